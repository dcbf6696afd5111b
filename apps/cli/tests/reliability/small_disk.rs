//! A disk of 256 kB.

use super::*;

/// Exit code of the shell if the disk was mounted, for any result of the line.
const MADE: i32 = 76;

/// Runs a line of the shell in a folder on such a disk, where that may be made.
fn on_small_disk(line: &str) -> Option<Output> {
    let folder = folder();
    let script = format!(
        "mkdir disk && mount -t tmpfs -o size=256k none disk && cd disk || exit 1\n\
         strandline() {{ '{}' \"$@\"; }}\n{line}\nexit {MADE}",
        env!("CARGO_BIN_EXE_strandline")
    );
    for rights in [&["--mount"][..], &["--map-root-user", "--mount"]] {
        let mut command = Command::new("unshare");
        let output =
            command.args(rights).args(["sh", "-c", &script]).current_dir(folder.path()).output().ok()?;
        if output.status.code() == Some(MADE) {
            return Some(output);
        }
        let _ = std::fs::remove_dir(folder.path().join("disk"));
    }
    None
}

/// The last output: a code, then the names and sizes of the files.
fn outcome(output: &Output) -> (String, String) {
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    let (code, left) = text.trim().split_once('\n').unwrap_or((text.trim(), ""));
    (code.to_owned(), left.to_owned())
}

#[test]
fn a_disk_that_fills_up_is_an_error_and_leaves_nothing_half() {
    let line = "strandline groom --style bob --strands 2000 --out a.hair >/dev/null; echo $?; ls -A";
    let Some(output) = on_small_disk(line) else {
        println!("NOT TESTED: no right to make a small disk");
        return;
    };
    assert_eq!(outcome(&output), ("1".to_owned(), String::new()), "{}", error(&output));
    assert!(error(&output).contains("No space left"), "{}", error(&output));

    let line = "strandline groom --style bob --strands 100 --out a.hair >/dev/null; \
                strandline convert a.hair b.hair --points 400 >/dev/null; echo $?; ls -A";
    let output = on_small_disk(line).unwrap();
    assert_eq!(outcome(&output), ("1".to_owned(), "a.hair".to_owned()), "{}", error(&output));

    let line = "strandline render --scene ../small.toml --frames 400 --out film >/dev/null; echo $?; \
                ls -A film";
    let output = on_small_disk(line).unwrap();
    let ((code, left), error) = (outcome(&output), error(&output));
    assert_eq!(code, "1", "{error}");
    // It runs out at a frame, or at the animated image that grows beside them.
    let full = ["the disk is full", "No space left"].iter().any(|reason| error.contains(reason));
    assert!(full && error.contains("frames already written are whole"), "{error}");
    assert!(left.lines().all(|name| name.starts_with("frame_") && name.ends_with(".png")), "{left}");
}

#[test]
fn a_cache_on_a_disk_that_fills_up_has_the_frames_before() {
    let line = "strandline sim --scene ../small.toml --frames 400 --out a.npz >/dev/null; echo $?; ls -A; \
                cp a.npz ..; cd ..; strandline render --cache a.npz --out film >/dev/null && echo drawn";
    let Some(output) = on_small_disk(line) else {
        println!("NOT TESTED: no right to make a small disk");
        return;
    };
    let ((code, left), error) = (outcome(&output), error(&output));
    assert_eq!((code.as_str(), left.as_str()), ("1", "a.npz\ndrawn"), "{error}");
    assert!(error.contains("cannot write the cache: No space left"), "{error}");
}
