//! A body whose vertices move by themselves: where its vertices are at a time, and the body frames that follow.

mod gaps;

use std::ops::Range;
use std::sync::{Arc, Mutex};

use glam::{Quat, Vec3};

use crate::leaps::Leaps;
use crate::rigid_fit::rigid_fit;
use crate::{BodyError, BodyFrame, Playback, Pose, VertexMotion};

/// Most vertices that the head's transform is fitted to.
const FITTED: usize = 2048;
/// Most vertices by which jumps between samples are found.
const LOOKED_AT: usize = 64;
/// Vertices of one joint that tell its rotation.
const LEAST: usize = 8;
/// Largest coordinate that is taken for a place \[m\].
const FARTHEST: f32 = 1e6;

/// Times of the motions \[s\], and the frame there.
type Known = (Vec<f64>, BodyFrame);

/// Body frames over time of a mesh in head space whose first vertices move: the skin, and the rigid transform of the
/// head, which is that of the vertices about the roots.
#[derive(Clone, Debug)]
pub struct SkinMotion {
    /// Motions of vertices; those of no motion ride the head.
    parts: Vec<Moving>,
    /// Vertices at rest \[m\], head space.
    rest: Arc<[Vec3]>,
    /// Vertices that move with the head.
    fitted: Arc<[u32]>,
    /// The frame of the times of the motions that were asked for last.
    last: Arc<Mutex<Option<Known>>>,
}

/// Vertices of a mesh that move as one motion has them.
#[derive(Clone, Debug)]
struct Moving {
    motion: VertexMotion,
    playback: Playback,
    /// Number of its first vertex in the mesh.
    first: usize,
    /// Vertices at rest as the motion has them, units of the file.
    origin: Arc<[Vec3]>,
    /// Metres of a unit of the file, and its rotation into head space.
    scale: f32,
    turn: Quat,
    /// Jumps of the head between two samples.
    leaps: Leaps,
}

impl Moving {
    /// The vertices of a mesh from the one of number `first` on, as a motion has them.
    ///
    /// # Errors
    /// Fewer vertices in the mesh, of `count`, than the motion has.
    fn new(
        motion: VertexMotion,
        playback: Playback,
        (first, count): (usize, usize),
        (scale, turn): (f32, Quat),
    ) -> Result<Self, BodyError> {
        let (own, origin) = (motion.vertex_count(), motion.rest());
        if own > count.saturating_sub(first) || own == 0 || origin.len() != own {
            let (found, expected) = (format!("{own}, for a mesh of {count}"), "those of the mesh");
            return Err(BodyError::Value { what: "the number of vertices that move", found, expected });
        }
        Ok(Self { motion, playback, first, origin: origin.into(), scale, turn, leaps: Leaps::default() })
    }

    /// The same, in which the head jumps between samples of the motion too far apart for a person's. Those with a mark between
    /// them are jumps already. The head is where vertices of these indices are.
    fn with_leaps(self, rest: &[Vec3], head: &[u32]) -> Self {
        let Some(place) = head.first().map(|index| rest[*index as usize]) else { return self };
        let own: Vec<Vec3> = head.iter().map(|index| rest[*index as usize]).collect();
        let all: Vec<u32> = (0..head.len() as u32).collect();
        let pose = |time: f64| {
            let moved = self.motion.places(time, head);
            let placed = own.iter().zip(head).zip(moved).map(|((rest, index), moved)| {
                let place = *rest + self.turn * (self.scale * (moved - self.origin[*index as usize]));
                if is_place(place) { place } else { *rest }
            });
            let pose = rigid_fit(&own, &placed.collect::<Vec<_>>(), &all);
            if pose.rotation.is_finite() && pose.translation.is_finite() { pose } else { Pose::IDENTITY }
        };
        let mut spans = self.motion.spans();
        spans.retain(|span| self.motion.marks().is_after(*span, span[1]).is_none());
        let leaps = Leaps::find(spans, place, pose);
        Self { leaps, ..self }
    }

    /// Indices of its vertices in the mesh.
    fn range(&self) -> Range<usize> {
        self.first..self.first + self.origin.len()
    }

    /// Time of the motion at one of the scene \[s\].
    fn time(&self, time: f64) -> f64 {
        self.leaps.held(self.playback.time(time, self.motion.end()))
    }

    /// True where the motion is elsewhere at once at some time.
    fn is_cut(&self) -> bool {
        !self.motion.teleports().is_empty() || !self.leaps.is_empty()
    }

    /// Number of marks and jumps up to a time of the scene \[s\].
    fn passed(&self, time: f64) -> i64 {
        let (rounds, end) = (self.playback.rounds(time, self.motion.end()), self.motion.end());
        let time = self.playback.time(time, end);
        self.motion.marks().passed(time, rounds).saturating_add(self.leaps.passed(time, rounds))
    }

