//! Half spaces that stand for solids near points.

use strandline_base::vec3x8::{Vec3x8, splat};
use wide::f32x8;

/// A half space for the points of one index, world space.
#[derive(Clone, Copy)]
pub struct Touch {
    /// Unit normal, out of the solid.
    pub normal: Vec3x8,
    /// Points stay where normal . x is at least this \[m\].
    pub offset: f32x8,
    /// Coulomb friction coefficient.
    pub friction: f32x8,
    /// Positions of points that stuck to the solid \[m\].
    pub stuck: Vec3x8,
    /// Positions after the look-up: unchanged, or where a solid stopped the points on their path \[m\].
    pub place: Vec3x8,
}

impl Touch {
    /// Height \[m\] above the plane.
    #[inline(always)]
    pub fn height(&self, position: Vec3x8) -> f32x8 {
        self.normal.dot(position) - self.offset
    }

    /// Distance \[m\] that friction may move points back in this step [Macklin2014 eq. 24]. It follows from the depth of
    /// the prediction alone, so that the number of rounds does not change it.
    #[inline(always)]
    pub fn friction_of(&self, predicted: Vec3x8) -> f32x8 {
        self.friction * (-self.height(predicted)).fast_max(splat(0.0))
    }

    /// Pushes points out of the solid and takes back their slip, up to the `left` \[m\] of friction. Friction holds until
    /// the step ends, even where a round has lifted the point a little.
    #[inline(always)]
    pub fn resolve(&self, position: Vec3x8, left: &mut f32x8) -> Vec3x8 {
        let height = self.height(position);
        if !(height.simd_lt(splat(0.0)) | left.simd_gt(splat(0.0))).any() {
            return position;
        }
        let out = position - self.normal * height.fast_min(splat(0.0));
        let slip = out - self.stuck;
        let slip = slip - self.normal * self.normal.dot(slip);
        let size = slip.length();
        let taken = left.fast_min(size);
        *left -= taken;
        out - slip * (taken / size)
    }

    #[inline(always)]
    pub(super) fn nearer(&self, other: &Self, position: Vec3x8) -> Self {
        self.or(self.height(position).simd_lt(other.height(position)), other)
    }

    /// This where the mask is set, else `other`.
    #[inline(always)]
    pub fn or(&self, mask: f32x8, other: &Self) -> Self {
        Self {
            normal: self.normal.or(mask, other.normal),
            offset: mask.bitselect(self.offset, other.offset),
            friction: mask.bitselect(self.friction, other.friction),
            stuck: self.stuck.or(mask, other.stuck),
            place: self.place.or(mask, other.place),
        }
    }

    /// This, without a touch where the mask is set.
    pub fn except(&self, mask: f32x8) -> Self {
        Self { offset: mask.bitselect(splat(f32::NEG_INFINITY), self.offset), ..*self }
    }
}
