//! Writes a small rigged glTF of the built-in bust: five joints, a smile as a morph target, and four clips.
//!
//! ```text
//! cargo run -p strandline-body --example bust -- out/bust.glb [spacing]
//! ```
//!
//! Clips: `nod` (the chin to the chest and up again), `look` (over the left shoulder, a rest, and back), `shrug` and
//! `smile`. Everything is quantised (KHR_mesh_quantization).

#![allow(clippy::print_stdout)] // a program for a terminal

mod glb;
#[path = "../src/mannequin/refine.rs"]
mod refine;

use glam::{Mat4, Quat, Vec3, vec3};
use glb::{Parts, container, joint_nodes, surface, turns};
use strandline_base::math;
use strandline_body::{Build, Eyes, Mannequin, SignedDistance};

/// Spacing of the samples of the skin \[m\], where no other is asked for.
const SPACING: f32 = 0.0081;
/// Balls \[m\] on the side of positive x within which triangles are split: centre, radius, and how many times.
const FINE: [(Vec3, f32, u32); 4] = [
    // Eyes, nose, mouth, and the ear.
    (vec3(0.031, -0.0165, 0.078), 0.019, 2),
    (vec3(0.0, -0.05, 0.103), 0.024, 2),
    (vec3(0.0, -0.078, 0.095), 0.028, 2),
    (vec3(0.085, -0.034, -0.01), 0.035, 1),
];
/// Steps of a coordinate over the box of the bust.
const STEPS: f32 = 65535.0;
/// Joints with the joint above and the place of each \[m\], head space.
const JOINTS: [(&str, Option<usize>, Vec3); 5] = [
    ("chest", None, vec3(0.0, -0.26, -0.04)),
    ("neck", Some(0), vec3(0.0, -0.185, -0.03)),
    ("head", Some(1), vec3(0.0, -0.062, -0.016)),
    ("shoulder.L", Some(0), vec3(0.03, -0.21, -0.05)),
    ("shoulder.R", Some(0), vec3(-0.03, -0.21, -0.05)),
];

/// The bust with closed eyes: it has no eyeballs of its own.
fn mannequin() -> Mannequin {
    Mannequin::of(Build::default(), Eyes::Closed)
}

/// The skin as triangles, from samples at a spacing \[m\], finer where the face has details.
fn skin(spacing: f32) -> (Vec<Vec3>, Vec<u32>) {
    let bust = mannequin();
    let bounds = bust.bounds();
    let on_skin = |place: Vec3| bust.nearest_skin(place).0;
    let (places, corners) = surface(|place| bust.distance(place), [bounds.min, bounds.max], spacing);
    let mut places: Vec<Vec3> = places.into_iter().map(on_skin).collect();
    let mut triangles = corners.as_chunks::<3>().0.to_vec();
    relax(&mut places, &triangles, 6, on_skin);
    for round in 0..2 {
        let is_fine = |middle: Vec3| {
            let half = vec3(middle.x.abs(), middle.y, middle.z);
            FINE.iter().any(|(center, radius, times)| round < *times && half.distance(*center) < *radius)
        };
        let ends = refine::split(&places, &mut triangles, is_fine);
        let middle = |[a, b]: [u32; 2]| on_skin(0.5 * (places[a as usize] + places[b as usize]));
        let new: Vec<Vec3> = ends.into_iter().map(middle).collect();
        places.extend(new);
        relax(&mut places, &triangles, 4, on_skin);
    }
    (places, triangles.concat())
}

/// Moves places about the details of the face towards the middles of their neighbours and back onto the skin, some rounds:
/// where the skin folds, triangles that were carried onto it lie over each other.
fn relax(places: &mut [Vec3], triangles: &[[u32; 3]], rounds: u32, on_skin: impl Fn(Vec3) -> Vec3) {
    let mut neighbours = vec![Vec::new(); places.len()];
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            neighbours[*from as usize].push(*to as usize);
        }
    }
    let is_near = |place: &Vec3| {
        let half = vec3(place.x.abs(), place.y, place.z);
        FINE.iter().any(|(center, radius, _)| half.distance(*center) < 1.3 * radius)
    };
    for _ in 0..rounds {
        let old = places.to_vec();
        for (place, around) in places.iter_mut().zip(&neighbours).filter(|(place, _)| is_near(place)) {
            let mean = around.iter().map(|index| old[*index]).sum::<Vec3>() / around.len().max(1) as f32;
            *place = on_skin(mean);
        }
    }
}

