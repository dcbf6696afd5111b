//! Light on its way through the cells of a grid, and what they scatter of it: part of `light_grid`.

use glam::{IVec3, Vec3, Vec4};
use strandline_base::par::prelude::*;

use super::light_scene::{Cell, Scene};
use super::occlusion::GridBox;
use crate::fast_math::exp;
use crate::light_field::{self, Field};
use crate::scatter::lattice::Lattice;
use crate::scatter::ways::{DIRECTIONS, Lines, Rays, SETS};

/// Mean cosine between random hairs and the plane across a direction.
pub(super) const MEAN_COSINE: f32 = std::f32::consts::FRAC_PI_4;
/// Attenuation of light by skin, relative to cells that are evenly filled with it.
const SKIN_EXTINCTION: f32 = 4.0;
/// Optical depth of hair below which the rounding of an exponential would show in the mean radiance of a cell.
const THIN: f32 = 1e-2;
/// Slots that lie together.
const BLOCK: usize = 64;
/// No slot.
const NONE: u32 = u32::MAX;
/// Directions of which no two are opposite.
const HALF: usize = DIRECTIONS / 2;

/// Light of [`BLOCK`] slots, shape `[direction][slot]`.
type Block = [[Vec4; BLOCK]; DIRECTIONS];

/// Light carried through cells. Those that hold something have a slot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Carried {
    counts: IVec3,
    /// The slot of each cell.
    slots: Vec<u32>,
    /// The slots in order along each axis.
    orders: [Vec<u32>; 3],
    /// Radiance of the skin of each slot.
    skins: Vec<Vec4>,
    sets: [Rayed; SETS],
}

/// Light along the directions of a set.
#[derive(Clone, Debug, Default)]
struct Rayed {
    /// Radiance of each slot's hair (between `scatter` and `carry`) or mean radiance within it (after `carry`).
    rays: Vec<Block>,
    /// Its share of direct light.
    direct: Vec<Block>,
    /// Effect of each slot on light along the first half of the directions.
    crossings: Vec<Vec<Crossing>>,
    ways: Vec<Way>,
}

/// Light along one direction.
#[derive(Clone, Debug, Default)]
struct Way {
    /// Unit direction in which light goes.
    direction: Vec3,
    lines: Lines,
    before: Before,
    /// Radiance that leaves each slot.
    leaving: Vec<Vec4>,
}

/// The slot before each one along its line; none where there is nothing before.
#[derive(Clone, Debug, Default)]
struct Before {
    slots: Vec<u32>,
    /// The last slot of each line, while slots are gone through.
    last: Vec<u32>,
}

impl Before {
    /// Goes through slots, given as cells and as an order along the axis of the lines.
    fn fill(&mut self, cells: &[Cell], order: &[u32], lines: &Lines, counts: IVec3) {
        let [axis, first, second] = [0, 1, 2].map(|more| (lines.axis + more) % 3);
        let asides: Vec<[i32; 2]> = (0..counts[axis]).map(|number| lines.aside(number)).collect();
        // Numbers of lines aside: a line that enters beside the first plane has a number below 0 or beyond the cells.
        let farthest = asides.last().copied().unwrap_or_default();
        let [low, high] =
            [0, 1].map(|side| farthest.map(|far| if side == 0 { far.max(0) } else { (-far).max(0) }));
        let width = counts[first] + low[0] + high[0];
        let height = counts[second] + low[1] + high[1];
        self.last.clear();
        self.last.resize((width * height) as usize, NONE);
        self.slots.resize(cells.len(), NONE);
        let (last, slots) = (&mut self.last, &mut self.slots);
        let mut pass = |slot: &u32| {
            let index = cells[*slot as usize].index as i32;
            let at = IVec3::new(index % counts.x, index / counts.x % counts.y, index / counts.x / counts.y);
            let [aside, down] = asides[lines.plane(at[axis], counts[axis]) as usize];
            let line = (at[second] - down + low[1]) * width + at[first] - aside + low[0];
            slots[*slot as usize] = std::mem::replace(&mut last[line as usize], *slot);
        };
        if lines.is_backward() { order.iter().rev().for_each(pass) } else { order.iter().for_each(&mut pass) }
    }
}

/// Effect of a cell on light along a direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Crossing {
    /// Shares that skin before and behind the hair lets through.
    before: f32,
    behind: f32,
    /// Share that goes through the hair, and its mean within it.
    passed: f32,
    mean: f32,
}

impl Carried {
    /// Lays slots for cells, which come in the order of their indices.
    pub(crate) fn lay(&mut self, grid: &GridBox, cells: &[Cell]) {
        let counts = grid.counts;
        self.counts = IVec3::from_array(counts.map(|count| count as i32));
        self.slots.clear();
        self.slots.resize(grid.cell_count(), NONE);
        cells.iter().enumerate().for_each(|(slot, cell)| self.slots[cell.index] = slot as u32);
        let strides = [1, counts[0], counts[0] * counts[1]];
        for (axis, order) in self.orders.iter_mut().enumerate() {
            order.clear();
            order.extend(0..cells.len() as u32);
            order.sort_by_key(|slot| cells[*slot as usize].index / strides[axis] % counts[axis]);
        }
    }

