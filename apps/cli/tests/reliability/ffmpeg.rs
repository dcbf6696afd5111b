//! An ffmpeg that fails, and folders whose names it could take for something else.

use super::*;

#[test]
fn a_video_that_fails_is_a_code_of_its_own_and_leaves_the_former_one() {
    let folder = folder();
    let render = ["render", "--scene", "small.toml", "--out", "out"];
    works(folder.path(), &render);
    let out = folder.path().join("out");
    std::fs::write(out.join("video.mp4"), b"former").unwrap();
    let half = "#!/bin/sh\nfor last; do true; done\nhead -c 1000 > \"${last#file:}\"\n";
    let script = format!("{half}printf 'no such\\033[2J encoder\\n' >&2\nexit 1\n");
    let (_keep, search) = with_program("ffmpeg", &script);
    let output = strandline(folder.path(), &render).env("PATH", search).output().unwrap();
    let error = error(&output);
    assert_eq!(output.status.code(), Some(4), "{error}");
    for words in
        ["ffmpeg ended with exit status: 1: no such\\u{1b}[2J encoder", "made no video", "earlier film"]
    {
        assert!(error.contains(words), "`{words}` is missing: {error}");
    }
    assert_eq!(std::fs::read(out.join("video.mp4")).unwrap(), b"former");
    let left = names(&out);
    assert_eq!(left.iter().filter(|name| !name.ends_with(".gif")).count(), 4 + 2, "{left:?}");
}

/// It cannot be started where there is none, and an image is made in its place.
#[test]
fn without_ffmpeg_there_is_an_animated_image() {
    let folder = folder();
    let render = ["render", "--scene", "small.toml", "--out", "out"];
    let output = strandline(folder.path(), &render).env("PATH", "/nowhere").output().unwrap();
    assert!(output.status.success() && error(&output).contains("no ffmpeg found"), "{}", error(&output));
    check_whole(&folder.path().join("out"));
    assert_eq!(names(&folder.path().join("out")).first().unwrap(), "animation.gif");
}

#[test]
fn a_folder_may_be_called_anything() {
    let folder = folder();
    for out in ["-x", "file:x", "tcp:1", "a%03d", "two words\n\"'", "--", "ä"] {
        let argument = format!("--out={out}");
        works(folder.path(), &["render", "--scene", "small.toml", &argument]);
        let out = folder.path().join(out);
        assert_eq!(names(&out).len(), 4 + 2, "{}", out.display());
        check_whole(&out);
        assert!(moving(&out).is_some());
    }
}
