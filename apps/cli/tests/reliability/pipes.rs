//! Output that nobody reads, or that no disk takes.

use std::fs::OpenOptions;

use super::*;

/// One of each kind of output.
fn commands(folder: &Path) -> Vec<Vec<&'static str>> {
    works(folder, &["groom", "--style", "bob", "--strands", "20", "--out", "a.hair"]);
    vec![
        vec!["--help"],
        vec!["--version"],
        vec!["info", "a.hair"],
        vec!["info", "a.hair", "--json"],
        vec!["convert", "a.hair", "b.tfx"],
        vec!["groom", "--style", "bob", "--strands", "20", "--out", "c.hair"],
        vec!["scene", "demo"],
        vec!["gpus"],
        vec!["shaders", "linked"],
        vec!["sim", "--scene", "small.toml"],
        vec!["sim", "--scene", "small.toml", "--json"],
        vec!["render", "--scene", "small.toml"],
        vec!["render", "--scene", "small.toml", "--json"],
    ]
}

#[test]
fn a_reader_that_goes_away_ends_the_program_quietly() {
    let folder = folder();
    for arguments in commands(folder.path()) {
        let mut child = strandline(folder.path(), &arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let error = error(&output);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {error}");
        // Notes may name features that the format of a file cannot hold, or a missing ffmpeg.
        assert!(error.lines().all(|line| line.starts_with("note: ")), "{arguments:?}: {error}");
    }
    // Files that were written before exist.
    assert!(is_whole(&folder.path().join("b.tfx")) && is_whole(&folder.path().join("c.hair")));
    assert_eq!(names(&folder.path().join("out/small")).len(), 4 + 2);
    let head = format!("{} scene demo | head -n 1", env!("CARGO_BIN_EXE_strandline"));
    let output = Command::new("sh").args(["-c", &head]).output().unwrap();
    assert_eq!(
        (output.stdout.iter().filter(|byte| **byte == b'\n').count(), error(&output)),
        (1, String::new())
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_the_output_is_an_error() {
    let folder = folder();
    let full = || Stdio::from(OpenOptions::new().write(true).open("/dev/full").unwrap());
    for arguments in commands(folder.path()) {
        let output = strandline(folder.path(), &arguments).stdout(full()).output().unwrap();
        let error = error(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
        assert!(
            error.contains("cannot write to the standard output") && !error.contains("panicked"),
            "{error}"
        );
    }
    // The code tells of an error that cannot be printed.
    for (arguments, code) in
        [(["info", "absent.hair"], 1), (["info", "--absent"], 2), (["convert", "a.hair"], 2)]
    {
        let output = strandline(folder.path(), &arguments).stderr(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    }
}

#[test]
fn closed_outputs_are_no_panic() {
    let folder = folder();
    commands(folder.path());
    let program = env!("CARGO_BIN_EXE_strandline");
    for (arguments, closed, code) in [
        ("info a.hair", ">&-", 0),
        ("info a.hair", ">&- 2>&-", 0),
        ("info absent.hair", "2>&-", 1),
        ("sim --scene small.toml", ">&- 2>&-", 0),
        ("render --scene small.toml --out new", ">&- 2>&- <&-", 0),
    ] {
        let line = format!("{program} {arguments} {closed}");
        let status = Command::new("sh").args(["-c", &line]).current_dir(folder.path()).status().unwrap();
        assert_eq!(status.code(), Some(code), "{line}");
    }
    assert_eq!(names(&folder.path().join("new")).len(), 4 + 2);
}
