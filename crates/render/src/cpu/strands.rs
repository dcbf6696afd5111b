//! What the stages hand on: every drawn strand of a frame, point by point.

use glam::Vec3;

/// All drawn strands of a frame. Every strand has the same number of points; shapes are
/// `[strand][point]`, root first, guide after guide, each guide followed by its follow strands.
#[derive(Clone, Debug, Default)]
pub struct Strands {
    /// Number of drawn strands.
    pub strand_count: usize,
    /// Points on each strand, one more than its segments.
    pub points_per_strand: usize,
    /// Positions \[m\], world space.
    pub positions: Vec<Vec3>,
    /// Unit tangents, root to tip, world space.
    pub tangents: Vec<Vec3>,
    /// Diameters \[m\], after taper and level of detail.
    pub widths: Vec<f32>,
    /// Radiance toward the camera, linear RGB; filled by `shade`.
    pub radiances: Vec<Vec3>,
}
