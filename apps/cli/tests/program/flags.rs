//! Options of commands: where they may stand, and which commands have them.

use std::path::Path;
use std::process::{Command, Output};

use glam::Vec3;
use strandline::Groom;

fn strandline(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandline")).args(arguments).current_dir(folder).output().unwrap()
}

/// Runs and expects success; returns standard output.
fn works(folder: &Path, arguments: &[&str]) -> String {
    let output = strandline(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Runs and expects an error of a code with some words.
fn fails(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) {
    let output = strandline(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    assert!(words.iter().all(|word| error.contains(word)), "{arguments:?}: {error}");
}

/// Strands of so many points that hang side by side.
fn groom(strands: usize, points: usize) -> Groom {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..strands {
        let root = Vec3::X * (0.002 * strand as f32);
        groom.push((0..points).map(|point| root + Vec3::NEG_Y * (0.2 * point as f32 / points as f32)));
    }
    groom
}

#[test]
fn options_stand_anywhere_between_the_files_of_convert() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    groom(12, 20).save(at.join("a.hair")).unwrap();
    works(at, &["convert", "--points", "8", "a.hair", "before.hair"]);
    for (name, arguments) in [
        ("between.hair", &["convert", "a.hair", "--points", "8", "between.hair"][..]),
        ("behind.hair", &["convert", "a.hair", "behind.hair", "--points", "8"]),
    ] {
        works(at, arguments);
        let same = [name, "before.hair"].map(|name| std::fs::read(at.join(name)).unwrap());
        assert!(same[0] == same[1], "{name}");
    }
    works(at, &["convert", "a.hair", "--clean", "before.hair", "--points", "8", "three.hair"]);
    assert!(works(at, &["info", "three.hair"]).contains("strands   24"));
    fails(at, &["convert", "a.hair", "--points", "8"], 2, &["one file", "IN... OUT"]);
    fails(at, &["convert", "--points", "8"], 2, &["IN... OUT"]);
}

#[test]
fn every_command_that_reads_a_groom_takes_points_of_a_strand() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // Bare points: no format tells where a strand ends.
    let mut text = "ply\nformat ascii 1.0\nelement vertex 600\nproperty float x\nproperty float y\nproperty \
                    float z\nend_header\n"
        .to_owned();
    for point in &groom(30, 20).points {
        text += &format!("{} {} {}\n", point.x, point.y, point.z);
    }
    std::fs::write(at.join("bare.ply"), text).unwrap();
    let small = ["--frames", "1", "--backend", "cpu", "--set", "film.settle=0"];
    for command in ["sim", "render"] {
        let size: &[&str] = if command == "render" { &["--size", "32x24", "--out", "a.png"] } else { &[] };
        let run = [&[command, "--groom", "bare.ply"][..], &small, size].concat();
        fails(at, &run, 1, &["--per-strand N"]);
        works(at, &[&run[..], &["--per-strand", "20"]].concat());
    }
    let report =
        works(at, &[&["sim", "--groom", "bare.ply", "--per-strand", "20", "--json"][..], &small].concat());
    assert!(report.contains("\"strands\":30,"), "{report}");
    assert!(works(at, &["info", "bare.ply", "--per-strand", "20"]).contains("strands   30"));
    fails(at, &["sim", "--per-strand", "20"], 2, &["--groom"]);
}
