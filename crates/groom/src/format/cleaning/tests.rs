use glam::Vec3;

use super::*;

/// A cap of strands of 16 points, 0.22 to 0.25 m long, about a place.
fn groom(count: usize, about: Vec3) -> Groom {
    let mut groom = Groom::empty(0.0);
    for strand in 0..count {
        let angle = 2.4 * strand as f32;
        let root = about + 0.1 * Vec3::new(angle.cos(), 0.5, angle.sin());
        let way = Vec3::new(angle.cos(), -1.0, angle.sin()).normalize();
        let step = 0.0148 + 0.002 * (strand % 7) as f32 / 7.0;
        groom.push((0..16).map(|point| root + step * point as f32 * way));
    }
    groom
}

#[test]
fn an_ordinary_groom_is_left_alone() {
    for scale in [1.0, 100.0, 0.01] {
        let mut one = groom(300, Vec3::new(0.0, 1.6, 0.0));
        one.transform(scale, glam::Quat::IDENTITY, Vec3::ZERO);
        let before = one.clone();
        assert!(one.leave_out_strays().is_empty());
        if scale == 1.0 {
            one.widths =
                Widths::PerPoint((0..one.points.len()).map(|p| 8e-5 * (p % 16) as f32 / 15.0).collect());
            one.colors = Some(vec![[0.0, 0.5, 1.0]; one.points.len()]);
            assert!(one.mend().is_empty());
        }
        assert_eq!(one.points, before.points);
    }
    // Fur of a millimetre is short as a whole; long hair beside short hair is no stray.
    let mut fur = groom(300, Vec3::ZERO);
    fur.transform(0.004, glam::Quat::IDENTITY, Vec3::ZERO);
    assert!(fur.mend().is_empty() && fur.leave_out_strays().is_empty());
    let mut long = groom(300, Vec3::ZERO);
    (0..10).for_each(|strand| long.push([Vec3::Y * 0.05, Vec3::new(0.0, -0.8, 0.02 * strand as f32)]));
    assert!(long.leave_out_strays().is_empty());
    let mut few = Groom::empty(0.0);
    few.push([Vec3::ZERO, Vec3::X]);
    few.push([Vec3::splat(1e5), Vec3::splat(2e5)]);
    assert!(few.leave_out_strays().is_empty(), "of few strands none is like the others");
}

#[test]
fn strays_are_left_out_whatever_the_units() {
    for (scale, far) in [(1.0, 1e6), (100.0, 1e6), (1.0, 5.0)] {
        let mut groom = groom(300, Vec3::new(0.0, 1.6, 0.0));
        groom.transform(scale, glam::Quat::IDENTITY, Vec3::ZERO);
        groom.points[4 * 16 + 15] = Vec3::X * far * scale;
        groom.points[9 * 16 + 7] = Vec3::NEG_Y * far * scale;
        let range = groom.range(20);
        groom.points[range].iter_mut().for_each(|point| *point += Vec3::Z * far * scale);
        assert_eq!(groom.strays("named"), ["3 strands reach far from all others, the first is 4: named"]);
        let held = groom.bounds_without_strays();
        assert_eq!(groom.leave_out_strays().len(), 1);
        assert_eq!(groom.strand_count(), 297);
        assert_eq!(groom.bounds(), held);
        assert!((held.max - held.min).max_element() < scale);
    }
}

#[test]
fn dummy_points_at_the_origin_are_left_out() {
    let mut groom = groom(300, Vec3::new(0.0, 1.6, 0.0));
    groom.colors = Some((0..groom.points.len()).map(|point| [point as f32, 0.0, 0.0]).collect());
    // Two strands padded with zeros at their ends, and one that has a point of its own alone.
    for point in [3 * 16 + 14, 3 * 16 + 15, 8 * 16 + 15].into_iter().chain(5 * 16 + 1..6 * 16) {
        groom.points[point] = Vec3::ZERO;
    }
    let notes = groom.leave_out_strays();
    assert_eq!(notes, ["18 dummy points lie at the origin, the first is point 14 of strand 3: left out"]);
    assert_eq!(groom.strand_count(), 299);
    assert_eq!([3, 4, 7].map(|strand| groom.strand(strand).len()), [14, 16, 15]);
    let color =
        |strand: usize, point: usize| groom.colors.as_ref().unwrap()[groom.range(strand).start + point][0];
    assert_eq!([color(3, 13), color(4, 0), color(5, 0)], [61.0, 64.0, 96.0], "attributes stay with points");
    assert_eq!(groom.colors.as_ref().unwrap().len(), groom.points.len());
}

