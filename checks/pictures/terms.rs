//! Each term of the light that hair sends to the eye, through `shade` on both backends: diffuse light, both
//! highlights, their noise, the light that passes through hair, and light from all around.

use glam::Vec3;
use strandline_checks::law;
use strandline_render::Strands;
use strandline_render::fibre::Highlight;
use strandline_render::{Clump, Environment, LevelOfDetail, Light, LightKind, Look, Shadow};

use crate::drawn::{Drawn, guides};

/// A highlight that is switched off by its place: narrow, and far from every view.
const AWAY: Highlight = Highlight { shift: -45.0, width: 0.5, strength: 0.5 };
const DARK: Environment = Environment { sky: Vec3::ZERO, ground: Vec3::ZERO };
/// Half floats round by 2.4e-4 of the value, and `exp` and square roots of a GPU add some of their own.
const HALF: f32 = 1e-3;

/// A look without any noise, surroundings or shadow, all of whose light is diffuse.
pub fn plain(color: Vec3) -> Look {
    let none = Highlight { shift: 0.0, width: 5.0, strength: 0.0 };
    Look {
        follow_strands: 1,
        hair_count: 0,
        root_color: color,
        tip_color: color,
        variation: 0.0,
        grey: 0.0,
        highlight_noise: 0.0,
        environment: DARK,
        shadow: Shadow { opacity: 0.0, ..Shadow::default() },
        clump: Clump { wave_amplitude: 0.0, shorter: 0.0, ..Clump::default() },
        ..Look::thesis()
    }
    .with_scheuermann(|fibre| {
        fibre.first_highlight = none;
        fibre.second_highlight = none;
        fibre.sparkle = 0.0;
        fibre.translucency = 0.0;
    })
}

/// Light from a direction, of radiance 1, without shadow.
fn sun(from: Vec3) -> Light {
    Light {
        kind: LightKind::Directional,
        position: from,
        target: Vec3::ZERO,
        intensity: 1.0,
        shadow: false,
        ..Light::default()
    }
}

/// Straight strands of 4 cm through one place, root to tip along the given ways, seen along z.
fn straight(ways: impl IntoIterator<Item = Vec3>, look: Look, lights: Vec<Light>) -> Drawn {
    let lines = ways.into_iter().map(|way| vec![-0.02 * way, 0.02 * way]);
    let detail = LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() };
    // So far off that all points are seen from one direction.
    Drawn { guides: guides(lines, 8), look, lights, eye: Vec3::Z * 200.0, detail }
}

/// A strand that leans by an angle \[degrees\] toward the eye: its tip is nearer.
fn leaning(degrees: f32) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vec3::new(0.0, cosine, sine)
}

/// Radiances of a strand's points.
fn of(strands: &Strands, strand: usize) -> &[Vec3] {
    &strands.radiances[strand * strands.points_per_strand..(strand + 1) * strands.points_per_strand]
}

fn close(found: f32, expected: f32, tolerance: f32) -> bool {
    (found - expected).abs() <= tolerance * expected.abs().max(1e-3)
}

law! {
    fn diffuse_light_falls_with_the_sine_between_hair_and_light(on) {
        let color = Vec3::new(0.8, 0.4, 0.1);
        let angles = [0.0_f32, 20.0, 45.0, 70.0, -45.0];
        let lit = |from: Vec3| straight(angles.map(leaning), plain(color), vec![sun(from)]).strands(on);
        let (before, behind) = (lit(Vec3::Z), lit(Vec3::NEG_Z));
        for (strand, angle) in angles.into_iter().enumerate() {
            let (before, behind) = (of(&before, strand)[3], of(&behind, strand)[3]);
            // Over both sides the turn about the strand drops out, leaving the sine of [Kajiya1989
            // eq. 14] over pi, twice, in the hair's colour.
            let expected = color * (2.0 / std::f32::consts::PI * angle.to_radians().cos());
            let sum = before + behind;
            for channel in 0..3 {
                let (found, expected) = (sum[channel], expected[channel]);
                assert!(close(found, expected, HALF), "{angle} degrees: {found}, expected {expected}");
            }
            // Hair sends more back than on.
            assert!(before.x > 3.0 * behind.x, "{angle} degrees: {before} and {behind}");
        }
        let along = straight([Vec3::Z], plain(color), vec![sun(Vec3::Z)]).strands(on);
        assert!(of(&along, 0)[3].max_element() < 1e-3, "light along a hair does not meet it");
    }
}

