use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::RenderError;
use strandline_gpu::Backend;

/// How large a picture is and how light becomes colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PictureSettings {
    /// Where pictures of a scene are drawn: auto (default), cpu, gpu, or gpu:0 and so on for one of
    /// several. A renderer that is there already stays where it is.
    pub backend: Backend,
    /// Width \[pixel\], 1 to 16,384. Default 800.
    pub width: u32,
    /// Height \[pixel\], 1 to 16,384. Default 600.
    pub height: u32,
    /// Samples along each axis of a pixel: 1 or 2. Default 2.
    pub supersampling: u32,
    /// Exposure \[stops\], -16 to 16; one more doubles the light. Default 0.
    pub exposure: f32,
    /// How light beyond white is shown. Default filmic.
    pub tone_map: ToneMap,
    /// What is behind everything.
    pub background: Background,
    /// Leave the background out and write opacity instead. Default false.
    pub transparent: bool,
}

/// How light beyond white is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToneMap {
    /// Cut off at 1.
    Off,
    /// Unchanged up to a knee, then rolled off smoothly toward white.
    #[default]
    Filmic,
}

/// A vertical gradient, linear RGB as shown: neither exposure nor tone map changes its hue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Background {
    /// At the top of the picture.
    pub top: Vec3,
    /// At the bottom of the picture.
    pub bottom: Vec3,
}

impl Default for Background {
    fn default() -> Self {
        Self { top: Vec3::new(0.30, 0.33, 0.37), bottom: Vec3::new(0.11, 0.12, 0.135) }
    }
}

impl Default for PictureSettings {
    fn default() -> Self {
        Self {
            backend: Backend::Auto,
            width: 800,
            height: 600,
            supersampling: 2,
            exposure: 0.0,
            tone_map: ToneMap::default(),
            background: Background::default(),
            transparent: false,
        }
    }
}

impl PictureSettings {
    /// Largest width and height \[pixel\].
    pub const MAX_SIZE: u32 = 16_384;
    /// Most memory that the samples of a picture may take \[MiB\].
    pub const MAX_MEMORY: u64 = 4096;
    /// Colour and opacity, depth and triangle of a sample, and its share of the finished pixel \[byte\].
    const SAMPLE_BYTES: u64 = 16 + 4 + 4 + 4;

    /// Default settings at a size \[pixel\].
    pub fn sized(width: u32, height: u32) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// Checks every field and the memory that the picture would take.
    ///
    /// # Errors
    /// A field outside its range, or samples beyond [`Self::MAX_MEMORY`].
    pub fn validate(&self) -> Result<(), RenderError> {
        let refuse = |name, found: String, expected| Err(RenderError::Setting { name, found, expected });
        for (name, size) in [("width", self.width), ("height", self.height)] {
            if !(1..=Self::MAX_SIZE).contains(&size) {
                return refuse(name, size.to_string(), "1 to 16384 pixels");
            }
        }
        if !(1..=2).contains(&self.supersampling) {
            return refuse("supersampling", self.supersampling.to_string(), "1 or 2");
        }
        if !(-16.0..=16.0).contains(&self.exposure) {
            return refuse("exposure", self.exposure.to_string(), "-16 to 16 stops");
        }
        for (name, color) in
            [("background.top", self.background.top), ("background.bottom", self.background.bottom)]
        {
            if !(color.is_finite() && color.cmpge(Vec3::ZERO).all()) {
                return refuse(name, color.to_string(), "finite numbers of 0 or more");
            }
        }
        let samples = u64::from(self.width) * u64::from(self.height) * u64::from(self.supersampling.pow(2));
        let needed = (samples * Self::SAMPLE_BYTES).div_ceil(1 << 20);
        if needed > Self::MAX_MEMORY {
            let what =
                format!("{} x {} pixels at supersampling {}", self.width, self.height, self.supersampling);
            return Err(RenderError::Memory { what, needed, allowed: Self::MAX_MEMORY });
        }
        Ok(())
    }

    /// Width over height.
    pub fn aspect(&self) -> f32 {
        self.width as f32 / self.height as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked_before_anything_is_allocated() {
        PictureSettings::default().validate().unwrap();
        PictureSettings { supersampling: 1, ..PictureSettings::sized(8192, 8192) }.validate().unwrap();
        for (width, height) in [(0, 600), (800, 0), (16_385, 1), (1, u32::MAX)] {
            let error = PictureSettings::sized(width, height).validate().unwrap_err();
            assert!(matches!(error, RenderError::Setting { .. }), "{error}");
        }
        let error = PictureSettings::sized(16_384, 16_384).validate().unwrap_err();
        assert!(error.to_string().contains("28672 MiB"), "{error}");
    }

    #[test]
    fn other_fields_are_refused_by_name() {
        let good = PictureSettings::default();
        let bad = [
            (PictureSettings { supersampling: 3, ..good }, "supersampling"),
            (PictureSettings { exposure: f32::NAN, ..good }, "exposure"),
            (
                PictureSettings { background: Background { top: Vec3::NEG_ONE, ..good.background }, ..good },
                "background.top",
            ),
        ];
        for (settings, name) in bad {
            assert!(settings.validate().unwrap_err().to_string().contains(name));
        }
    }
}
