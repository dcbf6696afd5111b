use glam::{Vec2, Vec3};

use crate::mannequin::Mannequin;
use crate::roots;

/// Where a strand leaves the skin, in head space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Position on the skin \[m\].
    pub position: Vec3,
    /// Unit normal of the skin, pointing out.
    pub normal: Vec3,
    /// Position on the scalp, 0..1 in both: the whorl is in the middle, the distance from there is
    /// the angle at the skull's centre.
    pub uv: Vec2,
}

/// The part of the skin on which hair grows.
#[derive(Clone, Debug)]
pub struct Scalp {
    mannequin: Mannequin,
}

/// Azimuth \[degrees\], 0 is the face and 180 the nape, and the height \[m\] above which hair grows.
const HAIRLINE: [(f32, f32); 12] = [
    (0.0, 0.062),
    (20.0, 0.064),
    (38.0, 0.058),
    (52.0, 0.034),
    (64.0, 0.008),
    (74.0, -0.026),
    (82.0, -0.030),
    (86.0, -0.002),
    (106.0, 0.000),
    (114.0, -0.040),
    (140.0, -0.066),
    (180.0, -0.074),
];

/// The centre of the skull \[m\], from which azimuth and uv are measured.
const CENTER: Vec3 = Vec3::new(0.0, 0.012, -0.004);
/// Direction of the whorl from the centre.
const WHORL: Vec3 = Vec3::new(0.10, 0.80, -0.59);
/// Angle \[rad\] from the whorl that uv = 0 or 1 stands for.
const UV_ANGLE: f32 = 2.6;

impl Scalp {
    pub(crate) fn new(mannequin: Mannequin) -> Self {
        Self { mannequin }
    }

    /// Unit vector from the skull's centre to the whorl.
    pub fn whorl(&self) -> Vec3 {
        WHORL.normalize()
    }

    /// How far inside the hairline a point of the skin lies \[m\], positive where hair grows.
    pub fn depth(&self, point: Vec3) -> f32 {
        let azimuth = point.x.abs().atan2(point.z - CENTER.z).to_degrees();
        let above = point.y - hairline(azimuth);
        // The ear and the crease around it are bare.
        let ear = Vec3::new(point.x.abs() - 0.083, (point.y + 0.034) * 0.5, (point.z + 0.008) * 0.8);
        above.min(ear.length() - 0.0165)
    }

    /// `count` roots spread evenly (blue noise) over the scalp; the same seed gives the same roots.
    /// They are ordered along a space-filling curve, so that neighbours are near in memory.
    pub fn roots(&self, count: usize, seed: u64) -> Vec<Root> {
        let triangles = roots::ScalpTriangles::new(&self.mannequin, |point| self.depth(point) > 0.0);
        let points = roots::spread(&triangles, &self.mannequin, count, seed);
        let mut found: Vec<Root> = points
            .into_iter()
            .map(|(position, normal)| Root { position, normal, uv: self.uv(position) })
            .collect();
        found.sort_by_cached_key(|root| roots::curve_index(root.uv));
        found
    }

    /// Position on the scalp, 0..1 in both.
    fn uv(&self, point: Vec3) -> Vec2 {
        let whorl = self.whorl();
        let direction = (point - CENTER).normalize_or(whorl);
        let angle = direction.dot(whorl).clamp(-1.0, 1.0).acos();
        let right = Vec3::Y.cross(whorl).normalize();
        let ahead = whorl.cross(right);
        let around = Vec2::new(direction.dot(right), direction.dot(ahead)).normalize_or_zero();
        (Vec2::splat(0.5) + 0.5 * angle / UV_ANGLE * around).clamp(Vec2::ZERO, Vec2::ONE)
    }
}

/// Height \[m\] of the hairline at an azimuth \[degrees\], smooth between the given ones.
fn hairline(azimuth: f32) -> f32 {
    let next = HAIRLINE.iter().position(|(at, _)| azimuth < *at).unwrap_or(HAIRLINE.len() - 1).max(1);
    let ((from, low), (to, high)) = (HAIRLINE[next - 1], HAIRLINE[next]);
    let share = ((azimuth - from) / (to - from)).clamp(0.0, 1.0);
    low + (high - low) * share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SignedDistance;

    #[test]
    fn roots_are_exact_even_and_the_same_every_time() {
        let mannequin = Mannequin::new();
        let scalp = mannequin.scalp();
        for count in [1, 8, 1750] {
            let roots = scalp.roots(count, 7);
            assert_eq!(roots.len(), count);
            for root in &roots {
                // Newton's steps end below a micrometre; f32 coordinates of 0.1 m hold 1e-8.
                assert!(mannequin.distance(root.position).abs() < 2e-6);
                // A triangle belongs to the scalp by its middle and reaches an edge beyond it.
                assert!(scalp.depth(root.position) > -3e-3, "{root:?}");
                assert!((root.normal.length() - 1.0).abs() < 1e-4);
                assert!(root.uv.cmpge(Vec2::ZERO).all() && root.uv.cmple(Vec2::ONE).all());
            }
            assert_eq!(roots, scalp.roots(count, 7));
        }
        assert_ne!(scalp.roots(100, 7), scalp.roots(100, 8));
    }

    #[test]
    fn no_two_roots_are_close_and_no_patch_is_bald() {
        let scalp = Mannequin::new().scalp();
        let roots = scalp.roots(1750, 3);
        let nearest = |point: Vec3, skip: usize| {
            let others = roots.iter().enumerate().filter(|(index, _)| *index != skip);
            others.map(|(_, other)| other.position.distance(point)).fold(f32::INFINITY, f32::min)
        };
        let gaps: Vec<f32> = (0..roots.len()).map(|index| nearest(roots[index].position, index)).collect();
        let mean = gaps.iter().sum::<f32>() / gaps.len() as f32;
        let least = gaps.iter().copied().fold(f32::INFINITY, f32::min);
        // Points of a Poisson process have a least gap near 0; evenly spread ones near the mean.
        assert!(least > 0.6 * mean, "least gap {least}, mean {mean}");
        let probes = scalp.roots(4000, 99);
        let bald = probes.iter().map(|probe| nearest(probe.position, usize::MAX)).fold(0.0, f32::max);
        // The farthest place of a maximal spread is one gap away; two would be a hole.
        assert!(bald < 1.7 * mean, "a place {bald} m from any root, mean gap {mean}");
    }
}
