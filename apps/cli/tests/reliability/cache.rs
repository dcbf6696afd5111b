//! Files kept from run to run save time and change nothing else.

use std::fmt::Write;
use std::path::Path;

use super::{SMALL, error, strandline};

/// A bumpy ball of many triangles, so that its grid takes a moment to build.
fn ball() -> String {
    const ROWS: usize = 80;
    const COLUMNS: usize = 160;
    let mut text = String::new();
    for row in 0..=ROWS {
        for column in 0..COLUMNS {
            let (tilt, turn) = (
                std::f64::consts::PI * row as f64 / ROWS as f64,
                std::f64::consts::TAU * column as f64 / COLUMNS as f64,
            );
            let radius = 0.1 + 0.004 * (7.0 * turn).sin() * tilt.sin().powi(2);
            let (x, y, z) = (tilt.sin() * turn.cos(), tilt.cos(), tilt.sin() * turn.sin());
            writeln!(text, "v {:.6} {:.6} {:.6}", radius * x, radius * y, radius * z).unwrap();
        }
    }
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let at = |row: usize, column: usize| 1 + row * COLUMNS + column % COLUMNS;
            let (a, b) = (at(row, column), at(row, column + 1));
            let (c, d) = (at(row + 1, column), at(row + 1, column + 1));
            writeln!(text, "f {a} {b} {d} {c}").unwrap();
        }
    }
    text
}

/// The first picture of the ball, with what is kept in a folder.
fn picture(folder: &Path, cache: &str) -> Vec<u8> {
    let arguments = ["render", "--scene", "ball.toml", "--out", "film"];
    let output = strandline(folder, &arguments).env("STRANDLINE_CACHE", cache).output().unwrap();
    assert!(output.status.success(), "{}", error(&output));
    std::fs::read(folder.join("film/frame_0000.png")).unwrap()
}

#[test]
fn a_kept_grid_gives_the_same_picture_and_a_broken_one_is_built_anew() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.obj"), ball()).unwrap();
    let scene = SMALL
        .replace("spacing = 0.02", "spacing = 0.0025\nfile = \"ball.obj\"")
        .replace("frames = 4", "frames = 1");
    std::fs::write(folder.path().join("ball.toml"), scene).unwrap();
    let built = picture(folder.path(), "off");
    assert!(picture(folder.path(), "kept") == built);
    let grids = folder.path().join("kept/grids");
    let kept: Vec<_> = std::fs::read_dir(&grids).unwrap().map(|entry| entry.unwrap().path()).collect();
    let [file] = &kept[..] else { panic!("{kept:?}") };
    let whole = std::fs::read(file).unwrap();
    assert!(picture(folder.path(), "kept") == built, "from the file");
    let mut broken = whole.clone();
    let middle = broken.len() / 2;
    broken[middle] ^= 0x40;
    std::fs::write(file, &broken).unwrap();
    assert!(picture(folder.path(), "kept") == built, "from a broken file");
    assert!(std::fs::read(file).unwrap() == whole, "the broken file is not replaced");
}
