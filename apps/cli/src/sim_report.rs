//! Output of `sim --json`.

use std::path::PathBuf;

use serde::Serialize;
use strandline::mesh::Placement;
use strandline::{Extent, Jump};

use crate::non_finite::NonFinite;
use crate::statistics::Times;

/// Output of `sim --json`.
#[derive(Debug, Serialize)]
pub struct SimReport {
    pub backend: String,
    pub strands: usize,
    pub points_per_strand: usize,
    pub steps: usize,
    /// Placement of groom and body, and the confidence in it.
    pub placement: Placement,
    pub ms_per_step: Times,
    pub stretch: Stretch,
    pub penetration_max_m: f32,
    pub drift: Spread,
    pub speed: Spread,
    /// Force of the air on a guide over the guide's weight, at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air: Option<Spread>,
    /// Density around points over that at rest, at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<Spread>,
    /// Strands of rods that had to be stiffer, and how many times stiffer the stiffest of them is.
    pub stiffened: usize,
    pub stiffest: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rods: Option<Rods>,
    /// `None` where strands pass through each other.
    pub contacts: Option<Contacts>,
    /// Jumps of the body, over which hair was carried.
    pub jumps: Vec<JumpReport>,
    #[serde(flatten)]
    pub non_finite: NonFinite,
    pub pcg: Pcg,
    pub fluid_cells_mean: f64,
    /// Files written by `--out`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub out: Option<OutReport>,
}

/// A jump of the body.
#[derive(Debug, Serialize)]
pub struct JumpReport {
    /// Time of the film \[s\].
    pub time: f64,
    /// Way and angle, human-readable.
    pub what: String,
}

impl From<Jump> for JumpReport {
    fn from(Jump { time, what }: Jump) -> Self {
        Self { time, what }
    }
}

/// A file of hair that moved.
#[derive(Debug, Serialize)]
pub struct OutReport {
    pub path: PathBuf,
    pub frames: usize,
    pub strands: usize,
    pub points: usize,
    pub bytes: u64,
    /// Of writing alone.
    pub seconds: f64,
}

/// Length over rest length - 1: the mean over all steps and segments, and the largest.
#[derive(Debug, Serialize)]
pub struct Stretch {
    pub mean: f64,
    pub max: f32,
}

/// A mean and a largest value: of `drift` the distance of points at the end from the groom as loaded,
/// carried by the head, over the strand's length; of `speed` the motion in the last second \[m/s\].
#[derive(Debug, Default, Serialize)]
pub struct Spread {
    pub mean: f32,
    pub max: f32,
}

impl From<Extent> for Spread {
    fn from(Extent { mean, max }: Extent) -> Self {
        Self { mean, max }
    }
}

/// Quality of the solve of rods.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Rods {
    /// Largest turn of a segment in the last Newton step of a strand.
    pub residual_max_rad: f32,
    /// Most strands of a step that would have needed more Newton steps.
    pub unsolved_max: usize,
    /// Strands at rest in the last step.
    pub resting: usize,
}

/// Contacts of strands with each other, of the last step; the deepest and the most crossed of all steps.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Contacts {
    /// Pairs of segments that press.
    pub pairs: usize,
    /// By how much axes were nearer than their wisps are thick.
    pub deepest_m: f32,
    /// Pairs whose axes had crossed in one step.
    pub crossed_max: usize,
}

/// The conjugate gradients.
#[derive(Debug, Serialize)]
pub struct Pcg {
    /// To the scene's relative residual.
    pub iterations_mean: f64,
    /// Until the same number would have been met as an absolute residual.
    pub iterations_absolute_mean: f64,
    /// Steps that stopped before that: they count with the iterations that they had.
    pub absolute_unmet: usize,
    pub residual_max: f32,
}
