//! Scattering among the directions along which light is carried through a grid.
//!
//! The fibre is looked up between single directions and scaled, for each kind of path, so that the sum over the
//! directions is the share of light that goes that way: even light stays even whatever the directions resolve.
//!
//! Hair that is not all alike scatters as a mixture of its darkest and its lightest does: what many hairs show is the
//! mean of what each shows, never what hair of their mean pigment would.

use std::sync::OnceLock;

use glam::{Vec3, Vec4};
use strandline_base::par::prelude::*;

use super::inclination::{Inclination, REGION, offsets};
use super::ways::{DIRECTIONS, Rays, SETS, Set, TANGENTS, directions, tangent};
use crate::fibre::chiang::{EyeRow, Lobes, MOMENTS, Met, PigmentTerms, Pigments, Table, terms_along};
use crate::light_field;

/// Least by which albedos of two kinds of hair differ, for a third to lie between them.
const LEAST_APART: f32 = 1e-6;

/// Most kinds of hair that are mixed.
pub const MOST_ENDS: usize = 2;
/// Sine of the inclination at which a fibre's albedo is near its mean over all of them.
const MEAN_SINE: f32 = 0.5;

/// Shares of the darkest and of the lightest hair, by channel.
pub type Mix = [Vec4; MOST_ENDS];
/// Hair that is all the same.
pub const ALL_DARK: Mix = [Vec4::ONE, Vec4::ZERO];

/// Scattering of a fibre.
#[derive(Clone, Debug)]
pub struct Lattice {
    table: Table,
    /// Terms along the fibre of straight light: parts of a lobe around the directions.
    straight: Vec<Vec4>,
    inclination: Inclination,
    /// The sets of directions in which light goes.
    sets: [Set; SETS],
    tangents: Vec<Vec3>,
    /// The darkest hair; the lightest, where there is another.
    ends: Vec<End>,
}

/// Radiance along each direction of a set of light along each one of another, shape `[arriving][shown]`.
type Shown = [Rays; DIRECTIONS];

/// Scattering of one kind of hair.
#[derive(Clone, Debug)]
struct End {
    /// Its view at some inclination.
    seen: EyeRow,
    around: PigmentTerms,
    /// Radiance that it sends along a direction of the next set, of light along one of a set: shape
    /// `[set][tangent][arriving][shown]`. Found when a cell asks for it: hair lies along few of the tangents.
    shown: [Vec<OnceLock<Box<Shown>>>; SETS],
    /// Share of even light that it gives back, as a mean over its directions.
    albedo: Vec4,
}

impl Lattice {
    /// The scattering of hair with the darkest's absorption per fibre radius, and of the lightest, whose pigment is a
    /// share of that; none where all hair is the same.
    pub fn new(lobes: &Lobes, absorption: [f64; 3], lightest: Option<Pigments>) -> Self {
        let table = Table::new(lobes, absorption);
        let straight = terms_along(&lobes.spread(REGION), table.floor);
        let inclination = Inclination::new(lobes);
        let sets = std::array::from_fn(directions);
        let tangents: Vec<Vec3> = (0..TANGENTS).map(tangent).collect();
        let mut lattice = Self { table, straight, inclination, sets, tangents, ends: Vec::new() };
        let kinds = [Some(Pigments::Even(1.0)), lightest];
        lattice.ends = kinds.into_iter().flatten().map(|pigments| lattice.end(pigments)).collect();
        lattice
    }

    fn end(&self, pigments: Pigments) -> End {
        let seen = EyeRow::new(MEAN_SINE, pigments);
        let albedo = self.table.seen_moments(&seen)[0];
        let shown = std::array::from_fn(|_| vec![OnceLock::new(); TANGENTS]);
        End { seen, around: self.table.around_of(&seen), shown, albedo }
    }

