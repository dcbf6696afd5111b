//! Signed distance of meshes against known values.

use glam::Vec3;
use strandline_body::{Aabb, BodyError, DistanceGrid, Mannequin, Mesh, SignedDistance};

use crate::shapes::{ball, distance_by_search, inside_out, part, supplied, together, winding_number};

pub const CENTER: Vec3 = Vec3::new(0.03, 1.5, -0.02);
pub const RADIUS: f32 = 0.1;
pub const SPACING: f32 = 0.004;
const PADDING: f32 = 0.03;

/// An exact ball.
struct Ball;

impl SignedDistance for Ball {
    fn distance(&self, point: Vec3) -> f32 {
        point.distance(CENTER) - RADIUS
    }
    fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        (self.distance(point), (point - CENTER).normalize())
    }
    fn bounds(&self) -> Aabb {
        Aabb { min: CENTER - RADIUS, max: CENTER + RADIUS }
    }
}

/// Points in a box, the same ones every time, at no special places.
fn points(bounds: Aabb, count: u32) -> impl Iterator<Item = Vec3> {
    let size = bounds.max - bounds.min;
    // The additive sequence of the plastic number fills a box evenly [Roberts2018].
    let steps = glam::DVec3::new(0.819_172_513_396, 0.671_043_606_703, 0.549_700_477_902);
    (1..=count).map(move |index| bounds.min + size * (steps * f64::from(index)).fract().as_vec3())
}

/// The places of the nodes of a grid: its values there are not interpolated.
pub fn nodes(grid: &DistanceGrid) -> impl Iterator<Item = Vec3> + '_ {
    let count = grid.cells() + 1;
    let total = count.x * count.y * count.z;
    (0..total).map(move |index| {
        let node = glam::UVec3::new(index % count.x, index / count.x % count.y, index / (count.x * count.y));
        grid.bounds().min + node.as_vec3() * grid.spacing()
    })
}

#[test]
fn what_a_grid_is_away_at_least_is_no_more_than_its_distance_and_not_much_less() {
    let grids = [
        DistanceGrid::from_field(&Ball, SPACING, PADDING).unwrap(),
        DistanceGrid::from_mesh(&ball(CENTER, RADIUS, 4), SPACING, PADDING).unwrap(),
    ];
    for grid in grids {
        let bounds = Aabb { min: grid.bounds().min - 0.1, max: grid.bounds().max + 0.1 };
        for point in points(bounds, 20_000).chain(nodes(&grid)) {
            let (least, distance) = (grid.distance_at_least(point), grid.distance(point));
            assert!(least >= 0.0 && least <= distance.max(0.0), "{point}: {least} of {distance}");
            // A cell's diagonal, and a step of the table.
            assert!(least > distance - SPACING * (3.0_f32.sqrt() + 0.26), "{point}: {least} of {distance}");
        }
        assert!(grid.distance_at_least(Vec3::NAN).is_nan() || grid.distance_at_least(Vec3::NAN) == 0.0);
    }
}

/// Checks a grid against the exact ball, whose samples are `inexact` \[m\] wrong.
fn check_ball(grid: &DistanceGrid, inexact: f32) {
    // Points of a smooth field. Trilinear error: spacing^2 / 8 times the sum of the second derivatives, 2 /
    // distance from the centre, here at least a third of the radius.
    let tolerance = inexact + SPACING * SPACING / 8.0 * 2.0 / (RADIUS / 3.0) + 1e-6;
    for point in points(grid.bounds(), 20_000).filter(|point| point.distance(CENTER) > RADIUS / 3.0) {
        let (distance, gradient) = grid.distance_and_gradient(point);
        let (exact, direction) = Ball.distance_and_gradient(point);
        assert!((distance - exact).abs() < tolerance, "{point}: {distance}, not {exact}");
        assert_eq!(distance, grid.distance(point));
        assert!((gradient.length() - 1.0).abs() < 1e-6);
        // Differences over two cells turn the gradient by less than spacing^2 / distance^2; the facets of
        // the mesh tilt it by up to 0.05; one-sided differences at the border by spacing / (2 distance).
        assert!(gradient.dot(direction) > 0.995, "{point}: {gradient}, not {direction}");
    }
}

