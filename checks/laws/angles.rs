//! Bends: where they stop, and how fast they swing back.

use std::f32::consts::PI;

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_sim::constrain::Angles;
use strandline_sim::{Drive, Settings};

use crate::strands::{bare, chain, first, line};

/// A strand of three segments of 5 cm that hangs from its first three points: one segment is free.
fn hanging(on: &On, settings: &Settings) -> Rig {
    let points = line(Vec3::ZERO, Vec3::NEG_Y * 0.15, 3);
    Rig::new(on, chain(&points, 1.0, |point| point < 3, settings))
}

/// The bend \[rad\] of one free segment after 3 s in a strong pull to the side.
fn pulled_aside(on: &On, limit: f32) -> f32 {
    let settings = Settings { gravity: Vec3::X * 9.81, damping: 5.0, ..bare(1.0 / 60.0, 20) }
        .with_constrain(|constrain| constrain.angles = Angles { limit, stiffness: 0.0 });
    let mut rig = hanging(on, &settings);
    rig.steps(&vec![Drive::default(); 180]);
    let points = first(rig.state());
    (points[2] - points[1]).angle_between(points[3] - points[2])
}

law! {
    fn a_segment_that_is_pulled_aside_stops_at_the_limit(on) {
        for limit in [0.2, 0.5, 1.2] {
            let found = pulled_aside(on, limit);
            // The limit itself is exact; gravity takes the segment out of it by g dt^2 / l, 0.05 rad at most,
            // before the rounds that follow bring it back.
            assert!((found - limit).abs() < 0.01, "bent by {found}, limit {limit}");
        }
        let free = pulled_aside(on, PI);
        assert!((free - 0.5 * PI).abs() < 0.01, "without a limit it points to the side: {free}");
    }
}

/// Angular frequency \[1/s\] at which one free segment swings, by two passages through rest.
fn swing(on: &On, stiffness: f32, time_step: f32) -> f32 {
    let settings = Settings { gravity: Vec3::ZERO, ..bare(time_step, 20) }
        .with_constrain(|constrain| constrain.angles = Angles { limit: PI, stiffness });
    let mut rig = hanging(on, &settings);
    rig.change(|state| {
        let joint = state.positions[2].get(0);
        state.positions[3].set(0, joint + 0.05 * Vec3::new(0.2_f32.sin(), -0.2_f32.cos(), 0.0));
    });
    let (mut before, mut crossings) = (0.01, Vec::new());
    for step in 0..2000 {
        rig.step(&Drive::default());
        let now = first(rig.state())[3].x;
        if before * now < 0.0 {
            crossings.push((step as f32 + before / (before - now)) * time_step);
            if crossings.len() == 3 {
                return 2.0 * PI / (crossings[2] - crossings[0]);
            }
        }
        before = now;
    }
    panic!("it does not swing: {} passages", crossings.len());
}

law! {
    fn a_bent_segment_swings_back_at_its_frequency(on) {
        for stiffness in [10.0, 25.0, 60.0] {
            let found = swing(on, stiffness, 0.025 / stiffness);
            // A backward Euler step of 0.025 rad swings at atan(0.025) / 0.025; 0.2 rad is 0.5 % off a small
            // swing, whose force is its sine.
            assert!((found / stiffness - 1.0).abs() < 0.015, "{found} of {stiffness} 1/s");
        }
    }
}
