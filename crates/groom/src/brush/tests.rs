use strandline_base::Random;

use super::*;
use crate::Widths;

/// Strands in pairs, each the mirror of the other, bent at random.
fn pairs() -> Groom {
    let mut random = Random::new(7, 1);
    let mut groom = Groom::empty(8e-5);
    let mut colors = Vec::new();
    for _ in 0..200 {
        let mut place = Vec3::new(0.002 + 0.09 * random.unit(), 0.1, 0.08 * random.signed());
        let mut way = Vec3::new(random.signed(), -0.2 + random.signed(), random.signed()).normalize();
        let mut strand = vec![place];
        for _ in 0..12 + random.bits() % 8 {
            way = (way + 0.4 * Vec3::new(random.signed(), random.signed(), random.signed())).normalize();
            place += way * (0.008 + 0.004 * random.unit());
            strand.push(place);
        }
        colors.extend(strand.iter().map(|point| [point.y, 0.0, 0.0]));
        colors.extend(strand.iter().map(|point| [point.y, 0.0, 0.0]));
        groom.push(strand.iter().copied());
        groom.push(strand.iter().map(|point| mirrored(*point, -1.0)));
    }
    groom.widths = Widths::PerPoint(vec![8e-5; groom.points.len()]);
    groom.colors = Some(colors);
    groom
}

fn stroke(tool: Tool) -> Stroke {
    let motion = Vec3::new(0.05, 0.02, -0.03);
    Stroke { tool, position: Vec3::new(0.04, 0.1, 0.0), radius: 0.05, motion, ..Stroke::default() }
}

fn is_under(stroke: &Stroke, groom: &Groom, strand: usize) -> bool {
    groom.strand(strand)[0].distance(stroke.position) < stroke.radius
}

#[test]
fn every_tool_keeps_roots_and_strands_outside_to_the_bit_and_changes_those_under_it() {
    let groom = pairs();
    for tool in Tool::ALL {
        let stroke = stroke(tool);
        let after = stroke.on(&groom);
        after.check_lengths().unwrap();
        let mut changed = 0;
        for strand in 0..groom.strand_count() {
            assert_eq!(after.strand(strand)[0], groom.strand(strand)[0], "{tool:?} {strand}");
            assert!(
                after.strand(strand).len() >= 2 && after.strand(strand).iter().all(|point| point.is_finite())
            );
            let is_other = after.strand(strand) != groom.strand(strand);
            assert!(!is_other || is_under(&stroke, &groom, strand), "{tool:?} {strand}");
            changed += usize::from(is_other);
        }
        assert!(changed > 20, "{tool:?} changes {changed}");
        let none = Stroke { strength: 0.0, ..stroke }.on(&groom);
        let near = none.points.iter().zip(&groom.points).all(|(a, b)| a.distance(*b) < 1e-6);
        assert!(near && none.points.len() == groom.points.len(), "{tool:?} without strength");
        assert_eq!(stroke.on(&groom), after, "the same bits");
    }
}

#[test]
fn symmetric_strokes_keep_mirrored_hair_mirrored_to_the_bit() {
    let groom = pairs();
    let is_mirrored = |groom: &Groom| {
        (0..groom.strand_count()).step_by(2).all(|strand| {
            let other: Vec<Vec3> =
                groom.strand(strand + 1).iter().map(|point| mirrored(*point, -1.0)).collect();
            groom.strand(strand) == other
        })
    };
    for tool in Tool::ALL {
        // Over the midline, where both brushes reach, and on the left.
        for x in [0.02, -0.02, 0.06] {
            let position = Vec3::new(x, 0.1, 0.01);
            let stroke = Stroke { position, symmetric: true, ..stroke(tool) };
            let after = stroke.on(&groom);
            assert!(is_mirrored(&after) && after != groom, "{tool:?} {x}");
            assert!(!is_mirrored(&Stroke { symmetric: false, ..stroke }.on(&groom)), "{tool:?} {x}");
        }
    }
}

#[test]
fn a_cut_leaves_no_point_beyond_its_length_and_what_was_before_it_to_the_bit() {
    let groom = pairs();
    for length in [0.001, 0.03, 0.0731] {
        let stroke = Stroke { length, ..stroke(Tool::Cut) };
        let after = stroke.on(&groom);
        let (before, lengths) = (groom.lengths(), after.lengths());
        for strand in 0..groom.strand_count() {
            let expected = if is_under(&stroke, &groom, strand) { length } else { before[strand] };
            assert!((lengths[strand] - expected).abs() < 1e-6, "{strand}: {}", lengths[strand]);
            let (cut, whole) = (after.strand(strand), groom.strand(strand));
            assert_eq!(cut[..cut.len() - 1], whole[..cut.len() - 1]);
            let colors = after.colors.as_ref().unwrap();
            assert!(after.range(strand).all(|point| (colors[point][0] - after.points[point].y).abs() < 1e-6));
        }
        let half = Stroke { strength: 0.5, ..stroke }.on(&groom).lengths();
        let under = (0..half.len()).filter(|strand| is_under(&stroke, &groom, *strand));
        for strand in under {
            assert!((half[strand] - 0.5 * (before[strand] + length)).abs() < 1e-6);
        }
    }
    let long = Stroke { length: 1.0, ..stroke(Tool::Cut) };
    assert_eq!(long.on(&groom), groom, "shorter hair stays");
}

