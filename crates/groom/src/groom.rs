use std::{collections::BTreeMap, ops::Range, path::PathBuf};

use glam::{Quat, Vec2, Vec3};
use strandline_base::SettingError;
use strandline_body::Aabb;

use crate::Influences;

/// Strand diameters \[m\].
#[derive(Clone, Debug, PartialEq)]
pub enum Widths {
    /// One diameter for all.
    Constant(f32),
    /// One diameter for each strand.
    PerStrand(Vec<f32>),
    /// One diameter for each point.
    PerPoint(Vec<f32>),
}

impl Widths {
    /// Diameter \[m\] at a point, given its strand and its index among all points.
    pub fn at(&self, strand: usize, point: usize) -> f32 {
        match self {
            Self::Constant(width) => *width,
            Self::PerStrand(widths) => widths[strand],
            Self::PerPoint(widths) => widths[point],
        }
    }
}

/// A set of strands at rest, root first, in head space. It has no time.
#[derive(Clone, Debug, PartialEq)]
pub struct Groom {
    /// First point of each strand, then the number of points: shape `[strand + 1]`.
    pub starts: Vec<u32>,
    /// Positions \[m\], shape `[point]`, strand after strand, root first.
    pub points: Vec<Vec3>,
    /// Diameters \[m\].
    pub widths: Widths,
    /// Position of each root on the scalp, 0..1, shape `[strand]`.
    pub root_uvs: Option<Vec<Vec2>>,
    /// Unit normal of the skin at each root, shape `[strand]`.
    pub root_normals: Option<Vec<Vec3>>,
    /// A group number for each strand, shape `[strand]`.
    pub groups: Option<Vec<u32>>,
    /// Names of the named groups.
    pub group_names: BTreeMap<u32, String>,
    /// True for strands that are guides, shape `[strand]`.
    pub guide_flags: Option<Vec<bool>>,
    /// The guides that each strand follows.
    pub influences: Option<Influences>,
    /// Linear RGB, 0..1, shape `[point]`.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Transparency, 0 opaque .. 1, shape `[point]`.
    pub transparencies: Option<Vec<f32>>,
    /// Masses \[kg\], above 0, shape `[point]`; without them the settings' mass per length counts.
    pub masses: Option<Vec<f32>>,
    /// Velocities at the beginning \[m/s\], head space, shape `[point]`; without them hair begins at rest.
    pub velocities: Option<Vec<Vec3>>,
    /// The number of each strand in its file, or through all of `files`, from 0, where others were left out or strands are
    /// of several files: shape `[strand]`.
    pub numbers: Option<Vec<u32>>,
    /// Files that were read as one groom, by the number of their first strand; numbers of strands then count through
    /// all of them.
    pub files: BTreeMap<u32, PathBuf>,
}

impl Groom {
    /// A groom without a strand.
    pub fn empty(width: f32) -> Self {
        Self {
            starts: vec![0],
            points: Vec::new(),
            widths: Widths::Constant(width),
            root_uvs: None,
            root_normals: None,
            groups: None,
            group_names: BTreeMap::new(),
            guide_flags: None,
            influences: None,
            colors: None,
            transparencies: None,
            masses: None,
            velocities: None,
            numbers: None,
            files: BTreeMap::new(),
        }
    }

    /// Appends a strand, root first.
    pub fn push(&mut self, points: impl IntoIterator<Item = Vec3>) {
        self.points.extend(points);
        self.starts.push(self.points.len() as u32);
    }

    /// Refuses a groom whose arrays do not belong together, as no file has it.
    ///
    /// # Errors
    /// Starts that do not rise from 0 to the number of points; an attribute of another length than its shape.
    pub fn check_lengths(&self) -> Result<(), SettingError> {
        let points = self.points.len();
        let rises = self.starts.is_sorted() && self.starts.first() == Some(&0);
        if !rises || self.starts.last().is_none_or(|end| *end as usize != points) {
            let expected =
                format!("one for each strand and one more, rising from 0 to {points}, the number of points");
            return Err(SettingError::new(
                "groom.starts",
                format!("{} numbers", self.starts.len()),
                expected,
            ));
        }
        let strands = self.strand_count();
        let widths = match &self.widths {
            Widths::Constant(_) => None,
            Widths::PerStrand(widths) => Some((widths.len(), strands)),
            Widths::PerPoint(widths) => Some((widths.len(), points)),
        };
        let of = |length: Option<usize>, expected: usize| length.map(|length| (length, expected));
        for (name, lengths) in [
            ("groom.widths", widths),
            ("groom.root_uvs", of(self.root_uvs.as_ref().map(Vec::len), strands)),
            ("groom.root_normals", of(self.root_normals.as_ref().map(Vec::len), strands)),
            ("groom.groups", of(self.groups.as_ref().map(Vec::len), strands)),
            ("groom.guide_flags", of(self.guide_flags.as_ref().map(Vec::len), strands)),
            (
                "groom.influences",
                self.influences.as_ref().map(|all| (all.guides().len(), all.per_strand() * strands)),
            ),
            ("groom.colors", of(self.colors.as_ref().map(Vec::len), points)),
            ("groom.transparencies", of(self.transparencies.as_ref().map(Vec::len), points)),
            ("groom.masses", of(self.masses.as_ref().map(Vec::len), points)),
            ("groom.velocities", of(self.velocities.as_ref().map(Vec::len), points)),
            ("groom.numbers", of(self.numbers.as_ref().map(Vec::len), strands)),
        ] {
            if let Some((length, expected)) = lengths.filter(|(length, expected)| length != expected) {
                let expected = format!("{expected}: {strands} strands have {points} points");
                return Err(SettingError::new(name, format!("{length} entries"), expected));
            }
        }
        Ok(())
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The points of a strand \[m\], root first.
    pub fn strand(&self, index: usize) -> &[Vec3] {
        &self.points[self.range(index)]
    }

    /// Indices of the points of a strand among all points.
    pub fn range(&self, strand: usize) -> Range<usize> {
        self.starts[strand] as usize..self.starts[strand + 1] as usize
    }

    /// Length of every strand \[m\], shape `[strand]`.
    pub fn lengths(&self) -> Vec<f32> {
        let length = |points: &[Vec3]| points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        (0..self.strand_count()).map(|strand| length(self.strand(strand))).collect()
    }

    /// The box around all points \[m\]; inverted without points.
    pub fn bounds(&self) -> Aabb {
        let start = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
        let (min, max) =
            self.points.iter().fold(start, |(min, max), point| (min.min(*point), max.max(*point)));
        Aabb { min, max }
    }

    /// Scales, then turns, then moves \[m\] everything.
    pub fn transform(&mut self, scale: f32, rotation: Quat, translation: Vec3) {
        for point in &mut self.points {
            *point = rotation * (scale * *point) + translation;
        }
        for normal in self.root_normals.iter_mut().flatten() {
            *normal = rotation * *normal;
        }
        for velocity in self.velocities.iter_mut().flatten() {
            *velocity = rotation * (scale * *velocity);
        }
        match &mut self.widths {
            Widths::Constant(width) => *width *= scale,
            Widths::PerStrand(widths) | Widths::PerPoint(widths) => {
                widths.iter_mut().for_each(|width| *width *= scale);
            }
        }
    }
}
