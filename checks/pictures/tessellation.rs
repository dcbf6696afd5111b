//! `tessellate` and `interpolate` against the formula, and across levels of detail.

use glam::{DVec3, Quat, Vec3};
use strandline_body::Pose;
use strandline_checks::law;
use strandline_groom::{Groom, Guides};
use strandline_render::Strands;
use strandline_render::cpu::{Curves, interpolate, tessellate};
use strandline_render::{DetailLevel, LevelOfDetail, Look, PictureSettings};

use crate::drawn::Drawn;
use crate::grooms::arcs;

const SPANS: usize = 5;

fn guides(strand_count: usize) -> Guides {
    Guides::resample(&arcs(strand_count), SPANS + 1).unwrap()
}

fn curves(guides: &Guides, level: &DetailLevel) -> Curves {
    let mut curves = Curves::default();
    let drawn =
        level.drawn_lanes().taken(guides.positions(), guides.strand_count(), guides.points_per_strand());
    tessellate(&drawn, guides, &Pose::IDENTITY, level, &mut curves);
    curves
}

fn strands(guides: &Guides, look: &Look, level: &DetailLevel) -> Strands {
    let mut strands = Strands::default();
    interpolate(&curves(guides, level), guides, &Pose::IDENTITY, look, level, &mut strands);
    strands
}

/// The uniform cubic B-spline by the recursion of Cox and de Boor, in double precision.
fn de_boor(controls: &[DVec3], parameter: f64) -> DVec3 {
    let span = (parameter as usize).min(controls.len() - 4);
    let mut points = [controls[span], controls[span + 1], controls[span + 2], controls[span + 3]];
    for level in 1..=3 {
        for index in (level..=3).rev() {
            // Knot of control point `index` in a uniform knot vector whose span starts at `span`.
            let knot = span as f64 + index as f64 - 3.0;
            let share = (parameter - knot) / (4 - level) as f64;
            points[index] = points[index - 1].lerp(points[index], share);
        }
    }
    points[3]
}

fn controls(guides: &Guides, strand: usize) -> Vec<DVec3> {
    let spans = guides.points_per_strand() - 1;
    let points: Vec<DVec3> = (0..=spans).map(|point| guides.position(strand, point).as_dvec3()).collect();
    // The quasi-interpolant of cubics: (-1, 8, -1) / 6, and the ends themselves.
    let mut controls = points.clone();
    for point in 1..spans {
        controls[point] = (8.0 * points[point] - points[point - 1] - points[point + 1]) / 6.0;
    }
    controls.insert(0, 2.0 * controls[0] - controls[1]);
    controls.push(2.0 * controls[spans + 1] - controls[spans]);
    controls
}

fn greatest_error(guides: &Guides, curves: &Curves, shift: f64) -> f64 {
    let mut greatest = 0.0f64;
    for guide in 0..guides.strand_count() {
        let controls = controls(guides, guide);
        for point in 0..curves.points_per_curve {
            let parameter = (point as f64 / 4.0 + shift).min(SPANS as f64);
            let error = curves.point(guide, point)[0].as_dvec3().distance(de_boor(&controls, parameter));
            greatest = greatest.max(error);
        }
    }
    greatest
}

#[test]
fn curves_follow_the_formula() {
    let guides = guides(37);
    let curves = curves(&guides, &DetailLevel::full(4, 1));
    assert_eq!(curves.points_per_curve, 21);
    // Positions up to 0.5 m in single precision (3e-8 m), with a dozen operations each.
    assert!(greatest_error(&guides, &curves, 0.0) < 3e-7);
    assert!(greatest_error(&guides, &curves, 0.01) > 3e-6, "a shifted parameter must be seen");
    for guide in 0..guides.strand_count() {
        let [root, _, _] = curves.point(guide, 0);
        let [tip, _, _] = curves.point(guide, 20);
        assert!(root.distance(guides.position(guide, 0)) < 1e-7);
        assert!(tip.distance(guides.position(guide, SPANS)) < 1e-7);
    }
}

law! {
    fn tangents_are_the_derivative_of_the_curve(on) {
        let look = Look { follow_strands: 1, ..Look::thesis() };
        let detail = LevelOfDetail::full();
        let drawn = Drawn { guides: guides(37), look, lights: Vec::new(), eye: Vec3::Z, detail };
        let [positions, tangents, _] = drawn.curves(on);
        let count = 4 * SPANS + 1;
        let greatest = |shift: f64| {
            let mut greatest = 0.0f64;
            for guide in 0..37 {
                let controls = controls(&drawn.guides, guide);
                for point in 0..count {
                    let parameter = point as f64 / 4.0 + shift;
                    let way = de_boor(&controls, parameter + 1e-5) - de_boor(&controls, parameter - 1e-5);
                    let found = tangents[guide * count + point].as_dvec3();
                    greatest = greatest.max(found.distance(way.normalize()));
                }
            }
            greatest
        };
        assert_eq!(positions.len(), 37 * count);
        // Control points of 0.3 m in single precision, 4 cm apart, and four products.
        assert!(greatest(0.0) < 1e-5, "{}", greatest(0.0));
        assert!(greatest(0.01) > 1e-4, "the derivative at another parameter is not noticed");
    }
}

