//! Light on its way through the cells of a grid, and what they scatter of it: part of `light_grid`.

use glam::{IVec3, Vec3, Vec4};
use strandline_base::par::prelude::*;

use super::light_scene::{Cell, Scene};
use super::occlusion::GridBox;
use crate::fast_math::exp;
use crate::light_field::{self, Field};
use crate::scatter::ways::directions;
use crate::scatter::ways::{DIRECTIONS, Rays};

/// Mean cosine between random hairs and the plane across a direction.
const MEAN_COSINE: f32 = std::f32::consts::FRAC_PI_4;
/// Attenuation of light by skin, relative to cells that are evenly filled with it.
const SKIN_EXTINCTION: f32 = 4.0;
/// Optical depth of hair below which the rounding of an exponential would show in the mean radiance of a cell.
const THIN: f32 = 1e-2;
/// Slots that lie together.
const BLOCK: usize = 64;
/// No slot.
const NONE: u32 = u32::MAX;

/// Light of [`BLOCK`] slots, shape `[direction][slot]`.
type Block = [[Vec4; BLOCK]; DIRECTIONS];

/// Light carried through cells. Those that hold something have a slot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Carried {
    /// The slot of each cell.
    slots: Vec<u32>,
    /// True for each row of cells that is not empty, shape `[layer][row]`.
    holds: Vec<bool>,
    /// Radiance of each slot's hair (between `scatter` and `carry`) or mean radiance within it (after
    /// `carry`).
    rays: Vec<Block>,
    /// Its share of direct light.
    direct: Vec<Block>,
    /// Radiance of the skin of each slot.
    skins: Vec<Vec4>,
    ways: Vec<Way>,
}

/// Light along one direction.
#[derive(Clone, Debug, Default)]
struct Way {
    /// Unit direction in which light goes.
    direction: Vec3,
    /// From cell to cell, and its length over that of a cell.
    step: IVec3,
    length: f32,
    /// Effect of each slot on light.
    crossings: Vec<Crossing>,
    /// Radiance that leaves each cell: of all of them behind the last `carry`, of two layers else.
    leaving: Vec<Vec4>,
}

/// Effect of a cell on light along a direction.
#[derive(Clone, Copy, Debug, Default)]
struct Crossing {
    /// Shares that skin before and behind the hair lets through.
    before: f32,
    behind: f32,
    /// Share that goes through the hair, and its mean within it.
    passed: f32,
    mean: f32,
}

impl Carried {
    /// Lays slots for cells; what they show at first of straight light, of even light, and of skin.
    pub(crate) fn begin(
        &mut self,
        grid: &GridBox,
        cells: &[Cell],
        even: impl Fn(&Cell) -> Vec4 + Sync + Send,
        straight: impl Fn(&Cell) -> Rays + Sync + Send,
        skin: impl Fn(&Cell) -> Vec4 + Sync + Send,
    ) {
        self.slots.clear();
        self.slots.resize(grid.cell_count(), NONE);
        cells.iter().enumerate().for_each(|(slot, cell)| self.slots[cell.index] = slot as u32);
        self.holds.clear();
        self.holds.extend(self.slots.chunks(grid.counts[0]).map(|row| row.iter().any(|slot| *slot != NONE)));
        let blocks = cells.len().div_ceil(BLOCK);
        let empty = || [[Vec4::ZERO; BLOCK]; DIRECTIONS];
        self.rays.resize_with(blocks, empty);
        self.direct.resize_with(blocks, empty);
        let both = self.rays.par_iter_mut().zip(&mut self.direct).zip(cells.par_chunks(BLOCK));
        both.for_each(|((rays, direct), cells)| {
            for (at, cell) in cells.iter().enumerate() {
                let even = even(cell);
                for (way, shown) in straight(cell).into_iter().enumerate() {
                    (direct[way][at], rays[way][at]) = (shown, shown + even);
                }
            }
        });
        self.skins.clear();
        self.skins.par_extend(cells.par_iter().map(skin));
        self.ways.resize_with(DIRECTIONS, Way::default);
        self.ways.par_iter_mut().zip(directions()).for_each(|(way, (step, _))| {
            (way.step, way.length) = (step, step.as_vec3().length());
            way.direction = step.as_vec3() / way.length;
            way.leaving.resize(grid.cell_count(), Vec4::ZERO);
            let (direction, length) = (way.direction, way.length);
            way.crossings.clear();
            way.crossings.extend(cells.iter().map(|cell| Crossing::new(cell, direction, length)));
        });
    }

