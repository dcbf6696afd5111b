//! Hair beside a far head is simulated from an origin there.

use glam::{Quat, Vec3};

use super::{Inline, Session, film_timing::FilmTiming};
use crate::{
    Backend, Prepared, Scene,
    body::{BodyFrame, Pose},
    groom::Vec3Lanes,
    scene::{CarrierName, ColliderSection, KeyframeSection, MotionName, SphereSection},
};

/// Distance \[m\] by which points may differ about the head: a twentieth of a step of single precision at 10 km. Nothing of
/// the scene is rounded there, so that they are the same bits; cells of the volume and rounding lie otherwise about a head
/// that is not a whole number of metres away.
const APART: f32 = 5e-5;
/// A place in whole metres.
const FAR: Vec3 = Vec3::new(-7000.0, 512.0, 7071.0);

/// Short hair on a head that turns beside a ball of the world, all about a place.
fn session(place: Vec3) -> Session<Inline> {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.body.spacing) = (16, 0.03);
    scene.simulation.volume.cells = [8; 3];
    scene.motion.name = MotionName::Keyframes;
    scene.motion.pivot = Some(Vec3::ZERO);
    let key = |time: f64, x: f32, degrees: f32| KeyframeSection {
        time,
        translation: place + Vec3::X * x,
        rotation: Vec3::Y * degrees,
        ..KeyframeSection::default()
    };
    scene.motion.keyframes = vec![key(0.0, 0.0, 10.0), key(0.25, 0.125, 50.0)];
    let ball = SphereSection {
        center: place + Vec3::new(0.25, 1.5, 0.0),
        radius: 0.125,
        carrier: CarrierName::World,
        ..SphereSection::default()
    };
    scene.colliders = vec![ColliderSection::Sphere(ball)];
    scene.film.settle = 0.0;
    Session::open(Prepared::new(&scene).unwrap(), Backend::Cpu.into()).unwrap()
}

/// The largest distance \[m\] of points about one place from those about another.
fn apart(one: &[Vec3Lanes], other: &[Vec3Lanes], between: Vec3) -> f32 {
    let pairs = one.iter().zip(other).flat_map(|(one, other)| {
        (0..crate::groom::LANES).map(|lane| one.get(lane).distance(other.get(lane) - between))
    });
    pairs.fold(0.0, f32::max)
}

fn positions(session: &mut Session<Inline>) -> Vec<Vec3Lanes> {
    session.simulation_mut().state().unwrap().positions.clone()
}

#[test]
fn the_film_of_a_far_head_is_that_of_one_beside_the_origin() {
    let [mut near, mut far] = [Vec3::ZERO, FAR].map(session);
    let origin = far.head_from_origin().origin();
    assert!(near.head_from_origin().origin() == Vec3::ZERO && origin == FAR, "{origin}");
    let between = FAR - origin;
    for frame in 0..8 {
        for session in [&mut near, &mut far] {
            let here = session.simulation().end().world_from_head();
            let timing = FilmTiming::new(session.scene(), session.head_from_origin().clone(), here);
            timing.run(session.simulation_mut(), frame).unwrap();
        }
        let off = apart(&positions(&mut near), &positions(&mut far), between);
        assert!(off < APART, "{off} m in frame {frame}");
    }
    let moved = apart(&positions(&mut near), &positions(&mut session(Vec3::ZERO)), Vec3::ZERO);
    assert!(moved > 0.02, "the hair moves by {moved} m alone");
    // A run goes on from its snapshot to the same bits.
    let snapshot = far.snapshot(7).unwrap();
    let mut again = session(FAR);
    let steps = far.simulation_mut().engine.steps();
    again.simulation_mut().restore(&snapshot, steps).unwrap();
    assert_eq!(again.simulation_mut().snapshot(7).unwrap(), snapshot);
}

#[test]
fn pieces_and_a_skin_that_moves_are_carried_as_exactly() {
    let [mut near, mut far] = [Vec3::ZERO, FAR].map(session);
    let between = FAR - far.head_from_origin().origin();
    let skin = near.view().painter.mesh().unwrap().positions.clone();
    for step in 1..=12 {
        let share = step as f32 / 12.0;
        let grown: Vec<Vec3> = skin.iter().map(|place| *place + Vec3::Y * (0.01 * share * place.y)).collect();
        for (session, place) in [(&mut near, Vec3::ZERO), (&mut far, between)] {
            let pose = Pose { rotation: Quat::from_rotation_y(0.2 * share), translation: place };
            let piece = Pose { translation: place + Vec3::X * 0.0625 * share, ..pose };
            let body = BodyFrame::from(pose).with_pieces([piece]).with_skin(grown.clone());
            let simulation = session.simulation_mut();
            let start = simulation.end().clone();
            simulation
                .step_along(1.0 / 60.0, &|share| (start.toward(&body, share), Vec3::ZERO.into()))
                .unwrap();
        }
        let off = apart(&positions(&mut near), &positions(&mut far), between);
        assert!(off < APART, "{off} m in step {step}");
    }
}
