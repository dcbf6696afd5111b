//! Strands that the laws are tried on.

use std::f32::consts::PI;

use glam::Vec3;
use strandline_body::{Carrier, Collider, Shape};
use strandline_groom::{Groom, Guides, Lanes, RestShape};
use strandline_sim::constrain::{Angles, LengthPass, Springs};
use strandline_sim::{Drag, Model, Settings, State, VolumeSettings};

/// Lengths only: no air, no springs, no shape, no pass and no volume.
pub fn bare(time_step: f32, iterations: u32) -> Settings {
    Settings {
        time_step,
        drag: Drag::OFF,
        volume: VolumeSettings { enabled: false, ..VolumeSettings::default() },
        ..Settings::constrained()
    }
    .with_constrain(|constrain| {
        constrain.iterations = iterations;
        constrain.springs = Springs::OFF;
        constrain.angles = Angles::OFF;
        constrain.length_pass = LengthPass { enabled: false, ..LengthPass::default() };
    })
}

/// Guides along one polyline.
pub fn one_strand(points: &[Vec3]) -> Guides {
    let mut groom = Groom::empty(8e-5);
    groom.push(points.iter().copied());
    Guides::resample(&groom, points.len()).unwrap()
}

/// A straight line of equal segments.
pub fn line(start: Vec3, end: Vec3, segments: usize) -> Vec<Vec3> {
    (0..=segments).map(|index| start.lerp(end, index as f32 / segments as f32)).collect()
}

/// A chain of point masses of 1 kg (the last of `tip_mass`) that is held only where `held` says.
pub fn chain(
    points: &[Vec3],
    tip_mass: f32,
    held: impl Fn(usize) -> bool + Sync,
    settings: &Settings,
) -> Model {
    let guides = one_strand(points);
    let mut rest = RestShape::new(&guides, 1.0);
    rest.mass.fill(Lanes([1.0; 8]));
    rest.mass.last_mut().unwrap().0[0] = tip_mass;
    Model::with_rest(&guides, rest, |_, point| held(point), settings, Vec::new()).unwrap()
}

/// The points of the first strand.
pub fn first(state: &State) -> Vec<Vec3> {
    state.positions.iter().map(|lanes| lanes.get(0)).collect()
}

/// A ball of hair: strands that leave a skull of radius 0.1 m and hang down around it.
pub fn ball_of_hair(strands: usize, points: usize, length: f32) -> Guides {
    let mut groom = Groom::empty(8e-5);
    let golden = PI * (3.0 - 5.0_f32.sqrt());
    for strand in 0..strands {
        // The upper part of the sphere, evenly [Gonzalez2010].
        let y = 1.0 - 1.1 * (strand as f32 + 0.5) / strands as f32;
        let around = golden * strand as f32;
        let ring = (1.0 - y * y).sqrt();
        let normal = Vec3::new(ring * around.cos(), y, ring * around.sin());
        groom.push(combed_down(normal, length, 4 * points));
    }
    Guides::resample(&groom, points).unwrap()
}

/// A strand that leaves the ball along `normal` and bends down without entering it.
fn combed_down(normal: Vec3, length: f32, pieces: usize) -> Vec<Vec3> {
    let piece = length / pieces as f32;
    let mut point = normal * 0.1;
    let mut direction = normal;
    let mut points = vec![point];
    for _ in 0..pieces {
        point += direction * piece;
        let out = point.normalize();
        direction = (direction + Vec3::NEG_Y * (6.0 * piece / 0.1)).normalize();
        if point.length() < 0.104 {
            direction = (direction - out * out.dot(direction).min(0.0)).normalize();
        }
        if point.length() < 0.102 {
            point = out * 0.102;
        }
        points.push(point);
    }
    points
}

/// The skull under [`ball_of_hair`].
pub fn skull(friction: f32) -> Collider {
    Collider { shape: Shape::Sphere { center: Vec3::ZERO, radius: 0.1 }, carrier: Carrier::HEAD, friction }
}
