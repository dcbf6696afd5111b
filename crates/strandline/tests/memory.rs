//! Play does not collect memory: every byte is counted.
#![allow(clippy::disallowed_methods)] // compared values may be rounded
#![allow(unsafe_code)] // an allocator cannot be written without

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicIsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use strandline::{Camera, Change, Live, Ray, Scene, live::Shown};

/// The system's allocator, counted.
struct Counted;

static HELD: AtomicIsize = AtomicIsize::new(0);

// SAFETY: every call goes to the system's allocator with the layout and the pointer that it was given; the
// count beside it touches no memory that is handed out.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size() as isize, Relaxed);
        // SAFETY: the caller's promise about the layout is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size() as isize, Relaxed);
        // SAFETY: `pointer` came from `alloc` above with this layout, as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

fn scene() -> Scene {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.groom.bound) = (60, Some(0));
    scene.body.spacing = 0.02;
    scene.simulation.volume.cells = [12; 3];
    scene.devices.simulation = strandline::Backend::Cpu;
    scene.devices.pictures = strandline::Backend::Cpu;
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    (scene.picture.width, scene.picture.height) = (64, 48);
    scene.look.shadow.map_size = 128;
    // Kept frames fill what they may within the first pictures.
    (scene.timeline.memory, scene.timeline.disk) = (1, 0);
    scene
}

fn next(live: &Live) -> Shown {
    let begin = Instant::now();
    loop {
        if let Some(shown) = live.take_shown() {
            return shown;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "nothing came");
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// Plays so many pictures with a hand that does something at each; what is held at
/// least \[byte\]: what a picture needs while it is drawn may be seen or not.
fn play(live: &Live, pictures: u32) -> isize {
    let mut least = isize::MAX;
    for count in 0..pictures {
        let share = (0.7 * count as f32).sin();
        let ray = Ray::new(&Camera::front(), glam::Vec2::new(0.3 * share, 0.2));
        live.send(match count % 7 {
            0 => Change::Grab(ray, 0.03),
            1 | 2 => Change::Drag(ray),
            3 => Change::Release,
            4 => Change::Length(0.75 + 0.25 * share),
            5 => Change::Settings(Box::new(scene().simulation)),
            _ => Change::Camera(Camera::front().orbit(share, 0.0)),
        });
        drop(next(live));
        live.take_events();
        least = least.min(HELD.load(Relaxed));
    }
    least
}

#[test]
fn play_holds_no_more_than_at_its_beginning() {
    let live = Live::new(scene(), || ()).unwrap();
    // Lists that follow the hair have grown to their sizes after as many pictures again.
    let first = play(&live, 60).max(play(&live, 60));
    let last = (0..4).map(|_| play(&live, 60)).last().unwrap();
    // 2 % is promised over ten minutes: `strandline bench window` plays them.
    assert!(last as f64 <= 1.02 * first as f64, "{first} bytes, then {last}");
    // Kept memory is seen: a tenth of the room.
    let kept = vec![0_u8; first as usize / 10];
    let more = play(&live, 36);
    assert!(more as f64 > 1.02 * first as f64, "{} bytes more are not noticed", kept.len());
}
