//! A body whose vertices move by themselves: where its vertices are at a time, and the body frames that follow.

use std::sync::{Arc, Mutex};

use glam::{Quat, Vec3};

use crate::gltf::Rig;
use crate::rigid_fit::rigid_fit;
use crate::teleports::Teleports;
use crate::vertex_frames::VertexFrames;
use crate::{BodyError, BodyFrame};

/// Most vertices that the head's transform is fitted to.
const FITTED: usize = 2048;
/// Vertices of one joint that tell its rotation.
const LEAST: usize = 8;
/// Largest coordinate that is taken for a place \[m\].
const FARTHEST: f32 = 1e6;

/// Motion of the vertices of a mesh, in the units and axes of its file, in the order of the mesh.
#[derive(Clone, Debug)]
pub struct VertexMotion {
    source: Source,
    teleports: Teleports,
}

#[derive(Clone, Debug)]
enum Source {
    Clip(Arc<Rig>),
    /// Frames, and the positions at rest where they are not those of the first frame.
    Frames(Arc<VertexFrames>, Option<Arc<[Vec3]>>),
}

impl VertexMotion {
    pub(crate) fn of_clip(rig: Rig) -> Self {
        let teleports = rig.teleports().clone();
        Self { source: Source::Clip(Arc::new(rig)), teleports }
    }

    pub(crate) fn of_frames(frames: VertexFrames) -> Self {
        Self { source: Source::Frames(Arc::new(frames), None), teleports: Teleports::default() }
    }

    /// Vertices at times \[s\]: shape `[frame][vertex]`. Between two times they move on straight lines; at rest they are
    /// where the first frame has them.
    ///
    /// # Errors
    /// No frame; as many times as frames, finite and rising; as many vertices in each frame as in the first, finite.
    pub fn sampled(times: Vec<f64>, frames: Vec<Vec<Vec3>>) -> Result<Self, BodyError> {
        VertexFrames::new(times, frames).map(Self::of_frames)
    }

    /// The motion of a mesh whose vertices have these positions at rest, units of the file; clips have their own rest.
    #[must_use]
    pub fn with_rest(self, rest: &[Vec3]) -> Self {
        let source = match self.source {
            Source::Frames(frames, _) => Source::Frames(frames, Some(rest.into())),
            clip => clip,
        };
        Self { source, ..self }
    }

    /// Adds marks, times of the motion \[s\] at which the body is elsewhere at once: hair is carried there, not pulled.
    /// Between the samples on both sides of a mark nothing is interpolated. The earlier one is held until the mark. In a
    /// motion that begins again a mark at 0 makes the beginning a jump.
    ///
    /// # Errors
    /// Times that are not finite.
    pub fn with_teleports(self, times: &[f64]) -> Result<Self, BodyError> {
        let teleports = Teleports::new(&[self.teleports.times(), times].concat())?;
        Ok(Self { teleports, ..self })
    }

    /// Times of the marks \[s\], rising: those of the file and those that were added.
    pub fn teleports(&self) -> &[f64] {
        self.teleports.times()
    }

    /// Time of the last sample \[s\]; those before the first and after the last are held.
    pub fn end(&self) -> f64 {
        match &self.source {
            Source::Clip(rig) => rig.end(),
            Source::Frames(frames, _) => frames.end(),
        }
    }

    /// Positions of all vertices at a time \[s\], units of the file.
    pub fn positions(&self, time: f64) -> Vec<Vec3> {
        match &self.source {
            Source::Clip(rig) => rig.positions(Some(time), &self.teleports),
            Source::Frames(frames, _) => frames.positions(time, &self.teleports),
        }
    }

    /// Positions of all vertices at rest, units of the file.
    fn rest(&self) -> Vec<Vec3> {
        match &self.source {
            Source::Clip(rig) => rig.positions(None, &self.teleports),
            Source::Frames(_, Some(rest)) => rest.to_vec(),
            Source::Frames(frames, None) => frames.positions(f64::NEG_INFINITY, &self.teleports),
        }
    }

    /// Of some vertices those that are known to move as one.
    fn rigid(&self, vertices: &[u32]) -> Vec<u32> {
        match &self.source {
            Source::Clip(rig) => rig.rigid(vertices),
            Source::Frames(..) => Vec::new(),
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        match &self.source {
            Source::Clip(rig) => rig.vertex_count(),
            Source::Frames(frames, _) => frames.vertex_count(),
        }
    }
}

/// Time of a motion at a time of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Time of the motion at the time 0 of the scene \[s\].
    pub start: f64,
    /// Seconds of the motion in a second of the scene.
    pub speed: f64,
    /// Begins again after its end.
    pub is_loop: bool,
}

impl Default for Playback {
    fn default() -> Self {
        Self { start: 0.0, speed: 1.0, is_loop: false }
    }
}

