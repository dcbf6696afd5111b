//! Writes a small rigged animal with fur: a glTF of 14 joints that walks, its fur as strands, and a scene of both.
//!
//! ```text
//! cargo run -p strandline-body --example animal -- out/animal
//! strandline render --scene out/animal/animal.toml
//! ```
//!
//! The clip `walk` is one stride of a walk on the spot: each foot is lifted a quarter of a stride after the one before it.

#![allow(clippy::print_stdout)] // a program for a terminal

mod glb;

use std::f32::consts::TAU;

use glam::{Mat4, Quat, Vec3, vec3};
use glb::{Parts, container, joint_nodes, surface, turns};
use strandline_base::{Random, math};

/// Spacing of the samples of the skin \[m\], and steps of a coordinate over the box of the animal.
const SPACING: f32 = 0.0105;
const STEPS: f32 = 65535.0;
/// Box of the animal \[m\].
const LOW: Vec3 = vec3(-0.2, -0.02, -0.45);
const HIGH: Vec3 = vec3(0.2, 0.65, 0.45);
/// Way over which parts of the body run into each other \[m\].
const BLEND: f32 = 0.03;
/// Strands of the fur, and points of each.
const STRANDS: usize = 4000;
const POINTS: usize = 6;
/// Duration of a stride \[s\], and keys of it.
const STRIDE: f32 = 1.0;
const KEYS: usize = 24;

/// Joints with the joint above and the place of each \[m\].
const JOINTS: [(&str, Option<usize>, Vec3); 14] = [
    ("hips", None, vec3(0.0, 0.30, -0.12)),
    ("chest", Some(0), vec3(0.0, 0.31, 0.0)),
    ("neck", Some(1), vec3(0.0, 0.34, 0.14)),
    ("head", Some(2), vec3(0.0, 0.43, 0.23)),
    ("fore.L", Some(1), vec3(0.055, 0.28, 0.12)),
    ("fore.R", Some(1), vec3(-0.055, 0.28, 0.12)),
    ("hind.L", Some(0), vec3(0.055, 0.28, -0.15)),
    ("hind.R", Some(0), vec3(-0.055, 0.28, -0.15)),
    ("forefoot.L", Some(4), vec3(0.055, 0.15, 0.115)),
    ("forefoot.R", Some(5), vec3(-0.055, 0.15, 0.115)),
    ("hindfoot.L", Some(6), vec3(0.058, 0.15, -0.125)),
    ("hindfoot.R", Some(7), vec3(-0.058, 0.15, -0.125)),
    ("tail", Some(0), vec3(0.0, 0.33, -0.20)),
    ("tip", Some(12), vec3(0.0, 0.38, -0.30)),
];

/// A cone with round ends: joint, the two ends \[m\] and their radii \[m\].
type Cone = (usize, Vec3, Vec3, f32, f32);

