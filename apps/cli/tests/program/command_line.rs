//! The program as a person uses it: right and wrong.

use std::path::Path;
use std::process::{Command, Output};

use crate::refusal::refused;

fn strandline(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandline")).args(arguments).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Runs and expects success; returns standard output.
fn works(folder: &Path, arguments: &[&str]) -> String {
    let output = strandline(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// Runs and expects one clear error with a code, all of some words, and no panic.
fn fails(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) {
    let output = refused(folder, arguments);
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    assert!(!error.contains("panicked"), "{error}");
    assert!(output.stdout.is_empty(), "{arguments:?} printed {}", text(&output.stdout));
    for word in words {
        assert!(error.contains(word), "`{word}` is missing for {arguments:?}: {error}");
    }
}

/// A scene that takes a moment.
const SMALL: &str = "[style]\nstrand_count = 40\n[look]\nfollow_strands = 2\n[film]\nframes = 2\nsettle = 0.0\n\
                     [level_of_detail]\nby_pixel = false\n[picture]\nwidth = 64\nheight = 48\n";

fn small(folder: &Path) {
    std::fs::write(folder.join("small.toml"), SMALL).unwrap();
}

fn keys(object: &serde_json::Value) -> Vec<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn render_writes_frames_a_sheet_and_a_moving_picture() {
    let folder = tempfile::tempdir().unwrap();
    small(folder.path());
    let output = works(folder.path(), &["render", "--scene", "small.toml", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&output).unwrap();
    let times = ["ms_per_frame_beside_simulation", "ms_of_frame_alone"];
    let others = ["backend", "render_backend", "frames", "follow_strands", "segments", "files"];
    for key in times.iter().chain(&others) {
        assert!(keys(&report).contains(key), "{key} is missing in {output}");
    }
    // 40 guides, eight strands of the style's own for each, two follow strands for each of these.
    assert_eq!((report["frames"].as_u64(), report["follow_strands"].as_u64()), (Some(2), Some(640)));
    for name in ["frame_0000.png", "frame_0001.png", "sheet.png"] {
        let file = std::fs::read(folder.path().join("out/small").join(name)).unwrap();
        assert!(file.starts_with(b"\x89PNG") && file.ends_with(b"IEND\xaeB`\x82"), "{name} is not whole");
    }
    let moving =
        ["video.mp4", "animation.gif"].map(|name| folder.path().join("out/small").join(name).is_file());
    assert_eq!(moving.iter().filter(|there| **there).count(), 1);
    for name in times {
        let stages = keys(&report[name]["stages"]);
        assert_eq!(stages.len(), 8, "{name}: {stages:?}");
    }
    // Nothing is simulated beside the only picture of a film.
    let output = works(folder.path(), &["render", "--scene", "small.toml", "--frames", "1", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert!(report[times[0]].is_null() && report[times[1]].is_object(), "{output}");
}

#[test]
fn measurements_are_plotted_and_other_files_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let measured = r#"{"bench": "thesis", "machine": {"cpu": "x", "threads": 2}, "quick": true, "results": {"grids": [
        {"cells": 16, "whole_on_cpu": {"frames_per_second": 4.0}, "gpu": null, "thesis_frames_per_second": [21.8, 96.2]},
        {"cells": 64, "whole_on_cpu": {"frames_per_second": 3.0}, "gpu": null, "thesis_frames_per_second": [3.19, 37.7]}]}}"#;
    std::fs::write(at.join("thesis.json"), measured).unwrap();
    std::fs::write(at.join("other.json"), "{}").unwrap();
    works(at, &["plot", "thesis.json"]);
    works(at, &["plot", "thesis.json", "--out", "named.svg"]);
    for name in ["thesis.svg", "named.svg"] {
        let text = std::fs::read_to_string(at.join(name)).unwrap();
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n") && text.contains("a quick run"));
    }
    fails(at, &["plot", "other.json"], 1, &["no measurements to plot", "--json FILE", "other.json"]);
    fails(at, &["plot", "none.json"], 1, &["cannot read the measurements", "none.json"]);
    fails(at, &["plot", "thesis.json", "--out", "no/folder.svg"], 1, &["the plot", "folder.svg"]);
}

#[test]
fn sim_prints_one_object_and_the_same_physics_every_time() {
    let folder = tempfile::tempdir().unwrap();
    small(folder.path());
    let run = || {
        let output = works(folder.path(), &["sim", "--scene", "small.toml", "--json", "--frames", "5"]);
        let mut report: serde_json::Value = serde_json::from_str(&output).unwrap();
        assert!(report["ms_per_step"]["median"].as_f64().unwrap() > 0.0);
        report.as_object_mut().unwrap().remove("ms_per_step");
        report
    };
    let report = run();
    assert!(report["steps"] == 10 && report["jumps"] == serde_json::json!([]), "{report}");
    let all =
        ["backend", "strands", "points_per_strand", "steps", "stretch", "penetration_max_m", "non_finite"];
    for key in all.into_iter().chain(["pcg", "fluid_cells_mean", "drift", "speed", "stiffened", "stiffest"]) {
        assert!(keys(&report).contains(&key), "{key}");
    }
    assert_eq!(report, run());
    let other = works(folder.path(), &["sim", "--scene", "small.toml", "--json", "--frames", "6"]);
    assert!(!other.contains("\"steps\":10,"), "the comparison can fail");
    let wet =
        works(folder.path(), &["sim", "--scene", "small.toml", "--json", "--frames", "5", "--hair", "wet"]);
    let wet: serde_json::Value = serde_json::from_str(&wet).unwrap();
    assert_ne!(wet["drift"], report["drift"], "wet hair moves like dry hair");
}

#[test]
fn grooms_are_grown_converted_and_described() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    works(at, &["groom", "--style", "curly", "--strands", "30", "--seed", "4", "--out", "a.hair"]);
    works(at, &["groom", "--style", "bob", "--strands", "60", "--guides", "12", "--out", "own.npz"]);
    let own =
        strandline::format::load(&at.join("own.npz"), &strandline::format::LoadOptions::default()).unwrap();
    let marks = own.groom.guide_flags.unwrap();
    assert_eq!((marks.len(), marks.iter().filter(|mark| **mark).count()), (60, 12));
    works(at, &["convert", "a.hair", "b.tfx"]);
    works(at, &["convert", "b.tfx", "c.hair", "--points", "5"]);
    let thin = ["convert", "a.hair", "d.ply", "--thin", "7", "--turn", "0,90,0", "--move", "-1,0,0"];
    works(at, &thin);
    works(at, &["convert", "b.tfx", "c.hair", "e.npz", "--scale", "0.5"]);
    let output = works(at, &["info", "e.npz", "--scale", "1"]);
    assert!(output.contains("group     1: c, 30 strands"), "{output}");
    for (file, points) in
        [("a.hair", 30 * 64), ("b.tfx", 30 * 64), ("c.hair", 30 * 5), ("d.ply", 7 * 64), ("e.npz", 30 * 69)]
    {
        let output = works(at, &["info", file, "--json"]);
        let report: serde_json::Value = serde_json::from_str(&output).unwrap();
        let strands = if file == "d.ply" { 7 } else { 30 + 30 * u32::from(file == "e.npz") };
        assert_eq!((&report["strands"], &report["points"]), (&strands.into(), &points.into()), "{output}");
        for key in ["format", "points_per_strand", "length_m", "bounds_m", "problems"] {
            assert!(keys(&report).contains(&key), "{key}");
        }
    }
    assert!(works(at, &["info", "a.hair"]).contains("strands   30"));
}

#[test]
fn wrong_usage_ends_with_two() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fails(at, &["fly"], 2, &["unrecognized subcommand"]);
    fails(at, &["render", "--size", "800"], 2, &["expected WIDTHxHEIGHT"]);
    fails(at, &["render", "--frames", "-3"], 2, &["-3"]);
    fails(at, &["render", "--frames", "0"], 2, &["0 is not in 1..=1000000"]);
    fails(at, &["render", "--style", "mohawk"], 2, &["`mohawk`", "bob, long, wavy"]);
    fails(at, &["render", "--motion", "jump"], 2, &["`jump`", "still, shake, nod"]);
    fails(at, &["render", "--style", "bob", "--groom", "a.hair"], 2, &["cannot be used with"]);
    fails(at, &["render", "--hair", "dry"], 2, &["`dry`", "fine, medium, coarse, wet, sprayed"]);
    fails(
        at,
        &["sim", "--scene", "thesis", "--hair", "wet"],
        2,
        &["simulation.strands.method", "expected \"rods\""],
    );
    fails(at, &["sim", "--backend", "gpus"], 2, &["`gpus`", "auto, cpu, gpu"]);
    fails(at, &["sim", "--scene", "nowhere"], 2, &["`nowhere`", "demo, thesis or the path of a .toml"]);
}

