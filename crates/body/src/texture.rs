//! Pictures on a body.

use std::io::Cursor;

use image::{ImageFormat, ImageReader, Limits};
use strandline_base::par::prelude::*;
use strandline_base::{math, memory};

/// Steps of linear light in the table of [`Srgb`].
const STEPS: usize = 1 << 14;

/// A picture on a body, sRGB with alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue and alpha, shape `[row][column]`, the first row at v = 0.
    pub texels: Vec<[u8; 4]>,
}

impl Texture {
    /// Longest side of a picture that is read \[texel\].
    pub const MOST_SIDE: u32 = 8192;

    /// Reads a .png or .jpeg file of at most `most` texels from its bytes.
    pub(crate) fn decode(bytes: &[u8], most: u64) -> Result<Self, String> {
        const KINDS: &str = "expected a .png or .jpeg";
        let format = match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            Ok(other) => return Err(format!("a picture of the kind {other:?}, {KINDS}")),
            Err(_) if bytes.starts_with(b"\xabKTX") => {
                return Err(format!("a picture of the kind KTX, {KINDS}"));
            }
            Err(_) => return Err(format!("no picture, {KINDS}")),
        };
        let reader = || ImageReader::with_format(Cursor::new(bytes), format);
        let (width, height) = reader().into_dimensions().map_err(|error| error.to_string())?;
        let count = u64::from(width) * u64::from(height);
        let side = Self::MOST_SIDE;
        if width.max(height) > side || count > most {
            return Err(format!("{width} x {height} texels, expected {side} on a side and {most} at most"));
        }
        // The picture as it is stored, of up to 16 bits a channel, and as it is kept.
        memory::check(&[memory::Need::new("a texture of the body", count, 12)])
            .map_err(|error| error.to_string())?;
        let mut limits = Limits::default();
        limits.max_alloc = Some(memory::most_unpacked(bytes.len() as u64).max(12 * count));
        let mut reader = reader();
        reader.limits(limits);
        let picture = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
        let texels = picture.pixels().map(|texel| texel.0).collect();
        Ok(Self { width, height, texels })
    }

    /// The picture at half its size, rounded down, in which texels count by their alpha.
    pub fn halved(&self, srgb: &Srgb) -> Self {
        let [width, height] = [self.width, self.height].map(|length| (length / 2).max(1));
        let mut texels = vec![[0; 4]; width as usize * height as usize];
        texels.par_chunks_mut(width as usize).enumerate().for_each(|(row, texels)| {
            for (column, texel) in texels.iter_mut().enumerate() {
                let at = |right: usize, down: usize| {
                    let x = (2 * column + right).min(self.width as usize - 1);
                    let y = (2 * row + down).min(self.height as usize - 1);
                    self.texels[y * self.width as usize + x]
                };
                *texel = srgb.mean([at(0, 0), at(1, 0), at(0, 1), at(1, 1)]);
            }
        });
        Self { width, height, texels }
    }

    /// Means of the channels, 0 to 1, as they are stored.
    pub(crate) fn means(&self) -> [f32; 4] {
        let mut sums = [0_u64; 4];
        for texel in &self.texels {
            sums.iter_mut().zip(texel).for_each(|(sum, part)| *sum += u64::from(*part));
        }
        sums.map(|sum| sum as f32 / (255.0 * self.texels.len().max(1) as f32))
    }

    /// True for as many texels as width and height say, at least one.
    pub fn is_whole(&self) -> bool {
        !self.texels.is_empty() && self.texels.len() as u64 == u64::from(self.width) * u64::from(self.height)
    }
}

/// Tables between stored colours and linear light \[IEC 61966-2-1\].
#[derive(Clone, Debug)]
pub struct Srgb {
    /// Linear light of each stored number.
    pub linear: [f32; 256],
    stored: Vec<u8>,
}

impl Default for Srgb {
    fn default() -> Self {
        let linear = std::array::from_fn(|stored| {
            let part = stored as f32 / 255.0;
            if part <= 0.040_45 { part / 12.92 } else { math::powf((part + 0.055) / 1.055, 2.4) }
        });
        let stored = (0..=STEPS).map(|step| {
            let part = step as f32 / STEPS as f32;
            let stored =
                if part <= 0.003_130_8 { 12.92 * part } else { 1.055 * math::powf(part, 1.0 / 2.4) - 0.055 };
            (255.0 * stored + 0.5) as u8
        });
        Self { linear, stored: stored.collect() }
    }
}

impl Srgb {
    /// The mean of four texels, weighted by their alpha; of four without alpha the plain mean.
    fn mean(&self, four: [[u8; 4]; 4]) -> [u8; 4] {
        let alpha: f32 = four.iter().map(|texel| f32::from(texel[3])).sum();
        let weight = |texel: &[u8; 4]| if alpha > 0.0 { f32::from(texel[3]) / alpha } else { 0.25 };
        let channel = |channel: usize| {
            let light: f32 =
                four.iter().map(|texel| self.linear[usize::from(texel[channel])] * weight(texel)).sum();
            self.stored[((light * STEPS as f32 + 0.5) as usize).min(STEPS)]
        };
        [channel(0), channel(1), channel(2), (0.25 * alpha + 0.5) as u8]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_means_of_light_among_texels_that_are_seen() {
        let square = |texels: [[u8; 4]; 4]| Texture { width: 2, height: 2, texels: texels.to_vec() };
        let half = square([[255, 0, 0, 255], [0, 0, 0, 255], [9, 255, 9, 0], [9, 255, 9, 0]]);
        let half = half.halved(&Srgb::default());
        assert_eq!((half.width, half.height), (1, 1));
        // Half the light of red is stored as 188, and the transparent green colours nothing.
        assert_eq!(half.texels, [[188, 0, 0, 128]]);
        let clear = square([[10, 20, 30, 0]; 4]).halved(&Srgb::default());
        assert_eq!(clear.texels, [[10, 20, 30, 0]]);
        let srgb = Srgb::default();
        for stored in 0..=255 {
            assert_eq!(srgb.mean([[stored, 0, 0, 255]; 4])[0], stored);
        }
    }

    #[test]
    fn other_pictures_are_refused_by_name() {
        let refused = |bytes: &[u8]| Texture::decode(bytes, 100).unwrap_err();
        assert!(refused(b"RIFF\0\0\0\0WEBPVP8 ").contains("WebP"), "{}", refused(b"RIFF\0\0\0\0WEBPVP8 "));
        assert!(refused(b"\xabKTX 20\xbb\r\n\x1a\n").contains("KTX"));
        assert!(refused(b"hello").contains("no picture"));
        let mut png = Vec::new();
        image::RgbImage::new(20, 6).write_to(&mut Cursor::new(&mut png), ImageFormat::Png).unwrap();
        assert!(refused(&png).contains("20 x 6 texels"), "{}", refused(&png));
        assert!(Texture::decode(&png, 120).unwrap().is_whole());
        assert!(Texture::decode(&png[..40], 120).is_err());
    }
}
