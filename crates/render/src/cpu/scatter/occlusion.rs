//! Surroundings hidden by hair from a place: the ambient part of `shade`.
//!
//! Hair is summed into a coarse grid of cells; light is carried through the grid along the six
//! axes, mixed a little with the neighbours at every cell so that it stands for a cone of
//! directions. A place keeps six visibilities, an ambient cube \[McTaggart2004\].

use glam::{UVec3, Vec3};
use strandline_base::par::prelude::*;

use crate::fast_math::exp;
use crate::fibre::chiang::MOST_CELLS as LONGEST;
use crate::lanes::{rounded_up, split};
use crate::shadow::stepped_down;
use crate::strands::Strands;
use crate::{Environment, Shadow};

/// Cells around them on each side: hair is spread over the nearest one, and light enters the other unhindered.
const AROUND: u32 = 2;
/// Bits of the cells' number on a metre behind the first: steps of 7 to 12 %.
const CELL_BITS: u32 = 3;
/// Cells at most: the box and the empty cells around it. Room for all is taken once, so that hair which
/// spreads while it moves asks for no more.
const MOST_CELLS: usize = (LONGEST as usize + 1 + 2 * AROUND as usize).pow(3);
/// Parts that the strands are shared out to.
const PARTS: usize = 4;
/// Whole numbers make sums that do not depend on their order: parts of a square metre, 2^44.
const UNITS: f32 = 17_592_186_044_416.0;
/// Mean of the sine between random hairs and a fixed direction: projected over full width times length.
const MEAN_SINE: f32 = std::f32::consts::FRAC_PI_4;
/// Share of the light that each of four neighbours gives at every cell: about 25 degrees of spread.
const SPREAD: f32 = 0.1;

/// Light that reaches each cell from +x, -x, +y, -y, +z, -z; two more are unused.
type Cube = [f32; 8];

/// Visibility of the surroundings around and in the hair.
#[derive(Clone, Debug, Default)]
pub struct Occlusion {
    /// Cells lie whole numbers of them beside this place \[m\].
    middle: Vec3,
    /// Cells along the longest side of the box around the hair; 0 for as many as there may be.
    longest: u32,
    min: Vec3,
    cell: f32,
    counts: [usize; 3],
    parts: Vec<Vec<u64>>,
    /// Logarithm of what each cell lets through.
    logs: Vec<f32>,
    cubes: Vec<Cube>,
    front: [Vec<f32>; 2],
}

impl Occlusion {
    /// Anchors the cells to a point of the head \[m\], world space, or to the origin if it is not finite, and sets their
    /// number along the longest side of the hair.
    pub fn set_grid(&mut self, middle: Vec3, longest: u32) {
        self.middle = if middle.is_finite() { middle } else { Vec3::ZERO };
        self.longest = longest.min(LONGEST);
    }

    /// Sums the hair and carries light through it.
    pub fn fill(&mut self, strands: &Strands, settings: &Shadow) {
        self.fit(&strands.positions);
        self.sum(strands, settings.log_transmission());
        refill(&mut self.cubes, self.logs.len(), [1.0; 8]);
        for axis in 0..3 {
            self.sweep(axis, true);
            self.sweep(axis, false);
        }
    }

    /// Lays the cells around the hair, as if it hid nothing.
    pub(crate) fn place(&mut self, strands: &Strands) {
        self.fit(&strands.positions);
        self.cubes.clear();
    }

    /// Visibility, 0 to 1, of the surroundings from a point \[m\] toward +x, -x, +y, -y, +z, -z.
    pub fn visibilities(&self, point: Vec3) -> [f32; 6] {
        let cube = self.cube(point);
        [cube[0], cube[1], cube[2], cube[3], cube[4], cube[5]]
    }

    /// Mean radiance of the surroundings that reaches a point \[m\], linear RGB.
    pub fn ambient(&self, point: Vec3, environment: &Environment) -> Vec3 {
        mean_radiance(&self.cube(point), environment)
    }

    /// Radiance that reaches a surface of the given unit normal at a point \[m\], weighted with the
    /// cosine: the radiance of a white matte surface there.
    pub fn ambient_on(&self, point: Vec3, normal: Vec3, environment: &Environment) -> Vec3 {
        let cube = self.cube(point);
        // Over the cosine lobe about a normal, the height of a direction averages two thirds of the normal's.
        environment.radiance(normal * (2.0 / 3.0)) * toward(&cube, normal)
    }

    /// The grid of the last picture.
    pub(crate) fn grid(&self) -> GridBox {
        GridBox { min: self.min, cell: self.cell, counts: self.counts }
    }

