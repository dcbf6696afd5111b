//! Options of commands: where they may stand, and which commands have them.

use std::path::Path;
use std::process::{Command, Output};

use glam::Vec3;
use strandline::Groom;

use crate::refusal::refused;

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
    let output = refused(folder, arguments);
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
        fails(at, &run, 1, &["--per-strand 20"]);
        works(at, &[&run[..], &["--per-strand", "20"]].concat());
    }
    let report =
        works(at, &[&["sim", "--groom", "bare.ply", "--per-strand", "20", "--json"][..], &small].concat());
    assert!(report.contains("\"strands\":30,"), "{report}");
    assert!(works(at, &["info", "bare.ply", "--per-strand", "20"]).contains("strands   30"));
    fails(at, &["sim", "--per-strand", "20"], 2, &["--groom"]);
}

#[test]
fn frequent_settings_have_flags() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("small.toml"), "[style]\nstrand_count = 12\n[body]\nspacing = 0.02\n").unwrap();
    let flags =
        "--look Copper --wind=-2,0,1 --view SIDE --fps 24 --width 1.5 --motion Nod --frames 1 --size 32x24";
    let flags: Vec<&str> = flags.split(' ').collect();
    let picture = |name: &str, more: &[&str]| {
        let run = ["render", "--scene", "small.toml", "--backend", "CPU", "--out", name];
        works(at, &[&run[..], more].concat());
        std::fs::read(at.join(name)).unwrap()
    };
    let found = picture("flags.png", &flags);
    let settings = [
        ("look.preset", "copper"),
        ("wind.velocity", "[-2, 0, 1]"),
        ("camera.view", "side"),
        ("film.frames_per_second", "24"),
        ("motion.name", "nod"),
        ("film.frames", "1"),
        ("picture.width", "32"),
        ("picture.height", "24"),
        ("look.width_scale", "1.5"),
    ];
    let settings: Vec<String> =
        settings.iter().flat_map(|(key, value)| ["--set".to_owned(), format!("{key}={value}")]).collect();
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    assert!(found == picture("set.png", &settings), "flags and settings draw different pictures");
    assert!(found != picture("plain.png", &["--frames", "1", "--size", "32x24"]));
    fails(
        at,
        &["render", "--look", "plaid", "--frames", "1", "--size", "8x8"],
        2,
        &["plaid", "brown, black, blonde, red, copper, grey", "#rrggbb"],
    );
    fails(at, &["render", "--view", "above"], 2, &["above", "front, three_quarter, side, back"]);
    fails(at, &["sim", "--fps", "0"], 2, &["from 1 to 1000"]);
}

#[test]
fn a_picture_of_a_format_that_is_not_written_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for name in ["x.jpg", "x.JPEG", "film.mp4"] {
        fails(at, &["render", "--frames", "1", "--out", name], 2, &["expected a .png or .exr file", name]);
        assert!(!at.join(name).exists(), "{name}");
    }
}

#[test]
fn two_pictures_into_one_folder_may_be_made_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("small.toml"), "[style]\nstrand_count = 40\n[body]\nspacing = 0.02\n").unwrap();
    let begin = |name: &str| {
        let run = ["render", "--scene", "small.toml", "--backend", "cpu", "--frames", "6", "--size", "48x32"];
        let mut command = Command::new(env!("CARGO_BIN_EXE_strandline"));
        command.args(run).args(["--out", name]).current_dir(at);
        command.stderr(std::process::Stdio::piped()).spawn().unwrap()
    };
    let runs = ["out/a.png", "out/b.png", "out/c.png"].map(begin);
    for run in runs {
        let output = run.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let count = std::fs::read_dir(at.join("out")).unwrap().count();
    assert_eq!(count, 18);
}

#[test]
fn a_run_without_a_display_draws_twelve_pictures_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_strandline"));
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let mut run = command.current_dir(folder.path()).stdout(std::process::Stdio::piped()).spawn().unwrap();
    let lines = std::io::BufRead::lines(std::io::BufReader::new(run.stdout.take().unwrap()));
    let said: Vec<String> = lines.take(2).map(|line| line.unwrap()).collect();
    run.kill().unwrap();
    run.wait().unwrap();
    assert!(said[1].starts_with("draws 12 pictures of ") && said[1].contains("out/demo"), "{said:?}");
}

#[test]
fn a_turntable_shows_the_hair_from_all_around() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("small.toml"), "[style]\nstrand_count = 60\n[body]\nspacing = 0.02\n").unwrap();
    let render = ["render", "--scene", "small.toml", "--backend", "cpu", "--size", "48x48"];
    works(at, &[&render[..], &["--turntable", "4", "--view", "front", "--out", "turn.png"]].concat());
    let read = |name: &str| image::open(at.join(name)).unwrap().to_rgb8().into_raw();
    let apart = |one: &[u8], other: &[u8]| {
        let each = one.iter().zip(other).map(|(one, other)| f64::from(one.abs_diff(*other)));
        each.sum::<f64>() / one.len() as f64
    };
    let [front, left, back, right] =
        ["turn_0000.png", "turn_0001.png", "turn_0002.png", "turn_0003.png"].map(read);
    assert!(!at.join("turn_0004.png").exists());
    for (view, turned) in [("front", &front), ("side", &left)] {
        let still = ["--motion", "still", "--frames", "1", "--view", view, "--out", "one.png"];
        works(at, &[&render[..], &still].concat());
        // Lights stay; the framing from another side is a little nearer.
        let difference = apart(&read("one.png"), turned);
        assert!(difference < 20.0, "{view}: {difference}");
    }
    for (one, other) in [(&front, &left), (&left, &back), (&back, &right), (&right, &front)] {
        assert!(apart(one, other) > 3.0, "a view is as the one before");
    }
}

#[test]
fn shells_and_man_know_every_command_and_option() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = works(at, &["completions", shell]);
        assert!(text.contains("turntable") && text.contains("convert"), "{shell}");
    }
    fails(at, &["completions", "csh"], 2, &["csh"]);
    works(at, &["man", "pages"]);
    let read = |name: &str| std::fs::read_to_string(at.join("pages").join(name)).unwrap();
    assert!(read("strandline.1").contains("convert"));
    assert!(read("strandline-render.1").contains("turntable"));
}

#[test]
fn a_mesh_is_told_from_strands_by_its_contents() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("body.mtl"), "newmtl skin\nKd 0.5 0.25 0.125\n").unwrap();
    let mesh = "mtllib body.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin\nf 1 2 3\n";
    std::fs::write(at.join("body.obj"), mesh).unwrap();
    let said = works(at, &["info", "body.obj"]);
    assert!(said.contains(".obj mesh") && said.contains("material  skin: color 0.50 0.25 0.12"), "{said}");
    // Neither strands nor faces.
    std::fs::write(at.join("points.obj"), "v 0 0 0\nv 1 0 0\n").unwrap();
    fails(at, &["info", "points.obj"], 1, &["strands as lines", "points.obj"]);
}
