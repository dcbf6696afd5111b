//! The nearest triangle of every node that is near the surface.

use glam::DVec3;

use crate::lattice::Lattice;
use crate::layers::{Corners, Layers};
use crate::triangle::nearer;
use crate::triangle_tree::Nearest;

/// Nodes within this distance \[cells\] of the surface are painted.
pub(crate) const REACH: f64 = 1.0;
/// Margin of visited nodes, so that rounding leaves none out.
const MARGIN: f64 = 1e-6;
/// Squared sine of the angles below which a triangle has no normal of its own.
const FLAT: f64 = 1e-20;
/// Squared share of the z axis in a normal above which a triangle lies in few layers.
const LEVEL: f64 = 0.8;

/// Tells the nodes of some layers, from the first one on, about every triangle within [`REACH`] of them: what
/// is then known no further than that is the nearest of all.
pub(crate) fn paint(layers: &Layers, lattice: &Lattice, first_layer: usize, nearest: &mut [Nearest]) {
    let layer_len = lattice.layer_len();
    let last_layer = first_layer + nearest.len() / layer_len - 1;
    let low = DVec3::new(0.0, 0.0, first_layer as f64);
    let high = (lattice.node_count - 1).as_dvec3().with_z(last_layer as f64);
    for triangle in layers.between(low.z - REACH, high.z + REACH) {
        let corners = &layers.triangles()[triangle as usize];
        let seen = ProjectedTriangle::new(corners);
        seen.for_each_node_beside(low, high, |point| {
            let known = &mut nearest[lattice.index(point.as_uvec3()) - first_layer * layer_len];
            let height = (point - corners[0]).dot(seen.normal);
            if height * height >= known.squared.min(REACH * REACH * (1.0 + MARGIN)) {
                return;
            }
            if let Some(squared) = nearer(corners, point, known.squared) {
                *known = Nearest { squared, triangle };
            }
        });
    }
}

/// A triangle projected along an axis to which its plane is not parallel.
struct ProjectedTriangle<'a> {
    corners: &'a Corners,
    /// Unit normal of a plane that it lies in.
    normal: DVec3,
    /// The axes across rows of nodes, along them, and of sight.
    axes: [usize; 3],
}

impl<'a> ProjectedTriangle<'a> {
    fn new(corners: &'a Corners) -> Self {
        let [a, b, c] = *corners;
        let longest = [b - a, c - b, a - c].into_iter().fold(DVec3::ZERO, |longest, edge| {
            if edge.length_squared() > longest.length_squared() { edge } else { longest }
        });
        let normal = (b - a).cross(c - a);
        let normal = if normal.length_squared() > FLAT * longest.length_squared().powi(2) {
            normal.normalize()
        } else {
            // A triangle without an area lies in every plane through its longest edge.
            longest.any_orthogonal_vector().normalize_or(DVec3::Z)
        };
        let squares = normal * normal;
        let axes = if squares.z > LEVEL {
            [1, 0, 2]
        } else if squares.x > squares.y {
            [2, 1, 0]
        } else {
            [2, 0, 1]
        };
        Self { corners, normal, axes }
    }

    /// Visits every node between two that is within [`REACH`] of the triangle, and some more: in every row those
    /// within reach of what of it passes by, along the sight those within reach of its plane.
    fn for_each_node_beside(&self, low: DVec3, high: DVec3, mut visit: impl FnMut(DVec3)) {
        let reach = REACH + MARGIN;
        let [across, along, sight] = self.axes;
        let [a, b, c] = *self.corners;
        let first = (a.min(b).min(c) - reach).max(low).ceil();
        let last = (a.max(b).max(c) + reach).min(high).floor();
        let half = reach / self.normal[sight].abs();
        let mut point = DVec3::ZERO;
        for row in whole_numbers(first[across], last[across]) {
            point[across] = row;
            let Some([least, most]) = self.passing(row, reach) else { continue };
            for place in whole_numbers(
                (least - reach).max(first[along]).ceil(),
                (most + reach).min(last[along]).floor(),
            ) {
                (point[along], point[sight]) = (place, 0.0);
                let plane = (a - point).dot(self.normal) / self.normal[sight];
                let ends = [(plane - half).max(first[sight]), (plane + half).min(last[sight])];
                for depth in whole_numbers(ends[0].ceil(), ends[1].floor()) {
                    point[sight] = depth;
                    visit(point);
                }
            }
        }
    }

