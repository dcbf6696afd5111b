use glam::{Quat, Vec3};
use strandline_base::math;

use super::*;
use crate::prepare::{placing::Defined, shown::Shown};
use crate::{
    Prepared, Sources,
    body::Mannequin,
    groom::{Style, StyleSettings, format::Up},
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
    let mesh = Mannequin::new().mesh();
    let shown = Shown::new(&own, &mesh, Defined::Nothing);
    on_skin(&own, groom, false, Body { mesh: &mesh, shown: &shown }, &NearestSurface::new(&mesh))
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
    assert_eq!(found(&moved, |_| ()), Some(vec![true; 400]), "hair that is fitted to this head");
    moved.turn_strands(&[true; 400]);
    assert_eq!(found(&moved, |_| ()), None);
    moved.turn_strands(&[true; 400]);
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

#[test]
fn strands_from_the_tip_in_other_axes_and_units_at_once_come_to_the_head_as_the_others() {
    let mesh = Mannequin::new().mesh();
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (Some("hair".into()), Some("head".into()));
    scene.body.solid = false;
    let load = |groom: Groom| {
        let sources = Sources::default().with_groom("hair", groom).with_mesh("head", mesh.clone());
        Prepared::from_sources(&scene, &sources).unwrap()
    };
    let back = math::rotation(Vec3::Y, std::f32::consts::PI);
    for style in [Style::Bob, Style::Long] {
        let whole = load(hair(style));
        for (scale, turn) in [
            (0.01, Up::Z.rotation()),
            (0.01, back * Up::Z.rotation()),
            (0.001, Up::MinusY.rotation()),
            (0.01, back),
            (0.0254, Up::X.rotation()),
        ] {
            let mut groom = hair(style);
            groom.turn_strands(&[true; 400]);
            groom.transform(1.0 / scale, turn.inverse(), Vec3::ZERO);
            let found = load(groom);
            let strands = 0..whole.guides.strand_count();
            let apart = |point: usize| {
                let far = |strand| {
                    whole.guides.position(strand, point).distance(found.guides.position(strand, point))
                };
                strands.clone().map(far).fold(0.0, f32::max)
            };
            let last = whole.guides.points_per_strand() - 1;
            assert!(
                apart(0) < 1e-3 && apart(last) < 1e-3,
                "{style:?} {scale} {turn}: roots {}, tips {} m off; {:?}",
                apart(0),
                apart(last),
                found.notes
            );
        }
    }
}
