//! Bound strands against the same strands simulated, on a groom and a head as artists make them.

use glam::Vec3;
use strandline::{Prepared, low_level::BoundStrands};
use strandline_body::{BodyFrame, Mesh, Pose};
use strandline_checks::{On, Rig};
use strandline_groom::{Frames, LANES, Vec3Lanes};
use strandline_render::{
    DetailLevel, Strands,
    cpu::{Curves, interpolate, keep_outside, tessellate},
};
use strandline_sim::{Drive, Model, Settings};

/// Her hair with a number of guides, to which the other strands are bound.
fn sintel(guides: Option<u32>) -> Option<Prepared> {
    strandline_checks::sintel(|scene| scene.groom.guides = guides)
}

/// Positions \[m\] of the simulated strands after two seconds of shake: after one, hair is where a stiff groom would be.
fn shaken(prepared: &Prepared) -> (Vec<Vec3Lanes>, Pose) {
    let settings = Settings::default();
    let model = Model::new(&prepared.guides, &settings, prepared.colliders.clone()).unwrap();
    let mut rig = Rig::new(&On::Cpu, model);
    let pose = |step: usize| prepared.head.pose(step as f64 * f64::from(settings.time_step));
    let steps = (2.0 / settings.time_step) as usize;
    let drive = |step| Drive::of(pose(step));
    rig.steps(&(1..=steps).map(drive).collect::<Vec<_>>());
    (rig.state().positions.clone(), pose(steps))
}

fn place(positions: &[Vec3Lanes], points: usize, strand: usize, point: usize) -> Vec3 {
    positions[strand / LANES * points + point].get(strand % LANES)
}

/// The nearest place of a triangle to a point \[Ericson2005 chapter 5\].
fn nearest_of([a, b, c]: [Vec3; 3], point: Vec3) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let inside = |from: Vec3, to: Vec3| (to - from).cross(point - from).dot(normal) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) && normal != Vec3::ZERO {
        let normal = normal.normalize();
        return point - normal * (point - a).dot(normal);
    }
    let on = |from: Vec3, to: Vec3| {
        let way = to - from;
        from + way * ((point - from).dot(way) / way.length_squared().max(1e-20)).clamp(0.0, 1.0)
    };
    let places = [on(a, b), on(b, c), on(c, a)];
    places.into_iter().min_by(|one, two| one.distance(point).total_cmp(&two.distance(point))).unwrap()
}

/// Depth \[m\] of a point under a mesh; below 0 outside.
fn depth(mesh: &Mesh, point: Vec3) -> f32 {
    let mut best = (f32::INFINITY, 0.0);
    for corners in &mesh.triangles {
        let corners = corners.map(|corner| mesh.positions[corner as usize]);
        let nearest = nearest_of(corners, point);
        let distance = nearest.distance(point);
        let [a, b, c] = corners;
        let side = (point - nearest).dot((b - a).cross(c - a).normalize_or_zero());
        // Triangles that share the nearest place: the one that faces the point most tells the side.
        if distance < best.0 - 1e-7 || (distance < best.0 + 1e-7 && side.abs() > f32::abs(best.1)) {
            best = (distance.min(best.0), side);
        }
    }
    -best.0 * best.1.signum()
}

