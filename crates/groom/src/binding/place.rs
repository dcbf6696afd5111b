//! Positions of bound strands: eight at a time, one lane per strand.

use glam::{Vec3, Vec4};
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::{Rigid, Vec3x8};
use strandline_body::{BodyFrame, Solids};
use wide::f32x8;

use super::frames::{Frames, PointFrame};
use super::influence::{Followed, MOST_INFLUENCES};
use super::{Binding, Surface};
use crate::{LANES, LaneSet, Vec3Lanes, block_count, outside::placed_outside};

impl Binding {
    /// Fills `out` with the points of the strands of a set \[m\], world space, shape `[block][point]` of lanes, given those
    /// of all guides in the same shape: [`Binding::follow`], then [`Binding::place`] out of solids. `frames` is used
    /// again from call to call.
    pub fn carry(
        &self,
        set: LaneSet,
        guides: &[Vec3Lanes],
        body: &BodyFrame,
        solids: &Solids,
        frames: &mut Frames,
        out: &mut Vec<Vec3Lanes>,
    ) {
        let placed = solids.placed(body);
        let at = |point: Vec3| placed.at(point);
        let at_least = |point: Vec3| placed.at_least(point);
        let surface = Surface { at: &at, at_least: &at_least };
        let surface = (!placed.is_empty()).then_some(&surface);
        self.follow(guides, body, frames);
        self.place(set, frames, body, surface, out);
    }

    /// Positions of the strands of a set \[m\], world space, shape `[block][point]` of lanes, from the frames of the
    /// guides ([`Binding::follow`]). Roots move with the head, or with the guides of their strands where these have
    /// root frames of their own. Segments have their rest lengths, scaled as those of the guides are. Points inside the
    /// body are put onto its surface.
    pub fn place(
        &self,
        set: LaneSet,
        frames: &Frames,
        body: &BodyFrame,
        surface: Option<&Surface>,
        out: &mut Vec<Vec3Lanes>,
    ) {
        let count = self.strands.points_per_strand();
        let turn = Rigid::new(&body.world_from_head());
        let rides = body.roots().is_none();
        let strand_count = set.count_of(self.strands.strand_count());
        out.resize(block_count(strand_count) * count, Vec3Lanes::default());
        if set.is_all() {
            let blocks = out.par_chunks_mut(count).zip_eq(self.strands.positions().par_chunks(count));
            blocks.zip_eq(&self.blocks).for_each(|((places, rest), followed)| {
                place_block(rest, followed, frames, (&turn, rides), surface, places);
            });
            return;
        }
        out.par_chunks_mut(count).enumerate().for_each_init(Vec::new, |rest, (block, places)| {
            let strands =
                std::array::from_fn(|lane| set.strand((block * LANES + lane).min(strand_count - 1)));
            let followed = self.gathered(&strands, rest);
            place_block(rest, &followed, frames, (&turn, rides), surface, places);
        });
    }

    /// A block of any strands: the guides that they follow, and their points at rest \[m\], shape `[point]`.
    fn gathered(&self, strands: &[usize; LANES], rest: &mut Vec<Vec3Lanes>) -> [Followed; MOST_INFLUENCES] {
        let count = self.strands.points_per_strand();
        rest.resize(count, Vec3Lanes::default());
        for (lane, strand) in strands.iter().enumerate() {
            let of_strand = &self.strands.positions()[strand / LANES * count..][..count];
            rest.iter_mut()
                .zip(of_strand)
                .for_each(|(rest, point)| rest.set(lane, point.get(strand % LANES)));
        }
        std::array::from_fn(|slot| Followed::of(strands.map(|strand| self.influences[strand][slot])))
    }
}

