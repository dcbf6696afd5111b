//! The ball that roots lie on, and how much of it they cover: a head of hair, a patch, or fur.

use std::f32::consts::TAU;

use glam::{DMat3, DVec3, Vec3};
use strandline_base::math;

/// Directions from a middle that roots may lie in.
const DIRECTIONS: usize = 120;
/// Shares of the directions that are those of a full head of hair: more than a beard and less than fur.
pub const FULL: std::ops::Range<f32> = 0.18..0.85;
/// Least share that is surely no beard around a ball through its roots, which may cover as much as little hair does.
pub const SURELY_FULL: f32 = 0.3;
/// Volume of roots over the cube of their size below which they lie in a plane.
const FLAT: f64 = 1e-5;

/// A ball through roots, in their units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootBall {
    /// Its middle, in units of the roots.
    pub middle: Vec3,
    /// Its radius, in the same units.
    pub radius: f32,
}

impl RootBall {
    /// The ball that roots lie nearest to; none where they lie in a plane.
    pub fn through(roots: &[Vec3]) -> Option<Self> {
        let count = roots.len() as f64;
        let middle = roots.iter().map(|root| root.as_dvec3()).sum::<DVec3>() / count.max(1.0);
        let (mut spread, mut pull) = (DMat3::ZERO, DVec3::ZERO);
        for root in roots {
            let beside = root.as_dvec3() - middle;
            spread +=
                DMat3::from_cols(beside * beside.x, beside * beside.y, beside * beside.z) * (1.0 / count);
            pull += beside * (beside.length_squared() / count);
        }
        let size = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        if spread.determinant().abs() <= FLAT * size * size * size {
            return None;
        }
        // The least squares of |p|^2 = 2 c p + k.
        let middle = (middle + 0.5 * (spread.inverse() * pull)).as_vec3();
        let radius = roots.iter().map(|root| root.distance(middle)).sum::<f32>() / count as f32;
        Some(Self { middle, radius })
    }
}

/// Share of the directions from a middle in which roots lie.
pub fn covered(roots: &[Vec3], middle: Vec3) -> f32 {
    let mut has = [false; DIRECTIONS];
    for root in roots {
        let way = (*root - middle).normalize_or_zero();
        let alike = |index: usize| direction(index).dot(way);
        let nearest = (1..DIRECTIONS).fold(0, |best, one| if alike(one) > alike(best) { one } else { best });
        has[nearest] = true;
    }
    has.iter().filter(|has| **has).count() as f32 / DIRECTIONS as f32
}

/// One of many directions, spread evenly.
fn direction(index: usize) -> Vec3 {
    let height = 1.0 - (2 * index + 1) as f32 / DIRECTIONS as f32;
    let (flat, around) = ((1.0 - height * height).sqrt(), (0.618_034 * index as f32).fract() * TAU);
    let beside = math::unit_at(around) * flat;
    Vec3::new(beside.x, height, beside.y)
}
