//! Motion of the camera through the keyframes of `[camera]`.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::CameraKeyframe;
use crate::{
    Error,
    body::{Curve, Key},
    render::Camera,
};

/// Most that a camera rises above its target or sinks below it \[degrees\]: beyond that up is nowhere.
const STEEPEST: f32 = 89.0;

/// A camera that moves about where a scene has it.
#[derive(Clone, Debug)]
pub(crate) struct CameraMotion {
    base: Camera,
    curve: Curve<6>,
}

/// The curve through keyframes; none without them.
///
/// # Errors
/// Times that do not rise.
pub(super) fn curve(keys: &[CameraKeyframe]) -> Result<Option<Curve<6>>, Error> {
    let key = |key: &CameraKeyframe| {
        let [x, y, z] = key.translation.as_dvec3().to_array();
        let [turn, rise, distance] = [key.turn, key.rise, key.distance].map(f64::from);
        let interpolation = key.interpolation.unwrap_or_default();
        Key { time: key.time, value: [turn, rise, distance, x, y, z], interpolation, is_cut: key.cut }
    };
    if keys.is_empty() {
        return Ok(None);
    }
    Ok(Some(Curve::new(keys.iter().map(key).collect())?))
}

impl CameraKeyframe {
    /// The keyframe at a time \[s\] by which a camera that the scene has at `base` looks as `seen` does. Its turn is the one
    /// nearest to `turn` \[degrees\], that of a keyframe before it; the field of view stays that of `base`.
    pub fn of_view(seen: &Camera, base: &Camera, time: f64, turn: f32) -> Self {
        let [(yaw, rise, distance), (base_yaw, base_rise, base_distance)] = [seen, base].map(place);
        let turned = yaw - base_yaw;
        Self {
            time,
            turn: turned + 360.0 * ((turn - turned) / 360.0).round(),
            rise: rise - base_rise,
            distance: (distance / base_distance.max(1e-6)).clamp(0.01, 1000.0),
            translation: seen.target - base.target,
            ..Self::default()
        }
    }
}

/// Yaw and height above its target \[degrees\], and distance from it \[m\], of a camera.
fn place(camera: &Camera) -> (f32, f32, f32) {
    let offset = camera.position - camera.target;
    let level = Vec3::new(offset.x, 0.0, offset.z).length();
    let yaw = math::atan2(offset.x, offset.z).to_degrees();
    (yaw, math::atan2(offset.y, level).to_degrees(), offset.length())
}

impl CameraMotion {
    /// The motion of a camera through keyframes, about its place without them; none without keyframes.
    ///
    /// # Errors
    /// Times that do not rise.
    pub fn new(keyframes: &[CameraKeyframe], base: Camera) -> Result<Option<Self>, Error> {
        Ok(curve(keyframes)?.map(|curve| Self { base, curve }))
    }

    /// The camera at a time \[s\].
    pub fn at(&self, time: f64) -> Camera {
        let [turn, rise, distance, x, y, z] = self.curve.at(time);
        let [turn, rise, distance] = [turn % 360.0, rise, distance].map(|value| value as f32);
        let moved = glam::DVec3::new(x, y, z).as_vec3();
        let offset = self.base.position - self.base.target;
        let (_, own, _) = place(&self.base);
        // A scene may have it steeper.
        let steep = (own + rise).clamp((-STEEPEST).min(own), STEEPEST.max(own));
        // The axis about which a camera before the face rises.
        let across = Vec3::new(offset.z, 0.0, -offset.x).try_normalize().unwrap_or(Vec3::X);
        let risen = if rise == 0.0 { offset } else { turned(across, own - steep) * offset };
        let offset = turned(Vec3::Y, turn) * risen * distance;
        let target = self.base.target + moved;
        Camera { position: target + offset, target, ..self.base }
    }
}

fn turned(axis: Vec3, degrees: f32) -> Quat {
    math::rotation(axis, degrees.to_radians())
}

#[cfg(test)]
#[allow(clippy::disallowed_methods)] // compared values may be rounded
mod tests {
    use super::*;
    use crate::body::Interpolation;

    fn motion(keys: &[CameraKeyframe]) -> CameraMotion {
        let base = Camera {
            position: Vec3::new(0.0, 1.5, 2.0),
            target: Vec3::new(0.0, 1.5, 0.0),
            ..Camera::default()
        };
        CameraMotion::new(keys, base).unwrap().unwrap()
    }

    #[test]
    fn a_turn_is_even_and_comes_back() {
        let linear = Some(Interpolation::Linear);
        let motion = motion(&[
            CameraKeyframe { interpolation: linear, ..CameraKeyframe::default() },
            CameraKeyframe { time: 4.0, turn: 360.0, ..CameraKeyframe::default() },
        ]);
        for (time, place) in
            [(0.0, Vec3::Z), (1.0, Vec3::X), (2.0, Vec3::NEG_Z), (3.0, Vec3::NEG_X), (4.0, Vec3::Z)]
        {
            let camera = motion.at(time);
            let away = (camera.position - Vec3::new(0.0, 1.5, 0.0) - 2.0 * place).length();
            assert!(away < 1e-5 && camera.target == Vec3::new(0.0, 1.5, 0.0), "{away} m at {time} s");
        }
    }

    #[test]
    fn a_camera_rises_comes_near_and_moves() {
        let key = CameraKeyframe { rise: 30.0, distance: 0.5, ..CameraKeyframe::default() };
        let camera = motion(&[key]).at(7.0);
        let expected = Vec3::new(0.0, 1.5 + 0.5, 0.75_f32.sqrt());
        assert!(camera.position.distance(expected) < 1e-5, "{}", camera.position);
        let key = CameraKeyframe { translation: Vec3::X, ..CameraKeyframe::default() };
        let camera = motion(&[key]).at(0.0);
        assert_eq!((camera.position.x, camera.target.x), (1.0, 1.0));
        let key = CameraKeyframe { rise: 180.0, ..CameraKeyframe::default() };
        let camera = motion(&[key]).at(0.0);
        let height = camera.position.y - 1.5;
        assert!(height > 1.99 && camera.position.z > 0.01, "not over the pole: {}", camera.position);
    }

    #[test]
    fn a_keyframe_of_a_view_shows_it() {
        let base = motion(&[CameraKeyframe::default()]).at(0.0);
        for (x, y, z) in [(1.0, 2.0, -0.5), (-2.0, 1.0, 0.1), (0.3, 3.0, 2.5)] {
            let target = Vec3::new(0.1, 1.4, -0.2);
            let seen = Camera { position: Vec3::new(x, y, z), target, ..base };
            for turn in [0.0, 350.0, -720.0] {
                let key = CameraKeyframe::of_view(&seen, &base, 2.0, turn);
                assert!((key.turn - turn).abs() <= 180.0 && key.time == 2.0, "{key:?}");
                let shown = motion(&[key]).at(0.0);
                assert!(shown.position.distance(seen.position) < 1e-4, "{shown:?}");
                assert!(shown.target.distance(seen.target) < 1e-6);
            }
        }
    }

    #[test]
    fn times_that_do_not_rise_are_refused() {
        let mut scene = crate::Scene::default();
        scene.camera.keyframes = vec![CameraKeyframe::default(); 2];
        assert!(scene.check().unwrap_err().to_string().contains("keyframe 1 has the time 0 s"));
    }
}
