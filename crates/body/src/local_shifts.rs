//! Ways of the parts of a skin through a step, by their place: hair on a head that turns need not know how far its
//! shoulders move.

use glam::{IVec3, Vec3, Vec3A};
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::{Vec3x8, splat};
use strandline_base::{LANES, Vec3Lanes};

/// Least edge \[m\] of a cell, and the cells around that of a point whose boxes count for it.
const EDGE: f32 = 0.03;
const AROUND: i32 = 2;
/// Most cells, and most cells that all boxes lie in together.
const MOST_CELLS: i64 = 1 << 16;
const MOST_FILLED: i64 = 1 << 20;
/// Largest extent \[m\] of a skin that has cells.
const MOST_EXTENT: f32 = 1e3;
/// Share of the distance that rounding of cells leaves.
const KEPT: f32 = 0.999;

/// The most that what lies in boxes has moved, by the cells of a box around all.
#[derive(Clone, Debug)]
pub(crate) struct LocalShifts {
    origin: Vec3,
    per_metre: f32,
    size: IVec3,
    /// \[m\], shape `[z][y][x]`: the most of the boxes in a cell and the cells around it.
    shifts: Vec<f32>,
}

impl LocalShifts {
    /// Boxes at the end of a step within a box around all, corners in metres, each with the square \[m^2\] of the most that
    /// its content has moved, in parts that run on all threads; `None` where boxes are too large for cells.
    pub fn new<Boxes: Iterator<Item = ([Vec3A; 2], f32)>>(
        [low, high]: [Vec3A; 2],
        parts: usize,
        boxes: impl Fn(usize) -> Boxes + Sync,
    ) -> Option<Self> {
        let (low, extent) = (Vec3::from(low), Vec3::from(high - low));
        if extent.is_nan() || extent.max_element() > MOST_EXTENT {
            return None;
        }
        let border = IVec3::splat(2 * (AROUND + 1));
        let size_of = |edge: f32| (extent / edge).ceil().as_ivec3() + border;
        let count = |size: IVec3| size.to_array().into_iter().map(i64::from).product::<i64>();
        let mut edge = EDGE;
        while count(size_of(edge)) > MOST_CELLS {
            edge *= 1.5;
        }
        let (size, origin) = (size_of(edge), low - edge * (AROUND + 1) as f32);
        let empty = Self { origin, per_metre: 1.0 / edge, size, shifts: vec![0.0; count(size) as usize] };
        let filled: Vec<Option<(Self, i64)>> =
            (0..parts).into_par_iter().map(|part| empty.clone().filled(boxes(part))).collect();
        let (mut found, mut all_filled) = (empty, 0);
        for part in filled {
            let (part, filled) = part?;
            all_filled += filled;
            let both = found.shifts.iter_mut().zip(part.shifts);
            both.for_each(|(most, shift)| *most = most.max(shift));
        }
        if all_filled > MOST_FILLED {
            return None;
        }
        let strides = [1, size.x, size.x * size.y];
        for (stride, cells) in strides.into_iter().zip(size.to_array()) {
            found.spread(stride as usize, cells as usize);
        }
        found.shifts.iter_mut().for_each(|shift| *shift = shift.sqrt());
        Some(found)
    }

    /// The same with the squares of boxes in their cells, and the number of these for all boxes together; `None` for too many.
    fn filled(mut self, boxes: impl Iterator<Item = ([Vec3A; 2], f32)>) -> Option<(Self, i64)> {
        let mut filled = 0;
        for ([low, high], shift) in boxes {
            let (low, high) = (self.cell(low.into()), self.cell(high.into()));
            let [x, y, z] = (high - low + 1).to_array().map(i64::from);
            filled += x * y * z;
            if filled > MOST_FILLED {
                return None;
            }
            for (z, y) in (low.z..=high.z).flat_map(|z| (low.y..=high.y).map(move |y| (z, y))) {
                let row = self.index(IVec3::new(low.x, y, z));
                let cells = &mut self.shifts[row..=row + (high.x - low.x) as usize];
                cells.iter_mut().for_each(|most| *most = most.max(shift));
            }
        }
        Some((self, filled))
    }

    /// Distance \[m\] within which all boxes count.
    pub fn reach(&self) -> f32 {
        KEPT * AROUND as f32 / self.per_metre
    }

    /// The most \[m\] that anything has moved which is within [`Self::reach`] of a point at the end.
    pub fn about(&self, point: Vec3) -> f32 {
        let cell = (point - self.origin) * self.per_metre;
        // No box lies near a point beyond the border.
        let is_within = cell.cmpge(Vec3::ZERO).all() && cell.cmplt(self.size.as_vec3()).all();
        if is_within { self.shifts[self.index(cell.as_ivec3())] } else { 0.0 }
    }

