//! The shape of a clump: radii at root and tip, taper, lengths; and the widths that a level of detail leaves.

use glam::Vec3;
use strandline_checks::{On, law};
use strandline_render::Strands;
use strandline_render::{Clump, LevelOfDetail, Look};

use crate::drawn::{Drawn, guides};

/// A clump that stands straight off the skin: nothing is lifted, waved or cut.
const STRAIGHT: Clump = Clump {
    root_radius: 0.008,
    tip_radius: 0.002,
    taper: 1.0,
    lift: 0.0,
    shorter: 0.0,
    wave_amplitude: 0.0,
    wave_length: 0.06,
    together: 0.0,
};

/// Number of guides.
const GUIDES: usize = 12;

/// Guides of 20 cm that stand upright, each with `follow_strands`.
fn clumps(clump: Clump, follow_strands: u32) -> Drawn {
    clumps_along(Vec3::Y, clump, follow_strands)
}

/// Guides of 20 cm in a direction; the skin faces up.
fn clumps_along(along: Vec3, clump: Clump, follow_strands: u32) -> Drawn {
    let lines = (0..GUIDES).map(|guide| {
        let root = Vec3::X * 0.05 * guide as f32;
        vec![root, root + along * 0.2]
    });
    let mut guides = guides(lines, 5);
    guides.set_root_normals(vec![Vec3::Y; GUIDES]);
    Drawn {
        guides,
        look: Look { clump, follow_strands, ..Look::thesis() },
        lights: Vec::new(),
        eye: Vec3::Z,
        detail: LevelOfDetail::full(),
    }
}

/// Distances \[m\] from their guide of all follow strands but the guide itself, shape `[point][strand]`.
fn distances(strands: &Strands) -> Vec<Vec<f32>> {
    let (count, per_guide) = (strands.points_per_strand, strands.strands_per_guide);
    (0..count)
        .map(|point| {
            (0..strands.strand_count)
                .filter(|strand| strand % per_guide > 0)
                .map(|strand| {
                    let guide = strand / per_guide * per_guide;
                    strands.positions[strand * count + point]
                        .distance(strands.positions[guide * count + point])
                })
                .collect()
        })
        .collect()
}

law! {
    fn a_clump_goes_from_its_root_radius_to_its_tip_radius(on) {
        for taper in [1.0, 1.5, 3.0] {
            let strands = clumps(Clump { taper, ..STRAIGHT }, 65).strands(on);
            let last = strands.points_per_strand - 1;
            for (point, found) in distances(&strands).into_iter().enumerate() {
                let share = point as f32 / last as f32;
                let radius = 0.008 + (0.002 - 0.008) * share.powf(taper);
                let farthest = found.iter().fold(0.0_f32, |most, distance| most.max(*distance));
                let square = found.iter().map(|distance| distance * distance).sum::<f32>() / found.len() as f32;
                // Strands lie even in the disc: to its rim, and with half the square of the radius in the mean. 64
                // strands of each of 12 guides leave 2 %.
                assert!(farthest < radius + 1e-6, "point {point}: {farthest} of {radius} m");
                assert!(farthest > 0.97 * radius, "point {point}: {farthest} of {radius} m");
                let even = square / (0.5 * radius * radius);
                assert!((even - 1.0).abs() < 0.05, "point {point}, taper {taper}: {even} of an even disc");
            }
        }
    }
}

law! {
    fn few_follow_strands_lie_in_their_guide_where_they_are_lifted(on) {
        // Share of the strands that are nearer to their guide than a fifth of the clump's radius.
        let share = |lift: f32, along: Vec3| {
            let strands = clumps_along(along, Clump { lift, ..STRAIGHT }, 65).strands(on);
            let last = strands.points_per_strand - 1;
            let radius = |point: usize| 0.008 + (0.002 - 0.008) * point as f32 / last as f32;
            let (mut near, mut all) = (0.0, 0.0);
            // The beginning turns from the skin's plane into the strand's own.
            for (point, found) in distances(&strands).into_iter().enumerate().skip(last / 4) {
                near += found.iter().filter(|&&one| one < 0.2 * radius(point)).count() as f32;
                all += found.len() as f32;
            }
            near / all
        };
        // Hair that stands off the skin is not lifted: a twenty-fifth of an even disc, as without lift.
        let [standing, plain] = [0.85, 0.0].map(|lift| share(lift, Vec3::Y));
        assert!((standing - 0.04).abs() < 0.01 && (standing - plain).abs() < 1e-3, "{standing} of an even disc, {plain} without lift");
        let lying = share(0.85, Vec3::Z);
        assert!(lying < 0.05, "{lying} of what lies along the skin");
    }
}

law! {
    fn a_group_has_clumps_and_waves_of_its_own_size(on) {
        let clump = Clump { wave_amplitude: 0.001, lift: 0.85, ..STRAIGHT };
        let [whole, spread] = [false, true].map(|is_own| {
            let mut drawn = clumps(clump, 17);
            let spreads = (0..GUIDES).map(|guide| [1.0, 0.25, 0.0][guide % 3]).collect();
            drawn.guides.set_spreads(is_own.then_some(spreads)).unwrap();
            drawn.strands(on)
        });
        let followers = 16;
        for (whole, spread) in distances(&whole).into_iter().zip(distances(&spread)) {
            for (strand, (whole, spread)) in whole.into_iter().zip(spread).enumerate() {
                let share = [1.0, 0.25, 0.0][strand / followers % 3];
                // Rounding of places of 0.6 m.
                assert!((spread - share * whole).abs() < 5e-7, "{strand}: {spread} of {whole} m");
            }
        }
    }
}

