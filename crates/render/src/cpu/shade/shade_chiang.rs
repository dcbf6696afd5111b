//! `shade` with the fibre of \[Chiang2016\]: straight light from every light, and what hair and skin scatter.

use glam::Vec3;
use strandline_base::par::prelude::*;

use super::radiances::{Shading, fill_all};
use crate::cpu::ShadowBody;
use crate::cpu::scatter::light_grid::LightGrid;
use crate::cpu::scatter::light_scene::{Scene, SkinColor};
use crate::cpu::scatter::mixture::{Chance, lightness, pigments};
use crate::cpu::scatter::occlusion::{Occlusion, toward};
use crate::fibre::chiang::{EyeRow, Pigments, Table};
use crate::level_of_detail::EveryFew;
use crate::light_field;
use crate::lights::Shining;
use crate::scatter::made::Made;
use crate::scatter::source::{OwnColors, Source};
use crate::shadow::{ShadowMap, Shadows};
use crate::strands::Strands;
use crate::{Light, Look};

/// Noise nodes along a strand.
const NODES: usize = 8;
/// Share of a light below which it is invisible.
const LEAST_SHARE: f32 = 1e-5;

/// State that the stage keeps from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Scattering {
    made: Option<Made>,
    /// The strands that scattered light is summed from.
    summed: EveryFew,
    /// Share of each shadow light that reaches every point of these, shape `[light][point]`.
    reached: Vec<Vec<f32>>,
    /// Share of the lightest hair in every point of mixed hair, shape `[channel][point]`.
    lightness: Vec<Vec<f32>>,
    grid: LightGrid,
}

/// Lights of the hair.
#[derive(Clone, Copy)]
pub struct Lit<'a> {
    /// The lights.
    pub lights: &'a [Light],
    /// Their shadows.
    pub shadows: &'a Shadows,
    /// The body and the colour of its skin.
    pub body: Option<(ShadowBody<'a>, SkinColor)>,
    /// The hair's look.
    pub look: &'a Look,
    /// The groom's colours, where it has some.
    pub own_colors: Option<&'a OwnColors>,
    /// Position of the camera \[m\], world space.
    pub eye: Vec3,
}

impl Scattering {
    /// Scattered light of the last picture.
    pub fn grid(&self) -> &LightGrid {
        &self.grid
    }

    /// Fills the radiances of all strands \[linear RGB\]; `occlusion` is filled here from the strands.
    pub fn shade(&mut self, strands: &mut Strands, lit: &Lit, occlusion: &mut Occlusion) {
        self.prepare(strands, lit, occlusion);
        let mut radiances = std::mem::take(&mut strands.radiances);
        if let Some(shading) = self.shading(strands, lit, occlusion) {
            fill_all(strands, &shading, &mut radiances);
        }
        strands.radiances = radiances;
    }

    /// Computes the light that reaches every point and the scattered light; fills `occlusion` from the strands.
    pub(crate) fn prepare(&mut self, strands: &Strands, lit: &Lit, occlusion: &mut Occlusion) {
        let look = lit.look;
        if lit.lights.iter().all(|light| light.shadow) {
            // Nothing else asks how much of the surroundings hair hides: the grid alone is taken.
            occlusion.place(strands);
        } else {
            occlusion.fill(strands, &look.hair_shadow());
        }
        let source = Source::new(look, lit.own_colors);
        if self.made.as_ref().is_none_or(|made| made.from != source) {
            self.made = Some(Made::new(source));
        }
        let Some(made) = &self.made else { return };
        let lattice = &made.lattice;
        self.summed = EveryFew::of(strands.full_count);
        reach(strands, lit, self.summed, &mut self.reached);
        if lattice.is_mixed() {
            lightness(strands, self.summed, look, &source, lattice, &mut self.lightness);
            self.reached.append(&mut self.lightness);
        }
        self.grid.fill(&Scene {
            strands,
            summed: self.summed,
            reached: &self.reached,
            body: lit.body,
            shadows: lit.shadows,
            occlusion,
            lights: lit.lights,
            around: look.around(),
            lattice,
            eye: lit.eye,
            rounds: made.rounds(),
        });
        self.lightness.extend(self.reached.drain(lit.lights.len()..));
    }

    /// Shading of the points of the prepared frame; `None` before that.
    pub(crate) fn shading<'a>(
        &'a self,
        strands: &'a Strands,
        lit: &'a Lit,
        occlusion: &'a Occlusion,
    ) -> Option<ChiangShading<'a>> {
        let Made { table, .. } = self.made.as_ref()?;
        let light = |(index, (light, reached))| {
            let (light, reached): (&Light, &Vec<f32>) = (light, reached);
            Shone { from: light.shining(), map: lit.shadows.map(index), reached }
        };
        let lights = lit.lights.iter().zip(&self.reached).enumerate().map(light).collect();
        Some(ChiangShading { strands, lit, table, lights, summed: self.summed, grid: &self.grid, occlusion })
    }
}

