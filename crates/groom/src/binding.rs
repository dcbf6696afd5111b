//! Bound strands: those of a groom that are not simulated, moved by the guides that they are bound to.
//!
//! Each point of a guide carries a frame: where it is, and how it is turned against rest. A point of a bound
//! strand keeps its place in the frames of the guides about it, at the same length along them, and lies where
//! their weighted mean has it: linear blend skinning [Magnenat1988]. Then segments get their rest lengths back
//! from root to tip. At rest all frames are the head's, so that a groom at rest is exactly the groom.

use glam::{Quat, Vec3};
use strandline_base::SettingError;
use strandline_base::par::prelude::*;
use strandline_body::BodyFrame;

use crate::{
    Groom, GroomError, Guides, LANES, Vec3Lanes,
    choice::{self, Feature, Roots},
};

/// A body that strands stay out of, world space.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    /// The signed distance \[m\] at a point \[m\], negative inside, and its unit gradient.
    pub at: &'a (dyn Fn(Vec3) -> (f32, Vec3) + Sync),
    /// Lower bound of the distance \[m\], 0 if it is not known without the exact one.
    pub at_least: &'a (dyn Fn(Vec3) -> f32 + Sync),
}

impl<'a> Surface<'a> {
    /// A body known by its distance alone.
    pub fn of(at: &'a (dyn Fn(Vec3) -> (f32, Vec3) + Sync)) -> Self {
        Self { at, at_least: &|_| 0.0 }
    }
}

impl std::fmt::Debug for Surface<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("Surface")
    }
}

mod frames;
mod influence;
mod place;
#[cfg(test)]
mod tests;
mod together;
mod weights;

pub use frames::Frames;
pub use influence::{Influence, MOST_INFLUENCES};
pub use together::closing;

use frames::PointFrame;
use influence::{Followed, blocks};

/// Lengths within this share of those at rest are those at rest.
const UNSCALED: f32 = 0.01;

/// The strands of a groom and the guides among them: which guides each strand follows, and where it is at rest.
#[derive(Clone, Debug)]
pub struct Binding {
    /// All strands at rest, resampled.
    strands: Guides,
    /// Guides at rest, of the same number of points.
    guides: Guides,
    /// Shape `[strand][MOST_INFLUENCES]`; a weight of 0 is an unused entry.
    influences: Vec<[Influence; MOST_INFLUENCES]>,
    /// The same, one lane per strand, shape `[block][MOST_INFLUENCES]`.
    blocks: Vec<[Followed; MOST_INFLUENCES]>,
}

impl Binding {
    /// Binds the strands of a groom to some of them, its guides by their indices in rising order.
    ///
    /// A strand that is a guide follows itself alone. Others follow the guides that the groom names, where it
    /// names some, and else the three that are nearest to them in place and shape, those of the same group first.
    /// `strands` and `guides` are the groom and its guides, resampled to the same number of points.
    ///
    /// # Errors
    /// No guide; numbers of strands or points that do not fit each other.
    pub fn new(
        groom: &Groom,
        strands_of_guides: &[usize],
        strands: Guides,
        guides: Guides,
    ) -> Result<Self, GroomError> {
        let sound = strands.strand_count() == groom.strand_count()
            && guides.strand_count() == strands_of_guides.len()
            && guides.points_per_strand() == strands.points_per_strand()
            && strands_of_guides.iter().all(|strand| *strand < groom.strand_count());
        if !sound || strands_of_guides.is_empty() {
            let found = format!("{} guides for {} strands", strands_of_guides.len(), groom.strand_count());
            return Err(
                SettingError::new("groom.guides", found, "guides that are strands of the groom").into()
            );
        }
        let lengths = groom.lengths();
        let features = choice::features(groom);
        let of_guides: Vec<Feature> = strands_of_guides.iter().map(|strand| features[*strand]).collect();
        let roots = Roots::new(&of_guides);
        let follow = |strand: usize| {
            if let Ok(guide) = strands_of_guides.binary_search(&strand) {
                return vec![(guide, 1.0)];
            }
            let named = weights::named(groom, strands_of_guides, strand);
            if named.is_empty() { weights::nearest(&features[strand], &of_guides, &roots) } else { named }
        };
        let influences = (0..groom.strand_count()).into_par_iter().map(|strand| {
            let mut influences = [Influence::default(); MOST_INFLUENCES];
            for (slot, (guide, weight)) in influences.iter_mut().zip(follow(strand)) {
                let pace = lengths[strand] / lengths[strands_of_guides[guide]].max(f32::MIN_POSITIVE);
                *slot = Influence { guide: guide as u32, weight, pace };
            }
            // An unused influence repeats a guide that is followed anyway: 0 times NaN would be NaN.
            let first = influences[0];
            for none in influences.iter_mut().filter(|influence| influence.weight == 0.0) {
                *none = Influence { weight: 0.0, ..first };
            }
            influences
        });
        let influences: Vec<_> = influences.collect();
        let blocks = blocks(&influences);
        Ok(Self { strands, guides, influences, blocks })
    }

    /// All strands at rest.
    pub fn strands(&self) -> &Guides {
        &self.strands
    }

    /// The guides at rest.
    pub fn guides(&self) -> &Guides {
        &self.guides
    }

    /// The guides that each strand follows, shape `[strand][MOST_INFLUENCES]`; a weight of 0 is an unused entry.
    pub fn influences(&self) -> &[[Influence; MOST_INFLUENCES]] {
        &self.influences
    }

    /// Notes where the guides are \[m\], world space, shape `[block][point]` of lanes: a frame of each of their
    /// points, and how long they are.
    ///
    /// The first frame turns with the root frame of its guide, and as little more as takes the first segment where it
    /// is; each further one turns as little as possible against the one before.
    pub fn follow(&self, positions: &[Vec3Lanes], body: &BodyFrame, frames: &mut Frames) {
        let count = self.guides.points_per_strand();
        frames.points.resize(self.guides.strand_count() * count, PointFrame::default());
        frames.scales.resize(self.guides.strand_count(), 1.0);
        let guides = frames.points.par_chunks_mut(count).zip_eq(&mut frames.scales).enumerate();
        guides.for_each(|(guide, (frames, scale))| {
            let now = |point: usize| positions[guide / LANES * count + point].get(guide % LANES);
            let rest = |point: usize| self.guides.position(guide, point);
            let mut rotation = body.root(guide).rotation;
            let (mut length, mut own) = (0.0, 0.0);
            for (point, frame) in frames.iter_mut().enumerate() {
                // The last point has no segment of its own.
                let start = point.min(count - 2);
                let segments = [rest(start + 1) - rest(start), now(start + 1) - now(start)];
                if point == start {
                    (length, own) = (length + segments[1].length(), own + segments[0].length());
                }
                let from = (rotation * segments[0]).normalize_or_zero();
                let to = segments[1].normalize_or_zero();
                if from != to && from != Vec3::ZERO && to != Vec3::ZERO {
                    rotation = (Quat::from_rotation_arc(from, to) * rotation).normalize();
                }
                *frame = PointFrame::new(rotation, rest(point), now(point));
            }
            let found = length / own.max(f32::MIN_POSITIVE);
            // Stretch left by the solver is not a change of length.
            *scale = if (found - 1.0).abs() < UNSCALED { 1.0 } else { found };
        });
    }
}
