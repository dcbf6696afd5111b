//! Hair between guides: strands of their own that run with the combed guides about them.

use std::f32::consts::TAU;

use glam::Vec3;
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_body::{Mannequin, Random, Root, Scalp};

use super::comb::{WHORL, in_fringe, smooth};
use super::near::Near;
use super::strand::{Strand, before_hairline, nearer};
use super::{Style, StyleSettings};

/// Guides that a strand runs with at most.
const WITH: usize = 3;
/// Distance \[m\] added between a strand and a guide that falls to the other side.
const OTHER_SIDE: f32 = 0.02;
/// Distance \[m\] added between a strand of the fringe and a guide beside it.
const NOT_OF_FRINGE: f32 = 0.05;
/// Distance \[m\] of points of two guides from which they have parted ways: no strand runs between them.
const PARTED: f32 = 0.045;
/// Share of strands beside a parting that cross it, and how far from it they do \[m\].
const CROSSING: (f32, f32) = (0.05, 0.010);
/// Amplitude \[m\] by which a parting wanders.
const WANDER: f32 = 0.0022;
/// Distance \[m\] from the whorl within which strands lie across it, and how far aside they follow other guides \[m\].
const ACROSS_WHORL: (f32, f32) = (0.020, 0.012);
/// Height of a strand above the skin beside its root over that of the guides, and the way \[m\] along which it reaches
/// theirs: of hair that hangs, of hair that is tied, which lies along the head, and of hair that stands off the skin.
const HANGING: [f32; 2] = [0.15, 0.06];
const TIED: [f32; 2] = [0.25, 0.03];
const STANDING: [f32; 2] = [0.65, 0.03];
/// More roots than strands: those that a thin hairline leaves out.
const SPARE: f32 = 1.12;
/// Share of the roots on the hairline itself that grow.
const THINNEST: f32 = 0.4;
/// Breadth of the hairline of tied hair over that of other hair: drawn tight it shows more of itself.
const TIED_HAIRLINE: f32 = 0.25;

/// A strand between guides before it is shaped.
pub(super) struct Between {
    /// The strand, combed.
    pub strand: Strand,
    /// The guide that it is most like.
    pub guide: usize,
    /// Density of the hair about its root, 0 on the hairline to 1.
    pub density: f32,
}

/// Grows `count` strands among combed guides.
pub(super) fn between(
    settings: &StyleSettings,
    mannequin: &Mannequin,
    scalp: &Scalp,
    guides: &[Strand],
    count: usize,
) -> Vec<Between> {
    let places = guides.iter().map(|guide| guide.root.position).collect();
    let near = Near::new(places, scalp.area());
    let roots = roots(settings, scalp, guides, count);
    roots
        .into_par_iter()
        .enumerate()
        .map(|(index, (root, density))| {
            let mut root = nearer(settings, mannequin, scalp, root);
            let mut density = density;
            if settings.style.is_tied() {
                density = density.min(self::density(settings, scalp, &root));
                if !in_fringe(settings, &root) {
                    let chance = Random::new(settings.seed, 18_000_000_000 + index as u64).unit();
                    root = before_hairline(mannequin, scalp, root, chance);
                }
            }
            let (strand, guide) = beside(settings, guides, &near, root, index);
            Between { strand, guide, density }
        })
        .collect()
}

/// Roots among those of the guides, fewer toward the hairline, and the density about each.
fn roots(settings: &StyleSettings, scalp: &Scalp, guides: &[Strand], count: usize) -> Vec<(Root, f32)> {
    let others: Vec<Root> = guides.iter().map(|guide| guide.root).collect();
    let wanted = (count as f32 * SPARE).ceil() as usize;
    let found = scalp.roots_among(&others, wanted, settings.seed ^ 0x5eed);
    let densities: Vec<f32> = found.par_iter().map(|root| dense(settings.hairline, scalp, root)).collect();
    let mut random = Random::new(settings.seed, 4_000_000_000);
    let rated = found.into_iter().zip(densities).map(|(root, density)| {
        let grows = random.unit() < THINNEST + (1.0 - THINNEST) * density;
        (root, density, grows)
    });
    let rated: Vec<_> = rated.collect();
    let growing = rated.iter().filter(|root| root.2).count();
    // Evenly along the list, in which neighbours are neighbours on the skin.
    let is_kept = |index: usize, of: usize, take: usize| {
        (index + 1) as u64 * take as u64 / of as u64 != index as u64 * take as u64 / of as u64
    };
    let bare = rated.len() - growing;
    let (take, fill) = (growing.min(count), count.saturating_sub(growing));
    let (mut of_growing, mut of_bare) = (0, 0);
    let kept = rated.into_iter().filter(|(_, _, grows)| {
        let (index, of, take) =
            if *grows { (&mut of_growing, growing, take) } else { (&mut of_bare, bare, fill) };
        *index += 1;
        is_kept(*index - 1, of, take)
    });
    kept.map(|(root, density, _)| (root, density)).collect()
}

