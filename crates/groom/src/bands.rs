//! The ring of a band about tied hair.

use glam::{Vec2, Vec3};

use crate::{Guides, Tie};

/// Way \[m\] along the strands behind a tie at which its band lies: before it, hair still comes from all sides.
const BEHIND: f32 = 0.008;
/// Hair \[m\] behind a tie within which a strand passes through its band.
const PASSES: f32 = 0.03;
/// Share of the strands of a tie that pass through its band, at least: others wind about it.
const MOST: f32 = 0.5;
/// Share of these strands that lie within the band along each of its axes.
const WITHIN: f32 = 0.95;
/// Strands of a band, at least, and the most that are looked at.
const FEWEST: usize = 8;
const LOOKED_AT: usize = 2000;

/// An ellipse about the strands behind a tie, head space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Its middle \[m\].
    pub middle: Vec3,
    /// Its half axes \[m\], at right angles.
    pub half_axes: [Vec3; 2],
}

impl Guides {
    /// The ellipse about the strands that pass through a tie, across their mean direction and just behind it; none where
    /// they are few, or wind about the tie.
    pub fn band(&self, tie: &Tie) -> Option<Band> {
        let tied: Vec<usize> = (0..self.strand_count()).filter(|strand| self.passes(*strand, tie)).collect();
        let every = tied.len().div_ceil(LOOKED_AT).max(1);
        let ends: Vec<End> =
            tied.into_iter().step_by(every).map(|strand| End::new(self, strand, tie)).collect();
        let along = ends.iter().map(|end| end.at(2.0 * BEHIND) - end.places[0]).sum::<Vec3>();
        let along = along.try_normalize()?;
        let plane = mean(&ends.iter().map(|end| end.places[0]).collect::<Vec<_>>()) + BEHIND * along;
        let crossings: Vec<Vec3> = ends.iter().filter_map(|end| end.crossing(plane, along)).collect();
        if crossings.len() < FEWEST || (crossings.len() as f32) < MOST * ends.len() as f32 {
            return None;
        }
        Some(about(&crossings, along))
    }
}

/// A strand from its place nearest to a tie on.
struct End {
    places: Vec<Vec3>,
}

impl End {
    fn new(guides: &Guides, strand: usize, tie: &Tie) -> Self {
        let place = |point| guides.position(strand, point);
        let count = guides.points_per_strand();
        let nearest = (1..count).map(|end| {
            let (start, way) = (place(end - 1), place(end) - place(end - 1));
            let share = (tie.position - start).dot(way) / way.length_squared().max(1e-30);
            (end, start + way * share.clamp(0.0, 1.0))
        });
        let apart = |found: &(usize, Vec3)| found.1.distance_squared(tie.position);
        let Some((end, first)) = nearest.min_by(|one, other| apart(one).total_cmp(&apart(other))) else {
            return Self { places: vec![place(0)] };
        };
        Self { places: std::iter::once(first).chain((end..count).map(place)).collect() }
    }

    /// The place so far \[m\] behind the tie, or the tip.
    fn at(&self, mut way: f32) -> Vec3 {
        for pair in self.places.windows(2) {
            let length = pair[0].distance(pair[1]);
            if way <= length {
                return pair[0].lerp(pair[1], way / length.max(1e-30));
            }
            way -= length;
        }
        self.places.last().copied().unwrap_or_default()
    }

    /// The place in which it passes a plane soon behind the tie, in the direction of its normal.
    fn crossing(&self, plane: Vec3, normal: Vec3) -> Option<Vec3> {
        let mut way = 0.0;
        for pair in self.places.windows(2) {
            let [before, after] = [pair[0], pair[1]].map(|place| (place - plane).dot(normal));
            if before <= 0.0 && after > 0.0 {
                return Some(pair[0].lerp(pair[1], before / (before - after)));
            }
            way += pair[0].distance(pair[1]);
            if way > PASSES {
                break;
            }
        }
        None
    }
}

