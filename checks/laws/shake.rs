//! A violent shake, frame rates and thread counts.

use std::f32::consts::PI;

use glam::Vec3;
use strandline_body::{Motion, Pose};
use strandline_checks::{On, Rig, law};
use strandline_groom::{LANES, Vec3Lanes};
use strandline_sim::{Clock, CpuRunner, Drive, Model, Settings, State};

use crate::strands::{ball_of_hair, skull};

/// Mean square speed \[m^2/s^2\] of the hair.
fn mean_square_speed(state: &State) -> f32 {
    let sum: f64 = state
        .velocities
        .iter()
        .flat_map(|v| (0..LANES).map(|lane| f64::from(v.get(lane).length_squared())))
        .sum();
    (sum / (state.velocities.len() * LANES) as f64) as f32
}

/// Largest mean square speed over 60 s of a shake of 20 g at 5 Hz; outside of `cargo xtask long` over 10 s on the CPU
/// and, on a software adapter, which takes longer, over 2 s.
fn shaken(on: &On, settings: &Settings) -> f32 {
    let hair = ball_of_hair(64, 12, 0.3);
    let model = Model::new(&hair, settings, vec![skull(0.3)]).unwrap();
    let mut rig = Rig::new(on, model);
    let speed = 2.0 * PI * 5.0;
    let amplitude = 20.0 * 9.81 / (speed * speed);
    let mut largest = 0.0_f32;
    for step in 1..=on.either(on.brief(3600, 600), 120) {
        let time = (f64::from(step) / 60.0 * 5.0).fract() as f32 / 5.0;
        let aside = Vec3::X * amplitude * (speed * time).sin();
        let world_from_head = Pose { translation: aside, ..Pose::IDENTITY };
        let report = rig.step(&Drive::of(world_from_head));
        assert_eq!(report.non_finite, 0, "step {step}");
        largest = largest.max(mean_square_speed(rig.state()));
    }
    largest
}

law! {
    long fn a_minute_of_violent_shaking_stays_bounded(on) {
        // The head itself moves at up to 6.25 m/s; the mean over all hair is no faster than half as much again,
        // though a tip may be. 4.5 and 6.0 m/s were seen.
        let bound = (1.5 * 6.25_f32).powi(2);
        let default = shaken(on, &Settings::constrained());
        assert!(default < bound, "strands of constraints: {default} m^2/s^2");
        let rods = shaken(on, &Settings::default());
        assert!(rods < bound, "rods: {rods} m^2/s^2");
        let thesis = shaken(on, &Settings::thesis());
        assert!(thesis < bound, "the thesis: {thesis} m^2/s^2");
    }
}

fn shake_for(clock: &mut Clock, model: &Model, frames: usize, rate: f64) -> State {
    let mut runner = CpuRunner::from(model.clone());
    let mut state = model.rest_state(Pose::IDENTITY);
    for _ in 0..frames {
        let ticks = clock.advance(1.0 / rate);
        for step in ticks.first..ticks.first + u64::from(ticks.count) {
            let time = clock.step_time(step + 1);
            let world_from_head = Motion::Shake.pose(time, Vec3::NEG_Y * 0.1);
            runner.step(&mut state, &Drive::of(world_from_head));
        }
    }
    state
}

// The next two are about bits, which the CPU backend alone promises: on a GPU points of one cell are
// summed in any order.

#[test]
fn the_frame_rate_does_not_change_a_bit() {
    let hair = ball_of_hair(40, 8, 0.25);
    let settings = Settings { time_step: 1.0 / 64.0, ..Settings::default() };
    let model = Model::new(&hair, &settings, vec![skull(0.3)]).unwrap();
    let mut results = [30.0, 60.0, 144.0].map(|rate| {
        shake_for(&mut Clock::new(settings.time_step), &model, 2 * rate as usize, rate).positions
    });
    assert_eq!(results[0], results[1]);
    assert_eq!(results[0], results[2]);
    let late = shake_for(&mut Clock::new(settings.time_step), &model, 61, 30.0);
    results[1] = late.positions;
    assert_ne!(results[0], results[1], "another time is not noticed");
}

fn with_threads(threads: usize, friction: f32, air: f32) -> Vec<Vec3Lanes> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let hair = ball_of_hair(300, 8, 0.25);
        let mut settings = Settings::default();
        settings.drag.factor = air;
        let model = Model::new(&hair, &settings, vec![skull(friction)]).unwrap();
        let mut clock = Clock::new(1.0 / 60.0);
        shake_for(&mut clock, &model, 60, 60.0).positions
    })
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    // The force of the air comes with the sums of its cells.
    for air in [0.0, 1.0] {
        let one = with_threads(1, 0.3, air);
        assert_eq!(one, with_threads(2, 0.3, air));
        assert_eq!(one, with_threads(5, 0.3, air));
        assert_ne!(one, with_threads(2, 0.1, air), "another friction is not noticed");
    }
}

/// Mean way \[m\] of a point in the last of some steps on a head that rests.
fn restless(on: &On, wind: Vec3, steps: usize) -> f32 {
    let hair = ball_of_hair(64, 12, 0.3);
    let model = Model::new(&hair, &Settings::default(), vec![skull(0.3)]).unwrap();
    let mut rig = Rig::new(on, model);
    let gust = |step: usize| Drive { wind: wind * (step as f32 * 0.1).sin(), ..Drive::default() };
    rig.steps(&(0..steps).map(gust).collect::<Vec<_>>());
    let state = rig.state();
    let pairs = state.positions.iter().zip(&state.previous_positions);
    let way: f32 = pairs.map(|(now, before)| now.get(0).distance(before.get(0))).sum();
    way / state.positions.len() as f32
}

law! {
    long fn hair_on_a_resting_head_comes_to_rest(on) {
        // 10 um in a step, 0.6 mm/s, is less than a tenth of a pixel of a head that fills the picture.
        let way = restless(on, Vec3::ZERO, on.either(600, 300));
        assert!(way < 1e-5, "{way} m");
        assert!(restless(on, Vec3::X, on.either(100, 40)) > 1e-4, "gusts are not noticed");
    }
}
