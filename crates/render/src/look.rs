use std::fmt::Display;

use glam::Vec3;
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
    /// Reflectance at the root. Default brown.
    pub root_color: Vec3,
    /// Reflectance at the tip. Default a lighter brown.
    pub tip_color: Vec3,
    /// Spread of brightness among strands as a share of it, 0 to 1. Default 0.35.
    pub variation: f32,
    /// Share of strands that have turned white, 0 to 1. Default 0.
    pub grey: f32,
    /// The white highlight, from the surface of the hair.
    pub first_highlight: Highlight,
    /// The coloured highlight, from light that crossed the hair.
    pub second_highlight: Highlight,
    /// Noise along and among strands by which both highlights are moved \[degrees\], 0 to 45. Default 4.
    pub highlight_noise: f32,
    /// How far a second noise breaks the second highlight up into sparkles, 0 to 1. Default 0.7.
    pub sparkle: f32,
    /// How much further light goes through bright hair than through black, 0 to 1. Default 0.6.
    pub translucency: f32,
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

/// A highlight on the hair \[Scheuermann2004\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Highlight {
    /// Angle \[degrees\] by which it is moved toward the tip, -45 to 45; below 0 toward the root.
    pub shift: f32,
    /// Its standard deviation along the strand \[degrees\], 0.5 to 60.
    pub width: f32,
    /// Share of the light that goes into it, 0 to 0.5.
    pub strength: f32,
}

impl Highlight {
    fn validate(&self) -> Result<(), RenderError> {
        require_range("look highlight shift", self.shift, -45.0, 45.0, "-45 to 45 degrees")?;
        require_range("look highlight width", self.width, 0.5, 60.0, "0.5 to 60 degrees")?;
        require_range("look highlight strength", self.strength, 0.0, 0.5, "0 to 0.5")
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

/// How hair and body cast shadows \[Yuksel2008\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Shadow {
    /// Texels along each side of a light's maps, 16 to 4,096; on a GPU 2,048 with two shadow lights, 1,024
    /// with eight. Default 512.
    pub map_size: u32,
    /// Distances \[m\] behind the first hair at which the three layers end, rising;
    /// hair farther behind it casts no shadow.
    /// Default 0.015, 0.05, 0.15.
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
            layers: [0.015, 0.05, 0.15],
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
            root_color: Vec3::new(0.115, 0.056, 0.027),
            tip_color: Vec3::new(0.22, 0.115, 0.058),
            variation: 0.35,
            grey: 0.0,
            first_highlight: Highlight { shift: -5.0, width: 5.0, strength: 0.07 },
            second_highlight: Highlight { shift: 7.0, width: 9.0, strength: 0.2 },
            highlight_noise: 4.0,
            sparkle: 0.7,
            translucency: 0.6,
            clump: Clump::default(),
            shadow: Shadow::default(),
            environment: Environment::default(),
            seed: 0,
        }
    }

    /// Black hair.
    pub fn black() -> Self {
        Self::colored([0.016, 0.013, 0.012], [0.026, 0.021, 0.019])
    }

    /// Blonde hair, lighter toward the tips.
    pub fn blonde() -> Self {
        Self::colored([0.46, 0.31, 0.165], [0.68, 0.51, 0.31])
    }

    /// Red hair.
    pub fn red() -> Self {
        Self::colored([0.34, 0.10, 0.035], [0.46, 0.165, 0.06])
    }

    /// Grey hair: dark strands among white ones.
    pub fn grey() -> Self {
        Self { grey: 0.6, ..Self::colored([0.17, 0.16, 0.15], [0.22, 0.21, 0.20]) }
    }

    fn colored(root_color: [f32; 3], tip_color: [f32; 3]) -> Self {
        Self { root_color: root_color.into(), tip_color: tip_color.into(), ..Self::brown() }
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
        for (name, color) in [("look.root_color", self.root_color), ("look.tip_color", self.tip_color)] {
            let sound = color.min_element() >= 0.0 && color.max_element() <= 1.0;
            require(sound, name, &color, "three numbers, 0 to 1")?;
        }
        require_range("look.variation", self.variation, 0.0, 1.0, "0 to 1")?;
        require_range("look.grey", self.grey, 0.0, 1.0, "0 to 1")?;
        require_range("look.highlight_noise", self.highlight_noise, 0.0, 45.0, "0 to 45 degrees")?;
        require_range("look.sparkle", self.sparkle, 0.0, 1.0, "0 to 1")?;
        require_range("look.translucency", self.translucency, 0.0, 1.0, "0 to 1")?;
        self.first_highlight.validate()?;
        self.second_highlight.validate()?;
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
