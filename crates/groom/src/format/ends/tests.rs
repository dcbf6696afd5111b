use super::*;

/// Strands that grow out of half a ball and hang, tapering where asked.
fn groom(count: usize, tapers: bool) -> Groom {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..count {
        let (up, around) = (1.0 - (strand as f32 + 0.5) / count as f32, 2.399_963 * strand as f32);
        let flat = (1.0 - up * up).sqrt();
        let way = Vec3::new(flat * around.cos(), up, flat * around.sin());
        groom.push((0..12).map(|point| {
            let share = point as f32 / 11.0;
            way * (0.1 + 0.1 * share) + Vec3::NEG_Y * (0.15 * share * share)
        }));
    }
    if tapers {
        let width = |point: usize| 8e-5 * (1.0 - 0.8 * (point % 12) as f32 / 11.0);
        groom.widths = Widths::PerPoint((0..groom.points.len()).map(width).collect());
    }
    groom
}

#[test]
fn turned_strands_are_found_by_their_taper_all_and_some() {
    let whole = groom(300, true);
    assert_eq!(whole.from_tip(), None);
    for every in [1, 2, 3, 10] {
        let turned: Vec<bool> = (0..300).map(|strand| strand % every == 0).collect();
        let mut mixed = whole.clone();
        mixed.turn_strands(&turned);
        assert_ne!(mixed, whole);
        assert_eq!(mixed.from_tip().as_ref(), Some(&turned), "one in {every}");
        let mut kept = mixed.clone();
        assert_eq!(kept.rooted(RootEnd::First, Cleaning::All, "hint"), None);
        let named = kept.rooted(RootEnd::Auto, Cleaning::Named, "hint").unwrap();
        assert!(named.ends_with("are stored from tip to root (hint)") && kept == mixed, "{named}");
        let note = mixed.rooted(RootEnd::Auto, Cleaning::All, "hint").unwrap();
        let found = if every == 1 {
            "all strands".to_owned()
        } else {
            format!("{} of 300", 300_usize.div_ceil(every))
        };
        assert!(note.starts_with(&found) && note.contains("--root-end first"), "{note}");
        assert_eq!(mixed, whole);
    }
}

#[test]
fn few_turned_strands_are_found_by_the_roots_of_the_others_in_any_units() {
    for scale in [1.0, 100.0] {
        let mut whole = groom(600, false);
        whole.transform(scale, glam::Quat::IDENTITY, Vec3::Y);
        assert_eq!(whole.from_tip(), None);
        for every in [10, 20, 200] {
            let turned: Vec<bool> = (0..600).map(|strand| strand % every == 3).collect();
            let mut mixed = whole.clone();
            mixed.turn_strands(&turned);
            let found = mixed.from_tip().unwrap_or_default();
            assert_eq!(found.len(), 600, "one in {every} at {scale}");
            let named = mixed.clone().rooted(RootEnd::Auto, Cleaning::Named, "hint").unwrap();
            assert!(named.starts_with("at least "), "{named}");
            let wrong = found.iter().zip(&turned).filter(|(found, turned)| **found && !**turned).count();
            let missed = found.iter().zip(&turned).filter(|(found, turned)| !**found && **turned).count();
            // Strands that end as near to the roots as they begin show nothing.
            assert!(wrong == 0 && missed <= 600 / every / 4, "one in {every} at {scale}: {wrong}, {missed}");
        }
    }
}

#[test]
fn all_that_points_have_turns_with_them() {
    let mut groom = groom(1, true);
    groom.push([Vec3::ZERO, Vec3::Y, Vec3::Y * 2.0]);
    let points = groom.points.len();
    groom.widths = Widths::PerPoint((0..points).map(|point| point as f32).collect());
    groom.colors = Some((0..points).map(|point| [point as f32; 3]).collect());
    groom.transparencies = Some((0..points).map(|point| point as f32).collect());
    groom.masses = groom.transparencies.clone();
    groom.velocities = Some((0..points).map(|point| Vec3::splat(point as f32)).collect());
    groom.turn_strands(&[false, true]);
    assert_eq!(groom.strand(1), [Vec3::Y * 2.0, Vec3::Y, Vec3::ZERO]);
    let at = 12;
    assert_eq!(groom.widths.at(1, at), 14.0);
    assert_eq!(groom.colors.as_ref().unwrap()[at], [14.0; 3]);
    assert_eq!(
        (groom.transparencies.as_ref().unwrap()[at], groom.masses.as_ref().unwrap()[at]),
        (14.0, 14.0)
    );
    assert_eq!((groom.velocities.as_ref().unwrap()[at], groom.widths.at(0, 0)), (Vec3::splat(14.0), 0.0));
}

#[test]
fn strands_that_come_back_to_the_roots_are_left_alone() {
    // A knot: every strand ends among the roots of others.
    let mut knot = groom(300, false);
    for strand in 0..300 {
        let range = knot.range(strand);
        let end = knot.points[knot.range((strand + 1) % 300).start];
        knot.points[range.end - 1] = end * 1.01;
    }
    assert_eq!(knot.from_tip(), None);
    // A tail: the tips of all lie together.
    let mut tail = groom(300, false);
    for strand in 0..300 {
        let end = tail.range(strand).end - 1;
        tail.points[end] = Vec3::new(0.0, -0.3, -0.15) + 0.01 * tail.points[end];
    }
    assert_eq!(tail.from_tip(), None);
}
