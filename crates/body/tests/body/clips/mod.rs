//! Clips of glTF files: vertices at any time, held to an evaluation in double precision that is not ours, and files that
//! are damaged.

mod deep;
mod fast;

use std::path::PathBuf;

use glam::Vec3;
use strandline_base::Random;
use strandline_body::{BodyError, BodyFrame, Mesh, RecordedMotion, VertexMotion};

use crate::damaged::{below, playbacks, rides, times};
use crate::files::{cube_bin, cube_json, glb, scratch};

fn rig() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/body/clips/rig.glb")
}

fn play(path: &std::path::Path, clip: &str) -> Result<(Mesh, VertexMotion, Vec<String>), BodyError> {
    Mesh::load_moving(path, clip)
}

#[test]
fn vertices_are_where_an_independent_evaluation_has_them() {
    let expected = include_str!("expected.txt");
    let mut blocks = 0;
    for block in expected.split("clip ").map(str::trim).filter(|block| !block.is_empty()) {
        // The name of a clip without one begins with the same word.
        let (name, rest) = block.split_once('@').map_or((block, ""), |(name, rest)| (name, rest));
        let name = if name == "3" { "clip 3" } else { name };
        if rest.is_empty() {
            continue;
        }
        let mut lines = rest.lines();
        let time: f64 = lines.next().unwrap().parse().unwrap();
        let (mesh, motion, _) = play(&rig(), name).unwrap();
        let found = motion.positions(time);
        assert_eq!(found.len(), mesh.positions.len());
        assert_eq!(lines.clone().count(), found.len());
        for (vertex, (line, found)) in lines.zip(&found).enumerate() {
            let numbers: Vec<f32> = line.split(' ').map(|number| number.parse().unwrap()).collect();
            let apart = found.distance(Vec3::from_slice(&numbers));
            assert!(apart < 1e-5, "vertex {vertex} of {name} at {time} s is {apart} m away");
        }
        blocks += 1;
    }
    assert_eq!(blocks, 36);
}

#[test]
fn clips_have_names_and_an_unknown_one_lists_them() {
    assert_eq!(Mesh::clip_names(&rig()).unwrap(), ["step", "linear", "spline", "clip 3"]);
    let error = play(&rig(), "walk").unwrap_err().to_string();
    assert!(error.contains("no clip `walk` among `step`, `linear`, `spline`, `clip 3`"), "{error}");
    assert!(error.contains("give one of these names") && !error.contains("export"), "{error}");
    assert!(play(&rig(), "LINEAR").is_ok());
    let (_folder, path) = scratch("cube.glb", &glb(&cube_json("{}", None), &cube_bin()));
    let error = play(&path, "walk").unwrap_err().to_string();
    assert!(error.contains("no clip, and none named `walk`"), "{error}");
    assert!(error.contains("with its animation, or leave the clip out") && !error.contains("OBJ"), "{error}");
    let (_folder, path) = scratch("cube.obj", crate::files::CUBE_OBJ.as_bytes());
    assert!(play(&path, "walk").unwrap_err().to_string().contains("without clips"));
    let (_, _, notes) = play(&rig(), "clip 3").unwrap();
    assert!(
        notes.iter().any(|note| note.contains("1 channel of KHR_animation_pointer is not played")),
        "{notes:?}"
    );
    assert!(notes.iter().any(|note| note.contains("1 of 24 vertices has no weights")), "{notes:?}");
}

#[test]
fn the_mesh_of_a_clip_is_that_of_the_file() {
    let (mesh, motion, _) = play(&rig(), "linear").unwrap();
    let alone = Mesh::load(&rig(), 1.0).unwrap();
    assert_eq!((&mesh.positions, &mesh.triangles), (&alone.positions, &alone.triangles));
    assert_eq!((motion.vertex_count(), motion.end()), (24, 2.0));
}

/// The document of the rig and its bytes.
fn parts() -> (String, Vec<u8>) {
    let bytes = std::fs::read(rig()).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    (String::from_utf8(bytes[20..20 + length].to_vec()).unwrap(), bytes[28 + length..].to_vec())
}

#[test]
fn a_clip_is_not_interpolated_over_a_mark_of_its_extras() {
    let (json, bin) = parts();
    let marked = |marks: &str| {
        let at = json.find("\"linear\"").unwrap() + "\"linear\"".len();
        let document = format!("{},\"extras\":{{\"teleports\":{marks}}}{}", &json[..at], &json[at..]);
        let (folder, path) = scratch("marked.glb", &glb(&document, &bin));
        (folder, play(&path, "linear"))
    };
    let (_, motion, _) = play(&rig(), "linear").unwrap();
    assert!(motion.teleports().is_empty());
    let (_folder, found) = marked("[0.37, 9.0]");
    let (_, jumps, _) = found.unwrap();
    assert_eq!(jumps.teleports(), [0.37, 9.0]);
    let apart = |one: f64, other: f64| {
        let pairs = jumps.positions(one).into_iter().zip(jumps.positions(other));
        pairs.map(|(one, other)| one.distance(other)).fold(0.0, f32::max)
    };
    // All keys lie at 0, 0.5, 1 and 2 s or beside: nothing moves on either side of the mark, and much at it.
    assert!(apart(0.3, 0.369) < 1e-6 && apart(0.37, 0.44) < 1e-6, "held on both sides");
    assert!(apart(0.369, 0.37) > 0.01, "{} m at the mark", apart(0.369, 0.37));
    assert_eq!(jumps.positions(1.5), motion.positions(1.5), "elsewhere as without it");
    for marks in ["0.5", "[\"soon\"]", "[null]", "{}"] {
        let error = marked(marks).1.unwrap_err().to_string();
        assert!(error.contains("the extra `teleports` of the clip `linear`"), "{error}");
    }
}