#[test]
fn curves_keep_to_the_guides_points() {
    // Points 5.5 cm apart on a ball of 9 cm: a skull under long hair.
    let mut groom = Groom::empty(8e-5);
    groom.push((0..=200).map(|step| {
        let angle = step as f32 / 200.0 * 3.05;
        Vec3::new(angle.cos(), angle.sin(), 0.0) * 0.09
    }));
    let guides = Guides::resample(&groom, SPANS + 1).unwrap();
    let curves = curves(&guides, &DetailLevel::full(4, 1));
    let deepest = (0..curves.points_per_curve)
        .map(|point| 0.09 - curves.point(0, point)[0].length())
        .fold(f32::MIN, f32::max);
    // The first and last spans, whose bend is unknown, dip by 2 mm; control points at the
    // guide's own points would dip by 5.
    assert!(deepest < 2.5e-3, "{deepest} m");
}

/// Greatest jump of the second derivative at the joints, over the greatest second derivative. Each span has four
/// segments, so five points give its cubic exactly.
fn joint_jump(points: &[DVec3]) -> f64 {
    let second = |at: usize| (points[at - 1] - 2.0 * points[at] + points[at + 1]) * 16.0;
    let mut jump = 0.0f64;
    let mut greatest = 0.0f64;
    for joint in (4..points.len() - 4).step_by(4) {
        // The second derivative of a cubic is linear: carried on from two points before and after.
        let before = 2.0 * second(joint - 1) - second(joint - 2);
        let after = 2.0 * second(joint + 1) - second(joint + 2);
        jump = jump.max(before.distance(after));
        greatest = greatest.max(before.length());
    }
    jump / greatest
}

#[test]
fn joints_are_smooth_to_the_second_derivative() {
    let guides = guides(37);
    let curves = curves(&guides, &DetailLevel::full(4, 1));
    for guide in 0..guides.strand_count() {
        let points: Vec<DVec3> = (0..21).map(|point| curves.point(guide, point)[0].as_dvec3()).collect();
        // Rounding of 3e-8 m, times 16 / h^2 twice over, against second derivatives of 5e-3 m.
        assert!(joint_jump(&points) < 2e-3, "{}", joint_jump(&points));
    }
}

#[test]
fn a_curve_with_a_kink_in_curvature_is_distinguished() {
    // Piecewise y = x^2 sign(x): smooth to the first derivative only.
    let points: Vec<DVec3> = (0..=8)
        .map(|index| {
            let x = f64::from(index) / 4.0 - 1.0;
            DVec3::new(x, x * x.abs(), 0.0)
        })
        .collect();
    assert!(joint_jump(&points) > 0.5);
}

#[test]
fn frames_are_orthonormal_and_follow_the_head() {
    let guides = guides(37);
    let level = DetailLevel::full(4, 1);
    let rest = curves(&guides, &level);
    let turned_pose =
        Pose { rotation: Quat::from_euler(glam::EulerRot::YXZ, 0.9, 0.4, -0.3), translation: Vec3::X };
    let mut moved = guides.positions().to_vec();
    for point in &mut moved {
        for lane in 0..8 {
            point.set(lane, turned_pose.point(point.get(lane)));
        }
    }
    let mut turned = Curves::default();
    tessellate(&moved, &guides, &turned_pose, &level, &mut turned);
    for guide in 0..guides.strand_count() {
        for point in 0..rest.points_per_curve {
            let [_, tangent, normal] = rest.point(guide, point);
            assert!((tangent.length() - 1.0).abs() < 1e-5 && (normal.length() - 1.0).abs() < 1e-5);
            assert!(tangent.dot(normal).abs() < 1e-5);
            // Twenty reflections of directions that rounding of the moved points (1e-7 m of 0.02 m) has turned.
            let expected = turned_pose.direction(normal);
            assert!(turned.point(guide, point)[2].distance(expected) < 1e-3);
        }
    }
}

