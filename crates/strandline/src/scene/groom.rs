use std::path::PathBuf;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::within;
use crate::{
    Error,
    groom::format::{Scale, Up},
};

/// `[groom]`: strands from a file, and how guides are made of strands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GroomSection {
    /// A .hair or .tfx file; without one the `[style]` is grown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Metres per unit of the file, or "auto".
    pub scale: Scale,
    /// The file's axis that points up.
    pub up: Up,
    /// Moves the strands of a file \[m\], head space.
    pub translation: Vec3,
    /// Every how manieth strand of a file is simulated; the others are left out.
    pub guide_every: u32,
    /// Points on each guide, 4 to 64.
    pub points_per_strand: u32,
    /// Length of every strand over its own, 0.05 to 1.
    pub length: f32,
    /// Where the simulated points are to begin with and how they move, as the window saves it; without it
    /// hair begins at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<PathBuf>,
}

impl Default for GroomSection {
    fn default() -> Self {
        Self {
            file: None,
            scale: Scale::default(),
            up: Up::default(),
            translation: Vec3::ZERO,
            guide_every: 1,
            points_per_strand: 16,
            length: 1.0,
            pose: None,
        }
    }
}

impl GroomSection {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("groom.guide_every", f64::from(self.guide_every), 1.0..=1e6)?;
        within("groom.points_per_strand", f64::from(self.points_per_strand), 4.0..=64.0)?;
        // As a number of 32 bits, 0.05 is a little more.
        within("groom.length", f64::from(self.length), f64::from(0.05_f32)..=1.0)
    }
}
