//! Time of a step on a body that moves by itself, beside that of the same step on a rigid one, stage by stage.
//!
//! `cargo run --release -p strandline-sim --example skin_step -- [steps] [steps per second]`

#![allow(clippy::disallowed_methods, clippy::print_stdout)] // it prints times, and nothing depends on its bits

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{Quat, Vec3, vec3};
use strandline_base::Stopwatch;
use strandline_body::{
    BodyFrame, Carrier, Collider, DistanceGrid, Mannequin, Mesh, Pose, Shape, SignedDistance, SkinRoots,
    SkinSolid,
};
use strandline_groom::{Groom, Guides};
use strandline_sim::{CpuRunner, Drive, Model, Settings, State};

const STRANDS: usize = 2000;
const POINTS: usize = 16;
const TRIANGLES: usize = 20_000;

fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// The skin of the sample bust, some of whose triangles are divided until there are enough.
fn mesh() -> Mesh {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb");
    let mut mesh = Mesh::load(&path, 1.0).expect("the sample bust");
    let count = mesh.triangles.len();
    let missing = TRIANGLES.saturating_sub(count) / 2;
    for index in 0..missing {
        let own = index * count / missing;
        let [a, b, c] = mesh.triangles[own];
        let middle = [a, b, c].map(|corner| mesh.positions[corner as usize]).iter().sum::<Vec3>() / 3.0;
        let new = mesh.positions.len() as u32;
        mesh.positions.push(middle);
        mesh.triangles[own] = [a, b, new];
        mesh.triangles.extend([[b, c, new], [c, a, new]]);
    }
    Mesh::new(mesh.positions, mesh.triangles).expect("a mesh")
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

fn guides(mannequin: &Mannequin) -> Guides {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..STRANDS {
        let share = (strand as f32 + 0.5) / STRANDS as f32;
        let around = 2.399_963 * strand as f32;
        let (up, ring) = (1.0 - 0.8 * share, (1.0 - (1.0 - 0.8 * share).powi(2)).sqrt());
        let (root, normal) = mannequin
            .nearest_skin(0.1 * vec3(ring * around.cos(), up, ring * around.sin()) + vec3(0.0, 0.03, 0.0));
        groom.push(draped(mannequin, root, normal));
    }
    Guides::resample(&groom, POINTS).expect("guides")
}

/// The bust at a time \[s\]: the head turns on shoulders that rise and fall.
fn frame(mesh: &Mesh, time: f32) -> BodyFrame {
    let turn = 0.7 * (2.0 * time).sin();
    let raised = 0.02 * (1.0 - (5.0 * time).cos());
    let world = |place: &Vec3| {
        let turned = Quat::from_rotation_y(turn * smooth(-0.2, -0.1, place.y)) * *place;
        turned + Vec3::Y * raised * smooth(0.05, 0.14, place.x.abs()) * smooth(-0.12, -0.2, place.y)
    };
    let head = Pose { rotation: Quat::from_rotation_y(turn), translation: Vec3::ZERO };
    let head_from_world = head.inverse();
    let skin: Vec<Vec3> = mesh.positions.iter().map(|place| head_from_world.point(world(place))).collect();
    BodyFrame::from(head).with_skin(skin)
}

/// One of the two bodies with its hair, and the milliseconds of each stage in each step.
struct Side {
    runner: CpuRunner,
    state: State,
    times: BTreeMap<&'static str, Vec<f64>>,
}

impl Side {
    fn new(guides: &Guides, settings: &Settings, shape: Shape) -> Self {
        let solid = Collider::new(shape, Carrier::HEAD, 0.3).expect("a solid");
        let model = Model::new(guides, settings, vec![solid]).expect("a model");
        let state = model.rest_state(BodyFrame::REST);
        Self { runner: model.into(), state, times: BTreeMap::new() }
    }

    fn step(&mut self, body: impl FnOnce(&BodyFrame) -> BodyFrame) {
        let watch = Stopwatch::start();
        let body = body(&self.state.body);
        let roots = watch.seconds();
        let report = self.runner.step(&mut self.state, &Drive::of(body));
        let all = watch.seconds();
        let stages: f64 = report.seconds.iter().map(|(_, seconds)| seconds).sum();
        let rows = report.seconds.iter().copied();
        for (name, seconds) in
            rows.chain([("0 roots", roots), ("1 tree", all - roots - stages), ("= all", all)])
        {
            self.times.entry(name).or_default().push(1e3 * seconds);
        }
    }
}

fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn main() {
    let number = |index: usize, other: f32| {
        std::env::args().nth(index).map_or(other, |text| text.parse().expect("a number"))
    };
    let (steps, rate) = (number(1, 100.0) as usize, number(2, 120.0));
    let mannequin = Mannequin::new();
    let (mesh, guides) = (mesh(), guides(&mannequin));
    let grid = Arc::new(DistanceGrid::of_mesh(&mesh, 0.004, 0.02).expect("samples"));
    let skin = Arc::new(SkinSolid::new(&mesh, Arc::clone(&grid)).expect("a skin"));
    let roots: Vec<Vec3> = (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect();
    let roots = SkinRoots::new(&mesh, &roots);
    println!("{} triangles, {} strands of {POINTS} points", skin.triangle_count(), guides.strand_count());
    let settings = Settings { time_step: 1.0 / rate, ..Settings::default() };
    let mut moving = Side::new(&guides, &settings, Shape::Skin(skin));
    let mut rigid = Side::new(&guides, &settings, Shape::Grid(grid));
    let frames: Vec<BodyFrame> = (1..=steps).map(|step| frame(&mesh, step as f32 / rate)).collect();
    for frame in frames {
        let head = frame.world_from_head();
        moving.step(|last| roots.placed(frame, last));
        rigid.step(|_| head.into());
    }
    for (name, times) in &moving.times {
        let (own, other) = (median(times), rigid.times.get(name).map_or(0.0, |times| median(times)));
        println!("{name:16} {own:8.3} ms, rigid {other:8.3} ms, more {:8.3} ms", own - other);
    }
    let bits = moving.state.positions.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten();
    let sum = bits.fold(0_u64, |sum, number| sum.rotate_left(5) ^ u64::from(number.to_bits()));
    println!("bits {sum:016x}");
}
