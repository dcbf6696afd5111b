//! Bound strands: those of a groom that are not simulated, moved by the guides that they are bound to.
//!
//! Each point of a guide carries a frame: where it is, and how it is turned against rest. A point of a bound
//! strand keeps its place in the frames of the guides about it, at the same length along them, and lies where
//! their weighted mean has it: linear blend skinning [Magnenat1988]. Then segments get their rest lengths back
//! from root to tip. At rest all frames are the head's, so that a groom at rest is exactly the groom.

use glam::{Mat3, Quat, Vec3, Vec4};
use rayon::prelude::*;
use strandline_base::SettingError;
use strandline_body::Pose;

use crate::{
    Groom, GroomError, Guides, LANES, Vec3Lanes,
    choice::{self, Feature, Roots},
    outside::placed_outside,
};

/// The signed distance \[m\] of a body at a point \[m\], world space, negative inside, and its unit gradient.
pub type Surface<'a> = dyn Fn(Vec3) -> (f32, Vec3) + Sync + 'a;

#[cfg(test)]
mod tests;
mod weights;

/// Guides that a strand is bound to at most.
pub const MOST_INFLUENCES: usize = 3;
/// Lengths within this share of those at rest are those at rest.
const UNSCALED: f32 = 0.01;

/// A frame of a guide's point as a map from rest to now: rows of a matrix with the translation \[m\] behind each.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Frame {
    /// Rows: what gives x, y and z, world space, of a place at rest \[m\], head space.
    pub rows: [[f32; 4]; 3],
}

impl Frame {
    fn new(rotation: Quat, rest: Vec3, now: Vec3) -> Self {
        let matrix = Mat3::from_quat(rotation);
        let translation = now - matrix * rest;
        let rows = matrix.transpose();
        Self {
            rows: [
                rows.x_axis.extend(translation.x).to_array(),
                rows.y_axis.extend(translation.y).to_array(),
                rows.z_axis.extend(translation.z).to_array(),
            ],
        }
    }
}

/// One guide that a bound strand follows.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Influence {
    /// The guide, by its place among the guides.
    pub guide: u32,
    /// How much it is followed; those of a strand sum to 1.
    pub weight: f32,
    /// Points of the guide that a point of the strand is along: the strand's length over the guide's.
    pub pace: f32,
}

/// The strands of a groom and the guides among them: which guides each strand follows, and where it is at rest.
#[derive(Clone, Debug)]
pub struct Binding {
    /// All strands at rest, resampled.
    strands: Guides,
    /// Guides at rest, of the same number of points.
    guides: Guides,
    /// Shape `[strand][MOST_INFLUENCES]`; weights of 0 stand for none.
    influences: Vec<[Influence; MOST_INFLUENCES]>,
}

