//! Grooms of every format.

use super::*;

#[test]
fn grooms_that_claim_much_or_hold_many() {
    let header = |strands: u32, points: u32, flags: u32, segments: u32| {
        let mut bytes = b"HAIR".to_vec();
        [strands, points, flags, segments].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.resize(128, 0);
        bytes
    };
    give("claims.hair", &header(8_000_000, 16_000_000, 2, 1));
    let mut many = header(43_000, 86_000, 2, 1);
    let mut next = numbers();
    (0..86_000 * 3).for_each(|_| many.extend((next() as f32).to_le_bytes()));
    give("many.hair", &many);
    give("zeros.tfx", &[0; LARGEST]);
}

/// A groom of strands of two points that fills a file, and its bytes in a format.
fn written(ending: &str, strands: usize) -> Vec<u8> {
    let mut groom = strandline::Groom::empty(8e-5);
    for strand in 0..strands {
        let root = glam::Vec3::new((strand % 200) as f32, 0.0, (strand / 200) as f32) * 5e-4;
        groom.push([root, root + 0.01 * glam::Vec3::Y]);
    }
    let path = tempfile::tempdir().unwrap();
    let path = path.path().join(format!("groom.{ending}"));
    strandline::format::save(&groom, &path).unwrap();
    std::fs::read(path).unwrap()
}

const FORMATS: [&str; 8] = ["hair", "tfx", "data", "bin", "ply", "npz", "npy", "obj"];

/// Files as large as they may be here, honest ones first; then every number of the first hundred bytes is a very
/// large one.
#[test]
fn every_format_full_and_with_numbers_that_lie() {
    for ending in FORMATS {
        let name = if ending == "obj" { "lines.obj".to_owned() } else { format!("groom.{ending}") };
        // Later strands have longer numbers where they are text.
        let full = written(ending, LARGEST * 8 / 10 / written(ending, 1000).len() * 1000);
        assert!(full.len() > LARGEST / 2, "{ending}: {} bytes show little", full.len());
        give(&name, &full);
        let small = written(ending, 40);
        for at in (0..100.min(small.len() - 4)).step_by(4) {
            let mut lying = small.clone();
            lying[at..at + 4].copy_from_slice(&0x7fff_ffff_u32.to_le_bytes());
            give(&name, &lying);
        }
        give(&name, &[0; LARGEST]);
        give(&name, &[b'9'; LARGEST]);
    }
}

/// Numbers as text that are as short as can be: a point takes more than its bytes.
#[test]
fn texts_of_the_shortest_numbers() {
    let lines = "v 0 0 0\nv 1 0 0\nl -1 -2\n";
    give("lines.obj", lines.repeat(LARGEST / lines.len()).as_bytes());
    give("lines.obj", "l -1 -1\n".repeat(LARGEST / 8).as_bytes());
    let count = (LARGEST - 200) / 6;
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    );
    give("groom.ply", (head + &"0 0 0\n".repeat(count)).as_bytes());
    let header = |shape: &str| {
        let text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({shape}), }}\n");
        [b"\x93NUMPY\x01\x00".as_slice(), &(text.len() as u16).to_le_bytes(), text.as_bytes()].concat()
    };
    for shape in ["8000000, 16, 3", "4294967295, 4294967295, 3", "1, 16777216, 3", "1048576, 0, 3"] {
        give("groom.npy", &header(shape));
    }
}

/// A project may name a file as often as it may name files.
#[test]
fn projects_that_name_a_file_often() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    std::fs::write(folder.path().join("part.tfx"), written("tfx", 200)).unwrap();
    let project =
        |lines: usize| std::fs::write(folder.path().join("a.tfxproj"), "part.tfx\n".repeat(lines)).unwrap();
    for (lines, code) in [(256, 0), (257, 1), (LARGEST / 9, 1)] {
        project(lines);
        let (found, peak, error) =
            run(folder.path(), &["sim", "--scene", "scene.toml", "--groom", "a.tfxproj"]);
        assert_eq!(found, Some(code), "{lines} lines: {error}");
        assert!(peak <= MEMORY, "{lines} lines: {peak} MiB");
    }
}

/// The memory requested before a file is read covers the reading, for the shortest numbers too.
#[test]
fn a_groom_takes_no_more_than_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let count = 4_000_000;
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
         element edge {count}\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n0 9 0\n"
    );
    let files = [
        ("edges.ply", head + &"0 1\n".repeat(count)),
        ("lines.obj", "v 0 0 0\nv 1 0 0\nl -1 -2\n".repeat(count / 4)),
    ];
    // The program itself takes some 20 MiB, and its allocator as much of what was just given back.
    let itself = 50;
    for (name, text) in files {
        std::fs::write(folder.path().join(name), &text).unwrap();
        let format = strandline::format::Format::of(Path::new(name)).unwrap();
        let (code, peak, error) = run(folder.path(), &["convert", name, "out.hair"]);
        assert!(matches!(code, Some(0 | 1)), "{name}: {error}");
        let length = (text.len() >> 20) as u64;
        assert!(peak < itself + format.taken * length, "{name}: {peak} MiB for {length}: {error}");
        assert!(peak > format.taken * length / 2, "{name}: {peak} MiB for {length} show nothing");
    }
}
