//! Skins that a motion turns inside out, mirror images of those at rest: hair stays outside.

use std::sync::Arc;

use glam::{Quat, Vec3, vec3};
use strandline_body::{BodyFrame, Mesh, PosedSkin, SkinRoots};

use crate::files::{cube_bin, cube_json, glb, scratch};
use crate::posed_skin::{solid, tube};

fn turn() -> Quat {
    Quat::from_axis_angle(vec3(0.6, 0.0, 0.8), 0.9)
}

/// A mirror image, turned, displaced and smaller.
fn mirrored(place: Vec3) -> Vec3 {
    turn() * (0.8 * vec3(-place.x, place.y, place.z)) + Vec3::splat(0.1)
}

fn skin(mesh: &Mesh, motion: impl Fn(Vec3) -> Vec3) -> Arc<[Vec3]> {
    mesh.positions.iter().map(|place| motion(*place)).collect()
}

/// Places around the side of the tube, with the directions out of it there.
fn around() -> impl Iterator<Item = (Vec3, Vec3)> {
    (0..60).map(|index| {
        let angle = 0.31 * index as f32;
        let out = vec3(angle.cos(), 0.0, angle.sin());
        (0.05 * out + Vec3::Y * (0.05 + 0.005 * index as f32), out)
    })
}

#[test]
fn roots_keep_their_strands_outside() {
    let mesh = tube();
    let (places, outs): (Vec<Vec3>, Vec<Vec3>) = around().unzip();
    let roots = SkinRoots::new(&mesh, &places);
    let placed = |skin: Arc<[Vec3]>| roots.placed(BodyFrame::REST.with_skin(skin), &BodyFrame::REST);
    let frame = placed(skin(&mesh, mirrored));
    for (index, (place, out)) in places.iter().zip(&outs).enumerate() {
        let (found, expected) = (frame.root(index), turn() * vec3(-out.x, out.y, out.z));
        assert!(found.direction(*out).dot(expected) > 0.99, "root {index} leans {}", found.direction(*out));
        // The chords of the tube lie within it by up to 0.2 mm.
        assert!(found.point(*place).distance(mirrored(*place)) < 4e-4, "root {index}");
    }
    // A sound motion is turned by nothing.
    let sound = placed(skin(&mesh, |place| turn() * place));
    assert!((0..places.len()).all(|index| sound.root(index).rotation.angle_between(turn()) < 1e-3));
}

#[test]
fn contacts_keep_their_side_through_a_step_that_turns_the_skin_over() {
    let mesh = tube();
    let solid = solid(&mesh, 0.01);
    let (rest, over) = (skin(&mesh, |place| place), skin(&mesh, mirrored));
    let near = skin(&mesh, |place| mirrored(place) + Vec3::X * 0.002);
    let posed =
        |start: &Arc<[Vec3]>, end: &Arc<[Vec3]>| PosedSkin::new(&solid, [Some(start), Some(end)]).unwrap();
    for skin in [posed(&rest, &over), posed(&over, &over)] {
        for (place, out) in around() {
            for height in [-0.02, -0.004, 0.004, 0.05] {
                let point = mirrored(place + height * out);
                let found = skin.nearest(point, PosedSkin::UNKNOWN);
                assert_eq!(found.distance < 0.0, height < 0.0, "{height}: {} at {point}", found.distance);
                assert_eq!(skin.depth(point, PosedSkin::UNKNOWN) > 0.0, height < 0.0, "{height}");
                let outward = turn() * vec3(-out.x, out.y, out.z);
                assert!(found.normal.dot(outward) > 0.9, "{height}: {} for {outward}", found.normal);
            }
        }
    }
    let (place, _) = around().next().unwrap();
    let triangle = posed(&over, &near).nearest(mirrored(place), PosedSkin::UNKNOWN).triangle;
    assert!(posed(&over, &near).motion(triangle, mirrored(place)).is_some());
    for [start, end] in [[&rest, &over], [&over, &rest]] {
        assert!(posed(start, end).motion(triangle, place).is_none(), "nothing carries a plane over");
    }
}

/// A cube under a node whose scale goes from 1 to these factors in a second.
fn scaled(factors: [f32; 3]) -> Vec<String> {
    let json = cube_json("", None);
    let (before, after) = json.rsplit_once("\"buffers\": [{\"byteLength\": 132}]").unwrap();
    let before = before.replace(
        "\"accessors\": [",
        "\"accessors\": [
 {\"bufferView\": 2, \"componentType\": 5126, \"count\": 2, \"type\": \"SCALAR\"},
 {\"bufferView\": 3, \"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"},",
    );
    // Two accessors come first now.
    let before =
        before.replace("\"POSITION\": 0", "\"POSITION\": 2").replace("\"indices\": 1", "\"indices\": 3");
    let before = before.replace(
        "\"byteLength\": 36}]",
        "\"byteLength\": 36}, {\"buffer\": 0, \"byteOffset\": 132, \"byteLength\": 8},
 {\"buffer\": 0, \"byteOffset\": 140, \"byteLength\": 24}]",
    );
    let clip = "\"animations\": [{\"name\": \"turn\", \"samplers\": [{\"input\": 0, \"output\": 1}],
 \"channels\": [{\"sampler\": 0, \"target\": {\"node\": 1, \"path\": \"scale\"}}]}],
\"buffers\": [{\"byteLength\": 164}]";
    let numbers = [0.0, 1.0, 1.0, 1.0, 1.0].into_iter().chain(factors);
    let bin = [cube_bin(), numbers.flat_map(f32::to_le_bytes).collect()].concat();
    let json = format!("{before}{clip}{after}")
        .replace("\"mesh\": 0, \"skin\": 0", "\"mesh\": 0, \"name\": \"box\"");
    let (_folder, path) = scratch("cube.glb", &glb(&json, &bin));
    Mesh::load_moving(&path, "turn").unwrap().2
}

#[test]
fn a_clip_that_mirrors_a_node_is_told() {
    let notes = scaled([-1.0, 1.0, 1.0]).join("\n");
    assert!(notes.contains("what `box` carries inside out at 1.00 s"), "{notes}");
    for sound in [[2.0, 1.0, 1.0], [-1.0, -1.0, 1.0]] {
        assert!(scaled(sound).is_empty(), "{sound:?}");
    }
}
