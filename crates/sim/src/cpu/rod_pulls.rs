//! Forces on rods: solids near them and the hand, as stiff springs of the Newton step.

use glam::Vec3;
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use super::rod_strands::Strands;
use crate::contact::contacts::{Care, Query};
use crate::contact::planes::Plane;
use crate::grab::Pinned;
use crate::strands::rods::pull::Pull;
use crate::strands::rods::real::{Real, Vector};
use crate::strands::rods::workspace::Workspace;

/// Stiffness of a contact or a pin over the mass of its point and the square of the step: what rests on a
/// solid sinks in by a thousandth of its fall in a step.
const STIFF: f64 = 1e3;

/// A point that is no higher \[m\] above a solid touches it: as near as two looks at one place of a skull may find it.
pub(crate) const TOUCHES: f64 = 2e-4;

/// A point that is no deeper \[m\] inside a solid lies on it: more than its position is rounded by.
const AT: f64 = 1e-7;

impl Strands<'_> {
    /// Planes near the points and what a hand holds, as stiff springs.
    pub(super) fn find_pulls(
        &self,
        space: &mut Workspace,
        planes: &mut [Plane],
        pinned: &[Pinned],
        part: u32,
    ) {
        space.pulls.clear();
        let stiff = f32x8::of(STIFF / (self.parts.time_step * self.parts.time_step));
        let end_on = self.nodes[self.nodes.len() - 1].stretch;
        let most = f32x8::splat(self.model.settings.collision_margin);
        for point in 0..self.nodes.len() {
            let node = &self.nodes[point];
            let margin = most.fast_min(f32x8::new(self.clearance[point].0)).fast_max(f32x8::ZERO);
            space.margins[point] = margin;
            let free = node.free.simd_gt(f32x8::ZERO);
            if free.any() && !self.parts.solids.is_empty() {
                // The position at constant velocity: a free fall alone leads millimetres deeper, where a
                // crease of the skin has another plane, which would throw hair at rest.
                let position = space.carried[point] + space.coast[point];
                let start = Some(space.points[point]);
                let query = Query { position, start, margin, free, care: Care::ROUGH, part };
                if let Some(touch) = self.parts.solids.touch(planes, point, query) {
                    let height = touch.height(space.carried[point]);
                    let near = height.simd_lt(f32x8::splat(1.0));
                    // A touching point rests in place.
                    let touches = height.simd_lt(f32x8::of(TOUCHES)) & space.loaded.simd_le(f32x8::ZERO);
                    let held = Vector::choose(space.loaded & near, space.loads[point], Vector::zero());
                    let height = touches.bitselect((height + f32x8::of(AT)).fast_min(f32x8::ZERO), height);
                    let stiffness = (node.mass * stiff).or_more(end_on);
                    space.pulls.push(Pull {
                        node: point,
                        normal: touch.normal,
                        reach: near.bitselect(-height, f32x8::splat(-1.0)),
                        stiffness: stiffness & near,
                        one_sided: true,
                        friction: touch.friction,
                        // Zero where the root frame carries the point as the solid moves.
                        stuck: touch.stuck - space.carried[point],
                        load: held * (f32x8::of(1.0) / stiffness),
                    });
                }
            }
            self.pull_pins(space, pinned, point, node.mass * stiff, part);
        }
    }

    fn pull_pins(&self, space: &mut Workspace, pinned: &[Pinned], point: usize, stiffness: f32x8, part: u32) {
        let mut goals = Vec3Lanes::default();
        let mut held = [0.0; LANES];
        for pin in pinned.iter().filter(|pin| pin.point == point) {
            let mut here = Vec3Lanes::default();
            space.points[point].store(&mut here);
            let share = 1.0 / (self.parts.count - part) as f32;
            goals.set(pin.lane, here.get(pin.lane).lerp(pin.goal, share));
            held[pin.lane] = 1.0;
        }
        if held.iter().all(|held| *held == 0.0) {
            return;
        }
        let stiffness = stiffness * f32x8::from(held);
        let missing = (Vector::load(&goals) - space.carried[point]).array();
        for (axis, reach) in missing.into_iter().enumerate() {
            let normal = Vector::splat([Vec3::X, Vec3::Y, Vec3::Z][axis]);
            let (friction, stuck, load) = (f32x8::ZERO, Vector::zero(), Vector::zero());
            space.pulls.push(Pull {
                node: point,
                normal,
                reach,
                stiffness,
                one_sided: false,
                friction,
                stuck,
                load,
            });
        }
    }
}
