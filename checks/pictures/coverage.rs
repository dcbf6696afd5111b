//! `draw`: exact coverage of ribbons of any width, and hair hidden by the body.

use glam::{Vec3, Vec4};
use strandline_body::Mesh;
use strandline_render::PictureSettings;
use strandline_render::{Samples, resolve_linear};

use crate::grooms::Random;
use crate::screen::{Screen, covered, line, white};

const WIDTHS: [f32; 8] = [0.05, 0.2, 0.5, 0.9, 1.0, 1.5, 2.7, 4.0];

/// A line of `length` \[sample\] about the middle of a picture of 256 samples.
fn placed(screen: &Screen, angle: f32, length: f32, shift: [f32; 2], segments: usize) -> Vec<Vec3> {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let end = |side: f32| {
        let half = 0.5 * side * length;
        screen.point(128.0 + shift[0] + half * cosine, 128.0 + shift[1] + half * sine)
    };
    line(end(-1.0), end(1.0), segments)
}

const LENGTH: f32 = 171.3;

/// Covered area \[sample^2\] of a line of that length and of a width \[sample\].
fn covered_area(angle: f32, width: f32, shift: [f32; 2], segments: usize) -> f64 {
    let screen = Screen { size: 256, supersampling: 1 };
    let strands = white(&[placed(&screen, angle, LENGTH, shift, segments)], width * screen.sample());
    covered(&screen.draw(&strands, None))
}

/// Covered area over length times width.
fn coverage(angle: f32, width: f32, shift: [f32; 2], segments: usize) -> f64 {
    covered_area(angle, width, shift, segments) / f64::from(LENGTH * width)
}

#[test]
fn a_ribbon_covers_its_area_at_any_angle_place_and_width() {
    let mut random = Random(5);
    let angles = (0..24).map(|step| step as f32 * 15.0).chain([1.0, 44.9, 45.1, 89.5]);
    for angle in angles {
        for width in WIDTHS {
            let shift = [random.unit(), random.unit()];
            for segments in [1, 3, 20] {
                let share = coverage(angle, width, shift, segments);
                // Every step covers the exact width; the rest are places rounded to f32 (1e-5 of a sample) at
                // the two ends of 171 samples, and 256 sums of three roundings.
                assert!((share - 1.0).abs() < 2e-5, "{angle} deg, {width}, {segments} segments: {share}");
            }
        }
    }
}

#[test]
fn segments_shorter_than_a_sample_lose_less_than_one_step() {
    for segments in [400, 1500] {
        for angle in [0.0, 20.0, 45.0, 77.0] {
            let share = coverage(angle, 0.7, [0.3, 0.6], segments);
            // A step goes to the segment that holds its middle; a first or last segment without a middle
            // gives up to half a step at each end to its neighbour: 1 of at least 121 steps.
            assert!((share - 1.0).abs() < 1.0 / 121.0, "{angle} deg, {segments}: {share}");
        }
    }
}

#[test]
fn the_area_check_sees_a_wrong_width() {
    // Drawn a hundredth of a hundredth too wide.
    let share = covered_area(30.0, 0.50005, [0.2, 0.4], 3) / f64::from(LENGTH * 0.5);
    assert!((share - 1.0).abs() > 2e-5, "{share}");
}

#[test]
fn a_bent_ribbon_has_neither_gaps_nor_doubled_joints() {
    let screen = Screen { size: 256, supersampling: 1 };
    let circle = |radius: f32, segments: usize| -> Vec<Vec3> {
        let place = |step: usize| {
            let (sine, cosine) = (step as f32 / segments as f32 * std::f32::consts::TAU).sin_cos();
            screen.point(128.3 + radius * cosine, 127.8 + radius * sine)
        };
        (0..=segments).map(place).collect()
    };
    for segments in [24, 60, 200] {
        let chord = 2.0 * 90.0 * (std::f32::consts::PI / segments as f32).sin();
        for width in [0.3, 1.0, 3.0] {
            let samples = screen.draw(&white(&[circle(90.0, segments)], width * screen.sample()), None);
            let share = covered(&samples) / f64::from(chord * segments as f32 * width);
            // The axis changes four times, each within a sample's length along 565 samples; corners
            // of 15 degrees overlap inside and open outside by equal parts.
            assert!((share - 1.0).abs() < 4.0 / 565.0, "{segments} segments of {width}: {share}");
        }
        let samples = screen.draw(&white(&[circle(90.0, segments)], 3.0 * screen.sample()), None);
        for step in 50..(segments - 1) * 50 {
            // Away from the two ends of the strand, samples on its line lie well inside a ribbon of 3,
            // smoothed over 1: nothing else may show there.
            let points = circle(90.0, segments);
            let at = step as f32 / 50.0;
            let place = points[at as usize].lerp(points[at as usize + 1], at.fract()) / screen.sample();
            let (column, row) = ((place.x + 128.0) as usize, (128.0 - place.y) as usize);
            let opacity = samples.color(column, row).w;
            assert!(opacity > 0.98, "{segments} segments: {opacity} at {column}, {row}");
        }
    }
}

