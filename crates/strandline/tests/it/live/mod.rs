//! Hair that plays live, on the thread of a window.

mod as_film;
mod files;
mod helpers;
mod project;
mod timeline;

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
    mpsc::channel,
};
use std::time::Duration;

use strandline::{
    Camera, Change, Live, Look, PictureSettings, Prepared, Ray, Settings,
    live::{Command, LiveClock, LiveEvent, Shown},
    scene::{MotionName, MotionSection},
};

use helpers::{PATIENCE, error, next, scene, settled, still, wait, waking};

#[test]
fn it_plays_and_stands_still_and_makes_single_steps() {
    let live = Live::new(scene(), waking()).unwrap();
    let seen: Vec<Shown> = (0..4).map(|_| next(&live)).collect();
    assert!(seen.windows(2).all(|pair| pair[1].frame > pair[0].frame));
    assert!(seen[3].picture != seen[0].picture && seen[3].step.is_some());
    assert_eq!(seen[3].places, ["cpu", "cpu"]);
    live.send(Command::Play(false));
    // Pictures on their way are shown, three at most; then nothing comes.
    live.wait_idle();
    let resting = live.take_shown().unwrap_or(seen[3].clone());
    assert!(resting.frame <= seen[3].frame + 3, "it does not stand still");
    live.wait_idle();
    assert!(live.take_shown().is_none());
    live.send(Command::Step);
    let stepped = next(&live);
    assert!(stepped.step.is_some() && stepped.picture != resting.picture);
    assert_eq!(stepped.frame, resting.frame + 1);
}

#[test]
fn every_change_shows_in_the_next_pictures() {
    let (live, first) = still();
    let mut last = first.picture.clone();
    let changes = [
        Change::Camera(Camera::back()),
        Change::Look(Box::new(Look { follow_strands: 2, ..scene().look })),
        Change::Lights(Vec::new()),
        Change::Picture(PictureSettings { exposure: 1.0, ..scene().picture }),
        Change::Length(0.5),
    ];
    for change in changes {
        live.send(change);
        let shown = next(&live);
        assert!(shown.picture != last);
        last = shown.picture;
    }
    live.send(Change::Reset);
    assert_eq!(next(&live).picture, last, "lengths stay through a reset of places");
    let nod = MotionSection { name: MotionName::Nod, ..scene().motion };
    let turned = MotionSection { rotation: glam::Vec3::new(10.0, 30.0, 0.0), ..nod.clone() };
    for command in [Change::Motion(Box::new(nod)), Change::Motion(Box::new(turned))] {
        let before = live.send(command);
        // The head is at its place a little later.
        let steps = (0..20).map(|_| live.send(Command::Step)).last().unwrap();
        assert!(steps > before);
        let shown = settled(&live);
        assert!(shown.drawn_after_command >= steps);
        assert!(shown.picture != last);
        last = shown.picture;
    }
    assert!(
        live.take_events().iter().all(|news| matches!(news, LiveEvent::Loaded(..) | LiveEvent::Loading(..)))
    );
}

#[test]
fn what_cannot_be_done_is_reported_and_what_is_there_stays() {
    let (live, first) = still();
    live.take_events();
    let mut missing = scene();
    missing.groom.file = Some("no-such.hair".into());
    live.send(Command::Load(Box::new(missing)));
    assert!(error(&live).contains("no-such.hair"));
    live.send(Change::Camera(Camera { near: -1.0, ..Camera::front() }));
    assert!(error(&live).contains("camera.near"));
    live.send(Change::Settings(Box::new(Settings { time_step: -1.0, ..scene().simulation })));
    assert!(error(&live).contains("time_step"));
    live.send(Change::Length(7.0));
    assert!(error(&live).contains("7"));
    let bad_motion = MotionSection { rotation: glam::Vec3::NAN, ..scene().motion };
    live.send(Change::Motion(Box::new(bad_motion)));
    assert!(error(&live).contains("motion.rotation"));
    let mut undrawable = scene();
    undrawable.look.fibre.scheuermann.sparkle = 7.0;
    live.send(Command::Load(Box::new(undrawable)));
    assert!(error(&live).contains("sparkle"));
    // After all that it still draws what it drew.
    let number = live.send(Change::Camera(first_camera()));
    let again = wait(|| live.take_shown().filter(|shown| shown.drawn_after_command >= number));
    assert_eq!(again.picture, first.picture);
    let mut other = scene();
    other.style.strand_count = 30;
    live.send(Command::Load(Box::new(other)));
    wait(|| live.take_events().into_iter().find(|news| matches!(news, LiveEvent::Loaded(..))));
    wait(|| live.take_shown().filter(|shown| shown.picture != first.picture));
}

/// The camera that the scene has for itself.
fn first_camera() -> Camera {
    Prepared::new(&scene()).unwrap().camera(64.0 / 48.0)
}