/// Share of each shadow light that body and hair let through to every point of some strands.
fn reach(strands: &Strands, lit: &Lit, summed: EveryFew, reached: &mut Vec<Vec<f32>>) {
    reached.resize_with(lit.lights.len(), Vec::new);
    for (light, reached) in reached.iter_mut().enumerate() {
        let Some(map) = lit.shadows.map(light) else {
            reached.clear();
            continue;
        };
        reached.resize(strands.positions.len(), 0.0);
        let count = strands.points_per_strand;
        let both = reached.par_chunks_mut(count).zip(strands.positions.par_chunks(count)).enumerate();
        both.filter(|(strand, _)| strands.is_one_of(*strand, summed)).for_each(|(_, (reached, places))| {
            for (reached, &place) in reached.iter_mut().zip(places) {
                *reached = map.reach(place);
            }
        });
    }
}

/// Properties that differ between strands.
struct Strand<'a> {
    look: &'a Look,
    /// Pigment as a multiple of the look's.
    darker: f32,
    /// Colours of its points, where the groom has some.
    own: Option<&'a [Vec3]>,
    /// Shift of the highlights \[rad\] at even distances from root to tip.
    shifts: [f32; NODES],
}

impl<'a> Strand<'a> {
    fn new(look: &'a Look, own: Option<&'a [Vec3]>, guide: u32, index: u32) -> Self {
        let Chance { darker, mut random, .. } = Chance::new(look, guide, index);
        let noise = 2.0 * look.highlight_noise.to_radians();
        let whole = 2.0 * random.unit() - 1.0;
        let shifts = std::array::from_fn(|_| noise * (0.6 * whole + 0.8 * random.unit() - 0.4));
        Self { look, darker, own, shifts }
    }

    /// Pigment of a point at a share of the way to the tip.
    #[inline]
    fn pigments(&self, point: usize, share: f32) -> Pigments {
        pigments(self.look, self.own, self.darker, point, share)
    }

    /// Shift of the highlights at a share of the way to the tip.
    #[inline]
    fn shift(&self, share: f32) -> f32 {
        let at = share * (NODES - 1) as f32;
        let node = (at as usize).min(NODES - 2);
        let (low, high) = (self.shifts[node], self.shifts[node + 1]);
        low + (high - low) * (at - node as f32)
    }
}

/// A light, with its shadows on the hair.
struct Shone<'a> {
    from: Shining<'a>,
    /// Its shadows.
    map: Option<&'a ShadowMap>,
    /// Share of the light that reaches each point, shape `[point]`; empty without shadow.
    reached: &'a Vec<f32>,
}

impl Shone<'_> {
    /// Share of the light that reaches a point \[m\], where hair and body cast shadows in it.
    #[inline]
    fn share(&self, point: usize, place: Vec3, known: bool) -> Option<f32> {
        let map = self.map?;
        Some(if known { self.reached[point] } else { map.reach(place) })
    }
}

/// Shading of strands by \[Chiang2016\], with the light that they scatter among each other.
pub(crate) struct ChiangShading<'a> {
    strands: &'a Strands,
    lit: &'a Lit<'a>,
    table: &'a Table,
    lights: Vec<Shone<'a>>,
    /// The sample of strands whose incoming light is known.
    summed: EveryFew,
    grid: &'a LightGrid,
    occlusion: &'a Occlusion,
}

impl Shading for ChiangShading<'_> {
    fn fill(&self, strand: usize, first: usize, radiances: &mut [Vec3]) {
        let ((guide, index), count) = (self.strands.place(strand), self.strands.points_per_strand);
        let own = Strand::new(self.lit.look, self.strands.own_colors(strand), guide as u32, index as u32);
        let known = self.summed.holds(guide, index);
        for (index, radiance) in (first..).zip(radiances) {
            *radiance = self.radiance(&own, strand * count + index, index, known);
        }
    }
}

impl ChiangShading<'_> {
    /// Light of a point, the `index`-th of its strand; `known` where its strand is in the sample.
    fn radiance(&self, own: &Strand, point: usize, index: usize, known: bool) -> Vec3 {
        let (place, t) = (self.strands.positions[point], self.strands.tangents[point]);
        let share = index as f32 / (self.strands.points_per_strand - 1) as f32;
        let (pigments, shift) = (own.pigments(index, share), own.shift(share));
        let to_eye = (self.lit.eye - place).normalize_or(Vec3::Z);
        let sine = t.dot(to_eye);
        let u = light_field::across(t, to_eye);
        let (field, more) = self.grid.field(place);
        let seen = EyeRow::new(sine, pigments);
        let moments = self.table.seen_moments(&seen);
        let mut sum = (light_field::shown(&field, &moments, t, u) * more).truncate();
        for light in &self.lights {
            let share = light.share(point, place, known);
            // Most hair lies in shadow.
            if share.is_some_and(|share| share <= LEAST_SHARE) {
                continue;
            }
            let from = light.from.at(place);
            let share = share.unwrap_or_else(|| toward(&self.occlusion.cube(place), from.to_light));
            if share > LEAST_SHARE {
                let sine_light = t.dot(from.to_light);
                let flat = (1.0 - sine_light * sine_light).max(1e-8).sqrt();
                let turn = (u.dot(from.to_light) / flat).clamp(-1.0, 1.0);
                let shown = self.table.shown(&seen, sine_light, turn, shift);
                sum += shown * from.radiance * (share * std::f32::consts::PI);
            }
        }
        sum
    }
}
