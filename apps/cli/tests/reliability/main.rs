//! The program under attack: pipes that close, disks that fill up, signals, a second run beside the first,
//! an ffmpeg that fails, files that are none.
#![cfg(unix)]
#![allow(clippy::print_stdout)] // it says what is not tested

mod cache;
mod ffmpeg;
mod inputs;
mod kills;
mod not_finite;
mod pipes;
mod rivals;
mod small_disk;

use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::time::{Duration, Instant};

/// A scene that takes a moment, on the CPU; the default look would take four times as long a picture.
const SMALL: &str = "[style]\nstrand_count = 40\n[body]\nspacing = 0.02\n[look]\npreset = \"thesis\"\nfollow_strands = 2\n\
                     [film]\nframes = 4\nsettle = 0.0\n[picture]\nwidth = 64\nheight = 48\n\
                     [devices]\nsimulation = \"cpu\"\npictures = \"cpu\"\n[simulation]\nvolume.cells = [8, 8, 8]\n";

/// A folder with the small scene.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    folder
}

fn strandline(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strandline"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null());
    command
}

/// The same with a terminal that may be closed, even where the tests run under `nohup`.
fn heeding(folder: &Path, arguments: &[&str]) -> Command {
    let default: &[&str] = if cfg!(target_os = "linux") { &["--default-signal=HUP"] } else { &[] };
    let mut command = Command::new("env");
    command.args(default).arg(env!("CARGO_BIN_EXE_strandline")).args(arguments);
    command.current_dir(folder).stdin(Stdio::null());
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    strandline(folder, arguments).output().unwrap()
}

/// Runs and expects success.
fn works(folder: &Path, arguments: &[&str]) {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", error(&output));
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Sends a signal by its name.
fn send(signal: &str, process: u32) {
    // One that has ended already gets none.
    let _ = Command::new("kill")
        .args([&format!("-{signal}"), &process.to_string()])
        .stderr(Stdio::null())
        .status();
}

/// True if a signal ended the run, or it had ended before; the signal may come before the program listens.
fn ended_by(status: ExitStatus, number: i32) -> bool {
    status.success() || status.code() == Some(128 + number) || status.signal() == Some(number)
}

/// Waits until something is so; fails after five minutes: a busy machine takes more than half a one.
fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < Duration::from_secs(300), "never {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The names in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// True if a file is complete in its format; files under a temporary name do not count.
fn is_whole(path: &Path) -> bool {
    let bytes = std::fs::read(path).unwrap();
    match path.extension().and_then(|ending| ending.to_str()) {
        // A reader is content without the end.
        Some("png") => bytes.ends_with(b"IEND\xaeB`\x82") && image::load_from_memory(&bytes).is_ok(),
        Some("gif") => bytes.starts_with(b"GIF") && bytes.ends_with(b";"),
        Some("mp4") => boxes(&bytes).is_some_and(|names| names.contains(b"moov".as_slice())),
        Some("npz") => strandline::low_level::check_cache(&bytes).is_ok(),
        Some("usda") => bytes.starts_with(b"#usda 1.0\n") && bytes.ends_with(b"\n}\n"),
        Some("hair" | "tfx") => strandline::Groom::load(path).is_ok(),
        Some("toml") | None => true,
        Some("strandline-part" | "strandline-foreign-part" | "strandline-lock") => true,
        Some(other) => panic!("what is {other}? {}", path.display()),
    }
}

/// The names of the boxes of an MP4 file, if they fill it.
fn boxes(mut bytes: &[u8]) -> Option<std::collections::HashSet<&[u8]>> {
    let mut names = std::collections::HashSet::new();
    while !bytes.is_empty() {
        let size = u32::from_be_bytes(bytes.get(..4)?.try_into().ok()?) as usize;
        names.insert(bytes.get(4..8)?);
        bytes = bytes.get(size.max(8)..)?;
    }
    Some(names)
}

/// Every file of a folder is whole.
fn check_whole(folder: &Path) {
    for path in names(folder).into_iter().map(|name| folder.join(name)).filter(|path| path.is_file()) {
        assert!(is_whole(&path), "{} is not whole", path.display());
    }
}

/// A folder with programs that come first.
fn with_program(name: &str, script: &str) -> (tempfile::TempDir, String) {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    // Written by another program: what is open for writing here, in whatever thread, cannot be run.
    let copy = Command::new("sh").args(["-c", "printf '%s' \"$1\" > \"$0\""]).arg(&path).arg(script).status();
    assert!(copy.unwrap().success());
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    let search = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap_or_default());
    (folder, search)
}

/// The moving picture in a folder of pictures.
fn moving(folder: &Path) -> Option<PathBuf> {
    ["video.mp4", "animation.gif"].map(|name| folder.join(name)).into_iter().find(|path| path.is_file())
}

#[test]
fn the_checks_see_what_is_not_whole() {
    let folder = folder();
    works(folder.path(), &["render", "--scene", "small.toml", "--out", "out"]);
    works(folder.path(), &["sim", "--scene", "small.toml", "--out", "out/a.npz"]);
    works(folder.path(), &["sim", "--scene", "small.toml", "--out", "out/a.usda"]);
    let out = folder.path().join("out");
    let good = ["frame_0000.png", "sheet.png", "a.npz", "a.usda"].map(|name| out.join(name));
    for path in good.into_iter().chain(moving(&out)) {
        assert!(is_whole(&path), "{}", path.display());
        let bytes = std::fs::read(&path).unwrap();
        for cut in [0, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..cut]).unwrap();
            assert!(!is_whole(&path), "{} of {} bytes", path.display(), cut);
        }
    }
}
