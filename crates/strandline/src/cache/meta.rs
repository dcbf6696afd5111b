//! Metadata of a cache, as JSON in its array `meta`.

use std::io::{Read, Seek};

use serde::{Deserialize, Serialize};
use strandline_base::npz::{Kind, Npz};

use super::What;
use crate::{
    scene::MAX_FILE_BYTES,
    sim::StepReport,
    snapshot::{
        arrays::{check_memory, expect, missing, text},
        check_layout,
    },
};

/// The object in `meta`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Meta {
    pub layout: u32,
    /// Program and version that wrote it.
    #[serde(default)]
    pub written_by: String,
    #[serde(default = "metres")]
    pub units: String,
    #[serde(default = "y")]
    pub up_axis: String,
    pub what: What,
    /// Frames a second of the film, the first of them in the file, and every how many is.
    pub frames_per_second: f32,
    #[serde(default)]
    pub first: u32,
    #[serde(default = "one")]
    pub every: u32,
    /// Steps of the simulation up to the last frame, without settling.
    #[serde(default)]
    pub steps: u64,
    #[serde(default)]
    pub group_names: Vec<String>,
    /// The scene as TOML, and the folder that its paths start from, seen from that of the cache.
    #[serde(default)]
    pub scene: String,
    #[serde(default)]
    pub scene_folder: String,
    #[serde(default)]
    pub report: Report,
}

fn metres() -> String {
    "m".to_owned()
}

fn y() -> String {
    "y".to_owned()
}

fn one() -> u32 {
    1
}

/// Quality of the steps that led to each frame of the file, one number a frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Report {
    pub steps: Vec<u32>,
    /// Length over rest length - 1; null for NaN.
    pub stretch_mean: Vec<Option<f32>>,
    pub stretch_max: Vec<Option<f32>>,
    /// Deepest point inside a solid \[m\].
    pub penetration_max_m: Vec<Option<f32>>,
    /// Most points in a step that were not finite.
    pub non_finite: Vec<u64>,
    /// The steps since the last frame.
    pub open: Open,
}

/// Steps that led to no frame yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Open {
    steps: u32,
    stretch_sum: Option<f32>,
    stretch_max: Option<f32>,
    penetration_max_m: f32,
    non_finite: u64,
}

impl Report {
    /// Adds a step.
    pub fn step(&mut self, step: &StepReport) {
        // A value that is no number stays none; a maximum would skip it.
        let first = self.open.steps == 0;
        let number = |so_far: Option<f32>, next: f32, join: fn(f32, f32) -> f32| {
            let joined = if first { next } else { join(so_far?, next) };
            (joined.is_finite() && next.is_finite()).then_some(joined)
        };
        self.open = Open {
            steps: self.open.steps + 1,
            stretch_sum: number(self.open.stretch_sum, step.stretch_mean, |a, b| a + b),
            stretch_max: number(self.open.stretch_max, step.stretch_max, f32::max),
            penetration_max_m: self.open.penetration_max_m.max(step.penetration_max),
            non_finite: self.open.non_finite.max(step.non_finite as u64),
        };
    }

    /// Ends the steps that led to a frame.
    pub fn frame(&mut self) {
        let Open { steps, stretch_sum, stretch_max, penetration_max_m, non_finite } =
            std::mem::take(&mut self.open);
        self.steps.push(steps);
        self.stretch_mean.push(stretch_sum.map(|sum| sum / steps as f32));
        self.stretch_max.push(stretch_max);
        self.penetration_max_m.push(penetration_max_m.is_finite().then_some(penetration_max_m));
        self.non_finite.push(non_finite);
    }
}

/// Most bytes of `meta` beyond its report: a scene of the longest kind, spelled as JSON.
const SCENE: u64 = 2 * MAX_FILE_BYTES;
/// Most bytes that the report has of a frame.
const REPORT: u64 = 160;

pub(super) fn read_meta<R: Read + Seek>(npz: &mut Npz<R>, frames: u64) -> Result<Meta, String> {
    let Some(mut rows) = npz.open("meta").map_err(text)? else { return Err(missing(npz, "meta")) };
    expect(&rows, "meta", Kind::U8, &[Some(rows.bytes())])?;
    let most = SCENE + REPORT * frames;
    if rows.bytes() > most {
        return Err(format!("meta of {} bytes, expected {most} at most for {frames} frames", rows.bytes()));
    }
    check_memory("meta", rows.bytes(), 8)?;
    let bytes = npz.all(&mut rows).map_err(text)?;
    let meta: Meta = serde_json::from_slice(&bytes).map_err(|error| format!("meta: {error}"))?;
    check_layout(meta.layout, &meta.units, &meta.up_axis)?;
    if meta.every == 0 {
        return Err("meta: every is 0, expected 1 or more".to_owned());
    }
    Ok(meta)
}
