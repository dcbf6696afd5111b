//! Bodies of several pieces, and root frames of strands.

use glam::{Quat, Vec3, vec3};
use strandline_body::{BodyFrame, Carrier, Collider, Pose, Shape};
use strandline_checks::{On, Rig, law};
use strandline_groom::{LANES, RestShape};
use strandline_sim::{Drive, Model, Settings, State, StrandMethod, VolumeSettings};

use crate::strands::{ball_of_hair, bare, line, one_strand, skull};

const STRANDS: usize = 6;
const POINTS: usize = 8;
const LENGTH: f32 = 0.1;

fn without_volume(settings: Settings) -> Settings {
    Settings { volume: VolumeSettings { enabled: false, ..VolumeSettings::default() }, ..settings }
}

/// Short hair on a ball of 0.1 m.
fn model(settings: Settings, solids: Vec<Collider>) -> Model {
    Model::new(&ball_of_hair(STRANDS, POINTS, LENGTH), &without_volume(settings), solids).unwrap()
}

fn point(state: &State, strand: usize, point: usize) -> Vec3 {
    state.positions[strand / LANES * POINTS + point].get(strand % LANES)
}

fn turned(angle: f32) -> Pose {
    Pose::rotation_about(
        vec3(0.0, -0.1, 0.0),
        Quat::from_rotation_y(angle) * Quat::from_rotation_x(0.3 * angle),
    )
}

/// A head that rests and a piece that turns; every second strand rides the piece.
fn two_pieces(angle: f32) -> BodyFrame {
    let root = |strand: usize| if strand.is_multiple_of(2) { Pose::IDENTITY } else { turned(angle) };
    BodyFrame::REST.with_pieces([turned(angle)]).with_roots((0..STRANDS).map(root).collect::<Vec<_>>())
}

law! {
    fn hair_rides_the_root_frame_of_its_own(on) {
        for settings in [Settings::default(), Settings::constrained()] {
            let rods = settings.strands.method == StrandMethod::Rods;
            let mut rig = Rig::new(on, model(settings, Vec::new()));
            let rest = rig.state().clone();
            for step in 1..=20 {
                rig.step(&Drive::of(two_pieces(0.01 * step as f32)));
            }
            let end = two_pieces(0.2);
            let state = rig.state().clone();
            for strand in 0..STRANDS {
                for rooted in 0..2 {
                    let home = end.root(strand).point(point(&rest, strand, rooted));
                    let apart = point(&state, strand, rooted).distance(home);
                    assert!(apart < 1e-6, "root of strand {strand}: {apart} m");
                }
                let (still, mut moved) = (strand.is_multiple_of(2), 0.0_f32);
                for index in 0..POINTS {
                    let home = end.root(strand).point(point(&rest, strand, index));
                    moved = moved.max(point(&state, strand, index).distance(home));
                }
                // Rods rest in their style, to the bit; those that turn lag behind in the air by little: the
                // piece has carried their tips by 40 mm.
                let most = if still { 1e-7 } else { 8e-3 };
                assert!(!rods || moved <= most, "strand {strand} lies {moved} m from its style");
            }
        }
    }
}

/// Hair under a head that nods, after some steps: with the root frames of a rigid head, or none.
fn nodded(on: &On, settings: &Settings, own: bool) -> State {
    let mut rig = Rig::new(on, model(settings.clone(), vec![skull(0.3)]));
    for step in 1..=12 {
        let pose = turned(0.02 * step as f32);
        let body = BodyFrame::from(pose);
        let body = if own { body.with_roots([pose; STRANDS]) } else { body };
        rig.step(&Drive { wind: Vec3::X * 0.5, ..Drive::of(body) });
    }
    rig.state().clone()
}

law! {
    fn root_frames_of_a_rigid_head_change_nothing(on) {
        for settings in [Settings::default(), Settings::constrained()] {
            let [rigid, own] = [false, true].map(|own| nodded(on, &settings, own));
            let apart = (0..STRANDS * POINTS).map(|index| {
                let (strand, at) = (index / POINTS, index % POINTS);
                point(&rigid, strand, at).distance(point(&own, strand, at))
            });
            let apart = apart.fold(0.0, f32::max);
            // A GPU carries points by quaternions in place of matrices, which rounds.
            assert!(apart < 2e-5, "{apart} m");
            if let On::Cpu = on {
                assert_eq!(rigid.positions, own.positions);
                assert_eq!(rigid.velocities, own.velocities);
            }
        }
    }
}