    /// Sets what cells with slots show at first: straight light along each set, even light, and skin.
    pub(crate) fn begin(
        &mut self,
        cells: &[Cell],
        lattice: &Lattice,
        even: impl Fn(&Cell) -> Vec4 + Sync + Send,
        straight: impl Fn(&Cell) -> [Rays; SETS] + Sync + Send,
        skin: impl Fn(&Cell) -> Vec4 + Sync + Send,
    ) {
        let blocks = cells.len().div_ceil(BLOCK);
        let empty = || [[Vec4::ZERO; BLOCK]; DIRECTIONS];
        for set in &mut self.sets {
            set.rays.resize_with(blocks, empty);
            set.direct.resize_with(blocks, empty);
        }
        let [one, other] = &mut self.sets;
        let rays = one.rays.par_iter_mut().zip(&mut other.rays);
        let direct = one.direct.par_iter_mut().zip(&mut other.direct);
        rays.zip(direct).zip(cells.par_chunks(BLOCK)).for_each(|((rays, direct), cells)| {
            let (rays, direct) = ([rays.0, rays.1], [direct.0, direct.1]);
            for (at, cell) in cells.iter().enumerate() {
                let even = even(cell);
                for (set, straight) in straight(cell).into_iter().enumerate() {
                    for (way, shown) in straight.into_iter().enumerate() {
                        (direct[set][way][at], rays[set][way][at]) = (shown, shown + even);
                    }
                }
            }
        });
        self.skins.clear();
        self.skins.par_extend(cells.par_iter().map(skin));
        for set in 0..SETS {
            self.lay_ways(set, cells, lattice);
        }
    }

    /// Lays the lines of cells along every direction of a set.
    fn lay_ways(&mut self, set: usize, cells: &[Cell], lattice: &Lattice) {
        let (orders, counts) = (&self.orders, self.counts);
        let Rayed { crossings, ways, .. } = &mut self.sets[set];
        ways.resize_with(DIRECTIONS, Way::default);
        ways.par_iter_mut().zip(lattice.ways(set)).for_each(|(way, (direction, _))| {
            (way.direction, way.lines) = (*direction, Lines::new(*direction));
            way.leaving.resize(cells.len(), Vec4::ZERO);
            way.before.fill(cells, &orders[way.lines.axis], &way.lines, counts);
        });
        crossings.resize_with(HALF, Vec::new);
        crossings.par_iter_mut().zip(ways).for_each(|(crossings, way)| {
            crossings.clear();
            let of = |cell: &Cell| Crossing::new(cell, way.direction, way.lines.length);
            crossings.extend(cells.iter().map(of));
        });
    }

    /// Carries light along every direction of a set through what the cells hold.
    pub(crate) fn carry(&mut self, set: usize, around: &Field) {
        let Self { orders, skins, sets, .. } = self;
        let Rayed { rays, crossings, ways, .. } = &mut sets[set];
        let mut parts: Vec<Vec<&mut [Vec4; BLOCK]>> = (0..DIRECTIONS).map(|_| Vec::new()).collect();
        for block in rays {
            parts.iter_mut().zip(block).for_each(|(part, rays)| part.push(rays));
        }
        parts.into_par_iter().zip(ways).enumerate().for_each(|(number, (mut rays, way))| {
            let outside = light_field::radiance(around, -way.direction);
            let opposite = number >= HALF;
            let crossings = &crossings[if opposite { DIRECTIONS - 1 - number } else { number }];
            let Way { lines, before, leaving, .. } = way;
            let order = &orders[lines.axis];
            for number in 0..order.len() {
                let number = if lines.is_backward() { order.len() - 1 - number } else { number };
                let slot = order[number] as usize;
                let arrived = leaving.get(before.slots[slot] as usize).copied().unwrap_or(outside);
                let ray = &mut rays[slot / BLOCK][slot % BLOCK];
                leaving[slot] = crossings[slot].turned(opposite).cross(ray, skins[slot], arrived);
            }
        });
    }

    /// Scatters the light that was carried along a set by hair, toward the next set, and skin.
    pub(crate) fn scatter(&mut self, set: usize, cells: &[Cell], scene: &Scene) {
        let [one, other] = &mut self.sets;
        let (from, to) = if set == 0 { (one, other) } else { (other, one) };
        let both = from.rays.par_iter().zip(&mut to.rays).zip(&to.direct);
        let cells = cells.par_chunks(BLOCK).zip(self.skins.par_chunks_mut(BLOCK));
        both.zip(cells).for_each(|(((from, to), direct), (cells, skins))| {
            for (at, (cell, skin)) in cells.iter().zip(skins).enumerate() {
                let carried: Rays = std::array::from_fn(|way| from[way][at]);
                if cell.hair > 0.0 {
                    let mut shown: Rays = std::array::from_fn(|way| direct[way][at]);
                    let kind = (cell.order, &cell.mix);
                    scene.lattice.add_shown(set, cell.nearest, kind, &carried, &mut shown);
                    to.iter_mut().zip(shown).for_each(|(rays, shown)| rays[at] = shown);
                }
                if cell.skin != Vec3::ZERO {
                    *skin = (cell.skin_light + on_skin(cell.skin, &carried, set, scene)) * cell.skin_color;
                }
            }
        });
    }