#[test]
fn bad_scenes_are_refused_by_key() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fails(at, &["sim", "--scene", "absent.toml"], 1, &["cannot read the scene", "absent.toml"]);
    for (content, words) in [
        ("[grom]\n", vec!["unknown field `grom`", "`groom`"]),
        ("[simulation]\ngravitas = 1\n", vec!["unknown field `gravitas`", "gravity"]),
        ("[style]\nstrand_count = -4\n", vec!["-4"]),
        ("[film]\nframes = 0\n", vec!["film.frames is 0", "1 to"]),
        ("[look]\nsparkle = 7\n", vec!["look.fibre.scheuermann.sparkle is 7, expected 0 to 1"]),
        ("[simulation]\ngravity = [1e30, 0, 0]\n", vec!["simulation.gravity is [1e30, 0, 0]", "m/s^2"]),
        ("[motion]\npivot = [nan, 0, 0]\n", vec!["motion.pivot is [NaN, 0, 0]"]),
        ("[picture]\nwidth = \"wide\"\n", vec!["wide"]),
        ("[groom]\nfile = \"absent.hair\"\n", vec!["cannot read the groom", "absent.hair"]),
        ("[body]\nfile = \"absent.obj\"\n", vec!["absent.obj"]),
        ("[[colliders]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = -1\n", vec!["-1"]),
        ("[motion]\nname = \"keyframes\"\n", vec!["keyframe"]),
    ] {
        std::fs::write(at.join("bad.toml"), content).unwrap();
        fails(at, &["sim", "--scene", "bad.toml"], 1, &words);
    }
}

