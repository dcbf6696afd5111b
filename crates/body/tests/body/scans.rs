//! Meshes of scanners and printers: .ply and .stl.

use glam::Vec3;
use proptest::prelude::*;

use crate::files::{CUBE_OBJ, load_bytes};
use crate::mesh_files::{check_cube, check_damaged, damage, damaged, refused};

/// Corners and quads of the cube, from its text.
fn cube() -> (Vec<[f32; 3]>, Vec<[u32; 4]>) {
    let rows = |word: &'static str| CUBE_OBJ.lines().filter_map(move |line| line.strip_prefix(word));
    let numbers = |line: &str| line.split_whitespace().map(|n| n.parse::<f32>().unwrap()).collect::<Vec<_>>();
    let corners = rows("v ").map(|line| numbers(line).try_into().unwrap()).collect();
    let quads = rows("f ").map(|line| {
        let corners: Vec<u32> = numbers(line).iter().map(|corner| *corner as u32 - 1).collect();
        corners.try_into().unwrap()
    });
    (corners, quads.collect())
}

fn ply(encoding: &str, list: &str) -> Vec<u8> {
    let (corners, quads) = cube();
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\ncomment a scan\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nproperty uchar red\nelement face {}\nproperty list uchar int {list}\nend_header\n",
        corners.len(),
        quads.len()
    )
    .into_bytes();
    let is_big = encoding.contains("big");
    let put = |bytes: &mut Vec<u8>, mut number: [u8; 4]| {
        if is_big {
            number.reverse();
        }
        bytes.extend(number);
    };
    for corner in corners {
        if encoding == "ascii" {
            bytes.extend(format!("{} {} {} 9\n", corner[0], corner[1], corner[2]).bytes());
            continue;
        }
        corner.iter().for_each(|number| put(&mut bytes, number.to_le_bytes()));
        bytes.push(9);
    }
    for quad in quads {
        if encoding == "ascii" {
            bytes.extend(format!("4 {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]).bytes());
            continue;
        }
        bytes.push(4);
        quad.iter().for_each(|number| put(&mut bytes, number.to_le_bytes()));
    }
    bytes
}

/// The triangles of the cube as places.
fn triangles() -> Vec<[[f32; 3]; 3]> {
    let (corners, quads) = cube();
    let places = |three: [u32; 3]| three.map(|corner| corners[corner as usize]);
    quads.iter().flat_map(|&[a, b, c, d]| [places([a, b, c]), places([a, c, d])]).collect()
}

fn binary_stl(head: &[u8]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, 0);
    bytes.extend(12_u32.to_le_bytes());
    for corners in triangles() {
        bytes.extend([0; 12]);
        corners.as_flattened().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn text_stl() -> String {
    let facet = |[a, b, c]: [[f32; 3]; 3]| {
        let vertex = |[x, y, z]: [f32; 3]| format!("      vertex {x:e} {y:e} {z:e}\n");
        let vertices = [a, b, c].map(vertex).concat();
        format!("  facet normal 0 0 0\n    outer loop\n{vertices}    endloop\n  endfacet\n")
    };
    format!("solid a vertex cube\n{}endsolid\n", triangles().into_iter().map(facet).collect::<String>())
}

#[test]
fn ply_meshes_are_read_in_every_encoding() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for list in ["vertex_indices", "vertex_index"] {
            let mesh = load_bytes("cube.ply", &ply(encoding, list)).unwrap();
            check_cube(&mesh, Vec3::ZERO, 1.0);
        }
    }
    let windows = String::from_utf8(ply("ascii", "vertex_index")).unwrap().replace('\n', "\r\n");
    check_cube(&load_bytes("cube.ply", format!("\u{FEFF}{windows}").as_bytes()).unwrap(), Vec3::ZERO, 1.0);
}

