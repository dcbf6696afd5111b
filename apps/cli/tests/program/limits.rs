//! Every documented limit that scales memory is run, or refused before anything is taken: under a limit of
//! the system's on memory, so that a wrong estimate ends the program (134) and fails the test.

use std::path::Path;
use std::process::{Command, Output};

use glam::Vec3;
use strandline::Groom;

/// Memory allowed to the program \[MiB\].
const ALLOWED: &str = "1024";
/// Memory allowed by the system \[KiB\]: the program's own limit, its libraries, stacks and allocator, which
/// reserves 64 MiB of addresses per thread.
const SYSTEM: u64 = 2 << 20;

fn limited(folder: &Path, arguments: &[&str]) -> Output {
    let script = format!("ulimit -v {SYSTEM}; exec \"$0\" \"$@\"");
    Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_strandline")])
        .args(arguments)
        .env("STRANDLINE_MEMORY", ALLOWED)
        // The scratch of each thread grows with the machine.
        .env("RAYON_NUM_THREADS", "2")
        // Addresses that the allocator reserves at a time [KiB]: a gibibyte else.
        .env("MIMALLOC_ARENA_RESERVE", "65536")
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Expects one clear error that names a key and the variable.
fn refused(output: &Output, words: &[&str]) {
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    for word in words {
        assert!(error.contains(word), "`{word}` is missing: {error}");
    }
}

fn runs(output: &Output) {
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{error}");
}

/// Draws one picture of a scene with some of its keys at their limits.
fn render(keys: &str) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let scene = format!(
        "film = {{ frames = 1, settle = 0.0 }}\nsimulation.backend = \"cpu\"\n\
                         picture = {{ backend = \"cpu\", supersampling = 1, width = 16, height = 16 }}\n{keys}"
    );
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    limited(folder.path(), &["render", "--scene", "scene.toml"])
}

const FEW: &str = "style = { strand_count = 30 }\ngroom.bound = 0\n";
/// Parts of the message that refuses too much memory.
const TOO_MUCH: [&str; 2] = ["more than the 1024 MiB", "STRANDLINE_MEMORY"];

#[test]
fn shadow_maps_at_their_largest() {
    // Without the grid that carries scattered light, which would take what one map leaves.
    let look = "look = { fibre.model = \"scheuermann\", shadow.map_size = 4096 }";
    let lights = |count: usize| format!("{FEW}{look}\n{}", "[[lights]]\n".repeat(count));
    runs(&render(&lights(1)));
    for count in [2, 8, 64] {
        let output = render(&lights(count));
        refused(&output, &TOO_MUCH);
        refused(&output, &["look.shadow.map_size = 4096", &format!("{count} lights")]);
    }
}

#[test]
fn lights_at_their_most() {
    let lights = |count: usize| format!("{FEW}{}", "[[lights]]\nshadow = false\n".repeat(count));
    runs(&render(&lights(64)));
    refused(&render(&lights(65)), &["lights is 65, expected 64 at most"]);
    refused(&render(&lights(100_000)), &["lights is 100000,"]);
}

#[test]
fn strands_points_and_segments_at_their_most() {
    // Without the grid that carries scattered light, beside which they would take too much.
    let unlit = "look.fibre.model = \"scheuermann\"\n";
    runs(&render(&format!("{FEW}{unlit}look.follow_strands = 1024\nlook.hair_count = 0")));
    let most = "look.follow_strands = 1024\nstyle.strand_count = 10000";
    refused(&render(most), &["look.follow_strands = 1024"]);
    refused(&render(most), &TOO_MUCH);
    let fine =
        "groom.points_per_strand = 64\nlevel_of_detail.segments_per_span = 16\nlook.follow_strands = 64";
    runs(&render(&format!("{FEW}{unlit}{fine}")));
    refused(&render(fine), &["look.follow_strands = 64"]);
    let strands = render(
        "style.strand_count = 8000000\ngroom.points_per_strand = 64\ngroom.bound = 0\nlook.follow_strands = 16",
    );
    refused(&strands, &["look.follow_strands = 16 on each of 8000000 guides"]);
    let folder = tempfile::tempdir().unwrap();
    let grown =
        limited(folder.path(), &["groom", "--style", "long", "--strands", "8000000", "--out", "long.hair"]);
    refused(&grown, &["style.strand_count = 8000000"]);
}

#[test]
fn cells_and_pictures_at_their_most() {
    runs(&render(&format!("{FEW}simulation.volume.cells = [200, 200, 200]")));
    refused(
        &render(&format!("{FEW}simulation.volume.cells = [512, 512, 512]")),
        &["simulation.volume.cells"],
    );
    let sized = |width: u32, height: u32| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("s.toml"), format!("{FEW}film = {{ frames = 1, settle = 0.0 }}"))
            .unwrap();
        let size = format!("{width}x{height}");
        let device = ["--backend", "cpu"];
        let arguments = [&["render", "--scene", "s.toml", "--size", &size][..], &device].concat();
        limited(folder.path(), &arguments)
    };
    runs(&sized(16384, 1));
    refused(&sized(16384, 16384), &["16384 x 16384 pixels", "MiB"]);
}

