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

#[test]
fn info_knows_bodies_in_motion() {
    let folder = tempfile::tempdir().unwrap();
    for frame in 1..4 {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 {frame} 0\nf 1 2 3\n");
        std::fs::write(folder.path().join(format!("walk{frame:02}.obj")), text).unwrap();
    }
    let pattern = folder.path().join("walk%02d.obj");
    for path in [&pattern, folder.path()] {
        let output = strandline(&["info", path.to_str().unwrap()]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let words = "mesh in motion\nvertices  3\ntriangles 1\nmotion    0.000 to 0.083 s\n";
        assert!(output.status.success() && text.ends_with(words), "{text}{output:?}");
    }
    let output = strandline(&["info", "--json", pattern.to_str().unwrap()]);
    let object: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(object["motion_s"][0], 0.0);
}

#[cfg(target_os = "linux")]
#[test]
fn info_knows_arrays_of_vertices() {
    use super::hostile_files::{ROW, cache};
    let vertices = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let array = |kind: &str, shape: &str| format!("'descr': '{kind}', {ROW}: ({shape})");
    let [of_vertices, of_faces, of_times] =
        [("<f4", "2, 3, 3"), ("|u1", "1, 3"), ("<f8", "2,")].map(|(kind, shape)| array(kind, shape));
    let times = [41.5_f64, 42.0].map(f64::to_le_bytes).concat();
    let arrays = [
        ("vertices.npy", of_vertices.as_str(), &vertices[..], 2),
        ("faces.npy", of_faces.as_str(), &[0, 1, 2][..], 1),
        ("times.npy", of_times.as_str(), &times[..], 1),
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.npz");
    std::fs::write(&path, cache(&arrays)).unwrap();
    let output = strandline(&["info", path.to_str().unwrap()]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let words = "mesh in motion\nvertices  3\ntriangles 1\nmotion    41.500 to 42.000 s\n";
    assert!(output.status.success() && text.ends_with(words), "{text}{output:?}");
}

/// Runs `sim` on a body under a limit of memory, which refuses it.
#[cfg(target_os = "linux")]
fn refused(name: &str, bytes: &[u8], arguments: &[&str], words: &str) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_strandline"))
        .args(["sim", "--frames", "1", "--look", "thesis", "--set", "style.strand_count=10", "--body", name])
        .args(arguments)
        .env("STRANDLINE_MEMORY", "256")
        .current_dir(folder.path())
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(error.contains(words) && error.contains("more than the 256 MiB"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn numbers_of_small_files_are_counted_before_they_are_read() {
    use super::hostile_files::{ROW, cache};
    let vertices = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let [of_vertices, of_faces] = [("<f4", "1, 3, 3"), ("|u1", "7000000, 3")]
        .map(|(kind, shape)| format!("'descr': '{kind}', {ROW}: ({shape})"));
    let arrays = [
        ("vertices.npy", of_vertices.as_str(), &vertices[..], 1),
        ("faces.npy", of_faces.as_str(), &[0; 3000][..], 7000),
    ];
    refused("walk.npz", &cache(&arrays), &[], "the array `faces` of the body would take 261 MiB");
    // Zeros but for the first one: many keys of a small file, in many channels.
    let sparse = |kind: &str| {
        format!(
            r#"{{"componentType":5126,"count":65536,"type":"{kind}","sparse":{{"count":1,"indices":{{"bufferView":0,
"componentType":5125}},"values":{{"bufferView":0}}}}}}"#
        )
    };
    let channel = r#"{"sampler":0,"target":{"node":0,"path":"translation"}}"#;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"buffers":[{{"byteLength":12,
"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}}],"bufferViews":[{{"buffer":0,"byteLength":12}}],
"accessors":[{},{}],"animations":[{{"name":"go","samplers":[{{"input":0,"output":1}}],"channels":[{}]}}]}}"#,
        sparse("SCALAR"),
        sparse("VEC3"),
        [channel; 120].join(",")
    );
    refused("go.gltf", json.as_bytes(), &["--clip", "go"], "the keys of the clip of the body would take");
}
