use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Everything about the motion that a person may set, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Length of a step \[s\].
    pub time_step: f32,
    /// Gravity \[m/s^2\], world space.
    pub gravity: Vec3,
    /// Elastic springs, each can be off.
    pub springs: Springs,
    /// The fluid volume.
    pub volume: VolumeSettings,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            time_step: 1.0 / 60.0,
            gravity: Vec3::new(0.0, -9.81, 0.0),
            springs: Springs::default(),
            volume: VolumeSettings::default(),
        }
    }
}

/// Elastic springs along a strand [Chen2011 §4].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Springs {}

/// The fluid volume that keeps strands apart [Chen2011 §4, McAdams2009].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VolumeSettings {
    /// False leaves the volume out.
    pub enabled: bool,
    /// Cells along x, y and z.
    pub cells: [u32; 3],
    /// FLIP share of the velocity update, 0 (PIC) to 1 (FLIP) [Chen2011 eq. 5].
    pub flip_share: f32,
    /// Relative residual at which the pressure solve stops.
    pub tolerance: f32,
    /// Most iterations of the pressure solve.
    pub max_iterations: u32,
    /// Preconditioner of the conjugate gradients.
    pub preconditioner: Preconditioner,
}

impl Default for VolumeSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            cells: [32; 3],
            flip_share: 0.95,
            tolerance: 1e-5,
            max_iterations: 200,
            preconditioner: Preconditioner::Mic0,
        }
    }
}

/// Preconditioner of the conjugate gradients.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Preconditioner {
    /// Modified incomplete Cholesky, level zero.
    #[default]
    Mic0,
    /// The diagonal.
    Jacobi,
    /// None.
    None,
}
