//! A scene that plays, and how to wait for what it shows.

use std::time::{Duration, Instant};

use strandline::{
    Backend, Live, Scene,
    live::{Command, LiveEvent, Shown},
};

pub fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.groom.bound = Some(0);
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.devices = Backend::Cpu.into();
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    (scene.picture.width, scene.picture.height) = (64, 48);
    // Small pictures of all strands.
    scene.level_of_detail.by_pixel = false;
    scene
}

/// Wakes this thread where it waits.
pub fn waking() -> impl Fn() + Send {
    let here = std::thread::current();
    move || here.unpark()
}

/// Longest wait for one thing: twenty times what the slowest takes on two quiet cores.
pub const PATIENCE: Duration = Duration::from_secs(180);

/// Waits for what is wanted.
pub fn wait<T>(mut look: impl FnMut() -> Option<T>) -> T {
    let begin = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        let left = PATIENCE.checked_sub(begin.elapsed()).expect("nothing came");
        std::thread::park_timeout(left);
    }
}

pub fn next(live: &Live) -> Shown {
    wait(|| live.take_shown())
}

/// The last picture before nothing comes any more.
pub fn settled(live: &Live) -> Shown {
    live.wait_idle();
    live.take_shown().expect("a picture came")
}

/// A scene that stands still, and its first picture.
pub fn still() -> (Live, Shown) {
    let live = Live::new(scene(), waking()).unwrap();
    live.send(Command::Play(false));
    let first = next(&live);
    (live, first)
}

/// The next error that is emitted.
pub fn error(live: &Live) -> String {
    wait(|| {
        live.take_events().into_iter().find_map(|news| match news {
            LiveEvent::Error(_, error) | LiveEvent::NotLoaded(_, _, error) => Some(error),
            _ => None,
        })
    })
}
