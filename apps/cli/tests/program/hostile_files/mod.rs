//! Small files made to take much: each is read or refused in seconds and within half a gigabyte.

mod grooms;
mod mapped;
mod pictures;

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// CPU seconds of a run, of all threads together, start of the program included. The aim is 2 s at the clock of a
/// quiet machine (docs/reliability.md); the largest found here, in the build of the tests, was 3.6 beside other work.
const SECONDS: u32 = 10;
/// Most memory that is resident at once \[MiB\].
const MEMORY: u64 = 500;
/// Largest file that is given \[byte\].
const LARGEST: usize = 1 << 20;

const SCENE: &str =
    "film = { frames = 1, settle = 0.0 }\nsimulation.backend = \"cpu\"\nstyle = { strand_count = 8 }\n";

/// Result of a run of the program: its code, its largest memory \[MiB\], and its messages.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, u64, String) {
    // Past its CPU time the system ends it: then there is no code.
    let script = format!("ulimit -t {SECONDS}; exec \"$0\" \"$@\"");
    let mut program = Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_strandline")])
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::null())
        // A file, since nobody reads a pipe before the program has ended.
        .stderr(std::fs::File::create(folder.join("stderr")).unwrap())
        .spawn()
        .unwrap();
    let status = format!("/proc/{}/status", program.id());
    let mut peak = 0;
    loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
        peak = peak.max(kibibytes.unwrap_or(0) >> 10);
        if let Some(ended) = program.try_wait().unwrap() {
            let error = std::fs::read(folder.join("stderr")).unwrap();
            return (ended.code(), peak, String::from_utf8_lossy(&error).chars().take(300).collect());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Gives the program a file, as a body, a groom or a scene by its ending.
fn give(name: &str, bytes: &[u8]) {
    assert!(bytes.len() <= LARGEST, "{name}: {} bytes", bytes.len());
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), bytes).unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    if name.ends_with("hdr") || name.ends_with("exr") {
        let lit = format!("surroundings.file = \"{name}\"\n{SCENE}picture = {{ width = 16, height = 16 }}\n");
        std::fs::write(folder.path().join("lit.toml"), lit).unwrap();
    }
    if name.ends_with("png") {
        mapped::write_mapped(folder.path(), name);
    }
    let scene = ["sim", "--scene", "scene.toml"];
    let arguments = match name.rsplit_once('.').unwrap().1 {
        "toml" => vec!["sim", "--scene", name],
        "hdr" | "exr" => vec!["render", "--scene", "lit.toml", "--backend", "cpu", "--out", "out"],
        "npz" if name.starts_with("groom") => [&scene[..], &["--groom", name]].concat(),
        "obj" if name.starts_with("lines") => [&scene[..], &["--groom", name]].concat(),
        "hair" | "tfx" | "data" | "bin" | "ply" | "npy" | "tfxproj" => {
            [&scene[..], &["--groom", name]].concat()
        }
        // With the scene that it names, and with this one.
        "npz" if name.starts_with("own") => vec!["render", "--cache", name, "--out", "out"],
        "npz" => vec!["render", "--cache", name, "--scene", "scene.toml", "--out", "out"],
        "png" => vec!["render", "--scene", "mapped.toml", "--out", "out"],
        _ => [&scene[..], &["--body", name]].concat(),
    };
    let (code, peak, error) = run(folder.path(), &arguments);
    assert!(matches!(code, Some(0 | 1)), "{name}: {code:?}: {error}");
    assert!(peak <= MEMORY, "{name}: {peak} MiB: {error}");
}

/// Numbers between 0 and 1, the same ones every time, at no special places.
fn numbers() -> impl FnMut() -> f64 {
    let mut random = strandline::math::Random::new(1, 0);
    move || f64::from(random.bits()) / (1_u64 << 32) as f64
}

#[test]
fn one_thin_triangle_many_times() {
    let rod = "v 0 0 0\nv 0.01 0 60\nv 0 0.01 60\nv 0.01 0.01 0\n";
    give("rod.obj", (rod.to_owned() + &"f 1 2 3\n".repeat(40_000)).as_bytes());
}

