mod elimination;
mod hairline;

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use strandline_base::math;
use strandline_base::par::prelude::*;

use crate::scalp_place::{CENTER, uv};
use crate::{Mannequin, Random, SignedDistance};

/// Root of a strand on the skin, in head space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Position on the skin \[m\].
    pub position: Vec3,
    /// Unit normal of the skin, pointing out.
    pub normal: Vec3,
    /// Position on the scalp, 0..1 in both: the crown in the middle, angle and distance from it kept.
    pub uv: Vec2,
}

/// The part of the skin on which hair grows: above a hairline that runs over forehead and temples,
/// in front of, over and behind the ears, and across the nape.
#[derive(Clone, Debug)]
pub struct Scalp {
    mannequin: Mannequin,
    /// Distance \[m\] of the skin from [`CENTER`], shape `[polar][azimuth]`.
    radii: Vec<f32>,
    /// Twice the skin area \[m^2\] up to and including each cell, shape `[polar][azimuth]`.
    areas: Vec<f32>,
}

/// Cells around the vertical axis.
const AZIMUTHS: usize = 72;
/// Cells from the vertex downward.
const POLARS: usize = 54;
/// Angle from the vertical \[rad\] that reaches below the nape.
const LOWEST: f32 = 2.55;
/// Bare skin around the root of an ear \[m\].
const EAR_MARGIN: f32 = 0.0025;
/// Candidates for each root.
const CANDIDATES: usize = 4;
/// Candidates for each root among others: with fewer growing is faster, and roots are less even.
const CANDIDATES_AMONG: usize = 3;
/// Up to this count roots are chosen by elimination; above it one in each stretch of a space-filling curve.
const ELIMINATED: usize = 60_000;

impl Mannequin {
    /// The part of the skin on which hair grows.
    pub fn scalp(&self) -> Scalp {
        Scalp::new(self.clone())
    }
}

impl Scalp {
    fn new(mannequin: Mannequin) -> Self {
        let corner_count = (POLARS + 1) * AZIMUTHS;
        let radii: Vec<f32> = (0..corner_count)
            .into_par_iter()
            .map(|corner| {
                skin_radius(&mannequin, direction((corner / AZIMUTHS) as f32, (corner % AZIMUTHS) as f32))
            })
            .collect();
        let mut scalp = Self { mannequin, radii, areas: Vec::new() };
        let mut total = 0.0;
        scalp.areas = (0..POLARS * AZIMUTHS)
            .map(|cell| {
                let corner = |polar: usize, azimuth: usize| {
                    let (polar, azimuth) =
                        ((cell / AZIMUTHS + polar) as f32, (cell % AZIMUTHS + azimuth) as f32);
                    scalp.guess(polar, azimuth)
                };
                let diagonals = (corner(1, 1) - corner(0, 0), corner(1, 0) - corner(0, 1));
                total += diagonals.0.cross(diagonals.1).length();
                total
            })
            .collect();
        scalp
    }

    /// True if hair grows at a place on the skin \[m\].
    pub fn contains(&self, position: Vec3) -> bool {
        self.height_above_hairline(position) > 0.0 && !self.mannequin.is_ear_within(position, EAR_MARGIN)
    }

    /// Coordinates of a place on the skin \[m\] on the scalp, as [`Root::uv`].
    pub fn uv(position: Vec3) -> Vec2 {
        uv(position)
    }

    /// Height \[m\] of a place on the skin above the hairline there, negative on bare skin.
    pub fn height_above_hairline(&self, position: Vec3) -> f32 {
        position.y - hairline::height(math::atan2(position.x.abs(), position.z))
    }

