//! Videos and scenes of hair that plays.

use strandline::{
    Change, Live, PictureSettings, Scene,
    live::{Command, LiveEvent},
};

use super::helpers::{error, next, scene, still, wait, waking};

#[test]
fn a_video_is_recorded_frame_by_frame_and_finished_when_it_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let live = Live::new(scene(), waking()).unwrap();
    next(&live);
    let files = |name: &str| {
        let list = std::fs::read_dir(folder.path().join(name)).unwrap();
        list.map(|file| file.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>()
    };
    live.send(Command::Record(folder.path().join("one")));
    // The size stays, whatever the window wants.
    live.send(Change::Picture(PictureSettings { width: 96, ..scene().picture }));
    wait(|| live.take_shown().filter(|shown| shown.recorded >= Some(4)));
    live.send(Command::StopRecording);
    wait(|| live.take_events().into_iter().find(|news| *news == LiveEvent::Recorded));
    let found = files("one");
    let frames = found.iter().filter(|name| name.starts_with("frame_")).count();
    assert!(frames >= 4, "{found:?}");
    assert!(found.iter().any(|name| name.starts_with("video.") || name.starts_with("animation.gif")));
    let first = image::image_dimensions(folder.path().join("one/frame_0000.png")).unwrap();
    assert_eq!(first, (64, 48));
    // Closing the window in the middle finishes the film.
    live.send(Command::Record(folder.path().join("two")));
    wait(|| live.take_shown().filter(|shown| shown.recorded >= Some(2)));
    drop(live);
    assert!(files("two").iter().any(|name| name.starts_with("video.") || name == "animation.gif"));
    // Steps before a scene is saved are frames of it, however fast their events come.
    let (live, _) = still();
    live.send(Command::Record(folder.path().join("steps")));
    for _ in 0..3 {
        live.send(Command::Step);
    }
    live.send(Command::Save(Box::new(scene()), 1, folder.path().join("saved.toml")));
    live.send(Command::StopRecording);
    drop(live);
    let frames = files("steps").iter().filter(|name| name.starts_with("frame_")).count();
    assert_eq!(frames, 3);
    let start = Scene::load(&folder.path().join("saved.toml")).unwrap().film.start;
    // Three frames of a film.
    assert!((start - 3.0 / 30.0).abs() < 1e-6, "{start}");
    // An unwritable folder is reported, and it plays on.
    let live = Live::new(scene(), waking()).unwrap();
    std::fs::write(folder.path().join("file"), b"x").unwrap();
    live.send(Command::Record(folder.path().join("file/three")));
    let mut events = Vec::new();
    wait(|| {
        events.extend(live.take_events());
        events.contains(&LiveEvent::Recorded).then_some(())
    });
    assert!(events.iter().any(|event| matches!(event, LiveEvent::Error(_, text) if text.contains("three"))));
    assert_eq!(next(&live).recorded, None);
}

#[test]
fn a_scene_is_saved_even_when_nobody_waits_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.toml");
    let live = Live::new(scene(), waking()).unwrap();
    while next(&live).frame < 10 {}
    live.send(Command::Save(Box::new(scene()), 1, folder.path().join("nowhere/kept.toml")));
    let refused = error(&live);
    assert!(refused.starts_with("cannot save the hair"), "{refused}");
    live.send(Command::Save(Box::new(scene()), 1, path.clone()));
    // Later commands do not count, in whatever batch they arrive.
    live.send(Change::Reset);
    drop(live);
    let saved = Scene::load(&path).unwrap();
    assert_eq!(saved.groom.pose, Some("kept_pose.npz".into()));
    // Ten frames at least, shown a step behind.
    assert!(saved.film.start > 9.0 / 60.0 - 1e-6, "{}", saved.film.start);
    let live = Live::new(saved, waking()).unwrap();
    next(&live);
    live.send(Command::Save(Box::new(scene()), 1, path.clone()));
    assert_eq!(
        wait(|| live.take_events().into_iter().find(|news| matches!(news, LiveEvent::Saved(_)))),
        LiveEvent::Saved(path)
    );
}
