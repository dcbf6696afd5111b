use std::collections::BTreeMap;

use serde::Serialize;

use super::Attribute;
use crate::Groom;

/// Contents of a file.
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
    /// Attributes beside points.
    pub attributes: Vec<&'static str>,
    /// Its groups by their numbers: names, where they have some, and strands.
    pub groups: BTreeMap<u32, GroupOf>,
    /// Oddities and omissions, human-readable.
    pub problems: Vec<String>,
}

/// A group of strands.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct GroupOf {
    /// Its name.
    pub name: Option<String>,
    /// Number of its strands.
    pub strands: usize,
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
            attributes: Attribute::ALL
                .into_iter()
                .filter(|attribute| attribute.is_in(groom))
                .map(Attribute::name)
                .collect(),
            groups: groups(groom),
            problems,
        }
    }
}

fn groups(groom: &Groom) -> BTreeMap<u32, GroupOf> {
    let mut groups = BTreeMap::<u32, GroupOf>::new();
    for number in groom.groups.iter().flatten() {
        groups.entry(*number).or_default().strands += 1;
    }
    for (number, name) in &groom.group_names {
        groups.entry(*number).or_default().name = Some(name.clone());
    }
    groups
}
