//! Shelter: hair and solids hold back the wind from the hair behind them, and hair carries the air among it along.

use glam::Vec3;
use strandline_body::{Carrier, Collider, Shape};
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides, LANES, RestShape, Vec3Lanes};
use strandline_sim::{Currents, Drive, Eddy, Model, Settings, Source};

use crate::air::{airy, blown};
use crate::rod_mechanics::model;
use crate::strands::{line, one_strand};

/// Strands along one side of a square of 4 cm, and the gap between them \[m\].
const SIDE: usize = 32;
const GAP: f32 = 0.04 / SIDE as f32;
/// Free segments of a strand, and its length \[m\].
const COUNT: usize = 16;
const LENGTH: f32 = 0.3;

/// Force of air of 5 m/s along x on loose strands that hang side by side, over that on a lone one: of the first rows
/// from the wind, the middle and the last ones. `moving` has the hair go through still air instead.
fn sheltered(on: &On, moving: bool) -> [f32; 3] {
    let settings = Settings { gravity: Vec3::ZERO, ..airy(1e-4, 40.0) };
    let gained = |side: usize| {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..side * side {
            let root = Vec3::new((strand / side) as f32, 0.0, (strand % side) as f32) * GAP;
            groom.push(line(root, root - Vec3::Y * LENGTH, COUNT));
        }
        let guides = Guides::resample(&groom, COUNT + 1).unwrap();
        let rest = RestShape::new(&guides, settings.line_density());
        let mut rig =
            Rig::new(on, Model::with_rest(&guides, rest, |_, _| false, &settings, Vec::new()).unwrap());
        let (speed, wind) = if moving { (-5.0, 0.0) } else { (0.0, 5.0) };
        rig.change(|state| state.velocities.fill(Vec3Lanes::splat(Vec3::X * speed)));
        rig.step(&blown(Vec3::X * wind));
        let state = rig.state();
        let of_strand = |strand: usize| {
            let points = strand / LANES * (COUNT + 1)..(strand / LANES + 1) * (COUNT + 1);
            points.map(|point| state.velocities[point].get(strand % LANES).x - speed).sum::<f32>()
        };
        (0..side * side).map(of_strand).collect::<Vec<_>>()
    };
    let (lone, block) = (gained(1)[0], gained(SIDE));
    let rows = |first: usize| {
        let strands = &block[first * SIDE..(first + 2) * SIDE];
        strands.iter().sum::<f32>() / (strands.len() as f32 * lone)
    };
    [rows(0), rows(SIDE / 2 - 1), rows(SIDE - 2)]
}

law! {
    fn hair_shelters_the_hair_behind_it(on) {
        let [first, middle, last] = sheltered(on, false);
        // The bounds of the law. Beer's law with the drag area of the rows before: 0.24 and 0.06.
        assert!(first > 0.6 && middle < 0.4 && last < 0.25, "{first}, {middle}, {last} of a lone strand's");
    }
}

law! {
    fn air_among_hair_goes_along_with_it(on) {
        let [first, middle, last] = sheltered(on, true);
        // As if the wind blew.
        assert!(first > 0.6 && middle < 0.4 && last < 0.25, "{first}, {middle}, {last} of a lone strand's");
    }
}

/// Angle \[degrees\] from the vertical of a hair of 14 cm that hangs in wind of 5 m/s, 1 cm behind a place where a ball as
/// wide as a head may be.
fn hanging(on: &On, ball: bool) -> f32 {
    const SHORT: f32 = 0.14;
    // Takes the swing; the equilibrium is the same.
    let settings = Settings { damping: 10.0, ..airy(1.0 / 60.0, 40.0) };
    let (root, free) = (Vec3::new(0.1, 0.07, 0.0), Vec3::Y * (SHORT / COUNT as f32));
    let guides = one_strand(&line(root + free, root - Vec3::Y * SHORT, COUNT + 1));
    let shape = Shape::sphere(Vec3::ZERO, 0.09).unwrap();
    let solids = ball.then(|| Collider::new(shape, Carrier::HEAD, 0.3).unwrap());
    let mut rig = Rig::new(on, model(&guides, &settings, |point| point < 2, solids.into_iter().collect()));
    rig.steps(&vec![blown(Vec3::X * 5.0); on.either(240, 180)]);
    let state = rig.state();
    let chord = state.positions[COUNT + 1].get(0) - state.positions[1].get(0);
    chord.x.atan2(-chord.y).to_degrees()
}

law! {
    long fn tips_hang_behind_a_head(on) {
        let (free, behind) = (hanging(on, false), hanging(on, true));
        assert!(free > 60.0 && behind.abs() < 5.0, "{behind} degrees behind a ball, {free} without it");
    }
}

/// Mean velocities \[m/s\] over a step of 1 ms that currents give two loose hairs upright 20 cm before the origin, the
/// second 40 cm aside, over a step.
fn driven(on: &On, currents: Currents) -> [Vec3; 2] {
    let settings = Settings { gravity: Vec3::ZERO, ..airy(1e-3, 40.0) };
    let mut groom = Groom::empty(8e-5);
    for aside in [0.0, 0.4] {
        let middle = Vec3::new(0.2, 0.0, aside);
        groom.push(line(middle + Vec3::Y * 0.02, middle - Vec3::Y * 0.02, COUNT));
    }
    let guides = Guides::resample(&groom, COUNT + 1).unwrap();
    let rest = RestShape::new(&guides, settings.line_density());
    let mut rig = Rig::new(on, Model::with_rest(&guides, rest, |_, _| false, &settings, Vec::new()).unwrap());
    rig.step(&Drive { currents, ..Drive::default() });
    let velocities = &rig.state().velocities;
    [0, 1].map(|lane| velocities.iter().map(|all| all.get(lane)).sum::<Vec3>() / velocities.len() as f32)
}

law! {
    fn fans_and_eddies_move_the_hair_in_them(on) {
        let fan = Source { place: Vec3::ZERO, direction: Vec3::X, speed: 5.0, radius: 0.05 };
        let [before, aside] = driven(on, Currents { sources: vec![fan], ..Currents::default() });
        // A metre of hair gains 2e-4 N / 6.5e-6 kg of 1 m/s: some centimetres a second in a millisecond.
        assert!(before.x > 0.05 && aside.length() < 0.02 * before.x, "{before} before the fan, {aside} beside it");
        // A wave along z whose half is 40 cm: up at the one, down at the other.
        let wave = Vec3::Z * (std::f32::consts::PI / 0.4);
        let eddy = Eddy { wave, phase: std::f32::consts::FRAC_PI_2, velocity: Vec3::Y };
        let [here, there] = driven(on, Currents { eddies: vec![eddy], ..Currents::default() });
        assert!(here.y > 3e-3 && there.y < -3e-3, "{here} and {there}");
    }
}
