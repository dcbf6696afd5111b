//! Strands drawn together about their guides, as water draws hair into locks.

use glam::Vec3;
use strandline_base::par::prelude::*;

use super::Binding;
use super::influence::{Influence, MOST_INFLUENCES, blocks};
use crate::{Guides, LANES};

/// Share of the length of which strands take three quarters to come half of their way together: they meet near the skin.
const NEAR_SKIN: f32 = 0.15;

/// Share of the way together that strands have gone at a share of their length: 0 at the root, 1 at the tip.
pub fn closing(share: f32) -> f32 {
    share * (1.0 + NEAR_SKIN) / (share + NEAR_SKIN)
}

impl Binding {
    /// The same strands, each drawn toward the guide that it follows most, by a share of its distance at the tip, 0 to 1.
    /// It follows the other guides by as much less.
    #[must_use]
    pub fn together(mut self, share: f32) -> Self {
        if share == 0.0 {
            return self;
        }
        let (count, guides) = (self.strands.points_per_strand(), &self.guides);
        let influences = &self.influences;
        let places = self.strands.positions_mut().par_chunks_mut(count).enumerate();
        places.for_each(|(block, places)| {
            for lane in 0..LANES {
                let strand = (block * LANES + lane).min(influences.len() - 1);
                let most = most(&influences[strand]);
                for (point, place) in places.iter_mut().enumerate().skip(1) {
                    let way = share * closing(point as f32 / (count - 1) as f32);
                    let toward = along(guides, most.guide as usize, point as f32 * most.pace);
                    place.set(lane, place.get(lane).lerp(toward, way));
                }
            }
        });
        for influences in &mut self.influences {
            let guide = most(influences).guide;
            for one in influences {
                let whole = if one.guide == guide && one.weight > 0.0 { 1.0 } else { 0.0 };
                one.weight += share * (whole - one.weight);
            }
        }
        self.blocks = blocks(&self.influences);
        self
    }
}

/// The guide that a strand follows most, the first of two alike.
fn most(influences: &[Influence; MOST_INFLUENCES]) -> Influence {
    influences[1..].iter().fold(influences[0], |most, one| if one.weight > most.weight { *one } else { most })
}

/// Place of a guide at rest \[m\] at a number of points from its root, its tip beyond it.
fn along(guides: &Guides, guide: usize, points: f32) -> Vec3 {
    let last = guides.points_per_strand() - 1;
    let segment = (points as usize).min(last - 1);
    let share = (points - segment as f32).clamp(0.0, 1.0);
    guides.position(guide, segment).lerp(guides.position(guide, segment + 1), share)
}