    /// Interval of a row within reach of the triangle; `None` if there is none.
    fn passing(&self, row: f64, reach: f64) -> Option<[f64; 2]> {
        let [across, along, _] = self.axes;
        let mut found = [f64::INFINITY, f64::NEG_INFINITY];
        for corner in 0..3 {
            let (start, end) = (self.corners[corner], self.corners[(corner + 1) % 3]);
            let rise = end[across] - start[across];
            let offset = row - start[across];
            let shares = if rise == 0.0 {
                if offset.abs() > reach {
                    continue;
                }
                [0.0, 1.0]
            } else {
                let [one, other] = [(offset - reach) / rise, (offset + reach) / rise];
                [one.min(other).max(0.0), one.max(other).min(1.0)]
            };
            if shares[0] <= shares[1] {
                for share in shares {
                    let place = start[along] + share * (end[along] - start[along]);
                    found = [found[0].min(place), found[1].max(place)];
                }
            }
        }
        (found[0] <= found[1]).then_some(found)
    }
}

/// The whole numbers between two, both included.
fn whole_numbers(first: f64, last: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |number| Some(number + 1.0)).take_while(move |number| *number <= last)
}

#[cfg(test)]
mod tests {
    use glam::UVec3;

    use super::*;

    /// No node within reach of a triangle is left out, for any shape and place.
    #[test]
    fn every_node_within_reach_is_visited() {
        let mut random = crate::Random::new(7, 0);
        let mut number = || f64::from(random.unit());
        let high = DVec3::new(11.0, 9.0, 8.0);
        let low = DVec3::new(0.0, 0.0, 2.0);
        for turn in 0..3000 {
            let mut corners: Corners = std::array::from_fn(|_| {
                DVec3::from_array(std::array::from_fn(|_| 16.0 * number() - 3.0)).map(|place| {
                    // Planes and edges along the axes, and corners on nodes.
                    if turn % 3 == 0 { place.round() } else { place }
                })
            });
            match turn % 7 {
                0 => corners[2] = corners[0],
                1 => corners[2] = corners[0].lerp(corners[1], 0.3),
                2 => corners = [corners[0]; 3],
                3 => corners[2] = corners[0] + 1e-7,
                _ => {}
            }
            let mut visited = std::collections::HashSet::new();
            ProjectedTriangle::new(&corners).for_each_node_beside(low, high, |point| {
                assert!(visited.insert(point.as_uvec3()), "{point} twice: {corners:?}");
            });
            for z in low.z as u32..=high.z as u32 {
                for y in 0..=high.y as u32 {
                    for x in 0..=high.x as u32 {
                        let node = UVec3::new(x, y, z);
                        let near = nearer(&corners, node.as_dvec3(), REACH * REACH * (1.0 + 1e-12)).is_some();
                        assert!(!near || visited.contains(&node), "{node} beside {corners:?}");
                    }
                }
            }
        }
    }

    /// Thin triangles that meet in a vertex, and those that meet in an edge: twice as many take twice as long.
    #[test]
    fn work_grows_as_triangles_do() {
        let middle = DVec3::splat(30.0);
        let visits = |count: u32, at_edge: bool| {
            let rim = |index: u32| {
                let (sine, cosine) = (std::f64::consts::TAU * f64::from(index) / f64::from(count)).sin_cos();
                middle + 28.0 * DVec3::new(sine, 0.0, cosine)
            };
            let mut visits = 0_u64;
            for index in 0..count {
                let corners = if at_edge {
                    [middle + 28.0 * DVec3::Y, middle - 28.0 * DVec3::Y, rim(index)]
                } else {
                    [middle + 28.0 * DVec3::Y, rim(index), rim(index + 1)]
                };
                ProjectedTriangle::new(&corners).for_each_node_beside(
                    DVec3::ZERO,
                    DVec3::splat(60.0),
                    |_| visits += 1,
                );
            }
            visits as f64
        };
        for at_edge in [false, true] {
            for count in [1000, 2000, 4000] {
                let growth = visits(2 * count, at_edge) / visits(count, at_edge);
                assert!(growth < 2.02, "{growth} from {count} on");
            }
        }
    }
}