#[test]
fn it_may_be_left_at_any_moment_under_any_commands() {
    let mut random = strandline::math::Random::new(7, 0);
    for round in 0..12 {
        let woken = Arc::new(AtomicBool::new(false));
        let wakes = woken.clone();
        let live = Live::new(scene(), move || wakes.store(true, Ordering::Relaxed)).unwrap();
        for _ in 0..round * 4 {
            let bits = random.bits();
            live.send(match bits >> 29 {
                0 => Command::Play(false),
                1 => Command::Play(true),
                2 => Command::Step,
                3 => Change::Reset.into(),
                4 => Change::Length(0.5 + 0.4 * (round as f32 / 12.0)).into(),
                5 => Command::Load(Box::new(scene())),
                6 => Change::Settings(Box::new(scene().simulation)).into(),
                _ => Change::Motion(Box::new(MotionSection {
                    rotation: glam::Vec3::Y * 5.0 * round as f32,
                    ..scene().motion
                }))
                .into(),
            });
            std::thread::sleep(Duration::from_micros((bits >> 20).into()));
        }
        let events = live.take_events();
        let failed =
            events.iter().find(|event| matches!(event, LiveEvent::Error(..) | LiveEvent::NotLoaded(..)));
        assert_eq!(failed, None, "round {round}");
        // A test that hangs fails by the end of its process alone.
        let (left, ended) = channel::<()>();
        let watch = std::thread::spawn(move || {
            if ended.recv_timeout(PATIENCE).is_err() {
                std::process::abort();
            }
        });
        drop(live);
        left.send(()).unwrap();
        watch.join().unwrap();
        // The threads have ended with it: none of them can wake the window any more.
        assert_eq!(Arc::strong_count(&woken), 1, "round {round}: a thread is left behind");
    }
}

/// Number of times out of twenty that a command shows within so many pictures after it. The machine
/// may be busy: then pictures pass that this thread does not see.
fn in_time(pictures: u64, tell: impl Fn(&Live, u64) -> u64, shows: impl Fn(&Shown, u64) -> bool) -> usize {
    let live = Live::new(scene(), waking()).unwrap();
    let mut last = next(&live);
    let mut count = 0;
    for turn in 0..20_u64 {
        // At any time of a frame.
        std::thread::sleep(Duration::from_micros(turn * 613 % 7000));
        last = live.take_shown().unwrap_or(last);
        let number = tell(&live, turn);
        let shown = wait(|| live.take_shown().filter(|shown| shows(shown, number)));
        count += usize::from(shown.frame <= last.frame + pictures);
        last = shown;
    }
    count
}

#[test]
fn a_view_shows_in_the_next_picture_that_is_begun() {
    let turn =
        |live: &Live, turn: u64| live.send(Change::Camera(Camera::front().orbit(0.1 * turn as f32, 0.0)));
    // The first picture to come is under way.
    assert!(in_time(2, turn, |shown, number| shown.drawn_after_command >= number) > 12);
    assert!(
        in_time(0, turn, |shown, number| shown.drawn_after_command >= number) == 0,
        "no picture is enough"
    );
}

#[test]
fn a_setting_shows_in_the_picture_after_that() {
    let settings = |turn: u64| {
        let mut settings = scene().simulation;
        settings.volume.enabled = turn.is_multiple_of(2);
        settings
    };
    let set = |live: &Live, turn: u64| live.send(Change::Settings(Box::new(settings(turn))));
    assert!(in_time(3, set, |shown, number| shown.simulated_after_command >= number) > 12);
    // The step that used it is one with the setting.
    let live = Live::new(scene(), waking()).unwrap();
    for turn in 0..6 {
        let number = set(&live, turn);
        let shown = wait(|| {
            live.take_shown().filter(|shown| shown.simulated_after_command >= number && shown.step.is_some())
        });
        let has_volume = shown.step.unwrap().seconds.iter().any(|(stage, _)| *stage == "splat");
        assert_eq!(has_volume, settings(turn).volume.enabled, "turn {turn}");
    }
}

#[test]
fn a_setting_that_is_refused_does_not_stop_it() {
    let live = Live::new(scene(), waking()).unwrap();
    next(&live);
    live.send(Change::Settings(Box::new(Settings { time_step: -1.0, ..scene().simulation })));
    wait(|| live.take_events().into_iter().find(|news| matches!(news, LiveEvent::Error(..))));
    let frame = next(&live).frame;
    wait(|| live.take_shown().filter(|shown| shown.frame > frame + 3 && shown.step.is_some()));
    assert!(!live.take_events().contains(&LiveEvent::Paused));
}