#[test]
fn bad_files_are_refused_with_their_path() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    works(at, &["groom", "--style", "pixie", "--strands", "20", "--out", "good.hair"]);
    let good = std::fs::read(at.join("good.hair")).unwrap();
    std::fs::write(at.join("cut.hair"), &good[..good.len() / 2]).unwrap();
    std::fs::write(at.join("zip.hair"), b"PK\x03\x04").unwrap();
    let mut huge = good.clone();
    huge[4..8].copy_from_slice(&u32::MAX.to_le_bytes());
    std::fs::write(at.join("huge.hair"), huge).unwrap();
    std::fs::write(at.join("old.tfx"), 2.0_f32.to_le_bytes().repeat(50)).unwrap();
    std::fs::write(at.join("empty.obj"), b"# nothing\n").unwrap();
    std::fs::write(at.join("nan.obj"), b"v 0 0 0\nv 1 0 0\nv nan 0 0\nf 1 2 3\n").unwrap();
    fails(at, &["info", "cut.hair"], 1, &["bytes", "expected", "cut.hair"]);
    fails(at, &["info", "zip.hair"], 1, &["starts with `PK", "expected `HAIR`", "zip.hair"]);
    fails(at, &["info", "huge.hair"], 1, &["4294967295 strands", "huge.hair"]);
    fails(at, &["info", "old.tfx"], 1, &["version 2", "3 or 4", "old.tfx"]);
    fails(at, &["convert", "good.hair", "good.fbx"], 1, &["`fbx`", ".hair, .tfx,", "good.fbx"]);
    fails(at, &["sim", "--frames", "1", "--body", "empty.obj"], 1, &["empty.obj"]);
    fails(at, &["sim", "--frames", "1", "--body", "nan.obj"], 1, &["nan.obj"]);
}