law! {
    fn colour_goes_from_root_to_tip_and_strands_vary(on) {
        let (root, tip) = (Vec3::new(0.6, 0.2, 0.1), Vec3::new(0.2, 0.4, 0.8));
        let look = Look { tip_color: tip, ..plain(root) };
        let strands = straight([Vec3::Y], look.clone(), vec![sun(Vec3::Z)]).strands(on);
        let (found, peak) = (of(&strands, 0), 1.8 / std::f32::consts::PI);
        for (point, radiance) in found.iter().enumerate() {
            let expected = root.lerp(tip, point as f32 / 7.0) * peak;
            assert!(radiance.distance(expected) < HALF, "point {point}: {radiance}, expected {expected}");
        }
        let varied = Look { variation: 0.4, ..look };
        let strands = straight([Vec3::Y; 400], varied.clone(), vec![sun(Vec3::Z)]).strands(on);
        let factors: Vec<f32> = (0..400).map(|strand| of(&strands, strand)[0].x / (0.6 * peak)).collect();
        let mean = factors.iter().sum::<f32>() / 400.0;
        let spread = (factors.iter().map(|factor| (factor - mean).powi(2)).sum::<f32>() / 400.0).sqrt();
        // Two even parts, each of half the spread to both sides: 0.4 sqrt(2 / 12) = 0.163; of 400 strands
        // the mean errs by 0.008 and the spread by 4 %.
        assert!((mean - 1.0).abs() < 0.03 && (spread - 0.163).abs() < 0.03, "mean {mean}, spread {spread}");
        let grey = Look { grey: 0.25, variation: 0.0, ..varied };
        let strands = straight([Vec3::Y; 400], grey, vec![sun(Vec3::Z)]).strands(on);
        let white = (0..400).filter(|&strand| of(&strands, strand)[0].z > 0.5 * peak).count();
        // 100 expected, deviation 9.
        assert!((60..140).contains(&white), "{white} of 400 strands are white");
    }
}

/// Inclinations of strands to the eye \[degrees\].
const LEANS: std::ops::RangeInclusive<i32> = -120..=120;

fn leans() -> impl Iterator<Item = f32> {
    LEANS.map(|step| step as f32 * 0.25)
}

/// Brightness in one channel of strands that lean more and more to the eye, lit from the eye: mean over the points of
/// each, by inclination \[degrees\].
fn profile(drawn: &Drawn, on: &strandline_checks::On, channel: usize) -> Vec<(f32, f32)> {
    let strands = drawn.strands(on);
    let mean = |strand: usize| {
        let points = of(&strands, strand);
        points.iter().map(|radiance| radiance[channel]).sum::<f32>() / points.len() as f32
    };
    leans().enumerate().map(|(strand, lean)| (lean, mean(strand))).collect()
}

/// Mean and deviation \[degrees\] of a profile.
fn moments(profile: &[(f32, f32)]) -> (f32, f32) {
    let weight: f32 = profile.iter().map(|(_, light)| light).sum();
    let mean = profile.iter().map(|(lean, light)| lean * light).sum::<f32>() / weight;
    let square = profile.iter().map(|(lean, light)| (lean - mean).powi(2) * light).sum::<f32>() / weight;
    (mean, square.sqrt())
}

law! {
    fn the_named_looks_lean_their_highlights_as_hair_does(on) {
        // Cuticle scales lean toward the tip by 2 to 4 degrees: mirrored light leans 5 to 10 degrees toward the root,
        // light that crosses the hair and returns half again as much toward the tip [Marschner2003 table 1]. Lit from the
        // eye, a strand whose tip is nearer (which leans toward the eye) shows the second one.
        for look in [Look::brown(), Look::black(), Look::blonde(), Look::red(), Look::grey()] {
            let bare = plain(Vec3::ZERO);
            let first = bare.clone().with_scheuermann(|fibre| {
fibre.first_highlight = look.fibre.scheuermann.first_highlight;
fibre.second_highlight = AWAY;
});
            let (mean, deviation) = moments(&profile(&straight(leans().map(leaning), first, vec![sun(Vec3::Z)]), on, 1));
            assert!((-10.0..-4.0).contains(&mean), "the first highlight leans by {mean} degrees");
            let width = look.fibre.scheuermann.first_highlight.width;
            assert!((deviation / width - 1.0).abs() < 0.1, "it is {deviation} degrees wide, {width} by its setting");
            // No light is diffuse when both highlights take half of it each.
            let second = plain(Vec3::new(0.81, 0.25, 0.04)).with_scheuermann(|fibre| {
fibre.first_highlight = AWAY;
fibre.second_highlight = Highlight { strength: 0.5, ..look.fibre.scheuermann.second_highlight };
});
            let sweep = straight(leans().map(leaning), second, vec![sun(Vec3::Z)]);
            let (mean, _) = moments(&profile(&sweep, on, 0));
            // The sweep ends 30 degrees aside, 2.5 deviations.
            assert!((5.0..15.0).contains(&mean), "the second highlight leans by {mean} degrees");
        }
    }
}

