//! Reading bodies: contents and errors of files.

use std::path::Path;

use glam::{Quat, Vec3};
use proptest::prelude::*;
use strandline_body::{BodyError, Mesh, MeshFormat};

use crate::files::{self, CUBE_OBJ, cube_glb, cube_json, load_bytes, scratch};
use crate::shapes;

/// Volume inside the surface \[m^3\]; negative when it is inside out.
fn volume(mesh: &Mesh) -> f32 {
    let corners = mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.positions[corner as usize]));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// Checks the cube from 0 to 1, scaled and moved.
pub fn check_cube(mesh: &Mesh, min: Vec3, size: f32) {
    // Single precision at the places of the cube.
    let rounding = 1e-6 * (min.abs().max_element() + size);
    let bounds = mesh.bounds().unwrap();
    assert!(
        (bounds.min - min).length() < rounding && (bounds.max - min - size).length() < rounding,
        "{bounds:?}"
    );
    assert_eq!(mesh.triangles.len(), 12);
    assert!(mesh.is_closed());
    let moved = Mesh::new(mesh.positions.iter().map(|p| *p - min).collect(), mesh.triangles.clone()).unwrap();
    assert!((volume(&moved) - size.powi(3)).abs() < 1e-5 * size.powi(3), "volume {}", volume(&moved));
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        // At a corner of a cube the three faces have the same angle: the normal is the diagonal.
        let diagonal = (*position - (min + 0.5 * size)).normalize();
        assert!((*normal - diagonal).length() < 1e-5, "{position}: {normal}");
    }
}

/// The error of a file, checked to name the file last.
pub fn refused(name: &str, bytes: &[u8]) -> String {
    let error = load_bytes(name, bytes).unwrap_err().to_string();
    assert!(error.ends_with(name), "the path comes last: {error}");
    error
}

#[test]
fn obj_polygons_become_triangles() {
    let mesh = load_bytes("cube.obj", CUBE_OBJ.as_bytes()).unwrap();
    check_cube(&mesh, Vec3::ZERO, 1.0);
    assert_eq!(mesh.positions.len(), 8);
    let path = scratch("cube.OBJ", CUBE_OBJ.as_bytes());
    check_cube(&Mesh::load(&path.1, 0.01).unwrap(), Vec3::ZERO, 0.01);
}

#[test]
fn obj_groups_and_relative_indices_are_joined() {
    let fifth = CUBE_OBJ.replace("f 5 6 7 8", "o lid\nusemtl skin\nf -4 -3 -2 -1\ng rest\ns 1");
    check_cube(&load_bytes("cube.obj", fifth.as_bytes()).unwrap(), Vec3::ZERO, 1.0);
    let windows = CUBE_OBJ.replace('\n', "\r\n");
    check_cube(&load_bytes("cube.obj", windows.as_bytes()).unwrap(), Vec3::ZERO, 1.0);
}

#[test]
fn obj_byte_order_marks_and_continued_lines_are_read() {
    let marked = format!("\u{FEFF}{}", CUBE_OBJ.trim_start_matches("# a cube\n"));
    check_cube(&load_bytes("cube.obj", marked.as_bytes()).unwrap(), Vec3::ZERO, 1.0);
    for end in ["\\\n", "\\\r\n"] {
        let continued = CUBE_OBJ.replace("f 5 6 7 8", &format!("f 5 6 {end}7 {end} 8"));
        check_cube(&load_bytes("cube.obj", continued.as_bytes()).unwrap(), Vec3::ZERO, 1.0);
    }
}

#[test]
fn obj_normals_are_kept() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nvn 0 0 1\nvt 0 0\nf 1/1/1 2//2 3/1\n";
    let mesh = load_bytes("triangle.obj", text.as_bytes()).unwrap();
    assert!((mesh.normals[0] - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-6);
    assert_eq!(mesh.normals[1], Vec3::Z);
}

