use serde::{Deserialize, Serialize};

use super::Style;
use crate::GroomError;

/// How to grow a style. Every number has a default that depends on the style.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Given")]
pub struct StyleSettings {
    /// The style.
    pub style: Style,
    /// Number of strands, 1 to 8,000,000. Default 2,000: guides for the renderer's follow strands.
    pub strand_count: usize,
    /// Seed of every random choice. Default 1.
    pub seed: u64,
    /// Greatest length \[m\] of a strand before curls.
    pub length: f32,
    /// Share by which lengths differ from strand to strand, 0 to 0.9.
    pub length_variation: f32,
    /// Height \[m\], head space, at which falling hair is cut level.
    pub cut_height: f32,
    /// Height \[m\] over which the cut is spread, hair from the crown ending highest; 0 cuts level.
    pub layering: f32,
    /// How far the ends turn under, toward the neck, 0 to 2.
    pub turn_under: f32,
    /// Place of the parting \[m\], positive on the head's left.
    pub parting: f32,
    /// Turn \[rad\] of the hair around the whorl.
    pub swirl: f32,
    /// Thickness \[m\] of the hair that lies on the skull.
    pub volume: f32,
    /// Width \[m\] of a clump at the roots.
    pub clump_width: f32,
    /// How far strands are drawn to the middle of their clump at the tip, 0 to 1.
    pub clump_share: f32,
    /// Amplitude \[m\] of waves.
    pub wave_amplitude: f32,
    /// Length \[m\] of a wave.
    pub wave_length: f32,
    /// Radius \[m\] of curls.
    pub curl_radius: f32,
    /// Length \[m\] of hair for one turn of a curl.
    pub curl_length: f32,
    /// Amplitude \[m\] of each strand's own disorder at the tip.
    pub noise: f32,
}

/// What a scene file gives; the rest comes from the style.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Given {
    style: Style,
    strand_count: Option<usize>,
    seed: Option<u64>,
    length: Option<f32>,
    length_variation: Option<f32>,
    cut_height: Option<f32>,
    layering: Option<f32>,
    turn_under: Option<f32>,
    parting: Option<f32>,
    swirl: Option<f32>,
    volume: Option<f32>,
    clump_width: Option<f32>,
    clump_share: Option<f32>,
    wave_amplitude: Option<f32>,
    wave_length: Option<f32>,
    curl_radius: Option<f32>,
    curl_length: Option<f32>,
    noise: Option<f32>,
}

impl From<Given> for StyleSettings {
    fn from(given: Given) -> Self {
        let plain = Self::new(given.style);
        Self {
            style: given.style,
            strand_count: given.strand_count.unwrap_or(plain.strand_count),
            seed: given.seed.unwrap_or(plain.seed),
            length: given.length.unwrap_or(plain.length),
            length_variation: given.length_variation.unwrap_or(plain.length_variation),
            cut_height: given.cut_height.unwrap_or(plain.cut_height),
            layering: given.layering.unwrap_or(plain.layering),
            turn_under: given.turn_under.unwrap_or(plain.turn_under),
            parting: given.parting.unwrap_or(plain.parting),
            swirl: given.swirl.unwrap_or(plain.swirl),
            volume: given.volume.unwrap_or(plain.volume),
            clump_width: given.clump_width.unwrap_or(plain.clump_width),
            clump_share: given.clump_share.unwrap_or(plain.clump_share),
            wave_amplitude: given.wave_amplitude.unwrap_or(plain.wave_amplitude),
            wave_length: given.wave_length.unwrap_or(plain.wave_length),
            curl_radius: given.curl_radius.unwrap_or(plain.curl_radius),
            curl_length: given.curl_length.unwrap_or(plain.curl_length),
            noise: given.noise.unwrap_or(plain.noise),
        }
    }
}

impl Default for StyleSettings {
    fn default() -> Self {
        Self::new(Style::default())
    }
}

