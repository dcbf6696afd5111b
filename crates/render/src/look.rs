use std::fmt::Display;

use serde::{Deserialize, Serialize};

use crate::{Environment, RenderError};

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
    /// How hair and body cast shadows.
    pub shadow: Shadow,
    /// Light from all around.
    pub environment: Environment,
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

/// How hair and body cast shadows [Yuksel2008].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Shadow {
    /// Texels along each side of a light's maps, 16 to 4,096. Default 512.
    pub map_size: u32,
    /// Distances \[m\] behind the first hair at which the three layers end, rising.
    /// Default 0.004, 0.016, 0.06.
    pub layers: [f32; 3],
    /// Share of the light that one hair takes away where it is crossed, 0 to 0.99. Default 0.3: most of
    /// what meets a hair goes on, scattered forward.
    pub opacity: f32,
    /// Depth \[m\] under the body's surface at which its shadow begins. Default 0.004.
    pub body_bias: f32,
    /// Depth \[m\] over which that shadow grows to its full. Default 0.008.
    pub body_softness: f32,
}

impl Default for Shadow {
    fn default() -> Self {
        Self {
            map_size: 512,
            layers: [0.004, 0.016, 0.06],
            opacity: 0.3,
            body_bias: 0.004,
            body_softness: 0.008,
        }
    }
}

impl Shadow {
    /// Logarithm of the share of light that one hair lets through.
    pub(crate) fn log_transmission(&self) -> f32 {
        (1.0 - self.opacity).ln()
    }

    fn validate(&self) -> Result<(), RenderError> {
        let sizes = 16..=4096;
        require(sizes.contains(&self.map_size), "look.shadow.map_size", &self.map_size, "16 to 4096")?;
        let [first, second, third] = self.layers;
        let rising = 1e-6 < first && first < second && second < third && third < 1e3;
        let found = format!("{:?}", self.layers);
        require(rising, "look.shadow.layers", &found, "three rising distances, 0.000001 to 1000 m")?;
        require_range("look.shadow.opacity", self.opacity, 0.0, 0.99, "0 to 0.99")?;
        require_range("look.shadow.body_bias", self.body_bias, 0.0, 1.0, "0 to 1 m")?;
        require_range("look.shadow.body_softness", self.body_softness, 1e-6, 1.0, "0.000001 to 1 m")
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
            shadow: Shadow::default(),
            environment: Environment::default(),
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
        self.environment.validate()?;
        self.shadow.validate()?;
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
