//! Shared by the examples that write a rigged glTF: the surface of a field as triangles, and the parts of a file.

#![allow(dead_code)] // each example uses a part

use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::{UVec3, Vec3};
use strandline_base::math;

/// A channel of a clip: node, path, kind of numbers and values of all keys.
pub type Channel<'a> = (usize, &'a str, &'a str, Vec<f32>);

/// The parts of the file: bytes, and the views and accessors over them as text.
#[derive(Default)]
pub struct Parts {
    pub bytes: Vec<u8>,
    pub views: Vec<String>,
    pub accessors: Vec<String>,
}

impl Parts {
    pub fn view(&mut self, bytes: &[u8], stride: usize) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bytes.len(), bytes.len());
        let stride = if stride > 0 { format!(r#","byteStride":{stride}"#) } else { String::new() };
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}{stride}}}"#));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    pub fn accessor(&mut self, bytes: &[u8], stride: usize, members: &str) -> usize {
        let view = self.view(bytes, stride);
        self.accessors.push(format!(r#"{{"bufferView":{view},{members}}}"#));
        self.accessors.len() - 1
    }

    pub fn floats(&mut self, numbers: &[f32], kind: &str, more: &str) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let count = numbers.len() / width;
        let members = format!(r#""componentType":5126,"count":{count},"type":"{kind}"{more}"#);
        self.accessor(&bytes, 0, &members)
    }

    /// A clip whose channels rest at every key: a name, times \[s\], and nodes with path, kind and values.
    pub fn clip(&mut self, name: &str, times: &[f32], channels: &[Channel]) -> String {
        self.clip_by("CUBICSPLINE", name, times, channels)
    }

    /// The same with another interpolation than that of resting keys: "LINEAR" or "STEP".
    pub fn clip_by(&mut self, way: &str, name: &str, times: &[f32], channels: &[Channel]) -> String {
        let last = times[times.len() - 1];
        let input = self.floats(times, "SCALAR", &format!(r#","min":[0],"max":[{last}]"#));
        let (mut samplers, mut targets) = (Vec::new(), Vec::new());
        for (index, (node, path, kind, values)) in channels.iter().enumerate() {
            let width = values.len() / times.len();
            let rest = if way == "CUBICSPLINE" { vec![0.0; width] } else { Vec::new() };
            let keys: Vec<f32> =
                values.chunks(width).flat_map(|value| [&rest[..], value, &rest[..]].concat()).collect();
            let output = self.floats(&keys, kind, "");
            samplers.push(format!(r#"{{"input":{input},"output":{output},"interpolation":"{way}"}}"#));
            targets.push(format!(r#"{{"sampler":{index},"target":{{"node":{node},"path":"{path}"}}}}"#));
        }
        let (samplers, targets) = (samplers.join(","), targets.join(","));
        format!(r#"{{"name":"{name}","samplers":[{samplers}],"channels":[{targets}]}}"#)
    }
}

/// Rotations about pitch and yaw \[degrees\] and roll, one behind the other.
pub fn turns(degrees: &[[f32; 3]]) -> Vec<f32> {
    degrees.iter().flat_map(|degrees| math::pitch_yaw_roll(Vec3::from(*degrees)).to_array()).collect()
}

/// Joints as nodes of a skeleton, from names, the joint above each and places \[m\].
pub fn joint_nodes(joints: &[(&str, Option<usize>, Vec3)]) -> Vec<String> {
    let joint = |(index, (name, above, place)): (usize, &(&str, Option<usize>, Vec3))| {
        let from = above.map_or(Vec3::ZERO, |above| joints[above].2);
        let Vec3 { x, y, z } = *place - from;
        let below: Vec<String> = (joints.iter().enumerate())
            .filter(|(_, joint)| joint.1 == Some(index))
            .map(|(below, _)| below.to_string())
            .collect();
        let children =
            if below.is_empty() { String::new() } else { format!(r#","children":[{}]"#, below.join(",")) };
        format!(r#"{{"name":"{name}","translation":[{x},{y},{z}]{children}}}"#)
    };
    joints.iter().enumerate().map(joint).collect()
}

/// The places and corners of triangles of the zero surface of a field, sampled over a box \[m\] at a spacing \[m\].
pub fn surface(field: impl Fn(Vec3) -> f32, [low, high]: [Vec3; 2], spacing: f32) -> (Vec<Vec3>, Vec<u32>) {
    let origin = low - Vec3::splat(2.0 * spacing);
    let size = ((high - origin) / spacing).as_uvec3() + UVec3::splat(4);
    let place = |index: u32| {
        let cell = UVec3::new(index % size.x, index / size.x % size.y, index / (size.x * size.y));
        origin + cell.as_vec3() * spacing
    };
    let samples: Vec<f32> = (0..size.x * size.y * size.z).map(|index| field(place(index))).collect();
    let mut buffer = SurfaceNetsBuffer::default();
    let shape = RuntimeShape::<u32, 3>::new(size.to_array());
    surface_nets(&samples, &shape, [0; 3], (size - UVec3::ONE).to_array(), &mut buffer);
    let places = buffer.positions.iter().map(|cell| origin + Vec3::from_array(*cell) * spacing);
    (places.collect(), buffer.indices)
}

/// A binary glTF.
pub fn container(mut json: Vec<u8>, mut bytes: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let number = |number: usize| (number as u32).to_le_bytes();
    let total = number(28 + json.len() + bytes.len());
    [
        b"glTF",
        &number(2)[..],
        &total,
        &number(json.len()),
        b"JSON",
        &json,
        &number(bytes.len()),
        b"BIN\0",
        &bytes,
    ]
    .concat()
}
