//! Clumps, waves, curls and disorder, laid over the combed strands.

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use strandline_body::{Mannequin, Random};

use super::comb::{TIE, smooth};
use super::grow::{CLEARANCE, Strand, outside};
use super::{Style, StyleSettings};
use crate::Guides;

/// Shapes the strands; also tells the clump of each.
pub fn finish(
    settings: &StyleSettings,
    mannequin: &Mannequin,
    strands: Vec<Strand>,
) -> (Vec<Strand>, Vec<u32>) {
    let clumps = clumps(settings, &strands);
    let shaped = strands.par_iter().enumerate().map(|(index, strand)| {
        let center = &strands[clumps[index] as usize];
        let points = shape(settings, mannequin, strand, center, index, clumps[index]);
        Strand { root: strand.root, points }
    });
    let strands = shaped.collect();
    (strands, clumps)
}

/// For every strand the strand in the middle of its clump.
fn clumps(settings: &StyleSettings, strands: &[Strand]) -> Vec<u32> {
    let count = (strands.len() as f32 / settings.clump_size).ceil().max(1.0) as usize;
    let every = strands.len() as f32 / count as f32;
    let middles: Vec<u32> = (0..count)
        .map(|clump| ((clump as f32 + 0.5) * every) as u32)
        .map(|m| m.min(strands.len() as u32 - 1))
        .collect();
    let side = (count as f32).sqrt().ceil().clamp(1.0, 256.0) as usize;
    let square = |uv: Vec2| ((uv * side as f32).as_uvec2()).min(glam::UVec2::splat(side as u32 - 1));
    let mut squares = vec![Vec::new(); side * side];
    for &middle in &middles {
        let at = square(strands[middle as usize].root.uv);
        squares[at.y as usize * side + at.x as usize].push(middle);
    }
    strands
        .par_iter()
        .enumerate()
        .map(|(index, strand)| {
            let at = square(strand.root.uv).as_ivec2();
            let mut best = (f32::INFINITY, index as u32);
            for y in (at.y - 2).max(0)..=(at.y + 2).min(side as i32 - 1) {
                for x in (at.x - 2).max(0)..=(at.x + 2).min(side as i32 - 1) {
                    for &middle in &squares[y as usize * side + x as usize] {
                        let gap = strands[middle as usize].root.position.distance(strand.root.position);
                        if gap < best.0 {
                            best = (gap, middle);
                        }
                    }
                }
            }
            best.1
        })
        .collect()
}

fn shape(
    settings: &StyleSettings,
    mannequin: &Mannequin,
    strand: &Strand,
    center: &Strand,
    index: usize,
    clump: u32,
) -> Vec<Vec3> {
    let mut own = Random::new(settings.seed, 2_000_000_000 + index as u64);
    let mut shared = Random::new(settings.seed, 3_000_000_000 + u64::from(clump));
    let phase = std::f32::consts::TAU * shared.unit() + 0.9 * (own.unit() - 0.5);
    let stretch = 0.85 + 0.3 * shared.unit();
    let swing = [own.unit(), own.unit(), own.unit(), own.unit()].map(|unit| std::f32::consts::TAU * unit);
    let length: f32 = strand.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let last = strand.points.len() - 1;
    let frames = frames(&strand.points, strand.root.normal);
    let mut points: Vec<Vec3> = (0..=last)
        .map(|point| {
            let share = point as f32 / last as f32;
            let along = share * length;
            let [side, up] = frames[point];
            let mut place = clumped(settings, strand, center, point, share);
            let wave = settings.wave_amplitude * smooth(0.02, 0.14, along);
            let angle = phase + std::f32::consts::TAU * along / (settings.wave_length * stretch);
            place += wave * (angle.sin() * side + 0.35 * angle.cos() * up);
            let curl = settings.curl_radius * smooth(0.01, 0.10, along);
            let angle = phase + std::f32::consts::TAU * along / (settings.curl_length * stretch);
            place += curl * (angle.cos() * side + angle.sin() * up);
            let disorder = settings.noise * share;
            let [a, b] = [swing[0] + 25.0 * along, swing[1] + 41.0 * along];
            place + disorder * ((a.sin() + 0.5 * (swing[2] + b).sin()) * side + (swing[3] + a).sin() * up)
        })
        .collect();
    points[0] = strand.root.position;
    for point in &mut points[1..] {
        *point = outside(mannequin, *point, CLEARANCE);
    }
    let mut even: Vec<Vec3> = Guides::equal_arcs(&points, points.len()).collect();
    for point in &mut even[1..] {
        *point = outside(mannequin, *point, 0.7 * CLEARANCE);
    }
    even
}

/// A strand drawn toward the middle of its clump; in a tied tail toward the middle of the tail.
fn clumped(settings: &StyleSettings, strand: &Strand, center: &Strand, point: usize, share: f32) -> Vec3 {
    let here = strand.points[point];
    // Strands that parted ways, at the neck for example, do not meet again.
    let apart = here.distance(center.points[point]);
    let pull = settings.clump_share * share.powf(1.3) * smooth(0.05, 0.02, apart);
    let mut place = here.lerp(center.points[point], pull);
    if settings.style == Style::Ponytail {
        // The tail closes toward its tip and opens a little in its upper third.
        let fallen = smooth(TIE.y, TIE.y - 0.25, here.y) * smooth(-0.08, -0.11, here.z);
        place.x *= 1.0 + 1.2 * fallen * (1.0 - fallen);
    }
    place
}

/// Two directions across the strand at every point, turned as little as possible from the root on.
fn frames(points: &[Vec3], normal: Vec3) -> Vec<[Vec3; 2]> {
    let tangent = |index: usize| {
        let (before, after) = (index.saturating_sub(1), (index + 1).min(points.len() - 1));
        (points[after] - points[before]).normalize_or(Vec3::NEG_Y)
    };
    let mut up = normal;
    (0..points.len())
        .map(|index| {
            let tangent = tangent(index);
            up = (up - tangent * up.dot(tangent)).normalize_or(tangent.any_orthonormal_vector());
            [tangent.cross(up), up]
        })
        .collect()
}
