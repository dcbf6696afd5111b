use std::f32::consts::PI;

use strandline_base::math;

use super::*;
use crate::Scene;
use crate::groom::{Style, StyleSettings};
use crate::prepare::guess;
use crate::prepare::placing::{Defined, Placings, place_mesh};

/// The built-in bust and a bob that grew on it, both elsewhere, in other units, turned by some angles.
fn pair(groom_scale: f32, groom_turn: f32, body_turn: f32) -> (Groom, Mesh) {
    let mut groom =
        StyleSettings { strand_count: 400, ..StyleSettings::new(Style::Ponytail) }.grow().unwrap();
    groom.transform(groom_scale, math::rotation(Vec3::Y, groom_turn), Vec3::new(0.0, 1.5, 0.3) * groom_scale);
    let mut mesh = crate::body::Mannequin::new().mesh();
    let turn = math::rotation(Vec3::Y, body_turn);
    place_mesh(&mut mesh, Placing { scale: 1.0, turn }, Vec3::ZERO, Vec3::Y * -0.4);
    (groom, mesh)
}

fn scene() -> Scene {
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (Some("a.hair".into()), Some("a.obj".into()));
    scene
}

fn placed(scene: &Scene, groom: &Groom, mesh: &Mesh) -> Placings {
    guess::of_files(scene, &[groom], Some(mesh), Defined::Nothing)
}

#[test]
fn hair_of_another_head_is_fitted_to_this_one() {
    for (unit, groom_turn, body_turn) in [(1.0, 0.0, 0.0), (100.0, PI, 0.0), (1.2, 0.0, PI), (0.8, PI, PI)] {
        let (mut groom, mut mesh) = pair(unit, groom_turn, body_turn);
        let found = placed(&scene(), &groom, &mesh);
        assert!(found.is_foreign, "{unit} {groom_turn} {body_turn}: {:?}", found.notes);
        place_mesh(&mut mesh, found.body, Vec3::ZERO, Vec3::ZERO);
        groom.transform(found.groom.scale, found.groom.turn, Vec3::ZERO);
        let note = fit(&mut groom, &mesh).unwrap();
        assert!(note.contains("another head") || note.contains("lies elsewhere"), "{note}");
        // Both look along +z, and roots lie where they grew.
        let bust = crate::body::Mannequin::new();
        let shift = mesh.bounds().unwrap().max - bust.mesh().bounds().unwrap().max;
        let grown =
            StyleSettings { strand_count: 400, ..StyleSettings::new(Style::Ponytail) }.grow().unwrap();
        let mut apart: Vec<f32> =
            groom.roots().zip(grown.roots()).map(|(one, two)| one.distance(two + shift)).collect();
        apart.sort_by(f32::total_cmp);
        assert!(apart[200] < 0.02, "{unit} {groom_turn} {body_turn}: half of them {} m", apart[200]);
    }
}

#[test]
fn an_afro_of_another_head_stands_up_from_any_axes() {
    let mut mesh = crate::body::Mannequin::new().mesh();
    place_mesh(&mut mesh, Placing { scale: 1.15, turn: Quat::IDENTITY }, Vec3::ZERO, Vec3::Y * -0.4);
    let grown = StyleSettings { strand_count: 400, ..StyleSettings::new(Style::Afro) }.grow().unwrap();
    for up in UPS {
        let mut groom = grown.clone();
        groom.transform(1.0, up.rotation().inverse(), Vec3::X);
        let found = placed(&scene(), &groom, &mesh);
        assert!(found.is_foreign, "{up:?}: {:?}", found.notes);
        let turn = found.groom.turn;
        // A refusal names the likeliest axes first.
        assert!(turn.angle_between(up.rotation()) < 0.01, "{up:?}: {:?} {:?}", found.notes, found.refusal);
    }
}

#[test]
fn hair_of_this_head_stays_and_so_does_what_a_scene_places() {
    let (mut groom, mesh) = pair(1.0, 0.0, 0.0);
    let mut moved = scene();
    moved.groom.translation = Vec3::X;
    assert!(!placed(&moved, &groom, &mesh).is_foreign);
    groom.transform(1.0, Quat::IDENTITY, Vec3::new(0.0, -1.9, -0.3));
    assert!(!placed(&scene(), &groom, &mesh).is_foreign);
    // A fur is not the hair of a head.
    let mut fur = Groom::empty(8e-5);
    for strand in 0..300 {
        let root = Vec3::new((0.37 * strand as f32).sin() * 0.2, 3.0, strand as f32 * 0.006);
        fur.push([root, root + Vec3::Y * 0.02]);
    }
    assert!(!placed(&scene(), &fur, &mesh).is_foreign);
}
