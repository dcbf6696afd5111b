use std::path::PathBuf;

use glam::Vec3;
use strandline_base::math;
use strandline_base::{SettingError, choices, settings};

use super::TeleportSection;
use crate::{
    Error,
    body::{Curve, Interpolation, Key, Keyframe, Motion, Playback},
};

choices! {
    /// The name of a motion.
    pub enum MotionName as "motion.name" {
        /// The head rests.
        Still = "still",
        /// "No".
        Shake = "shake",
        /// "Yes".
        Nod = "nod",
        /// A slow look to both sides.
        Turn = "turn",
        /// The poses of `[[motion.keyframes]]`.
        Keyframes = "keyframes",
        /// The motion of a joint of `motion.file`, from its first moment on.
        File = "file",
    }
    default Shake
}

settings! {
    /// A pose at a time, as a person writes it.
    pub struct KeyframeSection: Copy {
        /// Time; each later than the one before.
        time: f64 = 0.0, in [-1e6, 1e6] "s";
        /// Angles about the pivot: pitch (about x), yaw (about y), roll (about z), applied in the order roll, pitch,
        /// yaw; each angle is a curve of its own, so 720 degrees are two turns.
        rotation: Vec3 = Vec3::ZERO, in [-36_000.0, 36_000.0] "degrees", slider [-180.0, 180.0];
        /// Displacement of the pivot.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// The way to the next pose; without it that of `motion.interpolation`.
        interpolation: Option<Interpolation> = None;
        /// A jump: the pose before is held until this one. Hair is carried over jumps of the head; where a pose is held
        /// ("hold") and the next one is more than 15 degrees or 0.1 m away, that is a jump too.
        cut: bool = false;
    }
}

settings! {
    /// Motion of the head.
    pub struct MotionSection {
        /// The motion; without a name that of a body that moves by itself is "still".
        name: MotionName = MotionName::default();
        /// Point about which the head turns, head space; without one it is the mannequin's neck, or a
        /// point low in the body's or the groom's box.
        pivot: Option<Vec3> = None, in [-1e4, 1e4] "m";
        /// Rotation of the head added to its motion, about the pivot: pitch (about x), yaw (about y),
        /// roll (about z).
        rotation: Vec3 = Vec3::ZERO, in [-360.0, 360.0] "degrees", slider [-70.0, 70.0];
        /// Bends the neck of the built-in bust, so that its shoulders stay; without this the bust moves as one, which costs less. Beyond 75
        /// degrees the shoulders follow. It is a setting of the load: a window keeps the neck that it began with, and says so. The exact
        /// mannequin never bends.
        neck: bool = false;
        /// The way from pose to pose, where a pose does not name its own.
        interpolation: Interpolation = Interpolation::default();
        /// A .bvh, .gltf, .glb or .vrm file with a skeleton; used by "file".
        file: Option<PathBuf> = None;
        /// The joint of that file that moves as the head does, a node of a glTF.
        joint: String = "Head".to_owned();
        /// Clip of that file, where it is a glTF; without a name its first.
        clip: Option<String> = None;
        /// Metres per unit of that file.
        scale: f32 = 1.0, in [1e-6, 1e6] "m";
        /// Time of that file's motion at the time 0 of the scene; the motion is held before its beginning and after its end.
        start: f64 = 0.0, in [-1e6, 1e6] "s", slider [0.0, 10.0];
        /// Seconds of that file's motion in a second of the scene.
        speed: f64 = 1.0, in [-1000.0, 1000.0], slider [0.0, 4.0], more "a faster motion";
        /// Begins that file's motion again after its end.
        r#loop: bool = false;
        /// Marks at which the joint is elsewhere at once, beside `extras.teleports` of a glTF's clip, times of the file's
        /// motion. A `loop` jumps at its beginning where 0 is marked.
        teleports: Vec<TeleportSection> = Vec::new(), in [0, 100_000];
        /// Poses, in the order of their times; used by "keyframes".
        keyframes: Vec<KeyframeSection> = Vec::new();
    }
}

impl MotionSection {
    /// The motion itself.
    ///
    /// # Errors
    /// Keyframes that are missing, not finite or not in the order of their times.
    pub fn motion(&self) -> Result<Motion, Error> {
        Ok(match self.name {
            // The motion of a file is loaded with the scene.
            MotionName::Still | MotionName::File => Motion::Still,
            MotionName::Shake => Motion::Shake,
            MotionName::Nod => Motion::Nod,
            MotionName::Turn => Motion::Turn,
            MotionName::Keyframes => {
                let keys: Vec<_> =
                    self.keyframes.iter().map(|key| key.keyframe(self.interpolation)).collect();
                Motion::keyframes(&keys)?
            }
        })
    }

