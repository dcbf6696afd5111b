//! Memory and time of kept frames.

use strandline_base::Stopwatch;

use super::{MARKS, Timeline};
use crate::{Backend, Scene, live::loaded::Loaded, scene::TimelineSection};

/// A scene of 2,000 strands of 16 points whose head shakes.
fn loaded() -> Loaded {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.groom.points_per_strand) = (2000, 16);
    scene.body.spacing = 0.01;
    scene.devices = Backend::Cpu.into();
    scene.motion.name = crate::scene::MotionName::Shake;
    Loaded::new(&scene, &Box::default(), &mut None, &|_, _| {}).unwrap()
}

/// The middle one of some times \[s\].
fn middle(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

#[test]
fn keeping_frames_costs_little_of_the_simulation() {
    let mut loaded = loaded();
    let mut timeline = Timeline::new(&TimelineSection::default(), 240);
    timeline.begin(&loaded.session.held(), 0.0, None);
    let [mut simulated, mut kept, mut marked] = [Vec::new(), Vec::new(), Vec::new()];
    for frame in 0..24 {
        let watch = Stopwatch::start();
        timeline.under_way = Some(loaded.session.start_kept(0, false).unwrap());
        loaded.session.take().unwrap();
        simulated.push(watch.seconds());
        let watch = Stopwatch::start();
        if frame % 4 == 0 {
            loaded.session.with(crate::session::Simulation::bookmark).unwrap();
            marked.push(watch.seconds());
        }
        let watch = Stopwatch::start();
        timeline.add(&loaded.session.held(), 0.0, None, Vec::new());
        kept.push(watch.seconds());
    }
    let [simulated, kept, marked] = [simulated, kept, marked].map(middle);
    let share = (kept + marked / f64::from(MARKS)) / simulated;
    println!(
        "a frame {:.2} ms, kept in {:.3} ms, a bookmark {:.2} ms: {:.2} %",
        1e3 * simulated,
        1e3 * kept,
        1e3 * marked,
        1e2 * share
    );
    assert!(share < 0.03, "{share}");
}

#[test]
fn frames_of_a_usual_film_take_no_more_than_their_bound() {
    let mut loaded = loaded();
    assert_eq!(loaded.session.held().positions.len(), 250 * 16);
    let bookmark = loaded.session.with(crate::session::Simulation::bookmark).unwrap();
    let mark = bookmark.bytes();
    let mut timeline = Timeline::new(&TimelineSection::default(), 240);
    timeline.begin(&loaded.session.held(), 0.0, Some(bookmark));
    let frame = timeline.used[0] - mark;
    let film = 240 * frame + (240 / u64::from(MARKS) + 1) * mark;
    println!("{frame} bytes a frame, {mark} a bookmark, {film} a film");
    assert!(frame > 12 * 32_000 && film <= 120_000_000, "{frame} a frame, {mark} a bookmark: {film}");
}

#[test]
fn frames_beyond_the_memory_lie_on_the_disk_and_those_beyond_both_are_forgotten() {
    let mut loaded = loaded();
    let bookmark = loaded.session.with(crate::session::Simulation::bookmark).unwrap();
    let held = loaded.session.held();
    let mut positions = held.positions.to_vec();
    let mut timeline =
        Timeline::new(&TimelineSection { memory: 13, disk: 4, ..TimelineSection::default() }, 240);
    timeline.begin(&held, 0.0, Some(bookmark));
    for frame in 1..=60 {
        positions[7].x[3] = frame as f32;
        let held = crate::session::HostMoment { positions: &positions, ..held };
        assert_eq!(timeline.add(&held, 0.0, None, Vec::new()), None);
        assert!(timeline.used[0] <= 13_000_000 && timeline.used[1] <= 4_000_000, "{:?}", timeline.used);
    }
    let counted = timeline
        .frames
        .iter()
        .map(super::KeptFrame::bytes)
        .fold([0; 2], |sum, [memory, disk]| [sum[0] + memory, sum[1] + disk]);
    assert_eq!(timeline.used, counted, "what is counted is what is there");
    let shown = timeline.shown(30.0, 0.0);
    // Some 25 frames in memory beside the bookmark, and ten on the disk.
    assert!(
        shown.first > 20 && shown.first < 30 && shown.last == 60 && timeline.used[1] > 3_000_000,
        "{shown:?}"
    );
    for number in [shown.first, shown.first + 9, 59, 60] {
        let points = timeline.frame(number).unwrap().points.clone().unwrap();
        positions[7].x[3] = number as f32;
        assert!(*points.read().unwrap() == positions[..], "frame {number}");
    }
    assert!(timeline.frame(shown.first - 1).is_none() && timeline.frame(61).is_none());
    // The way to a frame begins at a bookmark, though the frame there is forgotten.
    timeline.playhead = 40;
    timeline.invalidate();
    assert_eq!((timeline.good, timeline.from(), timeline.nearest(3)), (40, 40, shown.first));
    assert!(timeline.good_frame(41).is_none() && timeline.frame(41).is_some());
}
