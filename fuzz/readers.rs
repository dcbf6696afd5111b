//! Properties that hold for any bytes, for every reader. Fuzz targets and the test of the kept corpora share
//! them.

use strandline::{
    Groom, Mesh, Scene,
    format::{LoadOptions, Parsed, bin, data, hair, npy, npz, obj, ply, prepare, project, tfx, usda},
    look::surroundings::{Panorama, Surroundings},
    low_level::{
        body::{BodyFrame, Playback, RecordedMotion, SkinMotion, SkinRoots, VertexMotion},
        groom::{GroomError, Guides},
    },
    mesh::{DistanceGrid, MeshFormat, SignedDistance},
};

/// A reader's target; whether it read the bytes.
pub type Target = fn(&[u8]) -> bool;

/// Every target by its name, which is also that of its folder of seeds.
pub const TARGETS: [(&str, Target); 26] = [
    ("hair", hair_file),
    ("tfx", tfx_file),
    ("project", project_file),
    ("data", data_file),
    ("bin", bin_file),
    ("ply", ply_file),
    ("usda", usda_file),
    ("npz", npz_file),
    ("npy", npy_file),
    ("lines", lines),
    ("obj", obj),
    ("gltf", gltf),
    ("clips", clips),
    ("frames", frames),
    ("walk", walk),
    ("bvh", bvh),
    ("scan", scan),
    ("stl", stl),
    ("beside", beside),
    ("scene", scene),
    ("pose", pose),
    ("attributes", attributes),
    ("cache", cache),
    ("grid", grid),
    ("surroundings", surroundings),
    ("map", map),
];

/// Strands and points that a pose is read for.
const POSE: [usize; 2] = [2, 4];
/// Length of a vector that is taken for a unit vector: single precision.
const UNIT: f32 = 1e-3;

/// A .hair file is read or refused; what was read can be written and read again.
pub fn hair_file(bytes: &[u8]) -> bool {
    groom(hair::read(bytes, None), |groom| hair::write(groom).map(|bytes| hair::read(&bytes, None).is_ok()))
}

/// A .usda file is read or refused.
pub fn usda_file(bytes: &[u8]) -> bool {
    groom(usda::read(bytes), |_| Ok(true))
}

/// A .tfx file, as a .hair file.
pub fn tfx_file(bytes: &[u8]) -> bool {
    groom(tfx::read(bytes), |groom| tfx::write(groom).map(|bytes| tfx::read(&bytes).is_ok()))
}

/// A .tfxproj file is read or refused; it names files below its folder alone.
pub fn project_file(bytes: &[u8]) -> bool {
    project::read(bytes).is_ok_and(|project| {
        assert!(!project.parts.is_empty());
        let stays = |file: &str| !file.starts_with('/') && file.split('/').all(|part| part != "..");
        assert!(project.parts.iter().all(|[file, _]| stays(file)));
        true
    })
}

/// A .data file, as a .hair file.
pub fn data_file(bytes: &[u8]) -> bool {
    groom(data::read(bytes, None), |groom| data::write(groom).map(|bytes| data::read(&bytes, None).is_ok()))
}

/// A .bin file, as a .hair file.
pub fn bin_file(bytes: &[u8]) -> bool {
    groom(bin::read(bytes, None), |groom| bin::write(groom).map(|bytes| bin::read(&bytes, None).is_ok()))
}

/// A .ply file, as a .hair file; bare points are strands of two.
pub fn ply_file(bytes: &[u8]) -> bool {
    groom(ply::read(bytes, Some(2)), |groom| ply::write(groom).map(|bytes| ply::read(&bytes, None).is_ok()))
}

/// A .npz file, as a .hair file; bare points are strands of two.
pub fn npz_file(bytes: &[u8]) -> bool {
    groom(npz::read(bytes, Some(2)), |groom| npz::write(groom).map(|bytes| npz::read(&bytes, None).is_ok()))
}

/// A .npy file, as a .hair file; bare points are strands of two.
pub fn npy_file(bytes: &[u8]) -> bool {
    groom(npy::read(bytes, Some(2)), |groom| npy::write(groom).map(|bytes| npy::read(&bytes, None).is_ok()))
}

/// Strands in an OBJ file, as a .hair file.
pub fn lines(bytes: &[u8]) -> bool {
    groom(obj::read(bytes), |groom| obj::write(groom).map(|bytes| obj::read(&bytes).is_ok()))
}

fn groom(parsed: Result<Parsed, GroomError>, again: impl Fn(&Groom) -> Result<bool, GroomError>) -> bool {
    let lenient = LoadOptions { strict: false, ..LoadOptions::default() };
    let Ok(loaded) = parsed.and_then(|parsed| prepare(parsed, &lenient)) else { return false };
    assert!(loaded.groom.points.iter().all(|point| point.is_finite()));
    let guides = Guides::resample(&loaded.groom, 4).expect("a groom with a strand");
    assert!(guides.root_normals().iter().all(|normal| normal.is_finite()));
    assert!(again(&loaded.groom).unwrap_or(true), "what was written is not read");
    true
}

