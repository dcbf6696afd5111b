//! `--set KEY=VALUE` of every command that takes a scene.

use std::path::Path;
use std::process::{Command, Output};

use crate::refusal::refused;

fn strandline(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_strandline")).args(arguments).current_dir(folder).output().unwrap()
}

#[test]
fn values_are_set_in_every_command_that_takes_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let printed = |arguments: &[&str]| {
        let output = strandline(folder.path(), arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let set = ["--set", "simulation.gravity=[0,-1.6,0]", "--set", "lights[0].position=[0,1,2]"];
    let scene = printed(&[&["scene", "demo"][..], &set].concat());
    assert!(scene.contains("gravity = [0.0, -1.6, 0.0]"), "{scene}");
    assert!(scene.contains("[[lights]]"), "{scene}");
    let small = ["--frames", "9", "--set", "film.frames=2", "--set", "style.strand_count=5"];
    let report =
        printed(&[&["sim", "--json", "--backend", "cpu", "--set", "film.settle=0"][..], &small].concat());
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    // Values replace those of options: two frames of two steps each, not nine.
    assert_eq!((report["steps"].as_u64(), report["strands"].as_u64()), (Some(4), Some(5)), "{report}");
}

#[test]
fn mistakes_are_told_with_the_nearest_key_and_the_range() {
    let folder = tempfile::tempdir().unwrap();
    for (value, words) in [
        ("simulation.gravty=1", ["no setting of a scene", "`simulation.gravity`"]),
        ("film.frames=0", ["film.frames is 0", "expected 1 to"]),
        ("film.frames", ["needs KEY=VALUE", "1 to 1,000,000"]),
        ("motion.name=jump", ["is \"jump\"", "one of still"]),
    ] {
        for command in [&["scene"][..], &["sim"], &["render"]] {
            let output = refused(folder.path(), &[command, &["--set", value]].concat());
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(2), "{command:?} {value}: {error}");
            assert!(words.iter().all(|words| error.contains(words)), "{command:?} {value}: {error}");
        }
    }
}

#[test]
fn a_groom_is_grown_with_settings_of_its_style_and_head() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let grown = |set: &[&str]| {
        let all = [&["groom", "--style", "bob", "--strands", "60", "--out", "bob.hair"][..], set].concat();
        let output = strandline(at, &all);
        assert!(output.status.success(), "{all:?}: {}", String::from_utf8_lossy(&output.stderr));
        let lengths = strandline::Groom::load(at.join("bob.hair")).unwrap().lengths();
        lengths.iter().sum::<f32>() / 60.0
    };
    let (long, short) = (grown(&[]), grown(&["--set", "style.length=0.05"]));
    assert!(long > 0.1 && (0.04..0.06).contains(&short), "{long} m, {short} m");
    for (set, word) in [
        ("style.length=9", "0.01"),
        ("groom.points_per_strand=8", "--guides"),
        ("look.grey=1", "keys of `style`"),
        ("style.seed=3", "keys of `style`"),
    ] {
        let output = refused(at, &["groom", "--style", "bob", "--set", set, "--out", "no.hair"]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{set}: {error}");
        assert!(error.contains(set.split('=').next().unwrap()) && error.contains(word), "{set}: {error}");
    }
}