    /// The key of what differs from another section in how the motion of `file` is read; `None` where that motion is the
    /// same. It is read when a scene is loaded.
    pub(crate) fn differs_in_file(&self, other: &Self) -> Option<&'static str> {
        let differs = [
            ("motion.file", self.file != other.file),
            ("motion.joint", self.joint != other.joint),
            ("motion.clip", self.clip != other.clip),
            ("motion.scale", self.scale != other.scale),
            ("motion.teleports", self.teleports != other.teleports),
        ];
        differs.into_iter().find(|(_, differs)| *differs).map(|(key, _)| key)
    }

    /// Checks that hair which was loaded with this section can follow another one.
    ///
    /// # Errors
    /// The motion of a file that was not read as the other section says.
    pub(crate) fn check_next(&self, next: &Self) -> Result<(), SettingError> {
        if next.name != MotionName::File {
            return Ok(());
        }
        if next.file.is_none() {
            return Err(SettingError::new("motion.name", "\"file\" without one", "`motion.file` too"));
        }
        match self.differs_in_file(next) {
            Some(key) => {
                let found = "another value than that of the motion as loaded";
                Err(SettingError::new(key, found, "the same one, or the scene loaded again"))
            }
            None => Ok(()),
        }
    }

    /// Time of the motion of `file` at a time of the scene.
    pub(crate) fn playback(&self) -> Playback {
        Playback { start: self.start, speed: self.speed, is_loop: self.r#loop }
    }
}

impl KeyframeSection {
    pub(super) fn keyframe(&self, interpolation: Interpolation) -> Keyframe {
        Keyframe {
            time: self.time,
            rotation: self.rotation,
            translation: self.translation,
            interpolation: self.interpolation.unwrap_or(interpolation),
            is_cut: self.cut,
        }
    }
}

settings! {
    /// Mean velocity of the air at a time.
    pub struct WindKeyframe: Copy {
        /// Time; each later than the one before.
        time: f64 = 0.0, in [-1e6, 1e6] "s";
        /// Mean velocity, world space.
        velocity: Vec3 = Vec3::ZERO, in [-100.0, 100.0] "m/s", slider [-10.0, 10.0];
        /// The way to the next keyframe; "smooth" without it.
        interpolation: Option<Interpolation> = None;
        /// A jump: the velocity before is held until this one.
        cut: bool = false;
    }
}

settings! {
    /// A place from which air blows: a fan with a direction, else a source to all sides. Rods under
    /// `simulation.drag.factor` feel it.
    pub struct WindSource: Copy {
        /// Place, world space.
        position: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Direction in which a fan blows, of any length: a jet that widens by a tenth of its way. Without it air blows to
        /// all sides.
        direction: Option<Vec3> = None, in [-1e4, 1e4];
        /// Speed of the air where a fan begins, else at `radius`.
        speed: f32 = 5.0, in [0.0, 100.0] "m/s", slider [0.0, 20.0];
        /// Radius of the source.
        radius: f32 = 0.1, in [1e-3, 100.0] "m", slider [0.01, 1.0], more "air that blows farther";
    }
}

settings! {
    /// Motion of the air.
    pub struct WindSection {
        /// Mean velocity, world space.
        velocity: Vec3 = Vec3::ZERO, in [-100.0, 100.0] "m/s", slider [-10.0, 10.0];
        /// Time in which the wind rises from calm at the beginning.
        rise: f32 = 0.0, in [0.0, 1000.0] "s", slider [0.0, 5.0], more "a wind that comes up more slowly";
        /// Share of the velocity that comes and goes.
        gust: f32 = 0.5, in [0.0, 1.0], more "stronger gusts and lulls";
        /// Time from gust to gust.
        gust_period: f32 = 1.7, in [0.05, 1000.0] "s", slider [0.2, 10.0], more "slower gusts";
        /// Speed of turbulence over that of the wind: eddies of many sizes that ride along with it. Rods under
        /// `simulation.drag.factor` feel it.
        turbulence: f32 = 0.0, in [0.0, 2.0], slider [0.0, 1.0], more "hair that flutters more";
        /// Length of the largest eddies; the smallest have a quarter of it.
        turbulence_size: f32 = 0.4, in [0.02, 100.0] "m", slider [0.05, 2.0], more "whole locks that move together";
        /// Seed of the turbulence.
        seed: u32 = 1, in [0, u32::MAX];
        /// Places from which air blows.
        sources: Vec<WindSource> = Vec::new(), in [0, 8];
        /// Mean velocities in the order of their times, in the place of `velocity`.
        keyframes: Vec<WindKeyframe> = Vec::new(), in [0, 100_000];
    }
}

