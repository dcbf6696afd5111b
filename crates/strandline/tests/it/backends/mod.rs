//! Hair on a GPU as the façade has it.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

mod lost;

use strandline::{
    Backend, Devices, Event, Hair, Picture, Player, Pose, Prepared, Scene,
    device::Gpu,
    look::Preset,
    low_level::{
        groom::{LANES, Vec3Lanes},
        sim::State,
    },
    scene::MotionName,
};

/// Any adapter, with a device of its own: these tests spoil it.
#[allow(clippy::print_stderr)] // it tells what is not tested
fn gpu() -> Option<Gpu> {
    match Gpu::any() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
            eprintln!("not tested on a GPU: {error}");
            None
        }
    }
}

fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.groom.bound = Some(0);
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.motion.name = MotionName::Shake;
    scene.film.frames = 4;
    scene.film.settle = 0.1;
    // A few thick strands.
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    (scene.picture.width, scene.picture.height) = (64, 48);
    // Light that is scattered many times takes a software adapter long.
    scene.look.dress(Preset::Thesis);
    scene
}

/// The scene without its body, which hair still hits.
fn prepared() -> Prepared {
    let mut scene = scene();
    scene.body.visible = false;
    Prepared::new(&scene).unwrap()
}

fn hair(gpu: &Gpu) -> Hair {
    let mut hair = Hair::with_device(prepared(), gpu).unwrap();
    // Two lights with shadow and one without, each shining from one place.
    hair.set_lights(scene().look.lights(glam::Vec3::ZERO)).unwrap();
    hair
}

fn turned(share: f32) -> Pose {
    Pose { rotation: glam::Quat::from_rotation_y(0.5 * share), ..Pose::IDENTITY }
}

/// The largest distance \[m\] between the 60 strands of two sets of positions.
fn apart(a: &[Vec3Lanes], b: &[Vec3Lanes]) -> f32 {
    let points = a.len() / 60_usize.div_ceil(LANES);
    let mut largest = 0.0_f32;
    for (index, (a, b)) in a.iter().zip(b).enumerate() {
        for lane in (0..LANES).filter(|lane| index / points * LANES + lane < 60) {
            largest = largest.max((a.get(lane) - b.get(lane)).length());
        }
    }
    largest
}

#[test]
fn a_scene_moves_alike_on_both_backends() {
    let Some(_) = gpu() else { return };
    let play = |backend| -> State {
        let mut player = Player::new(&scene(), backend, false).unwrap();
        for event in player.by_ref() {
            if let Event::Stepped(report) = event.unwrap() {
                assert_eq!(report.non_finite, 0);
                assert!(!report.seconds.is_empty());
            }
        }
        player.state().unwrap()
    };
    let (cpu, gpu) = (play(Backend::Cpu), play(Backend::Gpu(None)));
    assert_eq!(cpu.time, gpu.time);
    let moved = apart(&cpu.positions, &cpu.previous_positions);
    assert!(moved > 1e-4, "nothing moved: {moved}");
    // Fourteen steps; contact planes of another age under hair that lies on the head.
    let distance = apart(&cpu.positions, &gpu.positions);
    assert!(distance < 1e-2, "{distance}");
}

#[test]
fn points_cross_to_a_gpu_that_only_draws_and_stay_on_one_that_simulates() {
    let Some(_) = gpu() else { return };
    let mut scene = scene();
    scene.style.strand_count = 600;
    let points = 600 * u64::from(scene.groom.points_per_strand) * 12;
    let a_frame = |simulation| {
        let devices = Devices { simulation, pictures: Backend::Gpu(None) };
        let mut player = Player::new(&scene, devices, true).unwrap();
        player.set_overlap(false);
        let gpu = player.picture_gpu().unwrap();
        let mut crossed = Vec::new();
        for event in player {
            if matches!(event.unwrap(), Event::Drawn { .. }) {
                crossed.push(gpu.crossed().to_device);
            }
        }
        crossed[3] - crossed[2]
    };
    // Parameters of the stages and the step take some 2 kB.
    let parameters = 6000;
    let [drawn, both] = [a_frame(Backend::Cpu), a_frame(Backend::Gpu(None))];
    assert!(both < parameters, "{both}");
    assert!((points..points + parameters).contains(&drawn), "{drawn} of {points} bytes");
}

/// The pictures of a scene.
fn pictures(devices: Devices) -> Vec<Picture> {
    let player = Player::new(&scene(), devices, true).unwrap();
    let drawn = |event| match event {
        Ok(Event::Drawn { picture, report, .. }) => {
            let stages: Vec<&str> = report.seconds.iter().map(|(name, _)| *name).collect();
            let all =
                ["tessellate", "interpolate", "opacity_depth", "opacity_layers", "shade", "draw", "resolve"];
            assert_eq!(stages, all);
            Some(picture)
        }
        event => {
            event.unwrap();
            None
        }
    };
    player.filter_map(drawn).collect()
}

