//! Brushes: tools of a hairdresser that change hair at rest under a circle on the skin.
//!
//! A [`Stroke`] is plain data, so that a list of them can be kept in a file, undone and repeated. Roots never move.

mod cut;
mod shape;

use glam::Vec3;
use strandline_base::{choices, settings};

use crate::Groom;

choices! {
    /// A tool of a hairdresser.
    pub enum Tool as "tool" {
        /// Hair is drawn along `motion`, the tip farthest; its length stays.
        Comb = "comb",
        /// Hair keeps `length` from its root on.
        Cut = "cut",
        /// Hair grows by `length` in its own shape.
        Lengthen = "lengthen",
        /// Hair leans toward the strand in the middle, the tip most; its length stays.
        Clump = "clump",
        /// Hair winds about its own line, in turns of `pitch` and of the radius `curl`; its length stays.
        Curl = "curl",
    }
    default Comb
}

settings! {
    /// A stroke of a brush over hair at rest.
    pub struct Stroke: Copy {
        /// The tool.
        tool: Tool = Tool::default();
        /// Middle of the brush, near the skin, head space.
        position: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Distance from the middle within which strands have their roots.
        radius: f32 = 0.03, in [1e-4, 100.0] "m", slider [0.005, 0.15], more "a stroke over more strands";
        /// Share of the whole effect; toward the rim of the brush it falls to 0, but for `cut`.
        strength: f32 = 1.0, in [0.0, 1.0], slider [0.0, 1.0], more "a firmer hand";
        /// Way of the tips under `comb`, head space.
        motion: Vec3 = Vec3::ZERO, in [-10.0, 10.0] "m";
        /// Length that `cut` leaves, or that `lengthen` adds.
        length: f32 = 0.05, in [1e-3, 10.0] "m", slider [0.005, 0.3], more "longer hair";
        /// Radius of the turns of `curl`.
        curl: f32 = 0.006, in [0.0, 0.5] "m", slider [0.0, 0.03], more "wider curls";
        /// Length of hair in a turn of `curl`; a turn has six points of a strand at least.
        pitch: f32 = 0.04, in [1e-3, 10.0] "m", slider [0.01, 0.15], more "longer turns";
        /// Repeats the stroke on the other side of the head (x to -x).
        symmetric: bool = false;
    }
}

impl Stroke {
    /// The groom after this stroke. Strands of which no root lies under the brush keep their bits, and all roots do.
    ///
    /// A symmetric stroke reaches strands with their roots on its own side of x = 0, and its mirror those on the other, so
    /// that hair that is its own mirror stays so to the bit.
    pub fn on(&self, groom: &Groom) -> Groom {
        let sides: &[f32] = if self.symmetric { &[1.0, -1.0] } else { &[1.0] };
        let mut after = groom.clone();
        for side in sides {
            self.one_side(&mut after, groom, *side);
        }
        after
    }

    /// Applies the stroke to strands on one side of the head: `side` -1 for its mirror.
    fn one_side(&self, after: &mut Groom, before: &Groom, side: f32) {
        let own_side = if self.position.x < 0.0 { -side } else { side };
        let is_reached = |strand: &usize| {
            let root = before.strand(*strand).first();
            root.is_some_and(|root| {
                (!self.symmetric || root.x * own_side > 0.0 || (root.x == 0.0 && side > 0.0))
                    && self.falloff(mirrored(*root, side)) > 0.0
            })
        };
        let reached: Vec<usize> = (0..before.strand_count()).filter(is_reached).collect();
        if self.tool == Tool::Cut {
            return cut::cut(after, &reached, self.strength, self.length);
        }
        let middle = (self.tool == Tool::Clump).then(|| self.middle(before, &reached, side)).flatten();
        for strand in reached {
            let points: Vec<Vec3> =
                before.strand(strand).iter().map(|point| mirrored(*point, side)).collect();
            let share = self.strength * self.falloff(points[0]);
            let shaped = match self.tool {
                Tool::Comb => shape::comb(&points, share * self.motion),
                Tool::Lengthen => shape::lengthen(&points, share * self.length),
                Tool::Clump => shape::clump(&points, middle.as_deref().unwrap_or(&points), share),
                Tool::Curl => shape::curl(&points, share * self.curl, self.pitch),
                Tool::Cut => continue,
            };
            let range = after.range(strand);
            for (point, shaped) in after.points[range].iter_mut().zip(shaped).skip(1) {
                *point = mirrored(shaped, side);
            }
        }
    }

    /// Points of the strand with its root nearest to the middle of the brush.
    fn middle(&self, groom: &Groom, reached: &[usize], side: f32) -> Option<Vec<Vec3>> {
        let apart = |strand: &usize| mirrored(groom.strand(*strand)[0], side).distance_squared(self.position);
        let nearest = reached.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        Some(groom.strand(*nearest).iter().map(|point| mirrored(*point, side)).collect())
    }

    /// Share of the effect at a root: 1 in the middle, 0 from the rim on, smooth at both.
    fn falloff(&self, root: Vec3) -> f32 {
        let share = root.distance_squared(self.position) / (self.radius * self.radius);
        let inside = (1.0 - share).max(0.0);
        inside * inside
    }
}

/// A place on the other side of the head where `side` is -1.
fn mirrored(place: Vec3, side: f32) -> Vec3 {
    Vec3::new(side * place.x, place.y, place.z)
}

#[cfg(test)]
mod tests;