#[test]
fn obj_mistakes_are_named() {
    let with = |from: &str, to: &str| refused("cube.obj", CUBE_OBJ.replace(from, to).as_bytes());
    assert!(with("v 1 1 0", "v 1 nan 0").contains("vertex 2"));
    assert!(with("v 1 1 0", "v 1 inf 0").contains("vertex 2"));
    assert!(with("v 1 1 0", "v 1 one 0").contains("position parse error"));
    assert!(with("f 5 6 7 8", "f 5 6 7 9").contains("out of bounds"));
    assert!(with("f 5 6 7 8", "f 5 6 7 0").contains("the index 0, of 8 so far, in line"));
    assert!(with("f 5 6 7 8", "f 5 6 7 -9").contains("the index -9"));
    assert!(with("f 5 6 7 8", "f 5 6 7 9223372036854775807").contains("the index 9223372036854775807"));
    assert!(with("f 5 6 7 8", "f 5/1/1/1 6 7 8").contains("5/1/1/1"));
    assert!(refused("empty.obj", b"").contains("no vertices"));
    assert!(refused("points.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n").contains("no vertices"));
    assert!(
        refused("picture.obj", &[0x89, b'P', b'N', b'G', 0xff, 0xfe])
            .contains("bytes that are not text in line 1")
    );
}

#[test]
fn files_that_are_none_are_refused() {
    let (folder, _) = scratch("cube.obj", b"");
    let missing = folder.path().join("none.obj");
    assert!(matches!(Mesh::load(&missing, 1.0), Err(BodyError::Read { .. })));
    assert!(Mesh::load(folder.path(), 1.0).unwrap_err().to_string().contains("ending"));
    let named = folder.path().join("folder.obj");
    std::fs::create_dir(&named).unwrap();
    assert!(Mesh::load(&named, 1.0).is_err());
    assert!(refused("body.fbx", b"").contains("`fbx`, expected obj, gltf, glb, vrm, ply or stl; open it"));
    for scale in [0.0, -1.0, f32::NAN] {
        assert!(Mesh::load(Path::new("any.obj"), scale).unwrap_err().to_string().contains("scale"));
    }
}

#[test]
fn gltf_is_read_from_all_its_containers() {
    check_cube(&load_bytes("cube.glb", &cube_glb("{}")).unwrap(), Vec3::ZERO, 1.0);
    let inside = cube_json("{}", Some(&files::data_uri()));
    check_cube(&load_bytes("cube.gltf", inside.as_bytes()).unwrap(), Vec3::ZERO, 1.0);
    let beside = cube_json("{}", Some("the%20cube.bin"));
    let (folder, path) = scratch("cube.gltf", beside.as_bytes());
    assert!(Mesh::load(&path, 1.0).unwrap_err().to_string().contains("the cube.bin"));
    std::fs::write(folder.path().join("the cube.bin"), files::cube_bin()).unwrap();
    check_cube(&Mesh::load(&path, 1.0).unwrap(), Vec3::ZERO, 1.0);
}

/// The address is looked at after `%2F` and the like became bytes again, and leads nowhere but below the file.
#[test]
fn gltf_buffers_stay_below_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir_all(inner.join("deeper")).unwrap();
    for path in [folder.path().join("cube.bin"), inner.join("deeper/cube.bin")] {
        std::fs::write(path, files::cube_bin()).unwrap();
    }
    let path = inner.join("cube.gltf");
    let load = |uri: &str| {
        std::fs::write(&path, cube_json("{}", Some(uri))).unwrap();
        Mesh::load(&path, 1.0)
    };
    check_cube(&load("deeper/cube.bin").unwrap(), Vec3::ZERO, 1.0);
    check_cube(&load("deeper%2Fcube.bin").unwrap(), Vec3::ZERO, 1.0);
    let absolute = folder.path().join("cube.bin").display().to_string();
    for uri in [
        "../cube.bin",
        "%2e%2e/cube.bin",
        "..%2Fcube.bin",
        "deeper/../../cube.bin",
        "deeper/%2E./../cube.bin",
        &absolute,
        &absolute.replace('/', "%2F"),
        "%5C%5Chost%5Cshare%5Ccube.bin",
        "..%5Ccube.bin",
        "C%3A%5Ccube.bin",
        "C%3Acube.bin",
        "cube%00.bin",
    ] {
        let error = load(uri).unwrap_err().to_string();
        assert!(error.contains("expected the name of a file beside this one"), "{uri}: {error}");
    }
}