/// From 0 below a range to 1 above it.
fn rise(value: f32, from: f32, to: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Weights of the joints at a place of the skin, in bytes whose sum is 255.
fn weights(place: Vec3) -> [u8; 5] {
    // The chin belongs to the head, the throat behind it to the neck.
    let head = rise(place.y + 0.8 * place.z, -0.125, -0.075);
    let above_chest = rise(place.y + 0.2 * place.z, -0.235, -0.155);
    let neck = above_chest * (1.0 - head) * (1.0 - rise(place.x.abs(), 0.05, 0.09));
    let rest = 1.0 - head - neck;
    let side = rise(place.x.abs(), 0.04, 0.12) * rest;
    let [left, right] = if place.x > 0.0 { [side, 0.0] } else { [0.0, side] };
    let mut bytes = [0.0, neck, head, left, right].map(|weight: f32| (255.0 * weight).round() as u8);
    bytes[0] = 255 - bytes[1..].iter().fold(0, |sum: u8, byte| sum.saturating_add(*byte));
    bytes
}

/// Displacement of a place of the skin by a smile \[m\].
fn smile(place: Vec3) -> Vec3 {
    let side = place.x.signum();
    let near = |center: Vec3, reach: f32| {
        let distance = (place * vec3(side, 1.0, 1.0)).distance(center) / reach;
        math::exp(-distance * distance)
    };
    let corner = near(vec3(0.0245, -0.0786, 0.088), 0.014) * vec3(0.006, 0.008, -0.004);
    let cheek = near(vec3(0.045, -0.05, 0.072), 0.02) * vec3(0.002, 0.004, 0.002);
    (corner + cheek) * vec3(side, 1.0, 1.0)
}

fn clips(parts: &mut Parts) -> Vec<String> {
    let turn = |node: usize, degrees: &[[f32; 3]]| (node, "rotation", "VEC4", turns(degrees));
    let still = [0.0; 3];
    vec![
        parts.clip(
            "nod",
            &[0.0, 0.6, 1.0, 1.5, 2.0],
            &[
                turn(1, &[still, [14.0, 0.0, 0.0], [14.0, 0.0, 0.0], [-6.0, 0.0, 0.0], still]),
                turn(2, &[still, [24.0, 0.0, 0.0], [24.0, 0.0, 0.0], [-9.0, 0.0, 0.0], still]),
            ],
        ),
        parts.clip(
            "look",
            &[0.0, 0.7, 1.4, 2.2],
            &[
                turn(1, &[still, [2.0, 24.0, -3.0], [2.0, 24.0, -3.0], still]),
                turn(2, &[still, [6.0, 46.0, -4.0], [6.0, 46.0, -4.0], still]),
            ],
        ),
        parts.clip(
            "shrug",
            &[0.0, 0.45, 0.9, 1.5],
            &[
                turn(3, &[still, [0.0, 0.0, 16.0], [0.0, 0.0, 16.0], still]),
                turn(4, &[still, [0.0, 0.0, -16.0], [0.0, 0.0, -16.0], still]),
                turn(1, &[still, [3.0, 0.0, 0.0], [3.0, 0.0, 0.0], still]),
                turn(2, &[still, [-5.0, 0.0, 6.0], [-5.0, 0.0, 6.0], still]),
            ],
        ),
        parts.clip("smile", &[0.0, 0.5, 1.3, 2.0], &[(5, "weights", "SCALAR", vec![0.0, 1.0, 1.0, 0.0])]),
    ]
}

/// The whole file.
fn bust(spacing: f32) -> Vec<u8> {
    let (places, corners) = skin(spacing);
    let bounds = mannequin().bounds();
    let (origin, size) = (bounds.min, (bounds.max - bounds.min).max_element());
    let mut parts = Parts::default();
    let count = places.len();
    let quantised =
        |place: &Vec3| ((*place - origin) / size * STEPS).round().to_array().map(|step| step as u16);
    // Padded to four bytes.
    let steps: Vec<u8> = places
        .iter()
        .flat_map(|place| quantised(place).into_iter().chain([0]).flat_map(u16::to_le_bytes))
        .collect();
    let high = (bounds.max - origin) / size * STEPS;
    let range = format!(r#""min":[0,0,0],"max":[{},{},{}]"#, high.x as u16, high.y as u16, high.z as u16);
    let position =
        parts.accessor(&steps, 8, &format!(r#""componentType":5123,"count":{count},"type":"VEC3",{range}"#));
    // Of five joints at most four carry a vertex: no vertex is on both sides.
    let (mut joints, mut shares) = (Vec::new(), Vec::new());
    for place in &places {
        let weights = weights(*place);
        let side = if place.x > 0.0 { 3 } else { 4 };
        joints.extend([0, 1, 2, side as u8]);
        shares.extend([weights[0], weights[1], weights[2], weights[side]]);
    }
    let members = format!(r#""componentType":5121,"count":{count},"type":"VEC4""#);
    let joints = parts.accessor(&joints, 0, &members);
    let shares = parts.accessor(&shares, 0, &format!(r#"{members},"normalized":true"#));
    let indices: Vec<u8> = corners.iter().flat_map(|corner| (*corner as u16).to_le_bytes()).collect();
    let indices = parts.accessor(
        &indices,
        0,
        &format!(r#""componentType":5123,"count":{},"type":"SCALAR""#, corners.len()),
    );
    let target = smile_target(&mut parts, &places, size);
    let unit = Mat4::from_scale_rotation_translation(Vec3::splat(size / STEPS), Quat::IDENTITY, origin);
    let inverse: Vec<f32> = JOINTS
        .iter()
        .flat_map(|(_, _, place)| (Mat4::from_translation(-*place) * unit).to_cols_array())
        .collect();
    let inverse = parts.floats(&inverse, "MAT4", "");
    let clips = clips(&mut parts).join(",");
    let nodes = nodes().join(",");
    let mesh = format!(
        r#"{{"name":"bust","weights":[0],"extras":{{"targetNames":["smile"]}},"primitives":[{{"attributes":{{"POSITION":{position},"JOINTS_0":{joints},"WEIGHTS_0":{shares}}},"indices":{indices},"targets":[{{"POSITION":{target}}}]}}]}}"#
    );
    let (views, accessors, length) = (parts.views.join(","), parts.accessors.join(","), parts.bytes.len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"strandline"}},"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],"scene":0,"scenes":[{{"nodes":[0,5]}}],"nodes":[{nodes}],"skins":[{{"joints":[0,1,2,3,4],"inverseBindMatrices":{inverse}}}],"meshes":[{mesh}],"animations":[{clips}],"accessors":[{accessors}],"bufferViews":[{views}],"buffers":[{{"byteLength":{length}}}]}}"#
    );
    container(json.into_bytes(), parts.bytes)
}

/// The morph target: whole steps where the smile moves the skin, zeros elsewhere.
fn smile_target(parts: &mut Parts, places: &[Vec3], size: f32) -> usize {
    let (mut indices, mut values, mut changed) = (Vec::new(), Vec::new(), 0);
    let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
    for (index, place) in places.iter().enumerate() {
        let delta = (smile(*place) / size * STEPS).round();
        if delta.abs().max_element() >= 4.0 {
            indices.extend((index as u16).to_le_bytes());
            values.extend(
                delta.to_array().into_iter().chain([0.0]).flat_map(|step| (step as i16).to_le_bytes()),
            );
            (low, high, changed) = (low.min(delta), high.max(delta), changed + 1);
        }
    }
    // The values of a sparse part lie close together: single precision has no gaps to fill.
    let floats: Vec<u8> = values
        .chunks(8)
        .flat_map(|value| value[..6].chunks(2).map(|step| f32::from(i16::from_le_bytes([step[0], step[1]]))))
        .flat_map(f32::to_le_bytes)
        .collect();
    let (indices, values) = (parts.view(&indices, 0), parts.view(&floats, 0));
    let count = places.len();
    parts.accessors.push(format!(
        r#"{{"componentType":5126,"count":{count},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}],"sparse":{{"count":{changed},"indices":{{"bufferView":{indices},"componentType":5123}},"values":{{"bufferView":{values}}}}}}}"#,
        low.x, low.y, low.z, high.x, high.y, high.z
    ));
    parts.accessors.len() - 1
}

/// The joints, and the node of the skinned mesh.
fn nodes() -> Vec<String> {
    let mut nodes = joint_nodes(&JOINTS);
    nodes.push(r#"{"name":"bust","mesh":0,"skin":0}"#.to_owned());
    nodes
}

fn main() -> std::io::Result<()> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "bust.glb".to_owned());
    let spacing = std::env::args().nth(2).map_or(SPACING, |text| text.parse().expect("a spacing [m]"));
    let bytes = bust(spacing);
    std::fs::write(&path, &bytes)?;
    println!("{path}: {} bytes", bytes.len());
    Ok(())
}
