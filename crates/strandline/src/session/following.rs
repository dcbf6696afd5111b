//! A view that follows the keyframes of the camera.

use super::{Executor, Session};
use crate::{
    Error,
    render::Camera,
    scene::{CameraKeyframe, camera_motion::CameraMotion},
};

impl<E: Executor> Session<E> {
    /// Makes the view follow the keyframes of the camera, where there are some, until it is changed.
    pub fn follow_camera(&mut self) {
        self.follows_camera = self.camera_motion.is_some();
        let beginning = self.direction.time_shown(f64::INFINITY);
        self.camera_motion.iter().for_each(|motion| self.view.camera = motion.at(beginning));
    }

    /// Replaces the keyframes of the camera. The view follows them from the shown moment on; without any it is where the
    /// scene has it.
    pub(super) fn set_camera_keys(&mut self, keys: &[CameraKeyframe]) -> Result<(), Error> {
        self.camera_motion = CameraMotion::new(keys, self.camera_at_rest)?;
        self.follows_camera = self.camera_motion.is_some();
        self.view.camera = self.camera_at_rest;
        self.look_along(0.0);
        Ok(())
    }

    /// The camera as the scene has it, which its keyframes move.
    pub fn camera_at_rest(&self) -> &Camera {
        &self.camera_at_rest
    }

    /// True while the view follows the keyframes of the camera.
    pub fn follows_camera(&self) -> bool {
        self.follows_camera
    }

    /// Moves a view that follows keyframes to the shown moment, which lies `delay` \[s\] behind the end of a frame.
    pub(super) fn look_along(&mut self, delay: f64) {
        if let Some(motion) = self.camera_motion.as_ref().filter(|_| self.follows_camera) {
            self.view.camera = motion.at(self.direction.time_shown(delay));
        }
    }
}
