//! Light that hair and skin scatter many times, in the cells of a grid: part of `shade`.
//!
//! Hair is summed into cells with its mean direction, skin with its normal. Radiance is carried from cell to cell
//! along 26 directions; what a cell's hair takes away it gives back as the fibre does, what skin takes away as a
//! matte surface does, once more with every round. What is found holds all light but that which comes straight from
//! a light.

use glam::{IVec3, Vec3, Vec4};
use rayon::prelude::*;

use super::fast_math::exp;
use super::lattice::{DIRECTIONS, Lattice, Rays, directions};
use super::light_field::{self, Field};
use super::light_sums::{HAIR_SUMS, SKIN_SUMS, UNITS, sum};
use super::occlusion::{GridBox, Occlusion, toward};
use super::{ShadowBody, Shadows, Strands};
use crate::{Environment, Light};

/// Mean cosine between random hairs and the plane across a direction.
const MEAN_COSINE: f32 = std::f32::consts::FRAC_PI_4;
/// Most by which hair shows more than the field says.
const MOST_CORRECTION: f32 = 4.0;
/// How much less light skin lets through than cells that are evenly filled with it would.
const SKIN_EXTINCTION: f32 = 4.0;

/// What lies in a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    /// Area of its hair, full width times length, over that of a face.
    hair: f32,
    /// Mean direction of the hair, of unit length.
    tangent: Vec3,
    /// Share of the hair that has it; the rest lies every way.
    order: f32,
    /// Area of skin over that of a face, times its normal.
    skin: Vec3,
    /// Light that skin meets straight from lights, as radiance of a white surface.
    skin_light: Vec4,
    /// Radiance of the skin.
    skin_shown: Vec4,
    /// The lattice's number of the tangent.
    nearest: usize,
}

/// Scattered light around and in the hair.
#[derive(Clone, Debug, Default)]
pub struct LightGrid {
    grid: GridBox,
    parts: Vec<Vec<i64>>,
    cells: Vec<Cell>,
    /// What each cell's hair shows along every direction of straight light.
    direct: Vec<Rays>,
    /// All light but the straight one.
    fields: Vec<Field>,
    /// What hair of each cell's tangent shows toward the eye of that light, and what the field alone says of it.
    toward_eye: Vec<[Vec4; 2]>,
    carried: Vec<Carried>,
}

/// Light along one direction, shape `[cell]`.
#[derive(Clone, Debug, Default)]
struct Carried {
    /// Mean radiance within each cell's hair.
    mean: Vec<Vec4>,
    /// Radiance that leaves it.
    leaving: Vec<Vec4>,
    /// What its hair shows.
    shown: Vec<Vec4>,
}

/// What light is scattered by.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// All drawn hair.
    pub strands: &'a Strands,
    /// Share of each shadow light that reaches every point of it, shape `[light][point]`; empty for the others.
    pub reached: &'a [Vec<f32>],
    /// The body and the reflectance of its skin.
    pub body: Option<(ShadowBody<'a>, Vec3)>,
    /// Shadows of the same lights.
    pub shadows: &'a Shadows,
    /// How much of the surroundings hair hides; its grid is taken.
    pub occlusion: &'a Occlusion,
    /// The lights.
    pub lights: &'a [Light],
    /// Light from all around.
    pub environment: &'a Environment,
    /// The fibre's scattering among directions.
    pub lattice: &'a Lattice,
    /// Where the camera stands \[m\], world space.
    pub eye: Vec3,
    /// Mean multiple of the pigment.
    pub pigment: f32,
    /// How many times light is scattered.
    pub rounds: u32,
}

impl LightGrid {
    /// Sums hair and skin, and carries light through them.
    pub fn fill(&mut self, scene: &Scene) {
        self.grid = scene.occlusion.grid();
        sum(&self.grid, scene, &mut self.parts);
        self.prepare(scene);
        let cells = self.cells.len();
        self.fields.clear();
        self.toward_eye.clear();
        self.carried.resize_with(DIRECTIONS, Carried::default);
        let around = scene.environment.radiance(Vec3::X).extend(0.0);
        let albedo = scene.lattice.albedo();
        let color = scene.body.map_or(Vec3::ZERO, |(_, color)| color).extend(0.0);
        self.cells.iter_mut().for_each(|cell| cell.skin_shown = (cell.skin_light + around) * color);
        for (way, carried) in self.carried.iter_mut().enumerate() {
            carried.mean.resize(cells, Vec4::ZERO);
            carried.leaving.resize(cells, Vec4::ZERO);
            carried.shown.clear();
            // As if the surroundings reached every hair: even light is found at once.
            carried.shown.extend(self.direct.iter().map(|direct| direct[way] + around * albedo));
        }
        for _ in 0..scene.rounds {
            self.carry(scene);
            self.scatter(scene);
        }
        self.carry(scene);
        self.gather(scene);
    }

