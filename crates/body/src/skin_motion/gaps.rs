//! Ways between the end of a motion that begins again and its beginning.

use glam::Vec3;

use super::{Moving, SkinMotion};
use crate::Playback;
use crate::leaps::Leap;
use crate::rigid_fit::rigid_fit;

impl Moving {
    /// True where the motion begins again at some time.
    fn is_round(&self) -> bool {
        self.playback.is_round(self.motion.end())
    }

    /// Playback and end of the motion \[s\]: motions of the same begin again together.
    fn round(&self) -> (Playback, f64) {
        (self.playback, self.motion.end())
    }

    /// True where the motion begins again behind a mark, or a jump between its last samples.
    fn is_marked_at_ends(&self) -> bool {
        let end = self.motion.end();
        self.motion.marks().are_at_ends(end) || self.leaps.are_at_end(end)
    }
}

impl SkinMotion {
    /// For each motion, in the order in which they were added, the greatest distance \[m\] between where vertices are at its
    /// end and where they are at its beginning; 0 for one that does not begin again, and for one over whose gap hair is
    /// carried: its beginning or its end is marked, or the head jumps there within a step of `step` \[s\].
    pub fn gaps_of_loops(&self, step: f64) -> Vec<f32> {
        let mut carried: Vec<(Playback, f64)> =
            self.parts.iter().filter(|part| part.is_marked_at_ends()).map(Moving::round).collect();
        let body = &self.parts[0];
        if body.is_round() && !carried.contains(&body.round()) && self.head_leap_of_loop().is_jump(step) {
            carried.push(body.round());
        }
        let gap = |part: &Moving| {
            if !part.is_round() || carried.contains(&part.round()) {
                return 0.0;
            }
            let [from, to] = [0.0, part.motion.end()].map(|time| part.motion.positions(time));
            let apart = from.iter().zip(&to).map(|(from, to)| part.scale * from.distance(*to));
            apart.filter(|apart| apart.is_finite()).fold(0.0, f32::max)
        };
        self.parts.iter().map(gap).collect()
    }

    /// The way of the head from the end of the body's motion to its beginning.
    fn head_leap_of_loop(&self) -> Leap {
        let body = &self.parts[0];
        let pose = |time: f64| {
            let mut skin = self.rest.to_vec();
            body.place(time, &mut skin);
            rigid_fit(&self.rest, &skin, &self.fitted)
        };
        let place = self.fitted.first().map_or(Vec3::ZERO, |index| self.rest[*index as usize]);
        Leap::new(&pose(body.motion.end()), &pose(0.0), place)
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, vec3};

    use super::*;
    use crate::VertexMotion;

    /// Length of a step \[s\].
    const STEP: f64 = 1.0 / 60.0;

    #[test]
    fn a_gap_that_hair_is_carried_over_or_never_comes_to_is_none() {
        let rest = [vec3(0.0, 0.0, 0.0), vec3(0.1, 0.0, 0.0), vec3(0.0, 0.1, 0.0), vec3(0.0, 0.0, 0.1)];
        // Ways [m] of the samples after the first one, whose times are others.
        let told = |ways: [f32; 2], times: [f64; 3], speed: f64, marks: &[f64]| {
            let moved = |way: f32| rest.map(|place| place + Vec3::X * way).to_vec();
            let frames = vec![rest.to_vec(), moved(ways[0]), moved(ways[1])];
            let motion =
                VertexMotion::sampled(times.to_vec(), frames).unwrap().with_teleports(marks).unwrap();
            let playback = Playback { start: 0.0, speed, is_loop: true };
            let body = SkinMotion::new(motion, playback, &rest, (1.0, Quat::IDENTITY), &[]).unwrap();
            let [before, after] = [0.999, 1.001].map(|time| body.frame(time));
            (body.gaps_of_loops(STEP)[0] > 0.01, before.jumps_to(&after))
        };
        let slow = [0.0, 0.5, 1.0];
        assert_eq!(told([0.2, 0.4], slow, 1.0, &[]), (true, false));
        assert_eq!(told([0.2, 0.4], slow, 0.0, &[]), (false, false), "it stands still");
        for marks in [&[0.0][..], &[1.0], &[2.0]] {
            assert_eq!(told([0.2, 0.4], slow, 1.0, marks), (false, true), "{marks:?}");
        }
        assert_eq!(told([0.2, 0.4], slow, 1.0, &[0.5]), (true, false), "a mark elsewhere");
        assert_eq!(
            told([1.0, 2.0], slow, 1.0, &[]),
            (false, false),
            "2 m in a step are a jump by themselves"
        );
        assert_eq!(told([0.95, 0.4], [0.0, 0.99, 1.0], 1.0, &[]), (false, true), "a jump at the end");
    }
}
