//! Roots on a skin that moves, against frames that are known.

use glam::{Mat3, Quat, Vec3, vec3};
use strandline_body::{BodyFrame, Mesh, Pose, SkinRoots};

/// Bounds of the roots: distance \[m\] and angle \[degrees\].
const NEAR: f32 = 1e-4;
const ALIKE: f32 = 0.1;

/// A sheet about the origin in the plane y = 0, facing up, its columns at these places along x \[m\].
fn sheet(columns: &[f32]) -> Mesh {
    let rows = 41;
    let positions =
        (0..rows).flat_map(|row| columns.iter().map(move |x| vec3(*x, 0.0, 0.005 * row as f32 - 0.1)));
    let positions: Vec<Vec3> = positions.collect();
    let width = columns.len() as u32;
    let cell = |index: u32| {
        let corner = index / (width - 1) * width + index % (width - 1);
        [[corner, corner + width, corner + 1], [corner + 1, corner + width, corner + width + 1]]
    };
    Mesh::new(positions, (0..(width - 1) * (rows as u32 - 1)).flat_map(cell).collect()).unwrap()
}

fn even() -> Mesh {
    sheet(&(0..41).map(|column| 0.005 * column as f32 - 0.1).collect::<Vec<_>>())
}

/// Roots over the middle of a sheet, some a little above or below it.
fn roots() -> Vec<Vec3> {
    let root = |index: usize| {
        let share = index as f32 / 100.0;
        let height = [0.0, 5e-4, -5e-4][index % 3];
        vec3(0.16 * share - 0.08, height, 0.07 * (13.0 * share).sin())
    };
    (0..100).map(root).collect()
}

/// Angle between two rotations \[degrees\], sharp near 0.
fn angle(one: Quat, other: Quat) -> f32 {
    (2.0 * (one * other.conjugate()).xyz().length().min(1.0).asin()).to_degrees()
}

fn placed(mesh: &Mesh, skin: Vec<Vec3>, last: &BodyFrame) -> BodyFrame {
    SkinRoots::new(mesh, &roots()).placed(BodyFrame::REST.with_skin(skin), last)
}

fn moved(mesh: &Mesh, motion: impl Fn(Vec3) -> Vec3) -> BodyFrame {
    placed(mesh, mesh.positions.iter().map(|place| motion(*place)).collect(), &BodyFrame::REST)
}

/// Compares the root frames of a frame with the exact motion and rotation at each root.
fn compare(frame: &BodyFrame, motion: impl Fn(Vec3) -> Vec3, rotation: impl Fn(Vec3) -> Quat, angles: f32) {
    for (index, root) in roots().into_iter().enumerate() {
        let found = frame.root(index);
        let apart = found.point(root).distance(motion(root));
        assert!(apart < NEAR, "root {index} lies {apart} m from its place");
        let turned = angle(found.rotation, rotation(root));
        assert!(turned < angles, "root {index} is turned by {turned} degrees");
    }
}

#[test]
fn a_skin_at_rest_leaves_every_bit() {
    let mesh = even();
    let frame = moved(&mesh, |place| place);
    assert_eq!(frame.roots().unwrap(), vec![Pose::IDENTITY; 100]);
    let head = Pose { rotation: Quat::from_rotation_y(0.3), translation: vec3(0.1, 0.2, 0.3) };
    let body = BodyFrame::from(head).with_skin(mesh.positions.clone());
    let placed = SkinRoots::new(&mesh, &roots()).placed(body, &BodyFrame::REST);
    assert_eq!(placed.roots().unwrap(), vec![head; 100]);
    // Frames without a skin of this mesh, or with roots of their own, stay as they are.
    let own = BodyFrame::REST.with_skin(mesh.positions.clone()).with_roots([head; 100]);
    for frame in [own, BodyFrame::from(head), BodyFrame::REST.with_skin([Vec3::X])] {
        assert_eq!(SkinRoots::new(&mesh, &roots()).placed(frame.clone(), &BodyFrame::REST), frame);
    }
}

