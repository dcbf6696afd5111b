//! Every grown style: on the scalp, outside the body, as long as it says, the same every time.

use std::sync::Arc;

use strandline_body::{Build, Eyes, Mannequin, SignedDistance};
use strandline_groom::{Groom, Style, StyleSettings};

fn grown(style: Style, seed: u64) -> Groom {
    StyleSettings { strand_count: 240, seed, ..StyleSettings::new(style) }.grow().unwrap()
}

#[test]
fn strands_leave_the_skin_and_stay_outside() {
    let mannequin = Mannequin::new();
    for style in Style::ALL {
        for seed in [1, 2] {
            let groom = grown(style, seed);
            assert_eq!(groom.strand_count(), 240);
            for strand in 0..groom.strand_count() {
                let points = groom.strand(strand);
                assert!(points.iter().all(|point| point.is_finite()));
                assert!(mannequin.distance(points[0]).abs() < 1e-5, "a root off the skin");
                for point in &points[1..] {
                    // A millimetre is asked for; in the crease behind the ear two surfaces push
                    // against each other, and half of it is left.
                    let distance = mannequin.distance(*point);
                    assert!(distance > 5e-4, "{style:?} strand {strand}: {distance} m");
                }
            }
        }
    }
}

#[test]
fn lengths_are_within_the_settings_and_turns_are_gentle() {
    for style in Style::ALL {
        let settings = StyleSettings::new(style);
        let groom = grown(style, 3);
        // Curls and waves lie on top of the combed length.
        let curl = std::f32::consts::TAU * settings.curl_radius / settings.curl_length;
        let wave = std::f32::consts::TAU * settings.wave_amplitude / settings.wave_length;
        let most = settings.length * (1.3 + curl * curl + wave * wave);
        for (strand, length) in groom.lengths().into_iter().enumerate() {
            assert!((0.004..most).contains(&length), "{style:?} strand {strand}: {length} m");
        }
        let mut sharp = 0;
        let mut joints = 0;
        for strand in 0..groom.strand_count() {
            for joint in groom.strand(strand).windows(3) {
                let turn = (joint[1] - joint[0]).angle_between(joint[2] - joint[1]);
                sharp += usize::from(turn > 1.3);
                joints += 1;
            }
        }
        // A kink where hair is pushed off an ear or a shoulder is rare.
        assert!(sharp * 200 < joints, "{style:?}: {sharp} of {joints} joints turn by more than 75 degrees");
    }
}

/// Tips of all strands \[m\].
fn tips(groom: &Groom) -> Vec<glam::Vec3> {
    (0..groom.strand_count()).map(|strand| *groom.strand(strand).last().unwrap()).collect()
}

#[test]
fn a_bob_ends_level() {
    let settings = StyleSettings::new(Style::Bob);
    let mut heights: Vec<f32> = tips(&grown(Style::Bob, 4)).iter().map(|tip| tip.y).collect();
    heights.sort_by(f32::total_cmp);
    let (low, high) = (heights[12], heights[228]);
    // Nine of ten within the layering, a step of 4 mm and the disorder of the tips.
    assert!(high - low < settings.layering + 0.004 + 2.0 * settings.noise, "{low} to {high}");
    assert!((low - settings.cut_height).abs() < 0.01);
}

