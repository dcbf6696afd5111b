//! One frame as the host knows it.

use glam::Vec3;

use crate::{DetailLevel, FrameInput, PictureSettings};

/// A frame as the host works it out.
pub(super) struct Scene<'a> {
    pub input: &'a FrameInput<'a>,
    pub settings: &'a PictureSettings,
    pub level: DetailLevel,
    pub share: f32,
    pub guide_count: usize,
    /// Number of guides that share the hairs of the look.
    pub hair_strands: usize,
    pub guide_points: usize,
    pub vertex_count: usize,
    pub triangle_count: usize,
    /// 0 none, 1 open, 2 closed.
    pub body_kind: u32,
    pub body_ball: (Vec3, f32),
    /// Attributes of the groom that are drawn: see codes.rs.
    pub own: u32,
    /// Drawn parts of the body's materials, in bits: see codes.rs.
    pub paint: u32,
    /// Mean colour of the body, linear RGB.
    pub reflected: Vec3,
    /// Middle of the hair \[m\], world space.
    pub middle: Vec3,
    /// Mean of the guides' colours.
    pub own_color: Option<Vec3>,
}

impl Scene<'_> {
    pub fn curve_points(&self) -> usize {
        self.level.segment_count(self.guide_points) + 1
    }

    pub fn strand_count(&self) -> usize {
        self.guide_count * self.level.strand_count()
    }

    pub fn point_count(&self) -> usize {
        self.strand_count() * self.curve_points()
    }

    pub fn segment_count(&self) -> usize {
        self.strand_count() * (self.curve_points() - 1)
    }

    /// Strands at full detail.
    pub fn full_count(&self) -> usize {
        self.guide_count * self.level.full_follow_strands as usize
    }

    pub fn shadow_count(&self) -> usize {
        self.input.lights.iter().filter(|light| light.shadow).count()
    }
}