#[test]
fn fans_of_thin_triangles() {
    let rim = |count: u32| {
        let mut text = "v 0 .1 0\nv 0 -.1 0\n".to_owned();
        for index in 0..count {
            let angle = std::f64::consts::TAU * f64::from(index) / f64::from(count);
            writeln!(text, "v {:.6} 0 {:.6}", 0.1 * angle.sin(), 0.1 * angle.cos()).unwrap();
        }
        text
    };
    let (count, mut fan) = (18_000, rim(18_000));
    let mut star = fan.clone();
    for index in 0..count {
        let (here, next) = (index + 3, (index + 1) % count + 3);
        writeln!(fan, "f 1 {here} {next}").unwrap();
        // One that has an edge of its own with each: every one is open.
        writeln!(star, "f 1 2 {here}").unwrap();
    }
    give("open_fan.obj", fan.as_bytes());
    give("star.obj", star.as_bytes());
    let corners: String = (3..36_003).map(|corner| format!(" {corner}")).collect();
    give("polygon.obj", (rim(36_000) + "f" + &corners + "\n").as_bytes());
}

#[test]
fn large_triangles_in_any_order() {
    let mut next = numbers();
    let mut text = String::new();
    for _ in 0..1000 {
        writeln!(text, "v {:.3} {:.3} {:.3}", next(), next(), next()).unwrap();
    }
    while text.len() < LARGEST - 40 {
        let [a, b, c] = std::array::from_fn(|_| 1 + (1000.0 * next()) as u32);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    give("cloud.obj", text.as_bytes());
    // The same inside a cube, whose inside they are then.
    let cube = "v -1 -1 -1\nv 2 -1 -1\nv -1 2 -1\nv -1 -1 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let rest: String =
        text.lines().filter(|line| line.starts_with('v')).flat_map(|line| [line, "\n"]).collect();
    let mut inner = cube.to_owned() + &rest;
    while inner.len() < LARGEST - 40 {
        let [a, b, c] = std::array::from_fn(|_| 5 + (1000.0 * next()) as u32);
        writeln!(inner, "f {a} {b} {c}").unwrap();
    }
    give("buried.obj", inner.as_bytes());
}

#[test]
fn bodies_far_too_large_or_in_many_parts() {
    give("far.obj", b"v 0 0 0\nv 0 1 0\nv 1 0 0\nv 35000 0 0\nf 1 2 3\nf 1 3 4\n");
    give("cube.obj", b"v -1 -1 -1\nv 2 -1 -1\nv -1 2 -1\nv -1 -1 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let parts: String = (0..50_000).map(|part| format!("o {part}\nf 1 2 3\n")).collect();
    give("parts.obj", ("v 0 0 0\nv 0 1 0\nv 1 0 0\n".to_owned() + &parts).as_bytes());
    give("line.obj", &[b'f'; LARGEST]);
    give("spaces.obj", &[b' '; LARGEST]);
}

/// A binary glTF of one mesh: 256 places, and byte indices for a strip; `nodes` of it.
fn glb(indices: &[u8], nodes: usize) -> Vec<u8> {
    let mut next = numbers();
    let places: Vec<u8> = (0..768).flat_map(|_| (next() as f32).to_le_bytes()).collect();
    let count = indices.len();
    let node = |index: usize| format!("{{\"mesh\":0,\"translation\":[{index},0,0]}}");
    let nodes: Vec<String> = (0..nodes).map(node).collect();
    let mut json = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}],\"buffers\":[{{\"byteLength\":{}}}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":3072}},{{\"buffer\":0,\"byteOffset\":3072,\"byteLength\":{count}}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":256,\"type\":\"VEC3\",\
         \"min\":[0,0,0],\"max\":[1,1,1]}},\
         {{\"bufferView\":1,\"componentType\":5121,\"count\":{count},\"type\":\"SCALAR\"}}],\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\"indices\":1,\"mode\":5}}]}}]}}",
        nodes.join(","),
        3072 + count
    );
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let mut binary = [&places[..], indices].concat();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    file.extend((json.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(json.as_bytes());
    file.extend((binary.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}

#[test]
fn strips_of_bytes_and_meshes_that_are_repeated() {
    let mut next = numbers();
    let mut indices = |count: usize| (0..count).map(|_| (next() * 256.0) as u8).collect::<Vec<_>>();
    give("strip.glb", &glb(&indices(900_000), 1));
    give("repeated.glb", &glb(&indices(400_000), 12_000));
    // Just below what a small file may repeat.
    give("many.glb", &glb(&indices(1000), 130));
}

#[test]
fn scenes_of_many_sections() {
    for section in [
        "[[lights]]\n",
        "[[colliders]]\nshape='sphere'\ncenter=[0,0,0]\nradius=1\n",
        "[[motion.keyframes]]\n",
    ] {
        give("many.toml", (SCENE.to_owned() + &section.repeat((LARGEST - 200) / section.len())).as_bytes());
    }
    let keys: String = (0..100_000).map(|key| format!("k{key}=1\n")).collect();
    give("keys.toml", &keys.as_bytes()[..keys.len().min(LARGEST)]);
    give("deep.toml", ("a=".to_owned() + &"[".repeat(LARGEST - 8)).as_bytes());
    give("quotes.toml", &[b'"'; LARGEST]);
}

/// A zip of deflated arrays: their names, headers, and bytes that are repeated.
pub fn cache(arrays: &[(&str, &str, &[u8], usize)]) -> Vec<u8> {
    let (mut zip, mut directory) = (Vec::new(), Vec::new());
    let short = |number: usize| (number as u16).to_le_bytes();
    let long = |number: usize| (number as u32).to_le_bytes();
    for (name, header, bytes, times) in arrays {
        let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::best());
        let mut crc = flate2::Crc::new();
        let text = format!("{{{header}}}\n");
        let start = [b"\x93NUMPY\x01\x00".as_slice(), &short(text.len()), text.as_bytes()].concat();
        let pieces = std::iter::once(start.as_slice()).chain(std::iter::repeat_n(*bytes, *times));
        for piece in pieces {
            crc.update(piece);
            std::io::Write::write_all(&mut encoder, piece).unwrap();
        }
        let packed = encoder.finish().unwrap();
        let size = start.len() + bytes.len() * times;
        let mut common = [20, 0, 8, 0, 33].map(short).concat();
        common.extend([crc.sum() as usize, packed.len(), size].map(long).concat());
        common.extend([name.len(), 0].map(short).concat());
        directory.extend(
            [&b"PK\x01\x02\x14\x00"[..], &common, &[0; 10], &long(zip.len()), name.as_bytes()].concat(),
        );
        zip.extend([&b"PK\x03\x04"[..], &common, name.as_bytes(), &packed].concat());
    }
    let end = [&b"PK\x05\x06\0\0\0\0"[..], &short(arrays.len()), &short(arrays.len())].concat();
    let places = [directory.len(), zip.len()].map(long).concat();
    [zip, directory, end, places, vec![0; 2]].concat()
}

pub const ROW: &str = "'fortran_order': False, 'shape'";

#[test]
fn caches_that_unpack_to_much() {
    let meta = br#"{"layout":1,"what":"guides","frames_per_second":30.0,"scene":"film.frames = 1\nstyle.strand_count = 8"}"#;
    let zeros = [0; 1 << 16];
    let head = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0].map(f32::to_le_bytes).concat();
    let count = 16_u32 << 20;
    let starts = [0, count].map(u32::to_le_bytes).concat();
    let array = |kind: &str, shape: &str| format!("'descr': '{kind}', {ROW}: ({shape})");
    let points = array("<f4", &format!("1, {count}, 3"));
    let usual = [array("<f8", "1,"), array("<f4", "1, 7"), array("<u4", "2,")];
    let [times, heads, two] = usual.each_ref().map(String::as_str);
    let own = array("|u1", &format!("{},", meta.len()));
    let bomb = [
        ("times.npy", times, &[0; 8][..], 1),
        ("world_from_head.npy", heads, &head, 1),
        ("starts.npy", two, &starts, 1),
        ("points.npy", &points, &zeros, (12 * count as usize) >> 16),
        ("meta.npy", &own, meta, 1),
    ];
    for name in ["own.npz", "other.npz"] {
        give(name, &cache(&bomb));
    }
    // A report of more frames than there are.
    let long = [
        br#"{"layout":1,"what":"guides","frames_per_second":30.0,"report":{"steps":[0"#.as_slice(),
        &b",0".repeat(8 << 20),
        b"]}}",
    ]
    .concat();
    let header = array("|u1", &format!("{},", long.len()));
    let mut talker = bomb;
    talker[4] = ("meta.npy", &header, &long, 1);
    give("own.npz", &cache(&talker));
    // As many strands as there may be, of no points.
    let many = array("<u4", "8000000,");
    let mut crowd = bomb;
    crowd[2] = ("starts.npy", &many, &zeros, (4 * 8_000_000) >> 16);
    give("other.npz", &cache(&crowd));
    let most = array("|u1", "700000000,");
    let mut giant = bomb;
    giant[4] = ("meta.npy", &most, &zeros, 700_000_000 >> 16);
    give("own.npz", &cache(&giant));
}