#[test]
fn a_fringe_falls_over_the_forehead_to_its_length_and_leaves_other_hair_alone() {
    for style in [Style::Bob, Style::Ponytail] {
        let plain = StyleSettings { strand_count: 400, ..StyleSettings::new(style) };
        let with = StyleSettings { fringe: 0.05, ..plain };
        let [before, after] = [plain, with].map(|settings| settings.grow_hair(1600).unwrap());
        let tips = tips(&after);
        // Before the forehead, whose middle lies 8.5 cm before that of the head, above the eyes.
        let fringe: Vec<_> = tips.iter().filter(|tip| tip.z > 0.07 && tip.y > -0.01).collect();
        assert!(fringe.len() > 80, "{} {}", style.name(), fringe.len());
        // Cut 5 cm below the hairline at .056, over 6 mm, shorter by thinning of up to a seventh of 10 cm.
        let ends = |tip: &&&glam::Vec3| (-0.004..0.03).contains(&tip.y);
        assert!(fringe.iter().filter(ends).count() * 20 > fringe.len() * 19, "{}", style.name());
        let moved = (0..400).filter(|strand| before.strand(*strand) != after.strand(*strand)).count();
        assert!(moved < 80, "{}: {moved} of 400 guides", style.name());
        // Single short hairs of the hairline end there in any style.
        let of_before = self::tips(&before);
        let short = of_before.iter().filter(|tip| tip.z > 0.07 && tip.y > -0.01).count();
        assert!(short < 8, "{}: {short}", style.name());
    }
}

#[test]
fn hair_that_is_led_behind_the_ears_leaves_them_free() {
    for style in Style::ALL.into_iter().filter(|style| style.is_parted()) {
        let plain = StyleSettings { strand_count: 200, ..StyleSettings::new(style) };
        let led = StyleSettings { behind_ears: true, ..plain.clone() };
        // Beside an ear, whose rim reaches from 1 cm before to 2.4 cm behind the middle of the head.
        let is_before = |point: &glam::Vec3| {
            point.x.abs() > 0.07 && (-0.055..-0.010).contains(&point.y) && (-0.020..0.030).contains(&point.z)
        };
        let [before, after] = [plain, led].map(|settings| {
            let groom = settings.grow_hair(1600).unwrap();
            let hides = |strand: &usize| groom.strand(*strand).iter().any(is_before);
            (0..1600).filter(hides).count()
        });
        println!("{style:?}: {before} strands hide the ears, {after} when led behind");
        assert!(before > 160 && after * 12 < before, "{style:?}: {before}, {after}");
    }
}

#[test]
fn lashes_bend_away_from_the_eye_and_move_with_the_lids() {
    let settings = StyleSettings { strand_count: 390, ..StyleSettings::new(Style::Lashes) };
    let means = Eyes::ALL.map(|eyes| {
        let mannequin = Arc::new(Mannequin::of(Build::Medium, eyes));
        let (center, closed) = (mannequin.eye_center(), eyes == Eyes::Closed);
        let groom = settings.grow_on(mannequin.clone(), 390).unwrap();
        let (mut count, mut upper, mut sum) = (0, 0, 0.0);
        for strand in 0..390 {
            let points = groom.strand(strand);
            let (root, tip) = (points[0], points[6]);
            assert!(mannequin.distance(root).abs() < 1e-5, "{eyes:?}: a root off the skin");
            // Within a millimetre and a quarter of the margin of a lid, before the eye.
            let across = (root.x.abs() - center.x) / 0.014;
            let [up, down] = [true, false].map(|is_upper| mannequin.lid_margin(across, is_upper).y);
            let off = (root.y - up).abs().min((root.y - down).abs());
            assert!(off < 0.00125 && root.z > center.z, "{eyes:?}: {root}, {off} m off a lid");
            // The end of a lash of the upper lid rises, that of a lower one falls.
            let end = (tip - points[5]).normalize();
            let is_upper = end.y > 0.0;
            upper += usize::from(is_upper);
            assert!(closed || is_upper == (root.y > center.y), "{root} ends along {end}");
            assert!(end.y.abs() > 0.2 && tip.z > root.z + 0.001, "{root} ends along {end}");
            (count, sum) = (count + 1, sum + root.y);
        }
        assert_eq!((count, upper), (390, 240));
        sum / 390.0
    });
    assert!(means[1] < means[0] - 0.002, "closed lids are lower: {means:?}");
    // Few lashes stand on all of both lids.
    let few = StyleSettings { strand_count: 48, ..settings }.grow().unwrap();
    for side in [-1.0, 1.0] {
        for is_upper in [false, true] {
            let of_lid = (0..48)
                .map(|strand| few.strand(strand))
                .filter(|points| side * points[0].x > 0.0 && (points[6].y > points[5].y) == is_upper);
            let places: Vec<f32> = of_lid.map(|points| points[0].x.abs()).collect();
            let (least, most) =
                places.iter().fold((1.0_f32, 0.0_f32), |(low, high), x| (low.min(*x), high.max(*x)));
            assert!(most - least > 0.014, "{side} {is_upper}: from {least} to {most} m of 2.8 cm");
        }
    }
}

