//! Displacement in the picture of what each pixel shows, since the picture before.

use glam::{Vec2, Vec3};
use strandline_base::Pose;

use super::projection::Projection;
use crate::{Camera, FrameInput, PictureSettings};

/// State of a picture that the displacement in the next one is measured from.
#[derive(Clone, Debug)]
pub(crate) struct Before {
    camera: Camera,
    head: Pose,
    /// Points of the drawn strands \[m\], world space.
    points: Vec<Vec3>,
}

/// Displacement from one picture to the next.
pub(crate) struct Motion<'a> {
    /// `None` for the first picture.
    before: Option<(&'a Before, Projection)>,
    now: Projection,
    head: Pose,
    width: usize,
}

impl Before {
    /// The state of a picture whose strands have these points.
    pub fn new(input: &FrameInput, points: Vec<Vec3>) -> Self {
        Self { camera: *input.camera, head: input.body.world_from_head(), points }
    }
}

impl<'a> Motion<'a> {
    /// Displacement from the picture before to that of an input.
    pub fn new(before: Option<&'a Before>, input: &FrameInput, settings: &PictureSettings) -> Self {
        let size = [settings.width as f32, settings.height as f32];
        Self {
            before: before.map(|before| (before, Projection::of_size(&before.camera, size))),
            now: Projection::of_size(input.camera, size),
            head: input.body.world_from_head(),
            width: settings.width as usize,
        }
    }

    /// Displacement \[pixel\] of strand points, world space; 0 where other strands were drawn before.
    pub fn of_points(&self, points: &[Vec3]) -> Vec<Vec3> {
        match &self.before {
            Some((before, from)) if before.points.len() == points.len() => {
                let both = before.points.iter().zip(points);
                both.map(|(before, now)| between(from, *before, &self.now, *now).extend(0.0)).collect()
            }
            _ => vec![Vec3::ZERO; points.len()],
        }
    }

    /// Displacement \[pixel\] of the body at a depth along the view \[m\] in each pixel, 0 where there is none. The body
    /// moves as the head does.
    pub fn of_body(&self, depths: &[f32]) -> Vec<Vec2> {
        let Some((before, from)) = &self.before else { return vec![Vec2::ZERO; depths.len()] };
        let to_head = self.head.inverse();
        let of = |(at, depth): (usize, &f32)| {
            if *depth == 0.0 {
                return Vec2::ZERO;
            }
            let (column, row) = (at % self.width, at / self.width);
            let now = self.now.world(column as f32 + 0.5, row as f32 + 0.5, 1.0 / depth);
            between(from, before.head.point(to_head.point(now)), &self.now, now)
        };
        depths.iter().enumerate().map(of).collect()
    }
}

/// Displacement \[pixel\] between two places \[m\], each seen by its camera; 0 where one is nearer than the near plane.
fn between(from: &Projection, before: Vec3, to: &Projection, now: Vec3) -> Vec2 {
    let [before, now] = [from.screen(before, 0.0), to.screen(now, 0.0)];
    if before.z > 0.0 && now.z > 0.0 { Vec2::new(now.x - before.x, now.y - before.y) } else { Vec2::ZERO }
}