law! {
    fn the_first_highlight_is_white_and_the_second_takes_the_paler_colour_of_the_hair(on) {
        let color = Vec3::new(0.81, 0.25, 0.04);
        let here = Highlight { shift: 0.0, width: 5.0, strength: 0.5 };
        let lit = |first_highlight, second_highlight| {
            let look = plain(color).with_scheuermann(|fibre| {
fibre.first_highlight = first_highlight;
fibre.second_highlight = second_highlight;
});
            of(&straight([Vec3::Y], look, vec![sun(Vec3::Z)]).strands(on), 0)[3]
        };
        let (first, second) = (lit(here, AWAY), lit(AWAY, here));
        assert!(close(first.x, first.z, HALF) && close(first.y, first.z, HALF), "{first}");
        // Light that crossed the hair twice; the root of the reflectance.
        let tint = Vec3::new(0.9, 0.5, 0.2);
        for channel in 0..3 {
            assert!(close(second[channel] / second.x, tint[channel] / 0.9, HALF), "{second}");
        }
        // Each gives back its share: over all inclinations and turns the first sends cos(turn / 2) / 4, the second (1 +
        // cos turn)^2 / (3 pi), of its strength; straight back they are 1 / 4 and 4 / (3 pi).
        let ratio = (second.x / 0.9) / first.x;
        assert!(close(ratio, 16.0 / (3.0 * std::f32::consts::PI), 2.0 * HALF), "{ratio}");
    }
}

law! {
    fn noise_moves_both_highlights_by_up_to_its_angle(on) {
        let narrow = Highlight { shift: 0.0, width: 1.0, strength: 0.5 };
        let spread = |first_highlight, second_highlight, highlight_noise| {
            let look = Look { highlight_noise, ..plain(Vec3::ONE) }.with_scheuermann(|fibre| {
fibre.first_highlight = first_highlight;
fibre.second_highlight = second_highlight;
});
            // Eight strands of each inclination, and eight points of each strand, for the noise to differ.
            let ways = leans().flat_map(|lean| [leaning(lean); 8]);
            let strands = straight(ways, look, vec![sun(Vec3::Z)]).strands(on);
            let profile: Vec<(f32, f32)> = leans()
                .enumerate()
                .map(|(step, lean)| {
                    let all = (0..8).flat_map(|strand| of(&strands, 8 * step + strand));
                    (lean, all.map(|radiance| radiance.y).sum())
                })
                .collect();
            let reach = profile.iter().filter(|(_, light)| *light > 1e-2).map(|(lean, _)| lean.abs());
            (moments(&profile).1, reach.fold(0.0, f32::max))
        };
        for [first, second] in [[narrow, AWAY], [AWAY, narrow]] {
            let (still, _) = spread(first, second, 0.0);
            assert!((still - 1.0).abs() < 0.05, "without noise it is as wide as its setting: {still}");
            for noise in [4.0_f32, 8.0] {
                let (deviation, reach) = spread(first, second, noise);
                // Deviations add by their squares. Noise that is even up to its angle deviates by 0.58 of it, and by
                // less where more than one number goes into it.
                let moved = (deviation * deviation - still * still).max(0.0).sqrt() / noise;
                assert!((0.33..0.6).contains(&moved), "{noise} degrees of noise deviate by {moved} of it");
                assert!(reach < noise + 4.5, "{noise} degrees of noise reach {reach}");
            }
        }
    }
}

