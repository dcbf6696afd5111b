//! From world space to samples.

use glam::{Affine3A, Vec3, Vec4};

use super::samples::Samples;
use crate::Camera;

/// Widest ribbon \[sample\]: wider than any picture. It keeps arithmetic on mad widths finite.
const MAX_WIDTH: f32 = 65_536.0;

/// A camera and the samples it fills. In *screen* vectors, x and y are in samples from the upper
/// left corner (y down), z is one over the view depth \[1/m\], which is linear across the screen, and w
/// a diameter \[sample\].
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// World to view space.
    pub view_from_world: Affine3A,
    /// Focal length \[sample\].
    pub focal: f32,
    /// One over the depth of the near plane \[1/m\].
    pub max_inverse_depth: f32,
    world_from_view: Affine3A,
    center: [f32; 2],
}

impl Projection {
    /// The projection of a camera onto the samples of a picture.
    pub fn new(camera: &Camera, samples: &Samples) -> Self {
        Self::of_size(camera, [samples.width() as f32, samples.height() as f32])
    }

    /// The projection of a camera onto a picture of a width and a height \[sample\].
    pub fn of_size(camera: &Camera, [width, height]: [f32; 2]) -> Self {
        let view_from_world = camera.view_from_world();
        Self {
            view_from_world,
            focal: 0.5 * height * camera.focal(),
            max_inverse_depth: 1.0 / camera.near,
            world_from_view: view_from_world.inverse(),
            center: [0.5 * width, 0.5 * height],
        }
    }

    /// Carries a point \[m\] in world space with a diameter \[m\] to the screen. Points nearer than the
    /// near plane get a z of 0.
    #[inline]
    pub fn screen(&self, point: Vec3, width: f32) -> Vec4 {
        let view = self.view_from_world.transform_point3(point);
        let inverse_depth = -1.0 / view.z;
        // Written so that a NaN, too, counts as nearer.
        if inverse_depth > 0.0 && inverse_depth <= self.max_inverse_depth {
            self.at(view, inverse_depth, width)
        } else {
            Vec4::ZERO
        }
    }

    #[inline]
    fn at(&self, view: Vec3, inverse_depth: f32, width: f32) -> Vec4 {
        let scale = self.focal * inverse_depth;
        let (x, y) = (self.center[0] + scale * view.x, self.center[1] - scale * view.y);
        // max first: it turns a NaN into 0.
        #[expect(clippy::manual_clamp)]
        let width = (scale * width).max(0.0).min(MAX_WIDTH);
        Vec4::new(x, y, inverse_depth, width)
    }

    /// Intersection of the near plane with a line between two points \[m\] on either side of it: the share of
    /// the way from `start`, 0..1, and the point on the screen, with a diameter \[m\].
    pub fn near_crossing(&self, start: Vec3, end: Vec3, widths: [f32; 2]) -> (f32, Vec4) {
        let [first, last] = [start, end].map(|point| self.view_from_world.transform_point3(point));
        let share = ((-1.0 / self.max_inverse_depth - first.z) / (last.z - first.z)).clamp(0.0, 1.0);
        let width = widths[0] * (1.0 - share) + widths[1] * share;
        (share, self.at(first.lerp(last, share), self.max_inverse_depth, width))
    }

    /// The point \[m\] in world space that is seen at a place on the screen.
    #[inline]
    pub fn world(&self, x: f32, y: f32, inverse_depth: f32) -> Vec3 {
        let scale = 1.0 / (self.focal * inverse_depth);
        let view =
            Vec3::new((x - self.center[0]) * scale, (self.center[1] - y) * scale, -1.0 / inverse_depth);
        self.world_from_view.transform_point3(view)
    }

    /// Position of the camera \[m\], world space.
    pub fn eye(&self) -> Vec3 {
        self.world_from_view.translation.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_screen_and_back() {
        let mut samples = Samples::default();
        samples.resize(1600, 1200);
        let camera = Camera::three_quarter();
        let projection = Projection::new(&camera, &samples);
        let middle = projection.screen(camera.target, 1e-3);
        assert!((middle.x - 800.0).abs() < 1e-2 && (middle.y - 600.0).abs() < 1e-2);
        let point = Vec3::new(0.1, -0.2, 0.05);
        let screen = projection.screen(point, 1e-3);
        // Half a metre of depth carries about 1e-7 of relative error: far below a micrometre.
        assert!((projection.world(screen.x, screen.y, screen.z) - point).length() < 2e-6);
        assert_eq!(projection.screen(camera.position, 1e-3), Vec4::ZERO);
        assert_eq!(projection.screen(Vec3::NAN, 1e-3), Vec4::ZERO);
        assert!((projection.eye() - camera.position).length() < 1e-6);
    }
}
