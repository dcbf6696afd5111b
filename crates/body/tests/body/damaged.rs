//! Damaged motions of vertices, arrays of numpy and sequences of .obj files: each is refused clearly, or all its vertices,
//! its head and roots on it are somewhere at any time, played forward and backward.
//!
//! `STRANDLINE_FULL=1` looks at a hundred times as many.

use std::path::Path;

use glam::Quat;
use strandline_base::Random;
use strandline_base::npz::{Array, Kind, pack};
use strandline_body::{BodyError, BodyFrame, Mesh, Playback, SkinMotion, SkinRoots, VertexMotion};

use crate::files::CUBE_OBJ;
use crate::vertices::{faces, numbers};

/// Damaged files of each kind.
fn count() -> usize {
    if std::env::var_os("STRANDLINE_FULL").is_some_and(|value| value == "1") { 100_000 } else { 1000 }
}

/// A whole number below another.
pub fn below(random: &mut Random, count: usize) -> usize {
    (random.bits() as usize) % count
}

/// One of some values.
fn one_of<T: Copy>(values: &[T], random: &mut Random) -> T {
    values[below(random, values.len())]
}

/// Files that were refused, and that were drawn.
#[derive(Debug, Default)]
struct Told {
    refused: usize,
    drawn: usize,
}

impl Told {
    fn look(&mut self, loaded: Result<(Mesh, VertexMotion), BodyError>, random: &mut Random) {
        match loaded {
            Err(error) => {
                let text = error.to_string();
                assert!(text.contains("expected") || text.contains("cannot be read"), "{text}");
                self.refused += 1;
            }
            Ok((mesh, motion)) => {
                // Between two places that are far from each other single precision may end.
                for time in [f64::NEG_INFINITY, motion.end()] {
                    assert!(motion.positions(time).iter().all(|place| place.is_finite()), "at {time}");
                }
                rides(&mesh, motion, random);
                self.drawn += 1;
            }
        }
    }
}

/// Ways to play a motion: forward, backward, and any, each of them also round and round.
pub fn playbacks(random: &mut Random) -> [Playback; 3] {
    let mut number = || one_of(&[0.0, -0.3, 1.0, -1.5, 1e-9, -1e300], random);
    let [start, speed] = [number(), number()];
    let any = Playback { start, speed, is_loop: below(random, 2) == 0 };
    [Playback::default(), Playback { start: 0.3, speed: -1.5, is_loop: true }, any]
}

/// Times of a scene \[s\], in no order: of a few seconds, and far ones.
pub fn times(random: &mut Random) -> [f64; 6] {
    let [near, far] = [3.0, 1e9].map(|most| most * f64::from(random.signed()));
    [0.4, near, -1.0, far, f64::NAN, 1e300]
}

/// The vertices, the head and roots of a body are somewhere, however it is played.
pub fn rides(mesh: &Mesh, motion: VertexMotion, random: &mut Random) {
    let places = &mesh.positions;
    assert_eq!(motion.vertex_count(), places.len());
    let roots = SkinRoots::new(mesh, &[places[0], places[places.len() / 2] * 1.01]);
    for playback in playbacks(random) {
        let body = SkinMotion::new(motion.clone(), playback, places, (1.0, Quat::IDENTITY), &[]).unwrap();
        let mut last = BodyFrame::REST;
        for time in times(random) {
            last = roots.placed(body.frame(time), &last);
            let found = last.check(Some(2), Some(places.len()));
            assert!(found.is_ok(), "{found:?} at {time} of {playback:?}");
        }
        assert!(body.gaps_of_loops(0.01).iter().all(|gap| gap.is_finite()), "{playback:?}");
    }
}

/// A cube that rises in three frames, as an archive may have it.
fn cube() -> Vec<Array<'static>> {
    vec![
        Array::f32s("vertices", &[3, 8, 3], numbers(3)),
        Array::u32s("faces", &[12, 3], faces()),
        Array::f64s("times", &[3], [0.0, 0.5, 2.0]),
        Array::f64s("teleports", &[1], [1.0]),
        Array::f64s("fps", &[], [2.0]),
    ]
}

/// An array with a number, its type, its shape or its name changed.
fn change(array: &mut Array<'_>, random: &mut Random) {
    const COUNTS: [u64; 8] = [0, 1, 2, 3, 8, 24, 1 << 40, u64::MAX];
    let bytes = array.bytes.to_mut();
    match below(random, 6) {
        0 if bytes.len() >= 8 => {
            let number = one_of(&[0.0, -1.0, 7.5, 1e38, -3e38, 1e300, f64::NAN, f64::INFINITY], random);
            let at = below(random, bytes.len() / 8) * 8;
            bytes[at..at + 8].copy_from_slice(&match array.kind {
                Kind::F64 => number.to_le_bytes(),
                _ => [(number as f32).to_le_bytes(); 2].concat().try_into().unwrap(),
            });
        }
        1 => bytes.truncate(below(random, bytes.len() + 1)),
        2 => array.kind = one_of(&[Kind::F32, Kind::F64, Kind::U32, Kind::F16, Kind::I8], random),
        3 if !array.shape.is_empty() => {
            let axis = below(random, array.shape.len());
            array.shape[axis] = one_of(&COUNTS, random);
        }
        4 => array.shape.insert(below(random, array.shape.len() + 1), one_of(&COUNTS, random)),
        _ => array.name = one_of(&["v", "f", "times", "fps", "teleports", "poses", ""], random),
    }
}