    /// Radiance that a kind of hair with a known tangent sends along the set behind one.
    fn shown_by<'a>(&self, end: &'a End, set: usize, tangent: usize) -> &'a Shown {
        end.shown[set][tangent].get_or_init(|| {
            let t = self.tangents[tangent];
            let arriving = self.arriving(t, set);
            let next = &self.sets[(set + 1) % SETS];
            let mut found = Box::new([[Vec4::ZERO; DIRECTIONS]; DIRECTIONS]);
            for (to, (way, _)) in next.iter().enumerate() {
                let weights = self.weights_of(end, t, *way, &arriving, &[0.0; DIRECTIONS]);
                found.iter_mut().zip(weights).for_each(|(shown, weight)| shown[to] = weight);
            }
            found
        })
    }

    /// True if hair is not all alike.
    pub fn is_mixed(&self) -> bool {
        self.ends.len() > 1
    }

    /// Share of the lightest hair, by channel, that mixed with the darkest returns as much light as hair with
    /// shares of the darkest's pigment.
    pub fn lightness(&self, pigments: Vec3) -> Vec3 {
        let [End { albedo: dark, .. }, End { albedo: light, .. }] = *self.ends.as_slice() else {
            return Vec3::ZERO;
        };
        let albedo = self.table.moments(MEAN_SINE, Pigments::Channels(pigments))[0];
        let share = (albedo - dark) / (light - dark).max(Vec4::splat(LEAST_APART));
        share.truncate().clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// The tables that scattering is looked up in.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Inclination of light behind the fibre.
    #[cfg(feature = "gpu")]
    pub(crate) fn inclination(&self) -> &Inclination {
        &self.inclination
    }

    /// The entries of the tables; known directions of hair; terms along the fibre of straight light; what hair shows, shape
    /// `[end][set][tangent][arriving][shown]`.
    pub fn entries(&self) -> Vec<Vec4> {
        let tangents = self.tangents.iter().map(|tangent| tangent.extend(0.0));
        let all = || (0..SETS).flat_map(|set| (0..TANGENTS).map(move |tangent| (set, tangent)));
        let shown: Vec<&Shown> = self
            .ends
            .iter()
            .flat_map(|end| {
                let one = |(set, tangent)| self.shown_by(end, set, tangent);
                all().collect::<Vec<_>>().into_par_iter().map(one).collect::<Vec<_>>()
            })
            .collect();
        let shown = shown.into_iter().flatten().flatten().copied();
        let straight = self.straight.iter().copied();
        self.table.entries.iter().copied().chain(tangents).chain(straight).chain(shown).collect()
    }

    /// The directions of a set and their shares of the sphere.
    pub fn ways(&self, set: usize) -> &Set {
        &self.sets[set]
    }

    /// The nearest known direction of hair to a unit tangent; behind these their opposites have numbers.
    pub fn nearest(&self, tangent: Vec3) -> usize {
        let dots = self.tangents.iter().map(|known| known.dot(tangent));
        let best =
            |best: (usize, f32), next: (usize, f32)| if next.1.abs() > best.1.abs() { next } else { best };
        let (number, dot) = dots.enumerate().fold((0, 0.0), best);
        if dot < 0.0 { number + TANGENTS } else { number }
    }

    /// Radiance toward `to_eye` of each kind of hair of unit tangent `t` in light along each direction of a set, whose
    /// inclinations are those of `rays`, and its moments.
    pub fn weights(
        &self,
        t: Vec3,
        to_eye: Vec3,
        set: usize,
        rays: &Rays,
    ) -> impl Iterator<Item = (Rays, [Vec4; MOMENTS])> {
        let (offsets, arriving) = (offsets(rays), self.arriving(t, set));
        let of = move |end: &End| {
            let moments = self.table.seen_moments(&end.seen.at(t.dot(to_eye)));
            (self.weights_of(end, t, to_eye, &arriving, &offsets), moments)
        };
        self.ends.iter().map(of)
    }

    /// Light along every direction of a set, with the directions' shares of the sphere.
    fn arriving(&self, t: Vec3, set: usize) -> [(Arriving, f32); DIRECTIONS] {
        self.sets[set].map(|(way, share)| (Arriving::new(t, -way), share))
    }

    /// Sines of the inclinations of light along each direction lie so much beside the direction's own.
    fn weights_of(
        &self,
        end: &End,
        t: Vec3,
        to_eye: Vec3,
        arriving: &[(Arriving, f32); DIRECTIONS],
        offsets: &[f32; DIRECTIONS],
    ) -> Rays {
        let u = light_field::across(t, to_eye);
        let seen = end.seen.at(t.dot(to_eye));
        let terms = (&*self.table.entries, &end.around);
        let along = |arriving: &Arriving, share: f32| {
            let solid = 4.0 * std::f32::consts::PI * share;
            paths_of(&self.table, terms, u, &seen, arriving).map(|path| path * solid)
        };
        let mut paths = [[Vec3::ZERO; 3]; DIRECTIONS];
        let mut sums = [Vec3::ZERO; 3];
        for (path, (arriving, share)) in paths.iter_mut().zip(arriving) {
            *path = along(arriving, *share);
            (0..3).for_each(|kind| sums[kind] += path[kind]);
        }
        let shares = self.table.shares(&seen);
        let scales: [Vec3; 3] = std::array::from_fn(|path| shares[path] / sums[path].max(Vec3::splat(1e-20)));
        for ((path, offset), (arriving, share)) in paths.iter_mut().zip(offsets).zip(arriving) {
            if *offset != 0.0 {
                *path = along(&arriving.beside(-offset), *share);
            }
        }
        paths.map(|[r, tt, trt]| (r * scales[0] + tt * scales[1] + trt * scales[2]).extend(0.0))
    }

    /// Views of hair of unit tangent `t` along every direction of a set.
    pub fn shows(&self, t: Vec3, set: usize) -> [Shows; DIRECTIONS] {
        self.sets[set].map(|(way, share)| {
            let seen = self.ends[0].seen.at(t.dot(way));
            Shows { u: light_field::across(t, way), seen, weight: 4.0 * std::f32::consts::PI * share }
        })
    }

    /// Adds what a mixture of hair of unit tangent `t` shows along every direction of light of the given radiance (of a
    /// white surface that faces it) from a unit direction; the last lanes hold its first moments: see
    /// [`inclination`](super::inclination).
    ///
    /// The mean radiance over the sphere is nearly the fibre's, also for light along the hair, of which little meets the
    /// hair: terms along the fibre [d'Eon2011] are the same if eye and light change places, and their sum over all eyes
    /// is that over all lights. Shares of the paths are those of the light's inclination instead of each eye's: too
    /// bright by 0.07, 0.20 and 0.32 at 56, 71 and 78 degrees. As much light as meets the hair is 0.04 too bright at 12 degrees, and
    /// 0.15 and 0.27 too dark at 71 and 78.
    pub fn add_light(
        &self,
        t: Vec3,
        shows: &[Shows; DIRECTIONS],
        mix: &Mix,
        (to_light, light): (Vec3, Vec3),
        shown: &mut Rays,
    ) {
        let arriving = Arriving::new(t, to_light);
        for (end, share) in self.ends.iter().zip(mix) {
            if *share != Vec4::ZERO {
                self.add_light_of(end, &arriving, shows, light * share.truncate(), shown);
            }
        }
    }

    fn add_light_of(
        &self,
        end: &End,
        arriving: &Arriving,
        shows: &[Shows; DIRECTIONS],
        light: Vec3,
        shown: &mut Rays,
    ) {
        let mut sums = [Vec3::ZERO; 3];
        let paths = shows.each_ref().map(|Shows { u, seen, weight }| {
            let path =
                paths_of(&self.table, (&self.straight, &end.around), *u, &seen.of(&end.seen), arriving);
            sums.iter_mut().zip(path).for_each(|(sum, path)| *sum += path * *weight);
            path
        });
        let shares = self.table.shares(&end.seen.at(arriving.sine));
        let light = light * std::f32::consts::PI;
        let scales: [Vec3; 3] =
            std::array::from_fn(|path| light * shares[path] / sums[path].max(Vec3::splat(1e-20)));
        let sent = self.inclination.sent(arriving.sine, arriving.flat);
        for ((shown, shows), paths) in shown.iter_mut().zip(shows).zip(paths) {
            let paths = std::array::from_fn(|path| paths[path] * scales[path]);
            let moment = self.inclination.moment(&paths, &sent, shows.seen.sine());
            *shown += paths.into_iter().sum::<Vec3>().extend(moment);
        }
    }

    /// Shares of straight light whose inclination has a sine that the darkest hair sends on as R, TT and TRT.
    #[cfg(test)]
    pub(super) fn straight_shares(&self, sine: f32) -> [Vec3; 3] {
        self.table.shares(&self.ends[0].seen.at(sine))
    }

    /// Adds what a mixture of hair near tangent number `tangent` (see [`nearest`](Self::nearest)) shows along every direction
    /// of the set behind `set`, of light along those of `set`; a share `order` of the hair has that tangent, the rest lies
    /// every way and shows the same all around.
    pub fn add_shown(
        &self,
        set: usize,
        tangent: usize,
        (order, mix): (f32, &Mix),
        light: &Rays,
        shown: &mut Rays,
    ) {
        let mean: Vec4 = light.iter().zip(&self.sets[set]).map(|(light, (_, share))| *light * *share).sum();
        let unordered = self.albedo(mix) * mean * (1.0 - order);
        shown.iter_mut().for_each(|shown| *shown += unordered);
        // Opposite hair shows along the opposite direction the same of opposite light.
        let is_opposite = tangent >= TANGENTS;
        let (mut light, tangent) = (*light, tangent % TANGENTS);
        if is_opposite {
            light.reverse();
        }
        for (end, share) in self.ends.iter().zip(mix).filter(|(_, share)| **share != Vec4::ZERO) {
            let ordered_share = *share * order;
            let mut ordered = product(self.shown_by(end, set, tangent), &light);
            if is_opposite {
                ordered.reverse();
            }
            shown.iter_mut().zip(ordered).for_each(|(shown, ordered)| *shown += ordered * ordered_share);
        }
    }

    /// Share of even light that a mixture of hair gives back, as a mean over its directions.
    pub fn albedo(&self, mix: &Mix) -> Vec4 {
        self.albedos().zip(mix).map(|(albedo, share)| albedo * *share).sum()
    }

    /// Greatest albedo of any hair.
    pub(crate) fn most_albedo(&self) -> Vec4 {
        self.albedos().fold(Vec4::ZERO, Vec4::max)
    }

    /// Albedo of each kind of hair.
    pub fn albedos(&self) -> impl Iterator<Item = Vec4> {
        self.ends.iter().map(|end| end.albedo)
    }
}

