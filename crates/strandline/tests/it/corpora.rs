//! The kept corpora of the fuzz targets, replayed: every file of them and many that are nearly them.
//!
//! `STRANDLINE_FUZZ_SECONDS=60 cargo test --release -p strandline --test it corpora -- --nocapture` continues for
//! so long for each target and prints how many runs that were; `STRANDLINE_FUZZ_TARGET=obj` takes one of them, and
//! `STRANDLINE_FUZZ_SEED=8` changes the files otherwise: with one seed a longer run repeats a shorter one.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use strandline::math::Random;

#[path = "../../../../fuzz/readers.rs"]
mod readers;

/// Changed copies of each seed when nothing else is said.
const COPIES: u64 = 150;

fn seeds(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(target);
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{}", folder.display());
    files.into_iter().map(|file| (file.clone(), std::fs::read(file).unwrap())).collect()
}

/// A number below `end`.
fn below(random: &mut Random, end: usize) -> usize {
    ((random.unit() * end as f32) as usize).min(end.saturating_sub(1))
}

/// Changes bytes, numbers and length, as damage and spite do; `other` lends a piece.
fn change(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    for _ in 0..=below(random, 6) {
        let at = below(random, bytes.len() + 1).min(bytes.len().saturating_sub(1));
        if bytes.is_empty() {
            bytes.extend(other);
            continue;
        }
        match below(random, 7) {
            0 => bytes[at] ^= 1 << below(random, 8),
            1 => bytes[at] = below(random, 256) as u8,
            2 => bytes.truncate(at),
            3 => {
                let word = [0_u32, 1, 0x7f80_0000, u32::MAX, 0x7149_f2ca, 0x8000_0000][below(random, 6)];
                bytes.splice(at..(at + 4).min(bytes.len()), word.to_le_bytes());
            }
            4 => {
                let text = ["-1", "1e38", "nan", "99999999999", "[", "0.", "inf", "\n"][below(random, 8)];
                bytes.splice(at..(at + text.len()).min(bytes.len()), text.bytes());
            }
            5 => {
                let end = (at + 1 + below(random, 32)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            _ => {
                let from = below(random, other.len());
                let end = (from + 1 + below(random, 32)).min(other.len());
                bytes.splice(at..at, other[from..end].iter().copied());
            }
        }
        // Time goes to many files, not to long ones.
        bytes.truncate(4096);
    }
}

#[test]
fn every_reader_reads_or_refuses_its_corpus_and_what_is_nearly_it() {
    let seconds = std::env::var("STRANDLINE_FUZZ_SECONDS").ok().map(|text| text.parse().unwrap());
    let limit = seconds.map(Duration::from_secs);
    let only = std::env::var("STRANDLINE_FUZZ_TARGET").ok();
    let seed = std::env::var("STRANDLINE_FUZZ_SEED").map_or(7, |text| text.parse().unwrap());
    for (name, target) in readers::TARGETS {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        let seeds = seeds(name);
        let read = seeds.iter().filter(|(_, bytes)| target(bytes)).count();
        assert!(read > 0, "{name}: no seed is read: the target looks at nothing");
        let (begin, mut runs, mut sound) = (Instant::now(), 0_u64, 0_u64);
        while limit.map_or(runs < COPIES * seeds.len() as u64, |limit| begin.elapsed() < limit) {
            let mut random = Random::new(seed, runs);
            let mut bytes = seeds[below(&mut random, seeds.len())].1.clone();
            let other = &seeds[below(&mut random, seeds.len())].1;
            change(&mut bytes, other, &mut random);
            sound += u64::from(target(&bytes));
            runs += 1;
        }
        assert!(sound > 0, "{name}: every changed file is refused: the changes are too many");
        if seconds.is_some() {
            #[allow(clippy::print_stderr)] // a figure that was asked for
            {
                eprintln!("{name}: {runs} runs, {sound} of them read");
            }
        }
    }
}