#[test]
fn of_two_scenes_on_their_way_the_last_one_stays() {
    let (live, _) = still();
    live.take_events();
    let (mut slow, mut fast) = (scene(), scene());
    slow.body.spacing = 0.004;
    (slow.style.strand_count, fast.style.strand_count) = (300, 30);
    live.send(Command::Load(Box::new(slow)));
    live.send(Command::Load(Box::new(fast)));
    wait(|| live.take_shown().filter(|shown| shown.drawing.strands == 30));
    // The other one, which came too, is left out without a word.
    live.wait_idle();
    let shown = live.take_shown();
    assert!(shown.is_none_or(|shown| shown.drawing.strands == 30));
    assert_eq!(live.take_events().iter().filter(|news| matches!(news, LiveEvent::Loaded(..))).count(), 1);
}

#[test]
fn a_slow_picture_is_simpler_while_it_moves_and_full_when_it_rests() {
    let mut slow = scene();
    slow.look.follow_strands = 64;
    let clock = LiveClock::manual();
    clock.set_picture_seconds(0.1);
    let live = Live::with_clock(slow, waking(), clock.clone()).unwrap();
    live.send(Command::Adapt(true));
    let draft = wait(|| live.take_shown().filter(|shown| shown.draft));
    assert_eq!((draft.picture.width, draft.picture.height), (16, 12), "the coarsest comes first");
    clock.set_picture_seconds(0.03);
    wait(|| live.take_shown().filter(|shown| shown.draft && shown.picture.width > 16));
    clock.set_picture_seconds(0.3);
    wait(|| live.take_shown().filter(|shown| shown.draft && shown.picture.width == 16));
    live.send(Command::Play(false));
    let resting = settled(&live);
    assert!(resting.draft, "nothing has rested for a moment yet");
    clock.advance(Duration::from_millis(190));
    live.wait_idle();
    assert!(live.take_shown().is_none(), "too early");
    clock.advance(Duration::from_millis(210));
    let full = next(&live);
    assert_eq!((full.draft, full.picture.width, full.picture.height), (false, 64, 48));
    assert!(full.drawing.strands > 8 * draft.drawing.strands);
    live.send(Change::Camera(Camera::back()));
    assert!(settled(&live).draft, "what changes is simpler too");
    clock.advance(Duration::from_secs(1));
    assert!(!next(&live).draft);
    // A picture of 70 ms is not slow.
    clock.set_picture_seconds(0.07);
    live.send(Command::Adapt(false));
    live.send(Change::Camera(Camera::front()));
    assert!(!next(&live).draft);
    live.send(Command::Adapt(true));
    live.send(Change::Camera(Camera::back()));
    assert!(!next(&live).draft);
}

#[test]
fn hair_is_pulled_by_a_hand() {
    let mut long = scene();
    long.motion.name = MotionName::Still;
    long.look.width_scale = 60.0;
    // A guide that stands for itself alone creeps back through air.
    long.simulation.drag.factor = 0.0;
    let live = Live::new(long, waking()).unwrap();
    let camera = wait(|| {
        live.take_events().into_iter().find_map(|news| match news {
            LiveEvent::Loaded(_, _, camera, ..) => Some(camera),
            _ => None,
        })
    });
    let ray = |x: f32, y: f32| Ray::new(&camera, glam::Vec2::new(x, y));
    // Beside the head, where there is nothing; then in the middle of the hair.
    live.send(Change::Grab(ray(2.0, 0.9), 0.02));
    next(&live);
    assert_eq!(next(&live).grabbed, 0);
    live.send(Change::Grab(ray(-0.25, -0.4), 0.05));
    let held = wait(|| live.take_shown().filter(|shown| shown.grabbed > 0));
    live.send(Change::Drag(ray(-1.0, 0.2)));
    let pulled = wait(|| live.take_shown().filter(|shown| shown.frame > held.frame + 20));
    assert_eq!(pulled.grabbed, held.grabbed);
    // Still hair in still light makes the same picture to the bit, so that every difference is hair that moved; dark
    // brown hair changes a pixel by little, so that 15 of 255 is much.
    let differ = pulled.picture.pixels.iter().zip(&held.picture.pixels).filter(|(a, b)| a.abs_diff(**b) > 15);
    let differ = differ.count();
    assert!(differ > 60, "the hair does not follow the hand: {differ}, {} held", held.grabbed);
    // A hand that finds nothing lets go of what it held.
    live.send(Change::Grab(ray(2.0, 0.9), 0.02));
    wait(|| live.take_shown().filter(|shown| shown.grabbed == 0));
    // Once it has swung back.
    wait(|| {
        live.send(Change::Grab(ray(-0.25, -0.4), 0.05));
        live.take_shown().filter(|shown| shown.grabbed > 0)
    });
    live.send(Change::Release);
    wait(|| live.take_shown().filter(|shown| shown.grabbed == 0));
    assert!(live.take_events().is_empty());
}
