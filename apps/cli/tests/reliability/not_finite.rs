//! Hair whose points are no numbers.

use super::*;

/// Masses \[kg\] of 40 strands of 16 points, those of the first as given, as a safetensors file.
fn masses(of_first: f32) -> Vec<u8> {
    let header = "{\"masses\":{\"dtype\":\"F32\",\"shape\":[40,16],\"data_offsets\":[0,2560]}}";
    let numbers = (0..40 * 16).flat_map(|at| if at < 16 { of_first } else { 1e-7 }.to_le_bytes());
    let length = (header.len() as u64).to_le_bytes();
    length.into_iter().chain(header.bytes()).chain(numbers).collect()
}

/// Such a run says where, continues to its end, and ends with 3: what is there is not to be trusted by a script.
#[test]
fn a_run_says_where_goes_on_and_ends_with_3() {
    let folder = folder();
    let at = folder.path();
    let keys = "groom.points_per_strand = 16\ngroom.attributes = \"masses.safetensors\"\n";
    let method = "[simulation.strands]\nmethod = \"constrain\"\n";
    std::fs::write(at.join("light.toml"), format!("{keys}{SMALL}{method}")).unwrap();
    let sim = ["sim", "--scene", "light.toml", "--json"];
    let render = ["render", "--scene", "light.toml", "--out", "film"];
    std::fs::write(at.join("masses.safetensors"), masses(2e-7)).unwrap();
    works(at, &sim);
    // The least that single precision holds: whatever is divided by it is infinite.
    std::fs::write(at.join("masses.safetensors"), masses(1e-45)).unwrap();
    for arguments in [&sim[..], &render] {
        let output = run(at, arguments);
        let error = error(&output);
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {error}");
        assert!(error.contains("frame 0, strand 0"), "{arguments:?}: {error}");
    }
    // The code is the same if nobody reads the output.
    let mut unread = strandline(at, &sim).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    drop(unread.stdout.take());
    assert_eq!(unread.wait().unwrap().code(), Some(3));
    let names = names(&at.join("film"));
    assert_eq!(names.iter().filter(|name| name.starts_with("frame_")).count(), 4, "{names:?}");
    let output = run(at, &sim);
    let json = String::from_utf8(output.stdout).unwrap();
    assert!(json.contains("\"non_finite\":") && !json.contains("\"non_finite\":0,"), "{json}");
}
