//! `resolve`: from samples to pixels [Chen2011 §3.5] (frame/filter.rs); then exposure, tone map, sRGB.

use glam::{Vec3, Vec4};
use strandline_base::math;
use strandline_base::par::prelude::*;

use crate::frame::filter::Filter;
use crate::frame::samples::Samples;
use crate::{Picture, PictureSettings, ToneMap};

/// Rows of pixels handled together by one thread.
const CHUNK: usize = 8;
/// Light at which the filmic curve leaves the straight line.
const KNEE: f32 = 0.6;
/// Entries of the table from linear light to sRGB: at the steepest place, near black, one entry is
/// 0.2 of an 8-bit step.
const TABLE: usize = 16_384;

/// The stage and its state from frame to frame.
#[derive(Debug)]
pub struct Resolve {
    /// 8-bit sRGB of linear light 0..1 in equal steps.
    srgb: Vec<u8>,
}

impl Default for Resolve {
    fn default() -> Self {
        let linear = |index: usize| index as f32 / (TABLE - 1) as f32;
        Self { srgb: (0..TABLE).map(|index| (srgb(linear(index)) * 255.0 + 0.5) as u8).collect() }
    }
}

impl Resolve {
    /// Fills a picture from samples.
    pub fn resolve(&self, samples: &Samples, settings: &PictureSettings, picture: &mut Picture) {
        let (width, height) = (settings.width as usize, settings.height as usize);
        picture.width = settings.width;
        picture.height = settings.height;
        picture.pixels.resize(width * height * 3, 0);
        let rows = picture.pixels.par_chunks_mut(CHUNK * width * 3).enumerate();
        if settings.transparent {
            let alpha = picture.alpha.get_or_insert_default();
            alpha.resize(width * height, 0);
            rows.zip(alpha.par_chunks_mut(CHUNK * width)).for_each(|((chunk, pixels), alpha)| {
                self.rows(samples, settings, chunk * CHUNK, pixels, Some(alpha));
            });
        } else {
            picture.alpha = None;
            rows.for_each(|(chunk, pixels)| self.rows(samples, settings, chunk * CHUNK, pixels, None));
        }
    }