    #[inline]
    pub(crate) fn cube(&self, point: Vec3) -> Cube {
        let at = (point - self.min) / self.cell - Vec3::splat(0.5);
        let last = Vec3::from(self.counts.map(|count| count as f32 - 1.001));
        if self.cubes.is_empty() || !at.is_finite() {
            return [1.0; 8];
        }
        let at = at.clamp(Vec3::ZERO, last.max(Vec3::ZERO));
        let ([x, y, z], part) = split(at);
        let [columns, rows, _] = self.counts;
        let first = (z * rows + y) * columns + x;
        let mut sum = [0.0; 8];
        for corner in 0..8 {
            let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
            let weight = side(part.x, dx) * side(part.y, dy) * side(part.z, dz);
            let cube = &self.cubes[first + (dz * rows + dy) * columns + dx];
            for (sum, value) in sum.iter_mut().zip(cube) {
                *sum += weight * value;
            }
        }
        sum
    }

    fn fit(&mut self, points: &[Vec3]) {
        let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (min, max) = points
            .par_chunks(8192)
            .map(|chunk| chunk.iter().fold(empty, |(min, max), &point| (min.min(point), max.max(point))))
            .reduce(|| empty, |one, other| (one.0.min(other.0), one.1.max(other.1)));
        let longest = if self.longest == 0 { LONGEST } else { self.longest };
        let sound = min.is_finite() && max.is_finite();
        let (min, max) = if sound { (min, max) } else { (Vec3::ZERO, Vec3::ONE) };
        let extent = (max - min).max(Vec3::splat(1e-3));
        // Sizes of a few steps: cells stay where they are while the outline of the hair changes.
        self.cell = 1.0 / stepped_down(longest as f32 / extent.max_element(), CELL_BITS);
        let around = Vec3::splat(AROUND as f32);
        let first = ((min - self.middle) / self.cell).floor() - around;
        let last = ((min + extent - self.middle) / self.cell).floor() + around;
        self.min = self.middle + first * self.cell;
        let (least, most) = (UVec3::splat(1 + 2 * AROUND), UVec3::splat(longest + 1 + 2 * AROUND));
        let counts = ((last - first).as_uvec3() + UVec3::ONE).clamp(least, most);
        self.counts = counts.to_array().map(|count| count as usize);
    }

    fn sum(&mut self, strands: &Strands, log_transmission: f32) {
        let cells = self.counts.iter().product();
        let grid = Grid { min: self.min, inverse: 1.0 / self.cell, counts: self.counts };
        let count = strands.points_per_strand;
        self.parts.resize_with(PARTS, Vec::new);
        self.parts.par_iter_mut().enumerate().for_each(|(part, areas)| {
            refill(areas, cells, 0);
            let range = strands.strand_count * part / PARTS..strands.strand_count * (part + 1) / PARTS;
            for segment in range.flat_map(|strand| strand * count..(strand + 1) * count - 1) {
                let end = |point: usize| (strands.positions[point], strands.widths[point]);
                grid.spread(end(segment), end(segment + 1), areas);
            }
        });
        let face = self.cell * self.cell;
        let scale = MEAN_SINE * log_transmission / (UNITS * face);
        self.logs.clear();
        self.logs.reserve_exact(MOST_CELLS);
        self.logs.extend((0..cells).map(|cell| {
            let units: u64 = self.parts.iter().map(|part| part[cell]).sum();
            units as f32 * scale
        }));
    }

    /// Carries light along an axis, from its far end when `backward`; what passes is stored where it comes from.
    fn sweep(&mut self, axis: usize, backward: bool) {
        let strides = [1, self.counts[0], self.counts[0] * self.counts[1]];
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (wide, high, deep) = (self.counts[u], self.counts[v], self.counts[axis]);
        let slot = 2 * axis + usize::from(!backward);
        let [light, next] = &mut self.front;
        light.clear();
        light.resize(wide * high, 1.0);
        next.resize(wide * high, 1.0);
        for step in 0..deep {
            let plane = strides[axis] * if backward { deep - 1 - step } else { step };
            for row in 0..high {
                for column in 0..wide {
                    let at = |column: usize, row: usize| light[row * wide + column];
                    let around = at(column.saturating_sub(1), row)
                        + at((column + 1).min(wide - 1), row)
                        + at(column, row.saturating_sub(1))
                        + at(column, (row + 1).min(high - 1));
                    let arrived = (1.0 - 4.0 * SPREAD) * at(column, row) + SPREAD * around;
                    let cell = plane + column * strides[u] + row * strides[v];
                    // Half of the cell's own hair lies before its middle.
                    let half = exp(0.5 * self.logs[cell]);
                    self.cubes[cell][slot] = arrived * half;
                    next[row * wide + column] = arrived * half * half;
                }
            }
            std::mem::swap(light, next);
        }
    }
}

/// Box of the cells of a grid.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridBox {
    /// Its least corner \[m\].
    pub(crate) min: Vec3,
    /// Size of a cell \[m\].
    pub(crate) cell: f32,
    pub(crate) counts: [usize; 3],
}

impl GridBox {
    pub(crate) fn cell_count(&self) -> usize {
        self.counts.iter().product()
    }