#[test]
fn a_field_is_sampled() {
    let grid = DistanceGrid::from_field(&Ball, SPACING, PADDING).unwrap();
    check_ball(&grid, 0.0);
    assert_eq!(grid.spacing(), SPACING);
    // 0.26 m at 4 mm, rounded up.
    assert!(
        grid.cells().cmpge(glam::UVec3::splat(65)).all() && grid.cells().cmple(glam::UVec3::splat(66)).all()
    );
}

#[test]
fn both_sides_of_a_symmetric_field_are_at_their_nodes() {
    let bust = Mannequin::new();
    for (spacing, odd) in [(0.02, 1), (0.021, 0)] {
        let grid = DistanceGrid::from_field(&*bust, spacing, 0.0).unwrap();
        assert_eq!((grid.cells().x + 1) % 2, odd, "with a column in the middle and without");
        for (node, sample) in nodes(&grid).zip(grid.nodes()) {
            // Mirrored places differ by their rounding.
            assert!((sample.w - bust.distance(node)).abs() < 1e-6, "{node}");
        }
    }
}

#[test]
fn a_ball_of_triangles_is_a_ball() {
    let mesh = ball(CENTER, RADIUS, 5);
    let grid = DistanceGrid::from_mesh(&mesh, SPACING, PADDING).unwrap();
    // The facets lie within the sphere by what their centres show, and the corners on it.
    let facet = |triangle: &[u32; 3]| {
        let sum: Vec3 = triangle.iter().map(|corner| mesh.positions[*corner as usize]).sum();
        RADIUS - (sum / 3.0).distance(CENTER)
    };
    let sag = mesh.triangles.iter().map(facet).fold(0.0, f32::max);
    assert!(sag < 2e-4, "{sag}");
    check_ball(&grid, 1.01 * sag);
}

#[test]
fn the_border_of_the_box_does_not_show() {
    let mesh = ball(CENTER, RADIUS, 3);
    let grid = DistanceGrid::from_mesh(&mesh, SPACING, 0.0).unwrap();
    let Aabb { min, max } = grid.bounds();
    let step = 1e-5;
    for point in points(grid.bounds(), 2000) {
        for (border, outward) in [(point.with_x(min.x), Vec3::NEG_X), (point.with_y(max.y), Vec3::Y)] {
            let (inner, inner_gradient) = grid.distance_and_gradient(border - outward * step);
            let (outer, outer_gradient) = grid.distance_and_gradient(border + outward * step);
            assert_eq!(grid.distance(border - outward * step), inner, "one look as the other");
            assert_eq!(grid.distance(border + outward * step), outer, "one look as the other");
            // Distances change by their steps at most, 1.1 times that where they are interpolated.
            assert!((inner - outer).abs() < 2.2 * step, "{border}: {inner} {outer}");
            // 0.02 mm turn the gradient by what they are to the smallest distance, 8 mm, and a half of
            // that in corners of the interpolation.
            assert!((inner_gradient - outer_gradient).length() < 5e-3, "{inner_gradient} {outer_gradient}");
        }
    }
    for point in points(Aabb { min: min - 1.0, max: max + 1.0 }, 5000) {
        let (distance, gradient) = grid.distance_and_gradient(point);
        let exact = Ball.distance(point);
        // Outside never more than the distance but for the facets and the interpolation, and no less than
        // it over the root of two; inside what is interpolated is also smaller where the middle is near.
        let outside = point.clamp(min, max) != point;
        assert!(distance < exact + 2e-4 || !outside, "{point}: {distance}, not {exact}");
        let least = if outside { std::f32::consts::FRAC_1_SQRT_2 * exact } else { exact };
        assert!(distance > least - 2e-4 || exact < 0.0, "{point}: {distance}, not {exact}");
        assert!((gradient.length() - 1.0).abs() < 1e-6);
        let nearest = point.clamp(min, max);
        if nearest.distance(point) > 0.5 {
            assert!(gradient.dot((point - CENTER).normalize()) > 0.95, "{point}: {gradient}");
        }
    }
}

/// Distance \[m\] that a node of a large grid may be less, which is this far \[m\] from the surface: beyond seven cells it
/// is a bound, as `far_nodes_of_a_large_grid_are_never_farther_than_the_surface` holds it.
fn may_be_less(grid: &DistanceGrid, exact: f64) -> f64 {
    let spacing = f64::from(grid.spacing());
    let is_bound = grid.nodes().len() > 5 << 17 && exact > 7.0 * spacing;
    if is_bound { 2.5 * spacing } else { 0.0 }
}

