use std::fmt::Display;

use serde::{Deserialize, Serialize};

use crate::RenderError;

/// Colour and shape of the drawn hair.
///
/// Colours are linear RGB, 0..1. The named looks ([`Look::brown`] and so on) differ in colour only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Look {
    /// Follow strands of each guide, the guide itself among them, 1 to 1,024. Default 16.
    pub follow_strands: u32,
    /// Hairs that the drawn strands stand for: each strand is widened so that together they cover as
    /// much as this many hairs; 0 draws every strand as one hair. Default 100,000, a head of hair.
    pub hair_count: u32,
    /// Multiple of the groom's root diameters. Default 1.
    pub width_scale: f32,
    /// Diameter at the tip as a share of that at the root, 0 to 1. Default 0.3.
    pub tip_width: f32,
    /// How the drawn strands lie about their guide.
    pub clump: Clump,
    /// Seed of every random choice of the look. Default 0.
    pub seed: u32,
}

impl Default for Look {
    fn default() -> Self {
        Self::brown()
    }
}

/// How follow strands lie about their guide [Chen2011 §3.2].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Clump {
    /// Radius of the clump at the roots \[m\]. Default 0.005.
    pub root_radius: f32,
    /// Radius of the clump at the tips \[m\]. Default 0.003.
    pub tip_radius: f32,
    /// Exponent of the way from root to tip radius; above 1 the clump closes late. Default 1.5.
    pub taper: f32,
    /// How far the strands of hair combed along the skin are lifted off it, 0 (half of them inside)
    /// to 1 (the guide is the innermost). Default 0.85.
    pub lift: f32,
    /// Greatest share by which a follow strand is shorter than its guide, 0 to 0.9. Default 0.12.
    pub shorter: f32,
    /// Amplitude of each strand's own waves at the tip \[m\]; none at the root. Default 0.001.
    pub wave_amplitude: f32,
    /// Mean length of those waves \[m\]. Default 0.06.
    pub wave_length: f32,
}

impl Default for Clump {
    fn default() -> Self {
        Self {
            root_radius: 0.005,
            tip_radius: 0.003,
            taper: 1.5,
            lift: 0.85,
            shorter: 0.12,
            wave_amplitude: 0.001,
            wave_length: 0.06,
        }
    }
}

impl Look {
    /// Brown hair, the default.
    pub fn brown() -> Self {
        Self {
            follow_strands: 16,
            hair_count: 100_000,
            width_scale: 1.0,
            tip_width: 0.3,
            clump: Clump::default(),
            seed: 0,
        }
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first setting outside its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        let count = 1..=1024;
        require(
            count.contains(&self.follow_strands),
            "look.follow_strands",
            &self.follow_strands,
            "1 to 1024",
        )?;
        require_range("look.width_scale", self.width_scale, 0.0, 1e3, "0 to 1000")?;
        require_range("look.tip_width", self.tip_width, 0.0, 1.0, "0 to 1")?;
        self.clump.validate()
    }
}

impl Clump {
    fn validate(&self) -> Result<(), RenderError> {
        require_range("look.clump.root_radius", self.root_radius, 0.0, 1.0, "0 to 1 m")?;
        require_range("look.clump.tip_radius", self.tip_radius, 0.0, 1.0, "0 to 1 m")?;
        require_range("look.clump.taper", self.taper, 0.1, 10.0, "0.1 to 10")?;
        require_range("look.clump.lift", self.lift, 0.0, 1.0, "0 to 1")?;
        require_range("look.clump.shorter", self.shorter, 0.0, 0.9, "0 to 0.9")?;
        require_range("look.clump.wave_amplitude", self.wave_amplitude, 0.0, 1.0, "0 to 1 m")?;
        require_range("look.clump.wave_length", self.wave_length, 1e-3, 10.0, "0.001 to 10 m")
    }
}

/// An error about a setting unless it is `sound`.
pub(crate) fn require(
    sound: bool,
    name: &'static str,
    found: &dyn Display,
    expected: &'static str,
) -> Result<(), RenderError> {
    if sound { Ok(()) } else { Err(RenderError::Setting { name, found: found.to_string(), expected }) }
}

/// An error about a number unless it lies between two bounds; NaN lies nowhere.
pub(crate) fn require_range(
    name: &'static str,
    found: f32,
    least: f32,
    most: f32,
    expected: &'static str,
) -> Result<(), RenderError> {
    require((least..=most).contains(&found), name, &found, expected)
}