    /// Distance \[m\] of a place on the scalp from its border, to a few parts in ten.
    pub fn depth(&self, position: Vec3) -> f32 {
        let azimuth = math::atan2(position.x.abs(), position.z);
        // The hairline is steep at the temples: a height above it is more than the distance.
        let around = position.with_y(0.0).length().max(1e-3);
        let beside = hairline::height(azimuth + 0.06) - hairline::height(azimuth - 0.06);
        let slope = beside / (0.12 * around);
        let from_hairline = self.height_above_hairline(position) / (1.0 + slope * slope).sqrt();
        from_hairline.min(self.mannequin.ear_distance(position) - EAR_MARGIN)
    }

    /// Area \[m^2\], to a few parts in a hundred.
    pub fn area(&self) -> f32 {
        let cells = (0..POLARS * AZIMUTHS).filter(|&cell| {
            let (polar, azimuth) = ((cell / AZIMUTHS) as f32, (cell % AZIMUTHS) as f32);
            self.contains(self.guess(polar + 0.5, azimuth + 0.5))
        });
        // The table sums cross products of diagonals, twice the area of each cell.
        0.5 * cells
            .map(|cell| self.areas[cell] - if cell > 0 { self.areas[cell - 1] } else { 0.0 })
            .sum::<f32>()
    }

    /// `count` roots spread evenly (blue noise) over the scalp; the same seed gives the same roots.
    ///
    /// Up to 60,000 roots are left over from four times as many by taking away the most crowded
    /// \[Yuksel2015\]; more are drawn one from each stretch of a space-filling curve. Neighbours in the
    /// list are neighbours on the skin.
    pub fn roots(&self, count: usize, seed: u64) -> Vec<Root> {
        if count > ELIMINATED {
            return self.stretched(count, seed);
        }
        let mut candidates = self.candidates(count * CANDIDATES, seed);
        candidates.par_sort_by_cached_key(|root| curve_index(root.uv));
        let positions: Vec<Vec3> = candidates.iter().map(|root| root.position).collect();
        let kept = elimination::kept(&positions, 0, count);
        kept.into_iter().map(|index| candidates[index]).collect()
    }

    /// One root of each stretch of the curve. Only those that are chosen are led onto the skin.
    fn stretched(&self, count: usize, seed: u64) -> Vec<Root> {
        let guess = |index: u64| {
            let guess = self.random_guess(&mut Random::new(seed, index));
            self.contains(guess).then_some(guess)
        };
        let mut guesses = many(count * CANDIDATES, guess);
        guesses.par_sort_by_cached_key(|guess| curve_index(uv(*guess)));
        let chosen = |stretch: usize| {
            let first = stretch * CANDIDATES + Random::new(seed, stretch as u64).bits() as usize % CANDIDATES;
            // One in some thousands lies beside the border.
            let mut onward = guesses[first..].iter().chain(&guesses);
            onward.find_map(|guess| self.root_at(*guess))
        };
        (0..count).into_par_iter().filter_map(chosen).collect()
    }

    /// `count` further roots among others, spread evenly (blue noise) with them, as in [`Scalp::roots`]. More than
    /// 60,000 in all take no notice of the others.
    pub fn roots_among(&self, others: &[Root], count: usize, seed: u64) -> Vec<Root> {
        if others.len() + count > ELIMINATED {
            return self.roots(count, seed);
        }
        let mut candidates = self.candidates(count * CANDIDATES_AMONG, seed);
        candidates.par_sort_by_cached_key(|root| curve_index(root.uv));
        let positions: Vec<Vec3> = others.iter().chain(&candidates).map(|root| root.position).collect();
        let kept = elimination::kept(&positions, others.len(), others.len() + count);
        kept.into_iter().skip(others.len()).map(|index| candidates[index - others.len()]).collect()
    }

    /// Independent random places, equally likely everywhere on the scalp.
    fn candidates(&self, count: usize, seed: u64) -> Vec<Root> {
        many(count, |index| {
            let guess = self.random_guess(&mut Random::new(seed, index));
            if self.height_above_hairline(guess) < -0.01 { None } else { self.root_at(guess) }
        })
    }

