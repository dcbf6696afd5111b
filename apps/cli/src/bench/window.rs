//! Measures a window on the demo in use: the time to the first picture, pictures per second, pictures between
//! a move of the hand and its effect, and the growth of memory.

use std::time::{Duration, Instant};

use serde::Serialize;
use strandline::{
    Backend, Camera, Change, Live, Ray, Scene,
    live::{Command, LiveEvent, Shown},
};

use super::gpu::Device;
use super::machine::peak_memory_mb;
use crate::arguments::BenchOptions;
use crate::output::print_line;
use crate::progress::Progress;
use crate::statistics::{median, quantile};

/// Seconds of play; of a short run.
const SECONDS: [u64; 2] = [600, 6];
/// The picture of a window of 1280 x 800 points.
const SIZE: [u32; 2] = [960, 752];
/// Idle time.
const REST: Duration = Duration::from_millis(300);

#[derive(Debug, Serialize)]
pub struct Results {
    simulated_on: String,
    drawn_on: String,
    seconds: f64,
    seconds_to_first_picture: f64,
    pictures_per_second: f64,
    /// Changes of the picture: view, look.
    picture_moves: Shows,
    /// Changes of the motion: settings, length, a hand.
    motion_moves: Shows,
    /// Largest memory \[MB\] after a tenth of the time and at the end, where the system reports it.
    peak_memory_mb: [Option<f64>; 2],
}

pub fn run(device: Option<&Device>, options: &BenchOptions) -> anyhow::Result<Results> {
    let backend = device.map_or(Backend::Cpu, |device| Backend::Gpu(Some(device.gpu.adapter().index)));
    let seconds = options.seconds.unwrap_or(SECONDS[usize::from(options.quick)]);
    let mut scene = Scene::demo();
    (scene.devices.simulation, scene.devices.pictures) = (backend, backend);
    [scene.picture.width, scene.picture.height] = SIZE;
    let results = Play::begin(scene)?.on(seconds)?;
    let text = |memory: Option<f64>| memory.map_or("unknown".to_owned(), |mb| format!("{mb:.0} MB"));
    print_line!("\nThe window's demo, played for {:.0} s: {}", results.seconds, results.drawn_on);
    print_line!("first picture after     {:>8.2} s", results.seconds_to_first_picture);
    print_line!("pictures a second       {:>8.1}", results.pictures_per_second);
    for (what, shows) in [("view or look", &results.picture_moves), ("hair", &results.motion_moves)] {
        let ([pictures, most], [middle, late]) = (shows.pictures, shows.ms);
        print_line!(
            "a move of {what} shows in picture {pictures:.0}, at most {most:.0}; {middle:.0} ms, 95 of 100 within {late:.0} ms"
        );
    }
    let [early, end] = results.peak_memory_mb;
    print_line!("peak memory after a tenth of it {}, at the end {}", text(early), text(end));
    Ok(results)
}

/// Delay until moves show.
#[derive(Debug, Default, Serialize)]
struct Shows {
    /// Pictures that come after a move up to the one that shows it: the middle and the most. The first of
    /// them was under way.
    pictures: [f64; 2],
    /// Time \[ms\]: the median, and the 95th percentile.
    ms: [f64; 2],
}

/// Pictures and times \[ms\] between moves and the pictures that show them.
#[derive(Default)]
struct Moves(Vec<(f64, f64)>);

impl Moves {
    fn shows(&self) -> Shows {
        let (pictures, ms): (Vec<f64>, Vec<f64>) = self.0.iter().copied().unzip();
        Shows {
            pictures: [median(&pictures), quantile(&pictures, 1.0)],
            ms: [median(&ms), quantile(&ms, 0.95)],
        }
    }
}

/// A simulated user.
struct Play {
    live: Live,
    camera: Camera,
    scene: Scene,
    picture_moves: Moves,
    motion_moves: Moves,
    shown: Shown,
    opened: f64,
}

