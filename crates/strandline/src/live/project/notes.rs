//! Tasks of kept frames as plain data, and back.

use std::sync::Arc;

use glam::Vec3;

use crate::{
    Scene,
    cache::kept::TaskNote,
    groom::LANES,
    scene::{MotionSection, WindSection},
    session::{Live, Task, Weather},
    sim::{Settings, State},
};

/// Scenes that tasks and marks name by their number.
#[derive(Default)]
pub struct Scenes {
    pub texts: Vec<String>,
    weathers: Vec<(Arc<Weather>, usize)>,
    settings: Vec<(Settings, usize)>,
}

impl Scenes {
    fn add(&mut self, scene: &Scene) -> usize {
        self.texts.push(scene.to_toml());
        self.texts.len() - 1
    }

    /// Number of a scene with these settings.
    pub fn of_settings(&mut self, settings: &Settings) -> usize {
        if let Some((_, number)) = self.settings.iter().find(|(known, _)| known == settings) {
            return *number;
        }
        let number = self.add(&Scene { simulation: settings.clone(), ..Scene::default() });
        self.settings.push((settings.clone(), number));
        number
    }

    fn of_weather(&mut self, weather: &Arc<Weather>) -> usize {
        if let Some((_, number)) = self.weathers.iter().rev().find(|(known, _)| Arc::ptr_eq(known, weather)) {
            return *number;
        }
        let (motion, wind): (MotionSection, WindSection) = (weather.motion.clone(), weather.wind.clone());
        let number = self.add(&Scene { motion, wind, ..Scene::default() });
        self.weathers.push((weather.clone(), number));
        number
    }

    /// Notes of the tasks that led to a frame; `None` where one of them is of another kind of run.
    pub fn notes(&mut self, (before, live): &(Vec<Task>, Live)) -> Option<Vec<TaskNote>> {
        let done = before.iter().filter(|task| !is_refused(task));
        let mut notes = done.map(|task| self.note(task)).collect::<Option<Vec<_>>>()?;
        let Live { until, offset, weather, hand, .. } = live;
        notes.push(TaskNote::Live {
            until: until.to_bits(),
            offset: offset.to_bits(),
            scene: self.of_weather(weather),
            hand: hand.map(|hand| hand.to_array().map(f32::to_bits)),
        });
        Some(notes)
    }

    fn note(&mut self, task: &Task) -> Option<TaskNote> {
        Some(match task {
            Task::Settings(settings) => TaskNote::Settings(self.of_settings(settings)),
            Task::Lengths(scales) => {
                let first = *scales.first()?;
                TaskNote::Length(scales.iter().all(|scale| *scale == first).then(|| first.to_bits())?)
            }
            Task::Grab { index, lane, radius } => {
                TaskNote::Grab { index: *index, lane: *lane, radius: radius.to_bits() }
            }
            Task::Release => TaskNote::Release,
            Task::Film { .. } | Task::Cached { .. } | Task::Live(_) | Task::Reset { .. } => return None,
        })
    }
}

/// True for a task that the simulation refused when it came, and refuses again: it changed nothing.
fn is_refused(task: &Task) -> bool {
    match task {
        Task::Settings(settings) => settings.check().is_err(),
        Task::Lengths(scales) => !scales.iter().all(|scale| State::LENGTH_SCALES.contains(scale)),
        Task::Grab { radius, .. } => !(*radius > 0.0),
        _ => false,
    }
}

/// Bounds of the tasks of a session.
pub struct Room {
    /// Strands, and blocks of points.
    pub strands: usize,
    pub blocks: usize,
    /// Frames of a second.
    pub rate: f64,
}

/// The tasks that led to a frame, with the time \[s\] of the frame before, where it is known. `weather` gives that of a
/// scene by its number.
///
/// # Errors
/// Tasks that no session has.
pub fn tasks(
    notes: &[TaskNote],
    scenes: &[Scene],
    before: Option<f64>,
    room: &Room,
    weather: &mut dyn FnMut(usize) -> Result<Arc<Weather>, String>,
) -> Result<(Vec<Task>, Live), String> {
    let scene =
        |number: usize| scenes.get(number).ok_or(format!("a task with scene {number}, expected a known one"));
    let Some((TaskNote::Live { until, offset, scene: sky, hand }, earlier)) = notes.split_last() else {
        return Err("a frame whose last task is none of time, expected one".to_owned());
    };
    let task = |note: &TaskNote| {
        Ok(match *note {
            TaskNote::Settings(number) => Task::Settings(Box::new(scene(number)?.simulation.clone())),
            TaskNote::Length(scale) if State::LENGTH_SCALES.contains(&f32::from_bits(scale)) => {
                Task::Lengths(vec![f32::from_bits(scale); room.strands])
            }
            TaskNote::Grab { index, lane, radius }
                if index < room.blocks && lane < LANES && f32::from_bits(radius) > 0.0 =>
            {
                Task::Grab { index, lane, radius: f32::from_bits(radius) }
            }
            TaskNote::Release => Task::Release,
            _ => return Err(format!("the task {note:?}, expected one of this hair")),
        })
    };
    let earlier = earlier.iter().map(task).collect::<Result<Vec<_>, String>>()?;
    let (until, offset) = (f64::from_bits(*until), f64::from_bits(*offset));
    let begin = before.unwrap_or(until - 1.0 / room.rate);
    if !(until.abs() < 1e9 && offset.abs() < 1e9 && until > begin && (until - begin) * room.rate < 2.0) {
        return Err(format!(
            "a frame that ends at {until} s after one at {begin} s, expected the next frame"
        ));
    }
    let hand = hand.map(|hand| Vec3::from_array(hand.map(f32::from_bits)));
    if hand.is_some_and(|hand| !(hand.abs().max_element() < 1e4)) {
        return Err("a hand that is nowhere, expected one near the hair".to_owned());
    }
    let weather = scene(*sky).and_then(|_| weather(*sky))?;
    Ok((earlier, Live { until, offset, most_steps: f64::INFINITY, weather, hand }))
}
