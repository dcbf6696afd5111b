//! Grown hair, written by `strandline groom` with its guides and read again: the picture of its style.

use std::path::Path;
use std::process::Command;

use strandline::{Picture, Style};
use strandline_checks::{flip::compare, in_full};

/// Guides and strands in all.
const COUNTS: [&str; 2] = ["300", "2400"];

/// Runs the program; what it notes.
fn run(folder: &Path, arguments: &[&str]) -> String {
    let program = env!("CARGO_BIN_EXE_strandline");
    let output = Command::new(program).args(arguments).current_dir(folder).output().unwrap();
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {notes}");
    notes
}

/// The first picture of a scene of a size, and the notes.
fn drawn(folder: &Path, size: &str, scene: &[&str]) -> (Picture, String) {
    let rest =
        ["--motion", "still", "--frames", "1", "--size", size, "--backend", "cpu", "--out", "drawn.png"];
    let notes = run(folder, &[&["render"], scene, &rest].concat());
    let drawn = image::open(folder.join("drawn.png")).unwrap().into_rgb8();
    let (width, height) = drawn.dimensions();
    (Picture { width, height, pixels: drawn.into_raw(), alpha: None }, notes)
}

#[test]
fn a_style_that_was_written_and_read_is_drawn_as_the_style() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [guides, strands] = COUNTS;
    let few = ["long", "bun", "bob", "brows", "lashes"];
    let styles = if in_full() { Style::ALL.map(Style::name).to_vec() } else { few.to_vec() };
    let [guide_key, strand_key] = [format!("style.strand_count={guides}"), format!("groom.bound={strands}")];
    for style in styles {
        // Small pictures leave out the strands that follow those of the file; in one picture they are seen.
        let size = if style == "long" { "256x256" } else { "96x96" };
        let file = if style == "bob" { "bob.ply" } else { "other.npz" };
        run(at, &["groom", "--style", style, "--strands", strands, "--guides", guides, "--out", file]);
        let (grown, _) = drawn(at, size, &["--style", style, "--set", &guide_key, "--set", &strand_key]);
        // A file does not say of how many hairs it is; those of a face are fewer.
        let hairs = match style {
            "beard" => "look.hair_count=25000",
            "brows" => "look.hair_count=1500",
            "lashes" => "look.hair_count=550",
            _ => "look.hair_count=100000",
        };
        let (read, notes) = drawn(at, size, &["--groom", file, "--set", hairs]);
        assert!(notes.contains("taken from the file: groom.points_per_strand"), "{notes}");
        println!("{style}: {}", compare(&read, &grown, 0.0, 0.0).err().unwrap_or_default());
        // Files have 32 bits of each number, and follow strands that depend on nothing else: found 0.
        compare(&read, &grown, 0.01, 0.1).unwrap_or_else(|error| panic!("{style}: {error}"));
        if style == "bob" {
            let (other, notes) = drawn(at, size, &["--groom", file, "--set", "groom.guides=200"]);
            assert!(notes.contains("chosen to fit") && !notes.contains("taken from the file"), "{notes}");
            assert!(compare(&other, &grown, 0.01, 0.1).is_err(), "the comparison can fail");
        }
    }
}