/// Some bytes changed, or the end lost.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..below(random, 4) {
        let at = below(random, bytes.len());
        bytes[at] = below(random, 256) as u8;
    }
    if below(random, 16) == 0 {
        bytes.truncate(below(random, bytes.len()));
    }
}

#[test]
fn damaged_arrays_are_refused_or_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let [npz, npy, obj] = ["damaged.npz", "damaged.npy", "cube.obj"].map(|name| folder.path().join(name));
    std::fs::write(&obj, CUBE_OBJ).unwrap();
    let mesh = Mesh::load(&obj, 1.0).unwrap();
    let mut random = Random::new(35, 3);
    let [mut whole, mut beside] = [(); 2].map(|()| Told::default());
    for _ in 0..count() {
        let mut arrays = cube();
        for _ in 0..below(&mut random, 3) {
            let index = below(&mut random, arrays.len());
            change(&mut arrays[index], &mut random);
        }
        if below(&mut random, 4) == 0 {
            arrays.remove(below(&mut random, arrays.len()));
        }
        let mut bytes = arrays[0].npy();
        damage(&mut bytes, &mut random);
        std::fs::write(&npy, &bytes).unwrap();
        let mut bytes = pack(&arrays);
        damage(&mut bytes, &mut random);
        std::fs::write(&npz, &bytes).unwrap();
        whole.look(Mesh::load_sequence(&npz, 24.0), &mut random);
        for path in [&npz, &npy] {
            let loaded = VertexMotion::load(path, &mesh, Some(&obj), 24.0);
            beside.look(loaded.map(|motion| (mesh.clone(), motion)), &mut random);
        }
    }
    let least = |told: &Told, files: usize| told.refused * 4 > files && told.drawn * 8 > files;
    assert!(least(&whole, count()) && least(&beside, 2 * count()), "{whole:?}, {beside:?}");
}

/// The words of some files of the cube, one changed in one of them or in all alike.
fn changed(texts: &mut [String], random: &mut Random) {
    const WORDS: [&str; 14] =
        ["0", "1", "-1", "9", "nan", "1e38", "-3e38", "1e300", "99999999999", "1//1", "f", "v", "vn", ""];
    let (word, all) = (one_of(&WORDS, random), below(random, 2) == 0);
    let words = |text: &str| text.split_inclusive([' ', '\n']).map(str::to_owned).collect::<Vec<_>>();
    let file = below(random, texts.len());
    let at = below(random, words(&texts[file]).len());
    for (index, text) in texts.iter_mut().enumerate() {
        let mut words = words(text);
        if let Some(old) = words.get_mut(at).filter(|_| all || index == file) {
            let end = old.len() - old.trim_end().len();
            *old = format!("{word}{}", &old[old.len() - end..]);
        }
        *text = words.concat();
    }
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

#[test]
fn damaged_sequences_are_refused_or_drawn() {
    const NAMES: [&str; 6] = [
        "walk0.obj",
        "walk02.obj",
        "walk99999999999999999999.obj",
        "walk-1.obj",
        "walk.obj",
        "walk9223372036854775808.obj",
    ];
    let folder = tempfile::tempdir().unwrap();
    let pattern = folder.path().join("walk%d.obj");
    let mut random = Random::new(35, 4);
    let mut told = Told::default();
    for _ in 0..count() {
        let mut texts = [(); 3].map(|()| CUBE_OBJ.to_owned());
        for _ in 0..below(&mut random, 4) {
            changed(&mut texts, &mut random);
        }
        let mut names = ["walk1.obj", "walk2.obj", "walk4.obj"];
        if below(&mut random, 4) == 0 {
            names[below(&mut random, 3)] = one_of(&NAMES, &mut random);
        }
        for (name, text) in names.iter().zip(&mut texts) {
            if below(&mut random, 16) == 0 {
                text.truncate(below(&mut random, text.len() + 1));
            }
            write(folder.path(), name, text);
        }
        let path = one_of(&[&*pattern, folder.path()], &mut random);
        let rate = one_of(&[24.0, 0.001, 10_000.0], &mut random);
        told.look(Mesh::load_sequence(path, rate), &mut random);
        for name in names {
            // Two files may have one name.
            let _ = std::fs::remove_file(folder.path().join(name));
        }
    }
    assert!(told.refused * 4 > count() && told.drawn * 4 > count(), "{told:?}");
}