/// Compares some nodes with the search through all triangles, in distance and in sign.
fn check_against_search(mesh: &Mesh, grid: &DistanceGrid, every: usize) {
    let size = grid.bounds().max - grid.bounds().min;
    for point in nodes(grid).step_by(every) {
        let (distance, exact) = (f64::from(grid.distance(point)), distance_by_search(mesh, point));
        // Single precision over the box; node places are rounded by that too.
        let tolerance = 2e-6 * f64::from(size.max_element());
        let less = exact - distance.abs();
        let is_right = less > -tolerance && less < tolerance + may_be_less(grid, exact);
        assert!(is_right, "{point}: {distance}, not {exact}");
        if exact > tolerance {
            let winding = winding_number(mesh, point);
            assert_eq!(distance < 0.0, winding > 0.5, "{point}: {distance}, winds {winding} times");
        }
    }
}

#[test]
fn every_node_is_exact() {
    // Nodes fall on corners and edges: the ball is symmetric and its middle is that of the grid.
    let mesh = ball(CENTER, RADIUS, 2);
    let grid = DistanceGrid::from_mesh(&mesh, RADIUS / 8.0, 0.02).unwrap();
    check_against_search(&mesh, &grid, 1);
    // Triangles of a cell and less.
    let fine = ball(CENTER, RADIUS, 5);
    let grid = DistanceGrid::from_mesh(&fine, SPACING, 0.02).unwrap();
    check_against_search(&fine, &grid, 173);
}

#[test]
fn far_nodes_of_a_large_grid_are_never_farther_than_the_surface() {
    let mesh = ball(CENTER, RADIUS, 3);
    let spacing = 0.003;
    let grid = DistanceGrid::from_mesh(&mesh, spacing, 0.06).unwrap();
    assert!(grid.nodes().len() > 1 << 20);
    let (mut less, mut most) = (0, 0.0_f64);
    for point in nodes(&grid).step_by(397) {
        let (distance, exact) = (f64::from(grid.distance(point).abs()), distance_by_search(&mesh, point));
        let missing = (exact - distance) / f64::from(spacing);
        // Rounding of places of 1.6 m; up to 14 cells less a block's diagonal nothing is left to bounds.
        assert!(missing > -1e-3, "{point}: {distance}, not {exact}");
        assert!(missing < 1e-3 || exact > 7.0 * f64::from(spacing), "{point}: {distance}, not {exact}");
        less += usize::from(missing > 1e-2);
        most = most.max(missing);
    }
    // Half a cell outside; in the middle of the ball, where the nearest surface changes, a block's half.
    assert!(less > 100 && most < 2.5, "{less} nodes, {most} cells");
}

#[test]
fn lines_through_corners_and_edges_are_counted_once() {
    // All powers of two: the corners on the axes and the edges between them lie exactly on lines of nodes.
    let mesh = ball(Vec3::ZERO, 0.5, 2);
    let grid = DistanceGrid::from_mesh(&mesh, 0.0625, 0.125).unwrap();
    assert!(nodes(&grid).any(|node| node == Vec3::ZERO));
    check_against_search(&mesh, &grid, 1);
}

#[test]
fn the_collider_of_sintel_is_exact() {
    let Some(path) = supplied("sintel/sintel-collider.obj") else { return };
    let mesh = Mesh::load(&path, 1.0).unwrap();
    assert!(mesh.is_closed());
    let grid = DistanceGrid::from_mesh(&mesh, 0.003, 0.02).unwrap();
    check_against_search(&mesh, &grid, 311);
}

