//! A picture of radiance from every direction.

use std::path::{Path, PathBuf};

use glam::Vec3;
use strandline_base::read_plain;

use super::size::{MAX_PIXELS, check_size};
use super::{exr, hdr};
use crate::RenderError;

/// Radiance from every direction, linear RGB, rows from straight above to straight below, twice as wide as high.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    width: usize,
    pixels: Vec<Vec3>,
}

impl Panorama {
    /// Largest file that is read \[bytes\].
    pub const MAX_BYTES: u64 = 1 << 29;
    /// Most pixels that are read: 8,192 x 4,096.
    pub const MAX_PIXELS: usize = MAX_PIXELS;
    /// Brightest pixel: the sun at noon has some 1e5 beside a sky of 1. Sums of brighter ones may overflow.
    pub const MAX_LIGHT: f32 = 1e9;

    /// A picture of pixels, shape `[row][column]`.
    ///
    /// # Errors
    /// Another shape; a number below 0 or above [`Panorama::MAX_LIGHT`].
    pub fn new(width: usize, height: usize, pixels: Vec<Vec3>) -> Result<Self, String> {
        check_size(width, height)?;
        if pixels.len() != width * height {
            return Err(format!("it has {} pixels, expected {width} x {height}", pixels.len()));
        }
        let sound = |pixel: &Vec3| {
            pixel.is_finite() && pixel.min_element() >= 0.0 && pixel.max_element() <= Self::MAX_LIGHT
        };
        match pixels.iter().position(|pixel| !sound(pixel)) {
            None => Ok(Self { width, pixels }),
            Some(at) => Err(format!(
                "the pixel in column {} of row {} is {}, expected light of 0 to 1e9",
                at % width,
                at / width,
                pixels[at]
            )),
        }
    }

    /// Reads a .hdr (Radiance) or .exr (OpenEXR) picture.
    ///
    /// # Errors
    /// Content found and content expected.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let (width, height, pixels) = if bytes.starts_with(b"#?") {
            hdr::read(bytes)?
        } else if bytes.starts_with(&exr::MAGIC) {
            exr::read(bytes)?
        } else {
            return Err("neither a .hdr picture (which starts with `#?`) nor an OpenEXR file".to_owned());
        };
        Self::new(width, height, pixels)
    }

    /// Loads such a picture.
    ///
    /// # Errors
    /// [`RenderError::Surroundings`].
    pub fn load(path: &Path) -> Result<Self, RenderError> {
        let failed = |problem| RenderError::Surroundings { problem, path: PathBuf::from(path) };
        let bytes = read_plain(path, Self::MAX_BYTES).map_err(|error| failed(error.into()))?;
        Self::read(&bytes).map_err(|found| failed(found.into()))
    }

    /// Width and height \[pixel\].
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.pixels.len() / self.width]
    }

    /// Radiance, linear RGB, shape `[row][column]`.
    pub fn pixels(&self) -> &[Vec3] {
        &self.pixels
    }

    /// Means of blocks, with at most `rows` rows if the number of rows can be halved so far.
    pub(super) fn reduced(&self, rows: usize) -> Self {
        let can = |of: &Self| of.size()[1] > rows && of.size()[1].is_multiple_of(2);
        if !can(self) {
            return self.clone();
        }
        let mut small = self.halved();
        while can(&small) {
            small = small.halved();
        }
        small
    }

    /// Means of blocks of two by two pixels.
    fn halved(&self) -> Self {
        let [width, height] = self.size().map(|side| side / 2);
        let mean = |index: usize| {
            let (column, row) = (index % width, index / width);
            let pixel = |x, y| self.pixels[(2 * row + y) * 2 * width + 2 * column + x];
            0.25 * (pixel(0, 0) + pixel(1, 0) + pixel(0, 1) + pixel(1, 1))
        };
        Self { width, pixels: (0..width * height).map(mean).collect() }
    }
}