    fn rows(
        &self,
        samples: &Samples,
        settings: &PictureSettings,
        first: usize,
        pixels: &mut [u8],
        mut alpha: Option<&mut [u8]>,
    ) {
        let width = settings.width as usize;
        let gain = math::exp2(settings.exposure);
        let mut filter = Filter::new(samples, settings);
        for (row, pixels) in pixels.chunks_exact_mut(width * 3).enumerate() {
            let colors = filter.row(first + row);
            let (pixels, _) = pixels.as_chunks_mut::<3>();
            for (pixel, &color) in pixels.iter_mut().zip(colors) {
                *pixel = self.encode(settings.tone_map.apply(straight(color) * gain));
            }
            if let Some(alpha) = &mut alpha {
                for (alpha, color) in alpha[row * width..].iter_mut().zip(colors) {
                    *alpha = (color.w.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
                }
            }
        }
    }

    /// Linear light of 0..1 as 8-bit sRGB.
    fn encode(&self, color: Vec3) -> [u8; 3] {
        // A NaN becomes index 0.
        let index = |linear: f32| ((linear * (TABLE - 1) as f32 + 0.5) as usize).min(TABLE - 1);
        color.to_array().map(|linear| self.srgb[index(linear)])
    }
}

/// Colour of a pixel that is not multiplied by its opacity.
fn straight(color: Vec4) -> Vec3 {
    let opacity = color.w;
    if opacity >= 1.0 || opacity <= 0.0 { color.truncate() } else { color.truncate() / opacity }
}

impl ToneMap {
    /// Brings linear light into 0..1.
    ///
    /// The filmic curve maps the largest component and scales the others along, so that hue stays; the compression turns
    /// the colour toward white, as film does. The curve of ACES maps each component.
    #[inline]
    pub fn apply(self, light: Vec3) -> Vec3 {
        let light = light.max(Vec3::ZERO);
        if self == Self::Aces {
            // [Narkowicz2015]
            let shown = light * (light * 2.51 + 0.03) / (light * (light * 2.43 + 0.59) + 0.14);
            return shown.min(Vec3::ONE);
        }
        let peak = light.max_element();
        if self == Self::Off || peak <= KNEE {
            return light.min(Vec3::ONE);
        }
        let shown = shoulder(peak);
        // 0 at the knee, toward 1 far above.
        let faded = 1.0 - (shown / peak).sqrt();
        (light * (shown / peak)).lerp(Vec3::splat(shown), faded * faded)
    }
}

/// The identity up to the knee, then an exponential approach to 1 that starts with slope 1.
fn shoulder(light: f32) -> f32 {
    if light <= KNEE { light } else { 1.0 - (1.0 - KNEE) * math::exp(-(light - KNEE) / (1.0 - KNEE)) }
}

/// Linear light of 0..1 as sRGB [IEC61966-2-1].
fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * math::powf(linear, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::filter::resolve_linear;

    fn constant(color: Vec4, settings: &PictureSettings) -> Samples {
        let mut samples = Samples::default();
        let scale = settings.supersampling;
        samples.resize((settings.width * scale) as usize, (settings.height * scale) as usize);
        samples.colors.fill(color);
        samples
    }

    #[test]
    fn a_constant_picture_stays_constant() {
        let color = Vec4::new(0.5, 0.25, 0.125, 1.0);
        for supersampling in [1, 2] {
            let settings = PictureSettings { supersampling, ..PictureSettings::sized(37, 21) };
            let pixels = resolve_linear(&constant(color, &settings), &settings);
            // Weights and colours are short binary fractions: sums are exact.
            assert!(pixels.iter().all(|&pixel| pixel == color));
        }
    }

    #[test]
    fn every_sample_inside_gives_a_quarter() {
        let settings = PictureSettings::sized(20, 20);
        for (column, row) in [(10, 10), (11, 10), (10, 11), (13, 17)] {
            let mut samples = constant(Vec4::ZERO, &settings);
            let index = samples.index(column, row);
            samples.colors[index] = Vec4::ONE;
            let pixels = resolve_linear(&samples, &settings);
            assert_eq!(pixels.iter().copied().sum::<Vec4>(), Vec4::splat(0.25));
            assert_eq!(pixels[row / 2 * 20 + column / 2], Vec4::splat(5.0 / 32.0));
        }
    }

    #[test]
    fn tone_mapping_is_monotone_keeps_hue_and_stays_in_range() {
        for tone_map in [ToneMap::Off, ToneMap::Filmic, ToneMap::Aces] {
            let mut last = Vec3::ZERO;
            for step in 0..4000 {
                let light = Vec3::new(1.0, 0.6, 0.2) * (step as f32 * 0.005);
                let shown = tone_map.apply(light);
                assert!(shown.max_element() <= 1.0);
                // Rounding of a handful of f32 operations on numbers below 1.
                assert!((shown - last).min_element() >= -1e-6, "{light}: {last} to {shown}");
                last = shown;
            }
        }
        let shown = ToneMap::Filmic.apply(Vec3::new(4.0, 2.0, 1.0));
        assert!(shown.x > shown.y && shown.y > shown.z);
        // Toward white in equal shares: (r - g) / (g - b) is kept.
        assert!(((shown.x - shown.y) / (shown.y - shown.z) - 2.0).abs() < 1e-3);
        assert_eq!(ToneMap::Filmic.apply(Vec3::splat(0.5)), Vec3::splat(0.5));
    }

    #[test]
    fn opacity_is_written_only_when_asked_for() {
        let color = Vec4::new(0.25, 0.25, 0.25, 0.5);
        let mut picture = Picture::default();
        let resolve = Resolve::default();
        let sized = PictureSettings { tone_map: ToneMap::Off, ..PictureSettings::sized(19, 11) };
        let settings = PictureSettings { transparent: true, ..sized };
        resolve.resolve(&constant(color, &settings), &settings, &mut picture);
        assert!(picture.alpha.as_ref().unwrap().iter().all(|&alpha| alpha == 128));
        // 0.5 linear is 188 in sRGB.
        assert!(picture.pixels.iter().all(|&value| value == 188));
        let settings = PictureSettings { transparent: false, ..settings };
        resolve.resolve(&constant(color, &settings), &settings, &mut picture);
        assert_eq!(picture.alpha, None);
    }
}
