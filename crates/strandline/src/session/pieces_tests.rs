//! Bodies of several pieces in a cache: a run that resumes makes the same bits.

use glam::{Quat, Vec3, vec3};

use super::{engine::Engine, simulation::Simulation};
use crate::{
    Cache, OutSettings, Scene,
    body::{BodyFrame, Carrier, Collider, Pose, Shape},
    cache::{Leaving, Out},
    groom::{Groom, Guides},
    sim::{Model, Settings, State, StrandMethod},
    strands::tags::Tags,
};

const STRANDS: usize = 6;
/// Length of a frame \[s\]: no whole number of steps.
const FRAME: f64 = 0.021;

fn guides() -> Guides {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..STRANDS {
        let root = vec3(0.04 * strand as f32, 0.11, 0.0);
        groom.push((0..8).map(|point| root + vec3(0.012, 0.004, 0.002 * strand as f32) * point as f32));
    }
    Guides::resample(&groom, 8).unwrap()
}

/// A nod of the head, a piece that rises beside it, and every second root on that piece.
fn body(time: f64) -> BodyFrame {
    let time = time as f32;
    let head = Pose::rotation_about(Vec3::NEG_Y * 0.1, Quat::from_rotation_x(0.8 * time));
    let piece = Pose { translation: vec3(0.0, 0.2 * time, 0.1 * time), ..Pose::IDENTITY };
    let root = |strand: usize| if strand.is_multiple_of(2) { head } else { piece };
    BodyFrame::from(head).with_pieces([piece]).with_roots((0..STRANDS).map(root).collect::<Vec<_>>())
}

fn simulation(guides: &Guides, method: StrandMethod) -> Simulation {
    let ball = Shape::sphere(vec3(0.1, 0.05, 0.0), 0.05).unwrap();
    let ball = Collider::new(ball, Carrier::Piece(1), 0.3).unwrap();
    let mut settings = Settings::default();
    settings.strands.method = method;
    settings.volume.cells = [12; 3];
    let model = Model::new(guides, &settings, vec![ball]).unwrap();
    Simulation::new(Engine::new(None, model, false).unwrap(), settings.time_step)
}

fn run(simulation: &mut Simulation, frames: std::ops::Range<u32>) {
    for frame in frames {
        simulation
            .run_to(f64::from(frame + 1) * FRAME, &|time| (body(time), (Vec3::X * 0.3).into()))
            .unwrap();
    }
}

fn state(simulation: &mut Simulation) -> State {
    simulation.state().unwrap().clone()
}

#[test]
fn a_run_on_several_pieces_resumes_from_its_cache_to_the_same_bits() {
    let (folder, guides, mut scene) = (tempfile::tempdir().unwrap(), guides(), Scene::demo());
    scene.film.frames = 20;
    for method in StrandMethod::ALL {
        let path = folder.path().join(format!("{}.npz", method.name()));
        let mut whole = simulation(&guides, method);
        run(&mut whole, 0..9);
        let (snapshot, shown, steps) = (whole.snapshot(0).unwrap(), body(9.0 * FRAME), whole.engine.steps());
        let leaving = Leaving { guides: &guides, bound: None, tags: &Tags::default(), body: &shown };
        let mut out = Out::new(&OutSettings::new(&path), &scene, leaving).unwrap();
        let positions = state(&mut whole).positions;
        out.add(0, FRAME, (&positions, &shown, Vec3::ZERO), &[], Some(&snapshot)).unwrap();
        out.close(true, Some(&snapshot)).unwrap();
        let mut cache = Cache::open(&path).unwrap();
        assert_eq!(cache.read(0, &mut Vec::new()).unwrap(), shown);
        let found = cache.snapshot(STRANDS, 8).unwrap().unwrap();
        assert_eq!(found, snapshot);
        let mut resumed = simulation(&guides, method);
        resumed.restore(&found, steps).unwrap();
        [&mut whole, &mut resumed].into_iter().for_each(|simulation| run(simulation, 9..20));
        let [one, other] = [&mut whole, &mut resumed].map(state);
        assert_eq!((one.positions, one.velocities), (other.positions, other.velocities), "{method:?}");
        // The test can fail: without the pieces other hair follows.
        let mut rigid = found.clone();
        let head_alone = |body: &mut BodyFrame| *body = body.world_from_head().into();
        rigid.bodies.iter_mut().for_each(head_alone);
        head_alone(&mut rigid.state.body);
        let mut other = simulation(&guides, method);
        other.restore(&rigid, steps).unwrap();
        run(&mut other, 9..20);
        assert_ne!(state(&mut whole).positions, state(&mut other).positions, "{method:?}");
    }
}