/// A named part of a mesh is no larger than the mesh.
fn part(bytes: &[u8], format: MeshFormat, whole: &Mesh) -> bool {
    for name in ["a", "scalp", "Mesh"] {
        if let Ok(Some(part)) = Mesh::part_from(bytes, format, name) {
            assert!(part.triangles.len() <= whole.triangles.len());
            assert_eq!(part.positions.len(), part.normals.len());
        }
    }
    true
}

/// A mesh is read or refused; a mesh that was read is a solid where it is no larger than a body.
fn mesh(bytes: &[u8], format: MeshFormat) -> bool {
    Mesh::from_bytes(bytes, format).is_ok_and(|mesh| part(bytes, format, &mesh) && solid(&mesh))
}

/// An OBJ file is read or refused.
pub fn obj(bytes: &[u8]) -> bool {
    mesh(bytes, MeshFormat::Obj)
}

/// A glTF file, as an OBJ file.
pub fn gltf(bytes: &[u8]) -> bool {
    mesh(bytes, MeshFormat::Gltf)
}

/// A body in motion: its head, its vertices and roots on it are somewhere at any time.
fn moves((mesh, motion): (Mesh, VertexMotion)) -> bool {
    assert_eq!(motion.vertex_count(), mesh.positions.len());
    let playback = Playback { speed: -1.5, is_loop: true, ..Playback::default() };
    let places = &mesh.positions;
    let body = SkinMotion::new(motion, playback, places, (0.5, Default::default()), &[]).expect("a body");
    let roots = SkinRoots::new(&mesh, &[places[0], places[places.len() / 2] * 1.01]);
    let mut last = BodyFrame::REST;
    for time in [-1.0, 0.3, 0.4, 1.9, f64::NAN, 1e300] {
        let frame = roots.placed(body.frame(time), &last);
        frame.check(Some(2), Some(places.len())).expect("a body that is somewhere");
        last = frame;
    }
    true
}

/// Clips of a glTF file are refused, or move the body.
pub fn clips(bytes: &[u8]) -> bool {
    let Ok(names) = Mesh::clips_in(bytes) else { return false };
    let play =
        |name: &String| Mesh::moving_from(bytes, name).is_ok_and(|(mesh, motion, _)| moves((mesh, motion)));
    // Each clip reads the whole file.
    names.iter().take(4).filter(|name| play(name)).count() > 0
}

/// Vertices over time with their faces in an .npz are refused, or move the body.
pub fn frames(bytes: &[u8]) -> bool {
    let folder = Folder::new("frames");
    let path = folder.0.join("walk.npz");
    std::fs::write(&path, bytes).expect("a file");
    Mesh::load_sequence(&path, 24.0).is_ok_and(moves)
}

/// A sequence of .obj files, here with a byte 0 between two, is refused, or moves the body.
pub fn walk(bytes: &[u8]) -> bool {
    let folder = Folder::new("walk");
    for (number, file) in bytes.split(|byte| *byte == 0).take(4).enumerate() {
        std::fs::write(folder.0.join(format!("walk{number}.obj")), file).expect("a file");
    }
    Mesh::load_sequence(&folder.0, 24.0).is_ok_and(moves)
}

/// The motion of a joint of a .bvh is read or refused; what was read is somewhere at any time.
pub fn bvh(bytes: &[u8]) -> bool {
    RecordedMotion::from_bvh(bytes, "Head", 0.01).is_ok_and(|motion| {
        for time in [-1.0, 0.3, 1.9, f64::NAN, 1e300] {
            BodyFrame::from(motion.pose(time, [0.0, 0.1, 0.0].into())).check(None, None).expect("a pose");
        }
        true
    })
}

/// A PLY file with faces, as an OBJ file.
pub fn scan(bytes: &[u8]) -> bool {
    mesh(bytes, MeshFormat::Ply)
}

/// An STL file, as an OBJ file.
pub fn stl(bytes: &[u8]) -> bool {
    mesh(bytes, MeshFormat::Stl)
}

/// A folder that goes when it is dropped.
struct Folder(std::path::PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("strandline-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A glTF file in a folder, with files beside it, below it and outside: none from outside is read.
pub fn beside(bytes: &[u8]) -> bool {
    const OUTSIDE: f32 = 12_345.0;
    let outer = Folder::new("beside");
    std::fs::create_dir_all(outer.0.join("inner/below")).expect("a folder");
    let triangle = |at: f32| [at, 0.0, 0.0, at, 1.0, 0.0, at, 0.0, 1.0].map(f32::to_le_bytes).concat();
    for (name, at) in [("a.bin", OUTSIDE), ("inner/a.bin", 1.0), ("inner/below/a.bin", 2.0)] {
        std::fs::write(outer.0.join(name), triangle(at)).expect("a file");
    }
    let path = outer.0.join("inner/a.gltf");
    std::fs::write(&path, bytes).expect("a file");
    Mesh::load(&path, 1.0).is_ok_and(|mesh| {
        assert!(mesh.positions.iter().all(|position| position.x != OUTSIDE), "a file from outside was read");
        solid(&mesh)
    })
}

fn solid(mesh: &Mesh) -> bool {
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < UNIT));
    let bounds = mesh.bounds().expect("a mesh has vertices");
    let size = (bounds.max - bounds.min).max_element();
    // Few cells: the readers are what is looked at.
    if size > 1e-6 && size.is_finite() {
        check_grid(mesh, size / 4.0);
    }
    true
}

