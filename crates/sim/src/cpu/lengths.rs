//! Distance constraints between neighbours.

use strandline_groom::{Lanes, Vec3Lanes};

use super::vec3x8::{Vec3x8, load};

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
