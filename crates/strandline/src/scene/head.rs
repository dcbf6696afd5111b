use std::sync::Arc;

use glam::{Quat, Vec3};
use strandline_base::math;

use crate::{
    Error,
    body::{BodyFrame, Motion, Neck, Playback, Pose, RecordedMotion, SkinMotion},
    scene::{MotionName, MotionSection, origin, solid_motion::SolidMotion},
};

/// Pose of a head at every time: a motion about a pivot, and a turn added to it. A body that moves by itself is carried
/// by them as a whole.
#[derive(Clone, Debug)]
pub struct HeadMotion {
    motion: Motion,
    pivot: Vec3,
    turn: Quat,
    /// Motions of solids, the pieces after the head.
    solids: Arc<[SolidMotion]>,
    /// The world's origin \[m\] from which poses are given.
    origin: Vec3,
    body: Option<SkinMotion>,
    /// Motion from a file, in the place of `motion` where the section asks for it.
    recorded: Option<RecordedMotion>,
    is_recorded: bool,
    /// Time of that motion at a time of the scene.
    playback: Playback,
    /// Neck of the built-in bust, and whether it bends under the motion.
    neck: Option<Neck>,
    bends: bool,
}

impl HeadMotion {
    /// The motion of a section about a pivot \[m\], head space.
    ///
    /// # Errors
    /// Keyframes that are missing, not finite or not in the order of their times.
    pub fn new(section: &MotionSection, pivot: Vec3) -> Result<Self, Error> {
        let turn = math::pitch_yaw_roll(section.rotation);
        let is_recorded = section.name == MotionName::File;
        Ok(Self {
            motion: section.motion()?,
            pivot,
            turn,
            body: None,
            recorded: None,
            is_recorded,
            playback: section.playback(),
            neck: None,
            bends: section.neck,
            solids: Arc::default(),
            origin: Vec3::ZERO,
        })
    }

    /// The same motion, which carries a body that moves by itself.
    pub(crate) fn with_body(self, body: Option<SkinMotion>) -> Self {
        Self { body, ..self }
    }

    /// The same motion of a bust with a neck of its own.
    pub(crate) fn with_neck(self, neck: Option<Neck>) -> Self {
        Self { neck, ..self }
    }

    /// Neck of the built-in bust, where its parts are pieces of the body.
    pub(crate) fn neck(&self) -> Option<Neck> {
        self.neck
    }

    /// The same motion beside solids that move by themselves.
    pub(crate) fn with_solids(self, solids: impl Into<Arc<[SolidMotion]>>) -> Self {
        Self { solids: solids.into(), ..self }
    }

    /// Motions of solids.
    pub(crate) fn solids(&self) -> &Arc<[SolidMotion]> {
        &self.solids
    }

    /// The same motion, with that of a file for a section that asks for it, played as the section says.
    pub(crate) fn with_recorded(self, recorded: Option<RecordedMotion>) -> Self {
        let recorded = recorded.map(|recorded| recorded.with_playback(self.playback));
        Self { recorded, ..self }
    }

    /// Motion from a file.
    pub(crate) fn recorded(&self) -> Option<&RecordedMotion> {
        self.recorded.as_ref()
    }

    /// Playback of the motion of a file, and the times \[s\] of its first and its last sample, where the head follows it.
    pub(crate) fn played(&self) -> Option<(Playback, [f64; 2])> {
        self.recorded.as_ref().filter(|_| self.is_recorded).map(RecordedMotion::played)
    }

    /// Way \[m\] from the end of the motion of a file that begins again to its beginning, where the head follows it and hair is
    /// not carried over the gap within a step of `step` \[s\].
    pub(crate) fn gap_of_loop(&self, step: f64) -> f32 {
        let recorded = self.recorded.as_ref().filter(|_| self.is_recorded);
        recorded.map_or(0.0, |recorded| recorded.gap_of_loop(step))
    }

    /// Motion of the body itself; `None` for a rigid one.
    pub(crate) fn body(&self) -> Option<&SkinMotion> {
        self.body.as_ref()
    }

    /// A head that rests.
    pub(crate) fn still() -> Self {
        Self {
            motion: Motion::Still,
            pivot: Vec3::ZERO,
            turn: Quat::IDENTITY,
            body: None,
            recorded: None,
            is_recorded: false,
            playback: Playback::default(),
            neck: None,
            bends: false,
            solids: Arc::default(),
            origin: Vec3::ZERO,
        }
    }

