//! Hair and skin summed into the cells of the grid that carries scattered light.

use std::ops::Range;

use glam::Vec3;
use strandline_base::par::{self, prelude::*};
use wide::f32x4;

use super::light_scene::Scene;
use super::occlusion::GridBox;
use crate::Light;
use crate::cpu::ShadowBody;
use crate::lanes::rounded_up;

/// Most parts that the strands are shared out to.
const PARTS: usize = 4;
/// Largest value converted as 32 bits.
const MOST_SMALL: f32 = 1_073_741_824.0;
/// Whole numbers make sums that do not depend on their order: parts of a square metre, 2^40.
pub(crate) const UNITS: f32 = 1_099_511_627_776.0;
/// Sums of a cell's hair: its area, that times its direction, and behind these that times what reaches it of each light.
pub(crate) const HAIR_SUMS: usize = 4;
/// Depth \[cell\] below its surface at which skin is summed: spread over the cells around, it would hide the hair that
/// lies on it.
const SKIN_INSIDE: f32 = 0.5;
/// Sums of a cell's skin, behind those of its hair: area times normal, light on it, area times density of roots.
pub(crate) const SKIN_SUMS: usize = 7;

/// Sums both in parts, shape `[part][cell][sum]`.
pub(crate) fn sum(grid: &GridBox, scene: &Scene, parts: &mut Vec<Vec<i64>>) {
    let (cells, strands) = (grid.cell_count(), scene.strands);
    let width = HAIR_SUMS + scene.reached.len() + SKIN_SUMS;
    let count_of_parts = par::current_num_threads().clamp(1, PARTS);
    parts.resize_with(count_of_parts, Vec::new);
    parts.par_iter_mut().enumerate().for_each(|(part, sums)| {
        sums.clear();
        sums.resize(cells * width, 0);
        let range = |count: usize| count * part / count_of_parts..count * (part + 1) / count_of_parts;
        sum_hair(grid, scene, range(strands.strand_count), width, sums);
        if let Some((body, _)) = &scene.body {
            sum_skin(grid, scene, body, range(body.triangles.len()), width, sums);
        }
    });
}

/// Adds strands' segments: their area, that times their direction, and that times what reaches them of each light.
fn sum_hair(grid: &GridBox, scene: &Scene, range: Range<usize>, width: usize, sums: &mut [i64]) {
    let strands = scene.strands;
    let count = strands.points_per_strand;
    // Whole vectors; what is beyond the sums of hair adds nothing to those of skin.
    let mut values = vec![0.0; (width - SKIN_SUMS).next_multiple_of(4)];
    let mut quads = vec![f32x4::ZERO; values.len() / 4];
    let drawn = range.filter(|strand| strands.is_one_of(*strand, scene.summed));
    let stands_for = scene.summed.stands_for() as f32;
    for point in drawn.flat_map(|strand| strand * count..(strand + 1) * count - 1) {
        let (start, end) = (strands.positions[point], strands.positions[point + 1]);
        let way = end - start;
        let length = way.length();
        let longest = way.abs().max_element() / grid.cell;
        if !(length > 0.0 && longest < 1e4) {
            continue;
        }
        let pieces = rounded_up(longest).max(1) as f32;
        for piece in 0..pieces as usize {
            let along = (piece as f32 + 0.5) / pieces;
            let mix = |values: &[f32]| values[point] + (values[point + 1] - values[point]) * along;
            let area = length / pieces * mix(&strands.widths) * stands_for;
            values[0] = area;
            values[1..4].copy_from_slice(&(way * (area / length)).to_array());
            for (value, reached) in values[HAIR_SUMS..].iter_mut().zip(scene.reached) {
                *value = if reached.is_empty() { 0.0 } else { area * mix(reached) };
            }
            quads.iter_mut().zip(values.chunks(4)).for_each(|(to, values)| *to = quad(values));
            let small = values.iter().all(|value| value.abs() * UNITS < MOST_SMALL);
            grid.spread(start + way * along, |index, share| {
                let cell = &mut sums[index * width..][..width];
                if small {
                    add_small(cell, &quads, share);
                } else {
                    add(cell, &values[..width - SKIN_SUMS], share);
                }
            });
        }
    }
}