/// An archive that is unpacked may hold links: they lead nowhere but below the file either.
#[cfg(unix)]
#[test]
fn gltf_buffers_follow_no_link_out_of_their_folder() {
    use std::os::unix::fs::symlink;

    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir_all(inner.join("deeper")).unwrap();
    for path in [folder.path().join("cube.bin"), inner.join("deeper/cube.bin")] {
        std::fs::write(path, files::cube_bin()).unwrap();
    }
    symlink("..", inner.join("up")).unwrap();
    symlink(folder.path().join("cube.bin"), inner.join("link.bin")).unwrap();
    symlink("deeper/cube.bin", inner.join("near.bin")).unwrap();
    let load = |uri: &str| {
        let path = inner.join("cube.gltf");
        std::fs::write(&path, cube_json("{}", Some(uri))).unwrap();
        Mesh::load(&path, 1.0)
    };
    check_cube(&load("near.bin").unwrap(), Vec3::ZERO, 1.0);
    for uri in ["up/cube.bin", "link.bin"] {
        let error = load(uri).unwrap_err().to_string();
        assert!(error.contains("expected the name of a file beside this one"), "{uri}: {error}");
    }
}

#[test]
fn normals_are_of_unit_length_however_short_the_file_has_them() {
    for length in ["1e-22", "1e-44", "1e22", "3e38"] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 {length} {length}\nf 1//1 2//1 3//1\n");
        let mesh = load_bytes("triangle.obj", text.as_bytes()).unwrap();
        assert!((mesh.normals[0] - Vec3::new(0.0, 0.5, 0.5).normalize()).length() < 1e-6, "{length}");
    }
    // In a glTF too, below a node that is scaled.
    let json = cube_json(r#"{"scale": [1e3, 1e3, 1e3]}"#, None)
        .replace(r#""POSITION": 0"#, r#""POSITION": 0, "NORMAL": 2"#)
        .replace(
            r#""type": "SCALAR"}"#,
            r#""type": "SCALAR"}, {"bufferView": 2, "componentType": 5126, "count": 8, "type": "VEC3"}"#,
        )
        .replace(
            r#""byteLength": 36}"#,
            r#""byteLength": 36}, {"buffer": 0, "byteOffset": 132, "byteLength": 96}"#,
        )
        .replace(r#""byteLength": 132"#, r#""byteLength": 228"#);
    let mut bin = files::cube_bin();
    (0..8).for_each(|_| [0.0_f32, 0.0, 1e-22].iter().for_each(|number| bin.extend(number.to_le_bytes())));
    let mesh = load_bytes("cube.glb", &files::glb(&json, &bin)).unwrap();
    assert!(mesh.normals.iter().all(|normal| normal.distance(Vec3::Z) < 1e-6), "{:?}", mesh.normals[0]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_is_no_file_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["pipe.obj", "pipe.gltf", "pipe.bin"] {
        assert!(std::process::Command::new("mkfifo").arg(at(name)).status().unwrap().success());
    }
    std::os::unix::fs::symlink("/dev/zero", at("zero.glb")).unwrap();
    std::fs::write(at("cube.gltf"), cube_json("{}", Some("pipe.bin"))).unwrap();
    for name in ["pipe.obj", "pipe.gltf", "zero.glb", "cube.gltf"] {
        let error = Mesh::load(&at(name), 1.0).unwrap_err().to_string();
        assert!(error.contains("a device or a pipe, expected a plain file"), "{error}");
    }
}

#[test]
fn gltf_nodes_place_their_meshes() {
    let moved = cube_glb(r#"{"translation": [1, 2, 3], "scale": [2, 2, 2]}"#);
    check_cube(&load_bytes("cube.glb", &moved).unwrap(), Vec3::new(1.0, 2.0, 3.0), 2.0);
    let [x, y, z, w] = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2).to_array();
    let turned = cube_glb(&format!(r#"{{"rotation": [{x}, {y}, {z}, {w}]}}"#));
    check_cube(&load_bytes("cube.glb", &turned).unwrap(), Vec3::new(0.0, 0.0, -1.0), 1.0);
    let json = cube_json(r#"{"translation": [0, 0, 3]}"#, None).replace(
        r#"{"children": [1]}"#,
        r#"{"children": [1], "translation": [0, 5, 0], "scale": [2, 2, 2]}"#,
    );
    let nested = files::glb(&json, &files::cube_bin());
    check_cube(&load_bytes("cube.glb", &nested).unwrap(), Vec3::new(0.0, 5.0, 6.0), 2.0);
    // A mirror image has its outside outside too.
    let mirrored = cube_glb(r#"{"scale": [-1, 1, 1]}"#);
    check_cube(&load_bytes("cube.glb", &mirrored).unwrap(), Vec3::new(-1.0, 0.0, 0.0), 1.0);
}

#[test]
fn gltf_mistakes_are_named() {
    let with = |from: &str, to: &str| {
        let json = cube_json("{}", None);
        assert!(json.contains(from), "{from}");
        refused("cube.glb", &files::glb(&json.replace(from, to), &files::cube_bin()))
    };
    assert!(with(r#""count": 36"#, r#""count": 37"#).contains("accessor 1 beyond its buffer"));
    assert!(
        with(r#""count": 36"#, r#""count": 18446744073709551615"#).contains("accessor 1 beyond its buffer")
    );
    assert!(
        with(r#""byteLength": 96"#, r#""byteLength": 18446744073709551615"#).contains("beyond its buffer")
    );
    assert!(
        with(r#""componentType": 5126"#, r#""componentType": 5125"#).contains("accessor 0 of other numbers")
    );
    assert!(with(r#""count": 36"#, r#""count": 0"#).contains("no triangles"));
    assert!(with(r#""mesh": 0"#, r#""mesh": 1"#).contains("bad glTF"));
    assert!(with(r#""version": "2.0""#, r#""version": "#).contains("bad glTF"));
    assert!(with(r#""mesh": 0"#, r#""mesh": 0, "children": [0]"#).contains("node 0 twice in a scene"));
    assert!(with(r#"{"children": [1]}"#, r#"{"children": [1, 1]}"#).contains("node 1 below two others"));
    for uri in ["%FF.bin", "%F", "http://x/y.bin", "/etc/hostname", "%C3%28", ""] {
        let json = cube_json("{}", Some(uri));
        assert!(refused("cube.gltf", json.as_bytes()).contains("buffer 0"), "{uri}");
    }
    let mut bytes = cube_glb("{}");
    bytes[8..12].copy_from_slice(&3u32.to_le_bytes());
    assert!(refused("cube.glb", &bytes).contains("says it has 3"));
    let bytes = cube_glb("{}");
    assert!(refused("cube.glb", &bytes[..bytes.len() - 1]).contains("expected the whole file"));
    assert!(refused("cube.glb", b"glTF").contains("a file of 4 bytes"));
    assert!(refused("cube.gltf", b"").contains("bad glTF"));
    let mut far = files::cube_bin();
    far[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(refused("cube.glb", &files::glb(&cube_json("{}", None), &far)).contains("vertex 0"));
    far = files::cube_bin();
    far[96] = 8;
    let error = refused("cube.glb", &files::glb(&cube_json("{}", None), &far));
    assert!(error.contains("an index beyond the 8 vertices"), "{error}");
}

#[test]
fn real_heads_are_read() {
    for (name, triangle_count) in [("bust/hm08_bust_female.obj", 9376), ("sintel/sintel.obj", 5952)] {
        let Some(path) = shapes::supplied(name) else { return };
        let mesh = Mesh::load(&path, 1.0).unwrap();
        assert_eq!(mesh.triangles.len(), triangle_count);
        check_sound(&mesh);
    }
}

/// Checks the promises of every loaded mesh.
fn check_sound(mesh: &Mesh) {
    assert!(!mesh.triangles.is_empty());
    assert_eq!(mesh.positions.len(), mesh.normals.len());
    assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < mesh.positions.len()));
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5));
    assert!(mesh.closed().is_closed());
}

/// A mesh that many nodes place again makes much of a small file.
#[test]
fn repetition_in_a_small_gltf_is_limited() {
    let repeated = |nodes: usize| {
        let roots = (0..nodes).map(|node| node.to_string()).collect::<Vec<_>>().join(",");
        let part = r#"{"attributes": {"POSITION": 0}, "indices": 1}"#;
        let json = cube_json("{}", None)
            .replace(r#""nodes": [0]"#, &format!(r#""nodes": [{roots}]"#))
            .replace(r#"{"children": [1]}, {"mesh": 0, "skin": 0}"#, &vec![r#"{"mesh": 0}"#; nodes].join(","))
            .replace(r#""skins": [{"joints": [0]}],"#, "")
            .replace(part, &vec![part; 50].join(","));
        files::glb(&json, &files::cube_bin())
    };
    // 600 triangles for each node: 65,536 are the most for so small a file.
    for nodes in [20, 109] {
        assert_eq!(
            Mesh::from_bytes(&repeated(nodes), MeshFormat::Gltf).unwrap().triangles.len(),
            600 * nodes
        );
    }
    let refused = Mesh::from_bytes(&repeated(110), MeshFormat::Gltf).map(|mesh| mesh.triangles.len());
    assert!(refused.unwrap_err().to_string().contains("more than 65536 vertices or triangles"));
}

/// Damage to a file: bytes replaced, taken out and put in, and an early end.
pub fn damage() -> impl Strategy<Value = Vec<(u8, prop::sample::Index, u8)>> {
    // Digits, signs and separators find more than arbitrary bytes do.
    let byte = prop_oneof![prop::sample::select(b"0123456789-./eEfvn \n{}[],\":%".to_vec()), any::<u8>()];
    prop::collection::vec((0u8..4, any::<prop::sample::Index>(), byte), 1..8)
}

pub fn damaged(bytes: &[u8], damage: &[(u8, prop::sample::Index, u8)]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for (kind, place, byte) in damage {
        if bytes.is_empty() {
            break;
        }
        let place = place.index(bytes.len());
        match kind {
            0 | 1 => bytes[place] = *byte,
            2 => bytes.insert(place, *byte),
            _ if place > bytes.len() / 2 => bytes.truncate(place),
            _ => drop(bytes.remove(place)),
        }
    }
    bytes
}

pub fn check_damaged(name: &str, bytes: &[u8]) {
    match load_bytes(name, bytes) {
        Ok(mesh) => check_sound(&mesh),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_damaged_obj_does_no_harm(damage in damage()) {
        let text = format!("{CUBE_OBJ}vt 0 0\nvn 0 0 1\nf 1/1/1 2//1 -2/-1/-1\ng part\nusemtl skin\nf 1 2 3 4 5\n");
        check_damaged("cube.obj", &damaged(text.as_bytes(), &damage));
    }

    #[test]
    fn a_damaged_glb_does_no_harm(damage in damage()) {
        check_damaged("cube.glb", &damaged(&cube_glb(r#"{"scale": [2, 1, 1]}"#), &damage));
    }

    #[test]
    fn a_damaged_gltf_does_no_harm(damage in damage()) {
        let json = cube_json(r#"{"rotation": [0, 0, 0, 1]}"#, Some(&files::data_uri()));
        check_damaged("cube.gltf", &damaged(json.as_bytes(), &damage));
    }

    #[test]
    fn any_bytes_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for name in ["any.obj", "any.glb", "any.gltf", "any.ply", "any.stl"] {
            check_damaged(name, &bytes);
        }
    }
}