#[test]
fn frames_do_not_twist() {
    // In a plane curve, the part of the normal that stands on the plane stays the same.
    let mut groom = Groom::empty(8e-5);
    groom.push((0..=40).map(|step| {
        let angle = step as f32 * 0.1;
        Vec3::new(angle.cos(), angle.sin(), 0.0) * 0.1
    }));
    let mut guides = Guides::resample(&groom, 16).unwrap();
    guides.set_root_normals(vec![Vec3::new(0.6, 0.0, 0.8)]);
    let curves = curves(&guides, &DetailLevel::full(4, 1));
    let start = curves.point(0, 0)[2].z;
    assert!(start.abs() > 0.1 && start.abs() < 0.95, "the case must not be a trivial one");
    for point in 0..curves.points_per_curve {
        // The double reflection is exact to the fourth order of the step (0.067 rad) [Wang2008].
        assert!((curves.point(0, point)[2].z - start).abs() < 1e-4);
    }
}

/// Sum of width times length \[m^2\] of all strands.
fn covered_area(strands: &Strands) -> f64 {
    let count = strands.points_per_strand;
    let mut area = 0.0;
    for strand in 0..strands.strand_count {
        for point in strand * count..(strand + 1) * count - 1 {
            let length = strands.positions[point].distance(strands.positions[point + 1]);
            area += f64::from(length * 0.5 * (strands.widths[point] + strands.widths[point + 1]));
        }
    }
    area
}

#[test]
fn covered_area_is_the_same_at_every_distance() {
    let levels = LevelOfDetail::default();
    // Hair about each guide; strands that each stand for themselves, so many that their lengths average out.
    for (follow_strands, guides) in [(16, guides(300)), (1, guides(4800))] {
        let look = Look { follow_strands, ..Look::default() };
        let area =
            |distance: f32| covered_area(&strands(&guides, &look, &levels.level(distance, follow_strands)));
        let near = area(0.3);
        let expected = 8e-5 * f64::from(look.hair_count) * 0.2;
        assert!(near > 0.5 * expected && near < 1.5 * expected, "{near} of about {expected}");
        for distance in [1.6, 2.0, 2.9, 4.1, 6.0, 20.0] {
            // Widths make up for lengths; the rest is the length that coarser polylines cut off.
            let ratio = area(distance) / near;
            assert!((ratio - 1.0).abs() < 0.01, "{follow_strands} at {distance} m: {ratio}");
        }
        let drawn = levels.level(6.0, follow_strands).drawn_strands(guides.strand_count());
        assert_eq!(drawn, guides.strand_count() * follow_strands as usize / 4);
    }
    let thinned = DetailLevel { full_follow_strands: 8.0, ..levels.level(20.0, 16) };
    let (guides, look) = (guides(300), Look::default());
    let near = covered_area(&strands(&guides, &look, &levels.level(0.3, look.follow_strands)));
    assert!(covered_area(&strands(&guides, &look, &thinned)) < 0.6 * near, "lost strands must be seen");
}

/// Greatest distance \[m\] from the points of one frame to the polylines of the same strands of another,
/// weighted with the share of the strand's full width.
fn greatest_shift(from: &Strands, to: &Strands) -> f32 {
    let mut greatest = 0.0f32;
    let guide_count = from.strand_count / from.strands_per_guide;
    for guide in 0..guide_count {
        for index in 0..from.strands_per_guide.min(to.strands_per_guide) {
            let [from_start, to_start] = [from, to]
                .map(|strands| (guide * strands.strands_per_guide + index) * strands.points_per_strand);
            let other = &to.positions[to_start..to_start + to.points_per_strand];
            for point in &from.positions[from_start..from_start + from.points_per_strand] {
                let nearest = other
                    .windows(2)
                    .map(|pair| distance_to_segment(*point, pair[0], pair[1]))
                    .fold(f32::INFINITY, f32::min);
                greatest = greatest.max(nearest);
            }
        }
    }
    greatest
}

fn distance_to_segment(point: Vec3, start: Vec3, end: Vec3) -> f32 {
    let along = end - start;
    let share = ((point - start).dot(along) / along.length_squared().max(1e-20)).clamp(0.0, 1.0);
    point.distance(start + along * share)
}

#[test]
fn levels_change_without_a_jump() {
    let guides = guides(10);
    let look = Look::default();
    let levels = LevelOfDetail::default();
    // Close up, where segments become more, and where all fall.
    let mut distance = 0.1;
    let at = |distance: f32| strands(&guides, &look, &levels.level(distance, look.follow_strands));
    let mut borders = 0;
    let mut before = at(distance);
    while distance < 7.0 {
        distance *= 1.002;
        let after = at(distance);
        if after.points_per_strand != before.points_per_strand
            || after.strands_per_guide != before.strands_per_guide
        {
            borders += 1;
        }
        // A pixel of a 1,000 pixel picture of 30 degrees covers 0.5 mm for each metre of distance.
        let shift = greatest_shift(&before, &after);
        assert!(shift < 0.5 * 5e-4 * distance, "{shift} m at {distance} m");
        before = after;
    }
    assert!(borders > 40, "the way must cross many levels");
    let coarse = strands(&guides, &look, &DetailLevel { segments_per_span: 1.0, ..DetailLevel::full(4, 16) });
    assert!(greatest_shift(&at(1.0), &coarse) > 0.5 * 5e-4 * 1.4, "a jump must be seen");
}