    /// A random place near the skin \[m\].
    fn random_guess(&self, random: &mut Random) -> Vec3 {
        let wanted = random.unit() * self.areas[self.areas.len() - 1];
        let cell = self.areas.partition_point(|&area| area <= wanted).min(self.areas.len() - 1);
        let polar = (cell / AZIMUTHS) as f32 + random.unit();
        let azimuth = (cell % AZIMUTHS) as f32 + random.unit();
        self.guess(polar, azimuth)
    }

    /// The root nearest to a place near the skin \[m\], if hair grows there.
    fn root_at(&self, guess: Vec3) -> Option<Root> {
        let (position, distance, normal) = self.mannequin.settled(guess);
        (distance.abs() < 1e-5 && self.contains(position)).then(|| Root {
            position,
            normal,
            uv: uv(position),
        })
    }

    /// A place near the skin \[m\], from the table.
    fn guess(&self, polar: f32, azimuth: f32) -> Vec3 {
        let (row, column) = ((polar as usize).min(POLARS - 1), azimuth as usize);
        let (down, along) = (polar - row as f32, azimuth - column as f32);
        let radius = |row: usize, column: usize| self.radii[row * AZIMUTHS + column % AZIMUTHS];
        let upper = radius(row, column) * (1.0 - along) + radius(row, column + 1) * along;
        let lower = radius(row + 1, column) * (1.0 - along) + radius(row + 1, column + 1) * along;
        CENTER + direction(polar, azimuth) * (upper * (1.0 - down) + lower * down)
    }
}

/// The first `count` things that are found by their index; about half of the indices find one.
fn many<T: Send>(count: usize, find: impl Fn(u64) -> Option<T> + Sync) -> Vec<T> {
    let mut found = Vec::new();
    let mut tried = 0;
    while found.len() < count {
        let batch = (2 * (count - found.len())).max(64) as u64;
        found.par_extend((tried..tried + batch).into_par_iter().filter_map(&find));
        tried += batch;
    }
    found.truncate(count);
    found
}

/// Direction of a place in the table.
fn direction(polar: f32, azimuth: f32) -> Vec3 {
    let (sine, cosine) = math::sin_cos(polar * LOWEST / POLARS as f32);
    let (across, along) = math::sin_cos(azimuth * TAU / AZIMUTHS as f32);
    Vec3::new(sine * across, cosine, sine * along)
}

/// Distance \[m\] from [`CENTER`] to the skin, found by stepping outward by the depth.
fn skin_radius(mannequin: &Mannequin, direction: Vec3) -> f32 {
    let mut radius = 0.05;
    for _ in 0..24 {
        let depth = -mannequin.distance(CENTER + direction * radius);
        if depth < 1e-4 || radius > 0.16 {
            break;
        }
        radius += depth;
    }
    radius
}