/// Mean difference of two pictures' bytes.
fn unlike(one: &Picture, other: &Picture) -> f32 {
    assert_eq!(one.pixels.len(), other.pixels.len());
    let pairs = one.pixels.iter().zip(&other.pixels);
    pairs.map(|(a, b)| f32::from(a.abs_diff(*b))).sum::<f32>() / one.pixels.len() as f32
}

#[test]
fn a_scene_looks_alike_wherever_it_is_simulated_and_drawn() {
    let Some(_) = gpu() else { return };
    let on = |simulation, pictures_on| pictures(Devices { simulation, pictures: pictures_on });
    let (cpu, gpu) = (Backend::Cpu, Backend::Gpu(None));
    let expected = on(cpu, cpu);
    let last = |pictures: &[Picture]| pictures.last().unwrap().clone();
    assert_eq!(expected.len(), 4);
    assert!(unlike(&expected[0], &last(&expected)) > 1.0, "the head moves");
    // Points that stay on the device and points that are copied there.
    for devices in [(cpu, gpu), (gpu, gpu), (gpu, Backend::Gpu(Some(0))), (gpu, cpu)] {
        let found = on(devices.0, devices.1);
        for (one, other) in expected.iter().zip(&found) {
            // Levels of 255: strands of the two simulations differ by a millimetre or two.
            assert!(unlike(one, other) < 1.0, "{devices:?}: {}", unlike(one, other));
        }
    }
}

#[test]
fn more_lights_than_a_gpu_draws_are_refused_or_drawn_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    let light = hair.lights()[0];
    hair.set_lights(vec![light; 9]).unwrap();
    let camera = strandline::Camera::framing(hair.bounds(), glam::Vec3::Z, 1.0);
    let look = strandline::Look { follow_strands: 1, ..strandline::Look::thesis() };
    let error = hair.picture(&camera, &look).unwrap_err().to_string();
    assert!(error.contains("9 lights with shadow, at most 8"), "{error}");
    hair.set_lights(vec![light; 8]).unwrap();
    hair.picture(&camera, &look).unwrap();
    hair.set_lights(vec![light; 9]).unwrap();
    hair.set_fall_back(true);
    hair.take_notes();
    for _ in 0..2 {
        hair.picture(&camera, &look).unwrap();
        assert_eq!(hair.drawn_on(), "cpu");
        assert!(hair.opacity_map(8).unwrap().is_some(), "the map of a light that a GPU does not draw");
    }
    let notes = hair.take_notes();
    assert!(notes.len() == 1 && notes[0].contains("until the scene fits the GPU: 9 lights"), "{notes:?}");
    hair.set_lights(vec![light; 8]).unwrap();
    hair.picture(&camera, &look).unwrap();
    assert!(hair.drawn_on().starts_with("gpu:"), "{}", hair.drawn_on());
}

#[test]
fn a_second_picture_asks_for_no_more_memory() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    let look = strandline::Look { follow_strands: 8, ..strandline::Look::thesis() };
    let mut camera = strandline::Camera::framing(hair.bounds(), glam::Vec3::Z, 1.0);
    // Far away first: coming nearer needs the room that was made at once.
    camera.position *= 9.0;
    hair.picture(&camera, &look).unwrap();
    let used = gpu.memory_used();
    gpu.set_memory_limit(used);
    for distance in [0.5, 0.2] {
        camera.position *= distance;
        hair.set_lights(hair.lights()[..2].to_vec()).unwrap();
        hair.picture(&camera, &look).unwrap();
        assert_eq!(gpu.memory_used(), used);
    }
    let wider = strandline::PictureSettings::sized(4096, 4096);
    let error = hair.set_picture(&wider).unwrap_err().to_string();
    assert!(error.contains("out of memory"), "{error}");
    assert!(hair.picture(&camera, &look).is_ok(), "the old size stays");
    gpu.set_memory_limit(u64::MAX);
    let error = hair.set_picture(&strandline::PictureSettings::sized(8192, 64)).unwrap_err().to_string();
    assert!(error.contains("samples") && error.contains("8192"), "{error}");
}

#[test]
fn maps_of_a_gpu_can_be_looked_at() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    assert!(hair.opacity_map(0).unwrap().is_none());
    let camera = strandline::Camera::framing(hair.bounds(), glam::Vec3::Z, 1.0);
    hair.picture(&camera, &strandline::Look::thesis()).unwrap();
    let maps = [hair.opacity_map(0), hair.depth_map(0)].map(|map| map.unwrap().unwrap());
    assert!(maps.iter().all(|map| map.pixels.iter().any(|&byte| byte > 100)));
    // The third light casts no shadow.
    assert!(hair.opacity_map(2).unwrap().is_none());
    gpu.destroy();
    assert!(hair.opacity_map(0).is_err());
}

