//! A straight line through a skin: which of the places along it the skin winds around.

use glam::{DVec2, DVec3, Vec3, Vec3A};

use crate::PosedSkin;
use crate::posed_skin::DEPTH;

/// Most places along a line.
pub const MOST_PLACES: usize = 64;
/// Share of the largest coordinate by which rounding may move a box.
const ROUNDING: f32 = 4e-6;

/// Places at equal steps along a line.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// The first place \[m\].
    pub first: Vec3,
    /// Way \[m\] from each place to the next.
    pub step: Vec3,
    /// Number of places, [`MOST_PLACES`] at most.
    pub count: usize,
}

/// The sides of places along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// A bit for each place, the first one lowest: 1 where the skin winds around it.
    pub inside: u64,
    /// Way \[m\] back from the first place to the skin; infinite where the line meets none.
    pub behind: f32,
}

/// A line, and the axes across it.
struct Line {
    origin: Vec3A,
    across: [Vec3A; 2],
    /// The same axes for corners of triangles.
    axes: [DVec3; 3],
    slack: f32,
}

impl PosedSkin {
    /// The sides of places \[m\] on a line at the end of the step, head space, by the triangles that the whole line crosses: one
    /// search for all of them. They are exact where the skin passes through itself, too. `None` where the line enters the skin
    /// more or less often than it leaves it: through a hole, as where shells overlap and buried triangles were left out.
    pub fn sides_along(&self, places: &Places) -> Option<Sides> {
        let length = places.step.length();
        let mut sides = Sides { inside: 0, behind: f32::INFINITY };
        if !(length > 0.0 && length.is_finite() && places.first.is_finite()) {
            return Some(sides);
        }
        let [min, max] = self.boxes[0].corners();
        let largest = min.abs().max(max.abs()).max(places.first.abs().into()).max_element();
        let line = Line::new(places.first, places.step / length, ROUNDING * largest);
        let count = places.count.min(MOST_PLACES);
        // Windings of the skin around each place beyond those around the place behind it.
        let mut turns = [0_i32; MOST_PLACES + 1];
        let mut whole = 0;
        self.cross(&line, |height, turn| {
            whole += turn;
            if height <= 0.0 {
                sides.behind = sides.behind.min(-height as f32);
                return;
            }
            let passed = (height / f64::from(length)).ceil().min(count as f64) as usize;
            turns[passed] += turn;
        });
        if whole != 0 {
            return None;
        }
        let mut around = 0;
        for place in (0..count).rev() {
            around += turns[place + 1];
            sides.inside |= u64::from(around as f32 * self.facing > 0.0) << place;
        }
        Some(sides)
    }

    /// Calls for each triangle that a line crosses, with the way \[m\] along the line, and 1 where the line leaves through its
    /// front, -1 where it enters.
    fn cross(&self, line: &Line, mut crossed: impl FnMut(f64, i32)) {
        self.solid.tally.lines.add(1);
        let (mut waiting, mut count) = ([0_u32; DEPTH], 1);
        while count > 0 {
            count -= 1;
            let index = waiting[count];
            let node = self.boxes[index as usize];
            if !line.meets(node.corners()) {
                continue;
            }
            if node.right() == 0 {
                for triangle in node.triangles() {
                    let offsets = self.corners(&self.end, triangle).map(|corner| line.offset(corner));
                    // Most triangles lie to one side.
                    if line.are_aside(&offsets) {
                        continue;
                    }
                    if let Some((height, turn)) = crossing(offsets.map(|offset| line.flat(offset))) {
                        crossed(height, turn);
                    }
                }
                continue;
            }
            waiting[count] = node.right();
            waiting[count + 1] = index + 1;
            count += 2;
        }
    }
}

impl Line {
    fn new(origin: Vec3, along: Vec3, slack: f32) -> Self {
        let along_wide = along.as_dvec3().normalize();
        let one = along_wide.any_orthonormal_vector();
        let axes = [one, along_wide.cross(one), along_wide];
        let across = [axes[0], axes[1]].map(|axis| Vec3A::from(axis.as_vec3()));
        Self { origin: origin.into(), across, axes, slack }
    }

    /// False only for a box that the line passes by.
    fn meets(&self, [min, max]: [Vec3A; 2]) -> bool {
        let (offset, half) = (0.5 * (min + max) - self.origin, 0.5 * (max - min));
        self.across.iter().all(|axis| axis.dot(offset).abs() <= axis.abs().dot(half) + self.slack)
    }

    /// A corner from the origin \[m\].
    fn offset(&self, corner: Vec3) -> DVec3 {
        corner.as_dvec3() - Vec3::from(self.origin).as_dvec3()
    }

    /// True for corners that all lie on one side of a plane through the line: it crosses no triangle of them.
    fn are_aside(&self, offsets: &[DVec3; 3]) -> bool {
        let [one, two, three] = offsets.map(|offset| self.axes[1].dot(offset) > 0.0);
        one == two && two == three
    }

    /// A corner by its offset \[m\], across the line and along it.
    fn flat(&self, offset: DVec3) -> (DVec2, f64) {
        let [one, other, along] = self.axes.map(|axis| axis.dot(offset));
        (DVec2::new(one, other), along)
    }
}

/// The height at which an axis crosses a triangle, and 1 where it leaves through the front, -1 where it enters; `None` where
/// it passes. Corners are given across the axis, in axes that turn to the left about it, and along it. Through an edge it
/// crosses one of the two triangles there.
pub(crate) fn crossing(flat: [(DVec2, f64); 3]) -> Option<(f64, i32)> {
    let mut turns = 0;
    for side in 0..3 {
        let (start, end) = (flat[side].0, flat[(side + 1) % 3].0);
        let rises = end.y > 0.0;
        if (start.y > 0.0) == rises {
            continue;
        }
        // The same numbers in the same order from either triangle at an edge.
        let (low, high) = if rises { (start, end) } else { (end, start) };
        let is_right = low.perp_dot(high) > 0.0;
        turns += i32::from(is_right) * if rises { 1 } else { -1 };
    }
    if turns == 0 {
        return None;
    }
    // Height of the plane by the areas that the axis cuts off.
    let areas = [0, 1, 2].map(|side| flat[(side + 1) % 3].0.perp_dot(flat[(side + 2) % 3].0));
    let height = flat.iter().zip(areas).map(|((_, height), area)| height * area).sum::<f64>();
    Some((height / areas.iter().sum::<f64>(), turns))
}
