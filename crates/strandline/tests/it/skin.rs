//! Hair on a skin that moves by itself.

#![allow(clippy::disallowed_methods)] // compared values may be rounded

use glam::{Quat, Vec3, vec3};
use strandline::{
    Backend, Groom, Hair, Mesh, Pose, Prepared, Scene, Settings, Sources,
    format::{Scale, Up},
    low_level::{
        body::{BodyFrame, SkinRoots},
        groom::Guides,
        sim::{CpuRunner, Drive, Model},
    },
    scene::MotionName,
};

/// A sheet 20 cm wide in the plane y = 0, facing up, and hair that stands on it.
pub fn sheet() -> (Mesh, Groom, Guides) {
    let positions = (0..21 * 21).map(|index| vec3((index % 21) as f32, 0.0, (index / 21) as f32) * 0.01);
    let positions = positions.map(|place| place - vec3(0.1, 0.0, 0.1)).collect();
    let cell = |index: u32| {
        let corner = index / 20 * 21 + index % 20;
        [[corner, corner + 21, corner + 1], [corner + 1, corner + 21, corner + 22]]
    };
    let mesh = Mesh::new(positions, (0..400).flat_map(cell).collect()).unwrap();
    let mut groom = Groom::empty(8e-5);
    for strand in 0..24 {
        let root = vec3(0.006 * strand as f32 - 0.07, 0.0, 0.003 * strand as f32 - 0.03);
        groom.push((0..8).map(|point| root + Vec3::Y * 0.01 * point as f32));
    }
    let guides = Guides::resample(&groom, 8).unwrap();
    (mesh, groom, guides)
}

/// The hair without weight on the sheet, which it does not hit.
pub fn scene() -> Scene {
    let mut scene = Scene::default();
    scene.simulation.gravity = Vec3::ZERO;
    (scene.groom.file, scene.body.file) = (Some("hair".into()), Some("sheet".into()));
    (scene.groom.scale, scene.body.scale) = (Scale::Factor(1.0), Scale::Factor(1.0));
    (scene.groom.up, scene.body.up) = (Up::Y, Up::Y);
    (scene.groom.points_per_strand, scene.body.solid) = (8, false);
    scene.motion.name = MotionName::Still;
    scene
}

/// Hair and sheet of [`scene`].
pub fn sources(mesh: &Mesh, groom: &Groom) -> Sources {
    Sources::default().with_groom("hair", groom.clone()).with_mesh("sheet", mesh.clone())
}

fn hair(mesh: &Mesh, groom: &Groom) -> Hair {
    let prepared = Prepared::from_sources(&scene(), &sources(mesh, groom)).unwrap();
    Hair::from_prepared(prepared, Backend::Cpu).unwrap()
}

/// The sheet bent about a cylinder through an angle at its edge.
pub fn bent(place: Vec3, angle: f32) -> Vec3 {
    if angle == 0.0 {
        return place;
    }
    let radius = 0.1 / angle;
    let turn = Quat::from_rotation_z(-place.x / radius);
    let around = turn * (Vec3::Y * (radius + place.y)) - Vec3::Y * radius;
    vec3(around.x, around.y, place.z)
}

fn body(mesh: &Mesh, angle: f32) -> BodyFrame {
    BodyFrame::REST.with_skin(mesh.positions.iter().map(|place| bent(*place, angle)).collect::<Vec<_>>())
}

#[test]
fn roots_ride_a_bending_skin_and_hair_rests_on_it_once_it_stands() {
    let (mesh, groom, guides) = sheet();
    let mut hair = hair(&mesh, &groom);
    let clamps = |hair: &mut Hair, angle: f32| {
        let points = hair.points().unwrap();
        for strand in 0..24 {
            for point in 0..2 {
                let exact = bent(guides.position(strand, point), angle);
                let apart = points[8 * strand + point].distance(exact);
                assert!(apart < 2e-4, "point {point} of strand {strand} lies {apart} m off at {angle}");
            }
        }
    };
    for frame in 1..=10 {
        hair.step(1.0 / 60.0, body(&mesh, 0.05 * frame as f32)).unwrap();
        clamps(&mut hair, 0.05 * frame as f32);
    }
    for _ in 0..240 {
        hair.step(1.0 / 60.0, body(&mesh, 0.5)).unwrap();
    }
    let roots = hair.state().unwrap().body.clone();
    for (index, point) in hair.points().unwrap().iter().enumerate() {
        let home = roots.root(index / 8).point(guides.position(index / 8, index % 8));
        assert!(point.distance(home) < 1e-3, "point {index} lies {} m from rest", point.distance(home));
    }
}

#[test]
fn hair_at_rest_on_a_posed_skin_stays() {
    let (mesh, _, guides) = sheet();
    let roots: Vec<Vec3> = (0..24).map(|strand| guides.position(strand, 0)).collect();
    let posed = SkinRoots::new(&mesh, &roots).placed(body(&mesh, 0.5), &BodyFrame::REST);
    let model =
        Model::new(&guides, &Settings { gravity: Vec3::ZERO, ..Settings::default() }, Vec::new()).unwrap();
    let mut state = model.rest_state(posed.clone());
    let rest = state.positions.clone();
    let mut runner = CpuRunner::from(model);
    for _ in 0..60 {
        runner.step(&mut state, &Drive::of(posed.clone()));
    }
    for (now, rest) in state.positions.iter().zip(&rest) {
        let moved = (0..8).map(|lane| now.get(lane).distance(rest.get(lane))).fold(0.0, f32::max);
        assert!(moved < 1e-6, "hair on a skin that stands moved by {moved} m");
    }
}

#[test]
fn hair_is_carried_over_a_jump_and_it_is_noted() {
    let (mesh, groom, guides) = sheet();
    let there = Pose { rotation: Quat::from_rotation_x(3.0), translation: vec3(2.0, 0.5, 0.0) };
    let aside = Pose { translation: Vec3::X * 0.01, ..Pose::IDENTITY };
    for (body, jumps) in [
        (BodyFrame::from(there), true),
        (BodyFrame::from(aside).after_jump(), true),
        (BodyFrame::from(aside), false),
        (Pose { rotation: Quat::from_rotation_y(0.3), ..aside }.into(), false),
    ] {
        let mut hair = hair(&mesh, &groom);
        let reports = hair.step(1.0 / 60.0, body.clone()).unwrap();
        let notes = hair.take_notes();
        assert_eq!(notes.iter().any(|note| note.contains("the body jumps")), jumps, "{notes:?}");
        if !jumps {
            continue;
        }
        assert!(reports.iter().all(|report| report.speed_max < 0.1), "{reports:?}");
        for (index, point) in hair.points().unwrap().iter().enumerate() {
            let home = body.root(index / 8).point(guides.position(index / 8, index % 8));
            assert!(point.distance(home) < 1e-5, "point {index} lies {} m off", point.distance(home));
        }
    }
}
