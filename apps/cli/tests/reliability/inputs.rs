//! Inputs that are no files, and what they may do to a terminal.

use super::*;

/// Runs and expects an error of one line, soon.
fn refused(folder: &Path, arguments: &[&str], words: &[&str]) -> String {
    let begin = Instant::now();
    let output = run(folder, arguments);
    let error = error(&output);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
    for word in words {
        assert!(error.contains(word), "`{word}` is missing for {arguments:?}: {error}");
    }
    assert!(begin.elapsed() < Duration::from_secs(20), "{arguments:?} took {:?}", begin.elapsed());
    error
}

#[cfg(target_os = "linux")]
#[test]
fn what_is_no_file_is_refused_at_once() {
    let folder = folder();
    let at = folder.path();
    for ending in ["hair", "toml", "obj", "safetensors", "hdr", "npz", "png"] {
        let name = format!("pipe.{ending}");
        assert!(Command::new("mkfifo").arg(at.join(name)).status().unwrap().success());
    }
    for name in ["zero.hair", "zero.toml", "zero.obj"] {
        std::os::unix::fs::symlink("/dev/zero", at.join(name)).unwrap();
    }
    let scene = std::fs::read_to_string(at.join("small.toml")).unwrap();
    for (name, keys) in [
        ("posed.toml", "groom.pose = \"pipe.npz\""),
        ("attributes.toml", "groom.attributes = \"pipe.safetensors\""),
        ("surroundings.toml", "surroundings.file = \"pipe.hdr\""),
    ] {
        std::fs::write(at.join(name), format!("{keys}\n{scene}")).unwrap();
    }
    works(at, &["groom", "--style", "bob", "--strands", "3", "--out", "few.hair"]);
    let mapped = scene.replace("[look]", "[groom]\nfile = \"few.hair\"\n[look]\ncolor_map = \"pipe.png\"");
    std::fs::write(at.join("mapped.toml"), mapped).unwrap();
    let plain = "expected a plain file";
    for arguments in [
        &["info", "pipe.hair"][..],
        &["info", "zero.hair"],
        &["convert", "zero.hair", "a.tfx"],
        &["scene", "pipe.toml"],
        &["sim", "--scene", "zero.toml"],
        &["sim", "--scene", "posed.toml"],
        &["sim", "--scene", "attributes.toml"],
        &["render", "--scene", "surroundings.toml"],
        &["render", "--scene", "mapped.toml"],
        &["render", "--cache", "pipe.npz", "--out", "film"],
        &["sim", "--scene", "small.toml", "--resume", "pipe.npz", "--out", "more.npz"],
        &["sim", "--scene", "small.toml", "--body", "pipe.obj"],
        &["sim", "--scene", "small.toml", "--body", "zero.obj"],
        &["sim", "--scene", "small.toml", "--groom", "pipe.hair"],
    ] {
        refused(at, arguments, &[plain]);
    }
    std::fs::write(at.join("large.toml"), vec![b'\n'; (8 << 20) + 1]).unwrap();
    refused(at, &["scene", "large.toml"], &["8388609 bytes, expected 8 MiB at most"]);
}

#[test]
fn a_volume_too_large_for_the_gpu_is_refused_by_its_key() {
    let folder = folder();
    if run(folder.path(), &["gpus"]).stdout.starts_with(b"no GPU") {
        println!("not tested on a GPU: no adapter");
        return;
    }
    let scene = std::fs::read_to_string(folder.path().join("small.toml")).unwrap();
    std::fs::write(folder.path().join("fine.toml"), scene.replace("[8, 8, 8]", "[512, 512, 512]")).unwrap();
    let fine = ["sim", "--scene", "fine.toml", "--sim-device", "gpu"];
    refused(folder.path(), &fine, &["simulation.volume.cells is 512 x 512 x 512", "take fewer"]);
}

#[test]
fn files_do_not_command_the_terminal() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("e.toml"), "x = \"\u{1b}[2J\u{1b}]0;title\u{7}\" y").unwrap();
    std::fs::write(at.join("long.toml"), format!("x = \"{}\" y", "z".repeat(200_000))).unwrap();
    std::fs::write(at.join("a\u{1b}[2J.hair"), b"PK\x03\x04").unwrap();
    for file in ["e.toml", "long.toml", "a\u{1b}[2J.hair"] {
        let command = if file.ends_with("hair") { "info" } else { "scene" };
        let error = refused(at, &[command, file], &[]);
        assert!(!error.contains(|character: char| character.is_control() && character != '\n'), "{error:?}");
        assert!(error.len() < 4000, "{} bytes", error.len());
    }
    assert!(refused(at, &["scene", "e.toml"], &["\\u{1b}[2J"]).contains("\\u{7}"));
    // Notes and results too.
    works(at, &["groom", "--style", "bob", "--strands", "3", "--out", "b\u{1b}[2J.hair"]);
    let output = run(at, &["info", "b\u{1b}[2J.hair"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("b\\u{1b}[2J.hair: .hair") && !text.contains('\u{1b}'), "{text:?}");
}

#[test]
fn messages_of_libraries_are_shown_when_they_are_asked_for() {
    let folder = folder();
    let run = |arguments: &[&str], log: Option<&str>| {
        let mut command = strandline(folder.path(), arguments);
        command.env_remove("RUST_LOG").env_remove("XDG_RUNTIME_DIR").env_remove("NODEVICE_SELECT");
        command.envs(log.map(|log| ("RUST_LOG", log))).output().unwrap()
    };
    let quiet = error(&run(&["gpus"], None));
    assert!(!quiet.contains("XDG_RUNTIME_DIR"), "{quiet}");
    let count = |output: &Output| error(output).lines().filter(|line| line.contains("wgpu")).count();
    assert_eq!(count(&run(&["gpus"], None)), 0);
    assert!(count(&run(&["gpus", "--log", "trace"], None)) > 0, "wgpu says what it looks for");
    assert!(count(&run(&["gpus"], Some("wgpu_hal=trace,wgpu_core=trace"))) > 0);
    assert_eq!(count(&run(&["gpus", "--log", "off"], Some("trace"))), 0, "the command line comes first");
    assert_eq!(run(&["gpus", "--log", "loud"], None).status.code(), Some(2));
}

#[test]
fn a_frame_within_a_step_makes_one() {
    let folder = folder();
    let scene = std::fs::read_to_string(folder.path().join("small.toml")).unwrap();
    let still = scene.replace("frames = 4", "frames = 1\nframes_per_second = 1000.0");
    std::fs::write(folder.path().join("still.toml"), still).unwrap();
    let text = String::from_utf8(run(folder.path(), &["sim", "--scene", "still.toml"]).stdout).unwrap();
    assert!(text.contains(" 1 step on"), "{text}");
}
