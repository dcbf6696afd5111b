//! The drawn strands of a frame, point by point, and what both backends know of how they are grown.

pub(crate) mod clump;
pub(crate) mod curve;
pub(crate) mod roots;
pub(crate) mod scalp;

use glam::Vec3;
use strandline_base::SettingError;
use strandline_groom::{Binding, Guides, LaneSet};

use crate::RenderError;
use crate::level_of_detail::EveryFew;

/// Checks that the strands of a binding have the numbers of those of a renderer.
pub(crate) fn check_strands(strands: &Guides, binding: &Binding) -> Result<(), RenderError> {
    let shape = |strands: &Guides| [strands.strand_count(), strands.points_per_strand()];
    let (found, expected) = (shape(binding.strands()), shape(strands));
    if found == expected {
        return Ok(());
    }
    Err(SettingError::new("the bound strands", format!("{found:?}"), "those of the renderer").into())
}

/// All drawn strands of a frame. Every strand has the same number of points; shapes are
/// `[strand][point]`, root first, guide after guide, each guide followed by its follow strands.
#[derive(Clone, Debug, Default)]
pub struct Strands {
    /// Number of drawn strands.
    pub strand_count: usize,
    /// Drawn strands of each guide, the guide itself first.
    pub strands_per_guide: usize,
    /// Strands that there are at full detail.
    pub full_count: usize,
    /// Of each eight guides those whose strands are drawn ([`crate::DetailLevel::drawn_lanes`]); the others have none here.
    pub lanes: LaneSet,
    /// Points on each strand, one more than its segments.
    pub points_per_strand: usize,
    /// Positions \[m\], world space.
    pub positions: Vec<Vec3>,
    /// Unit tangents, root to tip, world space.
    pub tangents: Vec<Vec3>,
    /// Diameters \[m\], after taper and level of detail.
    pub widths: Vec<f32>,
    /// Colours of the groom, linear RGB, shape `[guide][point]` of the drawn guides; empty where it has none.
    pub colors: Vec<Vec3>,
    /// Radiance toward the camera, linear RGB; filled by `shade`. A renderer finds it where it is seen instead.
    pub radiances: Vec<Vec3>,
}

impl Strands {
    /// The guide of a strand among all guides, and the number of the strand among those of the guide: from afar some
    /// strands without follow strands are left out.
    #[inline]
    pub fn place(&self, strand: usize) -> (usize, usize) {
        (self.lanes.strand(strand / self.strands_per_guide), strand % self.strands_per_guide)
    }

    /// Colours of the groom at the points of a strand, where it has some.
    #[inline]
    pub(crate) fn own_colors(&self, strand: usize) -> Option<&[Vec3]> {
        let (guide, count) = (strand / self.strands_per_guide, self.points_per_strand);
        self.colors.get(guide * count..(guide + 1) * count)
    }

    /// True if a strand belongs to those that stand for all.
    #[inline]
    pub(crate) fn is_one_of(&self, strand: usize, few: EveryFew) -> bool {
        let (guide, index) = self.place(strand);
        few.holds(guide, index)
    }

    /// Number of segments of all strands.
    pub fn segment_count(&self) -> usize {
        self.strand_count * (self.points_per_strand - 1)
    }

    /// Makes room for a frame; memory is kept from frame to frame and contents are left as they are.
    pub fn resize(&mut self, guide_count: usize, strands_per_guide: usize, points_per_strand: usize) {
        self.strand_count = guide_count * strands_per_guide;
        self.strands_per_guide = strands_per_guide;
        self.points_per_strand = points_per_strand;
        let size = self.strand_count * points_per_strand;
        self.positions.resize(size, Vec3::ZERO);
        self.tangents.resize(size, Vec3::Y);
        self.widths.resize(size, 0.0);
        self.radiances.resize(size, Vec3::ZERO);
    }
}
