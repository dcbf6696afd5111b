//! The window as a person uses it: on a display without a screen, drawn by whatever adapter there is.

#![allow(clippy::print_stdout)] // it tells what is not tested, and how long opening took

mod display;
mod drop;
mod random_use;

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Command;

use display::{CONTROL, Display, Person, Screen};
use strandline::{Picture, settings::StyleSettings};
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
/// The slider of the strands' length where they are as groomed and where they are short, as the panel is laid out.
const LENGTH: [[i16; 2]; 2] = [[76, 380], [40, 380]];

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

fn load(path: &Path) -> Picture {
    let image = image::open(path).unwrap().into_rgb8();
    Picture { width: image.width(), height: image.height(), pixels: image.into_raw(), alpha: None }
}

#[test]
fn it_opens_plays_changes_and_closes() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let mut person = open(&display, &folder);
    let still = rest(&mut person);

    // A nod moves the picture, and the space bar stops it.
    person.click([146, 173]);
    person.see("the head nods", |screen| screen.changed(&still, STAGE) > 2000);
    person.point([700, 300]);
    person.key(0x20);
    let paused = rest(&mut person);

    // A slider: shorter hair covers less.
    let long = hair(&paused, STAGE);
    person.drag(&LENGTH);
    person.see("shorter hair", |screen| hair(screen, STAGE) < long * 8 / 10);
    person.drag(&[LENGTH[1], LENGTH[0]]);
    rest(&mut person);

    // The mouse goes around the head.
    let before = person.screen();
    person.drag(&[[900, 200], [1000, 200]]);
    person.see("another view", |screen| screen.changed(&before, STAGE) > 5000);
    person.key(0x66);
    person.see("the first view", |screen| screen.changed(&before, STAGE) < 500);
    assert!(person.close().success());
}

#[test]
fn hair_is_grabbed_and_the_wind_is_dragged() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let mut person = open(&display, &folder);
    let still = rest(&mut person);
    // The lower end of the hair on the left, and where it is pulled to.
    let beside = [320, 200, 500, 400];
    assert_eq!(hair(&still, beside), 0);
    let place = (400..560).rev().find_map(|y| {
        let x = (STAGE[0]..700).find(|x| hair(&still, [*x, y, x + 12, y + 12]) > 100)?;
        Some([x as i16 + 8, y as i16])
    });
    person.key_down(CONTROL);
    person.hold(&[place.expect("hair on the left"), [400, 300]]);
    person.key_up(CONTROL);
    // Two thin strands are enough; the circle that marks the hand has some 200 pixels.
    person.see("hair is pulled aside", |screen| screen.changed(&still, beside) > 600);
    person.release(1);
    person.see("it falls back", |screen| screen.changed(&still, beside) < 50);

    person.drag(&[[1216, 695], [1180, 690]]);
    person.see("the wind blows", |screen| screen.changed(&still, STAGE) > 2000);
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
    let shown = person.see("the error", |screen| red(screen) > 50);
    assert!(shown.changed(&still, STAGE) < 3000, "the old hair stays");

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
fn a_saved_scene_makes_the_picture_that_was_saved() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let mut person = open(&display, &folder);
    person.drag(&[LENGTH[0], [80, 380]]);
    person.drag(&[[900, 200], [860, 190]]);
    // Turned by hand, and stopped in the middle of a nod.
    person.drag(&[[76, 219], [90, 219]]);
    let still = rest(&mut person);
    person.click([146, 173]);
    person.see("the head nods", |screen| screen.changed(&still, STAGE) > 2000);
    person.point([700, 300]);
    person.key(0x20);
    assert!(rest(&mut person).changed(&still, STAGE) > 2000);
    person.with_control(0x73);
    person.with_control(0x70);
    let out = folder.join("out");
    let seen = out.join("view_000.png");
    person.wait("both files", |_| (seen.exists() && out.join("view_000.toml").exists()).then_some(()));
    // The picture is written whole under its name.
    let seen = load(&seen);
    assert!(person.close().success());

    let render = ["render", "--scene", "out/view_000.toml", "--out", "again"];
    let output =
        Command::new(env!("CARGO_BIN_EXE_strandline")).args(render).current_dir(&folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let again = load(&folder.join("again/frame_0000.png"));
    assert!(again == seen, "a FLIP of 0.01 is promised; on the CPU nothing differs");
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