impl StyleSettings {
    /// The style as it is meant to be.
    pub fn new(style: Style) -> Self {
        let long = Self {
            style,
            strand_count: 2000,
            seed: 1,
            length: 0.52,
            length_variation: 0.10,
            cut_height: -0.27,
            layering: 0.02,
            turn_under: 0.0,
            parting: 0.0,
            swirl: 0.0,
            volume: 0.012,
            clump_width: 0.020,
            clump_share: 0.35,
            wave_amplitude: 0.0,
            wave_length: 0.07,
            curl_radius: 0.0,
            curl_length: 0.05,
            noise: 0.003,
        };
        match style {
            Style::Long => long,
            Style::Bob => Self {
                length: 0.34,
                length_variation: 0.03,
                cut_height: -0.112,
                layering: 0.004,
                turn_under: 0.7,
                parting: 0.025,
                volume: 0.016,
                clump_share: 0.15,
                noise: 0.0015,
                ..long
            },
            Style::Wavy => Self {
                layering: 0.06,
                volume: 0.017,
                parting: 0.02,
                clump_width: 0.022,
                clump_share: 0.55,
                wave_amplitude: 0.011,
                wave_length: 0.095,
                ..long
            },
            Style::Curly => Self {
                length: 0.34,
                length_variation: 0.25,
                cut_height: -0.175,
                layering: 0.09,
                parting: -0.02,
                volume: 0.026,
                clump_width: 0.017,
                clump_share: 0.7,
                curl_radius: 0.0085,
                curl_length: 0.06,
                noise: 0.005,
                ..long
            },
            Style::Pixie => Self {
                length: 0.075,
                length_variation: 0.25,
                cut_height: -0.105,
                parting: 0.03,
                swirl: 0.35,
                volume: 0.010,
                clump_width: 0.0155,
                clump_share: 0.35,
                noise: 0.004,
                ..long
            },
            Style::Ponytail => Self {
                length: 0.50,
                length_variation: 0.15,
                cut_height: -0.25,
                volume: 0.009,
                clump_width: 0.025,
                clump_share: 0.25,
                wave_amplitude: 0.003,
                wave_length: 0.12,
                noise: 0.002,
                ..long
            },
        }
    }

    /// Points of a grown strand: more where it bends more.
    pub(super) fn points(&self) -> usize {
        if self.curl_radius > 0.0 {
            64
        } else if self.wave_amplitude > 0.0 {
            32
        } else {
            24
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first that is outside its range.
    pub fn validate(&self) -> Result<(), GroomError> {
        if !(1..=8_000_000).contains(&self.strand_count) {
            let found = self.strand_count.to_string();
            return Err(GroomError::Setting { name: "style.strand_count", found, expected: "1 to 8000000" });
        }
        let ranges: [(&'static str, f32, f32, f32, &'static str); 15] = [
            ("style.length", self.length, 0.01, 2.0, "0.01 to 2 m"),
            ("style.length_variation", self.length_variation, 0.0, 0.9, "0 to 0.9"),
            ("style.cut_height", self.cut_height, -10.0, 1.0, "-10 to 1 m"),
            ("style.layering", self.layering, 0.0, 0.5, "0 to 0.5 m"),
            ("style.turn_under", self.turn_under, 0.0, 2.0, "0 to 2"),
            ("style.parting", self.parting, -0.07, 0.07, "-0.07 to 0.07 m"),
            ("style.swirl", self.swirl, -3.0, 3.0, "-3 to 3 rad"),
            ("style.volume", self.volume, 0.001, 0.1, "0.001 to 0.1 m"),
            ("style.clump_width", self.clump_width, 0.002, 0.2, "0.002 to 0.2 m"),
            ("style.clump_share", self.clump_share, 0.0, 1.0, "0 to 1"),
            ("style.wave_amplitude", self.wave_amplitude, 0.0, 0.1, "0 to 0.1 m"),
            ("style.wave_length", self.wave_length, 0.005, 2.0, "0.005 to 2 m"),
            ("style.curl_radius", self.curl_radius, 0.0, 0.1, "0 to 0.1 m"),
            ("style.curl_length", self.curl_length, 0.005, 2.0, "0.005 to 2 m"),
            ("style.noise", self.noise, 0.0, 0.1, "0 to 0.1 m"),
        ];
        for (name, value, least, most, expected) in ranges {
            if !(least..=most).contains(&value) {
                return Err(GroomError::Setting { name, found: value.to_string(), expected });
            }
        }
        Ok(())
    }
}