#[test]
fn an_output_folder_that_cannot_be_written_is_an_error_and_an_open_body_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    small(at);
    std::fs::write(at.join("file"), b"in the way").unwrap();
    fails(
        at,
        &["render", "--scene", "small.toml", "--out", "file/out"],
        1,
        &["cannot write the output folder", "file/out"],
    );
    fails(
        at,
        &["groom", "--style", "bob", "--strands", "3", "--out", "file/a.hair"],
        1,
        &["cannot write", "a.hair"],
    );
    let corners = "v -1 -1 -1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 1\nv 0 0.4 0\n";
    std::fs::write(at.join("open.obj"), format!("{corners}f 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n")).unwrap();
    let open = ["sim", "--scene", "small.toml", "--frames", "1", "--body", "open.obj"];
    std::fs::write(at.join("small.toml"), format!("{SMALL}[body]\nspacing = 0.05\n")).unwrap();
    works(at, &open);
}

#[test]
fn printed_scenes_are_scenes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["demo", "thesis"] {
        let printed = works(folder.path(), &["scene", name]);
        std::fs::write(folder.path().join("again.toml"), &printed).unwrap();
        assert_eq!(works(folder.path(), &["scene", "again.toml"]), printed);
    }
}

/// Runs where no driver is found.
fn without_gpu(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandline"))
        .args(arguments)
        .current_dir(folder)
        .env("VK_DRIVER_FILES", "none.json")
        .env("VK_ICD_FILENAMES", "none.json")
        .output()
        .unwrap()
}