/// Density of the hair about a root of a style, 0 on the hairline to 1.
pub(super) fn density(settings: &StyleSettings, scalp: &Scalp, root: &Root) -> f32 {
    let breadth = if settings.style.is_tied() { TIED_HAIRLINE } else { 1.0 };
    dense(breadth * settings.hairline, scalp, root)
}

/// Density of hair about a root, 0 to 1, behind a hairline of a breadth \[m\].
fn dense(hairline: f32, scalp: &Scalp, root: &Root) -> f32 {
    smooth(0.0, hairline.max(1e-6), scalp.depth(root.position))
}

/// A strand that runs with the guides about its root, and the guide that it is most like.
fn beside(
    settings: &StyleSettings,
    guides: &[Strand],
    near: &Near,
    root: Root,
    index: usize,
) -> (Strand, usize) {
    let mut random = Random::new(settings.seed, 5_000_000_000 + index as u64);
    let falls = side(settings, &root, &mut random);
    let side = if in_fringe(settings, &root) { 0.0 } else { falls };
    let parted =
        if settings.style.is_parted() { smooth(WHORL.z, WHORL.z + 0.03, root.position.z) } else { 0.0 };
    let other_side = |guide: usize| match guides[guide].side {
        of_guide if of_guide == side => 0.0,
        of_guide if of_guide * side == 0.0 => NOT_OF_FRINGE,
        _ => OTHER_SIDE * parted,
    };
    let led = root.position + across_whorl(settings, &root, index);
    let found = near.nearest::<WITH>(led, other_side);
    let first = &guides[found[0].0];
    let weight = |(guide, distance): (usize, f32)| {
        let apart = |one: &Vec3, two: &Vec3| one.distance_squared(*two) > PARTED * PARTED;
        let parts = !distance.is_finite()
            || first.points.iter().zip(&guides[guide].points).any(|(one, two)| apart(one, two));
        if parts { 0.0 } else { 1.0 / (distance + 1e-3).powi(2) }
    };
    let weights = found.map(weight);
    let sum: f32 = weights.iter().sum();
    let weights = weights.map(|weight| weight / sum.max(f32::MIN_POSITIVE));
    let mut points: Vec<Vec3> = (0..first.points.len())
        .map(|point| {
            let of =
                found.iter().zip(&weights).map(|((guide, _), weight)| guides[*guide].points[point] * *weight);
            of.sum()
        })
        .collect();
    let aside = root.position - points[0];
    let last = points.len() - 1;
    let closes = if settings.style.is_tied() { 0.85 } else { 0.3 };
    for (point, place) in points.iter_mut().enumerate() {
        let share = point as f32 / last as f32;
        *place += aside * (1.0 - closes * smooth(0.0, 0.4, share));
    }
    points[0] = root.position;
    let flat = match settings.style {
        Style::Buzz | Style::Afro => STANDING,
        style if style.is_tied() => TIED,
        _ => HANGING,
    };
    lay_flat(&mut points, root.normal, flat);
    (Strand { root, side, points }, found[0].0)
}

/// Distance \[m\] of the guides that a strand follows from its root: strands about the whorl lie over each other, so that
/// none is bare.
fn across_whorl(settings: &StyleSettings, root: &Root, index: usize) -> Vec3 {
    let near = smooth(ACROSS_WHORL.0, 0.0, root.position.distance(WHORL));
    if near == 0.0 || settings.style.is_tied() || settings.style == Style::Afro {
        return Vec3::ZERO;
    }
    let mut random = Random::new(settings.seed, 13_000_000_000 + index as u64);
    let way = math::unit_at(TAU * random.unit()) * (near * random.unit().sqrt() * ACROSS_WHORL.1);
    let [first, second] = root.normal.any_orthonormal_pair().into();
    first * way.x + second * way.y
}

/// Side to which a strand falls: the parting wanders, and some strands cross it.
fn side(settings: &StyleSettings, root: &Root, random: &mut Random) -> f32 {
    let phase = TAU * Random::new(settings.seed, 6_000_000_000).unit();
    let along = root.position.z;
    let wander = math::sin(phase + 190.0 * along) + 0.6 * math::sin(2.0 * phase + 410.0 * along);
    let across = root.position.x - settings.parting + 0.6 * WANDER * wander + 0.001 * random.signed();
    let crosses = random.unit() < CROSSING.0 && across.abs() < CROSSING.1;
    if (across < 0.0) == crosses { 1.0 } else { -1.0 }
}

/// Draws the beginning of a strand toward the plane of the skin at its root, to a share of its height there.
fn lay_flat(points: &mut [Vec3], normal: Vec3, [flat, way]: [f32; 2]) {
    let root = points[0];
    let mut along = 0.0;
    let mut before = root;
    for point in &mut points[1..] {
        along += point.distance(before);
        before = *point;
        if along > way {
            break;
        }
        let height = (*point - root).dot(normal);
        let share = flat + (1.0 - flat) * smooth(0.0, way, along);
        *point -= normal * (height.max(0.0) * (1.0 - share));
    }
}