#[test]
fn rigid_motions_scaling_and_stretch_have_their_exact_frames() {
    let mesh = even();
    let turn = Quat::from_axis_angle(vec3(0.6, 0.0, 0.8), 2.5);
    let rigid = |place: Vec3| turn * place + vec3(0.2, -0.1, 0.3);
    compare(&moved(&mesh, rigid), rigid, |_| turn, 0.01);
    // Hair keeps its size, so that a root above the skin keeps its height: the bound of 0.1 mm leaves out these.
    let scaled = |place: Vec3| turn * (1.15 * place);
    compare(&moved(&mesh, scaled), scaled, |_| turn, 0.01);
    let stretch = Mat3::from_cols(vec3(1.3, 0.0, 0.2), Vec3::Y, vec3(0.2, 0.0, 0.9));
    let stretched = |place: Vec3| turn * (stretch * place);
    compare(&moved(&mesh, stretched), stretched, |_| turn, 0.01);
}

#[test]
fn a_bending_sheet_turns_its_roots_evenly() {
    let mesh = even();
    for radius in [0.1_f32, -0.1, 0.3] {
        let rotation = |place: Vec3| Quat::from_rotation_z(-place.x / radius);
        let bent = |place: Vec3| {
            let around = rotation(place) * (Vec3::Y * (radius + place.y)) - Vec3::Y * radius;
            vec3(around.x, around.y, place.z)
        };
        compare(&moved(&mesh, bent), bent, rotation, ALIKE);
    }
}

#[test]
fn a_soup_of_triangles_turns_its_roots_as_its_surface_does() {
    let mesh = crate::posed_skin::soup(&even());
    let radius = 0.1;
    let rotation = |place: Vec3| Quat::from_rotation_z(-place.x / radius);
    let bent = |place: Vec3| rotation(place) * (Vec3::Y * (radius + place.y)) - Vec3::Y * radius;
    let bent = |place: Vec3| Vec3 { z: place.z, ..bent(place) };
    compare(&moved(&mesh, bent), bent, rotation, ALIKE);
}

#[test]
fn thin_triangles_do_not_turn_a_root_over() {
    // Columns in pairs 2 um apart, which numbers of single precision still tell from each other.
    let columns: Vec<f32> =
        (0..40).map(|column| 0.01 * (column / 2) as f32 - 0.1 + 2e-6 * (column % 2) as f32).collect();
    let mesh = sheet(&columns);
    let turn = Quat::from_rotation_x(1.2);
    let noise = |place: Vec3| 2e-6 * vec3((7e4 * place.x + 3e3 * place.z).sin(), (9e4 * place.x).cos(), 0.0);
    let frame = moved(&mesh, |place| turn * (place + noise(place)));
    compare(&frame, |place| turn * place, |_| turn, 0.5);
}

#[test]
fn a_skin_without_area_keeps_the_last_rotation() {
    let mesh = even();
    let turn = Quat::from_rotation_z(0.7);
    let before = moved(&mesh, |place| turn * place);
    let line = placed(&mesh, mesh.positions.iter().map(|place| Vec3::X * place.x).collect(), &before);
    for (index, root) in line.roots().unwrap().iter().enumerate() {
        assert!(angle(root.rotation, turn) < 0.01 && root.translation.is_finite(), "{root:?} of {index}");
    }
    assert!(line.check(Some(100), None).is_ok());
}

#[test]
fn frames_between_two_follow_the_skin_there() {
    let mesh = even();
    let roots_on = SkinRoots::new(&mesh, &roots());
    let ahead = |way: f32| mesh.positions.iter().map(|place| *place + Vec3::X * way).collect::<Vec<_>>();
    let start = roots_on.placed(BodyFrame::REST.with_skin(ahead(0.0)), &BodyFrame::REST);
    let between = start.toward(&BodyFrame::REST.with_skin(ahead(0.1)), 0.5);
    assert!(between.roots().is_none());
    let between = roots_on.placed(between, &start);
    assert!(between.root(0).translation.distance(Vec3::X * 0.05) < 1e-6);
    // Saved and read again.
    let (roots, skin) = (between.roots().unwrap().to_vec(), between.skin().unwrap().clone());
    let read = BodyFrame::REST.with_skin(skin.clone()).with_roots(roots);
    assert!(read.toward(&start, 0.5).roots().is_some());
    assert!(roots_on.recognized(read).toward(&start, 0.5).roots().is_none());
    let own = BodyFrame::REST.with_skin(skin).with_roots(vec![Pose::IDENTITY; 100]);
    assert!(roots_on.recognized(own).toward(&start, 0.5).roots().is_some());
}
