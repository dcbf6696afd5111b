//! Hair that begins where other hair was left.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use strandline::{
    Backend, Error, Event, Hair, OutSettings, Picture, Player, Pose, Scene,
    low_level::{
        groom::{LANES, Vec3Lanes},
        sim::State,
    },
    settings::StrandMethod,
};

const STRANDS: usize = 60;
/// Length of a step \[s\].
const STEP: f64 = 1.0 / 60.0;

fn scene(backend: Backend) -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = STRANDS;
    scene.groom.bound = Some(0);
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    (scene.devices.simulation, scene.devices.pictures) = (backend, Backend::Cpu);
    scene.groom.length = 0.8;
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    (scene.picture.width, scene.picture.height) = (64, 48);
    scene
}

fn hair(scene: &Scene) -> Result<Hair, Error> {
    Hair::open(scene)
}

/// The largest difference between the strands of two sets of lanes.
fn apart(a: &[Vec3Lanes], b: &[Vec3Lanes]) -> f32 {
    let points = a.len() / STRANDS.div_ceil(LANES);
    let lanes = |index: usize| (0..LANES).filter(move |lane| index / points * LANES + lane < STRANDS);
    let each = a.iter().zip(b).enumerate();
    each.flat_map(|(index, (a, b))| lanes(index).map(move |lane| (a.get(lane) - b.get(lane)).length()))
        .fold(0.0, f32::max)
}

fn first_picture(scene: &Scene) -> Picture {
    let mut player = Player::new(scene, scene.devices, true).unwrap();
    let drawn = |event| match event {
        Ok(Event::Drawn { picture, .. }) => Some(picture),
        _ => None,
    };
    player.find_map(drawn).unwrap()
}

fn goes_on(backend: Backend, method: StrandMethod) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("swing.npz");
    let mut begun = scene(backend);
    begun.simulation.strands.method = method;
    let mut left = match hair(&begun) {
        Ok(hair) => hair,
        Err(error) => {
            assert!(backend != Backend::Cpu && !required(), "{error}");
            #[allow(clippy::print_stderr)] // it tells what is not tested
            return eprintln!("not tested on {backend}: {error}");
        }
    };
    let turned = Pose { rotation: glam::Quat::from_rotation_y(0.4), ..Pose::IDENTITY };
    for _ in 0..12 {
        left.step(STEP, turned).unwrap();
    }
    // Just a step each: what is shown is the last state.
    left.save_pose(&file).unwrap();
    let mut posed = begun;
    posed.groom.pose = Some(file.clone());
    posed.motion.pivot = Some(glam::Vec3::ZERO);
    posed.motion.rotation.y = 0.4_f32.to_degrees();
    posed.motion.name = strandline::scene::MotionName::Still;
    let mut again = hair(&posed).unwrap();
    let (left, begun) = (left.state().unwrap().clone(), again.state().unwrap().clone());
    assert_eq!(apart(&left.positions, &begun.positions), 0.0);
    // Velocities are those of the last state.
    let there = &left.velocities;
    assert_eq!(apart(there, &begun.velocities), 0.0);
    // Corrections of a length pass, or sections of rods.
    let kept_by = |state: &State| match method {
        StrandMethod::Constrain => state.corrections.clone(),
        StrandMethod::Rods => state.sections.clone(),
    };
    let (added, kept) = (kept_by(&left), kept_by(&begun));
    assert_eq!(apart(&added, &kept), 0.0);
    assert!(apart(&added, &vec![Vec3Lanes::default(); added.len()]) > 1e-3, "nothing was kept");
    if method == StrandMethod::Rods {
        let spins = |state: &State| state.spins.iter().map(|lanes| lanes.0[0]).collect::<Vec<f32>>();
        assert_eq!(spins(&left), spins(&begun));
        assert!(spins(&left).iter().any(|spin| spin.abs() > 1e-3), "nothing spun");
    }
    let fast = apart(there, &vec![Vec3Lanes::default(); there.len()]);
    assert!(fast > 0.1, "nothing moved: {fast} m/s");
    assert_eq!(begun.length_scale(7), 0.8);
    // It continues without a jerk: gravity and the volume change no velocity by 3 m/s in a step.
    let before = again.state().unwrap().positions.clone();
    again.step(STEP, turned).unwrap();
    let moved = apart(&before, &again.state().unwrap().positions);
    assert!(moved > 0.1 / 60.0 && moved < (fast + 3.0) / 60.0, "{moved} m at {fast} m/s");
    // A film begins with it, whatever time settling may take.
    posed.film.settle = 0.2;
    let shown = first_picture(&posed);
    let mut fresh = hair(&posed).unwrap();
    let camera = strandline::Prepared::new(&posed).unwrap().camera(64.0 / 48.0);
    assert_eq!(shown, fresh.picture(&camera, &posed.look).unwrap());
    posed.begin_at_rest();
    assert!(first_picture(&posed) != shown);
}

fn required() -> bool {
    std::env::var_os("STRANDLINE_REQUIRE_GPU").is_some_and(|value| value == "1")
}

#[test]
fn hair_goes_on_where_it_was_left_on_the_cpu() {
    for method in StrandMethod::ALL {
        goes_on(Backend::Cpu, method);
    }
}

#[test]
fn hair_goes_on_where_it_was_left_on_a_gpu() {
    for method in StrandMethod::ALL {
        goes_on(Backend::Gpu(None), method);
    }
}

#[test]
fn a_pose_of_other_hair_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("swing.npz");
    hair(&scene(Backend::Cpu)).unwrap().save_pose(&file).unwrap();
    let mut other = scene(Backend::Cpu);
    other.groom.pose = Some(file);
    other.style.strand_count = STRANDS + 1;
    let refused = hair(&other).err().unwrap().to_string();
    assert!(
        refused.contains("60 strands of 16 points, but the scene's hair has 61 strands")
            && refused.contains("swing.npz"),
        "{refused}"
    );
    other.groom.pose = Some(folder.path().join("none"));
    let refused = hair(&other).err().unwrap().to_string();
    assert!(refused.starts_with("cannot read the pose of the hair"), "{refused}");
    let nowhere = folder.path().join("nowhere/a.npz");
    let refused = hair(&scene(Backend::Cpu)).unwrap().save_pose(&nowhere).unwrap_err().to_string();
    assert!(refused.starts_with("cannot save the hair"), "{refused}");
}

#[test]
fn hair_goes_on_from_the_end_of_a_moving_cache() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("swing.npz");
    let mut begun = scene(Backend::Cpu);
    begun.film.frames = 4;
    let mut left = hair(&begun).unwrap();
    let mut out = left.begin_file(&OutSettings::new(&file)).unwrap();
    for frame in 0..4 {
        left.play(frame).unwrap();
        left.write(&mut out).unwrap();
    }
    left.end_file(out).unwrap();
    begun.groom.pose = Some(file);
    let mut again = hair(&begun).unwrap();
    let (left, begun) = (left.state().unwrap(), again.state().unwrap());
    assert_eq!(apart(&left.positions, &begun.positions), 0.0);
    assert_eq!(apart(&left.velocities, &begun.velocities), 0.0);
    assert!(apart(&left.velocities, &vec![Vec3Lanes::default(); left.velocities.len()]) > 0.01);
    assert_eq!(left.body, begun.body);
}