/// Parts of the body; those of a leg are of the left one.
const MIDDLE: [Cone; 7] = [
    (0, vec3(0.0, 0.300, -0.17), vec3(0.0, 0.30, -0.06), 0.086, 0.080),
    (1, vec3(0.0, 0.300, -0.06), vec3(0.0, 0.30, 0.13), 0.080, 0.092),
    (2, vec3(0.0, 0.325, 0.15), vec3(0.0, 0.42, 0.23), 0.074, 0.060),
    (3, vec3(0.0, 0.450, 0.26), vec3(0.0, 0.45, 0.28), 0.070, 0.066),
    (3, vec3(0.0, 0.440, 0.30), vec3(0.0, 0.425, 0.375), 0.045, 0.027),
    (12, vec3(0.0, 0.330, -0.21), vec3(0.0, 0.38, -0.30), 0.030, 0.026),
    (13, vec3(0.0, 0.380, -0.30), vec3(0.0, 0.47, -0.36), 0.026, 0.018),
];
const LEFT: [Cone; 9] = [
    (3, vec3(0.045, 0.490, 0.245), vec3(0.062, 0.56, 0.235), 0.026, 0.010),
    (4, vec3(0.055, 0.285, 0.120), vec3(0.055, 0.16, 0.115), 0.047, 0.030),
    (8, vec3(0.055, 0.150, 0.115), vec3(0.055, 0.03, 0.130), 0.029, 0.024),
    (8, vec3(0.055, 0.026, 0.130), vec3(0.055, 0.024, 0.158), 0.026, 0.023),
    (6, vec3(0.055, 0.285, -0.150), vec3(0.058, 0.17, -0.120), 0.060, 0.036),
    (10, vec3(0.058, 0.160, -0.120), vec3(0.058, 0.09, -0.178), 0.033, 0.023),
    (10, vec3(0.058, 0.090, -0.178), vec3(0.058, 0.028, -0.165), 0.023, 0.023),
    (10, vec3(0.058, 0.026, -0.165), vec3(0.058, 0.024, -0.135), 0.026, 0.023),
    (3, vec3(0.031, 0.470, 0.324), vec3(0.031, 0.47, 0.325), 0.017, 0.017),
];
/// The left eye and the nose: dark and bare.
const EYE: Vec3 = vec3(0.031, 0.472, 0.332);
const NOSE: Vec3 = vec3(0.0, 0.437, 0.402);
const BARE: f32 = 0.02;

/// Mirror image of a joint: that of the other side.
fn other_side(joint: usize) -> usize {
    match joint {
        4 | 6 | 8 | 10 => joint + 1,
        _ => joint,
    }
}

/// All parts of the body.
fn cones() -> Vec<Cone> {
    let mirror = vec3(-1.0, 1.0, 1.0);
    let right =
        LEFT.map(|(joint, start, end, from, to)| (other_side(joint), start * mirror, end * mirror, from, to));
    MIDDLE.into_iter().chain(LEFT).chain(right).collect()
}