#[test]
fn open_heads_get_an_inside() {
    for (name, spacing) in [
        ("bust/hm08_bust_female.obj", 0.004),
        ("bust/hm08_bust_male.obj", 0.008),
        ("sintel/sintel.obj", 0.006),
    ] {
        let Some(path) = supplied(name) else { return };
        let mesh = Mesh::load(&path, 1.0).unwrap();
        let Err(BodyError::OpenMesh { open_edge_count }) = DistanceGrid::from_mesh(&mesh, 0.01, 0.02) else {
            panic!("{name} is open");
        };
        assert!(open_edge_count > 10);
        let grid = DistanceGrid::from_open_mesh(&mesh, spacing, 0.02).unwrap();
        let closed = mesh.closed();
        assert!(closed.is_closed());
        for point in nodes(&grid).step_by(1999) {
            let (distance, exact) = (f64::from(grid.distance(point)), distance_by_search(&closed, point));
            let inside = winding_number(&closed, point) > 0.5;
            assert_eq!(distance < 0.0, inside, "{name} at {point}: {distance}");
            // Inside, shells within the head are left out, so that the way out is longer.
            let tolerance = 1e-6;
            let least = exact - tolerance - may_be_less(&grid, exact);
            assert!(distance.abs() > least, "{name} at {point}: {distance}, not {exact}");
            assert!(
                inside || distance.abs() < exact + tolerance,
                "{name} at {point}: {distance}, not {exact}"
            );
        }
    }
}

#[test]
fn shells_join() {
    let apart = Vec3::X * 0.12;
    let both = together(&ball(CENTER, RADIUS, 4), &ball(CENTER + apart, RADIUS, 4));
    let grid = DistanceGrid::from_mesh(&both, SPACING, PADDING).unwrap();
    let (left, right) = (Ball, |point: Vec3| Ball.distance(point - apart));
    for point in points(grid.bounds(), 5000) {
        let exact = left.distance(point).min(right(point));
        // Outside the union is the nearer ball; inside only the sign is as simple. Facets and interpolation
        // take 0.5 mm, and a crease between the balls a share of a cell.
        if exact > 0.0 {
            assert!((grid.distance(point) - exact).abs() < 1.5e-3, "{point}");
        } else if exact < -1.5e-3 {
            assert!(grid.distance(point) < 0.0, "{point}");
        }
    }
}

#[test]
fn a_shell_within_does_not_count() {
    let nested = together(&ball(CENTER, RADIUS, 4), &ball(CENTER, 0.3 * RADIUS, 3));
    let grid = DistanceGrid::from_mesh(&nested, SPACING, PADDING).unwrap();
    let plain = DistanceGrid::from_mesh(&ball(CENTER, RADIUS, 4), SPACING, PADDING).unwrap();
    for point in points(grid.bounds(), 5000) {
        assert_eq!(grid.distance(point), plain.distance(point));
    }
}

#[test]
fn a_mesh_inside_out_is_turned() {
    let mesh = ball(CENTER, RADIUS, 3);
    let grid = DistanceGrid::from_mesh(&mesh, SPACING, PADDING).unwrap();
    let turned = DistanceGrid::from_mesh(&inside_out(&mesh), SPACING, PADDING).unwrap();
    for point in points(grid.bounds(), 5000) {
        // Triangles with other corner orders round differently.
        assert!((grid.distance(point) - turned.distance(point)).abs() < 1e-6);
    }
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let mesh = together(&ball(CENTER, RADIUS, 4), &ball(CENTER + 0.05, 0.7 * RADIUS, 3));
    let with_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        let grid = pool.install(|| DistanceGrid::from_mesh(&mesh, SPACING, PADDING)).unwrap();
        let bits: Vec<_> = points(grid.bounds(), 20_000)
            .map(|point| grid.distance_and_gradient(point))
            .map(|(distance, gradient)| (distance.to_bits(), gradient.to_array().map(f32::to_bits)))
            .collect();
        bits
    };
    assert!(with_threads(1) == with_threads(3));
}

#[test]
fn an_open_mesh_is_refused_and_can_be_closed() {
    let whole = ball(CENTER, RADIUS, 4);
    let open = part(&whole, |center| center.y > CENTER.y - 0.6 * RADIUS);
    let error = DistanceGrid::from_mesh(&open, SPACING, PADDING).unwrap_err().to_string();
    assert!(error.contains(&format!("{} of its edges", open.open_edge_count())), "{error}");
    assert!(error.contains("close the mesh"), "{error}");
    let grid = DistanceGrid::from_open_mesh(&open, SPACING, PADDING).unwrap();
    let whole = DistanceGrid::from_mesh(&whole, SPACING, PADDING).unwrap();
    for point in points(grid.bounds(), 5000) {
        let above = point.y > CENTER.y;
        // Above the middle the nearest surface is the same one, outside for sure.
        if above && whole.distance(point) > 0.0 {
            assert!((grid.distance(point) - whole.distance(point)).abs() < 1e-4, "{point}");
        }
    }
    // The hole at 0.6 of the radius is closed by a flat lid, to the size of a triangle.
    assert!(grid.distance(CENTER - Vec3::Y * (0.5 * RADIUS)) < 0.0);
    assert!(grid.distance(CENTER - Vec3::Y * (0.75 * RADIUS)) > 0.0);
}

