//! `shade` with the fibre of \[Chiang2016\]: straight light from every light, and what hair and skin scatter.

use glam::Vec3;
use rayon::prelude::*;
use strandline_base::math;

use super::fast_math::exp;
use super::lattice::Lattice;
use super::light_field;
use super::light_grid::{LightGrid, Scene};
use super::noise::{Random, hash_pair, unit};
use super::occlusion::{Occlusion, toward};
use super::{ShadowBody, Shadows, Strands};
use crate::fibre::Chiang;
use crate::fibre::chiang::Table;
use crate::{Light, Look};

/// Noise nodes along a strand.
const NODES: usize = 8;
/// Pigment of white hair, as a multiple of that of the others.
const WHITE: f32 = 0.02;

/// Tables of a look's fibre.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    /// Fibre, colour of a mass of hair and mean pigment.
    pub(crate) from: (Chiang, Vec3, f32),
    pub(crate) table: Table,
    pub(crate) lattice: Lattice,
}

/// What the tables of a look are made from.
pub(crate) fn made_from(look: &Look) -> (Chiang, Vec3, f32) {
    (look.fibre.chiang, look.root_color, mean_pigment(look))
}

impl Made {
    pub(crate) fn new(look: &Look) -> Self {
        let from = made_from(look);
        let (fibre, color, pigment) = from;
        let (lobes, absorption) = (fibre.lobes(), fibre.absorption(color));
        let lattice = Lattice::new(&lobes, absorption, pigment);
        Self { from, table: Table::new(&lobes, absorption), lattice }
    }
}

/// What the stage keeps from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Scattering {
    made: Option<Made>,
    /// Share of each shadow light that reaches every point, shape `[light][point]`.
    reached: Vec<Vec<f32>>,
    grid: LightGrid,
}

/// What hair is lit by.
#[derive(Clone, Copy)]
pub struct Lit<'a> {
    /// The lights.
    pub lights: &'a [Light],
    /// Their shadows.
    pub shadows: &'a Shadows,
    /// The body and the colour of its skin.
    pub body: Option<(ShadowBody<'a>, Vec3)>,
    /// The hair's look.
    pub look: &'a Look,
    /// Where the camera stands \[m\], world space.
    pub eye: Vec3,
}

impl Scattering {
    /// Scattered light of the last picture.
    pub fn grid(&self) -> &LightGrid {
        &self.grid
    }

    /// Fills the radiances of all strands \[linear RGB\]; `occlusion` is filled here from the strands.
    pub fn shade(&mut self, strands: &mut Strands, lit: &Lit, occlusion: &mut Occlusion) {
        let look = lit.look;
        if lit.lights.iter().all(|light| light.shadow) {
            // Nothing else asks how much of the surroundings hair hides: the grid alone is taken.
            occlusion.place(strands);
        } else {
            occlusion.fill(strands, &look.hair_shadow());
        }
        if self.made.as_ref().is_none_or(|made| made.from != made_from(look)) {
            self.made = Some(Made::new(look));
        }
        let Some(Made { table, lattice, .. }) = &self.made else { return };
        reach(strands, lit, &mut self.reached);
        self.grid.fill(&Scene {
            strands,
            reached: &self.reached,
            body: lit.body,
            shadows: lit.shadows,
            occlusion,
            lights: lit.lights,
            environment: &look.environment,
            lattice,
            eye: lit.eye,
            pigment: mean_pigment(look),
            rounds: look.fibre.chiang.scatterings,
        });
        radiances(strands, lit, table, &self.reached, &self.grid, occlusion);
    }
}

/// Mean pigment of a look's hair as a multiple of that at the root.
fn mean_pigment(look: &Look) -> f32 {
    (1.0 - look.grey) * 0.5 * (1.0 + look.fibre.chiang.tip_pigment) + look.grey * WHITE
}

