//! Figures of the window on the CPU, and long use: how soon a kept frame is shown, pictures a second while the demo moves,
//! random actions without growth of memory.

use std::time::{Duration, Instant};

use eframe::egui::{self, Key, Modifiers};
use strandline::{Backend, Scene, math::Random};

use crate::person::{Window, button, scene};

/// Actions of a person in the short form; `STRANDLINE_ACTIONS` gives another number.
const ACTIONS: usize = 60;
/// Bytes that a window may gain beside what its timeline may hold: pictures, texts and the steps of undo.
const BESIDE: u64 = 96 << 20;

/// Seconds of all cores that this program has worked; 0 where the system does not tell.
fn worked() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let behind_name = text.rsplit(')').next().unwrap_or_default();
    let ticks = behind_name.split_whitespace().skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// Seconds after which a frame of the timeline is shown at the moving quality.
fn sought(window: &mut Window, frame: u32) -> f64 {
    let (before, begin) = (window.frame(), Instant::now());
    window.app_mut().seek(frame);
    while window.app().timeline().playhead != frame || window.frame() == before {
        assert!(begin.elapsed() < Duration::from_secs(60), "frame {frame} is never shown");
        window.pass(Vec::new(), None);
        std::thread::sleep(Duration::from_millis(1));
    }
    begin.elapsed().as_secs_f64()
}

/// The demo on the CPU with `STRANDLINE_MEASURE=1`, else a small scene: its seconds say nothing, the way is the same.
#[test]
fn kept_frames_are_shown_soon_and_the_demo_moves() {
    let measured = std::env::var_os("STRANDLINE_MEASURE").is_some();
    let mut scene = if measured { Scene::demo() } else { scene() };
    (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, Backend::Cpu);
    let mut window = Window::on(scene);
    window.until("a picture", |app| app.shown().is_some());
    let (first, begin, work) = (window.frame(), Instant::now(), worked());
    // A loaded machine plays less in that time.
    window.until("frames", |app| {
        let seconds = begin.elapsed().as_secs();
        app.timeline().good >= 24 || (seconds > 20 && app.timeline().good >= 4)
    });
    let shown = (window.frame() - first) as f64;
    let rate = shown / begin.elapsed().as_secs_f64();
    let each = 1e3 * (worked() - work) / shown;
    let [in_memory, _] = window.app().timeline().used;
    window.press(Key::Space);
    window.settle();
    let last = window.app().timeline().good;
    let (mut random, work) = (Random::new(39, 0), worked());
    let mut at = window.app().timeline().playhead;
    let mut seconds: Vec<f64> = (0..12)
        .map(|_| {
            at = (at + 1 + (random.unit() * (last - 1) as f32) as u32) % last;
            sought(&mut window, at)
        })
        .collect();
    let scrub = 1e3 * (worked() - work) / seconds.len() as f64;
    seconds.sort_by(f64::total_cmp);
    let (middle, longest) = (1e3 * seconds[6], 1e3 * seconds[11]);
    println!(
        "{rate:.1} pictures/s ({each:.0} ms of all cores each, steps too); {in_memory} bytes for {last} frames"
    );
    println!("a kept frame after {middle:.0} ms, at most {longest:.0} ms ({scrub:.0} ms of all cores)");
    if measured {
        assert!(rate >= 10.0, "{rate} pictures/s");
        assert!(middle <= 50.0, "{middle} ms");
    }
}

/// A random thing that a person does in the window.
fn act(window: &mut Window, random: &mut Random) {
    const KEYS: [Key; 12] = [
        Key::Space,
        Key::ArrowLeft,
        Key::ArrowRight,
        Key::ArrowUp,
        Key::ArrowDown,
        Key::Home,
        Key::End,
        Key::I,
        Key::O,
        Key::G,
        Key::Period,
        Key::R,
    ];
    const SLIDERS: [(&str, f32, f32); 4] =
        [("turn", -40.0, 40.0), ("tip width", 0.1, 1.0), ("wind x", -5.0, 5.0), ("length", 0.5, 1.2)];
    let mut place = || egui::pos2(320.0 + 540.0 * random.unit(), 20.0 + 500.0 * random.unit());
    let (from, to) = (place(), place());
    let pick = |random: &mut Random, count: usize| ((random.unit() * count as f32) as usize).min(count - 1);
    match pick(random, 8) {
        0..=2 => window.press(KEYS[pick(random, KEYS.len())]),
        3 => window.press_with(Modifiers::COMMAND, Key::Z),
        4 => window.press_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z),
        5 => window.drag(from, to),
        6 => {
            let (label, low, high) = SLIDERS[pick(random, SLIDERS.len())];
            window.slide(label, f64::from(low + (high - low) * random.unit()));
        }
        _ => {
            window.pass(vec![egui::Event::PointerMoved(from), button(from, true)], None);
            window.pass(vec![button(from, false)], None);
        }
    }
}

/// Bytes of this program in memory; none where the system does not tell.
fn resident() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(4096 * text.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}

#[test]
fn random_actions_neither_end_the_window_nor_make_it_grow() {
    let count =
        std::env::var("STRANDLINE_ACTIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(ACTIONS);
    let mut scene = scene();
    scene.timeline.memory = 16;
    scene.timeline.disk = 16;
    let mut window = Window::on(scene);
    window.until("a picture", |app| app.shown().is_some());
    let mut random = Random::new(2000, 0);
    let mut early = None;
    for action in 0..count {
        act(&mut window, &mut random);
        if action == count / 4 {
            early = resident();
        }
        let timeline = window.app().timeline();
        assert!((0..2).all(|kind| timeline.used[kind] <= timeline.most[kind]), "{timeline:?}");
        std::thread::sleep(Duration::from_millis(20));
    }
    window.settle();
    // It still does what it is told.
    let frame = window.frame();
    window.press(Key::Period);
    window.until("one more frame", |app| app.shown().is_some_and(|shown| shown.frame > frame));
    if let (Some(early), Some(late)) = (early, resident()) {
        let most = window.app().timeline().most[0] + BESIDE;
        println!("{count} actions: {} MB, then {} MB", early >> 20, late >> 20);
        assert!(late < early + most, "{early} bytes, then {late}");
    }
}
