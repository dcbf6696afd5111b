//! Strands at rest: the motion in a part of a step that is none.

use wide::f32x8;

use super::rod_parts::Parts;
use super::rod_strands::Strands;
use crate::strands::rods::real::Real;
use crate::strands::rods::workspace::Workspace;

/// Most that a point of a strand at rest moves in a part of a step, over its square \[m/s^2\]: two thousandths of
/// gravity. Hair that friction holds creeps by half as much.
const STILL: f64 = 0.02;
/// Most of it \[m\] for what neither a solid nor other hair holds, over the square of the part \[m/s^2\], and over the
/// part \[m/s\]: air that slows a soft thread holds it up by as little.
const STILL_LOOSE: f64 = 1e-7;
const STILL_FREE: f64 = 2e-3;
const STILL_SPEED: f64 = 6e-6;
/// Most that its way differs from the one before, over the square of the part \[m/s^2\]: a strand at rest is not
/// one that turns back.
const STEADY: f64 = 2e-4;
/// Share of the deceleration by hairs that rub which holds a strand at rest that neither other hair nor a solid presses:
/// it hangs a thousandth of its length aside at most.
const HELD: f64 = 0.05;
/// Arm \[m\] at which the turn of a section counts as way, the radius of a hair: what only twists moves too.
const ARM: f64 = 4e-5;
/// Turn \[rad\] that is rounding.
const TURN_ROUNDING: f64 = 1e-6;
/// Rounding of an edge in single precision, over its length.
const ROUNDING: f64 = 1.2e-7;
/// Edges whose rounding makes the end of a stiff strand tremble.
const TREMBLING: f64 = 8.0;

impl Strands<'_> {
    /// Masks of the strands that a part of a step moves, and of those that hold what is no number. `pressed` is above 0
    /// for strands that a solid presses.
    pub(super) fn moving(&self, space: &Workspace, pressed: f32x8) -> (f32x8, f32x8) {
        let motion = Motion::new(self, space);
        let bad = motion.nothing.is_nan();
        let square = self.parts.time_step * self.parts.time_step;
        let thresholds = Thresholds::new(self.parts, self.crowding);
        // A strand that rested rests on as long as its motion may be the rounding of all of its edges; in a short part
        // that is the rounding of the tensions of two edges, in both parts of a Newton step.
        let rounded = motion.speed.simd_eq(f32x8::ZERO).bitselect(motion.whole, motion.longest);
        let rounding = rounded.fast_min(motion.pull * f32x8::of(4.0 * square)) * f32x8::of(ROUNDING);
        let still = pressed.choose(f32x8::of(thresholds.pressed), thresholds.loose);
        let steady = pressed.choose(f32x8::of(thresholds.pressed_steady), thresholds.steady);
        let turned = |way: f32x8| (way * f32x8::of(1.0 / ARM)).fast_max(f32x8::of(TURN_ROUNDING));
        let (most, most_change) = (turned(still), turned(steady));
        let turns = motion.turn.simd_gt(most * most) | motion.turn_change.simd_gt(most_change * most_change);
        let trembling =
            (motion.longest * f32x8::of(TREMBLING * ROUNDING)).fast_min(f32x8::of(STILL_FREE * square));
        let (still, steady) = (still.fast_max(rounding), steady.fast_max(rounding.fast_max(trembling)));
        let (largest, change) = (motion.largest, motion.change);
        let moving = largest.simd_gt(still * still) | change.simd_gt(steady * steady) | turns | bad;
        (moving, bad)
    }
}

/// Motion of strands in a part of a step.
struct Motion {
    /// Squares of the longest way \[m\], of its longest difference from that at the earlier velocity, and of the
    /// largest earlier speed \[m/s\].
    largest: f32x8,
    change: f32x8,
    speed: f32x8,
    /// Squares of the largest turn \[rad\], and of its largest difference from that at the earlier spin.
    turn: f32x8,
    turn_change: f32x8,
    /// Length of the longest segment and of all \[m\].
    longest: f32x8,
    whole: f32x8,
    /// Acceleration over strain of a segment at most \[m/s^2\].
    pull: f32x8,
    /// 0 for finite numbers, else not a number.
    nothing: f32x8,
}

impl Motion {
    fn new(strands: &Strands, space: &Workspace) -> Self {
        let step = f32x8::of(strands.parts.time_step);
        let [mut largest, mut change, mut speed, mut turn, mut turn_change] = [f32x8::ZERO; 5];
        let [mut longest, mut whole, mut pull, mut nothing] = [f32x8::ZERO; 4];
        for (point, node) in strands.nodes.iter().enumerate() {
            let [.., angle] = space.work.moved[point];
            let other = angle - space.spins[point] * step;
            turn = turn.fast_max(angle * angle);
            turn_change = turn_change.fast_max(other * other);
            let moved = space.way(point);
            let square = moved.dot(moved);
            let other = moved - space.velocities[point] * step;
            largest = largest.fast_max(square);
            change = change.fast_max(other.dot(other));
            let before = space.velocities[point].dot(space.velocities[point]);
            speed = speed.fast_max(before);
            longest = longest.fast_max(space.length[point]);
            whole += space.length[point];
            if point + 1 < strands.nodes.len() {
                pull = pull.fast_max(node.stretch * space.inverse_mass[point]);
            }
            nothing += (square + before + angle) * f32x8::ZERO;
        }
        Self { largest, change, speed, turn, turn_change, longest, whole, pull, nothing }
    }
}

/// Motion in a part of a step below which a strand rests.
struct Thresholds {
    /// Way \[m\] of a strand that a solid presses, and of one that nothing presses.
    pressed: f64,
    loose: f32x8,
    /// Difference \[m\] of the way from that at the earlier velocity, of a loose strand and of a pressed one.
    steady: f32x8,
    pressed_steady: f64,
}

impl Thresholds {
    fn new(parts: &Parts, crowding: f32x8) -> Self {
        let step = parts.time_step;
        let square = step * step;
        // Rubbing holds a strand that hardly falls.
        let rubbing = f64::from(parts.settings.rubbing);
        let held = (f32x8::of(HELD) + crowding * f32x8::of(1.0 - HELD)) * f32x8::of(rubbing * square);
        let slow = (STILL_FREE * step).max(STILL_SPEED) * step;
        Self {
            pressed: STILL * square,
            loose: f32x8::of(slow.min(STILL_LOOSE)).fast_max(held),
            steady: held.fast_max(f32x8::of(STEADY * square)),
            pressed_steady: STEADY.max(rubbing) * square,
        }
    }
}