    /// The middle of a cell \[m\].
    pub(crate) fn middle(&self, index: usize) -> Vec3 {
        let [columns, rows, _] = self.counts;
        let at = [index % columns, index / columns % rows, index / columns / rows];
        self.min + Vec3::from(at.map(|at| at as f32 + 0.5)) * self.cell
    }

    /// True if a box \[m\] touches the grid.
    pub(crate) fn holds(&self, min: Vec3, max: Vec3) -> bool {
        let end = self.min + Vec3::from(self.counts.map(|count| count as f32)) * self.cell;
        max.cmpge(self.min).all() && min.cmple(end).all()
    }

    /// The first of the eight cells whose middles surround a place \[m\], and the share of the others.
    #[inline]
    pub(crate) fn place(&self, place: Vec3) -> (usize, Vec3) {
        let last = Vec3::from(self.counts.map(|count| count as f32 - 1.001));
        let at = ((place - self.min) / self.cell - Vec3::splat(0.5)).clamp(Vec3::ZERO, last.max(Vec3::ZERO));
        let [columns, rows, _] = self.counts;
        let ([x, y, z], part) = split(at);
        ((z * rows + y) * columns + x, part)
    }

    /// Hands the eight cells around a place \[m\] to `add`, each with its share.
    #[inline]
    pub(crate) fn spread(&self, place: Vec3, mut add: impl FnMut(usize, f32)) {
        let (first, part) = self.place(place);
        let [columns, rows, _] = self.counts;
        for corner in 0..8 {
            let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
            let share = side(part.x, dx) * side(part.y, dy) * side(part.z, dz);
            add(first + (dz * rows + dy) * columns + dx, share);
        }
    }
}

/// The cells that hair is summed into.
struct Grid {
    min: Vec3,
    /// Cells on a metre.
    inverse: f32,
    counts: [usize; 3],
}

impl Grid {
    /// Spreads the area of a segment, given by the place and the width \[m\] of its ends, in pieces no longer
    /// than a cell. The shares of a piece in the eight cells around it change smoothly with its place.
    #[inline]
    fn spread(&self, start: (Vec3, f32), end: (Vec3, f32), areas: &mut [u64]) {
        let way = end.0 - start.0;
        let longest = way.abs().max_element() * self.inverse;
        // No segment is longer than the grid, but where something is not finite.
        if longest.is_nan() || longest > MOST_CELLS as f32 {
            return;
        }
        let pieces = rounded_up(longest).max(1);
        let share = 1.0 / pieces as f32;
        let length = way.length() * (share * UNITS);
        for piece in 0..pieces {
            let along = (piece as f32 + 0.5) * share;
            let width = start.1 + (end.1 - start.1) * along;
            self.add(start.0 + way * along, length * width, areas);
        }
    }

    #[inline]
    fn add(&self, place: Vec3, area: f32, areas: &mut [u64]) {
        let [columns, rows, layers] = self.counts;
        let last = Vec3::new(columns as f32, rows as f32, layers as f32) - Vec3::splat(1.001);
        let at = ((place - self.min) * self.inverse - Vec3::splat(0.5)).clamp(Vec3::ZERO, last);
        let ([x, y, z], part) = split(at);
        let first = (z * rows + y) * columns + x;
        for upper in 0..4 {
            let (dy, dz) = (upper & 1, upper >> 1);
            let area = area * side(part.y, dy) * side(part.z, dz);
            let right = (area * part.x) as u64;
            let cell = first + (dz * rows + dy) * columns;
            areas[cell] += area as u64 - right;
            areas[cell + 1] += right;
        }
    }
}

/// So many of one value, in room for all cells there may be.
fn refill<T: Clone>(values: &mut Vec<T>, count: usize, value: T) {
    values.clear();
    values.reserve_exact(MOST_CELLS);
    values.resize(count, value);
}

#[inline]
fn side(part: f32, upper: usize) -> f32 {
    if upper == 1 { part } else { 1.0 - part }
}

/// Visibility toward a unit direction.
#[inline]
pub(crate) fn toward(cube: &Cube, direction: Vec3) -> f32 {
    let square = direction * direction;
    let pick = |axis: usize, value: f32| cube[2 * axis + usize::from(value < 0.0)];
    square.x * pick(0, direction.x) + square.y * pick(1, direction.y) + square.z * pick(2, direction.z)
}

/// Mean radiance over all directions.
#[inline]
pub(crate) fn mean_radiance(cube: &Cube, environment: &Environment) -> Vec3 {
    let level = 0.5 * (environment.sky + environment.ground) * (cube[0] + cube[1] + cube[4] + cube[5]);
    // The mean height of the directions of one axis's share of the sphere: three quarters of the pole's.
    let up = environment.radiance(Vec3::Y * 0.75) * cube[2];
    let down = environment.radiance(Vec3::NEG_Y * 0.75) * cube[3];
    (level + up + down) * (1.0 / 6.0)
}
