//! Eight strands at a time, as they lie in memory, and their points strand after strand, as files have them.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Strands in a block: one SIMD lane is one strand.
pub const LANES: usize = 8;

/// Blocks needed for a number of strands.
pub const fn block_count(strand_count: usize) -> usize {
    strand_count.div_ceil(LANES)
}

/// Place of a strand's point in arrays of shape `[block][point]` of lanes: the index, and the lane there.
#[inline]
pub const fn lane_place(strand: usize, point: usize, points_per_strand: usize) -> (usize, usize) {
    (strand / LANES * points_per_strand + point, strand % LANES)
}

/// Some of each eight strands, the same of every eight: a sample that is spread evenly. Its strands are numbered in the order
/// of all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneSet {
    /// Lanes of the set in order; those from `count` on are none of it.
    lanes: [u8; LANES],
    count: u8,
}

impl Default for LaneSet {
    fn default() -> Self {
        Self::ALL
    }
}

impl LaneSet {
    /// All strands.
    pub const ALL: Self = Self { lanes: [0, 1, 2, 3, 4, 5, 6, 7], count: LANES as u8 };

    /// The lanes for which a function is true.
    ///
    /// # Panics
    /// There is none.
    pub fn of(holds: impl Fn(usize) -> bool) -> Self {
        let mut set = Self { lanes: [0; LANES], count: 0 };
        for lane in (0..LANES).filter(|lane| holds(*lane)) {
            set.lanes[usize::from(set.count)] = lane as u8;
            set.count += 1;
        }
        assert!(set.count > 0, "a set without lanes");
        set
    }

    /// True where all strands are in the set.
    pub fn is_all(&self) -> bool {
        *self == Self::ALL
    }

    /// Number of strands in the set, of a number of strands.
    pub fn count_of(&self, strand_count: usize) -> usize {
        let (eights, rest) = (strand_count / LANES, strand_count % LANES);
        let lanes = &self.lanes[..usize::from(self.count)];
        eights * lanes.len() + lanes.iter().filter(|lane| usize::from(**lane) < rest).count()
    }

    /// Number among all strands of a strand of the set.
    #[inline]
    pub fn strand(&self, index: usize) -> usize {
        let count = usize::from(self.count);
        index / count * LANES + usize::from(self.lanes[index % count])
    }

    /// Takes the strands of the set out of lanes of shape `[block][point]`, in the same shape.
    pub fn taken<L: LaneArray + Default + Clone>(
        &self,
        lanes: &[L],
        strand_count: usize,
        points_per_strand: usize,
    ) -> Vec<L> {
        let count = self.count_of(strand_count);
        let mut taken = vec![L::default(); block_count(count) * points_per_strand];
        fill_lanes(&mut taken, count, points_per_strand, |strand, point| {
            let (index, lane) = lane_place(self.strand(strand), point, points_per_strand);
            lanes[index].element(lane)
        });
        taken
    }
}

/// Elements of shape `[block][point]` of lanes, strand after strand: shape `[strand][point]`.
pub fn in_strand_order<L: LaneArray>(
    lanes: &[L],
    strand_count: usize,
    points_per_strand: usize,
) -> impl Iterator<Item = L::Element> + '_ {
    let places = move |strand| (0..points_per_strand).map(move |point| (strand, point));
    (0..strand_count).flat_map(places).map(move |(strand, point)| {
        let (index, lane) = lane_place(strand, point, points_per_strand);
        lanes[index].element(lane)
    })
}

/// Fills lanes of shape `[block][point]` with the elements of strands, from (strand, point); lanes beyond the last strand
/// repeat it.
pub fn fill_lanes<L: LaneArray>(
    lanes: &mut [L],
    strand_count: usize,
    points_per_strand: usize,
    element: impl Fn(usize, usize) -> L::Element,
) {
    for (index, slot) in lanes.iter_mut().enumerate() {
        for lane in 0..LANES {
            let strand = (index / points_per_strand * LANES + lane).min(strand_count - 1);
            slot.set_element(lane, element(strand, index % points_per_strand));
        }
    }
}

/// Elements of the strands of a block.
pub trait LaneArray {
    /// Element of one strand.
    type Element;

    /// The element of a lane.
    fn element(&self, lane: usize) -> Self::Element;

