use glam::{Affine3A, Mat4, Vec3, Vec4};
use serde::{Deserialize, Serialize};
use strandline_base::SettingError;
use strandline_base::math;
use strandline_body::Aabb;

use crate::RenderError;

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// Position \[m\], world space.
    pub position: Vec3,
    /// Point in the middle of the picture \[m\], world space.
    pub target: Vec3,
    /// Upward direction in the picture; it need not be perpendicular to the line of sight, nor of unit
    /// length.
    pub up: Vec3,
    /// Vertical field of view \[degrees\], 1 to 170.
    pub field_of_view: f32,
    /// Nothing nearer than this is drawn \[m\].
    pub near: f32,
}

impl Camera {
    /// The camera in a world whose origin lies at `origin` \[m\].
    pub fn seen_from(&self, origin: Vec3) -> Self {
        Self { position: self.position - origin, target: self.target - origin, ..*self }
    }

    /// The built-in bust from the front.
    pub fn front() -> Self {
        Self::around_bust(Vec3::Z)
    }

    /// A view of the built-in bust from its front left, slightly from above.
    pub fn three_quarter() -> Self {
        Self::around_bust(Vec3::new(0.62, 0.16, 0.77))
    }

    /// The built-in bust from its left side.
    pub fn side() -> Self {
        Self::around_bust(Vec3::X)
    }

    /// The built-in bust from behind.
    pub fn back() -> Self {
        Self::around_bust(Vec3::NEG_Z)
    }

    /// Head and shoulders fill the picture: 0.56 m high at the distance of the head's middle.
    fn around_bust(direction: Vec3) -> Self {
        let target = Vec3::new(0.0, -0.07, 0.0);
        Self { position: target + direction.normalize() * 1.05, target, ..Self::default() }
    }

    /// A camera that sees the whole of a box \[m\] from `direction` (from the box toward the camera;
    /// any length) in a picture of the given width over height.
    pub fn framing(bounds: Aabb, direction: Vec3, aspect: f32) -> Self {
        let target = 0.5 * (bounds.min + bounds.max);
        let mut camera = Self { target, ..Self::default() };
        let direction = direction.normalize_or(Vec3::Z);
        camera.position = target + direction;
        let corners: [Vec3; 8] = std::array::from_fn(|corner| {
            let pick =
                |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
            Vec3::new(pick(0), pick(1), pick(2))
        });
        let distance = camera.distance_to_see(&corners, aspect);
        // A margin of a twentieth keeps outlines off the picture's edge.
        camera.position = target + direction * (1.05 * distance).max(2.0 * camera.near);
        camera
    }

    /// The distance \[m\] from the target at which the camera sees all places \[m\], world space, without turning.
    pub fn distance_to_see(&self, places: &[Vec3], aspect: f32) -> f32 {
        let direction = (self.position - self.target).normalize_or(Vec3::Z);
        let world_from_view = self.view_from_world().inverse();
        let (right, up) = (Vec3::from(world_from_view.x_axis), Vec3::from(world_from_view.y_axis));
        let slope_up = math::tan(0.5 * self.field_of_view.to_radians());
        let slope_right = slope_up * aspect.max(1e-3);
        places.iter().fold(0.0_f32, |distance, place| {
            let offset = *place - self.target;
            let toward = offset.dot(direction);
            let needed = (offset.dot(right).abs() / slope_right).max(offset.dot(up).abs() / slope_up);
            distance.max(toward + needed)
        })
    }

    /// The camera carried around its target: `yaw` about the up axis (to the camera's right), then
    /// `pitch` upward \[radians\].
    pub fn orbit(&self, yaw: f32, pitch: f32) -> Self {
        let up = self.up.normalize_or(Vec3::Y);
        let offset = math::rotation(up, yaw) * (self.position - self.target);
        let right = up.cross(offset).normalize_or(Vec3::X);
        // The poles are kept off: there, up has no direction in the picture.
        let elevation = math::asin((offset.normalize_or(Vec3::Z).dot(up)).clamp(-1.0, 1.0));
        let pitch = (elevation + pitch).clamp(-1.5, 1.5) - elevation;
        Self { position: self.target + math::rotation(right, -pitch) * offset, ..*self }
    }

    /// Carries world space to view space: x right, y up, the camera at the origin looking along -z.
    pub fn view_from_world(&self) -> Affine3A {
        let backward = (self.position - self.target).normalize_or(Vec3::Z);
        // Straight up or down, any direction across will do.
        let across = self.up.cross(backward);
        let right = if across.length_squared() > 1e-12 {
            across.normalize()
        } else {
            backward.any_orthonormal_vector()
        };
        let up = backward.cross(right);
        let world_from_view = glam::Mat3::from_cols(right, up, backward);
        let view_from_world = world_from_view.transpose();
        Affine3A::from_mat3_translation(view_from_world, -(view_from_world * self.position))
    }

