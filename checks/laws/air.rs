//! Air about rods: the force on a lone hair, the shape that it hangs in, the speed at which it falls.

use std::f64::consts::PI;

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_groom::RestShape;
use strandline_sim::{Drag, Drive, Model, Settings};

use crate::rod_mechanics::{model, rods};
use crate::strands::{first, line, one_strand};

/// Density \[kg/m^3\] and kinematic viscosity \[m^2/s\] of air.
const AIR: f64 = 1.2;
const NU: f64 = 1.5e-5;
const LENGTH: f32 = 0.3;
/// Free segments of a strand.
const COUNT: usize = 16;
const RADII: [f32; 3] = [25.0, 40.0, 60.0];
const SPEEDS: [f32; 4] = [0.5, 1.0, 3.0, 10.0];

/// Force \[N/m\] of air across a cylinder with a diameter \[m\] at a speed \[m/s\] [Cheng2013].
fn across(diameter: f64, speed: f64) -> f64 {
    let reynolds = (speed * diameter / NU).max(1e-9);
    let coefficient = 11.0 * reynolds.powf(-0.75)
        + 0.9 * (1.0 - (-1000.0 / reynolds).exp())
        + 1.2 * (1.0 - (-(reynolds / 4500.0).powf(0.7)).exp());
    // Stokes' flow below a Reynolds number of 0.1.
    let slow = 5.65e-5 * speed;
    if reynolds < 0.1 { slow } else { 0.5 * coefficient * AIR * diameter * speed * speed }
}

/// Force \[N/m\] of air along it \[Collis1959\].
fn along(diameter: f64, speed_across: f64, speed: f64) -> f64 {
    let reynolds = (speed_across * diameter / NU).max(0.1);
    PI * AIR * NU * 1.1 * (0.24 + 0.56 * reynolds.powf(0.45)) * speed
}

pub fn airy(time_step: f32, radius: f32) -> Settings {
    let mut settings = Settings { drag: Drag { factor: 1.0, ..Drag::default() }, ..rods(time_step) };
    settings.strands.rods.radius = radius;
    settings
}

pub fn blown(wind: Vec3) -> Drive {
    Drive { wind, ..Drive::default() }
}

/// A loose hair along x.
fn loose(on: &On, settings: &Settings) -> Rig {
    let guides = one_strand(&line(Vec3::ZERO, Vec3::X * LENGTH, COUNT));
    let rest = RestShape::new(&guides, settings.line_density());
    Rig::new(on, Model::with_rest(&guides, rest, |_, _| false, settings, Vec::new()).unwrap())
}

law! {
    fn wind_pushes_a_lone_hair_with_the_force_of_a_cylinder(on) {
        let cases = RADII.into_iter().flat_map(|radius| SPEEDS.map(|speed| (radius, speed)));
        for (radius, speed) in cases.step_by(on.either(1, 12)) {
            for (wind, force) in [
                (Vec3::Y, across(2e-6 * f64::from(radius), f64::from(speed))),
                (Vec3::X, along(2e-6 * f64::from(radius), 0.0, f64::from(speed))),
            ] {
                // Long enough to move hair by more than rounding, too short for it to follow the air.
                let heavy = f64::from(airy(1.0, radius).line_density());
                let time_step = ((0.03 * f64::from(speed) * heavy / force) as f32).clamp(1e-4, 1e-3);
                let settings = Settings { gravity: Vec3::ZERO, ..airy(time_step, radius) };
                let mut rig = loose(on, &settings);
                rig.step(&blown(wind * speed));
                let masses = rig.model().rest().mass.clone();
                let momentum: Vec3 =
                    rig.state().velocities.iter().zip(&masses).map(|(velocity, mass)| velocity.get(0) * mass.0[0]).sum();
                let found = f64::from(momentum.dot(wind) / (time_step * LENGTH));
                // The bound of the law: 3 % of the coefficient, and 3 % of the speed that the hair gains.
                assert!((found / force - 1.0).abs() < 0.1, "{radius} um, {wind} at {speed} m/s: {found} N/m, expected {force}");
            }
        }
    }
}