#[test]
fn bound_strands_go_where_they_would_go_and_stay_out_of_the_head() {
    let Some(some) = sintel(Some(2000)) else { return };
    let all = sintel(Some(11_400)).unwrap();
    let bound: &BoundStrands = some.bound.as_ref().unwrap();
    assert!(all.bound.is_none() && (1900..=2000).contains(&some.guides.strand_count()));
    let (points, strands) = (some.guides.points_per_strand(), bound.strands().strand_count());
    assert_eq!(strands, all.guides.strand_count());

    let (mut frames, mut placed) = (Frames::default(), Vec::new());
    bound.place(some.guides.positions(), &BodyFrame::REST, &mut frames, &mut placed);
    let at_rest = (0..strands)
        .map(|strand| {
            let own = (0..points).map(|point| bound.strands().position(strand, point));
            own.enumerate()
                .map(|(point, own)| place(&placed, points, strand, point).distance(own))
                .fold(0.0, f32::max)
        })
        .fold(0.0, f32::max);
    let (truth, pose) = shaken(&all);
    let (guides, _) = shaken(&some);
    bound.place(&guides, &pose.into(), &mut frames, &mut placed);
    let still: Vec<Vec3Lanes> = all.guides.positions().to_vec();
    let share = |found: &dyn Fn(usize, usize) -> Vec3| {
        let mut sum = 0.0;
        for strand in 0..strands {
            let rest = |point| all.guides.position(strand, point);
            let length: f32 = (1..points).map(|point| rest(point).distance(rest(point - 1))).sum();
            let apart: f32 = (0..points)
                .map(|point| found(strand, point).distance(place(&truth, points, strand, point)))
                .sum();
            sum += apart / points as f32 / length;
        }
        sum / strands as f32
    };
    let apart = share(&|strand, point| place(&placed, points, strand, point));
    let stiff = share(&|strand, point| pose.point(place(&still, points, strand, point)));

    println!(
        "at rest {at_rest:e} m; apart {:.2} % of a strand's length (a stiff groom: {:.2} %)",
        100.0 * apart,
        100.0 * stiff
    );
    assert!(at_rest < 1e-4, "{at_rest} m");
    assert!(apart <= 0.05, "{apart}");
    assert!(stiff > 2.0 * apart, "the comparison can fail: {stiff}");
    let own: Vec<Vec3> = (0..strands)
        .flat_map(|strand| (0..points).map(move |point| (strand, point)))
        .map(|(strand, point)| place(&placed, points, strand, point))
        .collect();
    println!("points of strands: {}", outside(&some, &own, points, &pose, [1, 4]));
    let (drawn, each) = drawn(&some, &placed, &pose);
    let per_span = some.scene.level_of_detail.segments_per_span as usize;
    println!("drawn points: {}", outside(&some, &drawn, each, &pose, [per_span, 31]));
}

/// The points that pictures draw \[m\], world space, strand by strand, and how many each strand has.
fn drawn(prepared: &Prepared, placed: &[Vec3Lanes], pose: &Pose) -> (Vec<Vec3>, usize) {
    let (all, look) = (prepared.bound.as_ref().unwrap().strands(), &prepared.scene.look);
    let level = DetailLevel::full(prepared.scene.level_of_detail.segments_per_span, look.follow_strands);
    let (mut curves, mut strands) = (Curves::default(), Strands::default());
    tessellate(placed, all, pose, &level, &mut curves);
    interpolate(&curves, all, pose, look, &level, &mut strands);
    let bound = prepared.bound.as_ref().unwrap();
    keep_outside(&mut strands, &curves, all.points_per_strand(), &bound.solids().placed(*pose));
    let each = level.segment_count(all.points_per_strand()) + 1;
    assert!(look.follow_strands > 1 && strands.positions.len() == strands.strand_count * each);
    (strands.positions, each)
}

/// Asserts that points \[m\], world space, `each` of a strand, lie outside the head, measured against the mesh itself:
/// 99.9 of 100, and none deeper than 1 mm; what was found. The first of every strand are left out, which lead out of
/// the skin, and all but every n-th strand: the distance to the mesh asks every triangle.
fn outside(prepared: &Prepared, points: &[Vec3], each: usize, pose: &Pose, [first, n]: [usize; 2]) -> String {
    let (mesh, head_from_world) = (prepared.mesh.as_ref().unwrap(), pose.inverse());
    let shape = &prepared.colliders[0].shape;
    let (mut looked, mut deep, mut deepest) = (0, 0, 0.0_f32);
    for strand in points.chunks(each).step_by(n) {
        for point in &strand[first..] {
            let point = head_from_world.point(*point);
            looked += 1;
            // Samples 4 mm apart err by less than that.
            if shape.distance(point) < 0.003 {
                let depth = depth(mesh, point);
                // Rounding of the surface itself.
                deep += usize::from(depth > 1e-4);
                deepest = deepest.max(depth);
            }
        }
    }
    let found = format!("{deep} of {looked} points inside, the deepest {:.2} mm", 1e3 * deepest);
    assert!(deep as f32 <= 0.001 * looked as f32 && deepest <= 1e-3, "{found}");
    found
}