#[test]
fn without_a_gpu_auto_takes_the_cpu_and_gpu_says_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    small(folder.path());
    let output = without_gpu(folder.path(), &["sim", "--scene", "small.toml", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    assert_eq!(report["backend"], "cpu");
    // Other drivers than Vulkan's are not hidden: a machine that has one finds its GPU here.
    if text(&without_gpu(folder.path(), &["gpus"]).stdout).starts_with("no GPU") {
        let output = without_gpu(folder.path(), &["sim", "--scene", "small.toml", "--backend", "gpu"]);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(error.contains("no GPU was found; install a Vulkan driver"), "{error}");
    }
}

#[test]
fn a_backend_is_named_on_the_command_line_or_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    small(folder.path());
    let there = !works(folder.path(), &["gpus"]).starts_with("no GPU");
    let sim = ["sim", "--scene", "small.toml", "--backend"];
    fails(folder.path(), &[&sim[..], &["cuda"]].concat(), 2, &["expected auto, cpu, gpu"]);
    fails(folder.path(), &[&sim[..], &["gpu:99"]].concat(), 1, &["no GPU of number 99 was found"]);
    if !there {
        eprintln!("not tested on a GPU: no adapter");
        return;
    }
    let output = works(folder.path(), &[&sim[..], &["gpu", "--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert!(report["backend"].as_str().unwrap().starts_with("gpu:0"), "{output}");
    assert!(report["ms_per_step"]["median"].as_f64().unwrap() > 0.0);
    let named = format!("{SMALL}[simulation]\nbackend = \"gpu\"\n");
    std::fs::write(folder.path().join("named.toml"), named).unwrap();
    let output = works(folder.path(), &["render", "--scene", "named.toml", "--json"]);
    assert!(output.contains("\"backend\":\"gpu:0"), "{output}");
    let output = works(folder.path(), &["render", "--scene", "named.toml", "--json", "--backend", "cpu"]);
    assert!(output.contains("\"backend\":\"cpu\",\"render_backend\":\"cpu\""), "{output}");
    let drawn =
        ["render", "--scene", "small.toml", "--json", "--sim-device", "cpu", "--render-device", "gpu"];
    let output = works(folder.path(), &drawn);
    assert!(output.contains("\"backend\":\"cpu\",\"render_backend\":\"gpu:0"), "{output}");
}

#[test]
fn without_a_display_the_window_says_so_and_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    small(folder.path());
    let view = |scene: &str| {
        Command::new(env!("CARGO_BIN_EXE_strandline"))
            .args(["view", "--scene", scene])
            .current_dir(folder.path())
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .output()
            .unwrap()
    };
    let output = view("small.toml");
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(error.contains("no window") && error.contains("`strandline render` needs no display"), "{error}");
    let output = view("missing.toml");
    assert!(text(&output.stderr).contains("missing.toml"));
}

#[test]
fn shader_modules_are_written_to_be_read() {
    let folder = tempfile::tempdir().unwrap();
    works(folder.path(), &["shaders", "linked"]);
    let text = std::fs::read_to_string(folder.path().join("linked/constrain.wgsl")).unwrap();
    assert!(text.contains("fn constrain(") && text.contains("@binding(0)"));
    std::fs::write(folder.path().join("file"), "").unwrap();
    fails(folder.path(), &["shaders", "file/linked"], 1, &["cannot write the shader modules", "file/linked"]);
}

/// The names of an .exr file's channels, the sums of their values and of their amounts.
fn channels(path: &Path) -> Vec<(String, f32, f32)> {
    let image = exr::prelude::read_first_flat_layer_from_file(path).unwrap();
    let channels = &image.layer_data.channel_data.list;
    let of = |channel: &exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
        let values = channel.sample_data.values_as_f32();
        let values = values.filter(|value| value.is_finite() && value.abs() < 1e6);
        let (sum, amount) =
            values.fold((0.0, 0.0), |(sum, amount), value| (sum + value, amount + value.abs()));
        (channel.name.to_string(), sum, amount)
    };
    channels.iter().map(of).collect()
}

#[test]
#[allow(clippy::print_stderr)] // it tells what is not tested
fn linear_light_and_channels_are_written_by_either_device() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "[style]\nstrand_count = 200\n[film]\nsettle = 0.0\n[picture]\nwidth = 64\nheight = 48\n";
    std::fs::write(folder.path().join("small.toml"), scene).unwrap();
    let draw = |device: &str, out: &str| {
        let arguments =
            ["render", "--scene", "small.toml", "--frames", "1", "--render-device", device, "--out", out];
        strandline(folder.path(), &arguments)
    };
    assert!(draw("cpu", "cpu.exr").status.success());
    let drawn = draw("gpu", "gpu.exr");
    let said = text(&drawn.stderr);
    if !drawn.status.success() {
        let required = std::env::var_os("STRANDLINE_REQUIRE_GPU").is_some_and(|value| value == "1");
        assert!(!required && said.contains("GPU"), "{said}");
        return eprintln!("not tested on a GPU: {said}");
    }
    assert!(said.contains("half floats"), "{said}");
    let [one, two] = ["cpu.exr", "gpu.exr"].map(|name| channels(&folder.path().join(name)));
    assert!(one.len() > 6, "{one:?}");
    for ((name, one, amount), (same, two, _)) in one.iter().zip(&two) {
        // Sums over a picture, beside those of amounts, since directions to both sides cancel: found within 1 %.
        let apart = (one - two).abs() / amount.max(1.0);
        assert!(name == same && apart < 0.02, "{name}: {one}, {same}: {two}");
    }
}

#[test]
fn a_picture_of_a_name_is_that_file_and_a_film_one_for_each_frame() {
    let folder = tempfile::tempdir().unwrap();
    small(folder.path());
    let is_png =
        |name: &str| std::fs::read(folder.path().join(name)).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG"));
    let said =
        works(folder.path(), &["render", "--scene", "small.toml", "--frames", "1", "--out", "new/one.png"]);
    assert!(said.contains("new/one.png") && is_png("new/one.png"), "{said}");
    works(folder.path(), &["render", "--scene", "small.toml", "--frames", "2", "--out", "two.png"]);
    assert!(is_png("two_0000.png") && is_png("two_0001.png") && !folder.path().join("two.png").exists());
}