    /// Writes the places of its vertices at a time of the motion \[s\] over those at rest, head space \[m\]. Returns the number
    /// of those that have none and are held at rest.
    fn place(&self, time: f64, rest: &mut [Vec3]) -> usize {
        let moved = self.motion.positions(time);
        let mut held_count = 0;
        for ((rest, origin), moved) in rest[self.range()].iter_mut().zip(&*self.origin).zip(moved) {
            // Vertices that do not move stay to the bit.
            let place = *rest + self.turn * (self.scale * (moved - *origin));
            if is_place(place) {
                *rest = place;
            } else {
                held_count += 1;
            }
        }
        held_count
    }
}

/// True for what may be a place in head space \[m\].
fn is_place(place: Vec3) -> bool {
    place.is_finite() && place.abs().max_element() < FARTHEST
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
        placing: (f32, Quat),
        head: &[u32],
    ) -> Result<Self, BodyError> {
        let count = motion.vertex_count();
        if let Some(index) = head.iter().find(|index| **index as usize >= count) {
            let (found, expected) = (format!("{index}, of {count}"), "a vertex that moves");
            return Err(BodyError::Value { what: "a vertex of the head", found, expected });
        }
        let all: Vec<u32> = if head.is_empty() { (0..count as u32).collect() } else { head.to_vec() };
        let rigid = motion.rigid(&all);
        let all = if rigid.len() < LEAST { all } else { rigid };
        let every = all.len().div_ceil(FITTED);
        let fitted: Arc<[u32]> = all.into_iter().step_by(every).collect();
        let few: Vec<u32> = fitted.iter().copied().step_by(fitted.len().div_ceil(LOOKED_AT)).collect();
        let body = Moving::new(motion, playback, (0, rest.len()), placing)?.with_leaps(rest, &few);
        Ok(Self { parts: vec![body], rest: rest.into(), fitted, last: Arc::default() })
    }

    /// Adds a motion of further vertices, from the one of number `first` on: a part of the body in a file of its own. It
    /// moves beside the body, in the space that both files share, and does not ride the head.
    ///
    /// # Errors
    /// Fewer vertices than the motion has; vertices that move already.
    pub fn with_part(
        self,
        first: usize,
        motion: VertexMotion,
        playback: Playback,
        placing: (f32, Quat),
    ) -> Result<Self, BodyError> {
        let mut part = Moving::new(motion, playback, (first, self.rest.len()), placing)?;
        // Clothes of the same clip jump with the body.
        let body = &self.parts[0];
        if part.playback == body.playback && part.motion.end() == body.motion.end() {
            part.leaps = body.leaps.clone();
        }
        let own = part.range();
        if let Some(other) =
            self.parts.iter().map(Moving::range).find(|other| own.start < other.end && other.start < own.end)
        {
            let (found, expected) = (format!("{own:?}, beside {other:?}"), "vertices of no other motion");
            return Err(BodyError::Value { what: "the vertices of a part", found, expected });
        }
        Ok(Self { parts: [self.parts, vec![part]].concat(), last: Arc::default(), ..self })
    }

    /// The body at a time of the scene \[s\].
    pub fn frame(&self, time: f64) -> BodyFrame {
        let frame = self.frame_without_marks(time);
        let cut = |part: &&Moving| part.is_cut();
        let passed = self.parts.iter().filter(cut).map(|part| part.passed(time));
        match passed.reduce(i64::saturating_add) {
            Some(passed) => frame.after_jumps(passed),
            None => frame,
        }
    }

    fn frame_without_marks(&self, time: f64) -> BodyFrame {
        let times: Vec<f64> = self.parts.iter().map(|part| part.time(time)).collect();
        let known = |last: &Option<(Vec<f64>, BodyFrame)>| {
            last.as_ref().filter(|(known, _)| *known == times).map(|(_, frame)| frame.clone())
        };
        // A thread that ended while it held the lock left a whole frame or none.
        let lock = || self.last.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(frame) = known(&lock()) {
            return frame;
        }
        let frame = self.computed(&times);
        *lock() = Some((times, frame.clone()));
        frame
    }

    /// The body at times of its motions \[s\].
    fn computed(&self, times: &[f64]) -> BodyFrame {
        let mut skin = self.rest.to_vec();
        let held = self.parts.iter().zip(times).map(|(part, time)| part.place(*time, &mut skin));
        let held_count = held.sum();
        let world_from_head = rigid_fit(&self.rest, &skin, &self.fitted);
        let head_from_world = world_from_head.inverse();
        for range in self.parts.iter().map(Moving::range) {
            skin[range].iter_mut().for_each(|place| *place = head_from_world.point(*place));
        }
        BodyFrame::from(world_from_head).with_skin(skin).with_held(held_count)
    }

    /// For each motion, in the order in which they were added, its playback, and the times \[s\] of its first and its last
    /// sample.
    pub fn played(&self) -> Vec<(Playback, [f64; 2])> {
        let of_part = |part: &Moving| (part.playback, [part.motion.begin(), part.motion.end()]);
        self.parts.iter().map(of_part).collect()
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
    fn clothes_of_the_same_motion_are_held_through_a_jump_with_the_body() {
        let rest = [Vec3::ZERO, Vec3::X * 0.1, Vec3::Y * 0.1, Vec3::Z * 0.1];
        let far = rest.map(|place| place + Vec3::X * 9.0);
        let motion = VertexMotion::sampled(vec![0.0, 0.04], vec![rest.to_vec(), far.to_vec()]).unwrap();
        let (all, placing) = ([rest, rest].concat(), (1.0, Quat::IDENTITY));
        let body = SkinMotion::new(motion.clone(), Playback::default(), &all, placing, &[]).unwrap();
        let both = body.with_part(4, motion, Playback::default(), placing).unwrap();
        let skin = both.frame(0.02).skin().map(|skin| skin.to_vec());
        assert!(skin.is_none_or(|skin| skin == all), "nothing is on its way");
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
    fn a_part_moves_beside_the_body_at_its_own_times() {
        let (motion, mut rest, turn) = motion();
        let count = rest.len();
        // A part of two vertices that rises by 20 cm in half a second, and one vertex that rides the head.
        let places = [vec3(0.0, 0.0, 100.0), vec3(5.0, 0.0, 100.0)];
        let raised = places.map(|place| place + Vec3::Z * 20.0);
        let part = VertexMotion::sampled(vec![0.0, 0.5], vec![places.to_vec(), raised.to_vec()]).unwrap();
        rest.extend([vec3(0.0, 1.1, 0.2), vec3(0.05, 1.1, 0.2), Vec3::splat(9.0)]);
        let body = SkinMotion::new(motion, Playback::default(), &rest, (0.01, turn), &[0, 1, 2, 3]).unwrap();
        let playback = Playback { start: 0.25, speed: -1.0, is_loop: true };
        let both = body.clone().with_part(count, part.clone(), playback, (0.01, turn)).unwrap();
        for (time, share) in [(0.0, 0.5), (0.125, 0.25), (0.5, 0.5), (0.625, 0.25)] {
            let (alone, frame) = (body.frame(time), both.frame(time));
            assert_eq!(alone.world_from_head(), frame.world_from_head());
            let (skin, expected) = (frame.skin().unwrap(), alone.skin().unwrap());
            assert_eq!(skin[..count], expected[..count], "the body moves as alone");
            for vertex in count..count + 2 {
                let world = frame.world_from_head().point(skin[vertex]);
                assert!(world.distance(rest[vertex] + Vec3::Y * 0.2 * share) < 1e-6, "{world} at {time}");
            }
            assert_eq!(skin[count + 2], rest[count + 2], "rides the head");
        }
        // Its marks count with those of the body; its loop does not close.
        let marked = |own: VertexMotion| body.clone().with_part(count, own, playback, (0.01, turn)).unwrap();
        assert!(!both.frame(0.2).jumps_to(&both.frame(0.3)));
        let jumping = marked(part.clone().with_teleports(&[0.0]).unwrap());
        assert!(jumping.frame(0.2).jumps_to(&jumping.frame(0.3)));
        let [of_body, of_part] = both.gaps_of_loops(0.01)[..] else { panic!("two motions") };
        assert!(of_body == 0.0 && (of_part - 0.2).abs() < 1e-6);
        assert_eq!((jumping.gaps_of_loops(0.01), body.gaps_of_loops(0.01)), (vec![0.0; 2], vec![0.0]));
        let refused = |first| body.clone().with_part(first, part.clone(), playback, (1.0, turn)).unwrap_err();
        assert!(refused(4).to_string().contains("4..6, beside 0..5"));
        assert!(refused(7).to_string().contains("2, for a mesh of 8"));
    }

    #[test]
    fn vertices_at_no_place_rest_and_are_counted() {
        let (_, rest, turn) = motion();
        let mut far = rest.clone();
        (far[3], far[4]) = (Vec3::X * 1e9, Vec3::Y * f32::MAX);
        let motion = VertexMotion::sampled(vec![0.0, 1.0], vec![rest.clone(), far]).unwrap();
        let body = SkinMotion::new(motion, Playback::default(), &rest, (1.0, turn), &[0, 1, 2]).unwrap();
        let [start, end] = [0.0, 1.0].map(|time| body.frame(time));
        assert_eq!((start.held_count(), end.held_count()), (0, 2));
        assert_eq!(end.skin().unwrap()[..], rest[..]);
        assert_eq!(start.toward(&end, 0.5).carried_by(&crate::Pose::IDENTITY).held_count(), 2);
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