#[test]
fn empty_and_impossible_meshes_are_refused() {
    let empty = Mesh::default();
    assert!(matches!(DistanceGrid::from_mesh(&empty, 0.01, 0.0), Err(BodyError::BadMesh { .. })));
    assert!(matches!(DistanceGrid::from_open_mesh(&empty, 0.01, 0.0), Err(BodyError::BadMesh { .. })));
    let mut bad = ball(CENTER, RADIUS, 1);
    bad.positions[7].y = f32::NAN;
    let error = DistanceGrid::from_mesh(&bad, 0.01, 0.0).unwrap_err().to_string();
    assert!(error.contains("vertex 7"), "{error}");
    let mut bad = ball(CENTER, RADIUS, 1);
    bad.triangles[5][2] = 1_000_000;
    let error = DistanceGrid::from_mesh(&bad, 0.01, 0.0).unwrap_err().to_string();
    assert!(error.contains("triangle 5"), "{error}");
}

#[test]
fn triangles_without_area_do_no_harm() {
    let line = vec![CENTER, CENTER + 0.1, CENTER + 0.2, CENTER];
    let flat = Mesh::new(line, vec![[0, 1, 2], [2, 1, 0], [0, 0, 0], [3, 0, 1], [1, 0, 3]]).unwrap();
    let grid = DistanceGrid::from_open_mesh(&flat, 0.02, 0.1).unwrap();
    for point in points(grid.bounds(), 500) {
        assert!(grid.distance(point) > -1e-6);
    }
}

#[test]
fn grids_have_limits() {
    let refused = |spacing, padding| DistanceGrid::from_field(&Ball, spacing, padding).unwrap_err();
    for spacing in [0.0, -1.0, f32::NAN] {
        assert!(refused(spacing, 0.0).to_string().contains("the spacing"));
    }
    for padding in [-1.0, f32::INFINITY] {
        assert!(refused(0.01, padding).to_string().contains("the padding"));
    }
    // In millimetres, as it were.
    let huge = ball(CENTER, 1e3 * RADIUS, 1);
    let refused = DistanceGrid::from_mesh(&huge, SPACING, 0.0).unwrap_err();
    assert!(matches!(refused, BodyError::GridTooLarge { cells, .. } if cells[0] >= 50_000), "{refused}");
}

#[test]
fn too_fine_a_grid_is_made_coarser() {
    // A rod of 60 m and one cell across, and a cube of as many cells as one can count.
    let rod = [Vec3::ZERO, Vec3::new(0.01, 0.0, 60.0), Vec3::new(0.0, 0.01, 60.0), Vec3::splat(0.01)];
    let rod = Mesh::new(rod.to_vec(), vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).unwrap();
    let grid = DistanceGrid::from_mesh(&rod, SPACING, 0.0).unwrap();
    assert!((1020..=1024).contains(&grid.cells().z), "{}", grid.cells());
    assert!(grid.spacing() > 14.0 * SPACING && grid.spacing() < 16.0 * SPACING, "{}", grid.spacing());
    let grid = DistanceGrid::from_mesh(&ball(CENTER, RADIUS, 1), 1e-30, 0.0).unwrap();
    let nodes = grid.nodes().len();
    assert!(nodes <= 8 << 20 && nodes > 7 << 20, "{nodes}");
}

#[test]
fn triangles_that_are_there_before_add_nothing() {
    let once = ball(CENTER, RADIUS, 2);
    let turned = once.triangles.iter().map(|&[a, b, c]| [c, a, b]);
    let twice = once.triangles.iter().copied().chain(turned).chain(once.triangles.iter().copied()).collect();
    let twice = Mesh::new(once.positions.clone(), twice).unwrap();
    let [once, twice] = [&once, &twice].map(|mesh| DistanceGrid::from_mesh(mesh, 0.01, 0.0).unwrap());
    assert!(once.nodes() == twice.nodes());
}