#[test]
fn a_small_file_is_not_resampled_to_more_than_memory_or_a_file_holds() {
    let folder = tempfile::tempdir().unwrap();
    let mut groom = Groom::empty(8e-5);
    for strand in 0..100_000 {
        let root = Vec3::new(strand as f32 * 1e-6, 0.0, 0.0);
        groom.push([root, root + Vec3::Y * 0.1]);
    }
    groom.save(folder.path().join("two.hair")).unwrap();
    let points = |count| limited(folder.path(), &["convert", "two.hair", "out.hair", "--points", count]);
    runs(&points("16"));
    refused(&points("1024"), &TOO_MUCH);
    // Our own reader refuses more.
    refused(&points("4096"), &["the number of points is 4096, which makes 409600000", "268435456 in all"]);
}

#[test]
fn a_variable_that_is_no_number_is_refused() {
    let output = Command::new(env!("CARGO_BIN_EXE_strandline"))
        .args(["sim", "--frames", "1", "--backend", "cpu"])
        .env("STRANDLINE_MEMORY", "8G")
        .output()
        .unwrap();
    refused(&output, &["STRANDLINE_MEMORY is `8G`, expected a number of MiB"]);
}

#[test]
fn bound_strands_rods_and_scattered_light_at_their_most() {
    let few_bound = "style.strand_count = 30\ngroom.bound = 3000\nlook.follow_strands = 1\n";
    runs(&render(few_bound));
    let most = "style.strand_count = 30\ngroom.bound = 8000000\nlook.follow_strands = 1\n";
    refused(&render(most), &["look.follow_strands = 1 on each of 8000000 guides"]);
    refused(&render(most), &TOO_MUCH);
    let rods = |keys: &str| render(&format!("simulation.strands.method = \"rods\"\n{keys}"));
    runs(&rods("style.strand_count = 30\ngroom.points_per_strand = 64\n"));
    refused(&rods("style.strand_count = 8000000\n"), &TOO_MUCH);
    // A light with an area has samples of its own for each place of its shadow.
    let area = "[[lights]]\nkind = \"rectangle\"\nwidth = 1.0\nheight = 1.0\nsamples = 4\n".repeat(8);
    let scattered =
        render(&format!("{FEW}look.fibre.model = \"chiang\"\nlook.shadow.map_size = 4096\n{area}"));
    refused(&scattered, &["look.shadow.map_size = 4096 for each of 128 lights with shadow"]);
    refused(&scattered, &TOO_MUCH);
}

#[test]
fn colliders_at_their_most() {
    let ball = "[[colliders]]\nshape = \"sphere\"\ncenter = [0.0, 3.0, 0.0]\nradius = 0.01\n";
    runs(&render(&format!("{FEW}{}", ball.repeat(1024))));
    refused(&render(&format!("{FEW}{}", ball.repeat(1025))), &["colliders is 1025, expected 1024 at most"]);
}

/// Files of one byte more than may be read, which take no room on the disk: refused by their length.
#[test]
fn files_of_more_than_they_may_hold() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), format!("{FEW}film = {{ frames = 1, settle = 0.0 }}"))
        .unwrap();
    for (name, most) in [
        ("a.hair", 4096),
        ("a.tfx", 4096),
        ("a.npz", 4096),
        ("a.ply", 4096),
        ("a.obj", 256),
        ("a.gltf", 256),
        ("a.glb", 256),
        ("a.toml", 8),
    ] {
        let file = std::fs::File::create(folder.path().join(name)).unwrap();
        file.set_len((most << 20) + 1).unwrap();
        let body = ["sim", "--scene", "s.toml", "--body", name];
        let output = match most {
            8 => limited(folder.path(), &["scene", name]),
            256 => limited(folder.path(), &body),
            _ => limited(folder.path(), &["info", name]),
        };
        refused(&output, &[&format!("{} bytes, expected {most} MiB at most", (most << 20) + 1)]);
    }
}

/// Memory is asked for what a file holds before it is read: this one is sparse, and takes no room on the disk.
#[test]
fn files_that_would_take_more_than_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    let (strands, points) = (8_000_000_u32, 128_000_000_u32);
    let mut header = b"HAIR".to_vec();
    [strands, points, 2, 15].iter().for_each(|number| header.extend(number.to_le_bytes()));
    header.resize(128, 0);
    let hair = folder.path().join("large.hair");
    std::fs::write(&hair, header).unwrap();
    std::fs::File::options().write(true).open(&hair).unwrap().set_len(128 + 12 * u64::from(points)).unwrap();
    let output = limited(folder.path(), &["info", "large.hair"]);
    refused(&output, &["the groom of large.hair would take 2930 MiB"]);
    refused(&output, &TOO_MUCH);
    let mesh = folder.path().join("large.obj");
    std::fs::File::create(mesh).unwrap().set_len(200 << 20).unwrap();
    let output = limited(folder.path(), &["sim", "--body", "large.obj", "--set", "style.strand_count=100"]);
    refused(&output, &["the body of ", "large.obj would take 6000 MiB"]);
    refused(&output, &TOO_MUCH);
}
