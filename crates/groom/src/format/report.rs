use serde::Serialize;

use crate::Groom;

/// What a file holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name and version of the format.
    pub format: &'static str,
    /// Strands that can be used.
    pub strands: usize,
    /// Their points.
    pub points: usize,
    /// Points on a strand.
    pub points_per_strand: Counts,
    /// Lengths of the strands \[m\].
    pub length_m: Lengths,
    /// Smallest and largest corner of the box around all points \[m\].
    pub bounds_m: [[f32; 3]; 2],
    /// Metres for each unit of the file.
    pub scale: f32,
    /// What was odd or left out, for a person to read.
    pub problems: Vec<String>,
}

/// Fewest and most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Fewest.
    pub min: usize,
    /// Most.
    pub max: usize,
}

/// Shortest, mean and longest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lengths {
    /// Shortest \[m\].
    pub min: f32,
    /// Mean \[m\].
    pub mean: f32,
    /// Longest \[m\].
    pub max: f32,
}

impl Report {
    /// Of a groom in metres.
    pub fn new(format: &'static str, groom: &Groom, scale: f32, problems: Vec<String>) -> Self {
        let counts = || groom.starts.windows(2).map(|pair| (pair[1] - pair[0]) as usize);
        let lengths = groom.lengths();
        let sum: f64 = lengths.iter().map(|length| f64::from(*length)).sum();
        let bounds = groom.bounds();
        Self {
            format,
            strands: groom.strand_count(),
            points: groom.points.len(),
            points_per_strand: Counts { min: counts().min().unwrap_or(0), max: counts().max().unwrap_or(0) },
            length_m: Lengths {
                min: lengths.iter().copied().fold(f32::INFINITY, f32::min),
                mean: (sum / lengths.len().max(1) as f64) as f32,
                max: lengths.iter().copied().fold(0.0, f32::max),
            },
            bounds_m: [bounds.min.to_array(), bounds.max.to_array()],
            scale,
            problems,
        }
    }
}