#[test]
fn beard_brows_and_lashes_grow_beside_hair_that_stays_as_it_is() {
    let mannequin = Mannequin::new();
    let plain = StyleSettings { strand_count: 400, ..StyleSettings::new(Style::Bob) };
    let with = StyleSettings { beard: true, brows: true, lashes: true, ..plain.clone() };
    let [alone, all] = [plain, with.clone()].map(|settings| settings.grow_hair(3200).unwrap());
    assert!((0..3200).all(|strand| all.strand(strand) == alone.strand(strand)));
    assert!(all.groups.as_ref().unwrap()[..3200] == alone.groups.unwrap());
    let (groups, guides) = (all.groups.as_ref().unwrap(), all.guide_flags.as_ref().unwrap());
    let roots: Vec<_> = all.roots().collect();
    // A quarter as many strands as of hair make a quarter as many hairs; brows and lashes are single strands, thinner.
    for (name, count, hairs, guide_count) in [
        ("", 3200, 100_000.0, 400),
        ("beard", 800, 25_000.0, 50),
        ("brows", 200, 1_500.0, 24),
        ("lashes", 390, 550.0, 25),
    ] {
        let named = |strand: &usize| all.group_names.get(&groups[*strand]).map_or("", String::as_str);
        let strands: Vec<usize> = (0..all.strand_count()).filter(|strand| named(strand) == name).collect();
        assert_eq!(strands.len(), count, "{name}");
        assert_eq!(strands.iter().filter(|strand| guides[**strand]).count(), guide_count, "{name}");
        let width: f32 = strands.iter().map(|strand| all.widths.at(*strand, 0)).sum();
        // Hair is thinner along its border.
        assert!((width / 8e-5 / 3200.0 * 100_000.0 / hairs - 1.0).abs() < 0.2, "{name}: {width} m");
        let eye = mannequin.eye_center();
        let is_there = |root: &glam::Vec3| {
            let mirrored = root.with_x(root.x.abs());
            match name {
                "beard" => (-0.14..-0.02).contains(&root.y) && root.z > -0.02,
                "brows" => (-0.01..0.02).contains(&root.y) && root.z > 0.04 && mirrored.x < 0.06,
                "lashes" => mirrored.distance(eye) < 0.018,
                _ => true,
            }
        };
        assert!(strands.iter().all(|strand| is_there(&roots[*strand])), "{name}");
        if !name.is_empty() {
            let right = strands.iter().filter(|strand| roots[**strand].x < 0.0).count();
            assert!(right * 3 > count && right * 3 < 2 * count, "{name}: {right} of {count} on the right");
        }
    }
    assert_eq!(all.strand_count(), 4590);
    assert_eq!(all.strand_count(), 3200 + with.strands_beside(3200));
    // A style is no part of itself.
    let bearded = StyleSettings { beard: true, brows: true, ..StyleSettings::new(Style::Beard) };
    let names = StyleSettings { strand_count: 100, ..bearded }.grow().unwrap().group_names;
    assert_eq!(names.into_values().collect::<Vec<_>>(), ["beard", "brows"]);
}

#[test]
fn a_ponytail_hangs_together_behind_the_head() {
    let tips = tips(&grown(Style::Ponytail, 4));
    let middle = tips.iter().sum::<glam::Vec3>() / tips.len() as f32;
    assert!(middle.z < -0.10 && middle.x.abs() < 0.01 && middle.y < -0.1, "{middle}");
    for tip in tips {
        // A tail is about 6 cm wide.
        assert!((tip - middle).with_y(0.0).length() < 0.05, "{tip} is off {middle}");
    }
}

