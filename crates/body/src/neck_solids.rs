//! The neck of the built-in bust as solids.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::Recent;

use crate::neck::{LEVELS, Neck, SLICES, SLOPE, level as level_of};
use crate::{Aabb, BodyError, Build, Caps, Carrier, DistanceGrid, Eyes, Mannequin, Shape};

/// Solids with their carriers.
type Parts = Vec<(Shape, Carrier)>;

/// Overlap \[m\] of neighbouring parts on either side.
const OVERLAP: f32 = 0.006;
/// Depth \[m\] by which the skin of a part recedes over its overlap: under a bend its ends stay under the skin.
const RECESS: f32 = 0.002;
/// Half the width \[m\] of the parts of the neck, and the air around them that their samples cover.
const HALF_WIDTH: f32 = 0.10;
const AIR: f32 = 0.008;
/// Depth \[m\] of the back and of the front of the neck, and of the back of the bust.
const BACK: f32 = -0.10;
const FRONT: f32 = 0.065;
const BACK_OF_BUST: f32 = -0.12;

impl Neck {
    /// The solid parts of samples of the bust, each with its carrier: head, shoulders, and the neck between. At rest their
    /// union is the bust, to the bit about the head.
    pub fn solids(&self, bust: &DistanceGrid) -> Vec<(DistanceGrid, Carrier)> {
        let steepness = Caps::steepness();
        let cap = OVERLAP * steepness;
        let whole = Caps {
            levels: [f32::NEG_INFINITY, f32::INFINITY],
            half_width: f32::INFINITY,
            depths: [f32::NEG_INFINITY, f32::INFINITY],
        };
        let [low, high] = LEVELS;
        let below = move |level: f32, point: Vec3| (level_of(point) - level) / steepness - OVERLAP;
        let above = move |level: f32, point: Vec3| (level - level_of(point)) / steepness - OVERLAP;
        let reach = OVERLAP * steepness + AIR;
        let all = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        let torso = Aabb { max: Vec3::INFINITY.with_y(low - SLOPE * BACK_OF_BUST + reach), ..all };
        let head = bust.within(all, |whole, point| capped(whole, above(high, point)));
        let shoulders = bust.within(torso, |whole, point| capped(whole, below(low, point)));
        let mut parts = vec![
            (head.with_caps(Caps { levels: [high - cap, f32::INFINITY], ..whole }), Carrier::HEAD),
            (
                shoulders.with_caps(Caps { levels: [f32::NEG_INFINITY, low + cap], ..whole }),
                Carrier::Piece(1),
            ),
        ];
        let height = (high - low) / SLICES as f32;
        for slice in 0..SLICES {
            let [from, to] = [slice, slice + 1].map(|slice| low + height * slice as f32);
            let bounds = Aabb {
                min: Vec3::new(-HALF_WIDTH - AIR, from - SLOPE * FRONT - reach, BACK - AIR),
                max: Vec3::new(HALF_WIDTH + AIR, to - SLOPE * BACK + reach, FRONT + AIR),
            };
            let cut = |point: Vec3| below(to, point).max(above(from, point)).max(point.x.abs() - HALF_WIDTH);
            let part = bust.within(bounds, |whole, point| capped(whole, cut(point)));
            let caps = Caps { levels: [from - cap, to + cap], half_width: HALF_WIDTH, depths: [BACK, FRONT] };
            parts.push((part.with_caps(caps), Carrier::Piece(slice as u16 + 2)));
        }
        parts
    }
}

impl Neck {
    /// The solid parts of [`Mannequin::grid`] at a spacing and with a padding \[m\]: see [`Neck::solids`]. The process keeps the
    /// last two.
    ///
    /// # Errors
    /// As [`Mannequin::grid`].
    pub fn solids_of(
        &self,
        mannequin: &Mannequin,
        spacing: f32,
        padding: f32,
    ) -> Result<Arc<Parts>, BodyError> {
        static PARTS: Recent<((Build, Eyes), [u32; 2]), Parts, 2> = Recent::new();
        PARTS.get((mannequin.person(), [spacing, padding].map(f32::to_bits)), || {
            let bust = mannequin.grid(spacing, padding)?;
            let parts = self.solids(bust.as_ref());
            Ok(parts.into_iter().map(|(part, carrier)| (Shape::Grid(Arc::new(part)), carrier)).collect())
        })
    }
}

/// Signed distance \[m\] of a part of the bust, given that of the whole and of the caps that cut it.
fn capped(whole: f32, cap: f32) -> f32 {
    whole.max(cap) + RECESS * (1.0 + cap / OVERLAP).clamp(0.0, 1.0)
}
