//! Clips whose nodes turn far between two keys, in which the load looks for jumps.

use glam::{Quat, Vec3};
use strandline_body::{Playback, SkinMotion};

use super::play;
use crate::files::{glb, scratch};

/// Vertices, keys, keys of a clip that is searched in part, and seconds between two keys.
const VERTICES: usize = 3000;
const KEYS: usize = 1400;
const MANY: usize = (1 << 16) + 11;
const SECONDS: f32 = 0.02;

/// A mesh that turns by half a circle between each two of some keys.
fn flips(keys: usize) -> Vec<u8> {
    let place = |index: usize| [index % 7, index / 7 % 11, index / 77].map(|number| 0.01 * number as f32);
    let places: Vec<u8> = (0..VERTICES).flat_map(place).flat_map(f32::to_le_bytes).collect();
    let corners: Vec<u8> = (0..VERTICES as u16).flat_map(u16::to_le_bytes).collect();
    let times: Vec<u8> = (0..keys).flat_map(|key| (SECONDS * key as f32).to_le_bytes()).collect();
    let turn =
        |key: usize| if key.is_multiple_of(2) { [0.0, 0.0, 0.0, 1.0_f32] } else { [0.0, 1.0, 0.0, 0.0] };
    let turns: Vec<u8> = (0..keys).flat_map(turn).flat_map(f32::to_le_bytes).collect();
    let parts = [places, corners, times, turns];
    let (mut views, mut first) = (Vec::new(), 0);
    for part in &parts {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{first},"byteLength":{}}}"#, part.len()));
        first += part.len();
    }
    let end = SECONDS * (keys - 1) as f32;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":{VERTICES},"type":"VEC3","min":[0,0,0],"max":[0.07,0.11,0.4]}},
{{"bufferView":1,"componentType":5123,"count":{VERTICES},"type":"SCALAR"}},
{{"bufferView":2,"componentType":5126,"count":{keys},"type":"SCALAR","min":[0],"max":[{end}]}},
{{"bufferView":3,"componentType":5126,"count":{keys},"type":"VEC4"}}],
"animations":[{{"name":"flips","samplers":[{{"input":2,"output":3}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"rotation"}}}}]}}],
"bufferViews":[{}],"buffers":[{{"byteLength":{first}}}]}}"#,
        views.join(",")
    );
    glb(&json, &parts.concat())
}

#[test]
fn jumps_of_a_clip_are_found_by_few_vertices() {
    let (_folder, path) = scratch("flips.glb", &flips(KEYS));
    let (mesh, motion, notes) = play(&path, "flips").unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let placing = (1.0, Quat::IDENTITY);
    let body = SkinMotion::new(motion.clone(), Playback::default(), &mesh.positions, placing, &[]).unwrap();
    // All at rest, and 64 at each key.
    let most = (VERTICES + 64 * KEYS) as u64;
    assert!((1..=most).contains(&motion.placed_count()), "{} vertices placed", motion.placed_count());
    let [held, turned] = [0.019, 0.021].map(|time| body.frame(time));
    assert!(held.jumps_to(&turned), "each half turn is a jump");
    assert_eq!(held.world_from_head().direction(Vec3::X), Vec3::X);
    let time = f64::from(SECONDS) * (KEYS - 1) as f64;
    let [held, turned] = [time - 0.001, time + 0.001].map(|time| body.frame(time));
    assert!(held.jumps_to(&turned), "the last one too");
}

#[test]
fn a_clip_that_is_searched_in_part_is_told() {
    let (_folder, path) = scratch("flips.glb", &flips(MANY));
    let (_, _, notes) = play(&path, "flips").unwrap();
    let [note] = &notes[..] else { panic!("one note: {notes:?}") };
    assert!(note.starts_with("10 of 65546 spans between keys far apart are not searched"), "{note}");
}
