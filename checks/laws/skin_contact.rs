//! Hair on the skin of a bust that turns its head and shrugs, against the exact deformed mesh.

use std::sync::Arc;

use glam::{DVec3, Quat, Vec3, vec3};
use rayon::prelude::*;
use strandline_body::{
    BodyFrame, Carrier, Collider, DistanceGrid, Mannequin, Mesh, Pose, Shape, SignedDistance, SkinRoots,
    SkinSolid,
};
use strandline_groom::{Groom, Guides, LANES};
use strandline_sim::{CpuRunner, Drive, Model, Settings, State};

const POINTS: usize = 16;
/// Length of a step \[s\].
const STEP: f32 = 1.0 / 120.0;

/// A bust, and guides that hang from the upper half of its head over neck and shoulders.
struct Bust {
    mesh: Mesh,
    skin: Shape,
    guides: Guides,
    roots: SkinRoots,
}

impl Bust {
    fn new(strands: usize) -> Self {
        let mannequin = Mannequin::new();
        let mesh = mannequin.mesh();
        let grid = DistanceGrid::of_mesh(&mesh, 0.004, 0.02).unwrap();
        let skin = Shape::Skin(Arc::new(SkinSolid::new(&mesh, grid.into()).unwrap()));
        let mut groom = Groom::empty(8e-5);
        for strand in 0..strands {
            let share = (strand as f32 + 0.5) / strands as f32;
            let around = 2.399_963 * strand as f32;
            let (up, ring) = (1.0 - 0.8 * share, (1.0 - (1.0 - 0.8 * share).powi(2)).sqrt());
            let (root, normal) = mannequin.nearest_skin(
                0.1 * vec3(ring * around.cos(), up, ring * around.sin()) + vec3(0.0, 0.03, 0.0),
            );
            groom.push(draped(&mannequin, root, normal));
        }
        let guides = Guides::resample(&groom, POINTS).unwrap();
        let roots = (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect::<Vec<_>>();
        Self { roots: SkinRoots::new(&mesh, &roots), mesh, skin, guides }
    }

    fn model(&self, shape: Shape) -> Model {
        let solid = Collider::new(shape, Carrier::HEAD, 0.3).unwrap();
        Model::new(&self.guides, &Settings { time_step: STEP, ..Settings::default() }, vec![solid]).unwrap()
    }

    /// The bust at a time \[s\]: the head turns on shoulders that rise and fall.
    fn frame(&self, time: f32) -> BodyFrame {
        let turn = 0.7 * (2.0 * time).sin();
        let raised = 0.02 * (1.0 - (5.0 * time).cos());
        let world = |place: &Vec3| {
            let turned = Quat::from_rotation_y(turn * smooth(-0.2, -0.1, place.y)) * *place;
            turned + Vec3::Y * raised * smooth(0.05, 0.14, place.x.abs()) * smooth(-0.12, -0.2, place.y)
        };
        let head = Pose { rotation: Quat::from_rotation_y(turn), translation: Vec3::ZERO };
        let head_from_world = head.inverse();
        let skin: Vec<Vec3> =
            self.mesh.positions.iter().map(|place| head_from_world.point(world(place))).collect();
        self.roots.placed(BodyFrame::from(head).with_skin(skin), &BodyFrame::REST)
    }

    /// Depth \[m\] of every free point inside the exact deformed mesh, 0 outside.
    fn depths(&self, state: &State, body: &BodyFrame) -> Vec<f32> {
        let head = body.world_from_head();
        let skin = body.skin().unwrap();
        let positions = skin.iter().map(|place| head.point(*place)).collect();
        let mesh = Mesh::new(positions, self.mesh.triangles.clone()).unwrap().closed();
        let points: Vec<Vec3> = (0..self.guides.strand_count())
            .flat_map(|strand| (2..POINTS).map(move |point| (strand, point)))
            .map(|(strand, point)| state.positions[strand / LANES * POINTS + point].get(strand % LANES))
            .collect();
        let places = mesh.nearest_places(&points);
        points
            .par_iter()
            .zip(places)
            .map(|(point, place)| {
                let away = point.distance(place);
                if away < 0.01 && winding(&mesh, *point) > 0.5 { away } else { 0.0 }
            })
            .collect()
    }
}

fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// A strand of 30 cm that leaves the skin and falls over it.
fn draped(mannequin: &Mannequin, root: Vec3, normal: Vec3) -> Vec<Vec3> {
    let (mut point, mut direction) = (root, normal);
    let mut points = vec![root];
    for _ in 0..60 {
        point += direction * 0.005;
        direction = (direction + Vec3::NEG_Y * 0.25).normalize();
        let (distance, out) = mannequin.distance_and_gradient(point);
        point += out * (0.006 - distance).max(0.0);
        points.push(point);
    }
    points
}

/// Winding number of a closed mesh around a point, by solid angles \[Jacobson2013\].
fn winding(mesh: &Mesh, point: Vec3) -> f64 {
    let angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| (mesh.positions[corner as usize] - point).as_dvec3());
        let [x, y, z]: [f64; 3] = [a, b, c].map(DVec3::length);
        let volume = a.dot(b.cross(c));
        2.0 * volume.atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    mesh.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[test]
fn hair_stays_outside_a_bust_that_turns_and_shrugs() {
    let bust = Bust::new(240);
    let model = bust.model(bust.skin.clone());
    let mut state = model.rest_state(BodyFrame::REST);
    let mut runner = CpuRunner::from(model);
    let (mut inside, mut all, mut deepest) = (0, 0, 0.0_f32);
    for step in 1..=240 {
        let body = bust.frame(step as f32 * STEP);
        let report = runner.step(&mut state, &Drive::of(body.clone()));
        assert_eq!(report.non_finite, 0);
        if step % 24 == 0 {
            let depths = bust.depths(&state, &body);
            all += depths.len();
            inside += depths.iter().filter(|depth| **depth > 1e-5).count();
            deepest = depths.into_iter().fold(deepest, f32::max);
        }
    }
    assert!(inside * 1000 <= all, "{inside} of {all} points inside");
    assert!(deepest < 2e-3, "{deepest} m deep");
}