    /// Carries view space to clip space for a picture of the given width over height: x and y in
    /// -1..1 with y up, depth 1 at the near plane and 0 at infinity.
    pub fn clip_from_view(&self, aspect: f32) -> Mat4 {
        let focal = self.focal();
        Mat4::from_cols(
            Vec4::new(focal / aspect, 0.0, 0.0, 0.0),
            Vec4::new(0.0, focal, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, self.near, 0.0),
        )
    }

    /// Focal length in half picture heights.
    pub fn focal(&self) -> f32 {
        1.0 / math::tan(0.5 * self.field_of_view.to_radians())
    }

    /// Checks every field.
    ///
    /// # Errors
    /// A value that is not finite, a field of view outside 1 to 170 degrees, a near plane that is not
    /// positive, a camera that stands on its target.
    pub fn validate(&self) -> Result<(), RenderError> {
        let refuse = |key, found: String, expected: &str| Err(SettingError::new(key, found, expected).into());
        if !self.position.is_finite() || !self.target.is_finite() {
            let found = format!("{} looking at {}", self.position, self.target);
            return refuse("camera.position", found, "finite numbers");
        }
        if self.position.distance(self.target) < 1e-6 {
            return refuse("camera.target", self.target.to_string(), "a point away from camera.position");
        }
        if !self.up.is_finite() || self.up.length_squared() < 1e-12 {
            return refuse("camera.up", self.up.to_string(), "a direction, such as [0, 1, 0]");
        }
        if !(1.0..=170.0).contains(&self.field_of_view) {
            return refuse("camera.field_of_view", self.field_of_view.to_string(), "1 to 170 degrees");
        }
        if !(self.near.is_finite() && self.near >= 1e-4) {
            return refuse("camera.near", self.near.to_string(), "a distance of 0.0001 m or more");
        }
        Ok(())
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            position: Vec3::new(0.0, -0.07, 1.05),
            target: Vec3::new(0.0, -0.07, 0.0),
            up: Vec3::Y,
            field_of_view: 30.0,
            near: 0.01,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_target_is_in_the_middle_and_up_is_up() {
        for camera in [Camera::front(), Camera::three_quarter(), Camera::side(), Camera::back()] {
            camera.validate().unwrap();
            let view_from_world = camera.view_from_world();
            let target = view_from_world.transform_point3(camera.target);
            assert!((target - Vec3::new(0.0, 0.0, -1.05)).length() < 1e-5);
            assert!(view_from_world.transform_point3(camera.target + 0.1 * Vec3::Y).y > 0.09);
            let clip = camera.clip_from_view(1.5) * target.extend(1.0);
            assert!(clip.x.abs() < 1e-5 && clip.y.abs() < 1e-5 && clip.w > 1.0);
        }
    }

    #[test]
    fn the_left_side_of_the_head_is_on_the_right_of_a_front_picture() {
        let point = Camera::front().view_from_world().transform_point3(Vec3::X * 0.1);
        assert!(point.x > 0.09);
    }

    #[test]
    fn framing_shows_every_corner_and_wastes_little() {
        let bounds = Aabb { min: Vec3::new(-0.2, -0.3, -0.1), max: Vec3::new(0.3, 0.2, 0.4) };
        for aspect in [0.5, 1.0, 2.0] {
            let camera = Camera::framing(bounds, Vec3::new(1.0, 0.4, 1.0), aspect);
            let clip_from_world = camera.clip_from_view(aspect) * Mat4::from(camera.view_from_world());
            let mut extent = 0.0_f32;
            for corner in 0..8 {
                let pick = |axis: usize| [bounds.min[axis], bounds.max[axis]][corner >> axis & 1];
                let clip = clip_from_world * Vec3::new(pick(0), pick(1), pick(2)).extend(1.0);
                extent = extent.max((clip.x / clip.w).abs()).max((clip.y / clip.w).abs());
            }
            assert!(extent < 1.0 && extent > 0.9, "{extent}");
        }
    }

    #[test]
    fn orbiting_keeps_the_distance_and_a_full_turn_returns() {
        let camera = Camera::three_quarter();
        let turned = camera.orbit(std::f32::consts::TAU, 0.0);
        assert!((turned.position - camera.position).length() < 1e-5);
        let raised = camera.orbit(0.3, 9.0);
        assert!((raised.position.distance(raised.target) - 1.05).abs() < 1e-5);
        assert!(raised.position.y > camera.position.y);
        let quarter = Camera::front().orbit(std::f32::consts::FRAC_PI_2, 0.0);
        assert!((quarter.position - Camera::side().position).length() < 1e-5);
    }

    #[test]
    fn bad_cameras_are_refused_by_name() {
        let good = Camera::front();
        let bad = [
            (Camera { field_of_view: 0.0, ..good }, "field_of_view"),
            (Camera { near: f32::NAN, ..good }, "near"),
            (Camera { target: good.position, ..good }, "target"),
            (Camera { position: Vec3::NAN, ..good }, "position"),
            (Camera { up: Vec3::ZERO, ..good }, "up"),
        ];
        for (camera, name) in bad {
            assert!(camera.validate().unwrap_err().to_string().contains(name));
        }
    }
}