#[test]
fn notes_give_numbers_of_the_file_after_strands_are_left_out() {
    // A square of strands that hang, one of which is led against the others.
    let mut lawn = Groom::empty(8e-5);
    for strand in 0..900 {
        let root = Vec3::new(0.005 * (strand / 30) as f32, 1.0, 0.005 * (strand % 30) as f32);
        let way = Vec3::new(0.001 * (strand % 7) as f32, if strand == 500 { 0.04 } else { -0.04 }, 0.0);
        lawn.push((0..6).map(|point| root + way * point as f32));
    }
    for strand in [2, 7] {
        let start = lawn.range(strand).start;
        lawn.points[start] = Vec3::NAN;
    }
    let [far, tiny] = [20, 31].map(|strand| lawn.range(strand));
    lawn.points[far].iter_mut().for_each(|point| *point += Vec3::X * 99.0);
    let root = lawn.points[tiny.start];
    lawn.points[tiny].iter_mut().enumerate().for_each(|(point, place)| *place = root + 1e-5 * point as f32);
    let last = lawn.range(600).end - 1;
    lawn.points[last] = Vec3::ZERO;
    let mut problems = Vec::new();
    let mut groom = crate::format::sieve::sieve(lawn, false, &mut problems).unwrap();
    assert!(problems[0].ends_with("the first are [2, 7]"), "{problems:?}");
    assert_eq!(
        groom.leave_out_strays(),
        [
            "1 strand reaches far from all others, the first is 20: left out",
            "1 dummy point lies at the origin, the first is point 5 of strand 600: left out"
        ]
    );
    assert_eq!(groom.mend(), ["1 strand is shorter than 1 mm and than 2 % of the median: left out"]);
    let notes = groom.unlike_beside();
    assert_eq!(notes, ["1 strand is led against all those beside, the first is 500: left as in the file"]);
    // Strands of further files have their own numbers.
    groom.append({
        let mut other = groom.clone();
        other.numbers = None;
        other.number_strands();
        other
    });
    assert_eq!([groom.number(0), groom.number(895), groom.number(896)], [0, 899, 0]);
}

#[test]
fn tiny_strands_are_left_out() {
    let mut groom = groom(300, Vec3::ZERO);
    for strand in (0..300).filter(|strand| strand % 3 == 0) {
        let range = groom.range(strand);
        let root = groom.points[range.start];
        let share = 10.0_f32.powf(-6.0 + 0.035 * strand as f32 / 3.0);
        groom.points[range].iter_mut().for_each(|point| *point = root + share * (*point - root));
    }
    assert_eq!(groom.unlike("hint").len(), 1);
    let notes = groom.mend();
    assert_eq!(notes, ["100 strands are shorter than 1 mm and than 2 % of the median: left out"]);
    assert_eq!(groom.strand_count(), 200);
    assert!(groom.mend().is_empty());
}

#[test]
fn widths_that_no_hair_has_are_mended() {
    let with = |widths: Widths| {
        let mut groom = Groom { widths, ..groom(40, Vec3::ZERO) };
        let notes = groom.mend();
        (groom.widths, notes)
    };
    let points = 40 * 16;
    for width in [0.0, 1.0, 1e-9] {
        let (found, notes) = with(Widths::PerPoint(vec![width; points]));
        assert_eq!((found, notes.len()), (Widths::Constant(HAIR_WIDTH), 1), "{width}");
    }
    assert_eq!(with(Widths::Constant(1.0)).0, Widths::Constant(HAIR_WIDTH));
    let (found, notes) = with(Widths::PerStrand(vec![0.08; 40]));
    assert!(notes[0].contains("taken as millimetres"), "{notes:?}");
    assert!((found.at(0, 0) - 8e-5).abs() < 1e-9);
    assert!((with(Widths::Constant(70.0)).0.at(0, 0) - 7e-5).abs() < 1e-9);
    let mut some = vec![8e-5; 40];
    (some[3], some[7]) = (0.0, 1.0);
    let (found, notes) = with(Widths::PerStrand(some));
    assert!(notes[0].starts_with("2 strands have widths unlike the others"), "{notes:?}");
    assert_eq!(found, Widths::PerStrand(vec![8e-5; 40]));
    assert_eq!(with(Widths::Constant(0.0)).0, Widths::Constant(0.0), "a file without widths");
}

#[test]
fn colours_of_bytes_become_light() {
    let with = |color: [f32; 3], one: f32| {
        let mut groom = groom(40, Vec3::ZERO);
        let mut colors = vec![color; groom.points.len()];
        colors[0][0] = one;
        groom.colors = Some(colors);
        let notes = groom.mend();
        (groom.colors.unwrap(), notes)
    };
    let (colors, notes) = with([139.0, 90.0, 43.0], 139.0);
    assert_eq!(notes, ["colours up to 139: taken as 0 to 255 of sRGB"]);
    // 139 / 255 of sRGB is 0.2582 of light.
    assert!((colors[1][0] - 0.2582).abs() < 1e-4 && colors[1][2] < 0.03, "{:?}", colors[1]);
    assert!(with([139.5, 90.25, 43.0], 1.0).1[0].contains("0 to 255"));
    assert!(with([35_723.0, 23_130.0, 11_051.0], 1.0).1[0].contains("0 to 65535"));
    assert!(with([35_723.5, 23_130.0, 11_051.0], 1.0).1[0].contains("cut off"));
    let (colors, notes) = with([0.25, 0.5, 0.75], 1.5);
    assert_eq!(notes, ["1 part of a colour is beyond 0 to 1: cut off there"]);
    assert_eq!((colors[0], colors[1]), ([1.0, 0.5, 0.75], [0.25, 0.5, 0.75]));
    assert!(with([0.0, 1.0, 0.5], -0.5).0[0][0] == 0.0);
}
