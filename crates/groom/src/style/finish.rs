//! Clumps, waves, curls and disorder, laid over the combed strands.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_body::{Random, Scalp};

use super::comb::smooth;
use super::skin::Skin;
use super::strand::{CLEARANCE, Strand};
use super::{Style, StyleSettings};
use crate::arcs::equal_arcs;

/// Angle \[rad\] by which disorder of a strand in a lock of curls is out of step with that of the lock.
const OUT_OF_STEP: f32 = 0.7;
/// Shares of their length between which curls close to locks, and the pull of these over that of other locks.
const CURLS_CLOSE: [f32; 2] = [0.04, 0.35];
const CURLS_HELD: f32 = 1.2;
/// Length \[m\] from the root by which curls have their radius, and the same of an afro, whose coils hide the scalp.
const CURLED: f32 = 0.08;
const CURLED_AFRO: f32 = 0.05;
/// Most of the way to the middle of its lock that a guide is drawn: none is a copy of another.
const MOST_PULL: f32 = 0.85;

/// The shaped strands, and the clump of each.
pub fn finish(
    settings: &StyleSettings,
    skin: &Skin,
    scalp: &Scalp,
    strands: &[Strand],
) -> (Vec<Strand>, Vec<u32>) {
    let count = (scalp.area() / settings.clump_width.powi(2)).ceil() as usize;
    let clumps = clumps(count.clamp(1, strands.len()), strands);
    let shaped = strands.par_iter().enumerate().map(|(index, strand)| {
        let center = &strands[clumps[index] as usize];
        let points = shape(settings, skin, strand, center, index, clumps[index]);
        Strand { root: strand.root, side: strand.side, points }
    });
    let strands = shaped.collect();
    (strands, clumps)
}

