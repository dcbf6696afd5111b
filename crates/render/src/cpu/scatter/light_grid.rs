//! Light that hair and skin scatter many times, in the cells of a grid: part of `shade`.
//!
//! Hair is summed into cells with its mean direction, skin with its normal. Radiance is carried from cell to cell
//! along directions of two sets that take turns; what a cell's hair takes away it gives back as the fibre does, what skin takes away as a
//! matte surface does, once more with every round. The sum holds all light but that which comes straight from
//! a light.

use std::sync::{Arc, OnceLock};

use glam::{Vec3, Vec4};
use strandline_base::par::prelude::*;

use super::light_carry::Carried;
use super::light_scale::light_scales;
use super::light_scene::{Cell, Scene};
use super::light_sums::{HAIR_SUMS, SKIN_SUMS, UNITS, sum};
use super::occlusion::{GridBox, toward};
use crate::light_field::{self, Field};
use crate::scatter::lattice::{ALL_DARK, Lattice};
use crate::scatter::ways::{DIRECTIONS, Rays, SETS};

/// Cosine of the angle between lights that are taken for one where straight light enters the grid.
const ONE_BEAM: f32 = 0.985;
/// Most by which hair shows more than the field says.
const MOST_CORRECTION: f32 = 4.0;

/// Scattered light around and in the hair.
#[derive(Clone, Debug, Default)]
pub struct LightGrid {
    grid: GridBox,
    parts: Vec<Vec<i64>>,
    /// The cells that hold something, in order.
    cells: Vec<Cell>,
    carried: Carried,
    toward: Option<Toward>,
    /// Of each cell, found when a place beside it is looked at: much hair is behind other hair.
    found: Vec<OnceLock<CellLight>>,
}

/// Whom light is found for, and how hair scatters it.
#[derive(Clone, Debug)]
struct Toward {
    lattice: Arc<Lattice>,
    eye: Vec3,
    around: Field,
    /// Number of sets along which light was carried; the mean of these is shown.
    sets: usize,
}

/// All light but the straight one in a cell; what hair of its tangent shows toward the eye of it, and what the field
/// alone says of that.
type CellLight = (Field, [Vec4; 2]);

impl LightGrid {
    /// Sums hair and skin, and carries light through them.
    pub fn fill(&mut self, scene: &Scene) {
        self.grid = scene.occlusion.grid();
        sum(&self.grid, scene, &mut self.parts);
        self.prepare(scene);
        // The last one is the first set's.
        for round in (1..=scene.rounds as usize).rev() {
            self.carried.carry(round % SETS, &scene.around);
            self.carried.scatter(round % SETS, &self.cells, scene);
        }
        self.carried.carry(0, &scene.around);
        let sets = SETS.min(scene.rounds as usize + 1);
        let (lattice, eye, around) = (scene.lattice.clone(), scene.eye, scene.around);
        self.toward = Some(Toward { lattice, eye, around, sets });
        self.found.clear();
        self.found.resize_with(self.grid.cell_count(), OnceLock::new);
    }