/// Share of each shadow light that body and hair let through to every point.
fn reach(strands: &Strands, lit: &Lit, reached: &mut Vec<Vec<f32>>) {
    reached.resize_with(lit.lights.len(), Vec::new);
    for (light, reached) in reached.iter_mut().enumerate() {
        let Some(map) = lit.shadows.map(light) else {
            reached.clear();
            continue;
        };
        reached.resize(strands.positions.len(), 0.0);
        let both = reached.par_chunks_mut(4096).zip(strands.positions.par_chunks(4096));
        both.for_each(|(reached, places)| {
            for (reached, &place) in reached.iter_mut().zip(places) {
                let open = map.body_visibility(place);
                *reached =
                    if open > 0.0 { open * exp(map.crossings(place) * map.log_transmission()) } else { 0.0 };
            }
        });
    }
}

/// What sets one strand apart from the others.
struct Strand {
    /// Pigment at root and tip, as a multiple of the look's at the root.
    pigments: [f32; 2],
    /// Shift of the highlights \[rad\] at even distances from root to tip.
    shifts: [f32; NODES],
}

impl Strand {
    fn new(look: &Look, guide: u32, index: u32) -> Self {
        let seed = hash_pair(look.seed ^ 0x10_5e, guide);
        // Half of the variation belongs to the whole clump, as in real locks.
        let clump = unit(seed) - 0.5;
        let mut random = Random::new(hash_pair(seed, index));
        let own = random.unit() - 0.5;
        let darker = math::exp2(-look.variation * (clump + own));
        let root = if random.unit() < look.grey { WHITE } else { darker };
        let noise = 2.0 * look.highlight_noise.to_radians();
        let whole = 2.0 * random.unit() - 1.0;
        Self {
            pigments: [root, root * look.fibre.chiang.tip_pigment],
            shifts: std::array::from_fn(|_| noise * (0.6 * whole + 0.8 * random.unit() - 0.4)),
        }
    }

    /// Pigment and shift at a share of the way to the tip.
    fn at(&self, share: f32) -> [f32; 2] {
        let at = share * (NODES - 1) as f32;
        let node = (at as usize).min(NODES - 2);
        let between = |low: f32, high: f32, part: f32| low + (high - low) * part;
        let [root, tip] = self.pigments;
        [between(root, tip, share), between(self.shifts[node], self.shifts[node + 1], at - node as f32)]
    }
}

fn radiances(
    strands: &mut Strands,
    lit: &Lit,
    table: &Table,
    reached: &[Vec<f32>],
    grid: &LightGrid,
    occlusion: &Occlusion,
) {
    let (count, per_guide) = (strands.points_per_strand, strands.strands_per_guide);
    let (positions, tangents) = (&strands.positions, &strands.tangents);
    strands.radiances.par_chunks_mut(count).enumerate().for_each(|(strand, radiances)| {
        let own = Strand::new(lit.look, (strand / per_guide) as u32, (strand % per_guide) as u32);
        for (index, radiance) in radiances.iter_mut().enumerate() {
            let point = strand * count + index;
            let (place, t) = (positions[point], tangents[point]);
            let [pigment, shift] = own.at(index as f32 / (count - 1) as f32);
            let to_eye = (lit.eye - place).normalize_or(Vec3::Z);
            let sine = t.dot(to_eye);
            let u = light_field::across(t, to_eye);
            let (field, more) = grid.field(place);
            let mut sum = (light_field::shown(&field, &table.moments(sine, pigment), t, u) * more).truncate();
            for (light, source) in lit.lights.iter().enumerate() {
                let from = source.at(place);
                let share = match reached[light].get(point) {
                    Some(share) => *share,
                    None => toward(&occlusion.cube(place), from.to_light),
                };
                if share > 1e-5 {
                    let sine_light = t.dot(from.to_light);
                    let flat = (1.0 - sine_light * sine_light).max(1e-8).sqrt();
                    let turn = (u.dot(from.to_light) / flat).clamp(-1.0, 1.0);
                    let shown = table.scatter(sine, sine_light, turn, pigment, shift);
                    sum += shown * from.radiance * (share * std::f32::consts::PI);
                }
            }
            *radiance = sum;
        }
    });
}
