//! Distance grids of meshes whose triangles overlap by thousands.

use glam::Vec3;
use strandline_body::{DistanceGrid, Mesh, SignedDistance};

use crate::distance_grid::{CENTER, RADIUS, SPACING, nodes};
use crate::shapes::distance_by_search;

/// A cone of `count` thin triangles with its tip up, and as many at its base.
fn cone(count: u32) -> Mesh {
    let rim = |index: u32| {
        let angle = std::f32::consts::TAU * index as f32 / count as f32;
        CENTER + RADIUS * Vec3::new(angle.sin(), 0.0, angle.cos())
    };
    let mut positions: Vec<Vec3> = (0..count).map(rim).collect();
    positions.extend([CENTER + RADIUS * Vec3::Y, CENTER]);
    let sides = (0..count).flat_map(|index| {
        let next = (index + 1) % count;
        [[index, next, count], [next, index, count + 1]]
    });
    Mesh::new(positions, sides.collect()).unwrap()
}

#[test]
fn thousands_of_thin_triangles_around_a_vertex_are_exact_near_the_surface() {
    for count in [500, 20_000] {
        let mesh = cone(count);
        let grid = DistanceGrid::from_mesh(&mesh, SPACING, 0.02).unwrap();
        let mut worst = [0.0_f64; 2];
        for point in nodes(&grid).step_by(811) {
            let (found, exact) = (f64::from(grid.distance(point)).abs(), distance_by_search(&mesh, point));
            let is_far = exact > f64::from(SPACING);
            worst[usize::from(is_far)] = worst[usize::from(is_far)].max((found - exact).abs());
        }
        // Single precision over the box.
        assert!(worst[0] < 1e-6, "{count}: {worst:?}");
        // Of thousands of overlapping triangles neighbours offer their nearest: two cells away at most a
        // quarter too far.
        let most = if count > 1000 { 0.25 * f64::from(SPACING) } else { 1e-6 };
        assert!(worst[1] < most, "{count}: {worst:?}");
    }
}