#[test]
fn no_place_of_the_scalp_is_bald() {
    let probes = Mannequin::new().scalp().roots(600, 12);
    for style in Style::ALL.into_iter().filter(|style| !style.is_of_face()) {
        let groom = StyleSettings { strand_count: 1750, ..StyleSettings::new(style) }.grow().unwrap();
        for probe in &probes {
            let covered = groom.points.iter().any(|point| point.distance(probe.position) < 0.011);
            // 1,750 roots lie 6 mm apart; a bald patch would be wider than two of these gaps.
            assert!(covered, "{style:?}: nothing near {}", probe.position);
        }
    }
}

#[test]
fn hair_between_guides_leaves_the_guides_as_they_are() {
    for style in [Style::Wavy, Style::Curly, Style::Pixie, Style::Braid, Style::Beard] {
        let settings = StyleSettings { strand_count: 200, ..StyleSettings::new(style) };
        let (guides, all) = (settings.grow().unwrap(), settings.grow_hair(1600).unwrap());
        assert_eq!((guides.strand_count(), all.strand_count()), (200, 1600));
        assert!((0..200).all(|strand| guides.strand(strand) == all.strand(strand)), "{style:?}");
        assert_eq!(all.marked_guides(), (0..200).collect::<Vec<_>>());
        // Each has a root of its own on the skin, and keeps off it.
        let mannequin = Mannequin::new();
        for strand in 200..1600 {
            let points = all.strand(strand);
            assert!(mannequin.distance(points[0]).abs() < 2e-5, "{style:?}");
            assert!(points[1..].iter().all(|point| mannequin.distance(*point) > 2e-4), "{style:?} {strand}");
        }
    }
}

#[test]
fn hair_between_guides_has_the_same_bits_for_any_number_of_threads() {
    let with = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let settings = StyleSettings { strand_count: 100, seed, ..StyleSettings::new(Style::Curly) };
        pool.install(|| settings.grow_hair(800).unwrap())
    };
    assert_eq!(with(1, 5), with(4, 5));
    assert_ne!(with(1, 5), with(1, 6));
}

#[test]
fn hair_is_thinner_and_shorter_toward_the_hairline() {
    let settings = StyleSettings { strand_count: 500, ..StyleSettings::new(Style::Long) };
    let (all, scalp) = (settings.grow_hair(4000).unwrap(), Mannequin::new().scalp());
    let lengths = all.lengths();
    let mean = |wanted: fn(f32) -> bool, value: &dyn Fn(usize) -> f32| {
        let strands: Vec<usize> =
            (500..4000).filter(|strand| wanted(scalp.depth(all.strand(*strand)[0]))).collect();
        assert!(strands.len() > 50);
        strands.iter().map(|strand| value(*strand)).sum::<f32>() / strands.len() as f32
    };
    let width = |strand: usize| all.widths.at(strand, 0);
    let (near, far) = (|depth: f32| depth < 0.004, |depth: f32| depth > 0.015);
    assert!(mean(near, &width) < 0.85 * mean(far, &width));
    assert!(mean(near, &|strand| lengths[strand]) < 0.85 * mean(far, &|strand| lengths[strand]));
}

/// Mean distance \[m\] of the strands from the `first` on from the middle of their lock half-way to their tips: of half of
/// the locks less.
fn breadth(groom: &Groom, first: usize) -> f32 {
    let groups = groom.groups.as_ref().unwrap();
    let mut locks: std::collections::BTreeMap<u32, Vec<glam::Vec3>> = std::collections::BTreeMap::new();
    for (strand, lock) in groups.iter().enumerate().skip(first) {
        let points = groom.strand(strand);
        locks.entry(*lock).or_default().push(points[points.len() / 2]);
    }
    let breadths = locks.into_values().filter(|lock| lock.len() > 5).map(|lock| {
        let middle = lock.iter().sum::<glam::Vec3>() / lock.len() as f32;
        lock.iter().map(|point| point.distance(middle)).sum::<f32>() / lock.len() as f32
    });
    let mut breadths: Vec<f32> = breadths.collect();
    breadths.sort_by(f32::total_cmp);
    breadths[breadths.len() / 2]
}