    /// Scattered light at a place \[m\], and by how much more of it hair shows toward the eye than the field says.
    #[inline]
    pub fn field(&self, place: Vec3) -> (Field, Vec4) {
        let mut sum = Field::default();
        let mut shown = [Vec4::ZERO; 2];
        if self.fields.is_empty() || !place.is_finite() {
            return (sum, Vec4::ONE);
        }
        let (first, part) = self.grid.place(place);
        let [columns, rows, _] = self.grid.counts;
        for corner in 0..8 {
            let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
            let side = |part: f32, upper: usize| if upper == 1 { part } else { 1.0 - part };
            let weight = side(part.x, dx) * side(part.y, dy) * side(part.z, dz);
            let cell = first + (dz * rows + dy) * columns + dx;
            for (sum, field) in sum.iter_mut().zip(&self.fields[cell]) {
                *sum += *field * weight;
            }
            for (sum, shown) in shown.iter_mut().zip(self.toward_eye[cell]) {
                *sum += shown * weight;
            }
        }
        let ratio = shown[0] / shown[1].max(Vec4::splat(1e-12));
        (sum, ratio.min(Vec4::splat(MOST_CORRECTION)))
    }

    /// Light that meets skin of unit normal at a point \[m\] but straight from lights, as radiance of a white surface.
    pub fn on_skin(&self, point: Vec3, normal: Vec3) -> Vec3 {
        // Cells half inside the body know no light from there.
        light_field::on_surface(&self.field(point + normal * self.grid.cell).0, normal).truncate()
    }

    /// What each cell holds, from the sums; the straight light that its hair meets.
    fn prepare(&mut self, scene: &Scene) {
        let (grid, parts) = (self.grid, &self.parts);
        let width = HAIR_SUMS + scene.lights.len() + SKIN_SUMS;
        let scale = 1.0 / (UNITS * grid.cell * grid.cell);
        let skin_sums = width - SKIN_SUMS;
        self.cells.resize(grid.cell_count(), Cell::default());
        self.direct.resize(grid.cell_count(), Rays::default());
        let albedo = scene.lattice.albedo();
        let both = self.cells.par_iter_mut().zip(self.direct.par_iter_mut());
        both.enumerate().for_each(|(index, (cell, direct))| {
            let number = |at: usize| {
                let whole: i64 = parts.iter().map(|part| part[index * width + at]).sum();
                whole as f32 * scale
            };
            let vector = |at: usize| Vec3::new(number(at), number(at + 1), number(at + 2));
            *cell = Cell { hair: number(0), skin: vector(skin_sums), ..Cell::default() };
            *direct = Rays::default();
            if cell.hair > 0.0 {
                let mean = vector(1) / cell.hair;
                cell.tangent = mean.normalize_or(Vec3::Y);
                cell.order = mean.length_squared().min(1.0);
                cell.nearest = scene.lattice.nearest(cell.tangent);
                let middle = grid.middle(index);
                let cube = scene.occlusion.cube(middle);
                for (light, source) in scene.lights.iter().enumerate() {
                    let lit = source.at(middle);
                    let share = if source.shadow {
                        number(HAIR_SUMS + light) / cell.hair
                    } else {
                        toward(&cube, lit.to_light)
                    };
                    let light = lit.radiance * share;
                    scene.lattice.add_light(cell.tangent, lit.to_light, light * cell.order, direct);
                    // Irradiance, pi times the radiance, over the whole sphere.
                    let even = albedo * light.extend(0.0) * (0.25 * (1.0 - cell.order));
                    direct.iter_mut().for_each(|shown| *shown += even);
                }
            }
            let skin = cell.skin.length();
            if skin > 0.0 {
                cell.skin_light = vector(skin_sums + 3).extend(0.0) / skin;
            }
        });
    }

    /// Carries light along every direction through what the cells hold.
    fn carry(&mut self, scene: &Scene) {
        let (grid, cells) = (self.grid, &self.cells);
        let directions = directions();
        self.carried.par_iter_mut().zip(directions).for_each(|(carried, (step, _))| {
            let way = Way::new(scene, step);
            let [columns, rows, layers] = grid.counts.map(|count| count as i32);
            let turned = |at: i32, count: i32, step: i32| if step < 0 { count - 1 - at } else { at };
            let inside = |at: i32, count: i32| (0..count).contains(&at);
            let back = (step.z * rows + step.y) * columns + step.x;
            for z in (0..layers).map(|z| turned(z, layers, step.z)) {
                for y in (0..rows).map(|y| turned(y, rows, step.y)) {
                    let known = inside(z - step.z, layers) && inside(y - step.y, rows);
                    for x in (0..columns).map(|x| turned(x, columns, step.x)) {
                        let index = (z * rows + y) * columns + x;
                        let arrived = if known && inside(x - step.x, columns) {
                            carried.leaving[(index - back) as usize]
                        } else {
                            way.outside
                        };
                        let index = index as usize;
                        let [mean, leaving] = way.cross(&cells[index], carried.shown[index], arrived);
                        carried.mean[index] = mean;
                        carried.leaving[index] = leaving;
                    }
                }
            }
        });
    }

