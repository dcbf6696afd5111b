//! Projects: a folder with a scene and its kept frames, from which the hair goes on.

use std::path::Path;

use strandline::{
    Change, Live, Scene, Settings,
    live::{Command, LiveEvent, Shown},
};

use super::helpers::{settled, wait};
use super::timeline::{breeze, exported, paused, points, seek, shaken, steps};

/// A scene of few strands of a file, which is written beside the folder of the project.
fn scene_of_file(folder: &Path) -> Scene {
    let mut scene = shaken();
    scene.style.strand_count = 12;
    let groom = folder.join("few.hair");
    scene.style.grow().unwrap().save(&groom).unwrap();
    scene.groom.file = Some(groom);
    scene.body.spacing = 0.02;
    scene.simulation.volume.enabled = false;
    scene
}

/// Saves the project of what plays, whose scene was loaded first.
fn save(live: &Live, scene: &Scene, folder: &Path) {
    live.send(Command::SaveProject(Box::new(scene.clone()), 1, folder.to_owned()));
    wait(|| {
        live.take_events().into_iter().find_map(|news| match news {
            LiveEvent::Saved(path) => {
                assert_eq!(path, folder);
                Some(())
            }
            LiveEvent::Error(_, error) => panic!("{error}"),
            _ => None,
        })
    });
}

/// A project that stands still, with what is told of it.
fn opened(folder: &Path) -> (Live, Vec<String>) {
    let live = paused(Scene::load(folder).unwrap());
    let told = live.take_events().into_iter().find_map(|news| match news {
        LiveEvent::Loaded(_, scene, _, _, notes) => {
            assert_eq!(scene.timeline.frames, None, "a scene that is saved next has frames of its own");
            Some(notes)
        }
        LiveEvent::NotLoaded(_, _, error) => panic!("{error}"),
        _ => None,
    });
    (live, told.unwrap())
}

/// The scene that was loaded, with what it left open chosen to fit its groom.
fn fitted(live: &Live) -> Scene {
    let found = live.take_events().into_iter().find_map(|news| match news {
        LiveEvent::Loaded(_, scene, ..) => Some(*scene),
        _ => None,
    });
    found.unwrap()
}

fn said(notes: &[String], words: &str) -> bool {
    notes.iter().any(|note| note.contains(words))
}

/// Plays ten frames, changes wind, stiffness and length, and plays up to 16.
fn swing(live: &Live, scene: &mut Scene) {
    steps(live, 6);
    if let Change::Wind(wind) = breeze() {
        scene.wind = wind;
    }
    live.send(breeze());
    steps(live, 4);
    // A slider that is dragged leaves many settings before one frame.
    for tick in 0..60 {
        let damping = 0.05 + 0.01 * tick as f32;
        live.send(Change::Settings(Box::new(Settings { damping, ..scene.simulation.clone() })));
    }
    scene.simulation.damping = 2.0 * scene.simulation.damping.max(0.1);
    scene.groom.length = 0.9;
    live.send(Change::Settings(Box::new(scene.simulation.clone())));
    live.send(Change::Length(scene.groom.length));
    steps(live, 6);
}

#[test]
fn a_project_has_its_frames_at_once_and_goes_on_with_the_same_bits() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name);
    let mut scene = shaken();
    // A step that does not divide a frame, of which some are under way.
    scene.simulation.time_step = 1.0 / 70.0;
    let live = paused(scene.clone());
    swing(&live, &mut scene);
    save(&live, &scene, &path("project"));
    exported(&live, &scene, &path("before.npz"), [1, 16]);
    let shown = settled_at(&live, 16);
    // The run that was not interrupted.
    steps(&live, 5);
    exported(&live, &scene, &path("whole.npz"), [1, 21]);
    drop(live);

    let (again, notes) = opened(&path("project"));
    assert!(said(&notes, "17 kept frames are read"), "{notes:?}");
    let first = seek(&again, 16);
    assert_eq!((first.timeline.first, first.timeline.good, first.timeline.last), (0, 16, 16));
    assert!(first.picture == shown.picture, "the last frame shows something else");
    exported(&again, &scene, &path("kept.npz"), [1, 16]);
    assert!(points(&path("kept.npz")) == points(&path("before.npz")));
    steps(&again, 5);
    exported(&again, &scene, &path("on.npz"), [1, 21]);
    let (on, whole) = (points(&path("on.npz")), points(&path("whole.npz")));
    assert!(on[..16] == whole[..16] && on[16..] == whole[16..], "it goes on with other bits");
    // From a frame before the changes it goes on too: their tasks are repeated.
    seek(&again, 8);
    again.send(Change::Settings(Box::new(Settings { damping: 0.5, ..scene.simulation.clone() })));
    let later = steps(&again, 3);
    assert_eq!((later.timeline.playhead, later.timeline.good), (11, 11));
}

fn settled_at(live: &Live, frame: u32) -> Shown {
    seek(live, frame - 1);
    seek(live, frame)
}

