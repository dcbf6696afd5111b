//! Hair whose points are no numbers.

use super::*;

/// Velocities \[m/s\] of the first of 40 strands of 16 points, as a safetensors file.
fn velocities(of_first: f32) -> Vec<u8> {
    let header = "{\"velocities\":{\"dtype\":\"F32\",\"shape\":[40,16,3],\"data_offsets\":[0,7680]}}";
    let numbers = (0..40 * 16 * 3).flat_map(|at| if at < 48 { of_first } else { 0.0 }.to_le_bytes());
    let length = (header.len() as u64).to_le_bytes();
    length.into_iter().chain(header.bytes()).chain(numbers).collect()
}

/// Such a run says where, goes on to its end, and ends with 3: what is there is not to be trusted by a script.
#[test]
fn a_run_says_where_goes_on_and_ends_with_3() {
    let folder = folder();
    let at = folder.path();
    let keys = "groom.points_per_strand = 16\ngroom.attributes = \"velocities.safetensors\"\n";
    std::fs::write(at.join("fast.toml"), format!("{keys}{SMALL}")).unwrap();
    let sim = ["sim", "--scene", "fast.toml", "--json"];
    let render = ["render", "--scene", "fast.toml", "--out", "film"];
    std::fs::write(at.join("velocities.safetensors"), velocities(1.0)).unwrap();
    works(at, &sim);
    std::fs::write(at.join("velocities.safetensors"), velocities(3e38)).unwrap();
    for arguments in [&sim[..], &render] {
        let output = run(at, arguments);
        let error = error(&output);
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {error}");
        assert!(error.contains("frame 0, strand 0"), "{arguments:?}: {error}");
    }
    // Whether anybody reads what is printed or not.
    let mut unread = strandline(at, &sim).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    drop(unread.stdout.take());
    assert_eq!(unread.wait().unwrap().code(), Some(3));
    let names = names(&at.join("film"));
    assert_eq!(names.iter().filter(|name| name.starts_with("frame_")).count(), 4, "{names:?}");
    let output = run(at, &sim);
    let json = String::from_utf8(output.stdout).unwrap();
    assert!(json.contains("\"non_finite\":") && !json.contains("\"non_finite\":0,"), "{json}");
}
