//! Moved hair in the hands of others: numpy and usd-core read what the program wrote, where they are there.
#![allow(clippy::print_stdout)] // it says what is not tested

use std::path::Path;
use std::process::{Command, Output};

use crate::refusal::refused;

/// A scene that takes a moment, on the CPU.
const SMALL: &str = "[style]\nstrand_count = 40\n[body]\nspacing = 0.02\n[look]\nfollow_strands = 2\n\
                     [film]\nframes = 8\nsettle = 0.0\n[devices]\nsimulation = \"cpu\"\npictures = \"cpu\"\n\
                     [picture]\nwidth = 64\nheight = 48\n[simulation]\nvolume.cells = [8, 8, 8]\n";

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandline")).args(arguments).current_dir(folder).output().unwrap()
}

/// Runs and expects success; what it prints.
fn works(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Runs and expects an error with a code and some words.
fn fails(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) {
    let output = refused(folder, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    for word in words {
        assert!(error.contains(word), "`{word}` is missing for {arguments:?}: {error}");
    }
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    folder
}

/// Says what is not tested, or fails where the environment asks for it.
fn untested(why: &str) {
    assert!(std::env::var_os("STRANDLINE_REQUIRE_PYTHON").is_none(), "{why}");
    println!("NOT TESTED: {why}");
}

/// A Python with numpy and usd-core, as the environment's STRANDLINE_PYTHON names it.
fn check(folder: &Path, files: &[&str]) {
    let python = std::env::var("STRANDLINE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/moved/check.py");
    let Ok(output) = Command::new(&python).arg(script).args(files).current_dir(folder).output() else {
        return untested(&format!("no {python}, so nobody else reads the files"));
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    match output.status.code() {
        Some(0) => println!("{text}"),
        Some(77) => untested(&format!("{python}: {text}(pip install numpy usd-core)")),
        _ => panic!("{text}{}", String::from_utf8_lossy(&output.stderr)),
    }
}

#[test]
fn numpy_and_usd_read_what_was_written() {
    let folder = folder();
    for (what, every) in [("guides", "1"), ("strands", "3")] {
        let sim = |out: &str, target: Option<&str>| {
            let mut arguments =
                vec!["sim", "--scene", "small.toml", "--what", what, "--every", every, "--out", out];
            arguments.extend(target.iter().flat_map(|target| ["--for", target]));
            works(folder.path(), &arguments);
        };
        sim("a.npz", None);
        sim("any.usda", None);
        sim("unreal.usda", Some("unreal"));
        sim("blender.usda", Some("blender"));
        let files = ["a.npz", "any.usda", "any", "unreal.usda", "unreal", "blender.usda", "blender"];
        check(folder.path(), &files);
    }
}

#[test]
fn a_cache_is_drawn_and_gone_on_from_by_its_name_alone() {
    let folder = folder();
    let at = folder.path();
    works(at, &["sim", "--scene", "small.toml", "--frames", "5", "--out", "a.npz"]);
    works(at, &["render", "--scene", "small.toml", "--frames", "5", "--out", "live"]);
    works(at, &["render", "--cache", "a.npz"]);
    for frame in 0..5 {
        let read = |from: &str| std::fs::read(at.join(from).join(format!("frame_{frame:04}.png"))).unwrap();
        assert!(read("live") == read("out/a"), "frame {frame}");
    }
    let report = works(at, &["sim", "--resume", "a.npz", "--frames", "8", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!((report["out"]["frames"].as_u64(), report["out"]["strands"].as_u64()), (Some(8), Some(40)));
    works(at, &["sim", "--scene", "small.toml", "--out", "b.npz"]);
    assert!(std::fs::read(at.join("a.npz")).unwrap() == std::fs::read(at.join("b.npz")).unwrap());
    works(at, &["sim", "--resume", "a.npz", "--frames", "9", "--out", "c.usda"]);
    assert!(std::fs::read_to_string(at.join("c.usda")).unwrap().contains("endTimeCode = 9 "));
}

#[test]
fn errors_say_what_to_do() {
    let folder = folder();
    let at = folder.path();
    works(at, &["sim", "--scene", "small.toml", "--out", "a.npz"]);
    fails(
        at,
        &["sim", "--out", "a.abc"],
        1,
        &["`abc` names no format of moving hair", ".usda", "%04d", "pip install 'strandline[abc]'", "a.abc"],
    );
    fails(at, &["sim", "--scene", "small.toml", "--out", "f/%02d.abc"], 1, &["`abc`", "f/00.abc"]);
    fails(at, &["sim", "--what", "hair", "--out", "a.npz"], 2, &["guides, strands"]);
    fails(at, &["sim", "--for", "maya", "--out", "a.usda"], 2, &["any, unreal, blender"]);
    fails(at, &["sim", "--for", "unreal", "--out", "a.npz"], 1, &["for", "unreal", ".usda"]);
    fails(at, &["sim", "--every", "2"], 2, &["--out"]);
    fails(at, &["sim", "--resume", "a.npz"], 1, &["made 8 frames", "--frames", "a.npz"]);
    let every = ["sim", "--resume", "a.npz", "--frames", "9", "--every", "2"];
    fails(at, &every, 1, &["every frame from 0 on", "something else", "--what guides --every 1 --from 0"]);
    fails(at, &["render", "--cache", "none.npz"], 1, &["cannot read the cache", "none.npz"]);
    fails(
        at,
        &["render", "--cache", "a.npz", "--scene", "demo"],
        1,
        &["40 strands, 640 points", "the scene's hair has"],
    );
    fails(
        at,
        &["sim", "--scene", "small.toml", "--out", "no/a.npz"],
        1,
        &["cannot write the cache", "no/a.npz"],
    );
}
