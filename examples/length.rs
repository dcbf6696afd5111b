//! Cut hair and let it grow while it moves: one side is shortened to 60 %, the other is half as long again.
//! `cargo run --release -p strandline --example length`

use strandline::{Camera, Hair, Look, Pose, Scene, Style};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::var_os("STRANDLINE_QUICK").is_some();
    let mut scene = Scene::default();
    scene.set_style(Style::Long);
    scene.style.strand_count = if quick { 50 } else { 2000 };
    scene.groom.bound = Some(0);
    let mut hair = Hair::open(&scene)?;
    let strands = 0..hair.guides().strand_count();
    let is_right = |strand| hair.guides().position(strand, 0).x > 0.0;
    let scales: Vec<f32> = strands.map(|strand| if is_right(strand) { 0.6 } else { 1.5 }).collect();
    hair.set_length_scale(&scales)?;
    let reports = hair.step(0.25, Pose::IDENTITY)?;
    assert!(reports.iter().all(|report| report.stretch_max < 1e-3), "hair has other lengths than those");
    std::fs::create_dir_all("out/examples")?;
    let picture = hair.picture(&Camera::front(), &Look::red())?;
    assert!(!picture.is_blank(), "no hair in the picture");
    picture.save("out/examples/length.png")?;
    Ok(())
}
