//! Hair that plays until it is told otherwise.

use std::time::{Duration, Instant};

use strandline::{Camera, Command, Live, Look, Motion, News, Scene, Shown};

fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.simulation.backend = strandline::Backend::Cpu;
    scene.picture.backend = strandline::Backend::Cpu;
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    (scene.picture.width, scene.picture.height) = (64, 48);
    scene
}

/// Waits for what is wanted, for at most a minute.
fn wait<T>(mut look: impl FnMut() -> Option<T>) -> T {
    let begin = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "nothing came");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn next(live: &Live) -> Shown {
    wait(|| live.take_shown())
}

/// A scene that stands still, and its first picture.
fn still() -> (Live, Shown) {
    let live = Live::new(scene(), || ()).unwrap();
    live.tell(Command::Play(false));
    let first = next(&live);
    (live, first)
}

#[test]
fn it_plays_and_stands_still_and_makes_single_steps() {
    let live = Live::new(scene(), || ()).unwrap();
    let seen: Vec<Shown> = (0..4).map(|_| next(&live)).collect();
    assert!(seen.windows(2).all(|pair| pair[1].frame > pair[0].frame));
    assert!(seen[3].picture != seen[0].picture && seen[3].step.is_some());
    assert_eq!(seen[3].places, ["cpu", "cpu"]);
    live.tell(Command::Play(false));
    // What was on its way is shown, three pictures at most; then nothing comes, however slow the machine.
    let (mut came, mut resting, mut since) = (0, seen[3].clone(), Instant::now());
    while since.elapsed() < Duration::from_millis(1500) {
        if let Some(shown) = live.take_shown() {
            (came, resting, since) = (came + 1, shown, Instant::now());
            assert!(came <= 3, "it does not stand still");
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    live.tell(Command::Step);
    let stepped = next(&live);
    assert!(stepped.step.is_some() && stepped.picture != resting.picture);
    assert_eq!(stepped.frame, resting.frame + 1);
}

#[test]
fn every_change_shows_in_the_next_pictures() {
    let (live, first) = still();
    let mut last = first.picture.clone();
    let changes = [
        Command::Camera(Camera::back()),
        Command::Look(Box::new(Look { follow_strands: 2, ..scene().look })),
        Command::Lights(Vec::new()),
        Command::Picture(strandline::render::PictureSettings { exposure: 1.0, ..scene().picture }),
        Command::Length(0.5),
    ];
    for change in changes {
        live.tell(change);
        let shown = next(&live);
        assert!(shown.picture != last);
        last = shown.picture;
    }
    let length = |live: &Live| {
        live.tell(Command::Reset);
        next(live).picture
    };
    assert!(length(&live) != first.picture, "lengths stay through a reset of places");
    for command in [Command::Motion(Motion::Nod), Command::Turn(0.5, 0.1)] {
        live.tell(command);
        live.tell(Command::Step);
        let shown = wait(|| live.take_shown().filter(|shown| shown.step.is_some()));
        assert!(shown.picture != last);
        last = shown.picture;
    }
    assert!(live.take_news().iter().all(|news| matches!(news, News::Loaded(..))));
}

#[test]
fn what_cannot_be_done_is_told_and_what_is_there_stays() {
    let (live, first) = still();
    live.take_news();
    let error = |live: &Live| {
        wait(|| {
            live.take_news().into_iter().find_map(|news| match news {
                News::Error(error) => Some(error),
                _ => None,
            })
        })
    };
    let mut missing = scene();
    missing.groom.file = Some("no-such.hair".into());
    live.tell(Command::Load(Box::new(missing)));
    assert!(error(&live).contains("no-such.hair"));
    live.tell(Command::Camera(Camera { near: -1.0, ..Camera::front() }));
    assert!(error(&live).contains("camera.near"));
    live.tell(Command::Settings(Box::new(strandline::Settings { time_step: -1.0, ..scene().simulation })));
    assert!(error(&live).contains("time_step"));
    live.tell(Command::Length(7.0));
    assert!(error(&live).contains("7"));
    // After all that it still draws what it drew.
    live.tell(Command::Camera(first_camera(&live)));
    let again = next(&live);
    assert_eq!(again.picture, first.picture);
    let mut other = scene();
    other.style.strand_count = 30;
    live.tell(Command::Load(Box::new(other)));
    wait(|| live.take_news().into_iter().find(|news| matches!(news, News::Loaded(..))));
    wait(|| live.take_shown().filter(|shown| shown.picture != first.picture));
}

/// The camera that the scene has for itself.
fn first_camera(_: &Live) -> Camera {
    let prepared = strandline::Prepared::new(&scene()).unwrap();
    scene().camera.camera(prepared.bounds, 64.0 / 48.0)
}

#[test]
fn it_may_be_left_at_any_moment_under_any_commands() {
    let mut state = 7_u64;
    for round in 0..12 {
        let live = Live::new(scene(), || ()).unwrap();
        for _ in 0..round * 4 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            live.tell(match state >> 61 {
                0 => Command::Play(false),
                1 => Command::Play(true),
                2 => Command::Step,
                3 => Command::Reset,
                4 => Command::Length(0.5 + 0.4 * (round as f32 / 12.0)),
                5 => Command::Load(Box::new(scene())),
                6 => Command::Settings(Box::new(scene().simulation)),
                _ => Command::Turn(0.1 * round as f32, 0.0),
            });
            std::thread::sleep(Duration::from_micros(state >> 52));
        }
        drop(live);
    }
}
