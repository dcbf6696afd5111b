//! Light that changes slowly with direction: spherical harmonics up to the second order, in plain numbers.

use glam::{Vec3, Vec4};

use crate::fibre::chiang::MOMENTS;

/// Numbers of a field, each of three channels.
pub const COEFFICIENTS: usize = 9;

/// Least radiance of a fibre in light from any direction, as a share of that in as much uniform light.
const LEAST_SHOWN: f32 = 0.1;

/// Radiance \[linear RGB\] from a unit direction w as `a + b.w + w.C.w` with a C without trace: a, b, and C's xx, yy,
/// xy, xz and yz.
pub type Field = [Vec4; COEFFICIENTS];

/// Weights of a unit direction with its radiance in the sum of the field over many directions.
#[inline]
pub fn weights(w: Vec3) -> [f32; COEFFICIENTS] {
    // Means over the sphere: w w = I / 3, and of w.C.w w w = 2 C / 15.
    [
        1.0,
        3.0 * w.x,
        3.0 * w.y,
        3.0 * w.z,
        7.5 * (w.x * w.x - 1.0 / 3.0),
        7.5 * (w.y * w.y - 1.0 / 3.0),
        7.5 * w.x * w.y,
        7.5 * w.x * w.z,
        7.5 * w.y * w.z,
    ]
}

/// Adds radiance from a unit direction, times its share of the sphere.
#[inline]
pub fn add(field: &mut Field, w: Vec3, light: Vec4) {
    for (sum, weight) in field.iter_mut().zip(weights(w)) {
        *sum += light * weight;
    }
}

/// Radiance from a unit direction.
#[inline]
pub fn radiance(field: &Field, w: Vec3) -> Vec4 {
    let [a, bx, by, bz, xx, yy, xy, xz, yz] = field;
    let second = *xx * (w.x * w.x - w.z * w.z)
        + *yy * (w.y * w.y - w.z * w.z)
        + (*xy * (w.x * w.y) + *xz * (w.x * w.z) + *yz * (w.y * w.z)) * 2.0;
    (*a + *bx * w.x + *by * w.y + *bz * w.z + second).max(Vec4::ZERO)
}

/// Radiance of a fibre of unit tangent `t` toward `u`, a unit vector across it; see
/// [`moments`](crate::fibre::chiang).
#[inline]
pub fn shown(field: &Field, moments: &[Vec4; MOMENTS], t: Vec3, u: Vec3) -> Vec4 {
    let [a, bx, by, bz, xx, yy, xy, xz, yz] = field;
    let along = *bx * t.x + *by * t.y + *bz * t.z;
    let across = *bx * u.x + *by * u.y + *bz * u.z;
    let product = |p: Vec3, q: Vec3| {
        *xx * (p.x * q.x - p.z * q.z)
            + *yy * (p.y * q.y - p.z * q.z)
            + *xy * (p.x * q.y + p.y * q.x)
            + *xz * (p.x * q.z + p.z * q.x)
            + *yz * (p.y * q.z + p.z * q.y)
    };
    let sum = moments[0] * *a
        + moments[1] * along
        + moments[2] * across
        + moments[3] * product(t, t)
        + moments[4] * product(u, u)
        + moments[5] * product(t, u);
    // The second order rings below 0 across strong light: no fibre is that dark where there is any.
    sum.max(moments[0] * *a * LEAST_SHOWN)
}

/// Light that meets a matte surface of unit normal, as the radiance of a white one.
#[inline]
pub fn on_surface(field: &Field, n: Vec3) -> Vec4 {
    let [a, bx, by, bz, xx, yy, xy, xz, yz] = field;
    let first = *bx * n.x + *by * n.y + *bz * n.z;
    let second = *xx * (n.x * n.x - n.z * n.z)
        + *yy * (n.y * n.y - n.z * n.z)
        + (*xy * (n.x * n.y) + *xz * (n.x * n.z) + *yz * (n.y * n.z)) * 2.0;
    // Over the cosine lobe: 1, 2/3 and 1/4 of the orders.
    (*a + first * (2.0 / 3.0) + second * 0.25).max(Vec4::ZERO)
}

/// A unit vector across `t` that points toward `to_eye`.
#[inline]
pub fn across(t: Vec3, to_eye: Vec3) -> Vec3 {
    (to_eye - t * t.dot(to_eye)).try_normalize().unwrap_or_else(|| t.any_orthonormal_vector())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere() -> impl Iterator<Item = Vec3> {
        (0..4000).map(|index| {
            let height = 1.0 - (2 * index + 1) as f32 / 4000.0;
            let flat = (1.0 - height * height).sqrt();
            let turn = index as f32 * 2.399_963_2;
            Vec3::new(flat * turn.cos(), flat * turn.sin(), height)
        })
    }

    #[test]
    fn a_field_gives_back_what_it_was_summed_from() {
        let light = |w: Vec3| 2.0 + 0.5 * w.x - 0.3 * w.z + 0.4 * (w.x * w.y) + 0.2 * (w.y * w.y - w.z * w.z);
        let mut field = Field::default();
        sphere().for_each(|w| add(&mut field, w, Vec4::splat(light(w) / 4000.0)));
        let n = Vec3::new(0.48, 0.6, 0.64);
        assert!((radiance(&field, n).x - light(n)).abs() < 2e-3, "{} {}", radiance(&field, n).x, light(n));
        let expected: f32 = sphere().map(|w| light(w) * 4.0 * w.dot(n).max(0.0) / 4000.0).sum();
        let found = on_surface(&field, n).x;
        assert!((found - expected).abs() < 2e-3, "{found} {expected}");
        // Light from one side is hardly taken for light from the other: the second order leaves 1 of 17.
        let mut field = Field::default();
        add(&mut field, Vec3::Y, Vec4::ONE);
        assert!(on_surface(&field, Vec3::NEG_Y).x < 0.06 * on_surface(&field, Vec3::Y).x);
    }
}