impl Playback {
    /// Time \[s\] of a motion that ends at `end` \[s\], at a time of the scene \[s\].
    pub fn time(&self, time: f64, end: f64) -> f64 {
        let time = self.start + self.speed * time;
        let time = if self.is_loop && end > 0.0 { time.rem_euclid(end) } else { time };
        if time.is_finite() { time } else { 0.0 }
    }

    /// Number of times that the motion has begun again.
    fn rounds(&self, time: f64, end: f64) -> f64 {
        let is_round = self.is_loop && end > 0.0;
        if is_round { ((self.start + self.speed * time) / end).floor() } else { 0.0 }
    }
}

/// Body frames over time of a mesh in head space whose first vertices move: the skin, and the rigid transform of the
/// head, which is that of the vertices about the roots.
#[derive(Clone, Debug)]
pub struct SkinMotion {
    motion: VertexMotion,
    playback: Playback,
    /// Vertices at rest \[m\], head space; those beyond the motion's ride the head.
    rest: Arc<[Vec3]>,
    /// Vertices at rest as the motion has them, units of the file.
    origin: Arc<[Vec3]>,
    /// Metres of a unit of the file, and its rotation into head space.
    scale: f32,
    turn: Quat,
    /// Vertices that move with the head.
    fitted: Arc<[u32]>,
    /// The frame of the time that was asked for last.
    last: Arc<Mutex<Option<(f64, BodyFrame)>>>,
}

impl SkinMotion {
    /// The motion of a mesh that was placed in head space by a scale \[m per unit\] and a rotation: the positions of its
    /// vertices there \[m\], those of the motion first. The head is where the vertices of these indices are, all of them
    /// without any; in a clip those of them that one joint carries alone, where there are enough.
    ///
    /// # Errors
    /// Fewer vertices than the motion has; an index beyond them.
    pub fn new(
        motion: VertexMotion,
        playback: Playback,
        rest: &[Vec3],
        (scale, turn): (f32, Quat),
        head: &[u32],
    ) -> Result<Self, BodyError> {
        let (count, origin) = (motion.vertex_count(), motion.rest());
        if count > rest.len() || count == 0 || origin.len() != count {
            let (found, expected) = (format!("{count}, for a mesh of {}", rest.len()), "those of the mesh");
            return Err(BodyError::Value { what: "the number of vertices that move", found, expected });
        }
        if let Some(index) = head.iter().find(|index| **index as usize >= count) {
            let (found, expected) = (format!("{index}, of {count}"), "a vertex that moves");
            return Err(BodyError::Value { what: "a vertex of the head", found, expected });
        }
        let all: Vec<u32> = if head.is_empty() { (0..count as u32).collect() } else { head.to_vec() };
        let rigid = motion.rigid(&all);
        let all = if rigid.len() < LEAST { all } else { rigid };
        let every = all.len().div_ceil(FITTED);
        Ok(Self {
            motion,
            playback,
            rest: rest.into(),
            origin: origin.into(),
            scale,
            turn,
            fitted: all.into_iter().step_by(every).collect(),
            last: Arc::default(),
        })
    }

    /// The body at a time of the scene \[s\].
    pub fn frame(&self, time: f64) -> BodyFrame {
        let frame = self.frame_without_marks(time);
        let marks = &self.motion.teleports;
        if marks.times().is_empty() {
            return frame;
        }
        let end = self.motion.end();
        frame.after_jumps(marks.passed(self.playback.time(time, end), self.playback.rounds(time, end)))
    }

    fn frame_without_marks(&self, time: f64) -> BodyFrame {
        let time = self.playback.time(time, self.motion.end());
        let known = |last: &Option<(f64, BodyFrame)>| {
            last.as_ref().filter(|(known, _)| *known == time).map(|(_, frame)| frame.clone())
        };
        // A thread that ended while it held the lock left a whole frame or none.
        let lock = || self.last.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(frame) = known(&lock()) {
            return frame;
        }
        let frame = self.computed(time);
        *lock() = Some((time, frame.clone()));
        frame
    }