impl Binding {
    /// Binds the strands of a groom to some of them, its guides by their indices in rising order.
    ///
    /// A strand that is a guide follows itself alone. Others follow the guides that the groom names, where it
    /// names some, and else the four that are nearest to them in place and shape, those of the same group first.
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
            influences
        });
        let influences = influences.collect();
        Ok(Self { strands, guides, influences })
    }

    /// All strands at rest.
    pub fn strands(&self) -> &Guides {
        &self.strands
    }

    /// The guides at rest.
    pub fn guides(&self) -> &Guides {
        &self.guides
    }

    /// The guides that each strand follows, shape `[strand][MOST_INFLUENCES]`; a weight of 0 stands for none.
    pub fn influences(&self) -> &[[Influence; MOST_INFLUENCES]] {
        &self.influences
    }

    /// Frames of the guides' points, shape `[guide][point]`, given where they are \[m\], world space, shape
    /// `[block][point]` of lanes.
    ///
    /// The first frame turns with the head, and as little more as takes the first segment where it is; each
    /// further one turns as little as it can against the one before.
    pub fn frames(&self, positions: &[Vec3Lanes], world_from_head: &Pose, out: &mut Vec<Frame>) {
        let count = self.guides.points_per_strand();
        out.resize(self.guides.strand_count() * count, Frame { rows: [[0.0; 4]; 3] });
        out.par_chunks_mut(count).enumerate().for_each(|(guide, frames)| {
            let now = |point: usize| positions[guide / LANES * count + point].get(guide % LANES);
            let rest = |point: usize| self.guides.position(guide, point);
            let mut rotation = world_from_head.rotation;
            for (point, frame) in frames.iter_mut().enumerate() {
                // The last point has no segment of its own.
                let start = point.min(count - 2);
                let from = (rotation * (rest(start + 1) - rest(start))).normalize_or_zero();
                let to = (now(start + 1) - now(start)).normalize_or_zero();
                if from != to && from != Vec3::ZERO && to != Vec3::ZERO {
                    rotation = (Quat::from_rotation_arc(from, to) * rotation).normalize();
                }
                *frame = Frame::new(rotation, rest(point), now(point));
            }
        });
    }

    /// Length of each guide over its length at rest, shape `[guide]`: other than 1 where it was cut or grew.
    pub fn scales(&self, positions: &[Vec3Lanes], out: &mut Vec<f32>) {
        let count = self.guides.points_per_strand();
        let scale = |guide: usize| {
            let now = |point: usize| positions[guide / LANES * count + point].get(guide % LANES);
            let rest = |point: usize| self.guides.position(guide, point);
            let length = |place: &dyn Fn(usize) -> Vec3| -> f32 {
                (1..count).map(|point| place(point).distance(place(point - 1))).sum()
            };
            let scale = length(&now) / length(&rest).max(f32::MIN_POSITIVE);
            // What the solver leaves of stretch is not what was asked for.
            if (scale - 1.0).abs() < UNSCALED { 1.0 } else { scale }
        };
        (0..self.guides.strand_count()).into_par_iter().map(scale).collect_into_vec(out);
    }

    /// Where all strands are \[m\], world space, shape `[block][point]` of lanes, given where the guides are, in
    /// the same shape. Roots move with the head, segments have the lengths that they have at rest, or that share
    /// of them that those of the guides have; points inside the body are put onto its surface.
    pub fn place(
        &self,
        positions: &[Vec3Lanes],
        world_from_head: &Pose,
        surface: Option<&Surface>,
        out: &mut Vec<Vec3Lanes>,
    ) {
        let (mut frames, mut scales) = (Vec::new(), Vec::new());
        self.frames(positions, world_from_head, &mut frames);
        self.scales(positions, &mut scales);
        let count = self.strands.points_per_strand();
        out.resize(self.strands.positions().len(), Vec3Lanes::default());
        out.par_chunks_mut(count).enumerate().for_each(|(block, places)| {
            for lane in 0..LANES {
                let strand = (block * LANES + lane).min(self.strands.strand_count() - 1);
                let put = |point: usize, place| places[point].set(lane, place);
                self.place_strand(strand, &frames, &scales, world_from_head, surface, put);
            }
        });
    }

    fn place_strand(
        &self,
        strand: usize,
        frames: &[Frame],
        scales: &[f32],
        world_from_head: &Pose,
        surface: Option<&Surface>,
        mut put: impl FnMut(usize, Vec3),
    ) {
        let influences = &self.influences[strand];
        let followed = || influences.iter().filter(|influence| influence.weight > 0.0);
        let scale: f32 =
            followed().map(|influence| influence.weight * scales[influence.guide as usize]).sum();
        let mut rest = self.strands.position(strand, 0);
        let mut before = world_from_head.point(rest);
        // Where the frames have the point before: segments lead as from one such place to the next.
        let mut blended_before = before;
        // How far \[m\] the surface is at least.
        let mut clear = 0.0;
        put(0, before);
        for point in 1..self.strands.points_per_strand() {
            let here = self.strands.position(strand, point);
            let blended = self.blend(influences, frames, point, here);
            let (segment, step) = (here - rest, blended - blended_before);
            let stretched = step.length_squared();
            let way = if stretched > 0.0 { step } else { world_from_head.direction(segment) };
            let own = segment.length_squared();
            let share = if stretched > 0.0 { own / stretched } else { 1.0 };
            let mut placed = before + way * (scale * share.sqrt());
            if let Some(surface) = surface {
                let length = before.distance(placed);
                clear -= length;
                if clear <= 0.0 {
                    clear = surface(placed).0;
                }
                if clear < 0.0 {
                    placed = placed_outside(before, placed, length, &surface).0;
                    clear = 0.0;
                }
            }
            put(point, placed);
            (rest, before, blended_before) = (here, placed, blended);
        }
    }

    /// Where the guides about a strand have a point of it, which is at `here` at rest \[m\].
    fn blend(&self, influences: &[Influence], frames: &[Frame], point: usize, here: Vec3) -> Vec3 {
        let last = self.guides.points_per_strand() - 1;
        let mut rows = [Vec4::ZERO; 3];
        for influence in influences.iter().filter(|influence| influence.weight > 0.0) {
            let along = (point as f32 * influence.pace) as usize;
            let frame = &frames[influence.guide as usize * (last + 1) + along.min(last)];
            for (row, of_frame) in rows.iter_mut().zip(&frame.rows) {
                *row += Vec4::from(*of_frame) * influence.weight;
            }
        }
        let here = here.extend(1.0);
        Vec3::new(rows[0].dot(here), rows[1].dot(here), rows[2].dot(here))
    }
}