/// Place along the Hilbert curve of order 16 over the unit square \[Hilbert1891\].
fn curve_index(uv: Vec2) -> u32 {
    const ORDER: u32 = 16;
    let most = ((1u32 << ORDER) - 1) as f32;
    let (mut x, mut y) = ((uv.x * most) as u32, (uv.y * most) as u32);
    let mut index = 0;
    for level in (0..ORDER).rev() {
        let (right, upper) = ((x >> level) & 1, (y >> level) & 1);
        index = (index << 2) | ((3 * right) ^ upper);
        let mask = (1 << level) - 1;
        x &= mask;
        y &= mask;
        if upper == 0 {
            if right == 1 {
                (x, y) = (mask - x, mask - y);
            }
            (x, y) = (y, x);
        }
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn scalp() -> (Arc<Mannequin>, Scalp) {
        let mannequin = Mannequin::new();
        let scalp = mannequin.scalp();
        (mannequin, scalp)
    }

    #[test]
    fn roots_lie_on_the_scalp_in_the_wanted_number() {
        let (mannequin, scalp) = scalp();
        for (count, seed) in [(1, 5), (700, 1), (700, 2)] {
            let roots = scalp.roots(count, seed);
            assert_eq!(roots.len(), count);
            for root in &roots {
                // Newton steps end within f32 rounding of 0.1 m.
                assert!(mannequin.distance(root.position).abs() < 1e-5);
                assert!(scalp.contains(root.position));
                assert!((root.normal.length() - 1.0).abs() < 1e-5);
                assert!(root.uv.min_element() >= 0.0 && root.uv.max_element() <= 1.0);
            }
        }
    }

    #[test]
    fn the_seed_decides() {
        let (_, scalp) = scalp();
        assert_eq!(scalp.roots(300, 4), scalp.roots(300, 4));
        assert_ne!(scalp.roots(300, 4), scalp.roots(300, 5));
    }

    #[test]
    fn the_spread_is_even_and_leaves_no_bald_patch() {
        let (_, scalp) = scalp();
        let roots = scalp.roots(1000, 9);
        let nearest = |place: Vec3, own: usize| {
            let others = roots.iter().enumerate().filter(|(index, _)| *index != own);
            others.map(|(_, root)| root.position.distance(place)).fold(f32::MAX, f32::min)
        };
        let gaps: Vec<f32> =
            roots.iter().enumerate().map(|(index, root)| nearest(root.position, index)).collect();
        let mean = gaps.iter().sum::<f32>() / gaps.len() as f32;
        let deviation = (gaps.iter().map(|gap| (gap - mean).powi(2)).sum::<f32>() / gaps.len() as f32).sqrt();
        // Independent places would give 0.52 [Clark1954]; a hexagonal lattice 0.
        assert!(deviation / mean < 0.2, "{}", deviation / mean);
        assert!(gaps.iter().all(|&gap| gap > 0.4 * mean));
        let widest = scalp
            .candidates(4000, 77)
            .iter()
            .map(|root| nearest(root.position, usize::MAX))
            .fold(0.0, f32::max);
        // The farthest place of a hexagonal lattice lies at 0.58 of its gap, at an edge at 1; random places reach 3.
        assert!(widest < 1.6 * mean, "{}", widest / mean);
    }

    #[test]
    fn the_area_is_that_of_a_scalp() {
        let (_, scalp) = scalp();
        // A person's scalp has 0.05 to 0.08 m^2.
        assert!((0.05..0.08).contains(&scalp.area()), "{}", scalp.area());
    }

    #[test]
    fn neighbours_in_the_list_are_near() {
        let (_, scalp) = scalp();
        let roots = scalp.roots(1000, 3);
        let steps = roots.windows(2).map(|pair| pair[0].position.distance(pair[1].position));
        // About 8 mm apart on average when sorted, 120 mm when shuffled.
        assert!(steps.sum::<f32>() / 999.0 < 0.016);
    }

    #[test]
    fn many_roots_are_drawn_along_the_curve() {
        let (mannequin, scalp) = scalp();
        let roots = scalp.roots(ELIMINATED + 1, 1);
        assert_eq!(roots.len(), ELIMINATED + 1);
        let grows =
            |root: &Root| mannequin.distance(root.position).abs() < 1e-5 && scalp.contains(root.position);
        assert!(roots.iter().all(grows));
        let mut places: Vec<[u32; 3]> =
            roots.iter().map(|root| root.position.to_array().map(f32::to_bits)).collect();
        places.sort_unstable();
        places.dedup();
        // One in some thousands may have moved to the root of the next stretch.
        assert!(places.len() as f32 > 0.999 * roots.len() as f32, "{} places", places.len());
        let right = roots.iter().filter(|root| root.position.x > 0.0).count() as f32 / roots.len() as f32;
        // Stratified: far better than the standard error of 0.002 of independent draws.
        assert!((right - 0.5).abs() < 0.004, "{right}");
    }
}