law! {
    fn sparkle_breaks_up_the_second_highlight_only(on) {
        let here = Highlight { shift: 0.0, width: 20.0, strength: 0.5 };
        let lit = |first_highlight, second_highlight, sparkle| {
            let look = plain(Vec3::ONE).with_scheuermann(|fibre| {
fibre.first_highlight = first_highlight;
fibre.second_highlight = second_highlight;
fibre.sparkle = sparkle;
});
            let strands = straight([Vec3::Y; 100], look, vec![sun(Vec3::Z)]).strands(on);
            strands.radiances.iter().map(|radiance| radiance.y).collect::<Vec<f32>>()
        };
        let shares = |first, second| -> Vec<f32> {
            let (whole, broken) = (lit(first, second, 0.0), lit(first, second, 0.7));
            broken.iter().zip(whole).map(|(broken, whole)| broken / whole).collect()
        };
        let second = shares(AWAY, here);
        let mean = second.iter().sum::<f32>() / second.len() as f32;
        let (least, most) =
            second.iter().fold((f32::MAX, f32::MIN), |(least, most), share| (least.min(*share), most.max(*share)));
        // Even from 1 - 0.7 to 1: 800 points have a mean within 0.01 of the middle.
        assert!((mean - 0.65).abs() < 0.03, "the mean is {mean}");
        assert!((0.3 - HALF..0.33).contains(&least) && (0.97..=1.0 + HALF).contains(&most), "{least} to {most}");
        let first = shares(here, AWAY);
        assert!(first.iter().all(|share| close(*share, 1.0, HALF)), "the first highlight does not sparkle");
    }
}

law! {
    fn light_goes_on_through_hair_in_its_colour(on) {
        // A block of hair: 12 rows behind each other, in the light of the eye.
        let lines = (0..240).map(|strand| {
            let (column, row) = (strand % 20, strand / 20);
            let at = Vec3::new(4e-4 * column as f32, 0.0, -2e-3 * row as f32);
            vec![at - Vec3::Y * 0.02, at + Vec3::Y * 0.02]
        });
        let hair = guides(lines, 4);
        let lit = |opacity, translucency| {
            let shadow = Shadow { opacity, map_size: 64, ..Shadow::default() };
            let look = Look { width_scale: 4.0, shadow, ..plain(Vec3::new(0.81, 0.25, 0.04)) }.with_scheuermann(|fibre| fibre.translucency = translucency);
            let lights = vec![Light { shadow: true, ..sun(Vec3::Z) }];
            let detail = LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() };
            let drawn = Drawn { guides: hair.clone(), look, lights, eye: Vec3::Z * 200.0, detail };
            drawn.strands(on).radiances
        };
        let (open, dull, clear) = (lit(0.0, 0.0), lit(0.3, 0.0), lit(0.3, 0.6));
        let mut deep = 0;
        for ((open, dull), clear) in open.iter().zip(&dull).zip(&clear) {
            // Transmittance of the hair before: exp(-x), the same in every colour.
            let x = (open.x / dull.x).ln();
            assert!(close(open.z / dull.z, open.x / dull.x, 4.0 * HALF), "{open} became {dull}");
            if x < 0.5 {
                continue;
            }
            deep += 1;
            // 0.6 of what a colour that is paler by its root lets through meets no hair.
            for (channel, tint) in [0.9, 0.5, 0.2].into_iter().enumerate() {
                let saved = (clear[channel] / dull[channel]).ln();
                assert!((saved - 0.6 * tint * x).abs() < 4.0 * HALF, "channel {channel}: {saved} of {x}");
            }
        }
        assert!(deep > 200, "{deep} points lie in shadow");
    }
}

law! {
    fn light_from_all_around_is_shown_in_the_hairs_colour(on) {
        let (color, sky, ground) = (Vec3::new(0.8, 0.4, 0.1), Vec3::new(0.2, 0.5, 1.0), Vec3::new(1.0, 0.2, 0.6));
        let lit = |sky, ground| {
            let look = Look { environment: Environment { sky, ground }, ..plain(color) };
            of(&straight([Vec3::Y, Vec3::X], look, Vec::new()).strands(on), 0)[3]
        };
        for (sky, ground) in [(sky, ground), (Vec3::ONE, Vec3::ONE), (sky, Vec3::ZERO), (Vec3::ZERO, ground)] {
            let (found, expected) = (lit(sky, ground), color * 0.5 * (sky + ground));
            for channel in 0..3 {
                assert!(close(found[channel], expected[channel], HALF), "{found}, expected {expected}");
            }
        }
    }
}