    /// The same for eight points.
    pub fn about_lanes(&self, points: &Vec3Lanes) -> [f32; LANES] {
        let cells = (Vec3x8::load(points) - Vec3x8::splat(self.origin)) * splat(self.per_metre);
        let (along, size) = (cells.array(), self.size.as_vec3());
        let is_within =
            |axis: usize| along[axis].simd_ge(splat(0.0)) & along[axis].simd_lt(splat(size[axis]));
        let is_within = (is_within(0) & is_within(1) & is_within(2)).to_bitmask();
        let [x, y, z] = along.map(|along| along.fast_trunc_int().to_array());
        std::array::from_fn(|lane| match is_within & (1 << lane) {
            0 => 0.0,
            _ => self.shifts[self.index(IVec3::new(x[lane], y[lane], z[lane]))],
        })
    }

    fn cell(&self, place: Vec3) -> IVec3 {
        // Rounded toward 0: what lies below 0 is clamped.
        ((place - self.origin) * self.per_metre).as_ivec3().clamp(IVec3::ZERO, self.size - 1)
    }

    fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }

    /// Gives each cell the most of those around it along an axis of a number of cells.
    fn spread(&mut self, stride: usize, cells: usize) {
        let before = self.shifts.clone();
        let around = AROUND as usize;
        let lines = self.shifts.chunks_exact_mut(stride * cells).zip(before.chunks_exact(stride * cells));
        for (after, before) in lines {
            for (place, after) in after.chunks_exact_mut(stride).enumerate() {
                let near = place.saturating_sub(around)..(place + around + 1).min(cells);
                for other in before[near.start * stride..near.end * stride].chunks_exact(stride) {
                    after.iter_mut().zip(other).for_each(|(most, other)| *most = most.max(*other));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Boxes = Vec<([Vec3A; 2], f32)>;

    /// Boxes of a centimetre over a plane of half a metre, those at one end of which move.
    fn plane() -> ([Vec3A; 2], Boxes) {
        let at = |x: u32, z: u32| Vec3A::new(0.01 * x as f32, 0.003 * (x * z % 7) as f32, 0.01 * z as f32);
        let shift = |place: Vec3A| (0.02 * (place.x - 0.3).max(0.0)).powi(2);
        let places = (0..50).flat_map(|x| (0..50).map(move |z| at(x, z)));
        let boxes: Boxes = places.map(|place| ([place, place + 0.01], shift(place))).collect();
        ([Vec3A::ZERO, Vec3A::new(0.51, 0.04, 0.51)], boxes)
    }

    #[test]
    fn no_box_within_reach_moves_more() {
        let (bounds, boxes) = plane();
        let parts = |part: usize| boxes.iter().skip(part).step_by(3).copied();
        let shifts = LocalShifts::new(bounds, 3, parts).unwrap();
        assert!(shifts.reach() > 0.059);
        let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
        for index in 0..400 {
            let share = index as f32;
            let around = Vec3::new((1.3 * share).sin(), 0.3 * (2.1 * share).cos(), (0.7 * share).sin());
            let point = Vec3::new(0.25, 0.0, 0.25) + 0.4 * around;
            let is_near = |([low, high], _): &&([Vec3A; 2], f32)| {
                let wide = Vec3A::from(point);
                wide.distance(wide.max(*low).min(*high)) <= shifts.reach()
            };
            let brute = boxes.iter().filter(is_near).map(|(_, shift)| shift.sqrt()).fold(0.0, f32::max);
            let found = shifts.about(point);
            assert!(found >= brute, "{found} at {point}, {brute} by all boxes");
            let mut lanes = Vec3Lanes::splat(Vec3::NAN);
            lanes.set(index % LANES, point);
            let mut expected = [0.0; LANES];
            expected[index % LANES] = found;
            assert_eq!(shifts.about_lanes(&lanes), expected, "{point}");
            (least, most) = (least.min(found), most.max(found));
        }
        assert!(least == 0.0 && most > 0.003, "{least} {most}: the bound is local");
        assert_eq!((shifts.about(Vec3::splat(9.0)), shifts.about(Vec3::NAN)), (0.0, 0.0));
    }

    #[test]
    fn boxes_too_large_for_cells_have_none() {
        let all = [Vec3A::ZERO, Vec3A::splat(900.0)];
        // Any of the two parts has fewer cells than are too many.
        assert!(LocalShifts::new(all, 2, |_| std::iter::repeat_n((all, 1.0), 20)).is_none());
        assert!(LocalShifts::new([Vec3A::ZERO, Vec3A::INFINITY], 1, |_| std::iter::empty()).is_none());
    }
}