/// Sliders of gravity, drag and stiffness move in every frame: no frame waits for the device.
#[test]
fn settings_that_change_in_every_frame_wait_for_nothing() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    hair.step(0.05, Pose::IDENTITY).unwrap();
    let before = gpu.waits();
    for frame in 0..8_u8 {
        let mut settings = hair.settings().clone();
        settings.gravity.y = -9.0 + f32::from(frame);
        settings.drag.factor = 1.0 + f32::from(frame);
        settings.strands.rods.youngs_modulus = 3.0 + f32::from(frame);
        hair.set_settings(&settings).unwrap();
        hair.step(1.0 / 60.0, Pose::IDENTITY).unwrap();
    }
    assert_eq!(gpu.waits(), before);
    gpu.wait().unwrap();
    assert_eq!(gpu.waits(), before + 1, "waits are counted");
}

#[test]
fn lengths_change_on_a_gpu_too() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    hair.step(0.05, Pose::IDENTITY).unwrap();
    hair.set_length_scale(&[0.5; 60]).unwrap();
    let reports = hair.step(0.2, Pose::IDENTITY).unwrap();
    assert!(reports.iter().all(|report| report.stretch_max < 1e-3), "{:?}", reports.last());
    let state = hair.state().unwrap().clone();
    let points = hair.guides().points_per_strand();
    let length = |strand: usize| -> f32 {
        (1..points)
            .map(|point| {
                let at = |point: usize| state.positions[strand / LANES * points + point].get(strand % LANES);
                at(point).distance(at(point - 1))
            })
            .sum()
    };
    let rest = |strand: usize| -> f32 {
        (1..points)
            .map(|p| hair.guides().position(strand, p).distance(hair.guides().position(strand, p - 1)))
            .sum()
    };
    for strand in 0..60 {
        assert!((length(strand) / rest(strand) - 0.5).abs() < 0.02, "strand {strand}");
    }
    assert!(hair.set_length_scale(&[2.5; 60]).is_err());
}

#[test]
fn a_hand_holds_on_a_gpu_and_when_it_goes_away() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    hair.set_fall_back(true);
    hair.step(0.05, Pose::IDENTITY).unwrap();
    let points = hair.guides().points_per_strand();
    let tip = |hair: &mut Hair| hair.state().unwrap().positions[points - 1].get(0);
    let (hand, aside) = (tip(&mut hair), glam::Vec3::new(0.02, 0.04, 0.05));
    assert!(hair.grab(hand, 0.002).unwrap() >= 1);
    let held = |hair: &mut Hair, place: glam::Vec3| {
        let missed = tip(hair).distance(place);
        assert!(missed < 0.005, "{} misses the hand by {missed} m", hair.simulated_on());
    };
    hair.move_hand(hand + aside);
    hair.step(0.2, Pose::IDENTITY).unwrap();
    hair.step(0.3, Pose::IDENTITY).unwrap();
    held(&mut hair, hand + aside);
    gpu.destroy();
    hair.move_hand(hand + 1.2 * aside);
    hair.step(0.1, Pose::IDENTITY).unwrap();
    hair.step(0.3, Pose::IDENTITY).unwrap();
    assert_eq!(hair.simulated_on(), "cpu");
    held(&mut hair, hand + 1.2 * aside);
    hair.release().unwrap();
    assert_eq!(hair.state().unwrap().grabbed(), 0);
    hair.step(0.3, Pose::IDENTITY).unwrap();
    assert!(tip(&mut hair).distance(hand + 1.2 * aside) > 0.01, "it falls when it is let go of");
}

#[test]
fn mic0_is_for_the_cpu_and_auto_takes_it_there() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene();
    scene.simulation.volume.preconditioner = strandline::settings::Preconditioner::Mic0;
    let made = Hair::with_device(Prepared::new(&scene).unwrap(), &gpu);
    let error = made.err().unwrap().to_string();
    assert!(error.contains("mic0") && error.contains("chebyshev"), "{error}");
}

#[test]
fn a_scene_names_its_backend() {
    let scene = Scene::parse("[simulation]\nbackend = \"gpu:2\"\n", "test").unwrap();
    assert_eq!(scene.devices.simulation, Backend::Gpu(Some(2)));
    assert!(scene.to_toml().contains("simulation = \"gpu:2\""));
    let error = Scene::parse("[simulation]\nbackend = \"cuda\"\n", "test").unwrap_err().to_string();
    assert!(error.contains("expected auto, cpu, gpu"), "{error}");
}
