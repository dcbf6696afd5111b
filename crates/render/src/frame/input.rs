use glam::{DVec3, Vec3};
use strandline_body::{Aabb, BodyFrame};
use strandline_groom::{Guides, Vec3Lanes};

use super::middle;
use crate::memory::{DrawnGroom, check_lights};

use crate::{BodyLook, Camera, DetailLevel, LevelOfDetail, Light, Look, PictureSettings, RenderError};

/// Inputs of one picture.
#[derive(Clone, Copy)]
pub struct FrameInput<'a> {
    /// Guide points \[m\], world space, shape `[block][point]` of lanes.
    pub positions: &'a [Vec3Lanes],
    /// The body.
    pub body: &'a BodyFrame,
    /// The camera.
    pub camera: &'a Camera,
    /// The hair's look.
    pub look: &'a Look,
    /// The body's look.
    pub body_look: &'a BodyLook,
    /// The lights.
    pub lights: &'a [Light],
    /// Level of detail.
    pub level_of_detail: &'a LevelOfDetail,
}

impl FrameInput<'_> {
    /// Checks everything but the points.
    ///
    /// # Errors
    /// A setting outside its range.
    pub(crate) fn validate(&self) -> Result<(), RenderError> {
        self.camera.validate()?;
        self.look.validate()?;
        self.body_look.validate()?;
        self.level_of_detail.validate()?;
        check_lights(self.lights)
    }

    /// Checks the body of pictures with a mesh of a number of vertices, where there is a mesh.
    ///
    /// # Errors
    /// Numbers that are not finite; skin vertices of another mesh.
    pub(crate) fn check_body(&self, vertices: Option<usize>) -> Result<(), RenderError> {
        Ok(self.body.check(None, vertices)?)
    }

    /// Middle of the hair \[m\], world space, for guides that lie in a box at rest, head space: the mean of the places to
    /// which the root frames carry the box's middle, or the head's place without root frames.
    pub(crate) fn middle(&self, bounds: Aabb) -> Vec3 {
        let middle = middle(bounds);
        let Some(roots) = self.body.roots().filter(|roots| !roots.is_empty()) else {
            return self.body.world_from_head().point(middle);
        };
        let sum = roots.iter().fold(DVec3::ZERO, |sum, root| sum + root.point(middle).as_dvec3());
        (sum / roots.len() as f64).as_vec3()
    }

    /// Detail of guides that lie in a box at rest \[m\], head space, in a picture of a number of rows. Root frames move
    /// the box by the way of its middle.
    pub(crate) fn level(&self, bounds: Aabb, rows: u32, guides: &Guides) -> DetailLevel {
        let (detail, head) = (self.level_of_detail, self.body.world_from_head());
        let moved = self.middle(bounds) - head.point(middle(bounds));
        let eye = head.inverse().point(self.camera.position - moved);
        let outside = (bounds.min - eye).max(eye - bounds.max).max(Vec3::ZERO).length();
        let distances = [eye.distance(middle(bounds)), outside];
        let scale = detail.view_scale(self.camera, rows);
        let of = [guides.strand_count(), guides.points_per_strand()];
        detail.level_of(distances.map(|distance| scale * distance), self.look.follow_strands, of)
    }

    /// The most detail of pictures like one that is drawn: full detail, or that from nearby where it is close up.
    #[cfg(feature = "gpu")]
    pub(crate) fn fullest(&self, drawn: &DetailLevel, guides: &Guides) -> DetailLevel {
        let (detail, follow_strands) = (self.level_of_detail, self.look.follow_strands);
        if drawn.segments_per_span <= detail.segments_per_span as f32 {
            return DetailLevel::full(detail.segments_per_span, follow_strands);
        }
        detail.level_of([0.0; 2], follow_strands, [guides.strand_count(), guides.points_per_strand()])
    }

    /// Refuses more than can be drawn, before anything is allocated for it.
    pub(crate) fn check_memory(
        &self,
        guide_count: usize,
        points_per_strand: usize,
        level: &DetailLevel,
        picture: &PictureSettings,
    ) -> Result<(), RenderError> {
        // The texels of shadow maps are chosen already.
        let Self { look, lights, .. } = *self;
        DrawnGroom { guide_count, points_per_strand, look, lights, picture, own_color: None }.check(level)
    }
}
