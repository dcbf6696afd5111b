//! Loss of a GPU, and a GPU without memory.

use strandline::{
    Backend, ErrorKind, Event, Hair, Player, Settings, device::Gpu, file::Film, settings::VolumeSettings,
};

use super::{apart, gpu, hair, prepared, scene, turned};

#[test]
fn a_lost_gpu_is_an_error_that_names_it_and_the_last_state_stays() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    hair.step(0.1, turned(0.2)).unwrap();
    let before = hair.state().unwrap().clone();
    gpu.destroy();
    let error = hair.step(0.1, turned(0.4)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::DeviceLost);
    let error = error.to_string();
    assert!(error.contains(&gpu.adapter().name) && error.contains("lost"), "{error}");
    assert_eq!(hair.state().unwrap().positions, before.positions);
    let camera = strandline::Camera::framing(hair.bounds(), glam::Vec3::Z, 1.0);
    let look = strandline::Look::thesis();
    let error = hair.picture(&camera, &look).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::DeviceLost, "a picture's failure is no error of the simulation");
    let error = error.to_string();
    assert!(error.contains(&gpu.adapter().name) && error.contains("lost"), "{error}");
    assert!(hair.step(0.1, turned(0.4)).is_err(), "it stays lost");
    hair.set_fall_back(true);
    assert!(hair.picture(&camera, &look).is_ok(), "the last state can be drawn");
    assert_eq!(hair.drawn_on(), "cpu");
    let notes = hair.take_notes().join(" ");
    assert!(notes.contains("drawing on the CPU from here on"), "{notes}");
}

#[test]
fn a_run_that_may_fall_back_goes_on_from_the_last_state() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    let notes = hair.take_notes();
    assert_eq!(notes.len(), usize::from(gpu.adapter().software), "{notes:?}");
    hair.set_fall_back(true);
    let mut reports = hair.step(0.1, turned(0.2)).unwrap();
    let before = hair.state().unwrap().clone();
    assert!(hair.simulated_on().starts_with("gpu:"));
    gpu.destroy();
    reports.extend(hair.step(1.0 / 60.0, turned(0.23)).unwrap());
    assert_eq!(reports.len(), 7, "each step once");
    assert_eq!(hair.simulated_on(), "cpu");
    let notes = hair.take_notes();
    assert!(
        notes.len() == 1 && notes[0].contains("falling back to the CPU, resuming from 0.100 s"),
        "{notes:?}"
    );
    assert!(notes[0].contains(&gpu.adapter().name), "{notes:?}");
    assert_eq!(hair.state().unwrap().previous_positions, before.positions, "no step is lost or repeated");
    let moved = apart(&hair.state().unwrap().positions, &before.positions);
    assert!(moved > 1e-5 && moved < 0.05, "{moved}");
    assert!(hair.take_notes().is_empty());
}

#[test]
fn steps_that_a_lost_gpu_had_made_are_made_again() {
    let Some(gpu) = gpu() else { return };
    let play = |gpu: Option<&Gpu>, checkpoint_every: u32| {
        let mut hair = match gpu {
            Some(gpu) => hair(gpu),
            None => Hair::from_prepared(prepared(), Backend::Cpu).unwrap(),
        };
        hair.set_fall_back(true);
        hair.set_settings(&Settings { checkpoint_every, ..hair.settings().clone() }).unwrap();
        hair.step(0.1, turned(0.2)).unwrap();
        // A state that was sent on its way has arrived then.
        gpu.inspect(|gpu| gpu.wait().unwrap());
        hair.step(0.1, turned(0.3)).unwrap();
        gpu.inspect(|gpu| gpu.destroy());
        hair.step(0.1, turned(0.4)).unwrap();
        let notes = hair.take_notes().join(" ");
        assert_eq!(notes.contains("resuming from 0.200 s"), gpu.is_some(), "{notes}");
        hair.state().unwrap().clone()
    };
    let expected = play(None, 120);
    // Nothing was read from the device: all is made again.
    assert_eq!(play(Some(&gpu), 120).positions, expected.positions);
    let Some(gpu) = self::gpu() else { return };
    // The CPU resumes from what was read.
    let found = play(Some(&gpu), 5);
    assert_eq!(found.time, expected.time);
    let distance = apart(&found.positions, &expected.positions);
    assert!(distance > 0.0 && distance < 1e-2, "{distance}");
}

#[test]
fn refused_memory_names_the_adapter_and_the_size() {
    let Some(gpu) = gpu() else { return };
    let mut hair = hair(&gpu);
    hair.step(0.05, turned(0.1)).unwrap();
    gpu.set_memory_limit(gpu.memory_used() + 100_000);
    let mut settings = hair.settings().clone();
    settings.volume = VolumeSettings { cells: [64; 3], ..settings.volume };
    hair.set_settings(&settings).unwrap();
    let error = hair.step(0.05, turned(0.2)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::OutOfMemory);
    let error = error.to_string();
    assert!(error.contains(&gpu.adapter().name) && error.contains("out of memory"), "{error}");
    assert!(error.contains("bytes was refused"), "{error}");
    hair.set_fall_back(true);
    hair.step(0.05, turned(0.2)).unwrap();
    assert_eq!(hair.simulated_on(), "cpu");
}

#[test]
fn a_film_keeps_its_finished_frames_when_the_gpu_goes_away() {
    let Some(_) = gpu() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut player = Player::new(&scene(), Backend::Gpu(None), true).unwrap();
    let mut film = Film::new(folder.path(), player.frames(), 24.0).unwrap();
    let mut outcome = None;
    while let Some(event) = player.next() {
        match event {
            Ok(Event::Drawn { frame, picture, .. }) => {
                film.add(&picture).unwrap();
                if frame == 1 {
                    player.gpu().unwrap().destroy();
                }
            }
            Ok(_) => {}
            Err(error) => outcome = Some(error.to_string()),
        }
    }
    assert!(outcome.unwrap().contains("lost"));
    assert!(player.next().is_none(), "a film that failed is over");
    for frame in 0..2 {
        let path = folder.path().join(format!("frame_{frame:04}.png"));
        assert_eq!(image::open(path).unwrap().width(), 64);
    }
}
