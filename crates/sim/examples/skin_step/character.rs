//! Hair of 30 cm on the sample bust of 20,000 triangles, whose head turns on shoulders that rise and fall.

use std::path::Path;

use glam::{Quat, Vec3, vec3};
use strandline_body::{BodyFrame, Mannequin, Mesh, Pose, SignedDistance};
use strandline_groom::{Groom, Guides};

/// Triangles of the skin.
pub const TRIANGLES: usize = 20_000;
/// Points of a strand.
pub const POINTS: usize = 16;
/// Air around the body that its samples cover, and their spacing \[m\], as of a scene.
pub const PADDING: f32 = 0.02;
pub const SPACING: f32 = 0.004;

fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// The skin of the sample bust in a file, some of whose triangles are divided until there are enough.
pub fn mesh(bust: &Path) -> Mesh {
    let mut mesh = Mesh::load(bust, 1.0).expect("the sample bust");
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

/// Place of a direction along a curve through cells (Morton's), on which neighbours are near, as in hair that grows here.
fn along_curve(direction: Vec3) -> u32 {
    let cells = ((direction + 1.0) * 512.0).to_array().map(|along| along as u32);
    (0..10).flat_map(|bit| cells.map(|cell| cell >> bit & 1)).rev().fold(0, |place, bit| place << 1 | bit)
}

/// So many strands all over the scalp.
pub fn guides(strands: usize) -> Guides {
    let mannequin = Mannequin::new();
    let direction = |strand: usize| {
        let share = (strand as f32 + 0.5) / strands as f32;
        let around = 2.399_963 * strand as f32;
        let (up, ring) = (1.0 - 0.8 * share, (1.0 - (1.0 - 0.8 * share).powi(2)).sqrt());
        vec3(ring * around.cos(), up, ring * around.sin())
    };
    let mut directions: Vec<Vec3> = (0..strands).map(direction).collect();
    directions.sort_by_key(|direction| along_curve(*direction));
    let mut groom = Groom::empty(8e-5);
    for direction in directions {
        let (root, normal) = mannequin.nearest_skin(0.1 * direction + vec3(0.0, 0.03, 0.0));
        groom.push(draped(&mannequin, root, normal));
    }
    Guides::resample(&groom, POINTS).expect("guides")
}

/// The bust at a time \[s\]: the head turns on shoulders that rise and fall.
pub fn frame(mesh: &Mesh, time: f32) -> BodyFrame {
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