impl WindSection {
    /// Velocity of the air \[m/s\] at a time \[s\]: two swings whose periods have no common multiple.
    pub fn at(&self, time: f64) -> Vec3 {
        let phase = std::f64::consts::TAU * time / f64::from(self.gust_period);
        let swing = 0.7 * math::sin(phase) + 0.3 * math::sin(2.618 * phase);
        let wind = self.mean(time) * (1.0 + self.gust * swing as f32);
        if self.rise > 0.0 { wind * self.risen(time) } else { wind }
    }

    /// Share of the wind that has risen at a time \[s\], without a jolt at either end.
    pub(super) fn risen(&self, time: f64) -> f32 {
        if self.rise == 0.0 {
            return 1.0;
        }
        let share = (time as f32 / self.rise).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }

    /// Velocity \[m/s\] at which turbulence rides along: the mean of keyframes, if there are any.
    pub(super) fn carrying(&self) -> Vec3 {
        let keys = self.keyframes.iter().map(|key| key.velocity);
        if self.keyframes.is_empty() {
            self.velocity
        } else {
            keys.sum::<Vec3>() / self.keyframes.len() as f32
        }
    }

    /// Mean velocity of the air \[m/s\] at a time \[s\].
    fn mean(&self, time: f64) -> Vec3 {
        // A scene with keyframes out of order is refused.
        let Ok(Some(curve)) = self.curve() else { return self.velocity };
        glam::DVec3::from(curve.at(time)).as_vec3()
    }

    /// The curve through the keyframes; none without them.
    ///
    /// # Errors
    /// Times that do not rise.
    pub(super) fn curve(&self) -> Result<Option<Curve<3>>, Error> {
        let key = |key: &WindKeyframe| Key {
            time: key.time,
            value: key.velocity.as_dvec3().to_array(),
            interpolation: key.interpolation.unwrap_or_default(),
            is_cut: key.cut,
        };
        if self.keyframes.is_empty() {
            return Ok(None);
        }
        Ok(Some(Curve::new(self.keyframes.iter().map(key).collect())?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wind_rises_from_calm() {
        let wind = WindSection { velocity: Vec3::X, gust: 0.0, rise: 2.0, ..WindSection::default() };
        for (time, share) in [(-1.0, 0.0), (0.0, 0.0), (1.0, 0.5), (2.0, 1.0), (3.0, 1.0)] {
            assert_eq!(wind.at(time), Vec3::X * share, "{time} s");
        }
    }

    #[test]
    fn a_motion_of_a_file_is_followed_as_it_was_loaded() {
        let joint = |joint: &str| MotionSection {
            name: MotionName::File,
            file: Some("walk.bvh".into()),
            joint: joint.to_owned(),
            ..MotionSection::default()
        };
        let nod = MotionSection { name: MotionName::Nod, ..MotionSection::default() };
        let bare = MotionSection { file: None, ..joint("Head") };
        assert!(joint("Head").check_next(&joint("Head")).is_ok() && joint("Head").check_next(&nod).is_ok());
        let refused = |from: &MotionSection, to: &MotionSection| from.check_next(to).unwrap_err().to_string();
        assert!(refused(&nod, &bare).contains("expected `motion.file` too"));
        assert!(refused(&nod, &joint("Head")).starts_with("motion.file is another"));
        assert!(refused(&joint("Head"), &joint("Hips")).starts_with("motion.joint is another"));
    }

    #[test]
    fn wind_follows_its_keyframes() {
        let mut wind = WindSection { velocity: Vec3::Z, gust: 0.0, ..WindSection::default() };
        assert_eq!(wind.at(1.0), Vec3::Z);
        let key = |time: f64, x: f32| WindKeyframe {
            time,
            velocity: Vec3::X * x,
            interpolation: Some(Interpolation::Linear),
            ..WindKeyframe::default()
        };
        wind.keyframes = vec![key(0.0, 0.0), key(2.0, 4.0), WindKeyframe { cut: true, ..key(3.0, -1.0) }];
        for (time, x) in [(-1.0, 0.0), (0.5, 1.0), (2.0, 4.0), (2.9, 4.0), (3.0, -1.0), (9.0, -1.0)] {
            assert_eq!(wind.at(time), Vec3::X * x, "{time} s");
        }
        wind.gust = 1.0;
        assert_ne!(wind.at(2.3), Vec3::X * 4.0, "gusts come and go beside keyframes");
        let mut scene = crate::Scene::default();
        scene.wind.keyframes = vec![key(1.0, 0.0), key(1.0, 1.0)];
        assert!(scene.check().unwrap_err().to_string().contains("keyframe 1 has the time 1 s"));
    }
}
