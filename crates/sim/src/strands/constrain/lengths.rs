//! Distance constraints between neighbours.

use strandline_groom::{Lanes, Vec3Lanes};
use wide::f32x8;

use strandline_base::vec3x8::{Vec3x8, load};

/// The segments of one block: rest lengths and how the ends share a correction.
#[derive(Clone, Copy)]
pub struct Segments<'a> {
    pub lengths: &'a [Lanes],
    pub share_lower: &'a [Lanes],
    pub share_upper: &'a [Lanes],
}

impl Segments<'_> {
    /// One round over the two independent sets: even segments, then odd ones [Chen2011 eq. 1-2, fig. 15-17].
    #[inline]
    pub fn project(&self, positions: &mut [Vec3Lanes]) {
        self.project_set(positions, 0);
        self.project_set(positions, 1);
    }

    /// The same for all lanes but those of a mask; `kept` is room for as many points.
    pub fn project_all_but(&self, mask: f32x8, positions: &mut [Vec3Lanes], kept: &mut [Vec3Lanes]) {
        if !mask.any() {
            return self.project(positions);
        }
        kept.copy_from_slice(positions);
        self.project(positions);
        for (position, kept) in positions.iter_mut().zip(kept) {
            Vec3x8::load(kept).or(mask, Vec3x8::load(position)).store(position);
        }
    }

    #[inline(always)]
    fn project_set(&self, positions: &mut [Vec3Lanes], first: usize) {
        let lengths = self.lengths[first..].chunks(2);
        let lower = self.share_lower[first..].chunks(2);
        let upper = self.share_upper[first..].chunks(2);
        for (((pair, length), lower), upper) in
            positions[first..].chunks_exact_mut(2).zip(lengths).zip(lower).zip(upper)
        {
            let (start, end) = (Vec3x8::load(&pair[0]), Vec3x8::load(&pair[1]));
            let across = end - start;
            let distance = across.length();
            // [Mueller2007 eq. 10-11]
            let correction = across * ((distance - load(&length[0])) / distance);
            (start + correction * load(&lower[0])).store(&mut pair[0]);
            (end - correction * load(&upper[0])).store(&mut pair[1]);
        }
    }
}