law! {
    fn detail_follows_the_size_of_a_pixel(on) {
        let look = Look { follow_strands: 16, ..Look::thesis() };
        // From the middle of the hair, or from the near side of its box.
        let draw = |from_middle: bool, distance: f32, rows: u32| {
            let (detail, guides) = (LevelOfDetail::default(), guides(40));
            let mut drawn = Drawn { guides, look: look.clone(), lights: Vec::new(), eye: Vec3::ZERO, detail };
            // A little farther, lest the last digit makes another strand.
            drawn.eye = drawn.middle() + 1.0001 * distance * Vec3::Z;
            if !from_middle {
                drawn.eye.z += drawn.bounds()[1].z - drawn.middle().z;
            }
            let report = drawn.reported(on, &PictureSettings::sized(8, rows)).1;
            (report.strands, report.segments)
        };
        let drawn = |distance, rows| draw(true, distance, rows);
        let full = drawn(1.5, 600);
        assert_eq!(full, (40 * 16, 40 * 16 * 4 * SPANS));
        assert_eq!([drawn(1.0, 600), drawn(3.0, 1200), drawn(0.75, 300)], [full; 3]);
        // Twice as far, or half as many rows: half the strands, and segments by the square root.
        let (strands, segments) = drawn(3.0, 600);
        assert_eq!(strands, 40 * 8);
        assert!(segments < full.1 * 2 / 5, "{segments} of {}", full.1);
        assert_eq!([drawn(6.0, 1200), drawn(1.5, 300)], [(strands, segments); 2]);
        // Close up by nearness or by rows: twice the segments.
        assert_eq!([draw(false, 0.125, 600), draw(false, 0.5, 2400)], [(full.0, 2 * full.1); 2]);
    }
}

law! {
    fn close_up_strands_are_as_round_in_pixels(on) {
        // Three turns of 5 mm.
        let curl = (0..=400).map(|step| {
            let turn = 3.0 * std::f32::consts::TAU * step as f32 / 400.0;
            Vec3::new(5e-3 * turn.cos(), -5e-4 * step as f32, 5e-3 * turn.sin())
        });
        let guides = crate::drawn::guides([curl.collect::<Vec<Vec3>>()], 28);
        let controls = controls(&guides, 0);
        // Greatest way from a segment's middle to the curve [m], at a distance from the near side of the hair.
        let stray = |distance: f32, detail: LevelOfDetail| {
            let detail = LevelOfDetail { by_pixel: false, ..detail };
            let (guides, look) = (guides.clone(), Look { follow_strands: 1, ..Look::thesis() });
            let mut drawn = Drawn { guides, look, lights: Vec::new(), eye: Vec3::ZERO, detail };
            drawn.eye = Vec3::new(0.0, -0.1, drawn.bounds()[1].z + distance);
            let [points, ..] = drawn.curves(on);
            let per_span = f64::from(detail.level(distance, 1).segments_per_span);
            assert_eq!(points.len() - 1, (per_span * 27.0 - 1e-3).ceil() as usize);
            // The last segment is shorter.
            (0..points.len() - 2).map(|point| {
                let middle = 0.5 * (points[point] + points[point + 1]).as_dvec3();
                middle.distance(de_boor(&controls, (point as f64 + 0.5) / per_span))
            }).fold(0.0, f64::max)
        };
        let detail = LevelOfDetail::default();
        let pixels = |distance: f32| stray(distance, detail) / f64::from(distance);
        let usual = pixels(0.5);
        for distance in [0.3, 0.125, 0.06, 0.04] {
            let found = pixels(distance) / usual;
            // Finer segments find the sharpest bend between the points, which coarse ones miss (0.04 m: 1.13).
            assert!((0.5..1.25).contains(&found), "at {distance} m segments stray {found} times as far");
        }
        let without = LevelOfDetail { most_segments: 1.0, ..detail };
        let found = stray(0.06, without) / 0.06 / usual;
        assert!(found > 7.0, "{found}: with as many segments as from 0.5 m they stray eight times as far");
    }
}

#[test]
fn the_drawn_strands_hold_for_any_number_of_threads() {
    let guides = guides(100);
    let look = Look::default();
    let level = DetailLevel::full(4, 16);
    let in_pool = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| strands(&guides, &look, &level))
    };
    let (one, five) = (in_pool(1), in_pool(5));
    assert_eq!((&one.positions, &one.tangents, &one.widths), (&five.positions, &five.tangents, &five.widths));
    let other = strands(&guides, &Look { seed: 1, ..look.clone() }, &level);
    assert_ne!(one.positions, other.positions);
}