/// Distance of a place from a part \[m\].
fn from_cone(&(_, start, end, from, to): &Cone, place: Vec3) -> f32 {
    let axis = end - start;
    let share = ((place - start).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    place.distance(start + axis * share) - (from + (to - from) * share)
}

/// Signed distance of the skin \[m\], nearly: all parts, run into each other.
fn distance(cones: &[Cone], place: Vec3) -> f32 {
    cones.iter().map(|cone| from_cone(cone, place)).fold(f32::INFINITY, |whole, part| {
        let share = (0.5 + 0.5 * (part - whole) / BLEND).clamp(0.0, 1.0);
        if whole == f32::INFINITY {
            part
        } else {
            part + (whole - part) * share - BLEND * share * (1.0 - share)
        }
    })
}

/// Unit normal of the skin.
fn normal(cones: &[Cone], place: Vec3) -> Vec3 {
    let step = 1e-3;
    let along = |axis: Vec3| distance(cones, place + axis * step) - distance(cones, place - axis * step);
    vec3(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or(Vec3::Y)
}

/// Joints that carry a place of the skin, the first four, and their weights in bytes whose sum is 255.
fn weights(cones: &[Cone], place: Vec3) -> ([u8; 4], [u8; 4]) {
    let mut shares = [0.0_f32; JOINTS.len()];
    for cone in cones {
        let away = from_cone(cone, place).max(0.0) / 0.02;
        shares[cone.0] = shares[cone.0].max(math::exp(-away * away));
    }
    let mut order: Vec<usize> = (0..JOINTS.len()).collect();
    order.sort_by(|one, other| shares[*other].total_cmp(&shares[*one]));
    let total: f32 = order[..4].iter().map(|joint| shares[*joint]).sum();
    let joints = std::array::from_fn(|place| order[place] as u8);
    let mut bytes: [u8; 4] =
        std::array::from_fn(|place| (255.0 * shares[order[place]] / total).round() as u8);
    bytes[0] = 255 - bytes[1..].iter().fold(0, |sum: u8, byte| sum.saturating_add(*byte));
    (joints, bytes)
}

/// Distance of a place from what is bare \[m\]: eyes and nose.
fn from_bare(place: Vec3) -> f32 {
    let side = place.with_x(place.x.abs());
    side.distance(EYE).min(place.distance(NOSE)) - BARE
}

/// Linear colour of the skin: a fox's red, pale below, dark at the feet, the ears' tips, eyes and nose.
fn color(place: Vec3, normal: Vec3) -> [f32; 3] {
    let [red, pale, dark] = [vec3(0.36, 0.13, 0.035), vec3(0.62, 0.55, 0.46), vec3(0.03, 0.022, 0.02)];
    let is_head = place.z > 0.2 && place.y > 0.36;
    let below = rise(-normal.y, 0.1, 0.7) * if is_head { 1.0 } else { rise(place.y, 0.14, 0.2) };
    let muzzle = rise(place.z, 0.30, 0.34) * rise(0.44 - place.y, -0.01, 0.015);
    let tip = rise(-place.z, 0.315, 0.35);
    let feet = 1.0 - rise(place.y, 0.06, 0.15);
    let ears = rise(place.y, 0.53, 0.56);
    let coat = red.lerp(pale, below.max(muzzle).max(tip)).lerp(dark, feet.max(ears));
    let bare = 1.0 - rise(from_bare(place), -0.003, 0.004);
    coat.lerp(vec3(0.008, 0.007, 0.007), bare).to_array()
}

/// From 0 below a range to 1 above it.
fn rise(value: f32, from: f32, to: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Length of the fur at a place \[m\].
fn length(place: Vec3) -> f32 {
    let face = rise(place.z, 0.23, 0.32) * rise(place.y, 0.36, 0.40);
    let ears = rise(place.y, 0.49, 0.52);
    let legs = 1.0 - rise(place.y, 0.14, 0.24);
    let tail = rise(-place.z, 0.22, 0.27) * rise(place.y, 0.24, 0.30);
    let coat = 0.030 - 0.023 * face.max(ears) - 0.016 * legs;
    coat + (0.055 - coat) * tail
}

/// Direction in which the fur lies at a place: backward, down the legs, along the tail.
fn flow(place: Vec3) -> Vec3 {
    let legs = 1.0 - rise(place.y, 0.18, 0.27);
    let tail = rise(-place.z, 0.22, 0.27) * rise(place.y, 0.24, 0.30);
    let back = vec3(0.0, -0.35, -1.0);
    back.lerp(Vec3::NEG_Y, legs).lerp(vec3(0.0, 0.75, -0.65), tail).normalize_or(Vec3::NEG_Y)
}

/// Strands of the fur, spread evenly over the skin \[m\].
fn fur(cones: &[Cone], places: &[Vec3], corners: &[u32]) -> Vec<[Vec3; POINTS]> {
    let triangles: Vec<[Vec3; 3]> =
        corners.chunks(3).map(|corners| [0, 1, 2].map(|corner| places[corners[corner] as usize])).collect();
    let mut sum = 0.0;
    let area = |[a, b, c]: &[Vec3; 3]| 0.5 * (*b - *a).cross(*c - *a).length();
    let sums: Vec<f32> = triangles.iter().map(|triangle| (sum += area(triangle), sum).1).collect();
    let mut random = Random::new(7, 0);
    let mut strands = Vec::with_capacity(STRANDS);
    for index in 0..STRANDS {
        let at = sum * (index as f32 + random.unit()) / STRANDS as f32;
        let [a, b, c] = triangles[sums.partition_point(|sum| *sum < at).min(triangles.len() - 1)];
        let (first, second) = (random.unit().sqrt(), random.unit());
        let root = a + (b - a) * (first * (1.0 - second)) + (c - a) * (first * second);
        let is_sole = root.y < 0.012;
        if from_bare(root) < 0.006 || is_sole {
            continue;
        }
        let out = normal(cones, root);
        let mess = vec3(random.unit(), random.unit(), random.unit()) - 0.5;
        let lie = (flow(root) + 0.35 * mess).reject_from_normalized(out).normalize_or(Vec3::NEG_Y);
        let step = length(root) * (0.8 + 0.4 * random.unit()) / (POINTS - 1) as f32;
        let mut place = root;
        strands.push(std::array::from_fn(|point| {
            if point > 0 {
                let share = point as f32 / (POINTS - 1) as f32;
                let up = 0.85 - 0.6 * share;
                place += step * (out * up + lie * (1.0 - up * up).sqrt()).normalize();
            }
            place
        }));
    }
    strands
}

/// Strands as a .data file: their number, then points and places of each.
fn data(strands: &[[Vec3; POINTS]]) -> Vec<u8> {
    let count = (strands.len() as i32).to_le_bytes().to_vec();
    strands.iter().fold(count, |mut bytes, strand| {
        bytes.extend((POINTS as i32).to_le_bytes());
        bytes.extend(strand.iter().flat_map(|place| place.to_array()).flat_map(f32::to_le_bytes));
        bytes
    })
}

/// The clip of a stride.
fn walk(parts: &mut Parts) -> String {
    let phase = |key: usize, offset: f32| TAU * (key as f32 / KEYS as f32 + offset);
    let times: Vec<f32> = (0..=KEYS).map(|key| STRIDE * key as f32 / KEYS as f32).collect();
    let turn = |node: usize, degrees: &dyn Fn(usize) -> [f32; 3]| {
        let keys: Vec<[f32; 3]> = (0..=KEYS).map(degrees).collect();
        (node, "rotation", "VEC4", turns(&keys))
    };
    let mut channels = Vec::new();
    // Left hind, left fore, right hind, right fore. A foot is bent while its leg swings forward.
    for (upper, lower, offset, bend) in
        [(6, 10, 0.0, 42.0), (4, 8, 0.75, 55.0), (7, 11, 0.5, 42.0), (5, 9, 0.25, 55.0)]
    {
        channels.push(turn(upper, &|key| [22.0 * math::sin(phase(key, offset)), 0.0, 0.0]));
        let swings = |key: usize| (-math::cos(phase(key, offset))).max(0.0);
        channels.push(turn(lower, &|key| [bend * swings(key).powi(2), 0.0, 0.0]));
    }
    channels.push(turn(1, &|key| [0.0, 4.0 * math::sin(phase(key, 0.1)), 2.0 * math::sin(phase(key, 0.35))]));
    channels.push(turn(2, &|key| {
        [3.0 * math::sin(2.0 * phase(key, 0.1)), -2.0 * math::sin(phase(key, 0.1)), 0.0]
    }));
    channels.push(turn(3, &|key| {
        [-4.0 * math::sin(2.0 * phase(key, 0.15)), -2.0 * math::sin(phase(key, 0.1)), 0.0]
    }));
    channels.push(turn(12, &|key| [0.0, 14.0 * math::sin(phase(key, 0.2)), 0.0]));
    channels.push(turn(13, &|key| [0.0, 20.0 * math::sin(phase(key, 0.05)), 0.0]));
    let hips = JOINTS[0].2;
    let bob =
        (0..=KEYS).flat_map(|key| (hips + Vec3::Y * 0.006 * math::sin(2.0 * phase(key, 0.05))).to_array());
    channels.push((0, "translation", "VEC3", bob.collect()));
    parts.clip_by("LINEAR", "walk", &times, &channels)
}

/// The whole file.
fn animal(cones: &[Cone], places: &[Vec3], corners: &[u32]) -> Vec<u8> {
    let (count, size) = (places.len(), (HIGH - LOW).max_element());
    let mut parts = Parts::default();
    let quantised = |place: &Vec3| ((*place - LOW) / size * STEPS).round().to_array().map(|step| step as u16);
    // Padded to four bytes.
    let steps =
        places.iter().flat_map(|place| quantised(place).into_iter().chain([0]).flat_map(u16::to_le_bytes));
    let steps: Vec<u8> = steps.collect();
    let high = (HIGH - LOW) / size * STEPS;
    let range = format!(r#""min":[0,0,0],"max":[{},{},{}]"#, high.x as u16, high.y as u16, high.z as u16);
    let position =
        parts.accessor(&steps, 8, &format!(r#""componentType":5123,"count":{count},"type":"VEC3",{range}"#));
    let (joints, shares): (Vec<[u8; 4]>, Vec<[u8; 4]>) =
        places.iter().map(|place| weights(cones, *place)).unzip();
    let members = format!(r#""componentType":5121,"count":{count},"type":"VEC4""#);
    let joints = parts.accessor(&joints.concat(), 0, &members);
    let shares = parts.accessor(&shares.concat(), 0, &format!(r#"{members},"normalized":true"#));
    let paint = |place: &Vec3| {
        let [red, green, blue] =
            color(*place, normal(cones, *place)).map(|part| (255.0 * part).round() as u8);
        [red, green, blue, 255]
    };
    let colors: Vec<[u8; 4]> = places.iter().map(paint).collect();
    let colors = parts.accessor(&colors.concat(), 0, &format!(r#"{members},"normalized":true"#));
    let indices: Vec<u8> = corners.iter().flat_map(|corner| (*corner as u16).to_le_bytes()).collect();
    let members = format!(r#""componentType":5123,"count":{},"type":"SCALAR""#, corners.len());
    let indices = parts.accessor(&indices, 0, &members);
    let unit = Mat4::from_scale_rotation_translation(Vec3::splat(size / STEPS), Quat::IDENTITY, LOW);
    let inverse =
        JOINTS.iter().flat_map(|(_, _, place)| (Mat4::from_translation(-*place) * unit).to_cols_array());
    let inverse = parts.floats(&inverse.collect::<Vec<_>>(), "MAT4", "");
    let clip = walk(&mut parts);
    let mut nodes = joint_nodes(&JOINTS);
    let (skinned, all): (usize, Vec<usize>) = (nodes.len(), (0..nodes.len()).collect());
    nodes.push(r#"{"name":"animal","mesh":0,"skin":0}"#.to_owned());
    let (nodes, views, accessors) = (nodes.join(","), parts.views.join(","), parts.accessors.join(","));
    let length = parts.bytes.len();
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"strandline"}},"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],"scene":0,"scenes":[{{"nodes":[0,{skinned}]}}],"nodes":[{nodes}],"skins":[{{"joints":{all:?},"inverseBindMatrices":{inverse}}}],"materials":[{{"name":"coat","pbrMetallicRoughness":{{"roughnessFactor":0.6,"metallicFactor":0}}}}],"meshes":[{{"name":"animal","primitives":[{{"attributes":{{"POSITION":{position},"JOINTS_0":{joints},"WEIGHTS_0":{shares},"COLOR_0":{colors}}},"indices":{indices},"material":0}}]}}],"animations":[{clip}],"accessors":[{accessors}],"bufferViews":[{views}],"buffers":[{{"byteLength":{length}}}]}}"#
    );
    container(json.into_bytes(), parts.bytes)
}

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "out/animal".to_owned());
    let folder = std::path::Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let cones = cones();
    let (places, corners) = surface(|place| distance(&cones, place), [LOW, HIGH], SPACING);
    let (body, strands) = (animal(&cones, &places, &corners), fur(&cones, &places, &corners));
    println!("{} vertices, {} bytes; {} strands", places.len(), body.len(), strands.len());
    std::fs::write(folder.join("animal.glb"), body)?;
    std::fs::write(folder.join("animal.data"), data(&strands))?;
    std::fs::write(folder.join("animal.toml"), include_str!("animal.toml"))
}