law! {
    fn a_hair_falls_at_its_own_speed_in_steps_of_any_length(on) {
        for radius in RADII.into_iter().step_by(on.either(1, 3)) {
            let diameter = 2e-6 * f64::from(radius);
            let weight = 1300.0 * PI * (1e-6 * f64::from(radius)).powi(2) * 9.81;
            // The speed at which the air carries the weight, by bisection.
            let (mut low, mut high) = (0.0, 10.0);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if across(diameter, middle) < weight { low = middle } else { high = middle }
            }
            for rate in [60.0, 240.0, 120.0, 480.0].into_iter().take(on.either(4, 2)) {
                let mut rig = loose(on, &airy(1.0 / rate, radius));
                rig.steps(&vec![Drive::default(); (0.8 * rate) as usize]);
                let speed = -f64::from(rig.state().velocities[COUNT / 2].get(0).y);
                // The law's coefficient is within 3 %, its speed within 3 % where the force goes with speed^(5/4).
                assert!((speed / low - 1.0).abs() < 0.05, "{radius} um, 1/{rate} s: {speed} m/s, expected {low}");
            }
        }
    }
}

/// Places of the nodes of a chain of segments \[m\] by their angles from the vertical.
fn places(angles: &[f64]) -> Vec<[f64; 2]> {
    let size = f64::from(LENGTH) / COUNT as f64;
    let mut places = vec![[0.0, 0.0]];
    for angle in angles {
        let [x, y] = places[places.len() - 1];
        places.push([x + size * angle.sin(), y - size * angle.cos()]);
    }
    places
}

/// Angle \[rad\] from the vertical of the chord of a clamped hair in a wind across it \[m/s\]: angles of the segments at which
/// moments of weight and air are those of the bends, by Newton's method with differences.
fn chord(radius: f64, wind: f64) -> f64 {
    let (diameter, size) = (2e-6 * radius, f64::from(LENGTH) / COUNT as f64);
    let radius = 1e-6 * radius;
    let mass = 1300.0 * PI * radius * radius;
    let stiffness = 3.5e9 * PI * radius.powi(4) / 4.0;
    let missing = |angles: &[f64]| -> Vec<f64> {
        let places = places(angles);
        let force = |point: usize| {
            let (lower, upper) = (places[point - 1], places[COUNT.min(point + 1)]);
            let chord = [upper[0] - lower[0], upper[1] - lower[1]];
            let long = chord[0].hypot(chord[1]);
            let (x, y) = (chord[0] / long, chord[1] / long);
            let (push, pull) = (wind * -y, wind * x);
            let length = if point == COUNT { 0.5 * size } else { size };
            let (push, pull) =
                (across(diameter, push.abs()) * push.signum(), along(diameter, push.abs(), pull));
            [length * (pull * x - push * y), length * (pull * y + push * x - mass * 9.81)]
        };
        let forces: Vec<_> = (1..=COUNT).map(force).collect();
        let bend = |joint: usize| {
            let (before, cell) = if joint == 0 { (0.0, 0.5 * size) } else { (angles[joint - 1], size) };
            let moment = stiffness / cell * 2.0 * (0.5 * (angles[joint] - before)).tan();
            let turned: f64 = (joint + 1..=COUNT)
                .map(|point| {
                    let arm = [places[point][0] - places[joint][0], places[point][1] - places[joint][1]];
                    arm[0] * forces[point - 1][1] - arm[1] * forces[point - 1][0]
                })
                .sum();
            moment - turned
        };
        (0..COUNT).map(bend).collect()
    };
    let mut angles = vec![(across(diameter, wind) / (mass * 9.81)).atan(); COUNT];
    for _ in 0..200 {
        let now = missing(&angles);
        let mut rows: Vec<Vec<f64>> = now.iter().map(|moment| vec![-moment]).collect();
        for joint in (0..COUNT).rev() {
            let mut aside = angles.clone();
            aside[joint] += 1e-6;
            for (row, (one, other)) in rows.iter_mut().zip(missing(&aside).iter().zip(&now)) {
                row.insert(0, (one - other) / 1e-6);
            }
        }
        let step = solved(rows);
        let most = step.iter().fold(0.0_f64, |most, turn| most.max(turn.abs()));
        for (angle, turn) in angles.iter_mut().zip(&step) {
            *angle += turn * (0.2 / most).min(1.0);
        }
        if most < 1e-9 {
            let [x, y] = places(&angles)[COUNT];
            return x.atan2(-y);
        }
    }
    panic!("no equilibrium of {diameter} m at {wind} m/s");
}