    /// Carries light along every direction through what the cells hold; what leaves each cell stays known of the `last`
    /// time. Else two layers are enough, which stay close to a processor.
    pub(crate) fn carry(&mut self, grid: &GridBox, around: &Field, last: bool) {
        let Self { slots, holds, rays, skins, ways, .. } = self;
        let mut parts: Vec<Vec<&mut [Vec4; BLOCK]>> = (0..DIRECTIONS).map(|_| Vec::new()).collect();
        for block in rays {
            parts.iter_mut().zip(block).for_each(|(part, rays)| part.push(rays));
        }
        parts.into_par_iter().zip(ways).for_each(|(mut rays, way)| {
            let outside = light_field::radiance(around, -way.direction);
            let (step, [columns, rows, layers]) = (way.step, grid.counts.map(|count| count as i32));
            let turned = |at: i32, count: i32, step: i32| if step < 0 { count - 1 - at } else { at };
            let inside = |at: i32, count: i32| (0..count).contains(&at);
            for z in (0..layers).map(|z| turned(z, layers, step.z)) {
                for y in (0..rows).map(|y| turned(y, rows, step.y)) {
                    let known = inside(z - step.z, layers) && inside(y - step.y, rows);
                    let first = |z: i32, y: i32| ((z * rows + y) * columns) as usize;
                    let layer = |z: i32| if last { z } else { z & 1 };
                    let row = Row {
                        first: first(layer(z), y),
                        columns: columns as usize,
                        from: known.then(|| first(layer(z - step.z), y - step.y)),
                        outside,
                    };
                    let cells = first(z, y);
                    if holds[cells / row.columns] {
                        let held = &slots[cells..][..row.columns];
                        way.cross(&row, held, |slot, crossing, arrived| {
                            crossing.cross(&mut rays[slot / BLOCK][slot % BLOCK], skins[slot], arrived)
                        });
                    } else {
                        way.pass(&row);
                    }
                }
            }
        });
    }

    /// Scatters the carried light by hair and skin.
    pub(crate) fn scatter(&mut self, cells: &[Cell], scene: &Scene) {
        let Self { rays, direct, skins, .. } = self;
        let both =
            rays.par_iter_mut().zip(direct).zip(cells.par_chunks(BLOCK)).zip(skins.par_chunks_mut(BLOCK));
        both.for_each(|(((rays, direct), cells), skins)| {
            for (at, (cell, skin)) in cells.iter().zip(skins).enumerate() {
                let carried: Rays = std::array::from_fn(|way| rays[way][at]);
                if cell.hair > 0.0 {
                    let mut shown: Rays = std::array::from_fn(|way| direct[way][at]);
                    scene.lattice.add_shown(cell.nearest, cell.order, &cell.mix, &carried, &mut shown);
                    rays.iter_mut().zip(shown).for_each(|(rays, shown)| rays[at] = shown);
                }
                if cell.skin != Vec3::ZERO {
                    *skin = (cell.skin_light + on_skin(cell.skin, &carried, scene)) * cell.skin_color;
                }
            }
        });
    }

    /// The slot of a cell.
    pub(crate) fn slot(&self, index: usize) -> Option<usize> {
        let slot = self.slots[index];
        (slot != NONE).then_some(slot as usize)
    }

    /// Light along every direction in a cell.
    pub(crate) fn rays(&self, index: usize) -> Rays {
        match self.slot(index) {
            Some(slot) => std::array::from_fn(|way| self.rays[slot / BLOCK][way][slot % BLOCK]),
            None => std::array::from_fn(|way| self.ways[way].leaving[index]),
        }
    }
}

/// Light along every direction that meets skin, of an area times its normal, as radiance of a white surface.
fn on_skin(skin: Vec3, rays: &Rays, scene: &Scene) -> Vec4 {
    let normal = skin.normalize_or_zero();
    let (mut met, mut whole) = (Vec4::ZERO, 1e-12);
    for (light, (way, share)) in rays.iter().zip(scene.lattice.ways()) {
        let weight = share * (-normal.dot(*way)).max(0.0);
        met += *light * weight;
        whole += weight;
    }
    met / whole
}

/// A row of cells along x.
struct Row {
    /// Index of the light that leaves its first cell, and the number of its cells.
    first: usize,
    columns: usize,
    /// The same of the row that light comes from, which may be this one; none where that is outside the grid.
    from: Option<usize>,
    /// Light from outside.
    outside: Vec4,
}