    /// The slot of a cell.
    pub(crate) fn slot(&self, index: usize) -> Option<usize> {
        let slot = self.slots[index];
        (slot != NONE).then_some(slot as usize)
    }

    /// Share of light that hair and skin let through on average to the hair of each slot, if it comes along a direction.
    pub(super) fn reached(&self, cells: &[Cell], direction: Vec3) -> Vec<f32> {
        let lines = Lines::new(direction);
        let (mut leaving, mut found) = (vec![0.0; cells.len()], vec![0.0; cells.len()]);
        let order = &self.orders[lines.axis];
        let mut before = Before::default();
        before.fill(cells, order, &lines, self.counts);
        let mut cross = |slot: &u32| {
            let cell = &cells[*slot as usize];
            let arrived = leaving.get(before.slots[*slot as usize] as usize).copied().unwrap_or(1.0);
            let Crossing { before, behind, passed, mean } = Crossing::new(cell, direction, lines.length);
            found[*slot as usize] = arrived * before * mean;
            leaving[*slot as usize] = arrived * before * passed * behind;
        };
        if lines.is_backward() {
            order.iter().rev().for_each(cross)
        } else {
            order.iter().for_each(&mut cross)
        }
        found
    }

    /// Light along every direction of a set in a cell, of the last time that it was carried along these.
    pub(crate) fn rays(&self, set: usize, index: usize, around: &Field) -> Rays {
        let Rayed { rays, ways, .. } = &self.sets[set];
        match self.slot(index) {
            Some(slot) => std::array::from_fn(|way| rays[slot / BLOCK][way][slot % BLOCK]),
            None => std::array::from_fn(|way| {
                let way = &ways[way];
                let before = before(&self.slots, self.counts, &way.lines, index) as usize;
                let outside = || light_field::radiance(around, -way.direction);
                way.leaving.get(before).copied().unwrap_or_else(outside)
            }),
        }
    }
}

/// The slot that light along lines meets last before it comes to a cell.
fn before(slots: &[u32], counts: IVec3, lines: &Lines, index: usize) -> u32 {
    let index = index as i32;
    let mut at = IVec3::new(index % counts.x, index / counts.x % counts.y, index / counts.x / counts.y);
    let first = lines.plane(at[lines.axis], counts[lines.axis]);
    for number in (1..=first).rev() {
        at -= lines.step(number);
        if at.cmplt(IVec3::ZERO).any() || at.cmpge(counts).any() {
            break;
        }
        let slot = slots[((at.z * counts.y + at.y) * counts.x + at.x) as usize];
        if slot != NONE {
            return slot;
        }
    }
    NONE
}

/// Light along every direction of a set that meets skin, of an area times its normal, as radiance of a white surface.
fn on_skin(skin: Vec3, rays: &Rays, set: usize, scene: &Scene) -> Vec4 {
    let normal = skin.normalize_or_zero();
    let (mut met, mut whole) = (Vec4::ZERO, 1e-12);
    for (light, (way, share)) in rays.iter().zip(scene.lattice.ways(set)) {
        let weight = share * (-normal.dot(*way)).max(0.0);
        met += *light * weight;
        whole += weight;
    }
    met / whole
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

    /// The same along the opposite direction, if that is asked for.
    #[inline]
    fn turned(&self, opposite: bool) -> Self {
        let Self { before, behind, .. } = *self;
        if opposite { Self { before: behind, behind: before, ..*self } } else { *self }
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
    fn the_slot_before_another_is_the_last_along_its_line() {
        let counts = [9, 14, 11];
        let grid = GridBox { min: Vec3::ZERO, cell: 1.0, counts };
        let mut cells = Vec::new();
        for index in 0..counts.iter().product() {
            if strandline_base::Random::new(2, index as u64).unit() < 0.3 {
                cells.push(Cell { index, ..Cell::default() });
            }
        }
        let mut carried = Carried::default();
        carried.lay(&grid, &cells);
        for (way, _) in (0..SETS).flat_map(crate::scatter::ways::directions) {
            let (lines, mut found) = (Lines::new(way), Before::default());
            found.fill(&cells, &carried.orders[lines.axis], &lines, carried.counts);
            let walked = cells.iter().map(|cell| before(&carried.slots, carried.counts, &lines, cell.index));
            assert!(found.slots.iter().copied().eq(walked), "{way}");
        }
    }

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