impl Play {
    /// Opens the scene and waits for its first picture.
    fn begin(scene: Scene) -> anyhow::Result<Self> {
        let begin = Instant::now();
        let live = Live::new(scene.clone(), || ())?;
        live.send(Command::Adapt(true));
        let mut play = Self {
            live,
            camera: Camera::front(),
            scene,
            picture_moves: Moves::default(),
            motion_moves: Moves::default(),
            shown: Shown::default(),
            opened: 0.0,
        };
        play.next(|_| true)?;
        play.opened = begin.elapsed().as_secs_f64();
        Ok(play)
    }

    /// Waits for a picture of a kind.
    fn next(&mut self, is: impl Fn(&Shown) -> bool) -> anyhow::Result<()> {
        loop {
            for news in self.live.take_events() {
                match news {
                    LiveEvent::Loaded(_, _, camera, ..) => self.camera = camera,
                    LiveEvent::NotLoaded(_, _, error) | LiveEvent::Error(_, error) => {
                        anyhow::bail!("{error}")
                    }
                    _ => {}
                }
            }
            if let Some(shown) = self.live.take_shown() {
                let there = is(&shown);
                self.shown = shown;
                if there {
                    return Ok(());
                }
            }
            std::thread::sleep(Duration::from_micros(200));
        }
    }

    /// Does something and waits for the picture that shows it.
    fn act(&mut self, change: Change) -> anyhow::Result<()> {
        // Finished pictures are shown before.
        if let Some(shown) = self.live.take_shown() {
            self.shown = shown;
        }
        let (before, begin) = (self.shown.frame, Instant::now());
        let moves_hair = !matches!(change, Change::Camera(_) | Change::Look(_));
        let number = self.live.send(change);
        self.next(|shown| {
            if moves_hair {
                shown.simulated_after_command >= number
            } else {
                shown.drawn_after_command >= number
            }
        })?;
        let moves = if moves_hair { &mut self.motion_moves } else { &mut self.picture_moves };
        moves.0.push(((self.shown.frame - before) as f64, 1e3 * begin.elapsed().as_secs_f64()));
        Ok(())
    }

    fn on(mut self, seconds: u64) -> anyhow::Result<Results> {
        let (begin, first) = (Instant::now(), self.shown.frame);
        let mut early = None;
        let mut progress = Progress::new(seconds, "seconds of play", false);
        let mut count = 0_u32;
        while begin.elapsed().as_secs() < seconds {
            self.play(count)?;
            count += 1;
            std::thread::sleep(REST);
            if begin.elapsed().as_secs() * 10 >= seconds && early.is_none() {
                early = Some(peak_memory_mb());
            }
            progress.reached(begin.elapsed().as_secs());
        }
        drop(progress);
        let passed = begin.elapsed().as_secs_f64();
        let [simulated_on, drawn_on] = self.shown.places.clone();
        Ok(Results {
            simulated_on,
            drawn_on,
            seconds: passed,
            seconds_to_first_picture: self.opened,
            pictures_per_second: (self.shown.frame - first) as f64 / passed,
            picture_moves: self.picture_moves.shows(),
            motion_moves: self.motion_moves.shows(),
            peak_memory_mb: [early.flatten(), peak_memory_mb()],
        })
    }

    /// One of the things that a person does, in turn.
    fn play(&mut self, count: u32) -> anyhow::Result<()> {
        let share = (0.7 * count as f32).sin();
        match count % 8 {
            0 => {
                let mut settings = self.scene.simulation.clone();
                settings.damping = 0.1 * (count / 8 % 2) as f32;
                self.act(Change::Settings(Box::new(settings)))
            }
            1 => {
                let ray = Ray::new(&self.camera, glam::Vec2::new(-0.25, -0.4));
                self.act(Change::Grab(ray, 0.012))
            }
            2 | 3 => {
                let ray = Ray::new(&self.camera, glam::Vec2::new(-0.6 + 0.2 * share, -0.2));
                self.act(Change::Drag(ray))
            }
            4 => self.act(Change::Release),
            5 => {
                let look =
                    self.scene.look.clone().with_scheuermann(|fibre| fibre.sparkle = 0.5 + 0.4 * share);
                self.act(Change::Look(Box::new(look)))
            }
            6 => self.act(Change::Length(0.75 + 0.25 * share)),
            _ => self.act(Change::Camera(self.camera.orbit(0.5 * share, 0.0))),
        }
    }
}
