//! Pairs of segments that touch or nearly do, their memory, and the force of Coulomb's law between them.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use strandline_groom::LANES;

use crate::SimError;

/// Share of its push by which a pair yields in a round: wisps that cannot all have their room press each other with a force
/// that stays bounded.
const YIELDS: f32 = 5e-3;

/// Memory of a pair from one part of a step to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Pair {
    /// Numbers of both segments, that of a lane `[block][point][lane]`; the lower one first.
    pub segments: [u32; 2],
    /// Unit vector from the second segment to the first, on the side where they belong.
    pub normal: [f32; 3],
    /// Force on the first segment \[N\].
    pub force: [f32; 3],
    /// Distance along the normal \[m\]: at which both are held together, else at the end of the part.
    pub gap: f32,
    /// 1 for a pair that slides, 0 for one that sticks.
    pub slides: f32,
}

impl Pair {
    /// Numbers of a pair in a checkpoint.
    pub const NUMBERS: usize = 12;

    /// Its numbers. A segment takes two of them, which single precision holds whole.
    pub fn numbers(&self) -> [f32; Self::NUMBERS] {
        let [one, other] =
            self.segments.map(|segment| [segment >> 16, segment & 0xffff].map(|half| half as f32));
        let ([x, y, z], [u, v, w]) = (self.normal, self.force);
        [one[0], one[1], other[0], other[1], x, y, z, u, v, w, self.gap, self.slides]
    }

    /// Pairs from their numbers, of strands with a number of points in a number of places of eight lanes.
    ///
    /// # Errors
    /// Pairs of other hair, or not in their order.
    pub fn restored(numbers: &[f32], places: usize, points: usize) -> Result<Vec<Self>, SimError> {
        let is_segment = |segment: u32| {
            let index = segment as usize / LANES;
            index < places && index % points + 1 < points
        };
        let pairs: Vec<Self> = numbers.chunks_exact(Self::NUMBERS).map(Self::from_numbers).collect();
        let in_order = pairs.windows(2).all(|two| two[0].segments < two[1].segments);
        match pairs.iter().find(|pair| !pair.segments.into_iter().all(is_segment)) {
            None if in_order => Ok(pairs),
            wrong => Err(SimError::Checkpoint {
                found: wrong.map_or_else(
                    || "pairs in another order".to_owned(),
                    |pair| format!("a pair of segments {:?}", pair.segments),
                ),
                expected: "pairs of segments of this hair, in rising order".to_owned(),
            }),
        }
    }

    fn from_numbers(numbers: &[f32]) -> Self {
        let whole = |at: usize| (numbers[at] as u32) << 16 | (numbers[at + 1] as u32 & 0xffff);
        Self {
            segments: [whole(0), whole(2)],
            normal: [numbers[4], numbers[5], numbers[6]],
            force: [numbers[7], numbers[8], numbers[9]],
            gap: numbers[10],
            slides: numbers[11],
        }
    }
}

/// A pair within a part of a step.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    pub segments: [u32; 2],
    /// Shares of both segments.
    pub shares: [f32; 2],
    pub normal: Vec3,
    /// Distance \[m\] of the axes where wisps touch, and along the normal where the part begins.
    pub touch: f32,
    pub gap: f32,
    /// Way \[m\] along the normal of the first against the second that the pair needs at least.
    pub needs: f32,
    /// Stiffness \[N/m\] with which rounds hold each of both places; 0 of what the head carries.
    pub holds: [f32; 2],
    /// Force over relative way with which a round changes the force \[N/m\].
    pub stiffness: f32,
    /// Force on the first segment \[N\].
    pub force: Vec3,
    /// Force that strands were given last, and its change since \[N\].
    pub given: Vec3,
    pub change: Vec3,
    /// Most force \[N\] that holds both together, and the distance \[m\] along the normal at which it does.
    pub pulls: f32,
    pub held_at: f32,
    /// True for a pair that slid in the part before, and for one that slides now.
    pub slid: bool,
    pub slides: bool,
}

/// Coefficients of friction: of what sticks and of what slides.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    pub sticks: f32,
    pub slides: f32,
}

impl Near {
    /// A round: the force answers the relative way \[m\] of both places, by the augmented Lagrangian of contact and
    /// Coulomb's law; what holds both together does not rub. Strands get the force with its change once more, as in alternating directions [Daviet2023].
    #[inline]
    pub fn answer(&mut self, way: Vec3, friction: Friction) {
        if !way.is_finite() {
            (self.change, self.given, self.force) = (-self.given, Vec3::ZERO, Vec3::ZERO);
            return;
        }
        let along = self.normal.dot(way);
        let old = self.normal.dot(self.force);
        let push = (old * (1.0 - YIELDS) + self.stiffness * (self.needs - along)).max(0.0);
        // Nothing yields where both are held together.
        let pull = (old + self.stiffness * (self.held_at - self.gap - along)).min(0.0).max(-self.pulls);
        let push = if push > 0.0 { push } else { pull };
        let aside = way - self.normal * along;
        let held = self.force - self.normal * old - aside * self.stiffness;
        let size = held.length();
        let limit = push.max(0.0) * if self.slid { friction.slides } else { friction.sticks };
        self.slides = size > limit;
        let rubs = if self.slides { held * (limit / size) } else { held };
        let force = self.normal * push + rubs;
        let given = force * 2.0 - self.force;
        self.change = given - self.given;
        (self.given, self.force) = (given, force);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_that_never_gets_its_room_presses_with_a_bounded_force() {
        let mut near = Near {
            segments: [0, 8],
            shares: [0.5; 2],
            normal: Vec3::Y,
            touch: 2e-3,
            gap: 1e-3,
            needs: 3e-4,
            holds: [0.1; 2],
            stiffness: 0.05,
            force: Vec3::ZERO,
            given: Vec3::ZERO,
            change: Vec3::ZERO,
            pulls: 0.0,
            held_at: 1e-3,
            slid: false,
            slides: false,
        };
        for _ in 0..5000 {
            near.answer(Vec3::ZERO, Friction { sticks: 0.3, slides: 0.25 });
        }
        let bound = near.stiffness * near.needs / YIELDS;
        assert!((near.force.y / bound - 1.0).abs() < 1e-3, "{} N, bound {bound}", near.force.y);
    }
}
