//! Vertices over time: arrays of numpy and meshes one behind the other.

use std::path::Path;

use glam::Vec3;
use strandline_base::npz::{self, Array};
use strandline_body::{BodyError, Mesh, VertexMotion};

use crate::files::{CUBE_OBJ, scratch};

/// The cube whose upper half rises by a metre a frame, in the order of its file.
fn frames(count: usize) -> Vec<Vec<Vec3>> {
    let corners: Vec<Vec3> = CUBE_OBJ
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| {
            let numbers: Vec<f32> = line.split(' ').map(|number| number.parse().unwrap()).collect();
            Vec3::from_slice(&numbers)
        })
        .collect();
    let at = |frame: usize| {
        let place = |corner: &Vec3| *corner + Vec3::Y * corner.y * frame as f32;
        corners.iter().map(place).collect()
    };
    (0..count).map(at).collect()
}

pub fn numbers(count: usize) -> Vec<f32> {
    frames(count).iter().flatten().flat_map(Vec3::to_array).collect()
}

/// The triangles of the cube in the order of its file.
pub fn faces() -> Vec<u32> {
    let quads = CUBE_OBJ.lines().filter_map(|line| line.strip_prefix("f "));
    let corners =
        |line: &str| line.split(' ').map(|word| word.parse::<u32>().unwrap() - 1).collect::<Vec<_>>();
    quads.map(corners).flat_map(|q| [q[0], q[1], q[2], q[0], q[2], q[3]]).collect()
}

/// Every vertex of a mesh is where its own motion has it: the upper ones rise with time by a rate [m/s].
fn check(mesh: &Mesh, motion: &VertexMotion, rate: f32, end: f64) {
    assert_eq!(motion.end(), end);
    for time in [-1.0, 0.0, 0.3 * end, end, end + 1.0] {
        let share = time.clamp(0.0, end) as f32;
        for (rest, found) in mesh.positions.iter().zip(motion.positions(time)) {
            assert!(
                found.distance(*rest + Vec3::Y * rest.y * rate * share) < 1e-5,
                "{rest} at {time}: {found}"
            );
        }
    }
}

fn load(path: &Path, mesh: &Path) -> Result<VertexMotion, BodyError> {
    VertexMotion::load(path, &Mesh::load(mesh, 1.0).unwrap(), Some(mesh), 2.0)
}

#[test]
fn arrays_move_a_mesh_in_the_order_of_its_file() {
    let (folder, obj) = scratch("cube.obj", CUBE_OBJ.as_bytes());
    let mesh = Mesh::load(&obj, 1.0).unwrap();
    let in_file = &frames(1)[0];
    assert_ne!(&mesh.positions, in_file, "the reader has an order of its own");
    let path = folder.path().join("walk.npy");
    std::fs::write(&path, Array::f32s("v", &[3, 8, 3], numbers(3)).npy()).unwrap();
    check(&mesh, &load(&path, &obj).unwrap(), 2.0, 1.0);
    std::fs::write(&path, Array::f64s("v", &[3, 24], numbers(3).into_iter().map(f64::from)).npy()).unwrap();
    check(&mesh, &load(&path, &obj).unwrap(), 2.0, 1.0);
    let path = folder.path().join("walk.npz");
    let verts = Array::f32s("verts", &[3, 8, 3], numbers(3));
    std::fs::write(&path, npz::pack(&[verts, Array::f64s("mocap_framerate", &[], [4.0])])).unwrap();
    check(&mesh, &load(&path, &obj).unwrap(), 4.0, 0.5);
}