    /// Light along every direction in a cell.
    fn rays(&self, index: usize) -> Rays {
        std::array::from_fn(|way| self.carried[way].mean[index])
    }

    /// What hair and skin show of what was carried.
    fn scatter(&mut self, scene: &Scene) {
        let color = scene.body.map_or(Vec3::ZERO, |(_, color)| color).extend(0.0);
        let shown: Vec<Option<(Rays, Vec4)>> = self
            .cells
            .par_iter()
            .enumerate()
            .map(|(index, cell)| {
                let skin = cell.skin.length();
                if cell.hair == 0.0 && skin == 0.0 {
                    return None;
                }
                let rays = self.rays(index);
                let mut shown = self.direct[index];
                if cell.hair > 0.0 {
                    scene.lattice.add_shown(cell.nearest, cell.order, &rays, &mut shown);
                }
                let normal = cell.skin / skin.max(1e-12);
                let mut met = Vec4::ZERO;
                let mut whole = 1e-12;
                for (light, (way, share)) in rays.iter().zip(scene.lattice.ways()) {
                    let weight = share * (-normal.dot(*way)).max(0.0);
                    met += *light * weight;
                    whole += weight;
                }
                let on_skin = cell.skin_light + met / whole;
                Some((shown, on_skin * color))
            })
            .collect();
        for (index, shown) in shown.into_iter().enumerate() {
            let Some((shown, skin)) = shown else { continue };
            self.cells[index].skin_shown = skin;
            self.carried.iter_mut().zip(shown).for_each(|(carried, shown)| carried.shown[index] = shown);
        }
    }

    /// Sums what was carried into fields, and finds what hair shows toward the eye.
    fn gather(&mut self, scene: &Scene) {
        let (grid, this) = (self.grid, &*self);
        let found: Vec<(Field, [Vec4; 2])> = (0..self.cells.len())
            .into_par_iter()
            .map(|index| {
                let (cell, rays) = (&this.cells[index], this.rays(index));
                let mut field = Field::default();
                for (light, (way, share)) in rays.iter().zip(scene.lattice.ways()) {
                    light_field::add(&mut field, -*way, *light * *share);
                }
                if cell.hair == 0.0 {
                    return (field, [Vec4::ZERO; 2]);
                }
                let to_eye = (scene.eye - grid.middle(index)).normalize_or(Vec3::Z);
                let weights = scene.lattice.weights(cell.tangent, to_eye);
                let shown =
                    rays.iter().zip(weights).fold(Vec4::ZERO, |sum, (ray, weight)| sum + *ray * weight);
                let moments = scene.lattice.table().moments(cell.tangent.dot(to_eye), scene.pigment);
                let u = light_field::across(cell.tangent, to_eye);
                let known = light_field::shown(&field, &moments, cell.tangent, u);
                // Weighted with the cell's hair: empty cells have no say.
                (field, [shown * cell.hair, known * cell.hair])
            })
            .collect();
        (self.fields, self.toward_eye) = found.into_iter().unzip();
    }
}

/// Light along one direction.
struct Way {
    /// Unit direction in which light goes.
    direction: Vec3,
    /// Length of a step over that of a cell.
    length: f32,
    /// Radiance where the grid ends.
    outside: Vec4,
}

impl Way {
    fn new(scene: &Scene, step: IVec3) -> Self {
        let length = step.as_vec3().length();
        let direction = step.as_vec3() / length;
        let outside = scene.environment.radiance(-direction).extend(0.0);
        Self { direction, length, outside }
    }

    /// Mean radiance in a cell and what leaves it.
    #[inline]
    fn cross(&self, cell: &Cell, shown: Vec4, arrived: Vec4) -> [Vec4; 2] {
        let facing = cell.skin.dot(self.direction);
        if cell.hair == 0.0 && facing == 0.0 {
            return [arrived; 2];
        }
        let bare = exp(-SKIN_EXTINCTION * self.length * facing.abs());
        // Skin that light goes toward lies behind the hair, skin that it comes from before it. The inside of the body
        // is as bright as its skin, so that places between cells within and without are not dark.
        let cross_skin = |light: Vec4| light * bare + cell.skin_shown * (1.0 - bare);
        let [mean, left] =
            self.cross_hair(cell, shown, if facing > 0.0 { cross_skin(arrived) } else { arrived });
        [mean, if facing > 0.0 { left } else { cross_skin(left) }]
    }

    #[inline]
    fn cross_hair(&self, cell: &Cell, shown: Vec4, entered: Vec4) -> [Vec4; 2] {
        if cell.hair == 0.0 {
            return [entered; 2];
        }
        let sine = cell.tangent.dot(self.direction);
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let depth = cell.hair * self.length * (cell.order * cosine + (1.0 - cell.order) * MEAN_COSINE);
        if depth < 1e-6 {
            return [entered; 2];
        }
        let passed = exp(-depth);
        let mean = shown + (entered - shown) * ((1.0 - passed) / depth);
        [mean, shown + (entered - shown) * passed]
    }
}
