//! Hair that plays until it is told otherwise.

use std::time::{Duration, Instant};

use strandline::low_level::render::PictureSettings;
use strandline::low_level::{Command, News, Prepared, Ray, Shown};
use strandline::scene::{MotionName, MotionSection};
use strandline::{Backend, Camera, Live, Look, Scene, Settings};

fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.devices = Backend::Cpu.into();
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

/// The last picture before nothing comes any more.
fn settled(live: &Live) -> Shown {
    let (mut last, mut since) = (next(live), Instant::now());
    while since.elapsed() < Duration::from_millis(1500) {
        if let Some(shown) = live.take_shown() {
            (last, since) = (shown, Instant::now());
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    last
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
        Command::Picture(PictureSettings { exposure: 1.0, ..scene().picture }),
        Command::Length(0.5),
    ];
    for change in changes {
        live.tell(change);
        let shown = next(&live);
        assert!(shown.picture != last);
        last = shown.picture;
    }
    live.tell(Command::Reset);
    assert_eq!(next(&live).picture, last, "lengths stay through a reset of places");
    let nod = MotionSection { name: MotionName::Nod, ..scene().motion };
    let turned = MotionSection { rotation: glam::Vec3::new(10.0, 30.0, 0.0), ..nod.clone() };
    for command in [Command::Motion(Box::new(nod)), Command::Motion(Box::new(turned))] {
        let before = live.tell(command);
        // The head is at its place a little later.
        let steps = (0..20).map(|_| live.tell(Command::Step)).last().unwrap();
        assert!(steps > before);
        let shown = settled(&live);
        assert!(shown.heard >= steps);
        assert!(shown.picture != last);
        last = shown.picture;
    }
    assert!(live.take_news().iter().all(|news| matches!(news, News::Loaded(..))));
}

/// The next error that is told.
fn error(live: &Live) -> String {
    wait(|| {
        live.take_news().into_iter().find_map(|news| match news {
            News::Error(error) | News::NotLoaded(_, error) => Some(error),
            _ => None,
        })
    })
}

#[test]
fn what_cannot_be_done_is_told_and_what_is_there_stays() {
    let (live, first) = still();
    live.take_news();
    let mut missing = scene();
    missing.groom.file = Some("no-such.hair".into());
    live.tell(Command::Load(Box::new(missing)));
    assert!(error(&live).contains("no-such.hair"));
    live.tell(Command::Camera(Camera { near: -1.0, ..Camera::front() }));
    assert!(error(&live).contains("camera.near"));
    live.tell(Command::Settings(Box::new(Settings { time_step: -1.0, ..scene().simulation })));
    assert!(error(&live).contains("time_step"));
    live.tell(Command::Length(7.0));
    assert!(error(&live).contains("7"));
    let bad_motion = MotionSection { rotation: glam::Vec3::NAN, ..scene().motion };
    live.tell(Command::Motion(Box::new(bad_motion)));
    assert!(error(&live).contains("motion.rotation"));
    let mut undrawable = scene();
    undrawable.look.sparkle = 7.0;
    live.tell(Command::Load(Box::new(undrawable)));
    assert!(error(&live).contains("sparkle"));
    // After all that it still draws what it drew.
    let number = live.tell(Command::Camera(first_camera()));
    let again = wait(|| live.take_shown().filter(|shown| shown.heard >= number));
    assert_eq!(again.picture, first.picture);
    let mut other = scene();
    other.style.strand_count = 30;
    live.tell(Command::Load(Box::new(other)));
    wait(|| live.take_news().into_iter().find(|news| matches!(news, News::Loaded(..))));
    wait(|| live.take_shown().filter(|shown| shown.picture != first.picture));
}

/// The camera that the scene has for itself.
fn first_camera() -> Camera {
    Prepared::new(&scene()).unwrap().camera(64.0 / 48.0)
}

#[test]
fn it_may_be_left_at_any_moment_under_any_commands() {
    let mut random = strandline::low_level::base::Random::new(7, 0);
    for round in 0..12 {
        let live = Live::new(scene(), || ()).unwrap();
        for _ in 0..round * 4 {
            let bits = random.bits();
            live.tell(match bits >> 29 {
                0 => Command::Play(false),
                1 => Command::Play(true),
                2 => Command::Step,
                3 => Command::Reset,
                4 => Command::Length(0.5 + 0.4 * (round as f32 / 12.0)),
                5 => Command::Load(Box::new(scene())),
                6 => Command::Settings(Box::new(scene().simulation)),
                _ => Command::Motion(Box::new(MotionSection {
                    rotation: glam::Vec3::Y * 5.0 * round as f32,
                    ..scene().motion
                })),
            });
            std::thread::sleep(Duration::from_micros((bits >> 20).into()));
        }
        drop(live);
    }
}

/// How often of twenty times something told shows within so many pictures that come after it. The machine
/// may be busy: then pictures pass that this thread does not see.
fn in_time(pictures: u64, tell: impl Fn(&Live, u64) -> u64, shows: impl Fn(&Shown, u64) -> bool) -> usize {
    let live = Live::new(scene(), || ()).unwrap();
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
        |live: &Live, turn: u64| live.tell(Command::Camera(Camera::front().orbit(0.1 * turn as f32, 0.0)));
    // The first picture to come is under way.
    assert!(in_time(2, turn, |shown, number| shown.heard >= number) > 12);
    assert!(in_time(0, turn, |shown, number| shown.heard >= number) == 0, "no picture is enough");
}

#[test]
fn a_setting_shows_in_the_picture_after_that() {
    let settings = |turn: u64| {
        let mut settings = scene().simulation;
        settings.volume.enabled = turn.is_multiple_of(2);
        settings
    };
    let set = |live: &Live, turn: u64| live.tell(Command::Settings(Box::new(settings(turn))));
    assert!(in_time(3, set, |shown, number| shown.felt >= number) > 12);
    // The step that has felt it is one with the setting.
    let live = Live::new(scene(), || ()).unwrap();
    for turn in 0..6 {
        let number = set(&live, turn);
        let shown = wait(|| live.take_shown().filter(|shown| shown.felt >= number && shown.step.is_some()));
        let has_volume = shown.step.unwrap().seconds.iter().any(|(stage, _)| *stage == "splat");
        assert_eq!(has_volume, settings(turn).volume.enabled, "turn {turn}");
    }
}

#[test]
fn a_setting_that_is_refused_does_not_stop_it() {
    let live = Live::new(scene(), || ()).unwrap();
    next(&live);
    live.tell(Command::Settings(Box::new(Settings { time_step: -1.0, ..scene().simulation })));
    wait(|| live.take_news().into_iter().find(|news| matches!(news, News::Error(_))));
    let frame = next(&live).frame;
    wait(|| live.take_shown().filter(|shown| shown.frame > frame + 3 && shown.step.is_some()));
    assert!(!live.take_news().contains(&News::Paused));
}

#[test]
fn of_two_scenes_on_their_way_the_last_one_stays() {
    let (live, _) = still();
    live.take_news();
    let (mut slow, mut fast) = (scene(), scene());
    slow.body.spacing = 0.004;
    (slow.style.strand_count, fast.style.strand_count) = (300, 30);
    // How long the slow one takes by itself.
    let begin = Instant::now();
    Prepared::new(&slow).unwrap();
    let needed = begin.elapsed();
    let told = Instant::now();
    live.tell(Command::Load(Box::new(slow)));
    live.tell(Command::Load(Box::new(fast)));
    wait(|| live.take_shown().filter(|shown| shown.drawing.strands == 30));
    // Long enough for the other one, which is left out without a word: five times what it needs.
    std::thread::sleep((5 * needed).saturating_sub(told.elapsed()));
    let shown = live.take_shown();
    assert!(shown.is_none_or(|shown| shown.drawing.strands == 30));
    assert_eq!(live.take_news().iter().filter(|news| matches!(news, News::Loaded(..))).count(), 1);
}

#[test]
fn a_slow_picture_is_simpler_while_it_moves_and_full_when_it_rests() {
    let mut slow = scene();
    slow.style.strand_count = 800;
    (slow.look.follow_strands, slow.picture.width, slow.picture.height) = (64, 640, 480);
    let live = Live::new(slow, || ()).unwrap();
    live.tell(Command::Adapt(true));
    let draft = wait(|| live.take_shown().filter(|shown| shown.draft));
    assert_eq!((draft.picture.width, draft.picture.height), (320, 240));
    live.tell(Command::Play(false));
    let full = wait(|| live.take_shown().filter(|shown| !shown.draft));
    assert_eq!((full.picture.width, full.picture.height), (640, 480));
    assert!(full.drawing.strands >= 4 * draft.drawing.strands, "{} strands", draft.drawing.strands);
    // On many threads it is not slow, and then nothing has to be simpler.
    if full.drawing.seconds.iter().map(|(_, seconds)| seconds).sum::<f64>() > 0.1 {
        live.tell(Command::Camera(Camera::back()));
        wait(|| live.take_shown().filter(|shown| shown.draft));
        wait(|| live.take_shown().filter(|shown| !shown.draft));
    }
    live.tell(Command::Adapt(false));
    live.tell(Command::Camera(Camera::front()));
    assert!(!next(&live).draft);
}

#[test]
fn hair_is_pulled_by_a_hand() {
    let mut long = scene();
    long.motion.name = MotionName::Still;
    long.look.width_scale = 60.0;
    let live = Live::new(long, || ()).unwrap();
    let camera = wait(|| {
        live.take_news().into_iter().find_map(|news| match news {
            News::Loaded(_, _, camera, ..) => Some(camera),
            _ => None,
        })
    });
    let ray = |x: f32, y: f32| Ray::new(&camera, glam::Vec2::new(x, y));
    // Beside the head, where there is nothing; then in the middle of the hair.
    live.tell(Command::Grab(ray(2.0, 0.9), 0.02));
    next(&live);
    assert_eq!(next(&live).grabbed, 0);
    live.tell(Command::Grab(ray(-0.25, -0.4), 0.05));
    let held = wait(|| live.take_shown().filter(|shown| shown.grabbed > 0));
    live.tell(Command::Drag(ray(-1.0, 0.2)));
    let pulled = wait(|| live.take_shown().filter(|shown| shown.frame > held.frame + 20));
    assert_eq!(pulled.grabbed, held.grabbed);
    // Still hair in still light makes the same picture to the bit, so that every difference is hair that moved; dark
    // brown hair changes a pixel by little, so that 15 of 255 is much.
    let differ = pulled.picture.pixels.iter().zip(&held.picture.pixels).filter(|(a, b)| a.abs_diff(**b) > 15);
    let differ = differ.count();
    assert!(differ > 60, "the hair does not follow the hand: {differ}, {} held", held.grabbed);
    // A hand that finds nothing lets go of what it held.
    live.tell(Command::Grab(ray(2.0, 0.9), 0.02));
    wait(|| live.take_shown().filter(|shown| shown.grabbed == 0));
    live.tell(Command::Grab(ray(-0.25, -0.4), 0.05));
    wait(|| live.take_shown().filter(|shown| shown.grabbed > 0));
    live.tell(Command::Release);
    wait(|| live.take_shown().filter(|shown| shown.grabbed == 0));
    assert!(live.take_news().is_empty());
}

#[test]
fn a_video_is_recorded_frame_by_frame_and_finished_when_it_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let live = Live::new(scene(), || ()).unwrap();
    next(&live);
    let files = |name: &str| {
        let list = std::fs::read_dir(folder.path().join(name)).unwrap();
        list.map(|file| file.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>()
    };
    live.tell(Command::Record(folder.path().join("one")));
    // The size stays, whatever the window wants.
    live.tell(Command::Picture(PictureSettings { width: 96, ..scene().picture }));
    wait(|| live.take_shown().filter(|shown| shown.recorded >= Some(4)));
    live.tell(Command::StopRecording);
    wait(|| live.take_news().into_iter().find(|news| *news == News::Recorded));
    let found = files("one");
    let frames = found.iter().filter(|name| name.starts_with("frame_")).count();
    assert!(frames >= 4, "{found:?}");
    assert!(found.iter().any(|name| name.starts_with("video.") || name.starts_with("animation.gif")));
    let first = image::image_dimensions(folder.path().join("one/frame_0000.png")).unwrap();
    assert_eq!(first, (64, 48));
    // Closing the window in the middle finishes the film.
    live.tell(Command::Record(folder.path().join("two")));
    wait(|| live.take_shown().filter(|shown| shown.recorded >= Some(2)));
    drop(live);
    assert!(files("two").iter().any(|name| name.starts_with("video.") || name == "animation.gif"));
    // Steps before a scene is saved are frames of it, however fast they are told.
    let (live, _) = still();
    live.tell(Command::Record(folder.path().join("steps")));
    for _ in 0..3 {
        live.tell(Command::Step);
    }
    live.tell(Command::Save(Box::new(scene()), 1, folder.path().join("saved.toml")));
    live.tell(Command::StopRecording);
    drop(live);
    let frames = files("steps").iter().filter(|name| name.starts_with("frame_")).count();
    assert_eq!(frames, 3);
    let start = Scene::load(&folder.path().join("saved.toml")).unwrap().film.start;
    // Three frames, seen a step later.
    assert!((start - 2.0 / 60.0).abs() < 1e-6, "{start}");
    // Where nothing can be written it is told, and it plays on.
    let live = Live::new(scene(), || ()).unwrap();
    std::fs::write(folder.path().join("file"), b"x").unwrap();
    live.tell(Command::Record(folder.path().join("file/three")));
    let news = wait(|| Some(live.take_news()).filter(|news| news.contains(&News::Recorded)));
    assert!(news.iter().any(|news| matches!(news, News::Error(text) if text.contains("three"))));
    assert_eq!(next(&live).recorded, None);
}

#[test]
fn a_scene_is_saved_even_when_nobody_waits_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.toml");
    let live = Live::new(scene(), || ()).unwrap();
    while next(&live).frame < 10 {}
    live.tell(Command::Save(Box::new(scene()), 1, folder.path().join("nowhere/kept.toml")));
    let refused = error(&live);
    assert!(refused.starts_with("cannot save the hair"), "{refused}");
    live.tell(Command::Save(Box::new(scene()), 1, path.clone()));
    // What comes behind it does not count, in whatever heap it is heard.
    live.tell(Command::Reset);
    drop(live);
    let saved = Scene::load(&path).unwrap();
    assert_eq!(saved.groom.pose, Some("kept.safetensors".into()));
    // Ten frames at least, shown a step behind.
    assert!(saved.film.start > 9.0 / 60.0 - 1e-6, "{}", saved.film.start);
    let live = Live::new(saved, || ()).unwrap();
    next(&live);
    live.tell(Command::Save(Box::new(scene()), 1, path.clone()));
    assert_eq!(
        wait(|| live.take_news().into_iter().find(|news| matches!(news, News::Saved(_)))),
        News::Saved(path)
    );
}