    /// Sets the element of a lane.
    fn set_element(&mut self, lane: usize, element: Self::Element);
}

impl LaneArray for Lanes {
    type Element = f32;

    #[inline]
    fn element(&self, lane: usize) -> f32 {
        self.0[lane]
    }

    #[inline]
    fn set_element(&mut self, lane: usize, element: f32) {
        self.0[lane] = element;
    }
}

impl LaneArray for Vec3Lanes {
    type Element = Vec3;

    #[inline]
    fn element(&self, lane: usize) -> Vec3 {
        self.get(lane)
    }

    #[inline]
    fn set_element(&mut self, lane: usize, element: Vec3) {
        self.set(lane, element);
    }
}

/// One number for each strand of a block.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Lanes(pub [f32; LANES]);

/// One vector for each strand of a block, component by component.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vec3Lanes {
    /// First components.
    pub x: [f32; LANES],
    /// Second components.
    pub y: [f32; LANES],
    /// Third components.
    pub z: [f32; LANES],
}

impl Vec3Lanes {
    /// The same vector in every lane.
    pub fn splat(vector: Vec3) -> Self {
        Self { x: [vector.x; LANES], y: [vector.y; LANES], z: [vector.z; LANES] }
    }

    /// All vectors with another one added.
    #[must_use]
    pub fn moved(&self, by: Vec3) -> Self {
        let add = |lanes: [f32; LANES], by: f32| lanes.map(|lane| lane + by);
        Self { x: add(self.x, by.x), y: add(self.y, by.y), z: add(self.z, by.z) }
    }

    /// The vector of one strand.
    #[inline]
    pub fn get(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// Sets the vector of one strand.
    #[inline]
    pub fn set(&mut self, lane: usize, vector: Vec3) {
        self.x[lane] = vector.x;
        self.y[lane] = vector.y;
        self.z[lane] = vector.z;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strands_go_into_lanes_and_come_back_and_the_last_fills_its_block() {
        let (strands, points) = (11, 3);
        let element = |strand: usize, point: usize| Vec3::new(strand as f32, point as f32, 0.5);
        let mut lanes = vec![Vec3Lanes::default(); block_count(strands) * points];
        fill_lanes(&mut lanes, strands, points, element);
        let found: Vec<Vec3> = in_strand_order(&lanes, strands, points).collect();
        let wanted: Vec<Vec3> =
            (0..strands * points).map(|index| element(index / points, index % points)).collect();
        assert_eq!(found, wanted);
        // The last lane of the second block repeats strand 10.
        assert_eq!(lanes[points + 2].get(7), element(10, 2));
        assert_eq!(lane_place(10, 2, points), (points + 2, 2));
        let mut numbers = vec![Lanes::default(); block_count(strands) * points];
        fill_lanes(&mut numbers, strands, points, |strand, point| (10 * strand + point) as f32);
        assert_eq!(in_strand_order(&numbers, strands, points).nth(4 * points + 1), Some(41.0));
    }

    #[test]
    fn a_set_takes_its_lanes_of_every_eight_strands_in_order() {
        let set = LaneSet::of(|lane| lane % 3 == 1);
        for (strands, wanted) in [(7, vec![1, 4]), (8, vec![1, 4, 7]), (22, vec![1, 4, 7, 9, 12, 15, 17, 20])]
        {
            let found: Vec<usize> = (0..set.count_of(strands)).map(|index| set.strand(index)).collect();
            assert_eq!(found, wanted);
            let mut all = vec![Lanes::default(); block_count(strands) * 2];
            fill_lanes(&mut all, strands, 2, |strand, point| (10 * strand + point) as f32);
            let taken = set.taken(&all, strands, 2);
            let points: Vec<f32> = in_strand_order(&taken, wanted.len(), 2).collect();
            let of = |strand: &usize| [10.0 * *strand as f32, 10.0 * *strand as f32 + 1.0];
            assert_eq!(points, wanted.iter().flat_map(of).collect::<Vec<_>>());
        }
        assert!(LaneSet::of(|_| true).is_all() && !set.is_all());
        assert_eq!((LaneSet::ALL.count_of(13), LaneSet::ALL.strand(11)), (13, 11));
    }
}
