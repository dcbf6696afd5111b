//! Time of a step of strands that push each other, beside that of the same step without, and what the step meets.
//!
//! `cargo run --release -p strandline-sim --example contact_step -- [bob, long or wavy] [steps] [points] [strands]`

#![allow(clippy::disallowed_methods, clippy::print_stdout)] // it prints times, and nothing depends on its bits

use glam::{Quat, Vec3};
use strandline_base::Stopwatch;
use strandline_body::{BodyFrame, Carrier, Collider, Mannequin, Pose, Shape};
use strandline_groom::{Guides, Style, StyleSettings};
use strandline_sim::{CpuRunner, Drive, Model, Settings, State};

/// Steps per second, and those of the shake before times are taken.
const RATE: f32 = 60.0;
const BEFORE: usize = 6;

/// Seconds of all threads of the program so far.
fn processor_seconds() -> f64 {
    let Ok(text) = std::fs::read_to_string("/proc/self/stat") else { return 0.0 };
    let fields: Vec<&str> =
        text.rsplit_once(')').map_or(vec![], |(_, rest)| rest.split_whitespace().collect());
    [11, 12].iter().filter_map(|index| fields.get(*index)?.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// A head that shakes by 35 degrees.
fn drive(step: usize) -> Drive {
    let turn = 35_f32.to_radians() * (std::f32::consts::TAU * step as f32 / RATE).sin();
    Drive::of(Pose { rotation: Quat::from_rotation_y(turn), translation: Vec3::ZERO })
}

fn run(name: &str, model: Model, steps: usize) {
    let mut state: State = model.rest_state(BodyFrame::REST);
    let mut runner = CpuRunner::from(model);
    let mut report = (0..BEFORE).map(|step| runner.step(&mut state, &drive(step))).next_back();
    let (watch, before) = (Stopwatch::start(), processor_seconds());
    let mut solve = 0.0;
    for step in BEFORE..BEFORE + steps {
        let made = runner.step(&mut state, &drive(step));
        solve += made.seconds.iter().find(|(name, _)| *name == "solve_rods").map_or(0.0, |(_, one)| *one);
        report = Some(made);
    }
    let count = steps as f64;
    let processors = 1e3 * (processor_seconds() - before) / count;
    let (whole, solve) = (1e3 * watch.seconds() / count, 1e3 * solve / count);
    let bits = state.positions.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten();
    let sum = bits.fold(0_u64, |sum, number| sum.rotate_left(5) ^ u64::from(number.to_bits()));
    let contacts = report.and_then(|report| report.contacts);
    println!(
        "{name}: {processors:.0} ms of processors, {whole:.0} ms, solve_rods {solve:.0} ms; {contacts:?}; bits {sum:016x}"
    );
}

fn main() {
    let argument = |index: usize| std::env::args().nth(index);
    let number = |index, other| argument(index).map_or(other, |text| text.parse().expect("a number"));
    let style = match argument(1).as_deref() {
        None | Some("bob") => Style::Bob,
        Some("long") => Style::Long,
        Some("wavy") => Style::Wavy,
        Some(other) => panic!("bob, long or wavy, not {other}"),
    };
    let (steps, points, strands) = (number(2, 30), number(3, 16), number(4, 2000));
    let groom = StyleSettings { strand_count: strands, ..StyleSettings::new(style) }.grow().expect("hair");
    let guides = Guides::own_points(&groom, points).expect("guides");
    let head = || Collider::new(Shape::Mannequin(Mannequin::new()), Carrier::HEAD, 0.3).expect("a solid");
    let mut settings = Settings { time_step: 1.0 / RATE, ..Settings::default() };
    let model = |settings: &Settings| Model::new(&guides, settings, vec![head()]).expect("a model");
    println!("{strands} strands of {points} points, {steps} steps");
    if argument(5).is_none() {
        run("without contact", model(&settings), steps);
    }
    settings.contact.enabled = true;
    run("with contact", model(&settings), steps);
}