impl Way {
    /// Carries light through a row that holds something: in a slot `leaves` says what does of what arrives.
    #[inline]
    fn cross(&mut self, row: &Row, held: &[u32], mut leaves: impl FnMut(usize, &Crossing, Vec4) -> Vec4) {
        let (aside, crossings) = (self.step.x, &self.crossings);
        let mut leaves = |slot: u32, arrived: Vec4| match slot {
            NONE => arrived,
            slot => leaves(slot as usize, &crossings[slot as usize], arrived),
        };
        if row.from == Some(row.first) {
            let mut arrived = row.outside;
            for at in 0..row.columns {
                let column = if aside < 0 { row.columns - 1 - at } else { at };
                arrived = leaves(held[column], arrived);
                self.leaving[row.first + column] = arrived;
            }
            return;
        }
        let (from, to) = two_rows(&mut self.leaving, row);
        for (column, (to, slot)) in to.iter_mut().zip(held).enumerate() {
            // Before the first there is none, as there is none behind the last.
            let arrived = from.get(column.wrapping_sub(aside as usize));
            *to = leaves(*slot, arrived.copied().unwrap_or(row.outside));
        }
    }

    /// Carries light through a row that holds nothing.
    fn pass(&mut self, row: &Row) {
        let aside = self.step.x;
        let (from, to) = two_rows(&mut self.leaving, row);
        if from.is_empty() {
            return to.fill(row.outside);
        }
        let count = row.columns - aside.unsigned_abs() as usize;
        let [from_first, to_first] = [(-aside).max(0), aside.max(0)].map(|first| first as usize);
        to[to_first..][..count].copy_from_slice(&from[from_first..][..count]);
        match aside {
            1 => to[0] = row.outside,
            -1 => to[row.columns - 1] = row.outside,
            _ => {}
        }
    }
}

/// The row that light comes from, empty where that is the same one or outside the grid, and the row itself.
fn two_rows<'a>(leaving: &'a mut [Vec4], row: &Row) -> (&'a [Vec4], &'a mut [Vec4]) {
    match row.from {
        Some(from) if from < row.first => {
            let (low, high) = leaving.split_at_mut(row.first);
            (&low[from..][..row.columns], &mut high[..row.columns])
        }
        Some(from) if from > row.first => {
            let (low, high) = leaving.split_at_mut(from);
            (&high[..row.columns], &mut low[row.first..][..row.columns])
        }
        _ => (&[], &mut leaving[row.first..][..row.columns]),
    }
}

impl Crossing {
    fn new(cell: &Cell, direction: Vec3, length: f32) -> Self {
        let facing = cell.skin.dot(direction);
        let bare = exp(-SKIN_EXTINCTION * length * facing.abs());
        // Skin that light goes toward lies behind the hair, skin that it comes from before it.
        let (before, behind) = if facing > 0.0 { (bare, 1.0) } else { (1.0, bare) };
        let sine = cell.tangent.dot(direction);
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let depth = cell.hair * length * (cell.order * cosine + (1.0 - cell.order) * MEAN_COSINE);
        if depth < THIN {
            let mean = 1.0 - 0.5 * depth;
            return Self { before, behind, passed: 1.0 - depth * mean, mean };
        }
        let passed = exp(-depth);
        Self { before, behind, passed, mean: (1.0 - passed) / depth }
    }

    /// Light that leaves the cell, by the light that arrives. Replaces the radiance of its hair by the mean
    /// radiance in it. The inside of the body is as bright as its skin, so that places between cells inside
    /// and outside are not dark.
    #[inline]
    fn cross(&self, ray: &mut Vec4, skin: Vec4, arrived: Vec4) -> Vec4 {
        let shown = *ray;
        let over = skin + (arrived - skin) * self.before - shown;
        *ray = shown + over * self.mean;
        let left = shown + over * self.passed;
        skin + (left - skin) * self.behind
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_hair_dims_light_as_the_exponential_says() {
        for step in 0..160 {
            let depth = 10.0_f64.powf(-8.0 + 0.05 * f64::from(step));
            let cell = Cell { hair: depth as f32, tangent: Vec3::Y, order: 1.0, ..Cell::default() };
            let Crossing { passed, mean, .. } = Crossing::new(&cell, Vec3::X, 1.0);
            let exact = (-depth).exp();
            assert!((f64::from(passed) - exact).abs() < 3e-6, "{depth}: {passed} {exact}");
            let exact = -(-depth).exp_m1() / depth;
            assert!((f64::from(mean) - exact).abs() < 2e-4, "{depth}: {mean} {exact}");
        }
    }
}