#[test]
fn frames_of_other_hair_or_another_motion_are_left_out_with_the_reason() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("project");
    let scene = scene_of_file(home.path());
    let live = paused(scene.clone());
    let fitted = fitted(&live);
    steps(&live, 3);
    // A scene of a person's own is not written over, a project is.
    let own = home.path().join("own");
    std::fs::create_dir(&own).unwrap();
    std::fs::write(own.join("scene.toml"), "# mine\n").unwrap();
    live.send(Command::SaveProject(Box::new(fitted.clone()), 1, own.clone()));
    let refused = wait(|| {
        live.take_events().into_iter().find_map(|news| match news {
            LiveEvent::Error(_, error) => Some(error.to_string()),
            LiveEvent::Saved(_) => panic!("written over"),
            _ => None,
        })
    });
    assert!(refused.contains("choose another folder"), "{refused}");
    assert_eq!(std::fs::read(own.join("scene.toml")).unwrap(), b"# mine\n");
    (0..2).for_each(|_| save(&live, &fitted, &folder));
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 2, "nothing temporary is left");
    drop(live);
    let text = std::fs::read_to_string(folder.join("scene.toml")).unwrap();
    assert!(text.contains("file = \"../few.hair\""), "its paths start from the folder");
    let last = |live: &Live| settled_seek(live).timeline.last;
    let (live, notes) = opened(&folder);
    assert!(said(&notes, "4 kept frames") && last(&live) == 3, "{notes:?}");
    // A look moves no hair.
    let greyer = text.replace("grey = 0.0", "grey = 0.5");
    assert_ne!(greyer, text);
    std::fs::write(folder.join("scene.toml"), &greyer).unwrap();
    assert!(said(&opened(&folder).1, "4 kept frames"));
    let other = text.replace("\nfriction = ", "\nfriction = 0.0 # ");
    assert_ne!(other, text);
    std::fs::write(folder.join("scene.toml"), &other).unwrap();
    let (live, notes) = opened(&folder);
    assert!(said(&notes, "kept frames are left out") && said(&notes, "friction = 0.0 (was "), "{notes:?}");
    assert_eq!(last(&live), 0);
    std::fs::write(folder.join("scene.toml"), &text).unwrap();
    let mut other = scene.style.clone();
    other.seed += 1;
    other.grow().unwrap().save(home.path().join("few.hair")).unwrap();
    let (live, notes) = opened(&folder);
    assert!(said(&notes, "left out") && said(&notes, "the content of few.hair"), "{notes:?}");
    assert_eq!(last(&live), 0);
}

fn settled_seek(live: &Live) -> Shown {
    live.send(Command::Seek(u32::MAX));
    settled(live)
}

#[test]
fn damaged_frames_are_refused_and_the_scene_opens_without_them() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("project");
    let mut scene = scene_of_file(home.path());
    // Without a body it opens quickly.
    (scene.body.visible, scene.film.settle) = (false, 0.0);
    let live = paused(scene.clone());
    steps(&live, 2);
    save(&live, &fitted(&live), &folder);
    drop(live);
    let file = folder.join("frames.npz");
    let good = std::fs::read(&file).unwrap();
    let scene = Scene::load(&folder).unwrap();
    let live = paused(scene.clone());
    let told = |live: &Live, bytes: &[u8]| {
        std::fs::write(&file, bytes).unwrap();
        live.send(Command::Load(Box::new(scene.clone())));
        wait(|| {
            live.take_events().into_iter().find_map(|news| match news {
                LiveEvent::Loaded(.., notes) => Some(notes),
                LiveEvent::NotLoaded(_, _, error) => panic!("{error}"),
                _ => None,
            })
        })
    };
    live.take_events();
    assert!(said(&told(&live, &good), "3 kept frames"));
    let layout = good.windows(10).position(|words| words == b"\"layout\":1").unwrap();
    let mut newer = good.clone();
    newer[layout + 9] = b'2';
    // Hair that this version grows otherwise.
    let rest = good.windows(7).position(|words| words == b"\"rest\":").unwrap() + 7;
    let mut other = good.clone();
    let digit = rest + good[rest..].iter().position(|byte| *byte == b',').unwrap() - 1;
    other[digit] = b'0' + (other[digit] - b'0' + 1) % 10;
    let damaged = told(&live, &other).join(" ");
    // The message has the checksum of the file's part as it is and as it should be.
    let mut sums =
        damaged.split("checksum 0x").skip(1).map(|rest| u32::from_str_radix(&rest[..8], 16).unwrap());
    let [now, before] = [sums.next().unwrap(), sums.next().unwrap()].map(u32::to_le_bytes);
    let places: Vec<usize> = (0..other.len() - 3).filter(|at| other[*at..at + 4] == before).collect();
    places.into_iter().for_each(|at| other[at..at + 4].copy_from_slice(&now));
    let notes = told(&live, &other);
    assert!(said(&notes, "of another shape at rest"), "{notes:?}");
    let cases = [&good[..good.len() / 2], &[], b"PK nothing", &newer];
    for bytes in cases {
        let notes = told(&live, bytes);
        assert!(said(&notes, "kept frames are left out"), "{notes:?}");
    }
    let mut refused = 0;
    for number in 0..200_usize {
        let mut bad = good.clone();
        let at = number * 7919 % bad.len();
        bad[at] ^= 1 << (number % 8);
        refused += usize::from(said(&told(&live, &bad), "left out"));
    }
    // Bytes between the arrays are of no use.
    assert!(refused > 120, "{refused} of 200");
    assert!(said(&told(&live, &good), "3 kept frames"));
}
