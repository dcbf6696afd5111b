use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use strandline_base::{
    SettingError,
    memory::{self, Need},
};
use strandline_body::Aabb;

use crate::{
    GroomError, Guides, attributes,
    format::{self, LoadOptions, Saved},
};

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
    /// Linear RGB, 0..1, shape `[point]`.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Transparency, 0 opaque .. 1, shape `[point]`.
    pub transparencies: Option<Vec<f32>>,
    /// Masses \[kg\], above 0, shape `[point]`; without them the settings' mass per length counts.
    pub masses: Option<Vec<f32>>,
    /// Velocities at the beginning \[m/s\], head space, shape `[point]`; without them hair begins at rest.
    pub velocities: Option<Vec<Vec3>>,
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
            colors: None,
            transparencies: None,
            masses: None,
            velocities: None,
        }
    }

    /// Appends a strand, root first.
    pub fn push(&mut self, points: impl IntoIterator<Item = Vec3>) {
        self.points.extend(points);
        self.starts.push(self.points.len() as u32);
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The points of a strand \[m\], root first.
    pub fn strand(&self, index: usize) -> &[Vec3] {
        &self.points[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// Loads a .hair or .tfx file strictly, in metres, y up; see [`format::load`] for more.
    ///
    /// # Errors
    /// See [`GroomError`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, GroomError> {
        Ok(format::load(path.as_ref(), &LoadOptions::default())?.groom)
    }

    /// Writes a .hair or .tfx file; says what the format could not hold.
    ///
    /// # Errors
    /// See [`GroomError`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<Saved, GroomError> {
        format::save(self, path.as_ref())
    }

    /// Length of every strand \[m\], shape `[strand]`.
    pub fn lengths(&self) -> Vec<f32> {
        let length = |points: &[Vec3]| points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        (0..self.strand_count()).map(|strand| length(self.strand(strand))).collect()
    }

    /// The box around all points \[m\]; inside out when there is none.
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

    /// The strands that a choice by index keeps, in their order.
    pub fn kept(&self, keep: impl Fn(usize) -> bool) -> Self {
        let strands: Vec<usize> = (0..self.strand_count()).filter(|strand| keep(*strand)).collect();
        let range = |strand: &usize| self.starts[*strand] as usize..self.starts[strand + 1] as usize;
        let per_strand = |values: &[f32]| strands.iter().map(|strand| values[*strand]).collect();
        let per_point = |values: &[f32]| strands.iter().flat_map(|s| &values[range(s)]).copied().collect();
        let mut groom = Self::empty(0.0);
        for strand in &strands {
            groom.push(self.strand(*strand).iter().copied());
        }
        groom.widths = match &self.widths {
            Widths::Constant(width) => Widths::Constant(*width),
            Widths::PerStrand(widths) => Widths::PerStrand(per_strand(widths)),
            Widths::PerPoint(widths) => Widths::PerPoint(per_point(widths)),
        };
        groom.root_uvs = self.root_uvs.as_ref().map(|all| strands.iter().map(|s| all[*s]).collect());
        groom.root_normals = self.root_normals.as_ref().map(|all| strands.iter().map(|s| all[*s]).collect());
        groom.groups = self.groups.as_ref().map(|all| strands.iter().map(|s| all[*s]).collect());
        groom.colors =
            self.colors.as_ref().map(|all| strands.iter().flat_map(|s| &all[range(s)]).copied().collect());
        groom.transparencies = self.transparencies.as_ref().map(|all| per_point(all));
        groom.masses = self.masses.as_ref().map(|all| per_point(all));
        groom.velocities = self
            .velocities
            .as_ref()
            .map(|all| strands.iter().flat_map(|strand| &all[range(strand)]).copied().collect());
        groom
    }

    /// Every strand resampled to `count` points at equal arc length; its width is that of its root, and its
    /// mass stays.
    ///
    /// # Errors
    /// A count outside 2..=4096; masses or velocities that do not fit the points; more points than a file may
    /// hold, or more memory than may be taken.
    pub fn resampled(&self, count: usize) -> Result<Self, GroomError> {
        if !(2..=format::MAX_POINTS_PER_STRAND as usize).contains(&count) {
            return Err(SettingError::new("the number of points", count, "2 to 4096").into());
        }
        attributes::check(self)?;
        self.check_resampled(count as u64)?;
        let strands = 0..self.strand_count();
        let mut groom = Self::empty(0.0);
        groom.points.reserve_exact(self.strand_count() * count);
        for strand in strands.clone() {
            groom.push(Guides::equal_arcs(self.strand(strand), count));
        }
        let root = |strand: usize| self.starts[strand] as usize;
        let spread = |strand: usize| std::iter::repeat_n(strand, count);
        groom.widths = match &self.widths {
            Widths::Constant(width) => Widths::Constant(*width),
            widths => Widths::PerStrand(strands.clone().map(|s| widths.at(s, root(s))).collect()),
        };
        groom.root_uvs.clone_from(&self.root_uvs);
        groom.root_normals.clone_from(&self.root_normals);
        groom.groups.clone_from(&self.groups);
        groom.colors =
            self.colors.as_ref().map(|all| strands.clone().flat_map(spread).map(|s| all[root(s)]).collect());
        groom.transparencies = self
            .transparencies
            .as_ref()
            .map(|all| strands.clone().flat_map(spread).map(|s| all[root(s)]).collect());
        let masses = strands.clone().filter_map(|strand| attributes::masses(self, strand, count));
        groom.masses = self.masses.is_some().then(|| masses.flatten().collect());
        let velocities = strands.filter_map(|strand| attributes::velocities(self, strand, count));
        groom.velocities = self.velocities.is_some().then(|| velocities.flatten().collect());
        Ok(groom)
    }

    /// Refuses what `count` points on every strand would be before they are made.
    fn check_resampled(&self, count: u64) -> Result<(), GroomError> {
        let strand_count = self.strand_count() as u64;
        let points = strand_count * count;
        let what = || format!("points = {count} on each of {strand_count} strands");
        if points > format::MAX_POINTS {
            let found = format!("{count}, which makes {points} on {strand_count} strands");
            return Err(SettingError::new("the number of points", found, "268435456 in all at most").into());
        }
        // A position, and a colour and a transparency where the groom has them; then the bytes of a file.
        let colors = if self.colors.is_some() { 12 } else { 0 };
        let transparencies = if self.transparencies.is_some() { 4 } else { 0 };
        memory::check(&[Need::new(what(), points, 2 * (12 + colors + transparencies))])?;
        Ok(())
    }
}