/// A number of the document replaced by another, or a word left out.
fn mutated(json: &str, random: &mut Random) -> String {
    let digits: Vec<usize> =
        json.match_indices(|letter: char| letter.is_ascii_digit()).map(|(at, _)| at).collect();
    let at = digits[below(random, digits.len())];
    let end = at + json[at..].find(|letter: char| !letter.is_ascii_digit()).unwrap();
    let numbers =
        ["0", "1", "2", "3", "7", "65535", "4294967295", "18446744073709551615", "-1", "1e39", "null", "[]"];
    let number = numbers[below(random, numbers.len())];
    let words = [
        ("\"LINEAR\"", "\"CUBIC\""),
        ("\"STEP\"", "\"CUBICSPLINE\""),
        ("\"CUBICSPLINE\"", "\"LINEAR\""),
        ("\"rotation\"", "\"weights\""),
        ("\"translation\"", "\"rotation\""),
        ("\"VEC3\"", "\"VEC4\""),
        ("\"SCALAR\"", "\"MAT4\""),
        ("\"node\"", "\"mode\""),
        ("\"sampler\"", "\"simpler\""),
        ("\"joints\"", "\"points\""),
        ("\"normalized\":true", "\"normalized\":false"),
        ("\"weights\"", "\"waits\""),
        ("\"byteStride\"", "\"byteStrides\""),
        ("\"input\"", "\"output\""),
        ("\"targets\"", "\"target\""),
    ];
    if below(random, 4) == 0 {
        let (from, to) = words[below(random, words.len())];
        let places: Vec<usize> = json.match_indices(from).map(|(at, _)| at).collect();
        if !places.is_empty() {
            let at = places[below(random, places.len())];
            return format!("{}{to}{}", &json[..at], &json[at + from.len()..]);
        }
    }
    format!("{}{number}{}", &json[..at], &json[end..])
}

/// A thousand damaged skeletons of .bvh: each is refused, or its joint is somewhere.
#[test]
fn damaged_skeletons_are_refused_or_played() {
    const ARM: &str = "HIERARCHY ROOT Hips { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation \
                       Yrotation JOINT Head { OFFSET 0 10 0 CHANNELS 3 Zrotation Xrotation Yrotation End Site { OFFSET 0 \
                       5 0 } } } MOTION Frames: 2 Frame Time: 0.5 1 90 2 0 0 0 0 0 0 1 95 2 90 0 0 0 0 90";
    let others =
        ["0", "-1", "7", "1e308", "-1e308", "nan", "18446744073709551615", "{", "}", "JOINT", "MOTION", ""];
    let mut random = Random::new(35, 2);
    let (mut refused, mut played) = (0, 0);
    for _ in 0..1000 {
        let mut words: Vec<&str> = ARM.split(' ').collect();
        for _ in 0..=below(&mut random, 2) {
            let at = below(&mut random, words.len());
            words[at] = others[below(&mut random, others.len())];
        }
        match RecordedMotion::from_bvh(words.join(" ").as_bytes(), "Head", 0.01) {
            Err(error) => {
                assert!(error.to_string().contains("expected"), "{error}");
                refused += 1;
            }
            Ok(motion) => {
                for playback in playbacks(&mut random) {
                    let motion = motion.clone().with_playback(playback);
                    for time in times(&mut random) {
                        let pose = motion.pose(time, Vec3::Y);
                        let found = BodyFrame::from(pose).check(None, None);
                        assert!(found.is_ok(), "{pose:?} at {time} of {playback:?} of {}", words.join(" "));
                        motion.jumps_until(time);
                    }
                    assert!(motion.gap_of_loop(0.01).is_finite());
                }
                played += 1;
            }
        }
    }
    assert!(refused > 300 && played > 100, "{refused} refused, {played} played");
}

/// A thousand damaged rigs: each is refused, or all its vertices are somewhere.
#[test]
fn damaged_clips_are_refused_or_drawn() {
    let (json, bin) = parts();
    let mut random = Random::new(35, 1);
    let (mut refused, mut drawn) = (0, 0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.glb");
    for _ in 0..1000 {
        let mut document = mutated(&json, &mut random);
        if below(&mut random, 3) == 0 {
            document = mutated(&document, &mut random);
        }
        let mut bytes = bin.clone();
        for _ in 0..below(&mut random, 20) {
            let at = below(&mut random, bytes.len());
            bytes[at] = below(&mut random, 256) as u8;
        }
        std::fs::write(&path, glb(&document, &bytes)).unwrap();
        for clip in ["step", "linear", "spline", "clip 3"] {
            match play(&path, clip) {
                Err(error) => {
                    assert!(error.to_string().contains("expected"), "{error}");
                    refused += 1;
                }
                Ok((mesh, motion, _)) => {
                    rides(&mesh, motion, &mut random);
                    drawn += 1;
                }
            }
        }
    }
    assert!(refused > 300 && drawn > 300, "{refused} refused, {drawn} drawn");
}
