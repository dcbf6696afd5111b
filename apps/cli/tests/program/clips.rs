//! Clips of bodies: listed, chosen, and refused by name.

use std::process::{Command, Output};

fn strandline(arguments: &[&str]) -> Output {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    Command::new(env!("CARGO_BIN_EXE_strandline")).args(arguments).current_dir(folder).output().unwrap()
}

#[test]
fn info_lists_the_clips_of_a_body() {
    let output = strandline(&["info", "bust.glb"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && text.starts_with("bust.glb: glTF\nvertices  "), "{text}");
    let clips: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("clip      ")).collect();
    assert_eq!(clips, ["nod", "look", "shrug", "smile"]);
    let object = strandline(&["info", "--json", "bust.glb"]).stdout;
    let object: serde_json::Value = serde_json::from_slice(&object).unwrap();
    assert_eq!(object["clips"][2], "shrug");
    assert!(object["triangles"].as_u64() > Some(10_000));
}

#[test]
fn a_clip_is_played_by_its_name() {
    let small =
        ["--frames", "2", "--backend", "cpu", "--set", "style.strand_count=20", "--set", "body.spacing=0.02"];
    let run = |clip: &str| {
        strandline(&[&["sim", "--json", "--body", "bust.glb", "--clip", clip][..], &small].concat())
    };
    let output = run("shrug");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = run("walk");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && words.contains("bust.glb: `nod`, `look`"), "{words}");
}