    /// The pose of the head at a time \[s\].
    pub fn pose(&self, time: f64) -> Pose {
        match &self.body {
            Some(_) => self.frame(time).world_from_head(),
            None => self.carrying(time).0,
        }
    }

    /// The body at a time \[s\]: the pose of the head, and the skin where it moves by itself.
    pub fn frame(&self, time: f64) -> BodyFrame {
        let (carrying, shoulders) = self.carrying(time);
        let frame = match &self.body {
            Some(body) => body.frame(time).carried_by(&carrying),
            None => carrying.into(),
        };
        let recorded = self.recorded.as_ref().filter(|_| self.is_recorded);
        let jumps = recorded.map_or_else(|| self.motion.jumps_until(time), |motion| motion.jumps_until(time));
        let frame = match jumps {
            Some(jumps) => frame.after_further_jumps(jumps),
            None => frame,
        };
        self.with_pieces(frame, &shoulders, time)
    }

    /// A body with the solids that move by themselves at a time \[s\], where it has no pieces of its own. A bust moves as one.
    pub(crate) fn beside_solids(&self, body: BodyFrame, time: f64) -> BodyFrame {
        let head = body.world_from_head();
        self.with_pieces(body, &head, time)
    }

    fn with_pieces(&self, body: BodyFrame, shoulders: &Pose, time: f64) -> BodyFrame {
        if (self.solids.is_empty() && self.neck.is_none()) || body.piece_count() > 1 {
            return body;
        }
        let head = body.world_from_head();
        let neck = self.neck.map(|neck| neck.pieces(&head, shoulders));
        let solids = self.solids.iter().map(|solid| solid.pose(time, &head, self.origin));
        body.with_pieces(neck.into_iter().flatten().chain(solids).collect::<Vec<_>>())
    }

    /// Transforms of the head, or of a body that moves by itself, and of the shoulders by the motion about the pivot.
    fn carrying(&self, time: f64) -> (Pose, Pose) {
        let pose = match self.recorded.as_ref().filter(|_| self.is_recorded) {
            Some(recorded) => recorded.pose_from(time, self.pivot, self.origin),
            None => self.motion.pose_from(time, self.pivot, self.origin),
        };
        let pivot = pose.point(self.pivot);
        let about = |rotation: Quat| Pose { rotation, translation: pivot - rotation * self.pivot };
        let of_shoulders = if self.bends { Neck::of_shoulders(pose.rotation) } else { pose.rotation };
        (about(pose.rotation * self.turn), about(of_shoulders * self.turn))
    }

    /// The same motion in a world whose origin lies at `origin` \[m\].
    pub(crate) fn seen_from(&self, origin: Vec3) -> Self {
        Self { origin, ..self.clone() }
    }

    /// The world's origin from which its poses are given \[m\].
    pub(crate) fn origin(&self) -> Vec3 {
        self.origin
    }

    /// An origin \[m\], in whole metres, beside the head at a time \[s\]; the world's where the head is near that.
    pub(crate) fn origin_at(&self, time: f64) -> Vec3 {
        origin::beside(self.seen_from(Vec3::ZERO).pose(time).point(self.pivot))
    }

    /// Point about which the head turns \[m\], head space.
    pub fn pivot(&self) -> Vec3 {
        self.pivot
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_turn_goes_about_the_pivot_and_moves_with_the_head() {
        let pivot = Vec3::new(0.0, -0.1, 0.02);
        let still = MotionSection { name: MotionName::Still, ..MotionSection::default() };
        let turned = MotionSection { rotation: Vec3::new(0.0, 90.0, 0.0), ..still.clone() };
        let head = HeadMotion::new(&turned, pivot).unwrap();
        assert!(head.pose(1.0).point(pivot).distance(pivot) < 1e-6);
        let ahead = head.pose(1.0).point(pivot + Vec3::Z);
        assert!(ahead.distance(pivot + Vec3::X) < 1e-5, "{ahead}");
        let nods = MotionSection { name: MotionName::Nod, ..turned };
        let pose = HeadMotion::new(&nods, pivot).unwrap().pose(0.4);
        let plain = HeadMotion::new(&MotionSection { name: MotionName::Nod, ..still }, pivot).unwrap();
        let expected = plain.pose(0.4).point(pivot + Vec3::X);
        assert!(pose.point(pivot + Vec3::Z).distance(expected) < 1e-5);
    }
}