/// Sum over the arriving directions of weights times light.
fn product(weights: &Shown, light: &Rays) -> Rays {
    /// As many sums as a processor holds at once.
    const AT_ONCE: usize = 10;
    let mut found = [Vec4::ZERO; DIRECTIONS];
    for first in (0..DIRECTIONS).step_by(AT_ONCE) {
        let mut sums = [Vec4::ZERO; AT_ONCE];
        for arriving in 0..DIRECTIONS {
            let (weights, light) = (&weights[arriving][first..first + AT_ONCE], light[arriving]);
            for at in 0..AT_ONCE {
                sums[at] += weights[at] * light;
            }
        }
        found[first..first + AT_ONCE].copy_from_slice(&sums);
    }
    found
}

/// Radiance of each kind of path toward the eye, in whose direction `u` is a unit vector across the hair.
#[inline]
fn paths_of(
    table: &Table,
    terms: (&[Vec4], &PigmentTerms),
    u: Vec3,
    seen: &EyeRow,
    light: &Arriving,
) -> [Vec3; 3] {
    let turn = (u.dot(light.to_light) / light.flat).clamp(-1.0, 1.0);
    table.by_path_around(terms, seen, &light.met, turn)
}

/// View of hair along one direction.
#[derive(Clone, Copy, Debug)]
pub struct Shows {
    /// A unit vector across the hair toward the eye.
    u: Vec3,
    seen: EyeRow,
    /// Weight in the sum over all directions.
    weight: f32,
}

/// Light that meets hair from one direction.
#[derive(Clone, Copy)]
struct Arriving {
    to_light: Vec3,
    sine: f32,
    /// Cosine of its inclination.
    flat: f32,
    met: Met,
}

impl Arriving {
    #[inline]
    fn new(t: Vec3, to_light: Vec3) -> Self {
        let sine = t.dot(to_light);
        Self { to_light, sine, flat: (1.0 - sine * sine).max(1e-8).sqrt(), met: Met::new(sine) }
    }

    /// The same turn at an inclination whose sine is greater by an offset.
    #[inline]
    fn beside(&self, offset: f32) -> Self {
        Self { met: Met::new((self.sine + offset).clamp(-1.0, 1.0)), ..*self }
    }
}

#[cfg(test)]
mod tests;
