//! Odd motions, and what is said of them.

use super::*;
use strandline::{
    Jump,
    scene::{Interpolation, KeyframeSection},
};

/// The bust in memory, 0.3 m aside from 0.2 s on, with one vertex of its chest far beyond all places.
fn aside() -> (Scene, Sources) {
    let mesh = Mesh::load(&bust(), 1.0).unwrap();
    let mut beside: Vec<Vec3> = mesh.positions.iter().map(|place| *place + Vec3::X * 0.3).collect();
    let height = |vertex: &usize| mesh.positions[*vertex].y;
    let lowest = (0..beside.len()).min_by(|one, other| height(one).total_cmp(&height(other))).unwrap();
    beside[lowest] = Vec3::splat(1e9);
    let motion = VertexMotion::sampled(vec![0.1, 0.2], vec![mesh.positions.clone(), beside]).unwrap();
    let mut memory = scene("nod");
    (memory.body.file, memory.body.clip) = (Some("bust".into()), None);
    memory.body.teleports = vec![TeleportSection { time: 0.2 }];
    memory.film.frames = 16;
    (memory, Sources::default().with_mesh("bust", mesh).with_motion("bust", motion))
}

#[test]
fn jumps_are_listed_and_vertices_at_no_place_are_told_once() {
    let (scene, sources) = aside();
    let mut player = Player::from_sources(&scene, &sources, scene.devices, false).unwrap();
    let mut notes = Vec::new();
    for event in player.by_ref() {
        if let Event::Note(note) = event.unwrap() {
            notes.push(note);
        }
    }
    let held: Vec<_> = notes.iter().filter(|note| note.contains("at no finite place")).collect();
    assert_eq!(
        held,
        ["1 vertex of the body is at no finite place within 1,000 km at 0.20 s: held as at rest"]
    );
    let jumps = player.jumps();
    let [Jump { time, what }] = &jumps[..] else { panic!("one jump: {jumps:?}") };
    assert!((time - 0.2).abs() < 0.009, "{time}");
    assert!(what.contains("jumps by 0.30 m and 0 degrees, as marked"), "{what}");
}

/// A head that turns between two samples of 24 in a second, in frames of 1/120 s: by half a turn, which rigs flip, and by as
/// much as a person who shakes it does at 20 rad/s.
#[test]
fn a_turn_between_two_samples_is_a_jump_where_frames_are_finer() {
    let mesh = Mesh::load(&bust(), 1.0).unwrap();
    let played = |degrees: f32| {
        let turn = Quat::from_rotation_y(degrees.to_radians());
        let turned = mesh.positions.iter().map(|place| turn * *place).collect();
        let times = vec![0.1, 0.1 + 1.0 / 24.0];
        let motion = VertexMotion::sampled(times, vec![mesh.positions.clone(), turned]).unwrap();
        let sources = Sources::default().with_mesh("bust", mesh.clone()).with_motion("bust", motion);
        let mut memory = scene("nod");
        (memory.body.file, memory.body.clip) = (Some("bust".into()), None);
        memory.film.frames_per_second = 120.0;
        let mut hair = Hair::from_sources(&memory, &sources).unwrap();
        let mut fastest = 0.0_f32;
        for frame in 0..24 {
            let reports = hair.play(frame).unwrap();
            fastest = reports.iter().map(|report| report.speed_max).fold(fastest, f32::max);
        }
        (fastest, hair.take_notes().join("\n"))
    };
    let (carried, notes) = played(180.0);
    assert!(notes.contains("and 180 degrees: hair is carried with it"), "{notes}");
    assert!(carried < 0.5, "{carried} m/s");
    let (pulled, notes) = played(48.0);
    assert!(!notes.contains("jumps") && pulled > 1.0, "{pulled} m/s: {notes}");
}

#[test]
fn a_loop_that_does_not_close_is_told() {
    let notes = |change: fn(&mut Scene)| {
        let mut loops = scene("nod");
        loops.body.r#loop = true;
        change(&mut loops);
        Prepared::new(&loops).unwrap().notes.join("\n")
    };
    assert!(!notes(|_| {}).contains("body.loop"), "the clip ends where it begins");
    let folder = tempfile::tempdir().unwrap();
    let mesh = Mesh::load(&bust(), 1.0).unwrap();
    for frame in 0..3 {
        write_obj(&folder.path().join(format!("walk{frame:04}.obj")), &mesh, 0.1 * frame as f32);
    }
    let mut walks = scene("nod");
    (walks.body.clip, walks.body.file, walks.body.r#loop) =
        (None, Some(folder.path().join("walk%04d.obj")), true);
    walks.body.scale = strandline::format::Scale::Factor(1.0);
    let open = Prepared::new(&walks).unwrap().notes.join("\n");
    assert!(open.contains("body.loop: the motion ends 20.0 cm from where it begins"), "{open}");
    walks.body.teleports = vec![TeleportSection { time: 0.0 }];
    let marked = Prepared::new(&walks).unwrap().notes.join("\n");
    assert!(!marked.contains("body.loop"), "{marked}");
}

/// Motion of the head that a scene file without `motion.name` gets beside its body.
#[test]
fn a_body_that_moves_is_not_shaken_unless_the_scene_says_so() {
    let name = |body: &str, motion: &str| {
        let text = format!(
            "[style]\nstyle = \"bob\"\nstrand_count = 40\n[groom]\nbound = 0\n[body]\nspacing = 0.02\nfile = '{}'\n{body}\n{motion}",
            bust().display()
        );
        Prepared::new(&Scene::parse(&text, "a test").unwrap()).unwrap().scene.motion.name
    };
    assert_eq!(name("clip = \"smile\"", ""), MotionName::Still);
    assert_eq!(name("clip = \"smile\"", "[motion]\nname = \"shake\""), MotionName::Shake);
    let part = format!("[[body.parts]]\nfile = '{}'\nclip = \"smile\"", bust().display());
    assert_eq!(name("", &part), MotionName::Still, "a part that moves");
    assert_eq!(name("", ""), MotionName::Shake, "a body that rests");
    let (mut scene, sources) = aside();
    scene.motion.name = MotionName::Shake;
    assert_eq!(Prepared::from_sources(&scene, &sources).unwrap().scene.motion.name, MotionName::Still);
    scene.set_motion(MotionName::Shake);
    assert_eq!(Prepared::from_sources(&scene, &sources).unwrap().scene.motion.name, MotionName::Shake);
}

/// A built-in bust that drives evenly: frames of 1/24 s hold two or three steps of 1/60 s, those of 1/50 s one or two.
#[test]
fn an_even_motion_slower_than_a_jump_is_none_at_any_frame_rate() {
    let jumps = |speed: f32, rate: f32| {
        let mut drives = scene("nod");
        (drives.body.clip, drives.body.file, drives.motion.name) = (None, None, MotionName::Keyframes);
        drives.motion.interpolation = Interpolation::Linear;
        let key = |time: f64| KeyframeSection {
            time,
            translation: time as f32 * speed * Vec3::X,
            ..Default::default()
        };
        drives.motion.keyframes = vec![key(0.0), key(1.0)];
        drives.film.frames_per_second = rate;
        let mut hair = Hair::open(&drives).unwrap();
        (0..8).for_each(|frame| drop(hair.play(frame).unwrap()));
        hair.take_notes().iter().filter(|note| note.contains("jumps by")).count()
    };
    assert_eq!([jumps(22.0, 24.0), jumps(16.0, 50.0)], [0, 0], "slower than 25 m/s");
    assert!(jumps(27.0, 24.0) > 0, "the threshold stands");
}