/// For every strand the strand in the middle of its clump.
fn clumps(count: usize, strands: &[Strand]) -> Vec<u32> {
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
                        let other = &strands[middle as usize];
                        let gap = other.root.position.distance(strand.root.position);
                        let alike = (other.side == 0.0) == (strand.side == 0.0);
                        if gap < best.0 && alike {
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
    skin: &Skin,
    strand: &Strand,
    center: &Strand,
    index: usize,
    clump: u32,
) -> Vec<Vec3> {
    let length: f32 = strand.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let last = strand.points.len() - 1;
    let bends = Bends::new(settings, strand, index, clump);
    let mut points: Vec<Vec3> = frames(&strand.points, strand.root.normal)
        .into_iter()
        .enumerate()
        .map(|(point, frame)| {
            let share = point as f32 / last as f32;
            clumped(settings, strand, center, point, share) + bends.offset(settings, frame, share, length)
        })
        .collect();
    points[0] = strand.root.position;
    for point in &mut points[1..] {
        *point = skin.outside(*point, CLEARANCE);
    }
    let mut even: Vec<Vec3> = equal_arcs(&points, points.len()).collect();
    for point in &mut even[1..] {
        *point = skin.outside(*point, 0.7 * CLEARANCE);
    }
    even
}

/// The choices that bend a strand: those of its clump and its own.
pub(super) struct Bends {
    wave_phase: f32,
    curl_phase: f32,
    /// Turning sense and radius of the curl, 1 on average in size.
    curl: f32,
    /// Rate of waves and curls, 1 on average.
    rate: f32,
    swing: [f32; 4],
}

impl Bends {
    fn new(settings: &StyleSettings, strand: &Strand, index: usize, clump: u32) -> Self {
        let mut own = Random::new(settings.seed, 2_000_000_000 + index as u64);
        let (wave_phase, curl_phase, curl, rate) = Self::shared(settings, strand, clump);
        Self {
            wave_phase: wave_phase + 0.5 * (own.unit() - 0.5),
            curl_phase: curl_phase + 0.9 * (own.unit() - 0.5),
            curl: curl * (0.9 + 0.2 * own.unit()),
            rate: rate + 0.04 * (own.unit() - 0.5),
            swing: [(); 4].map(|()| TAU * own.unit()),
        }
    }

    /// Phases of waves and curls, size and rate that all strands of a clump have.
    fn shared(settings: &StyleSettings, strand: &Strand, clump: u32) -> (f32, f32, f32, f32) {
        let mut shared = Random::new(settings.seed, 3_000_000_000 + u64::from(clump));
        let sense = if shared.unit() < 0.5 { -1.0 } else { 1.0 };
        // Waves of neighbouring clumps run side by side; curls do not.
        let place = strand.root.position;
        let together =
            2.5 * math::sin(31.0 * place.z + 1.3) + 2.0 * math::sin(23.0 * place.y + 17.0 * place.x);
        let wave_phase = together + 1.1 * (shared.unit() - 0.5);
        let curl_phase = TAU * shared.unit();
        (wave_phase, curl_phase, sense * (0.65 + 0.7 * shared.unit()), 0.8 + 0.4 * shared.unit())
    }

    /// Choices of a strand of a small lock in a clump: the lock has some of its own, the strand few.
    pub fn in_lock(settings: &StyleSettings, strand: &Strand, clump: u32, lock: usize, index: usize) -> Self {
        let mut bends = Self::new(settings, strand, index, clump);
        let mut own = Random::new(settings.seed, 9_000_000_000 + index as u64);
        let mut shared = Random::new(settings.seed, 10_000_000_000 + lock as u64);
        let (turn, size) = (shared.signed(), shared.signed());
        // Choices of the clump alone, but for the swing.
        let middle = Self::shared(settings, strand, clump);
        bends.wave_phase = middle.0 + 0.3 * turn + 0.12 * own.signed();
        bends.curl_phase = middle.1 + 0.35 * turn + 0.15 * own.signed();
        bends.curl = middle.2 * (1.0 + 0.12 * size + 0.06 * own.signed());
        bends.rate = middle.3 * (1.0 + 0.006 * size);
        if settings.is_curled() {
            // A lock of curls strays as a whole.
            let mut lock = Random::new(settings.seed, 14_000_000_000 + u64::from(clump));
            bends.swing = [(); 4].map(|()| TAU * lock.unit() + OUT_OF_STEP * own.signed());
        }
        bends
    }

    /// Distance \[m\] by which a strand is bent aside at a share of its length \[m\].
    pub fn offset(&self, settings: &StyleSettings, [side, up]: [Vec3; 2], share: f32, length: f32) -> Vec3 {
        let along = share * length;
        let wave = settings.wave_amplitude * smooth(0.02, 0.16, along);
        let curled = if settings.style == Style::Afro { CURLED_AFRO } else { CURLED };
        let curl = settings.curl_radius * smooth(0.005, curled, along);
        let (mut waved, mut coiled) = (Vec3::ZERO, Vec3::ZERO);
        if wave > 0.0 {
            let wave_rate = 1.0 + 0.5 * (self.rate - 1.0);
            let angle = self.wave_phase + TAU * wave_rate * along / settings.wave_length;
            waved = wave * (math::sin(angle) * side + 0.4 * math::cos(angle) * up);
        }
        if curl > 0.0 {
            let angle = self.curl_phase + TAU * self.rate * along / settings.curl_length;
            coiled = curl * (self.curl * math::cos(angle) * side + self.curl.abs() * math::sin(angle) * up);
        }
        let [a, b] = [self.swing[0] + 25.0 * along, self.swing[1] + 41.0 * along];
        let disorder = settings.noise * share;
        let loose =
            (math::sin(a) + 0.5 * math::sin(self.swing[2] + b)) * side + math::sin(self.swing[3] + a) * up;
        waved + coiled + disorder * loose
    }
}

/// Share of the pull toward a lock that is reached at a share of a strand's length. Curls close to locks that are thinner
/// than curls are wide by a third of their length: wider ones are a bush.
pub(super) fn closed(settings: &StyleSettings, share: f32) -> f32 {
    if settings.is_curled() {
        CURLS_HELD * smooth(CURLS_CLOSE[0], CURLS_CLOSE[1], share)
    } else {
        math::powf(share, 1.3)
    }
}

/// A strand drawn toward the middle of its clump.
fn clumped(settings: &StyleSettings, strand: &Strand, center: &Strand, point: usize, share: f32) -> Vec3 {
    let here = strand.points[point];
    // Strands that parted ways, at the neck for example, do not meet again.
    let apart = here.distance(center.points[point]);
    let pull = (settings.clump_share * closed(settings, share)).min(MOST_PULL) * smooth(0.05, 0.02, apart);
    here.lerp(center.points[point], pull)
}

/// Two directions across the strand at every point, turned as little as possible from the root on.
pub(super) fn frames(points: &[Vec3], normal: Vec3) -> Vec<[Vec3; 2]> {
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
