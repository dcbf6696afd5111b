//! A person without a plan: whatever mouse, keys, edges of the window and files do, the window stays, and its
//! memory with it.

use std::time::{Duration, Instant};

use strandline::{math::Random, settings::StyleSettings};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConfigureWindowAux, ConnectionExt};

use crate::display::{Display, Person, SIZE};
use crate::{folder, open};

/// Seconds of use when the environment's STRANDLINE_RANDOM_USE says nothing else; `cargo xtask long` asks for a minute.
const SECONDS: u64 = 10;
/// Allowed growth of memory \[MiB\] of a window of one size at rest with one scene, after it had every size and every file
/// once. It covers the reserve of the allocator and layers of the greatest window. Found: 0 to 107 MiB in 10 and 60 seconds.
const ADDED: u64 = 250;
const SPACE: u32 = 0x20;
/// X symbols: space, full stop, arrows, f, g, r, t, tab, escape, page up and down.
const KEYS: [u32; 12] = [SPACE, 0x2e, 0xff51, 0xff53, 0x66, 0x67, 0x72, 0x74, 0xff09, 0xff1b, 0xff55, 0xff56];
const SIZES: [[u32; 2]; 6] = [[1280, 800], [640, 400], [1, 1], [3000, 700], [300, 2000], [9000, 200]];

#[test]
fn random_use_ends_nothing_and_keeps_memory_flat() {
    let Some(display) = Display::start() else { return };
    let (_keep, folder) = folder();
    let groom = StyleSettings { strand_count: 300, ..StyleSettings::default() }.grow().unwrap();
    groom.save(folder.join("grown.hair")).unwrap();
    std::fs::write(folder.join("bad.hair"), b"PK nothing").unwrap();
    std::fs::write(folder.join("half.obj"), "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n").unwrap();
    let files = ["small.toml", "grown.hair", "bad.hair", "half.obj", "nothing.toml"];
    let seconds = std::env::var("STRANDLINE_RANDOM_USE").map_or(SECONDS, |text| text.parse().unwrap());
    let mut person = open(&display, &folder);
    for size in SIZES {
        resize(&mut person, size);
        std::thread::sleep(Duration::from_millis(300));
    }
    files.iter().for_each(|file| person.drop_file(&folder.join(file)));
    let early = settled(&mut person, &folder.join(files[0]));
    let (mut random, mut actions, begin) = (Random::new(3, 0), 0, Instant::now());
    while begin.elapsed().as_secs() < seconds {
        act(&mut person, &mut random, &|index| folder.join(files[index % files.len()]));
        actions += 1;
        assert!(person.is_open(), "it ended after {actions} actions");
    }
    assert!(actions > 0, "no action in {seconds} s");
    let late = settled(&mut person, &folder.join(files[0]));
    println!("{actions} actions in {seconds} s: {early} MiB at the beginning, {late} MiB at the end");
    assert!(late < early + ADDED, "{early} MiB became {late} MiB");
    assert!(person.close().success());
}

/// Memory \[MiB\] with a scene that was loaded just now, in a window of the first size that has drawn its whole picture
/// and rests, paused if need be: a moving picture takes less, so only then are beginning and end alike.
fn settled(person: &mut Person, scene: &std::path::Path) -> u64 {
    resize(person, SIZES[0]);
    person.drop_file(scene);
    std::thread::sleep(Duration::from_secs(2));
    // On a busy machine the first key may set a window going that was about to rest: the next one pauses it again.
    for seconds in [8, 30, 30, 30] {
        if rests(person, Duration::from_secs(seconds)) {
            return person.memory();
        }
        person.key(SPACE);
    }
    panic!("the window does not come to rest");
}

/// True when a second comes in which the window computes next to nothing.
fn rests(person: &Person, patience: Duration) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < patience {
        let before = person.cpu_seconds();
        std::thread::sleep(Duration::from_secs(1));
        if person.cpu_seconds() - before < 0.1 {
            return true;
        }
    }
    false
}

fn resize(person: &mut Person, [width, height]: [u32; 2]) {
    let size = ConfigureWindowAux::new().width(width).height(height);
    person.connection.configure_window(person.window, &size).unwrap();
    person.connection.flush().unwrap();
}

fn act(person: &mut Person, random: &mut Random, file: &dyn Fn(usize) -> std::path::PathBuf) {
    let mut below = |end: usize| (random.bits() as usize) % end;
    let [here, there] = [(); 2].map(|()| [below(SIZE[0]) as i16, below(SIZE[1]) as i16]);
    match below(16) {
        0..=3 => {
            person.point(here);
            person.fake(4, 1, [0; 2]);
            person.fake(5, 1, [0; 2]);
        }
        4..=6 => {
            let button = [1, 1, 2, 3][below(4)];
            person.point(here);
            person.fake(4, button, [0; 2]);
            person.point([(here[0] + there[0]) / 2, (here[1] + there[1]) / 2]);
            person.point(there);
            person.fake(5, button, [0; 2]);
        }
        7..=8 => {
            let button = [4, 5][below(2)];
            person.point(here);
            for _ in 0..3 {
                person.fake(4, button, [0; 2]);
                person.fake(5, button, [0; 2]);
            }
        }
        9..=12 => person.key(KEYS[below(KEYS.len())]),
        13 => resize(person, SIZES[below(SIZES.len())]),
        _ => person.drop_file(&file(below(64))),
    }
}