/// The ellipse about places in a plane: along the axes of their covariance, and as wide as most of them lie.
fn about(places: &[Vec3], normal: Vec3) -> Band {
    let middle = mean(places);
    let [first, second]: [Vec3; 2] = normal.any_orthonormal_pair().into();
    let flat: Vec<Vec2> = places
        .iter()
        .map(|place| Vec2::new((*place - middle).dot(first), (*place - middle).dot(second)))
        .collect();
    let sum = |of: fn(&Vec2) -> f32| flat.iter().map(of).sum::<f32>();
    let (across, mixed) = (sum(|at| at.x * at.x - at.y * at.y), sum(|at| 2.0 * at.x * at.y));
    // Half of the angle of (across, mixed) is that of the longer axis.
    let size = Vec2::new(across, mixed).length().max(1e-30);
    let cosine = (0.5 * (1.0 + across / size)).clamp(0.0, 1.0).sqrt();
    let sine = (0.5 * (1.0 - across / size)).clamp(0.0, 1.0).sqrt() * if mixed < 0.0 { -1.0 } else { 1.0 };
    let ways = [Vec2::new(cosine, sine), Vec2::new(-sine, cosine)];
    let half_axes = ways.map(|way| {
        let mut sizes: Vec<f32> = flat.iter().map(|at| at.dot(way).abs()).collect();
        sizes.sort_by(f32::total_cmp);
        let within = sizes[((sizes.len() - 1) as f32 * WITHIN) as usize];
        (first * way.x + second * way.y) * within
    });
    Band { middle, half_axes }
}

fn mean(places: &[Vec3]) -> Vec3 {
    places.iter().sum::<Vec3>() / places.len().max(1) as f32
}

#[cfg(test)]
mod tests {
    use strandline_base::math::{cos, sin};

    use super::*;
    use crate::Groom;

    /// Strands from all sides through an ellipse of half axes \[m\] about the z axis, and on along it.
    fn tail(half: [f32; 2]) -> Guides {
        let mut groom = Groom::empty(8e-5);
        for index in 0..400 {
            let (turn, out) = (index as f32 * 2.4, (index as f32 / 400.0).sqrt());
            let aside = Vec3::new(cos(turn) * out, sin(turn) * out, 0.0);
            let (far, near) = (0.1 * aside, aside * Vec3::new(half[0], half[1], 0.0));
            let place = |point: usize| {
                let along = point as f32 * 0.01 - 0.1;
                far.lerp(near, (point as f32 / 10.0).min(1.0)) + along * Vec3::Z
            };
            groom.push((0..24).map(place));
        }
        Guides::resample(&groom, 24).unwrap()
    }

    #[test]
    fn a_band_lies_about_the_tail_behind_its_tie() {
        let tie = Tie { position: Vec3::ZERO, radius: 0.02 };
        let Some(band) = tail([0.012, 0.006]).band(&tie) else { panic!("a tail has a band") };
        // Strands come nearest to the tie a little behind it.
        assert!(band.middle.distance(Vec3::Z * BEHIND) < 2e-3, "{band:?}");
        // Strands fill the ellipse evenly: 95 % lie within .85 of its half axes, as r = sqrt(1 - x^2) gives.
        let [long, short] = band.half_axes;
        assert!(
            long.z.abs() < 1e-4 && long.y.abs() < 1e-3 && (long.x.abs() / 0.012 - 0.85).abs() < 0.05,
            "{long}"
        );
        assert!(short.x.abs() < 1e-3 && (short.y.abs() / 0.006 - 0.85).abs() < 0.05, "{short}");
        assert_eq!(tail([0.012, 0.006]).band(&Tie { position: Vec3::splat(1.0), ..tie }), None, "no hair");
    }

    #[test]
    fn hair_that_winds_about_its_tie_has_no_band() {
        let mut groom = Groom::empty(8e-5);
        for index in 0..100 {
            let start = index as f32 * 0.063;
            let place = |point: usize| {
                let turn = start + point as f32;
                Vec3::new(cos(turn) * 0.02, sin(turn) * 0.02, 0.0)
            };
            groom.push((0..24).map(place));
        }
        let guides = Guides::resample(&groom, 24).unwrap();
        assert_eq!(guides.band(&Tie { position: Vec3::ZERO, radius: 0.03 }), None);
    }
}