law! {
    fn a_bad_strand_goes_back_to_its_own_root_frame(on) {
        for settings in [Settings::default(), bare(1.0 / 60.0, 20)] {
            let method = settings.strands.method;
            let mut rig = Rig::new(on, model(settings, Vec::new()));
            let rest = rig.state().clone();
            rig.steps(&vec![Drive { wind: Vec3::X, ..Drive::of(two_pieces(0.3)) }; 5]);
            rig.change(|state| state.velocities[5].set(1, Vec3::NAN));
            let report = rig.step(&Drive::of(two_pieces(0.3)));
            assert!(report.non_finite > 0, "{method:?}");
            for index in 0..POINTS {
                let home = turned(0.3).point(point(&rest, 1, index));
                let apart = point(rig.state(), 1, index).distance(home);
                assert!(apart < 1e-6, "{apart} m");
            }
        }
    }
}

/// Mean velocity \[m/s\] along a log of a loose strand that lies on it, after half a second in which the carrier of the
/// log moves along at 0.2 m/s.
fn carried_along(on: &On, carrier: Carrier, friction: f32) -> f32 {
    let log = Shape::Capsule { start: Vec3::NEG_Z, end: Vec3::Z, radius: 0.05 };
    let log = Collider::new(log, carrier, friction).unwrap();
    let hair = one_strand(&line(vec3(-0.05, 0.0512, 0.0), vec3(0.05, 0.0512, 0.0), 10));
    let settings = Settings { collision_margin: 1e-3, ..bare(1.0 / 60.0, 20) };
    let rest = RestShape::new(&hair, 6.5e-6);
    let mut rig = Rig::new(on, Model::with_rest(&hair, rest, |_, _| false, &settings, vec![log]).unwrap());
    rig.steps(&vec![Drive::default(); 20]);
    let moved = |step: usize| Pose { translation: Vec3::Z * (0.2 / 60.0 * step as f32), ..Pose::IDENTITY };
    let drive = |step| Drive::of(BodyFrame::REST.with_pieces([Pose::IDENTITY, moved(step)]));
    rig.steps(&(1..=30).map(drive).collect::<Vec<_>>());
    let velocities = &rig.state().velocities;
    velocities.iter().map(|lanes| lanes.get(0).z).sum::<f32>() / velocities.len() as f32
}

law! {
    long fn a_piece_takes_along_what_rubs_on_it(on) {
        let along = carried_along(on, Carrier::Piece(2), 0.8);
        assert!((along - 0.2).abs() < 0.02, "{along} m/s");
        for (carrier, friction) in [(Carrier::Piece(2), 0.0), (Carrier::Piece(1), 0.8), (Carrier::World, 0.8)] {
            let along = carried_along(on, carrier, friction);
            // A strand that slides off sideways drifts along a little.
            assert!(along.abs() < 6e-3, "{along} m/s on {carrier:?} with friction {friction}");
        }
    }
}

law! {
    fn a_solid_moves_with_its_piece(on) {
        for settings in [bare(1.0 / 60.0, 20), Settings::default()] {
            let hair = one_strand(&line(vec3(-0.1, 0.055, 0.0), vec3(0.1, 0.055, 0.0), 16));
            let ball = Shape::sphere(Vec3::ZERO, 0.05).unwrap();
            let ball = Collider::new(ball, Carrier::Piece(1), 0.3).unwrap();
            let model = Model::new(&hair, &without_volume(settings), vec![ball]).unwrap();
            let mut rig = Rig::new(on, model);
            let risen = |step: usize| Pose { translation: Vec3::Y * (0.002 * step as f32), ..Pose::IDENTITY };
            let drive = |step| Drive::of(BodyFrame::REST.with_pieces([risen(step)]));
            let reports = rig.steps(&(1..=20).map(drive).collect::<Vec<_>>());
            let middle = risen(20).translation;
            let near = rig.state().positions.iter().map(|lanes| lanes.get(0).distance(middle)).fold(1.0, f32::min);
            assert!(near > 0.05 - 5e-4, "a point lies {near} m from the middle of a ball of 0.05 m");
            // The strand lies on it: the ball has lifted it.
            assert!(near < 0.056, "{near} m");
            let deepest = reports.iter().map(|report| report.penetration_max).fold(0.0, f32::max);
            assert!(deepest < 5e-4, "{deepest} m");
        }
    }
}