/// Triangles of any places: their grid is finite and changes no faster than places do.
pub fn grid(bytes: &[u8]) -> bool {
    let Some((&count, rest)) = bytes.split_first() else { return false };
    let count = usize::from(count) + 3;
    let Some((places, corners)) = rest.split_at_checked(6 * count) else { return false };
    let number = |pair: &[u8]| f32::from(i16::from_le_bytes([pair[0], pair[1]])) / 1024.0;
    let vertex = |place: &[u8]| [&place[..2], &place[2..4], &place[4..]].map(number).into();
    let positions = places.chunks_exact(6).map(vertex).collect();
    let corner = |corner: u8| u32::from(corner) % count as u32;
    let triangles = corners.chunks_exact(3).map(|three| [three[0], three[1], three[2]].map(corner)).collect();
    Mesh::new(positions, triangles).is_ok_and(|mesh| {
        let bounds = mesh.bounds().expect("a mesh has vertices");
        check_grid(&mesh, ((bounds.max - bounds.min).max_element() / 12.0).max(1e-3));
        true
    })
}

fn check_grid(mesh: &Mesh, spacing: f32) {
    let Ok(grid) = DistanceGrid::from_open_mesh(mesh, spacing, 0.0) else { return };
    let spacing = grid.spacing();
    let columns = grid.cells().x as usize + 1;
    for row in grid.nodes().chunks(columns) {
        assert!(row.iter().all(|node| node.is_finite()));
        for pair in row.windows(2) {
            let change = (pair[0].w.abs() - pair[1].w.abs()).abs();
            // Rounding of two distances in single precision.
            let rounding = 1e-5 * (pair[0].w.abs() + spacing);
            assert!(change <= spacing + rounding, "{change} m over {spacing} m");
        }
    }
    let (distance, gradient) = grid.distance_and_gradient(grid.origin() - 1.0);
    assert!(distance.is_finite() && (gradient.length() - 1.0).abs() < UNIT);
}

/// A scene is read or refused; what was read can be written and read again, and is then the same.
pub fn scene(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let Ok(scene) = Scene::parse(text, "fuzzed") else { return false };
    let written = scene.to_toml();
    let again = Scene::parse(&written, "written").expect("what was written is read");
    assert_eq!(again.to_toml(), written);
    true
}

/// The pose of hair is read or refused.
pub fn pose(bytes: &[u8]) -> bool {
    strandline::low_level::check_pose(bytes, POSE).is_ok()
}

/// Masses and velocities of hair are read or refused.
pub fn attributes(bytes: &[u8]) -> bool {
    let mut groom = Groom::empty(8e-5);
    (0..POSE[0]).for_each(|_| groom.push([[0.0; 3], [0.0, -1.0, 0.0]].map(Into::into)));
    let mut guides = Guides::resample(&groom, POSE[1]).expect("a groom with a strand");
    let is_read = strandline::low_level::check_attributes(bytes, &mut guides).is_ok();
    assert!(guides.masses().into_iter().flatten().all(|mass| mass.is_finite() && *mass > 0.0));
    assert!(guides.velocities().into_iter().flatten().all(|velocity| velocity.is_finite()));
    is_read
}

/// A map over the scalp is read or refused; what was read is light at every place.
pub fn map(bytes: &[u8]) -> bool {
    [[0.0, 0.0], [1.0, 1.0], [0.3, 0.7], [-1e30, 1e30]].into_iter().all(|uv| {
        strandline::low_level::read_map(bytes, uv.into()).is_ok_and(|(color, share)| {
            assert!(color.is_finite() && (0.0..=1.0).contains(&share), "{color} {share} at {uv:?}");
            true
        })
    })
}

/// A moving cache is read, every frame of it, or refused.
pub fn cache(bytes: &[u8]) -> bool {
    strandline::low_level::check_cache(bytes).is_ok()
}

/// A picture of the surroundings is read or refused; what was read lights with finite numbers.
pub fn surroundings(bytes: &[u8]) -> bool {
    Panorama::read(bytes).is_ok_and(|panorama| {
        let [width, height] = panorama.size();
        assert!(width == 2 * height && panorama.pixels().len() == width * height);
        assert!(panorama.pixels().iter().all(|pixel| pixel.is_finite()));
        let surroundings = Surroundings::new(&panorama, 30.0, 1.0);
        assert!(surroundings.suns().len() <= 2);
        true
    })
}
