//! Air about rods: its force as a spring of the Newton step that pulls each point along with the flow.

use glam::Vec3;
use strandline_base::vec3x8::splat;
use strandline_groom::LANES;
use wide::f32x8;

use crate::Model;
use crate::strands::rods::air::Wisp;
use crate::strands::rods::hairs::Traits;
use crate::strands::rods::real::{Real, Vector};
use crate::strands::rods::workspace::Workspace;

/// Air in a part of a step.
pub(super) struct Air {
    time_step: f32x8,
    /// \[m/s\]
    pub(super) wind: Vector<f32x8>,
    /// Factor of the force, over the length of the part \[1/s\].
    rate: f32x8,
    /// Hairs that a guide stands for; `None` takes those that resist together.
    hairs: Option<f32>,
}

impl Air {
    pub(super) fn new(model: &Model, time_step: f32, wind: Vec3) -> Self {
        let drag = &model.settings.drag;
        Self {
            time_step: splat(time_step),
            wind: Vector::splat(wind),
            rate: splat(drag.factor / time_step),
            hairs: drag.hairs,
        }
    }

    /// True where rods feel the force of physics.
    pub(super) fn blows(&self) -> bool {
        self.rate.to_array()[0] > 0.0
    }

    /// Air about a block of strands.
    pub(super) fn of(&self, strands: &[Traits]) -> Around {
        let hairs = of_lanes(strands, |strand| self.hairs.unwrap_or(strand.hairs));
        let start = of_lanes(strands, |strand| strand.taper_start);
        Around {
            wisp: Wisp::new(
                of_lanes(strands, |strand| strand.diameter),
                hairs,
                of_lanes(strands, |strand| strand.hairs),
                of_lanes(strands, |strand| strand.packing),
            ),
            thinner: of_lanes(strands, |strand| strand.tip) - splat(1.0),
            start,
            per_taper: splat(1.0) / (splat(1.0) - start).or_more(splat(1e-6)),
            time_step: self.time_step,
            rate: self.rate,
        }
    }
}

/// Air about eight strands.
pub(super) struct Around {
    wisp: Wisp<f32x8>,
    /// Change of the diameter from root to tip over that at the root, where it begins, and 1 over the share of the length
    /// that it takes.
    thinner: f32x8,
    start: f32x8,
    per_taper: f32x8,
    time_step: f32x8,
    rate: f32x8,
}

impl Around {
    /// Sets the force of the air on a point, by its speed at the beginning of the part: implicit by the force across the
    /// strand, less what the air along it leaves of that. `back` leads from where the head carries the point to where it
    /// is \[m\], `wind` is the velocity of the air there \[m/s\].
    #[inline(always)]
    pub(super) fn blow(&self, space: &mut Workspace, point: usize, back: Vector<f32x8>, wind: Vector<f32x8>) {
        let last = space.points.len() - 1;
        let (above, below) = (last.min(point + 1), point.saturating_sub(1));
        let tangent = space.points[above] - space.points[below];
        let relative = wind - space.velocities[point];
        let along = tangent * (tangent.dot(relative) / (tangent.dot(tangent) + splat(1e-30)));
        let [across, slide] = self.wisp_at(space.share[point]).drag((relative - along).length());
        let goal = (wind - along * (splat(1.0) - slide / across)) * self.time_step + back;
        let before = if point > 0 { space.length[below] } else { f32x8::ZERO };
        let after = if point < last { space.length[point] } else { f32x8::ZERO };
        let length = (before + after) * splat(0.5);
        space.work.blow(point, goal, across * length * self.rate);
    }

    /// The wisp at a share of the length.
    #[inline(always)]
    pub(super) fn wisp_at(&self, share: f32x8) -> Wisp<f32x8> {
        let tapered = ((share - self.start) * self.per_taper).or_more(f32x8::ZERO).or_less(splat(1.0));
        self.wisp.thinned(splat(1.0) + self.thinner * tapered)
    }
}

/// Shares of the length before each point, from the lengths behind each \[m\].
pub(super) fn shares(lengths: &[f32x8], shares: &mut [f32x8]) {
    let mut passed = f32x8::ZERO;
    for (share, length) in shares.iter_mut().zip(lengths) {
        *share = passed;
        passed += *length;
    }
    // Nothing lies behind the last point.
    let whole = shares.last().map_or(passed, |whole| whole.or_more(splat(1e-9)));
    shares.iter_mut().for_each(|share| *share /= whole);
}

/// A number of each of a block's strands.
pub(super) fn of_lanes(strands: &[Traits], number: impl Fn(&Traits) -> f32) -> f32x8 {
    f32x8::from(std::array::from_fn::<f32, LANES, _>(|lane| number(&strands[lane])))
}