/// Places the strands of a block, at rest at `rest` \[m\]; `rides` tells whether their roots ride the head.
fn place_block(
    rest: &[Vec3Lanes],
    followed: &[Followed; MOST_INFLUENCES],
    frames: &Frames,
    (turn, rides): (&Rigid, bool),
    surface: Option<&Surface>,
    places: &mut [Vec3Lanes],
) {
    let count = rest.len();
    let scale = scales(followed, frames);
    let mut here = Vec3x8::load(&rest[0]);
    let mut before =
        if rides { turn.points(here) } else { blend(followed, &frames.points, 0, count, &rest[0]) };
    // Place of the point before by the frames: segments lead from one such place to the next.
    let mut blended_before = before;
    // Lower bound of the distance \[m\] to the surface.
    let mut clear = f32x8::ZERO;
    before.store(&mut places[0]);
    for point in 1..count {
        let next = Vec3x8::load(&rest[point]);
        let blended = blend(followed, &frames.points, point, count, &rest[point]);
        let (segment, step) = (next - here, blended - blended_before);
        let (own, stretched) = (segment.dot(segment), step.dot(step));
        let moves = stretched.simd_gt(f32x8::ZERO);
        let mut factor = scale * (own / stretched).sqrt();
        let mut way = step;
        if !moves.all() {
            way = step.or(moves, turn.directions(segment));
            factor = moves.select(factor, scale);
        }
        let mut placed = before + way * factor;
        if let Some(surface) = surface {
            let length = scale * own.sqrt();
            clear -= length;
            let close = clear.simd_le(f32x8::ZERO).to_bitmask();
            if close != 0 {
                (placed, clear) = outside(close, before, placed, length, clear, surface);
            }
        }
        placed.store(&mut places[point]);
        (here, before, blended_before) = (next, placed, blended);
    }
}

/// Lengths of the guides that strands follow, over their lengths at rest.
fn scales(followed: &[Followed; MOST_INFLUENCES], frames: &Frames) -> f32x8 {
    followed.iter().fold(f32x8::ZERO, |sum, one| {
        let of_guides = one.guides.map(|guide| frames.scales[guide as usize]);
        sum + f32x8::from(one.weights) * f32x8::from(of_guides)
    })
}

/// Place by the guides of a point that is at `rest` at rest \[m\].
fn blend(
    followed: &[Followed; MOST_INFLUENCES],
    frames: &[PointFrame],
    point: usize,
    count: usize,
    rest: &Vec3Lanes,
) -> Vec3x8 {
    let last = (count - 1) as f32;
    let along = followed.each_ref().map(|one| {
        (f32x8::from(one.paces) * point as f32).fast_min(f32x8::splat(last)).fast_trunc_int().to_array()
    });
    let mut found = Vec3Lanes::default();
    for lane in 0..LANES {
        let (x, y, z) = (rest.x[lane], rest.y[lane], rest.z[lane]);
        let mut sum = Vec4::ZERO;
        for (one, along) in followed.iter().zip(&along) {
            let frame = &frames[one.guides[lane] as usize * count + along[lane] as usize];
            let [first, second, third, translation] = frame.columns;
            sum += (first * x + second * y + third * z + translation) * one.weights[lane];
        }
        found.set(lane, sum.truncate());
    }
    Vec3x8::load(&found)
}

/// Puts those strands' points that may lie inside onto the surface: `close` has a bit for each.
fn outside(
    close: u32,
    before: Vec3x8,
    placed: Vec3x8,
    length: f32x8,
    clear: f32x8,
    surface: &Surface,
) -> (Vec3x8, f32x8) {
    let (mut from, mut to) = (Vec3Lanes::default(), Vec3Lanes::default());
    before.store(&mut from);
    placed.store(&mut to);
    let (length, mut clear) = (length.to_array(), clear.to_array());
    for lane in (0..LANES).filter(|lane| close >> lane & 1 == 1) {
        let point = to.get(lane);
        clear[lane] = (surface.at_least)(point);
        if clear[lane] > 0.0 {
            continue;
        }
        clear[lane] = (surface.at)(point).0;
        if clear[lane] < 0.0 {
            let moved = placed_outside(from.get(lane), point, length[lane], &surface.at);
            to.set(lane, moved.0);
            clear[lane] = 0.0;
        }
    }
    (Vec3x8::load(&to), f32x8::from(clear))
}
