//! Finds strands that cannot be used: named when reading strictly, left out and counted when not.

use strandline_base::counted;

use crate::{Groom, GroomError, Widths};

use super::MAX_COORDINATE;

/// A strand shorter than this share of the median length is left out.
const SHORT: f32 = 1e-6;
/// Bad strands that a problem names before it only counts.
const NAMED: usize = 3;

/// Faults of strands, and their requirements.
const FAULTS: [(&str, &str); 4] = [
    ("has fewer than two points", "two or more"),
    ("has a coordinate that is not a number or is too large", "finite coordinates below 1e7"),
    ("has no length", "a length above 0"),
    (
        "has a width, colour or another attribute that is not sound",
        "finite numbers, widths not below 0, masses above 0",
    ),
];

/// Checks every strand; in strict mode the first bad one is an error.
pub fn sieve(groom: Groom, strict: bool, problems: &mut Vec<String>) -> Result<Groom, GroomError> {
    let lengths = groom.lengths();
    let mut sorted: Vec<f32> = lengths.iter().copied().filter(|length| length.is_finite()).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let shortest = SHORT * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let faults: Vec<Option<usize>> =
        (0..groom.strand_count()).map(|strand| fault(&groom, strand, lengths[strand], shortest)).collect();
    if strict && let Some((strand, fault)) = faults.iter().enumerate().find_map(|(i, f)| Some((i, (*f)?))) {
        let (found, expected) = FAULTS[fault];
        let (strand, file) = groom.origin(strand);
        let error = GroomError::Strand { strand, found, expected };
        return Err(match file {
            Some(file) => error.of(file),
            None => error,
        });
    }
    for (kind, (text, _)) in FAULTS.iter().enumerate() {
        let bad: Vec<usize> = (0..faults.len()).filter(|strand| faults[*strand] == Some(kind)).collect();
        if let Some(first) = bad.get(..bad.len().min(NAMED)).filter(|first| !first.is_empty()) {
            let (left, are) = (
                counted(bad.len(), "strand", "strands"),
                if bad.len() == 1 { "it is" } else { "the first are" },
            );
            let first: Vec<String> = first.iter().map(|strand| groom.numbered(*strand)).collect();
            problems.push(format!("{left} left out: each {text}; {are} [{}]", first.join(", ")));
        }
    }
    if faults.iter().all(Option::is_none) {
        Ok(groom)
    } else {
        Ok(groom.left_of_file(|strand| faults[strand].is_none()))
    }
}

fn fault(groom: &Groom, strand: usize, length: f32, shortest: f32) -> Option<usize> {
    let range = groom.starts[strand] as usize..groom.starts[strand + 1] as usize;
    let points = groom.strand(strand);
    if points.len() < 2 {
        return Some(0);
    }
    if !points.iter().all(|point| point.is_finite() && point.abs().max_element() < MAX_COORDINATE) {
        return Some(1);
    }
    if length.is_nan() || length <= shortest {
        return Some(2);
    }
    let sound_width = |width: &f32| width.is_finite() && *width >= 0.0;
    let widths = match &groom.widths {
        Widths::Constant(width) => sound_width(width),
        Widths::PerStrand(widths) => sound_width(&widths[strand]),
        Widths::PerPoint(widths) => widths[range.clone()].iter().all(sound_width),
    };
    let uvs = groom.root_uvs.as_ref().is_none_or(|uvs| uvs[strand].is_finite());
    let normals = groom.root_normals.as_ref().is_none_or(|all| all[strand].is_finite());
    let sound = |all: &Option<Vec<f32>>, is_sound: fn(f32) -> bool| {
        all.as_ref().is_none_or(|all| all[range.clone()].iter().all(|value| is_sound(*value)))
    };
    let clear = sound(&groom.transparencies, f32::is_finite);
    let masses = sound(&groom.masses, |mass| mass.is_finite() && mass > 0.0);
    let colors = groom
        .colors
        .as_ref()
        .is_none_or(|all| all[range.clone()].as_flattened().iter().all(|value| value.is_finite()));
    let velocities = groom.velocities.as_ref().is_none_or(|all| all[range].iter().all(|v| v.is_finite()));
    (!(widths && uvs && normals && clear && masses && colors && velocities)).then_some(3)
}
