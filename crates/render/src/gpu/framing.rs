//! Frames of a renderer, from their inputs.

use super::GpuRenderer;
use super::codes;
use super::scene::Scene;
use crate::{FrameInput, PictureSettings};

impl GpuRenderer {
    /// A frame of an input.
    pub(super) fn scene<'a>(
        &self,
        input: &'a FrameInput<'a>,
        settings: &'a PictureSettings,
        share: f32,
    ) -> Scene<'a> {
        let middle = input.middle(self.bounds);
        let (paint, reflected) = self.skin.paint(input.body_look);
        Scene {
            input,
            settings,
            level: input.level(self.bounds, settings.height, &self.guides),
            share,
            guide_count: self.guides.strand_count(),
            hair_strands: self.guides.hair_strands(),
            guide_points: self.guides.points_per_strand(),
            vertex_count: self.skin.vertex_count().unwrap_or(0),
            triangle_count: self.skin.corners().len() / 3,
            body_kind: self.skin.kind(),
            body_ball: self.skin.ball(),
            own: codes::own_kinds(&self.guides),
            paint,
            reflected,
            middle,
            own_color: self.own_colors.map(|own| own.mean),
        }
    }
}
