use glam::Vec3;
use strandline_base::{Group, choices, settings};
use strandline_gpu::Backend;

use crate::RenderError;

settings! {
    /// Size of a picture, and conversion of light to colour.
    pub struct PictureSettings: Copy {
        /// Width.
        width: u32 = 800, in [1, PictureSettings::MAX_SIZE] "pixel";
        /// Height.
        height: u32 = 600, in [1, PictureSettings::MAX_SIZE] "pixel";
        /// Samples along each axis of a pixel.
        supersampling: u32 = 2, in [1, 2], more "smoother edges at four times the cost";
        /// Exposure; one more doubles the light.
        exposure: f32 = 0.0, in [-16.0, 16.0] "stops", slider [-4.0, 4.0], more "a brighter picture";
        /// Mapping of light beyond white.
        tone_map: ToneMap = ToneMap::default();
        /// The background.
        background: Background = Background::default();
        /// Leaves the background out and writes opacity instead.
        transparent: bool = false;
        /// Keeps linear light, depth, the hair's coverage, its directions and strands too, as for an .exr
        /// file.
        layers: bool = false;
        moved { backend: Backend => "devices.pictures" }
    }
}

choices! {
    /// Mapping of light beyond white.
    pub enum ToneMap as "picture.tone_map" {
        /// Cut off at 1.
        Off = "off",
        /// Unchanged up to a knee, then rolled off smoothly toward white; the hue stays.
        Filmic = "filmic",
        /// With a toe, a long shoulder and more contrast between, as film scanned with ACES [Narkowicz2015]. Each channel
        /// is mapped by itself, which makes colours more vivid and shifts bright brown toward orange.
        Aces = "aces",
    }
    default Filmic
}

settings! {
    /// A vertical gradient, linear RGB before exposure and tone map.
    pub struct Background: Copy {
        /// At the top of the picture.
        top: Vec3 = Vec3::new(0.13, 0.14, 0.155), in [0.0, 1000.0];
        /// At the bottom of the picture.
        bottom: Vec3 = Vec3::new(0.05, 0.054, 0.06), in [0.0, 1000.0];
    }
}

impl PictureSettings {
    /// Largest width and height \[pixel\].
    pub const MAX_SIZE: u32 = 16_384;
    /// Most memory that the samples of a picture may take \[MiB\].
    pub const MAX_MEMORY: u64 = 4096;
    /// Colour and opacity, depth and triangle of a sample, and its share of the finished pixel \[byte\].
    const SAMPLE_BYTES: u64 = 16 + 4 + 4 + 4;
    /// Channels of a pixel as they are gathered, as they are named, and as they are packed for the file \[byte\].
    const LAYERS_BYTES: u64 = 60 + 40 + 40;

    /// Default settings at a size \[pixel\].
    pub fn sized(width: u32, height: u32) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// Checks every field and the memory that the picture would take.
    ///
    /// # Errors
    /// A field outside its range, or samples beyond [`Self::MAX_MEMORY`].
    pub fn validate(&self) -> Result<(), RenderError> {
        self.check_as("picture")?;
        let needed = self.memory().div_ceil(1 << 20);
        if needed > Self::MAX_MEMORY {
            let what =
                format!("{} x {} pixels at supersampling {}", self.width, self.height, self.supersampling);
            return Err(RenderError::Memory { what, needed, allowed: Self::MAX_MEMORY });
        }
        Ok(())
    }

    /// Memory of the samples \[byte\].
    pub(crate) fn memory(&self) -> u64 {
        let samples = u64::from(self.width) * u64::from(self.height);
        let layers = if self.layers { samples * Self::LAYERS_BYTES } else { 0 };
        samples * u64::from(self.supersampling).pow(2) * Self::SAMPLE_BYTES + layers
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
