//! The timeline: frames that are kept, shown again, made stale, gone on from and exported.

use std::path::Path;

use glam::Vec3;
use strandline::{
    Cache, Change, Live, OutSettings, Picture, Player, Scene,
    live::{Command, LiveClock, LiveEvent, Pace, Shown},
    scene::{MotionName, MotionSection, WindSection},
};

use super::helpers::{error, scene, settled, wait, waking};

/// A scene that stands still, with a head that shakes in the wind.
pub fn shaken() -> Scene {
    let mut scene = scene();
    scene.motion.name = MotionName::Shake;
    scene.wind.velocity = Vec3::new(2.0, 0.0, 1.0);
    scene.wind.gust = 0.5;
    (scene.picture.width, scene.picture.height) = (32, 24);
    scene
}

pub fn paused(scene: Scene) -> Live {
    let live = Live::new(scene, waking()).unwrap();
    live.send(Command::Play(false));
    live.wait_idle();
    live
}

/// The picture after so many further frames, one after the other.
pub fn steps(live: &Live, frames: u32) -> Shown {
    for _ in 0..frames {
        live.send(Command::Step);
    }
    settled(live)
}

pub fn seek(live: &Live, frame: u32) -> Shown {
    live.send(Command::Seek(frame));
    settled(live)
}

pub fn breeze() -> Change {
    Change::Wind(WindSection { velocity: Vec3::new(-6.0, 0.0, 2.0), ..WindSection::default() })
}

/// Points of every frame of a cache.
pub fn points(path: &Path) -> Vec<Vec<Vec3>> {
    let mut cache = Cache::open(path).unwrap();
    let mut points = Vec::new();
    (0..cache.len())
        .map(|frame| {
            cache.read(frame, &mut points).unwrap();
            points.clone()
        })
        .collect()
}

pub fn exported(live: &Live, scene: &Scene, path: &Path, frames: [u32; 2]) {
    live.send(Command::Export(Box::new(scene.clone()), OutSettings::new(path), frames));
    let written = wait(|| {
        live.take_events().into_iter().find_map(|news| match news {
            LiveEvent::Exported(written) => Some(written),
            LiveEvent::Error(_, error) => panic!("{error}"),
            _ => None,
        })
    });
    assert_eq!(written.frames as u32, frames[1] - frames[0] + 1);
}

#[test]
fn sixty_frames_of_a_window_have_the_points_of_the_film_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = shaken();
    (scene.film.frames, scene.simulation.time_step) = (60, 1.0 / 50.0);
    let path = |name: &str| folder.path().join(name);
    let mut player = Player::new(&scene, scene.devices, false).unwrap();
    player.set_out(&OutSettings::new(path("film.npz"))).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    player.close_out().unwrap();
    let live = paused(scene.clone());
    let shown = steps(&live, 60);
    assert_eq!((shown.timeline.playhead, shown.timeline.good, shown.timeline.film_end), (60, 60, 60));
    exported(&live, &scene, &path("window.npz"), [1, 60]);
    let (film, window) = (points(&path("film.npz")), points(&path("window.npz")));
    assert_eq!(film.len(), 60);
    let moved = film[59].iter().zip(&film[30]).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
    assert!(moved > 0.01, "nothing moves: {moved} m");
    assert!(film == window, "the window plays something else");
    // A part of them, and none that is not kept.
    exported(&live, &scene, &path("part.npz"), [20, 30]);
    assert!(points(&path("part.npz")) == film[19..30]);
    live.send(Command::Export(Box::new(scene), OutSettings::new(path("no.npz")), [50, 61]));
    assert!(error(&live).contains("1 is lacking"));
}

#[test]
fn kept_frames_are_shown_as_they_were_without_a_step() {
    let live = paused(shaken());
    let pictures: Vec<Picture> = (0..12).map(|_| steps(&live, 1).picture).collect();
    for frame in [3, 12, 1, 7] {
        let shown = seek(&live, frame);
        assert_eq!(shown.timeline.playhead, frame);
        assert!(shown.picture == pictures[frame as usize - 1], "frame {frame} is another");
        assert!(shown.step.is_none(), "frame {frame} was simulated");
    }
    assert_eq!(seek(&live, 99).timeline.playhead, 12, "the nearest that is kept");
    // Steps over kept frames show them, and those after the last are simulated.
    seek(&live, 10);
    assert!(steps(&live, 2).picture == pictures[11]);
    let shown = steps(&live, 1);
    assert!(shown.step.is_some() && shown.timeline.good == 13);
}