/// The cube as one list of six strips, with corners before them that make no triangles.
fn strips(idle: usize) -> String {
    let (corners, quads) = cube();
    let corners: String = corners.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let list: String = quads.iter().map(|[a, b, c, d]| format!(" {a} {b} {d} {c} -1")).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
         element tristrips 1\nproperty list int int vertex_indices\nend_header\n{corners}{}{}{list}\n",
        idle + 30,
        " 0".repeat(idle)
    )
}

#[test]
fn ply_strips_of_triangles_are_read() {
    for idle in [0, 2, 5000] {
        let mesh = load_bytes("cube.ply", strips(idle).as_bytes());
        // An odd strip begins the other way round.
        check_cube(&mesh.unwrap(), Vec3::ZERO, 1.0);
    }
    let text = strips(0);
    let with = |from: &str, to: &str| refused("cube.ply", text.replace(from, to).as_bytes());
    assert!(with(" -1 ", " 8 ").contains("a face with the vertex 8 of 8"));
    assert!(with("\n30 ", "\n3000000000 ").contains("a list of 3000000000 numbers, expected 0 to"));
}

#[test]
fn ply_mistakes_are_named() {
    let text = String::from_utf8(ply("ascii", "vertex_indices")).unwrap();
    let with = |from: &str, to: &str| refused("cube.ply", text.replace(from, to).as_bytes());
    assert!(with("element face 6", "element face 0").contains("8 points and no faces"));
    assert!(with("4 0 3 2 1", "4 0 3 2 8").contains("a face with the vertex 8 of 8"));
    assert!(with("4 0 3 2 1", "4 0 3 2 -1").contains("a face with the vertex -1 of 8"));
    assert!(with("property float z", "property float w").contains("no coordinates"));
    assert!(with("element vertex 8", "element vertex 4000000000").contains("rows of"));
    assert!(with("1 1 1 9", "1 nan 1 9").contains("vertex 6"));
    assert!(with("ply\n", "off\n").contains("starts with `off"));
}

#[test]
fn stl_meshes_are_read_as_text_and_binary() {
    let text = text_stl();
    // Binary files of some programs begin as those of text do.
    for bytes in [
        binary_stl(b""),
        binary_stl(b"solid facet"),
        text.clone().into_bytes(),
        format!("\u{FEFF}{text}").into_bytes(),
    ] {
        let mesh = load_bytes("cube.stl", &bytes).unwrap();
        check_cube(&mesh, Vec3::ZERO, 1.0);
        assert_eq!(mesh.positions.len(), 8, "corners at one place are one vertex");
    }
}

#[test]
fn stl_mistakes_are_named() {
    let bytes = binary_stl(b"");
    assert!(refused("cube.stl", &bytes[..bytes.len() - 1]).contains("an STL file"));
    assert!(refused("cube.stl", b"").contains("an STL file"));
    assert!(refused("cube.stl", &binary_stl(b"")[..84]).contains("an STL file"));
    let with = |from: &str, to: &str| refused("cube.stl", text_stl().replacen(from, to, 1).as_bytes());
    assert!(with("vertex 0e0 0e0 0e0", "vertex 0e0 0e0").contains("line 4"));
    assert!(with("vertex 0e0 0e0 0e0", "vertex 0e0 and 0e0 0e0").contains("line 4"));
    assert!(with("vertex 0e0 0e0 0e0\n", "\n").contains("other than three vertices"));
    assert!(with("vertex 0e0 0e0 0e0", "vertex nan 0 0").contains("vertex 0"));
    assert!(refused("empty.stl", b"solid\nendsolid\n").contains("no vertices"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn a_damaged_scan_does_no_harm(damage in damage(), kind in 0_usize..4) {
        let (name, bytes) = [
            ("cube.ply", ply("ascii", "vertex_indices")),
            ("cube.ply", ply("binary_big_endian", "vertex_indices")),
            ("cube.stl", text_stl().into_bytes()),
            ("cube.stl", binary_stl(b"solid")),
        ].into_iter().nth(kind).unwrap();
        check_damaged(name, &damaged(&bytes, &damage));
    }
}
