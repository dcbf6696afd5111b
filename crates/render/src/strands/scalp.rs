//! Density of roots about places of the body: skin among them is darker, and of the hair's colour.

use std::collections::HashMap;

use glam::{IVec3, Vec3};
use strandline_base::par::prelude::*;
use strandline_groom::Guides;

/// Share of the surface of the box around the roots on which they lie.
const COVERED: f32 = 0.4;
/// One in this many roots at either end of an axis is ignored as a stray, which is no part of the scalp.
const STRAYS: usize = 50;

/// Factor of the colour of skin about which roots are so dense, 0 to 1, by that among dense ones. Its twin is in
/// gpu/common.wesl.
pub(crate) fn tint(among_dense: Vec3, density: f32) -> Vec3 {
    Vec3::ONE.lerp(among_dense, density)
}

/// Density of roots about every vertex over their mean density, 0 to 1; head space.
pub fn root_densities(vertices: &[Vec3], guides: &Guides) -> Vec<f32> {
    let roots: Vec<Vec3> = (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect();
    let [x, y, z] = [0, 1, 2].map(|axis| extent(roots.iter().map(|root| root[axis]).collect()));
    let surface = 2.0 * (x * y + y * z + z * x);
    // Twice the distance of neighbours.
    let reach = 2.0 * (COVERED * surface / roots.len().max(1) as f32).sqrt();
    if !(reach.is_finite() && reach > 1e-6) {
        return vec![0.0; vertices.len()];
    }
    let cell = |point: Vec3| (point / reach).floor().as_ivec3();
    let mut cells: HashMap<IVec3, Vec<Vec3>> = HashMap::new();
    roots.iter().for_each(|&root| cells.entry(cell(root)).or_default().push(root));
    // Sum of the weights of roots of mean density: the integral over the disc, for a root on a square of half
    // the reach.
    let whole = 4.0 * std::f32::consts::PI / 3.0;
    let density = |vertex: &Vec3| {
        let around = |index: i32| IVec3::new(index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1);
        let near = (0..27).filter_map(|index| cells.get(&(cell(*vertex) + around(index)))).flatten();
        let weight = |root: &Vec3| (1.0 - root.distance_squared(*vertex) / (reach * reach)).max(0.0).powi(2);
        (near.map(weight).sum::<f32>() / whole).min(1.0)
    };
    vertices.par_iter().map(density).collect()
}

/// Extent of numbers, if they were spread as evenly at both ends as between.
fn extent(mut numbers: Vec<f32>) -> f32 {
    numbers.sort_unstable_by(f32::total_cmp);
    let (count, strays) = (numbers.len(), numbers.len() / STRAYS);
    let within = &numbers[strays..count - strays];
    let [Some(first), Some(last)] = [within.first(), within.last()] else { return 0.0 };
    (last - first) * count as f32 / within.len() as f32
}

#[cfg(test)]
mod tests {
    use strandline_groom::Groom;

    use super::*;

    #[test]
    fn skin_among_roots_is_dense_and_skin_beside_them_is_not() {
        let mut groom = Groom::empty(1e-4);
        for index in 0..900 {
            let root = Vec3::new((index % 30) as f32 * 5e-3, 0.0, (index / 30) as f32 * 5e-3);
            groom.push((0..4).map(|point| root + Vec3::Y * (0.02 * point as f32)));
        }
        let guides = Guides::resample(&groom, 4).unwrap();
        let places = [Vec3::new(0.07, 0.0, 0.07), Vec3::new(0.3, 0.0, 0.07), Vec3::new(0.07, -0.1, 0.07)];
        let found = root_densities(&places, &guides);
        // Flat: the box has two sides, on one of which all roots lie.
        assert!(found[0] > 0.6 && found[1] == 0.0 && found[2] == 0.0, "{found:?}");
        // One that strayed changes nothing, and does not make all others its neighbours.
        groom.push((0..4).map(|point| Vec3::new(1e3, 0.02 * point as f32, 1e3)));
        let strayed = root_densities(&places, &Guides::resample(&groom, 4).unwrap());
        assert!((strayed[0] - found[0]).abs() < 0.01 && strayed[1..] == found[1..], "{strayed:?}");
    }
}
