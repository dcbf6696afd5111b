//! Locks of two sizes, strays, frizz and ends of the hair between guides.

use std::collections::{BTreeSet, HashMap};
use std::f32::consts::TAU;

use glam::Vec3;
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_body::Random;

use super::StyleSettings;
use super::comb::smooth;
use super::finish::{Bends, closed, frames};
use super::hair::Between;
use super::skin::Skin;
use super::strand::{CLEARANCE, Strand, WIDTH};
use crate::arcs::equal_arcs;

/// Strands of a small lock: neighbours on the skin.
const SMALL_LOCK: usize = 8;
/// Distances \[m\] from the middle of a large and of a small lock beyond which nothing is drawn to it.
const APART: [[f32; 2]; 2] = [[0.05, 0.02], [0.03, 0.012]];
/// Frizz of a stray over that of others.
const STRAY: f32 = 3.5;
/// Distance \[m\] by which strays stand off at their tips.
const STRAY_OUT: f32 = 0.006;
/// Length \[m\] from the root by which a strand has its waves: hair that is drawn back crosses from the start on.
const WAVED: f32 = 0.06;
const WAVED_TIED: f32 = 0.02;
/// Share of the strands on the hairline itself that are short, the same of tied hair, and their lengths \[m\].
const SHORT: f32 = 0.5;
const SHORT_TIED: f32 = 0.2;
const SHORT_LENGTHS: [f32; 2] = [0.008, 0.035];

/// Length \[m\] from the root by which a strand has its clearance from the skin, and the least share of it before.
const RISEN: f32 = 0.02;
const LEAST_RISEN: f32 = 0.3;

/// A shaped strand and its diameter \[m\].
pub(super) struct Shaped {
    pub points: Vec<Vec3>,
    pub width: f32,
}

/// Shapes strands between guides; `clumps` gives the guide in the middle of each guide's lock.
pub(super) fn shape(
    settings: &StyleSettings,
    skin: &Skin,
    guides: &[Strand],
    clumps: &[u32],
    hair: &[Between],
) -> Vec<Shaped> {
    let larges = larges(guides, clumps);
    let closing = closing(settings);
    let shaped = hair.par_iter().enumerate().map(|(index, own)| {
        let lock = index / SMALL_LOCK;
        let middle = &hair[(lock * SMALL_LOCK + SMALL_LOCK / 2).min(hair.len() - 1)];
        let clump = clumps[own.guide];
        let Some(large) = larges.get(&clump) else { unreachable!("every lock has a middle") };
        One { settings, own, middle, large, closing: &closing, clump, lock, index }.shape(skin)
    });
    shaped.collect()
}

/// The middle of a large lock.
struct Large<'a> {
    strand: &'a Strand,
    /// Directions across it at each point.
    across: Vec<[Vec3; 2]>,
}

/// Middles of the locks that `clumps` names.
fn larges<'a>(guides: &'a [Strand], clumps: &[u32]) -> HashMap<u32, Large<'a>> {
    let named: BTreeSet<u32> = clumps.iter().copied().collect();
    let large = |clump: u32| {
        let strand = &guides[clump as usize];
        (clump, Large { strand, across: frames(&strand.points, strand.root.normal) })
    };
    named.into_iter().map(large).collect()
}

/// Shares of the pull toward a small and a large lock that points of a strand have reached.
fn closing(settings: &StyleSettings) -> Vec<[f32; 2]> {
    let last = settings.points() - 1;
    let share = |point: usize| point as f32 / last as f32;
    (0..=last).map(|point| [math::powf(share(point), 0.7), closed(settings, share(point))]).collect()
}

/// A strand while it is shaped.
struct One<'a> {
    settings: &'a StyleSettings,
    own: &'a Between,
    /// In the middle of its small and of its large lock.
    middle: &'a Between,
    large: &'a Large<'a>,
    closing: &'a [[f32; 2]],
    clump: u32,
    lock: usize,
    index: usize,
}

