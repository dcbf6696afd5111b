use std::io::Write;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};

use strandline_base::WholeFile;

use crate::RenderError;

/// A finished picture: 8-bit sRGB, rows from the top, shape `[row][column][channel]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    /// Width \[pixel\].
    pub width: u32,
    /// Height \[pixel\].
    pub height: u32,
    /// RGB, three bytes a pixel. Not multiplied by `alpha`.
    pub pixels: Vec<u8>,
    /// Opacity, one byte a pixel, of a picture drawn with a transparent background.
    pub alpha: Option<Vec<u8>>,
}

impl Picture {
    /// True if every row has one colour: a picture of nothing, or of the background, which changes from top
    /// to bottom.
    pub fn is_blank(&self) -> bool {
        let mut rows = self.pixels.chunks_exact(3 * self.width.max(1) as usize);
        rows.all(|row| row.chunks_exact(3).all(|pixel| *pixel == row[..3]))
    }

    /// Writes the picture as PNG. The file appears under its name only once it is complete.
    ///
    /// # Errors
    /// [`RenderError::Save`] for a folder that is missing or cannot be written and for a full disk;
    /// no half-written file is left behind.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), RenderError> {
        let path = path.as_ref();
        WholeFile::write(path, |file| self.encode(file))
            .and_then(WholeFile::keep)
            .map_err(|source| RenderError::Save { source, path: path.to_path_buf() })
    }

    /// Writes the picture as PNG to `sink`.
    ///
    /// # Errors
    /// Whatever the sink reports.
    pub fn encode(&self, sink: impl Write) -> std::io::Result<()> {
        let encoder = PngEncoder::new(sink);
        let outcome = match &self.alpha {
            None => encoder.write_image(&self.pixels, self.width, self.height, ExtendedColorType::Rgb8),
            Some(_) => {
                encoder.write_image(&self.interleaved(), self.width, self.height, ExtendedColorType::Rgba8)
            }
        };
        outcome.map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => std::io::Error::other(other),
        })
    }

    /// RGBA, four bytes a pixel; opaque where the picture carries no alpha.
    pub fn interleaved(&self) -> Vec<u8> {
        let opacity = |pixel: usize| self.alpha.as_ref().map_or(255, |alpha| alpha[pixel]);
        let (colors, _) = self.pixels.as_chunks::<3>();
        colors.iter().enumerate().flat_map(|(pixel, &[r, g, b])| [r, g, b, opacity(pixel)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient(alpha: bool) -> Picture {
        let pixels = (0..5 * 3 * 3).map(|byte| byte as u8 * 5).collect();
        let alpha = alpha.then(|| (0..15).map(|pixel| pixel * 17).collect());
        Picture { width: 5, height: 3, pixels, alpha }
    }

    #[test]
    fn a_background_alone_is_blank_and_one_pixel_more_is_not() {
        let pixels = (0..5 * 3 * 3).map(|byte| byte as u8 / 15).collect();
        let mut picture = Picture { width: 5, height: 3, pixels, alpha: None };
        assert!(picture.is_blank());
        picture.pixels[20] += 1;
        assert!(!picture.is_blank());
    }

    #[test]
    fn a_saved_picture_reads_back_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        for alpha in [false, true] {
            let picture = gradient(alpha);
            let path = folder.path().join("picture.png");
            picture.save(&path).unwrap();
            let read = image::ImageReader::open(&path).unwrap().decode().unwrap();
            assert_eq!(read.color().has_alpha(), alpha);
            assert_eq!(read.into_rgba8().into_raw(), picture.interleaved());
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_is_named_with_its_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nowhere").join("picture.png");
        let message = gradient(false).save(&path).unwrap_err().to_string();
        assert!(message.contains("create it first") && message.ends_with("picture.png"), "{message}");
        let file = folder.path().join("file");
        std::fs::write(&file, b"x").unwrap();
        let message = gradient(false).save(file.join("picture.png")).unwrap_err().to_string();
        assert!(message.contains("its folder is a file"), "{message}");
    }
}
