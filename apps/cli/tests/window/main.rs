//! The window on a display without a screen, drawn by whatever adapter there is: the system's side of it. Panels and
//! their controls are tested in apps/viewer/tests/window, without a display.

#![allow(clippy::print_stdout)] // it tells what is not tested, and how long opening took

mod display;
mod drop;
mod random_use;

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use display::{Display, Person, Screen};
use strandline::settings::StyleSettings;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConfigureWindowAux, ConnectionExt};

/// A scene that is drawn in no time. Its film has one frame, before anything has moved.
const SCENE: &str = r#"
motion.name = "still"
groom.points_per_strand = 10
style = { style = "long", strand_count = 400 }
body.spacing = 0.008
look = { preset = "thesis", follow_strands = 4, hair_count = 20000 }
simulation = { backend = "cpu", damping = 2.0, volume.cells = [12, 12, 12] }
picture.backend = "cpu"
film = { frames = 1, settle = 0.0, frames_per_second = 1000.0 }
"#;

/// The picture's part of the window \[left, top, right, bottom\], without tools, messages and the wind's dial.
const STAGE: [usize; 4] = [320, 60, 1150, 560];
/// Rectangle of messages.
const MESSAGES: [usize; 4] = [305, 560, 1150, 765];

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("small.toml"), SCENE).unwrap();
    let path = folder.path().to_owned();
    (folder, path)
}

/// True if there is a picture: its background is brighter than an empty window.
fn has_picture(screen: &Screen) -> bool {
    let [red, green, blue] = screen.at(STAGE[0], STAGE[1]);
    red.min(green).min(blue) > 80
}

/// Pixels that are hair: brown, not as bright as skin.
fn hair(screen: &Screen, place: [usize; 4]) -> usize {
    screen.count(place, |[red, _, blue]| red < 170 && i16::from(red) - i16::from(blue) > 24)
}

/// Opens the small scene and waits for its picture.
fn open(display: &Display, folder: &Path) -> Person {
    let mut person = display.open(folder, &["view", "small.toml"]);
    person.see("a picture with hair", |screen| has_picture(screen) && hair(screen, STAGE) > 5000);
    println!("the first picture after {:.2} s", person.begin.elapsed().as_secs_f64());
    person.focus();
    person
}

/// Waits until next to nothing moves any more, for longer than a picture takes on a busy machine.
fn rest(person: &mut Person) -> Screen {
    let (mut last, mut quiet) = (person.screen(), 0);
    person.wait("rest", |person| {
        std::thread::sleep(std::time::Duration::from_millis(500));
        let now = person.screen();
        quiet = if now.changed(&last, STAGE) < 400 { quiet + 1 } else { 0 };
        last = now.clone();
        (quiet == 4).then_some(now)
    })
}

#[test]
fn it_opens_plays_turns_its_view_and_closes() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    std::fs::write(folder.join("small.toml"), SCENE.replace("\"still\"", "\"nod\"")).unwrap();
    let mut person = open(&display, &folder);
    let first = person.screen();
    person.see("the head nods", |screen| screen.changed(&first, STAGE) > 2000);
    person.point([700, 300]);
    person.key(0x20);
    let paused = rest(&mut person);

    // The mouse goes around the head, and a key goes back.
    person.drag(&[[900, 200], [1000, 200]]);
    person.see("another view", |screen| screen.changed(&paused, STAGE) > 5000);
    person.key(0x66);
    person.see("the first view", |screen| screen.changed(&paused, STAGE) < 500);
    assert!(person.close().success());
}

#[test]
fn files_are_dropped_and_a_bad_one_says_so_while_the_old_hair_stays() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let mut person = open(&display, &folder);
    let still = rest(&mut person);

    let bad = folder.join("bad.hair");
    std::fs::write(&bad, b"PK nothing").unwrap();
    person.drop_file(&bad);
    let red = |screen: &Screen| screen.count(MESSAGES, |pixel| pixel == [255, 128, 128]);
    // A picture that was simpler while it moved may be finer by then, which changes fewer pixels than other hair.
    person.see("the error and the old hair", |screen| {
        red(screen) > 50 && screen.changed(&still, STAGE) < 12_000
    });

    let groom = folder.join("pixie.hair");
    let style = StyleSettings::new(strandline::Style::Pixie);
    StyleSettings { strand_count: 150, ..style }.grow().unwrap().save(&groom).unwrap();
    person.drop_file(&groom);
    person.see("short hair and no error", |screen| {
        red(screen) == 0 && has_picture(screen) && screen.changed(&still, STAGE) > 20_000
    });
    assert!(person.close().success());
}

#[test]
fn it_remembers_its_window() {
    use x11rb::connection::Connection;
    use x11rb::protocol::xproto::{ConfigureWindowAux, ConnectionExt};
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let person = open(&display, &folder);
    let smaller = ConfigureWindowAux::new().width(900).height(600);
    person.connection.configure_window(person.window, &smaller).unwrap();
    person.connection.flush().unwrap();
    std::thread::sleep(std::time::Duration::from_secs(2));
    assert!(person.close().success());
    let person = display.open(&folder, &["view", "small.toml"]);
    let found = person.connection.get_geometry(person.window).unwrap().reply().unwrap();
    assert_eq!([found.width, found.height], [900, 600]);
    assert!(person.close().success());
}

#[test]
fn it_may_be_wider_than_three_screens() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let mut person = open(&display, &folder);
    for width in [8193, 11_520, 1280] {
        let size = ConfigureWindowAux::new().width(width).height(300);
        person.connection.configure_window(person.window, &size).unwrap();
        person.connection.flush().unwrap();
        // It is drawn at its new size some times.
        std::thread::sleep(std::time::Duration::from_secs(2));
        assert!(person.is_open(), "it ended at {width} pixels");
    }
}

#[test]
fn a_library_that_is_missing_is_named_with_its_package() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    // Nothing that could be loaded, in a folder that the loader looks into first.
    for name in ["libxkbcommon-x11.so.0", "libxkbcommon-x11.so"] {
        std::fs::write(folder.join(name), b"").unwrap();
    }
    let run = |arguments: &[&str]| {
        let mut program = display.program(&folder, arguments);
        program.env("LD_LIBRARY_PATH", &folder);
        program
    };
    let output = run(&["view", "small.toml"]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    for word in ["the library libxkbcommon-x11.so.0", "libxkbcommon-x11-0", "strandline render"] {
        assert!(error.contains(word), "`{word}` is missing: {error}");
    }
    assert!(!error.contains("panicked"), "{error}");
    // Without a command the demo takes over.
    let mut demo = run(&[]).stdout(std::process::Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(demo.stdout.take().unwrap()).lines();
    let shown = lines.find(|line| line.as_ref().is_ok_and(|line| line.contains("strandline demo:")));
    demo.kill().unwrap();
    demo.wait().unwrap();
    assert!(shown.is_some(), "the demo does not take over");
}