impl One<'_> {
    fn shape(&self, skin: &Skin) -> Shaped {
        let mut random = Random::new(self.settings.seed, 7_000_000_000 + self.index as u64);
        let is_stray = random.unit() < self.settings.strays;
        let [pull, frizz, depth, thick] = std::array::from_fn(|_| random.unit());
        let strand = &self.own.strand;
        let length: f32 = strand.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let bends = Bends::in_lock(self.settings, strand, self.clump, self.lock, self.index);
        let wisp = Wisp::new(self.settings, &mut random, if is_stray { STRAY } else { 0.7 + 0.6 * frizz });
        let held = if is_stray { 0.15 } else { 0.7 + 0.5 * pull };
        let last = strand.points.len() - 1;
        let mut points: Vec<Vec3> = (0..=last)
            .map(|point| {
                let share = point as f32 / last as f32;
                let tangent = tangent(&strand.points, point);
                // Curls of a lock turn about one axis: its middle lends the directions across.
                let up = self.large.across[point][1];
                let up = (up - tangent * up.dot(tangent)).normalize_or(tangent.any_orthonormal_vector());
                let frame = [tangent.cross(up), up];
                let out = if is_stray { STRAY_OUT * share * share } else { 0.0 };
                self.drawn(point, held)
                    + bends.offset(self.settings, frame, share, length)
                    + wisp.offset(frame, share * length)
                    + up * out
            })
            .collect();
        points[0] = strand.root.position;
        let kept = self.kept(length, &mut random);
        let mut even: Vec<Vec3> = equal_arcs(&cut(points, kept), last + 1).collect();
        let clearance = CLEARANCE * (0.5 + 0.9 * depth);
        let step = even[0].distance(even[1]);
        for (index, point) in even.iter_mut().enumerate().skip(1) {
            let risen = (index as f32 * step / RISEN).clamp(LEAST_RISEN, 1.0);
            *point = skin.outside(*point, clearance * risen);
        }
        Shaped { points: even, width: width(thick, self.own.density) }
    }

    /// A point drawn toward the middles of both locks.
    fn drawn(&self, point: usize, held: f32) -> Vec3 {
        let [of_small, of_large] = self.closing[point];
        let toward = |here: Vec3, middle: Vec3, size: usize, most: f32, closed: f32| {
            let near = smooth(APART[size][0], APART[size][1], here.distance(middle));
            here.lerp(middle, (most * held).min(1.0) * closed * near)
        };
        let here = self.own.strand.points[point];
        let small = toward(here, self.middle.strand.points[point], 1, self.settings.lock_share, of_small);
        toward(small, self.large.strand.points[point], 0, self.settings.clump_share, of_large)
    }

    /// Share of its length that is left of a strand: its lock and itself are cut, and hair on the hairline is short.
    fn kept(&self, length: f32, random: &mut Random) -> f32 {
        let mut lock = Random::new(self.settings.seed, 8_000_000_000 + self.lock as u64);
        let [own, short, shorter] = std::array::from_fn(|_| random.unit());
        let cut = self.settings.thinning * (0.6 * lock.unit() + 1.6 * own.powi(3));
        let kept = (1.0 - cut).max(0.2);
        let [least, most] = SHORT_LENGTHS;
        let of_hairline = if self.settings.style.is_tied() { SHORT_TIED } else { SHORT };
        let is_short = short < of_hairline * (1.0 - self.own.density);
        let left = if is_short { (least + (most - least) * shorter) / length.max(1e-3) } else { 1.0 };
        kept.min(left)
    }
}

/// Diameter \[m\] of a strand by chance, 0 to 1, finer on the hairline.
pub(super) fn width(thick: f32, density: f32) -> f32 {
    WIDTH * (0.8 + 0.4 * thick) * (0.55 + 0.45 * density)
}

/// The unit tangent at a point of a strand.
fn tangent(points: &[Vec3], point: usize) -> Vec3 {
    let (before, after) = (point.saturating_sub(1), (point + 1).min(points.len() - 1));
    (points[after] - points[before]).normalize_or(Vec3::NEG_Y)
}

/// The first share of a strand.
fn cut(mut points: Vec<Vec3>, share: f32) -> Vec<Vec3> {
    let total: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let mut left = share * total;
    for point in 1..points.len() {
        let length = points[point].distance(points[point - 1]);
        if length >= left && share < 1.0 {
            points[point] = points[point - 1].lerp(points[point], left / length.max(f32::MIN_POSITIVE));
            points.truncate(point + 1);
            break;
        }
        left -= length;
    }
    points
}

/// A strand's own slow waves about its lock.
struct Wisp {
    amplitude: f32,
    /// Length \[m\] from the root by which it has them.
    grown: f32,
    phases: [f32; 4],
    /// Angles for each metre of length.
    rates: [f32; 4],
}

impl Wisp {
    fn new(settings: &StyleSettings, random: &mut Random, size: f32) -> Self {
        let phases = std::array::from_fn(|_| TAU * random.unit());
        // Waves of 4 to 8 cm: neighbours that touch part again within one of them.
        let rates = std::array::from_fn(|_| 80.0 + 77.0 * random.unit());
        let grown = if settings.style.is_tied() { WAVED_TIED } else { WAVED };
        Self { amplitude: settings.frizz * size, grown, phases, rates }
    }

    /// Offset \[m\] at a length along the strand \[m\].
    fn offset(&self, [side, up]: [Vec3; 2], along: f32) -> Vec3 {
        let wave = |which: usize| math::sin(self.phases[which] + self.rates[which] * along);
        let grown = self.amplitude * smooth(0.0, self.grown, along);
        grown * ((wave(0) + 0.5 * wave(1)) * side + (0.8 * wave(2) + 0.4 * wave(3)) * up)
    }
}