/// The first four of values, 0 beyond their end, in units.
#[inline]
fn quad(values: &[f32]) -> f32x4 {
    let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
    f32x4::from([at(0), at(1), at(2), at(3)]) * f32x4::splat(UNITS)
}

/// Adds a share of values.
#[inline]
fn add(sums: &mut [i64], values: &[f32], share: f32) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += (value * share * UNITS) as i64;
    }
}

/// [`add`] of values in units that 32 bits hold, to the same bits: units are a power of two.
#[inline]
fn add_small(sums: &mut [i64], quads: &[f32x4], share: f32) {
    let share = f32x4::splat(share);
    for (sums, quad) in sums.chunks_mut(4).zip(quads) {
        let parts = (*quad * share).fast_trunc_int().to_array();
        sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += i64::from(part));
    }
}

/// Adds skin: its area times its normal, light that meets it, and its area times the density of roots.
fn sum_skin(
    grid: &GridBox,
    scene: &Scene,
    body: &ShadowBody,
    range: Range<usize>,
    width: usize,
    sums: &mut [i64],
) {
    let lights: Vec<_> = scene.lights.iter().map(Light::shining).collect();
    for corners in &body.triangles[range] {
        let [a, b, c] = corners.map(|corner| body.positions[corner as usize]);
        let (ab, ac) = (b - a, c - a);
        let across = 0.5 * ab.cross(ac);
        let normal = across.normalize_or_zero();
        let longest = ab.length().max(ac.length()).max(b.distance(c)) / grid.cell;
        if !(longest < 1e3) || normal == Vec3::ZERO || !grid.holds(a.min(b).min(c), a.max(b).max(c)) {
            continue;
        }
        let rooted =
            Vec3::from(corners.map(|corner| body.roots.get(corner as usize).copied().unwrap_or(0.0)));
        let pieces = (2.0 * longest).ceil().max(1.0) as usize;
        let share = 1.0 / (pieces * pieces) as f32;
        for (first, second) in (0..pieces).flat_map(|row| (0..2 * row + 1).map(move |at| (row, at))) {
            // The middle of one of the equal triangles.
            let (row, at) = (first as f32, second as f32);
            let upright = second % 2 == 0;
            let along = (row + if upright { 2.0 / 3.0 } else { 1.0 / 3.0 }) / pieces as f32;
            let aside = (0.5 * at + if upright { 1.0 / 3.0 } else { 1.0 / 6.0 }) / pieces as f32;
            let place = a + ab * (along - aside) + ac * aside;
            let mut light = Vec3::ZERO;
            for (index, source) in lights.iter().enumerate() {
                let lit = source.at(place);
                let facing = normal.dot(lit.to_light);
                if facing > 0.0 {
                    let passed = scene.shadows.map(index).map_or(1.0, |map| map.reach(place));
                    light += lit.radiance * (facing * passed);
                }
            }
            let area = across * share;
            let light = light * area.length();
            let shares = Vec3::new(1.0 - along, along - aside, aside);
            let rooted = rooted.dot(shares) * area.length();
            let values = [area.x, area.y, area.z, light.x, light.y, light.z, rooted];
            let quads = [0, 4].map(|first| quad(&values[first..]));
            let small = values.iter().all(|value| value.abs() * UNITS < MOST_SMALL);
            grid.spread(place - normal * (SKIN_INSIDE * grid.cell), |index, share| {
                let sums = &mut sums[(index + 1) * width - SKIN_SUMS..][..SKIN_SUMS];
                if small { add_small(sums, &quads, share) } else { add(sums, &values, share) }
            });
        }
    }
}
