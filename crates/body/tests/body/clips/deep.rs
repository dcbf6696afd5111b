//! A skin at the end of a long chain of joints, far from the origin of its mesh.

use glam::{DMat4, DQuat, DVec3, Mat4, Vec3};

use super::play;
use crate::files::{glb, scratch};

const JOINTS: usize = 40;
const VERTICES: usize = 60;
/// Origin of the body \[m\], space of the mesh.
const ORIGIN: DVec3 = DVec3::new(160.0, -120.0, 300.0);

/// Place of a joint in the space of the one above, and its rotation at rest.
fn local(joint: usize) -> (Vec3, [f32; 4]) {
    let share = joint as f64;
    let rotation = DQuat::from_axis_angle(
        DVec3::new((1.3 * share).sin(), (0.7 * share).cos(), 0.4).normalize(),
        0.9 * (2.1 * share).sin(),
    );
    let place = 9.0 * DVec3::new((0.9 * share).cos(), (1.7 * share).sin(), (0.3 * share).cos());
    (place.as_vec3(), rotation.as_quat().to_array())
}

/// The turn \[rad\] that the clip gives the middle joint, at its end.
const TURNED: f64 = 0.02;

/// Transforms of the joints into the world, the middle one turned by a share.
fn world(share: f64) -> Vec<DMat4> {
    let mut above = DMat4::IDENTITY;
    let joints = (0..JOINTS).map(|joint| {
        let (place, rotation) = local(joint);
        let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
        let turn = if joint == JOINTS / 2 { turned(share) } else { rotation };
        above *= DMat4::from_rotation_translation(turn, place.as_dvec3());
        above
    });
    joints.collect()
}

fn turned(share: f64) -> DQuat {
    let (_, rest) = local(JOINTS / 2);
    let rest = DQuat::from_array(rest.map(f64::from)).normalize();
    // As the file has it: the end of the clip in single precision.
    let end = (rest * DQuat::from_rotation_y(TURNED)).as_quat().to_array().map(f64::from);
    rest.slerp(DQuat::from_array(end).normalize(), share)
}

/// Inverse bind matrices: they bring the body to the origin of the world.
fn binds() -> Vec<Mat4> {
    world(0.0).iter().map(|joint| (joint.inverse() * DMat4::from_translation(-ORIGIN)).as_mat4()).collect()
}

/// A vertex \[m\], space of the mesh, within a metre of the body's origin; it has two joints in equal parts.
fn vertex(index: usize) -> (Vec3, [u8; 4]) {
    let share = index as f64;
    let place = ORIGIN + DVec3::new((1.1 * share).sin(), (2.3 * share).cos(), (0.6 * share).sin());
    (place.as_vec3(), [(index % JOINTS) as u8, ((7 * index + 3) % JOINTS) as u8, 0, 0])
}

fn bytes(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// The file.
fn file() -> Vec<u8> {
    let numbers = |rotation: DQuat| rotation.as_quat().to_array();
    let sections = [
        bytes((0..VERTICES).flat_map(|index| vertex(index).0.to_array())),
        bytes((0..VERTICES).flat_map(|_| [0.5, 0.5, 0.0, 0.0])),
        bytes(binds().iter().flat_map(Mat4::to_cols_array)),
        bytes([0.0, 1.0]),
        bytes(numbers(turned(0.0)).into_iter().chain(numbers(turned(1.0)))),
        (0..VERTICES).flat_map(|index| vertex(index).1).collect(),
        (0..VERTICES as u8 - 2).flat_map(|index| [index, index + 1, index + 2]).collect(),
    ];
    let mut first = 0;
    let mut views = Vec::new();
    for section in &sections {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{first},"byteLength":{}}}"#, section.len()));
        first += section.len();
    }
    let accessor = |(view, (kind, count, shape)): (usize, &(u32, usize, &str))| {
        let ends = if view == 0 { r#","min":[0,0,0],"max":[1,1,1]"# } else { "" };
        format!(r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"{shape}"{ends}}}"#)
    };
    let shapes = [
        (5126, VERTICES, "VEC3"),
        (5126, VERTICES, "VEC4"),
        (5126, JOINTS, "MAT4"),
        (5126, 2, "SCALAR"),
        (5126, 2, "VEC4"),
        (5121, VERTICES, "VEC4"),
        (5121, 3 * (VERTICES - 2), "SCALAR"),
    ];
    let joint = |joint: usize| {
        let (place, rotation) = local(joint);
        let child =
            if joint + 1 < JOINTS { format!(r#","children":[{}]"#, joint + 1) } else { String::new() };
        let place = place.to_array();
        format!(r#"{{"translation":{place:?},"rotation":{rotation:?}{child}}}"#)
    };
    let list = |items: Vec<String>| items.join(",");
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,{JOINTS}]}}],
"nodes":[{},{{"mesh":0,"skin":0}}],"skins":[{{"joints":{:?},"inverseBindMatrices":2}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":5}},"indices":6}}]}}],
"animations":[{{"name":"turn","samplers":[{{"input":3,"output":4}}],
"channels":[{{"sampler":0,"target":{{"node":{},"path":"rotation"}}}}]}}],
"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{first}}}]}}"#,
        list((0..JOINTS).map(joint).collect()),
        (0..JOINTS).collect::<Vec<_>>(),
        JOINTS / 2,
        list(shapes.iter().enumerate().map(accessor).collect()),
        list(views),
    );
    let mut bin = sections.concat();
    bin.resize(bin.len().next_multiple_of(4), 0);
    glb(&json, &bin)
}

/// Sums of products of a size of a hundred metres come out at about one: in single precision a part in ten million of the
/// hundred is more than the bound.
#[test]
fn a_long_chain_far_from_the_origin_of_its_mesh_is_exact() {
    let (_folder, path) = scratch("deep.glb", &file());
    let (_, motion, notes) = play(&path, "turn").unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let binds = binds();
    let mut in_single = 0.0_f64;
    for time in [0.0, 0.3, 1.0] {
        let joints: Vec<DMat4> =
            world(time).iter().zip(&binds).map(|(joint, own)| *joint * own.as_dmat4()).collect();
        for (index, found) in motion.positions(time).into_iter().enumerate() {
            let (place, of) = vertex(index);
            let part = |slot: usize| 0.5 * joints[of[slot] as usize].transform_point3(place.as_dvec3());
            let expected = part(0) + part(1);
            let apart = found.as_dvec3().distance(expected);
            assert!(
                apart < 1e-5 && expected.length() < 10.0,
                "vertex {index} at {time} s: {apart} m, {expected}"
            );
            let rounded = |slot: usize| 0.5 * joints[of[slot] as usize].as_mat4().transform_point3(place);
            in_single = in_single.max((rounded(0) + rounded(1)).as_dvec3().distance(expected));
        }
    }
    assert!(in_single > 1e-5, "{in_single} m: the law can fail");
}