/// The solution of a system of rows, each with its right side behind it: Gauss's elimination with pivots.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let count = rows.len();
    for column in 0..count {
        let pivot = (column..count)
            .max_by(|one, other| rows[*one][column].abs().total_cmp(&rows[*other][column].abs()));
        rows.swap(column, pivot.unwrap());
        let own = rows[column].clone();
        for row in rows.iter_mut().skip(column + 1) {
            let share = row[column] / own[column];
            row.iter_mut().zip(&own).for_each(|(number, other)| *number -= share * other);
        }
    }
    let mut found = vec![0.0; count];
    for row in (0..count).rev() {
        let sum: f64 = (row + 1..count).map(|column| rows[row][column] * found[column]).sum();
        found[row] = (rows[row][count] - sum) / rows[row][row];
    }
    found
}

law! {
    fn a_hair_hangs_in_the_wind_at_its_own_angle(on) {
        let cases = RADII.into_iter().flat_map(|radius| SPEEDS.map(|speed| (radius, speed)));
        for (radius, speed) in cases.step_by(on.either(1, 12)) {
            let expected = chord(f64::from(radius), f64::from(speed)).to_degrees();
            let mut settings = airy(1.0 / 60.0, radius);
            // Takes the swing; the equilibrium is the same.
            settings.damping = 10.0;
            let root = Vec3::Y * (LENGTH / COUNT as f32);
            let guides = one_strand(&line(root, Vec3::NEG_Y * LENGTH, COUNT + 1));
            let mut rig = Rig::new(on, model(&guides, &settings, |point| point < 2, Vec::new()));
            rig.steps(&vec![blown(Vec3::X * speed); on.either(360, 240)]);
            let points = first(rig.state());
            let chord = points[COUNT + 1] - points[1];
            let found = f64::from(chord.x.atan2(-chord.y).to_degrees());
            assert!((found - expected).abs() < 3.0, "{radius} um, {speed} m/s: {found} degrees, expected {expected}");
        }
    }
}

law! {
    fn a_strand_of_a_mass_of_its_own_is_blown_as_so_many_hairs(on) {
        let points = line(Vec3::ZERO, Vec3::NEG_Y * 0.2, 12);
        let blown_aside = |own: bool, hairs: u32, change: fn(&mut Settings)| {
            let mut settings = airy(1.0 / 60.0, 40.0);
            (settings.drag.shelter, settings.strands.rods.wisp_hairs) = (false, if own { 1 } else { hairs });
            change(&mut settings);
            let mut guides = one_strand(&points);
            if own {
                // Of as many hairs, which are no stiffer than one.
                let of_hairs = hairs as f32 * settings.line_density();
                let mass = RestShape::new(&guides, of_hairs).mass;
                guides.set_masses(Some(mass.iter().map(|lanes| lanes.0[0]).collect())).unwrap();
                settings.strands.rods.youngs_modulus *= hairs as f32;
            }
            let mut rig = Rig::new(on, Model::new(&guides, &settings, Vec::new()).unwrap());
            rig.steps(&vec![blown(Vec3::X * 2.0); 60]);
            first(rig.state()).last().unwrap().x
        };
        let alone = blown_aside(false, 1, |_| ());
        for change in [|_: &mut Settings| (), |settings: &mut Settings| settings.drag.hairs = Some(50.0)] {
            let [expected, found] = [false, true].map(|own| blown_aside(own, 5, change));
            // Sections of a wisp are slower to turn than those of one hair.
            assert!((found / expected - 1.0).abs() < 0.01, "{found}, expected {expected}");
            assert!(found < 0.95 * alone, "a wisp is sheltered: {found}, a hair {alone}");
        }
    }
}