    /// Scattered light at a place \[m\], and by how much more of it hair shows toward the eye than the field says.
    #[inline]
    pub fn field(&self, place: Vec3) -> (Field, Vec4) {
        let mut sum = Field::default();
        let mut shown = [Vec4::ZERO; 2];
        if self.found.is_empty() || !place.is_finite() {
            return (sum, Vec4::ONE);
        }
        let (first, part) = self.grid.place(place);
        let [columns, rows, _] = self.grid.counts;
        for corner in 0..8 {
            let (dx, dy, dz) = (corner & 1, corner >> 1 & 1, corner >> 2);
            let side = |part: f32, upper: usize| if upper == 1 { part } else { 1.0 - part };
            let weight = side(part.x, dx) * side(part.y, dy) * side(part.z, dz);
            let cell = first + (dz * rows + dy) * columns + dx;
            let (field, toward_eye) = self.found[cell].get_or_init(|| self.gather(cell));
            for (sum, field) in sum.iter_mut().zip(field) {
                *sum += *field * weight;
            }
            for (sum, shown) in shown.iter_mut().zip(toward_eye) {
                *sum += *shown * weight;
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

    /// Content of each cell, from the sums; the direct light on its hair.
    fn prepare(&mut self, scene: &Scene) {
        let (grid, parts) = (self.grid, &self.parts);
        let width = HAIR_SUMS + scene.reached.len() + SKIN_SUMS;
        let scale = 1.0 / (UNITS * grid.cell * grid.cell);
        let skin_sums = width - SKIN_SUMS;
        let around = scene.around[0];
        let number = |index: usize, at: usize| {
            let whole: i64 = parts.iter().map(|part| part[index * width + at]).sum();
            whole as f32 * scale
        };
        let vector = |index, at| Vec3::new(number(index, at), number(index, at + 1), number(index, at + 2));
        let holding = (0..grid.cell_count()).into_par_iter().filter_map(|index| {
            let (hair, skin) = (number(index, 0), vector(index, skin_sums));
            let area = skin.length();
            if hair <= 0.0 && area <= 0.0 {
                return None;
            }
            let mut cell = Cell { index, hair: hair.max(0.0), skin, ..Cell::default() };
            if hair > 0.0 {
                let mean = vector(index, 1) / hair;
                cell.tangent = mean.normalize_or(Vec3::Y);
                cell.order = mean.length_squared().min(1.0);
                cell.nearest = scene.lattice.nearest(cell.tangent);
                cell.mix = ALL_DARK;
                if scene.lattice.is_mixed() {
                    // Behind the sums of the lights.
                    let light = vector(index, HAIR_SUMS + scene.lights.len()) / hair;
                    let light = light.clamp(Vec3::ZERO, Vec3::ONE).extend(0.0);
                    cell.mix = [Vec4::ONE - light, light];
                }
            }
            if area > 0.0 {
                cell.skin_light = vector(index, skin_sums + 3).extend(0.0) / area;
                // Sides of thin skin take each other's area away, so that few roots count as many there.
                let rooted = (number(index, skin_sums + 6) / area).clamp(0.0, 1.0);
                let color = scene.body.map_or(Vec3::ZERO, |(_, color)| color.among(rooted));
                cell.skin_color = color.extend(0.0);
            }
            Some(cell)
        });
        self.cells.clear();
        self.cells.par_extend(holding);
        let reached = |cell: &Cell, light: usize| number(cell.index, HAIR_SUMS + light) / cell.hair;
        self.carried.lay(&grid, &self.cells);
        let scales = light_scales(&grid, &self.cells, &self.carried, scene.lights, &reached);
        let straight = |cell: &Cell| {
            let reached = |light: usize| scales[light] * reached(cell, light);
            straight_light(cell, grid.middle(cell.index), scene, &reached)
        };
        // As if the surroundings reached every hair: even light is found at once.
        let even = |cell: &Cell| around * scene.lattice.albedo(&cell.mix);
        let skin = |cell: &Cell| (cell.skin_light + around) * cell.skin_color;
        self.carried.begin(&self.cells, scene.lattice, even, straight, skin);
    }

    /// Sums what was carried through a cell into a field, and finds what its hair shows toward the eye.
    #[cold]
    fn gather(&self, index: usize) -> CellLight {
        let Some(toward) = &self.toward else { return CellLight::default() };
        let part = 1.0 / toward.sets as f32;
        let rays: [Rays; SETS] = std::array::from_fn(|set| self.carried.rays(set, index, &toward.around));
        let mut field = Field::default();
        for (set, rays) in rays.iter().enumerate().take(toward.sets) {
            for (light, (way, share)) in rays.iter().zip(toward.lattice.ways(set)) {
                light_field::add(&mut field, -*way, *light * (*share * part));
            }
        }
        let cell = self.carried.slot(index).map(|slot| &self.cells[slot]).filter(|cell| cell.hair > 0.0);
        let middle = self.grid.middle(index);
        (field, cell.map_or([Vec4::ZERO; 2], |cell| toward.shown(cell, middle, &rays, &field)))
    }
}

impl Toward {
    /// Radiance of a cell's hair toward the eye in the light along every direction, and the part that the
    /// field alone gives.
    fn shown(&self, cell: &Cell, middle: Vec3, rays: &[Rays; SETS], field: &Field) -> [Vec4; 2] {
        let to_eye = (self.eye - middle).normalize_or(Vec3::Z);
        let u = light_field::across(cell.tangent, to_eye);
        let mut sums = [Vec4::ZERO; 2];
        for (set, rays) in rays.iter().enumerate().take(self.sets) {
            let weights = self.lattice.weights(cell.tangent, to_eye, set, rays);
            for ((weights, moments), share) in weights.zip(&cell.mix) {
                let shown =
                    rays.iter().zip(weights).fold(Vec4::ZERO, |sum, (ray, weight)| sum + *ray * weight);
                let known = light_field::shown(field, &moments, cell.tangent, u);
                // Weighted with the cell's hair: empty cells have no say.
                let weight = *share * cell.hair;
                sums = [sums[0] + shown * weight, sums[1] + known * weight];
            }
        }
        sums
    }
}

/// Radiance of a cell's hair along every direction of each set in direct light, of which a share of each light reaches
/// it.
fn straight_light(cell: &Cell, middle: Vec3, scene: &Scene, reached: &dyn Fn(usize) -> f32) -> [Rays; SETS] {
    let mut shown = [[Vec4::ZERO; DIRECTIONS]; SETS];
    if cell.hair == 0.0 {
        return shown;
    }
    let mut shows = None;
    let mut show = |beam: &Beam| {
        if beam.light == Vec3::ZERO {
            return;
        }
        let views = || std::array::from_fn(|set| scene.lattice.shows(cell.tangent, set));
        let shows: &[_; SETS] = shows.get_or_insert_with(views);
        let (to_light, light) = (beam.way.normalize_or(Vec3::Y), beam.light);
        let ordered = (to_light, light * cell.order);
        // Irradiance, pi times the radiance, over the whole sphere.
        let even = scene.lattice.albedo(&cell.mix) * light.extend(0.0) * (0.25 * (1.0 - cell.order));
        for (shown, shows) in shown.iter_mut().zip(shows) {
            scene.lattice.add_light(cell.tangent, shows, &cell.mix, ordered, shown);
            shown.iter_mut().for_each(|shown| *shown += even);
        }
    };
    let mut beam = Beam::default();
    for (light, source) in scene.lights.iter().enumerate() {
        let lit = source.at(middle);
        let share =
            if source.shadow { reached(light) } else { toward(&scene.occlusion.cube(middle), lit.to_light) };
        if !beam.take(lit.to_light, lit.radiance * share) {
            show(&beam);
            beam = Beam::default();
            beam.take(lit.to_light, lit.radiance * share);
        }
    }
    show(&beam);
    shown
}

/// Light of neighbouring lights that come from nearly one direction.
#[derive(Clone, Copy, Default)]
struct Beam {
    /// The way to it, as long as there is light.
    way: Vec3,
    light: Vec3,
}

impl Beam {
    /// Takes more light, unless it comes from elsewhere.
    fn take(&mut self, to_light: Vec3, light: Vec3) -> bool {
        let weight = light.element_sum();
        let apart = self.way.dot(to_light) < ONE_BEAM * self.way.length();
        if weight > 0.0 && apart {
            return false;
        }
        self.way += to_light * weight;
        self.light += light;
        true
    }
}
