use glam::Quat;
use strandline_base::math;

use super::*;
use crate::{
    Prepared, Sources,
    body::Mannequin,
    groom::{Style, StyleSettings},
};

fn hair(style: Style) -> Groom {
    let mut groom = StyleSettings { strand_count: 400, ..StyleSettings::new(style) }.grow().unwrap();
    // Widths and groups would show more than a file of points has.
    (groom.widths, groom.groups) = (crate::groom::Widths::Constant(0.0), None);
    groom
}

fn found(groom: &Groom, scene: impl Fn(&mut Scene)) -> Option<Vec<bool>> {
    let mut own = Scene::default();
    own.groom.file = Some("hair".into());
    own.body.file = Some("head".into());
    scene(&mut own);
    on_skin(&own, groom, &Mannequin::new().mesh(), Defined::Nothing)
}

#[test]
fn strands_from_the_tip_are_found_by_the_skin_whatever_their_share() {
    for style in [Style::Bob, Style::Pixie, Style::Long] {
        let whole = hair(style);
        assert_eq!(found(&whole, |_| ()), None, "{style:?}");
        for every in [1, 2, 3, 20] {
            // Short hair lies on the skin with both ends: one strand alone shows little.
            if style == Style::Pixie && every > 1 {
                continue;
            }
            let turned: Vec<bool> = (0..400).map(|strand| strand % every == 0).collect();
            let mut mixed = whole.clone();
            mixed.turn_strands(&turned);
            let found = found(&mixed, |_| ()).unwrap_or_default();
            let missed = found.iter().zip(&turned).filter(|(found, turned)| found != turned).count();
            assert!(
                found.len() == 400 && missed <= 20,
                "{style:?}, one in {every}: {missed} of {}",
                found.len()
            );
        }
    }
}

#[test]
fn strands_from_the_tip_are_found_in_other_units_and_axes_and_where_a_scene_moves_them() {
    let mut turned = hair(Style::Bob);
    turned.turn_strands(&[true; 400]);
    let mut other = turned.clone();
    other.transform(100.0, math::rotation(Vec3::X, std::f32::consts::FRAC_PI_2), Vec3::ZERO);
    for groom in [&turned, &other] {
        let found = found(groom, |_| ()).unwrap_or_default();
        assert!(found.iter().filter(|turned| **turned).count() >= 396);
    }
    let mut moved = turned.clone();
    moved.transform(1.0, Quat::IDENTITY, Vec3::new(0.0, 0.0, -3.0));
    assert_eq!(found(&moved, |_| ()), None, "hair of no head here");
    let found = found(&moved, |scene| scene.groom.translation.z = 3.0).unwrap_or_default();
    assert!(found.iter().filter(|turned| **turned).count() >= 396);
}

#[test]
fn a_scene_says_what_is_turned_and_how_to_leave_it() {
    let (whole, mesh) = (hair(Style::Bob), Mannequin::new().mesh());
    let mut turned = whole.clone();
    turned.turn_strands(&[true; 400]);
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (Some("hair".into()), Some("head".into()));
    scene.body.spacing = 0.01;
    let load = |scene: &Scene, groom: &Groom| {
        let sources = Sources::default().with_groom("hair", groom.clone()).with_mesh("head", mesh.clone());
        Prepared::from_sources(scene, &sources).unwrap()
    };
    let (one, two) = (load(&scene, &whole), load(&scene, &turned));
    assert!(one.guides.positions() == two.guides.positions(), "the same hair");
    let is_told =
        |prepared: &Prepared| prepared.notes.iter().any(|note| note.contains("groom.root_end = \"first\""));
    assert!(!is_told(&one) && is_told(&two), "{:?}", two.notes);
    scene.groom.root_end = RootEnd::Last;
    let last = load(&scene, &turned);
    assert!(last.guides.positions() == one.guides.positions() && !is_told(&last));
    scene.groom.root_end = RootEnd::First;
    let first = load(&scene, &turned);
    assert!(first.guides.positions() != one.guides.positions() && !is_told(&first));
}

#[test]
fn tips_that_lie_on_a_shoulder_are_no_roots() {
    // Roots of reconstructed hair may float a little; some tips of it lie on the body far from them.
    let (mut groom, mesh) = (hair(Style::Bob), Mannequin::new().mesh());
    let mut lowest = mesh.positions.clone();
    lowest.sort_by(|one, two| one.y.total_cmp(&two.y));
    for (strand, tip) in lowest[..40].iter().enumerate() {
        let range = groom.range(10 * strand);
        let points = &mut groom.points[range];
        let (root, count) = (points[0] * 1.2, points.len() as f32 - 1.0);
        for (at, point) in points.iter_mut().enumerate() {
            *point = root.lerp(*tip, at as f32 / count);
        }
    }
    assert_eq!(found(&groom, |_| ()), None);
}
