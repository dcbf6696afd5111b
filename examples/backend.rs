//! Hair on the GPU if there is one, and what a step costs there.
//! `cargo run --release -p strandline --example backend`
#![allow(clippy::print_stdout)]

use strandline::{Backend, Hair, Pose, Prepared, Scene, StepReport};

fn main() -> Result<(), strandline::Error> {
    let mut scene = Scene::demo();
    scene.style.strand_count = if std::env::var_os("STRANDLINE_QUICK").is_some() { 100 } else { 2000 };
    // `Backend::Gpu(None)` would take a software adapter too, and fail where there is none.
    let mut hair = Hair::from_prepared(Prepared::new(&scene)?, Backend::auto())?;
    let reports = hair.step(0.2, Pose::IDENTITY)?;
    let is_sound = |report: &StepReport| report.non_finite == 0 && report.stretch_max < 1e-3;
    assert!(!reports.is_empty() && reports.iter().all(is_sound), "a step went wrong: {reports:?}");
    println!("simulated on {}", hair.simulated_on());
    for note in hair.take_notes() {
        println!("note: {note}");
    }
    for (stage, seconds) in reports.last().map_or(&[][..], |report| &report.seconds) {
        println!("{stage:<15}{:>8.3} ms", 1e3 * seconds);
    }
    Ok(())
}