    /// The body at a time of the motion \[s\].
    fn computed(&self, time: f64) -> BodyFrame {
        let moved = self.motion.positions(time);
        let place = |((rest, origin), moved): ((&Vec3, &Vec3), Vec3)| {
            // Vertices that do not move stay to the bit; those that overflow are held at rest.
            let place = *rest + self.turn * (self.scale * (moved - *origin));
            if place.is_finite() && place.abs().max_element() < FARTHEST { place } else { *rest }
        };
        let placed: Vec<Vec3> = self.rest.iter().zip(&*self.origin).zip(moved).map(place).collect();
        let world_from_head = rigid_fit(&self.rest, &placed, &self.fitted);
        let head_from_world = world_from_head.inverse();
        let riding = self.rest[placed.len()..].iter().copied();
        let skin = placed.iter().map(|place| head_from_world.point(*place)).chain(riding);
        BodyFrame::from(world_from_head).with_skin(skin.collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    /// A tetrahedron of a head and a vertex of a shoulder below, in centimetres with z up, over a second.
    fn motion() -> (VertexMotion, Vec<Vec3>, Quat) {
        let rest =
            [vec3(0.0, 0.0, 160.0), vec3(10.0, 0.0, 150.0), vec3(0.0, 10.0, 150.0), vec3(0.0, 0.0, 140.0)];
        let rest = [&rest[..], &[vec3(20.0, 0.0, 120.0)]].concat();
        let mut moved: Vec<Vec3> = rest.iter().map(|place| *place + Vec3::X * 30.0).collect();
        moved[4] = rest[4] + Vec3::Z * 5.0;
        let motion = VertexMotion::sampled(vec![0.0, 1.0], vec![rest.clone(), moved]).unwrap();
        let turn = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
        let placed = rest.iter().map(|place| turn * (0.01 * *place) + vec3(0.0, 0.1, 0.2)).collect();
        (motion, placed, turn)
    }

    #[test]
    fn the_skin_is_given_beside_the_rigid_motion_of_the_head() {
        let (motion, mut rest, turn) = motion();
        rest.push(Vec3::splat(9.0));
        let placing = (0.01, turn);
        let body = SkinMotion::new(motion, Playback::default(), &rest, placing, &[0, 1, 2, 3]).unwrap();
        assert_eq!(body.frame(-1.0).skin().unwrap()[..], rest[..], "the first frame is held, to the bit");
        assert_eq!(body.frame(0.0).world_from_head(), crate::Pose::IDENTITY);
        for (time, share) in [(0.5, 0.5), (1.0, 1.0), (7.0, 1.0)] {
            let frame = body.frame(time);
            let skin = frame.skin().unwrap();
            assert!(frame.world_from_head().translation.distance(Vec3::X * 0.3 * share) < 1e-6);
            for vertex in [0, 1, 2, 3, 5] {
                assert!(skin[vertex].distance(rest[vertex]) < 1e-6, "{vertex} rides the head at {time}");
            }
            let world = frame.world_from_head().point(skin[4]);
            assert!(world.distance(rest[4] + Vec3::Y * 0.05 * share) < 1e-6, "{world}");
            assert!(frame.check(None, Some(6)).is_ok());
        }
    }

    #[test]
    fn playback_starts_goes_on_and_begins_again() {
        let playback = Playback { start: 0.5, speed: 2.0, is_loop: true };
        assert_eq!([0.0, 0.5, 1.0].map(|time| playback.time(time, 2.0)), [0.5, 1.5, 0.5]);
        assert_eq!(Playback { speed: -1.0, ..playback }.time(1.0, 2.0), 1.5);
        assert_eq!(Playback { is_loop: false, ..playback }.time(5.0, 2.0), 10.5);
        assert_eq!(playback.time(f64::NAN, 2.0), 0.0);
    }

    #[test]
    fn a_mark_holds_what_was_before_it_and_numbers_the_frames() {
        let (motion, rest, turn) = motion();
        let motion = motion.with_teleports(&[0.6]).unwrap();
        let new =
            |playback| SkinMotion::new(motion.clone(), playback, &rest, (0.01, turn), &[0, 1, 2, 3]).unwrap();
        let body = new(Playback::default());
        let [held, before, after, later] = [0.3, 0.59, 0.6, 2.0].map(|time| body.frame(time));
        assert_eq!(held.world_from_head(), crate::Pose::IDENTITY, "nothing is interpolated over a mark");
        assert_eq!(before, held);
        assert!(after.world_from_head().translation.distance(Vec3::X * 0.3) < 1e-6);
        assert_eq!(later, after);
        assert!(before.jumps_to(&after) && !held.jumps_to(&before) && !after.jumps_to(&later));
        assert_eq!(before.toward(&after, 0.5), after, "there is no way to a frame behind a mark");
        // Each round has the mark again, also backward; the beginning of a round has none.
        let rounds = new(Playback { is_loop: true, ..Playback::default() });
        let [first, end, begun, second] = [0.7, 0.99, 1.1, 1.7].map(|time| rounds.frame(time));
        assert!(!first.jumps_to(&end) && !end.jumps_to(&begun) && begun.jumps_to(&second));
        let unmarked = self::motion().0;
        let body = SkinMotion::new(unmarked, Playback::default(), &rest, (0.01, turn), &[]).unwrap();
        assert!(!body.frame(0.3).jumps_to(&body.frame(0.9)));
    }

    #[test]
    fn a_motion_that_does_not_fit_is_refused() {
        let (motion, rest, turn) = motion();
        let new = |rest: &[Vec3], head: &[u32]| {
            SkinMotion::new(motion.clone(), Playback::default(), rest, (0.01, turn), head)
                .unwrap_err()
                .to_string()
        };
        assert!(new(&rest[..4], &[]).contains("5, for a mesh of 4"));
        assert!(new(&rest, &[5]).contains("5, of 5"));
    }
}