#[test]
fn supersampling_keeps_the_light_of_thin_hair() {
    let pixels = |supersampling: u32| {
        let screen = Screen { size: 128, supersampling };
        let scale = supersampling as f32;
        let mut random = Random(8);
        let lines: Vec<_> = (0..12)
            .map(|strand| {
                // Rows of their own: where strands cross, coverage is not a sum.
                let (y, slope) = (8.0 + 9.0 * strand as f32 + random.unit(), random.between(-3.0, 3.0));
                line(
                    screen.point(9.3 * scale, y * scale),
                    screen.point(110.7 * scale, (y + slope) * scale),
                    7,
                )
            })
            .collect();
        // A third of a pixel wide.
        let strands = white(&lines, 0.33 * scale * screen.sample());
        let settings = PictureSettings { supersampling, ..PictureSettings::sized(128, 128) };
        resolve_linear(&screen.draw(&strands, None), &settings)
    };
    let sum = |pixels: &[Vec4]| pixels.iter().map(|pixel| f64::from(pixel.w)).sum::<f64>();
    let (single, doubled) = (sum(&pixels(1)), sum(&pixels(2)));
    // Both draw the exact area; the filter gives every sample the same weight.
    assert!((single / doubled - 1.0).abs() < 1e-5, "{single} and {doubled}");
}

/// A square of `half` \[sample\] to each side at depth 0, facing the camera.
fn square(screen: &Screen, half: f32) -> Mesh {
    let middle = 0.5 * screen.size as f32;
    let corner = |x: f32, y: f32| screen.point(middle + x * half, middle - y * half);
    let positions = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

#[test]
fn the_body_hides_exactly_what_is_behind_it() {
    let screen = Screen { size: 160, supersampling: 1 };
    let mut random = Random(3);
    let mut lines = |depth: f32| -> Vec<Vec<Vec3>> {
        (0..60)
            .map(|_| {
                let mut end = || {
                    let place = screen.point(random.between(5.0, 155.0), random.between(5.0, 155.0));
                    place + Vec3::Z * depth
                };
                line(end(), end(), 6)
            })
            .collect()
    };
    let (front, behind) = (lines(0.001), lines(-0.001));
    let body = square(&screen, 50.0);
    let inside = |place: usize| (30..130).contains(&place);
    for (lines, hidden) in [(front, false), (behind, true)] {
        let strands = white(&lines, 0.8 * screen.sample());
        let (bare, bodied) = (screen.draw(&strands, None), screen.draw(&strands, Some(body.clone())));
        let mut seen = 0;
        for (column, row) in (0..160 * 160).map(|sample| (sample % 160, sample / 160)) {
            let (bare, bodied) = (bare.color(column, row), bodied.color(column, row));
            let hidden = hidden && inside(column) && inside(row);
            let expected = if hidden { Vec3::ZERO } else { bare.truncate() };
            assert_eq!(bodied.truncate(), expected, "at {column}, {row}");
            seen += usize::from(bodied.x > 0.0);
        }
        assert!(seen > 1000, "{seen}");
    }
}

#[test]
fn the_order_of_strands_does_not_matter() {
    let screen = Screen { size: 128, supersampling: 2 };
    let mut random = Random(6);
    let mut lines = Vec::new();
    let mut shades = Vec::new();
    for _ in 0..150 {
        let mut end = || {
            let place = screen.point(random.between(5.0, 250.0), random.between(5.0, 250.0));
            place + Vec3::Z * random.between(-0.1, 0.1)
        };
        lines.push(line(end(), end(), 4));
        shades.push(Vec3::new(random.unit(), random.unit(), random.unit()));
    }
    let draw = |order: &[usize]| -> Samples {
        let pick: Vec<_> = order.iter().map(|&strand| lines[strand].clone()).collect();
        let mut strands = white(&pick, 2.5 * screen.sample());
        for (radiances, &strand) in strands.radiances.chunks_exact_mut(5).zip(order) {
            radiances.fill(shades[strand]);
        }
        screen.draw(&strands, None)
    };
    let forward: Vec<usize> = (0..150).collect();
    let backward: Vec<usize> = (0..150).rev().collect();
    // Exact: no two of these 600 segments have the same mean depth in 24 bits.
    assert!(draw(&forward).colors == draw(&backward).colors);
}

#[test]
fn strands_through_the_camera_are_cut_and_strands_that_are_not_numbers_left_out() {
    let screen = Screen { size: 96, supersampling: 1 };
    let away = line(Vec3::new(0.02, -0.05, 1.2), Vec3::new(0.0, 0.0, -0.5), 5);
    let mut broken = line(screen.point(10.0, 20.0), screen.point(80.0, 20.0), 5);
    broken[2].y = f32::NAN;
    let dot = vec![screen.point(40.0, 70.0); 6];
    let samples = screen.draw(&white(&[away, broken, dot], 1e-3), None);
    assert!(samples.colors.iter().all(|color| color.is_finite() && color.w <= 1.0 + 1e-6));
    // The one through the camera's right: from the lower edge up to the middle, nowhere thinner than
    // 0.3 samples, half of which the nearer of two samples shows.
    assert!(samples.color(48, 48).w > 0.0);
    assert!((60..96).all(|row| (48..96).any(|column| samples.color(column, row).w > 0.15)));
    // Of the broken one, 0.18 samples wide, the segments beside the bad point are missing, the others are there.
    let row = |column: usize| samples.color(column, 19).w + samples.color(column, 20).w;
    assert!(row(15) > 0.17 && row(75) > 0.17 && row(35) == 0.0 && row(50) == 0.0);
    assert_eq!(samples.color(40, 70).w, 0.0);
}
