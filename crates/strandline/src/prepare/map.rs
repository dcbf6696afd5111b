//! A picture over the scalp: colours or widths by root coordinates.

use std::io::Cursor;
use std::path::Path;

use glam::{Vec2, Vec3};
use image::{DynamicImage, ImageFormat, ImageReader, RgbImage};
use strandline_base::{math, memory, read_plain};

use crate::{Error, Scene, render::Picture};

/// The linear colour and the share of white that a map over the scalp, the bytes of its file, has at a place.
///
/// # Errors
/// The bytes are no map.
#[doc(hidden)]
pub fn read_map(bytes: &[u8], uv: Vec2) -> Result<(Vec3, f32), String> {
    let map = Map::parse(bytes.to_vec())?;
    Ok((map.color(uv), map.share(uv)))
}

/// A picture over the scalp.
pub(super) struct Map {
    picture: DynamicImage,
}

impl Map {
    /// Reads a .png file.
    ///
    /// # Errors
    /// The file cannot be read, is no .png or has too many pixels.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let bytes = read_plain(path, Scene::MAX_MAP_BYTES).map_err(|error| Error::map(path, error))?;
        Self::parse(bytes).map_err(|found| Error::map(path, found))
    }

    /// A map of a picture in memory.
    ///
    /// # Errors
    /// The picture has no pixels, too many on a side, or another number than its size says.
    pub fn of_picture(picture: &Picture) -> Result<Self, String> {
        let (width, height, side) = (picture.width, picture.height, Scene::MAX_MAP_SIDE);
        let expected = format!("expected 1 to {side} pixels on a side, three bytes each");
        let is_sound = [width, height].iter().all(|length| (1..=side).contains(length));
        let pixels = RgbImage::from_raw(width, height, picture.pixels.clone()).filter(|_| is_sound);
        // Longer data than the size asks for would be cut off silently.
        let pixels =
            pixels.filter(|pixels| pixels.as_raw().len() == 3 * (width as usize) * (height as usize));
        let found = || format!("{width} x {height} pixels in {} bytes, {expected}", picture.pixels.len());
        Ok(Self { picture: pixels.ok_or_else(found)?.into() })
    }

    /// Number of pixels.
    pub fn pixel_count(&self) -> u64 {
        u64::from(self.picture.width()) * u64::from(self.picture.height())
    }

    fn parse(bytes: Vec<u8>) -> Result<Self, String> {
        let most = memory::most_unpacked(bytes.len() as u64);
        let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        let (mut limits, side) = (image::Limits::default(), Scene::MAX_MAP_SIDE);
        (limits.max_image_width, limits.max_image_height) = (Some(side), Some(side));
        limits.max_alloc = Some(most);
        reader.limits(limits);
        let expected = format!(
            "expected a .png of at most {side} x {side} pixels that unpack to {} MiB at most",
            most >> 20
        );
        let picture = reader.decode().map_err(|error| format!("{error}, {expected}"))?;
        Ok(Self {
            picture: if picture.color().has_color() {
                picture.into_rgb8().into()
            } else {
                picture.into_luma16().into()
            },
        })
    }

    /// The colour at a place, linear RGB.
    pub fn color(&self, uv: Vec2) -> Vec3 {
        self.at(uv, linear)
    }

    /// The share of white at a place.
    pub fn share(&self, uv: Vec2) -> f32 {
        self.at(uv, |part| part).element_sum() / 3.0
    }

    /// Interpolates the four pixels about a place; beyond the borders they repeat.
    fn at(&self, uv: Vec2, part: impl Fn(f32) -> f32) -> Vec3 {
        let size = Vec2::new(self.picture.width() as f32, self.picture.height() as f32);
        // The first row of a picture is its upper border.
        let at = (Vec2::new(uv.x, 1.0 - uv.y) * size - 0.5).clamp(Vec2::ZERO, size - 1.0);
        let low = at.floor();
        let share = at - low;
        let pixel = |x: f32, y: f32| {
            let [x, y] = [x.min(size.x - 1.0) as u32, y.min(size.y - 1.0) as u32];
            let parts = match &self.picture {
                DynamicImage::ImageRgb8(picture) => {
                    picture.get_pixel(x, y).0.map(|part| f32::from(part) / 255.0)
                }
                DynamicImage::ImageLuma16(picture) => [f32::from(picture.get_pixel(x, y).0[0]) / 65_535.0; 3],
                _ => [0.0; 3],
            };
            Vec3::from(parts.map(&part))
        };
        let row = |y: f32| pixel(low.x, y).lerp(pixel(low.x + 1.0, y), share.x);
        row(low.y).lerp(row(low.y + 1.0), share.y)
    }
}

/// A part of a colour of the screen \[IEC 61966-2-1\] as light.
fn linear(part: f32) -> f32 {
    if part <= 0.040_45 { part / 12.92 } else { math::powf((part + 0.055) / 1.055, 2.4) }
}