#[test]
fn lengthened_hair_keeps_its_shape() {
    let groom = pairs();
    let stroke = Stroke { length: 0.04, ..stroke(Tool::Lengthen) };
    let after = stroke.on(&groom);
    let (before, lengths) = (groom.lengths(), after.lengths());
    let mut longest: f32 = 0.0;
    for strand in 0..groom.strand_count() {
        let more = stroke.falloff(groom.strand(strand)[0]) * stroke.length;
        assert!((lengths[strand] - before[strand] - more).abs() < 1e-6);
        longest = longest.max(more);
        let scale = lengths[strand] / before[strand];
        for (old, new) in groom.strand(strand).windows(2).zip(after.strand(strand).windows(2)) {
            assert!(((new[1] - new[0]) - scale * (old[1] - old[0])).length() < 1e-6);
        }
    }
    assert!(longest > 0.03);
}

#[test]
fn combed_clumped_and_curled_hair_keeps_its_length() {
    let groom = pairs();
    for tool in [Tool::Comb, Tool::Clump, Tool::Curl] {
        let after = stroke(tool).on(&groom);
        for (old, new) in groom.lengths().iter().zip(after.lengths()) {
            assert!((old - new).abs() < 1e-5 * old, "{tool:?} {old} {new}");
        }
    }
}

#[test]
fn a_comb_draws_tips_along_its_motion_and_a_clump_gathers_them() {
    let groom = pairs();
    let tip = |groom: &Groom, strand| *groom.strand(strand).last().unwrap();
    let comb = stroke(Tool::Comb);
    let combed = comb.on(&groom);
    let way = comb.motion.normalize();
    let under: Vec<usize> =
        (0..groom.strand_count()).filter(|strand| is_under(&comb, &groom, *strand)).collect();
    let moved: f32 = under.iter().map(|&strand| (tip(&combed, strand) - tip(&groom, strand)).dot(way)).sum();
    let mean = moved / under.len() as f32;
    assert!((0.1..1.0).contains(&(mean / comb.motion.length())), "{mean}");

    let near = Stroke { radius: 0.02, ..stroke(Tool::Clump) };
    let clumped = near.on(&groom);
    let spread = |groom: &Groom| {
        let inner: Vec<usize> =
            under.iter().copied().filter(|strand| is_under(&near, groom, *strand)).collect();
        let middle = inner.iter().map(|&strand| tip(groom, strand)).sum::<Vec3>() / inner.len() as f32;
        inner.iter().map(|&strand| tip(groom, strand).distance(middle)).sum::<f32>() / inner.len() as f32
    };
    // The mean share over a disc is a third.
    assert!(spread(&clumped) < 0.8 * spread(&groom), "{} of {}", spread(&clumped), spread(&groom));
}

#[test]
fn a_straight_strand_winds_in_turns_of_its_pitch() {
    let mut groom = Groom::empty(8e-5);
    groom.push((0..161).map(|point| Vec3::new(0.0, -0.001 * point as f32, 0.0)));
    let curl = Stroke { tool: Tool::Curl, radius: 1.0, curl: 0.005, pitch: 0.04, ..Stroke::default() };
    let points = curl.on(&groom).points;
    // 160 mm of hair in turns of 40 mm: four, of which each crosses the plane x = 0 twice.
    let [middle_x, middle_z] =
        [0, 2].map(|part| points[81..].iter().map(|point| point[part]).sum::<f32>() / 80.0);
    let crossings =
        points.windows(2).filter(|pair| (pair[0].x - middle_x) * (pair[1].x - middle_x) < 0.0).count();
    assert!((6..=9).contains(&crossings), "{crossings}");
    let far = |point: &Vec3| (point.x - middle_x).hypot(point.z - middle_z);
    assert!(points[81..].iter().all(|point| (far(point) - 0.005).abs() < 3e-4));
    let shortened = -points[160].y / 0.16;
    // Of a turn 2 pi 5 mm lie across: sqrt(1 - (31.4 / 40)^2) = .62 of it along.
    assert!((0.6..0.75).contains(&shortened), "{shortened}");
}

#[test]
fn strands_of_one_point_and_of_no_length_are_no_obstacle() {
    let mut groom = Groom::empty(8e-5);
    groom.push([Vec3::ZERO]);
    groom.push([Vec3::ZERO; 4]);
    groom.push([]);
    for tool in Tool::ALL {
        let after = Stroke { tool, motion: Vec3::X, ..Stroke::default() }.on(&groom);
        assert!(
            after.check_lengths().is_ok() && after.points.iter().all(|point| point.is_finite()),
            "{tool:?}"
        );
    }
}