law! {
    fn follow_strands_are_shorter_by_up_to_their_share(on) {
        let clump = Clump { root_radius: 0.0, tip_radius: 0.0, shorter: 0.3, ..STRAIGHT };
        let strands = clumps(clump, 65).strands(on);
        let count = strands.points_per_strand;
        let length = |strand: usize| {
            strands.positions[strand * count].distance(strands.positions[(strand + 1) * count - 1]) / 0.2
        };
        let followers = (0..strands.strand_count).filter(|strand| strand % 65 > 0);
        let lengths: Vec<f32> = followers.map(length).collect();
        let mean = lengths.iter().sum::<f32>() / lengths.len() as f32;
        let shortest = lengths.iter().fold(1.0_f32, |least, length| least.min(*length));
        // 768 squares of an even number: a mean of 1/3 within 0.011 and a largest of nearly 1.
        assert!((mean - 0.9).abs() < 0.01 && (0.7 - 1e-5..0.705).contains(&shortest), "{mean}, {shortest}");
        assert!((0..GUIDES).all(|guide| (length(65 * guide) - 1.0).abs() < 1e-5), "guides keep their length");
    }
}

law! {
    fn waves_grow_from_nothing_to_their_amplitude(on) {
        let clump = Clump { root_radius: 0.0, tip_radius: 0.0, wave_amplitude: 0.002, ..STRAIGHT };
        let found = distances(&clumps(clump, 65).strands(on));
        let root_mean_square = |point: usize| {
            let all = &found[point];
            (all.iter().map(|distance| distance * distance).sum::<f32>() / all.len() as f32).sqrt()
        };
        let last = found.len() - 1;
        assert!(root_mean_square(0) < 1e-7);
        // Two waves across each other, each of an effective 1 / sqrt(2): together their amplitude, which varies from
        // strand to strand by 0.4 to 1.6 (an effective 1.06).
        for point in [last / 2, last] {
            let expected = 1.06 * 0.002 * point as f32 / last as f32;
            let ratio = root_mean_square(point) / expected;
            assert!((ratio - 1.0).abs() < 0.1, "point {point}: {ratio} of the amplitude");
        }
    }
}

/// Sum of the widths \[m\] at the roots, and those of the first guide's strands.
fn widths(on: &On, look: Look, distance: f32, detail: LevelOfDetail) -> (f32, Vec<f32>) {
    let drawn = Drawn { look, eye: Vec3::new(0.275, 0.1, distance), detail, ..clumps(STRAIGHT, 16) };
    let strands = drawn.strands(on);
    let roots: Vec<f32> = strands.widths.iter().step_by(strands.points_per_strand).copied().collect();
    (roots.iter().sum(), roots[..strands.strands_per_guide].to_vec())
}

law! {
    fn fewer_strands_are_wider_and_cover_the_same(on) {
        let look = Look { follow_strands: 16, hair_count: 50_000, clump: STRAIGHT, ..Look::thesis() };
        // A GPU draws a picture of 16 rows to ask for its strands.
        let detail = LevelOfDetail { by_pixel: false, ..LevelOfDetail::default() };
        // All hairs that the strands stand for, side by side.
        let expected = 50_000.0 * 8e-5;
        // Full detail ends at 1.5 m; at d m there are 16 x 1.5 / d follow strands.
        for (distance, strands, part) in [(1.0, 16, 1.0), (3.2, 8, 0.5), (4.0, 6, 1.0), (50.0, 2, 1.0)] {
            let (sum, first) = widths(on, look.clone(), distance, detail);
            // Sums of some hundred numbers in single precision.
            assert!((sum / expected - 1.0).abs() < 1e-4, "{distance} m: {sum} of {expected} m");
            assert_eq!(first.len(), strands, "{distance} m");
            // The last strand fades by its width, the others are alike.
            let last = first[strands - 1] / first[0];
            assert!((last - part).abs() < 1e-3, "{distance} m: the last is {last} of the others");
            assert!(first[..strands - 1].iter().all(|width| (width / first[0] - 1.0).abs() < 1e-5));
        }
        let (sum, first) = widths(on, Look { hair_count: 0, ..look.clone() }, 1.0, detail);
        assert!((sum / (16.0 * GUIDES as f32 * 8e-5) - 1.0).abs() < 1e-4 && (first[0] / 8e-5 - 1.0).abs() < 1e-5);
        let (wide, _) = widths(on, Look { width_scale: 2.0, ..look }, 1.0, detail);
        assert!((wide / (2.0 * expected) - 1.0).abs() < 1e-4, "{wide}");
    }
}

law! {
    fn strands_thin_toward_the_tip_to_their_share(on) {
        let look = Look { tip_width: 0.4, clump: STRAIGHT, ..Look::thesis() };
        let strands = Drawn { look, ..clumps(STRAIGHT, 16) }.strands(on);
        let count = strands.points_per_strand;
        for widths in strands.widths.chunks(count) {
            assert!((widths[count - 1] / widths[0] - 0.4).abs() < 1e-4, "{widths:?}");
            assert!(widths.windows(2).all(|pair| pair[1] <= pair[0]), "{widths:?}");
        }
    }
}