#[test]
fn an_archive_with_faces_is_a_mesh_in_motion() {
    let path = |arrays: &[Array]| scratch("walk.npz", &npz::pack(arrays));
    let vertices = || Array::f32s("vertices", &[3, 8, 3], numbers(3));
    let faces = || Array::u32s("f", &[12, 3], faces());
    let (_folder, whole) = path(&[vertices(), faces(), Array::f64s("times", &[3], [0.0, 2.0, 4.0])]);
    assert!(Mesh::is_sequence(&whole));
    let (mesh, motion) = Mesh::load_sequence(&whole, 1.0).unwrap();
    assert_eq!((&mesh.positions, mesh.triangles.len()), (&frames(1)[0], 12));
    check(&mesh, &motion, 0.5, 4.0);
    let marks = || Array::f64s("teleports", &[2], [3.0, 1.0]);
    let (_folder, marked) =
        path(&[vertices(), faces(), Array::f64s("times", &[3], [0.0, 2.0, 4.0]), marks()]);
    let (_, marked) = Mesh::load_sequence(&marked, 1.0).unwrap();
    assert_eq!(marked.teleports(), [1.0, 3.0]);
    let held = [0.0, 0.99, 1.0, 2.99, 3.0].map(|time| marked.positions(time));
    assert!(held[0] == held[1] && held[1] != held[2] && held[2] == held[3] && held[3] != held[4]);
    let refused = |arrays: &[Array], words: &str| {
        let (_folder, path) = path(arrays);
        let error = Mesh::load_sequence(&path, 1.0).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(&[vertices()], "no faces");
    refused(&[faces(), Array::f64s("poses", &[1, 156], [0.0; 156])], "poses of a body model and no vertices");
    refused(&[faces(), Array::f32s("v", &[3, 8], numbers(1))], "vertices of shape [3, 8]");
    refused(
        &[vertices(), faces(), Array::f64s("times", &[2], [0.0, 2.0])],
        "times of shape [2] for 3 frames",
    );
    refused(&[vertices(), faces(), Array::f64s("times", &[3], [0.0, 2.0, 1.0])], "not rising");
    refused(&[vertices(), faces(), Array::f64s("fps", &[], [0.0])], "a rate of 0");
    refused(&[vertices(), faces(), Array::f64s("teleports", &[1], [f64::NAN])], "the time of a teleport");
    refused(&[vertices(), Array::u32s("f", &[1, 3], [0, 1, 8])], "between the vertices 0, 1, 8 of 8");
    refused(&[vertices(), Array::f32s("f", &[1, 3], [0.0, 1.0, 2.5])], "faces of shape [1, 3]");
    let (_folder, obj) = scratch("cube.obj", CUBE_OBJ.as_bytes());
    let (_folder, few) = path(&[Array::f32s("v", &[1, 7, 3], numbers(1)[..21].to_vec())]);
    assert!(load(&few, &obj).unwrap_err().to_string().contains("7 vertices in a frame, for a mesh of 8"));
}

#[test]
fn files_of_one_topology_are_a_mesh_in_motion() {
    let [folder, unpadded] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let faces = &CUBE_OBJ[CUBE_OBJ.find("f 1").unwrap()..];
    // A file is missing: the motion goes on evenly.
    for (number, frame) in frames(4).iter().enumerate().filter(|(number, _)| *number != 2) {
        let line = |place: &Vec3| format!("v {} {} {}\n", place.x, place.y, place.z);
        let text = frame.iter().map(line).collect::<String>() + faces;
        std::fs::write(folder.path().join(format!("walk{:02}.obj", number + 9)), &text).unwrap();
        std::fs::write(unpadded.path().join(format!("walk{}.obj", number + 9)), &text).unwrap();
    }
    std::fs::write(folder.path().join("walk.txt"), "").unwrap();
    let pattern = folder.path().join("walk%02d.obj");
    assert!(Mesh::is_sequence(&pattern) && Mesh::is_sequence(folder.path()));
    let (mesh, motion) = Mesh::load_sequence(&pattern, 2.0).unwrap();
    check(&mesh, &motion, 2.0, 1.5);
    let (_, of_folder) = Mesh::load_sequence(folder.path(), 2.0).unwrap();
    assert_eq!((of_folder.end(), of_folder.positions(9.0)), (1.0, motion.positions(9.0)));
    let (_, by_number) = Mesh::load_sequence(unpadded.path(), 2.0).unwrap();
    assert_eq!(
        [0.0, 9.0].map(|time| by_number.positions(time)),
        [0.0, 9.0].map(|time| of_folder.positions(time))
    );
    std::fs::write(folder.path().join("walk13.obj"), CUBE_OBJ.replace("f 5 6 7 8\n", "")).unwrap();
    let error = Mesh::load_sequence(&pattern, 2.0).unwrap_err().to_string();
    assert!(error.contains("other faces than the first file") && error.contains("walk13.obj"), "{error}");
    let absent = Mesh::load_sequence(&folder.path().join("run%02d.obj"), 2.0).unwrap_err().to_string();
    assert!(absent.contains("no such .obj file"), "{absent}");
}

#[test]
fn the_looks_of_a_sequence_are_those_of_its_first_file() {
    let folder = tempfile::tempdir().unwrap();
    let write = |number: usize, library: &str| {
        let text = format!("mtllib {library}\nusemtl skin\n{CUBE_OBJ}");
        std::fs::write(folder.path().join(format!("walk{number}.obj")), text).unwrap();
    };
    write(1, "skin.mtl");
    (2..4).for_each(|number| write(number, "other.mtl"));
    std::fs::write(folder.path().join("skin.mtl"), "newmtl skin\nKd 0.5 0.2 0.1\nmap_d hole.png\n").unwrap();
    let (mesh, _, notes) = Mesh::load_sequence_noted(folder.path(), 24.0).unwrap();
    let material = &mesh.materials.as_ref().unwrap().list[0];
    assert_eq!(material.name.as_deref(), Some("skin"));
    let [note] = &notes[..] else { panic!("one note: {notes:?}") };
    assert!(note.contains("the mask `hole.png` of `skin` is not read"), "{note}");
    let bad = CUBE_OBJ.replacen("v ", "v 1e9 ", 1);
    std::fs::write(folder.path().join("walk2.obj"), bad).unwrap();
    let error = Mesh::load_sequence(folder.path(), 24.0).unwrap_err().to_string();
    assert!(error.contains("walk2.obj") && error.contains("finite coordinates"), "{error}");
}