#[test]
fn curls_of_a_lock_lie_together_by_the_middle_of_their_length() {
    // 0.97 and 1.38 where curls close as other hair does.
    for (style, most) in [(Style::Curly, 0.88), (Style::Coils, 1.12)] {
        let settings = StyleSettings { strand_count: 400, ..StyleSettings::new(style) };
        let (found, radius) = (breadth(&settings.grow_hair(3200).unwrap(), 400), settings.curl_radius);
        println!("{style:?}: {:.2} mm, curls of {:.2} mm", 1e3 * found, 1e3 * radius);
        assert!(found < most * radius, "{style:?}: {found}");
    }
}

#[test]
fn guides_of_a_lock_of_curls_lie_together_by_the_middle_of_their_length() {
    // 0.84 where they close as other guides do.
    let settings = StyleSettings { strand_count: 1600, ..StyleSettings::new(Style::Curly) };
    let found = breadth(&settings.grow().unwrap(), 0);
    println!("guides: {:.2} mm, curls of {:.2} mm", 1e3 * found, 1e3 * settings.curl_radius);
    assert!(found < 0.78 * settings.curl_radius, "{found}");
}

#[test]
fn hair_that_is_led_behind_the_ears_stays_behind_the_shoulders() {
    for style in [Style::Long, Style::Wavy] {
        let plain = StyleSettings { strand_count: 200, ..StyleSettings::new(style) };
        let led = StyleSettings { behind_ears: true, ..plain.clone() };
        let [before, after] = [plain, led].map(|settings| {
            let is_before = |tip: &&glam::Vec3| tip.y < -0.15 && tip.z > 0.02;
            let groom = settings.grow_hair(1600).unwrap();
            // Strands in thick layers went on outward where they passed the place behind the ear.
            let is_astray = |point: &&glam::Vec3| point.x.abs() > 0.15 && point.y > -0.08;
            assert_eq!(groom.points.iter().filter(is_astray).count(), 0, "{style:?}");
            tips(&groom).iter().filter(is_before).count()
        });
        println!("{style:?}: {before} tips before the shoulders, {after} when led behind the ears");
        assert!(before > 160 && after * 12 < before, "{style:?}: {before}, {after}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_for_any_number_of_threads() {
    let with = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| grown(Style::Curly, seed))
    };
    assert_eq!(with(1, 5), with(4, 5));
    assert_ne!(with(1, 5), with(1, 6));
}

#[test]
fn settings_outside_their_range_are_refused_by_name() {
    let long = StyleSettings::new(Style::Long);
    for (settings, name) in [
        (StyleSettings { strand_count: 0, ..long.clone() }, "style.strand_count is 0"),
        (StyleSettings { strand_count: 9_000_000, ..long.clone() }, "style.strand_count"),
        (StyleSettings { length: -1.0, ..long.clone() }, "style.length is -1"),
        (StyleSettings { noise: f32::NAN, ..long }, "style.noise is NaN"),
    ] {
        let text = settings.grow().unwrap_err().to_string();
        assert!(text.contains(name), "{text}");
    }
    assert!("mohawk".parse::<Style>().unwrap_err().to_string().contains("bob, long"));
}

#[test]
fn settings_that_a_style_makes_nothing_of_are_named() {
    let unused = |style: Style| {
        let all = StyleSettings { fringe: 0.05, behind_ears: true, beard: true, ..StyleSettings::new(style) };
        all.without_effect()
    };
    assert!(unused(Style::Bob).is_empty());
    assert_eq!(unused(Style::Ponytail), ["style.behind_ears"]);
    assert_eq!(unused(Style::Buzz), ["style.fringe", "style.behind_ears"]);
    assert_eq!(unused(Style::Beard), ["style.fringe", "style.behind_ears", "style.beard"]);
    assert!(StyleSettings::new(Style::Buzz).without_effect().is_empty());
}