#[test]
fn a_change_makes_stale_what_comes_after_it_and_the_hair_goes_on_from_there() {
    let mut all = paused(shaken());
    let before = seek_after(&all, 9, 5);
    all.send(breeze());
    let shown = settled(&all).timeline;
    assert_eq!((shown.good, shown.last, shown.playhead), (5, 9, 5));
    let gone_on: Vec<Picture> = (0..6).map(|_| steps(&all, 1).picture).collect();
    assert!(seek(&all, 5).picture == before);
    // As if nothing had come after the fifth.
    let one = paused(shaken());
    assert!(steps(&one, 5).picture == before);
    one.send(breeze());
    for (frame, picture) in gone_on.iter().enumerate() {
        assert!(steps(&one, 1).picture == *picture, "frame {}", frame + 6);
    }
    // Settings, length and a hand likewise, over a change that came before.
    all = one;
    seek(&all, 8);
    let stiff = Change::Settings(Box::new(strandline::Settings { damping: 30.0, ..scene().simulation }));
    all.send(stiff);
    all.send(Change::Length(0.7));
    let again = steps(&all, 3).picture;
    assert!(again != gone_on[5]);
    // The way back to a frame repeats the changes before it.
    seek(&all, 10);
    all.send(breeze());
    assert!(steps(&all, 1).picture == again);
    // Back over the changes and on again: they stay.
    seek(&all, 2);
    assert!(steps(&all, 9).picture == again, "kept frames");
    seek(&all, 2);
    all.send(breeze());
    let other = steps(&all, 9).picture;
    assert!(other != again && other != gone_on[5]);
    assert_eq!(settled_timeline(&all), (11, 11));
}

/// Steps, then goes back: the picture there.
fn seek_after(live: &Live, frames: u32, back: u32) -> Picture {
    steps(live, frames);
    seek(live, back).picture
}

fn settled_timeline(live: &Live) -> (u32, u32) {
    let timeline = seek(live, u32::MAX).timeline;
    (timeline.good, timeline.last)
}

#[test]
fn looks_and_views_make_nothing_stale_and_a_reset_begins_anew() {
    let live = paused(shaken());
    steps(&live, 6);
    seek(&live, 2);
    live.send(Change::Camera(strandline::Camera::back()));
    live.send(Change::Lights(Vec::new()));
    live.send(Change::Look(Box::new(scene().look)));
    assert_eq!(settled(&live).timeline.good, 6);
    live.send(Change::Reset);
    let timeline = settled(&live).timeline;
    assert_eq!((timeline.playhead, timeline.last), (0, 0));
    live.send(Change::Motion(Box::new(MotionSection { name: MotionName::Nod, ..scene().motion })));
    assert_eq!(steps(&live, 2).timeline.good, 2);
}

#[test]
fn it_plays_in_a_loop_at_its_own_speed_by_the_clock() {
    let clock = LiveClock::manual();
    let live = Live::with_clock(shaken(), waking(), clock.clone()).unwrap();
    live.send(Command::Play(false));
    live.wait_idle();
    steps(&live, 10);
    live.send(Command::Pace(Pace::OwnSpeed));
    live.send(Command::Range([Some(3), Some(6)], true));
    seek(&live, 3);
    live.send(Command::Play(true));
    let playhead =
        |at: u32| wait(|| live.take_shown().filter(|shown| shown.timeline.playhead == at)).timeline.playhead;
    // The first at once, the others a thirtieth of a second apart, and round again.
    playhead(4);
    for frame in [5, 6, 3, 4] {
        assert!(live.take_shown().is_none());
        clock.advance(std::time::Duration::from_secs_f64(1.0 / 30.0 + 1e-6));
        playhead(frame);
    }
}

#[test]
fn a_refused_change_is_told_once_and_the_accepted_one_before_it_stays_on_the_way_back() {
    let (refusing, plain) = (paused(shaken()), paused(shaken()));
    let mut settings = shaken().simulation;
    settings.gravity *= 0.5;
    for live in [&refusing, &plain] {
        steps(live, 3);
        live.send(Change::Settings(Box::new(settings.clone())));
        live.send(Change::Length(1.5));
    }
    // Refused, both: the way back must neither ask for them again nor forget those before them.
    settings.strands.constrain.iterations = 0;
    refusing.send(Change::Settings(Box::new(settings)));
    refusing.send(Change::Length(2.5));
    for frame in [2, 1] {
        let pictures = [&refusing, &plain].map(|live| {
            seek(live, frame);
            // Frames after this one are simulated anew.
            live.send(breeze());
            steps(live, 2).picture
        });
        assert!(pictures[0] == pictures[1], "after frame {frame}");
    }
    let errors = |live: &Live| {
        let events = live.take_events();
        events.iter().filter(|event| matches!(event, LiveEvent::Error(..))).count()
    };
    assert_eq!((errors(&refusing), errors(&plain)), (2, 0));
}
