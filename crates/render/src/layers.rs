//! Linear light and what else is known of each pixel, as channels of an OpenEXR file.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Vec2, WritableImage,
};
use strandline_base::WholeFile;

use crate::RenderError;

/// Channels of a picture, rows from the top.
///
/// `R`, `G`, `B`: radiance, linear, before exposure and tone map, times opacity; `A`: opacity. `depth.Z`: distance
/// along the view \[m\] of the hair where it covers half of a pixel, else of the body, infinite where neither is;
/// `mask.hair`: share of the pixel that hair covers; `tangent.X`, `.Y`, `.Z`: mean direction of that hair toward its tips, world
/// space; `motion.X`, `.Y`: displacement \[pixel\], to the right and down, since the picture drawn before, of the hair where
/// depth is the hair's, else of the body as its head moves, 0 in the first picture and where neither is; `strand.id`: number of
/// the nearest strand, from 1, 0 where none is.
///
/// A GPU draws light and numbers as half floats: light to 5e-4 of itself and up to 65,000, depth of hair to some 0.1 mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Width \[pixel\].
    pub width: u32,
    /// Height \[pixel\].
    pub height: u32,
    /// Names and values, shape `[row][column]`.
    pub channels: Vec<(String, Vec<f32>)>,
}

impl Layers {
    /// The channels as an OpenEXR file.
    ///
    /// # Errors
    /// Bytes of the encoder.
    pub fn encode(&self) -> Result<Vec<u8>, String> {
        let channel = |(name, values): &(String, Vec<f32>)| {
            AnyChannel::new(name.as_str(), FlatSamples::F32(values.clone()))
        };
        let channels = AnyChannels::sort(self.channels.iter().map(channel).collect());
        let size = Vec2(self.width as usize, self.height as usize);
        let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
        let mut bytes = Cursor::new(Vec::new());
        let written = Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes);
        written.map_err(|error| error.to_string())?;
        Ok(bytes.into_inner())
    }

    /// Writes them to a file, which appears under its name only once it is complete.
    ///
    /// # Errors
    /// [`RenderError::Save`], as for [`Picture::save`](crate::Picture::save).
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), RenderError> {
        let path = path.as_ref();
        let bytes = self.encode().map_err(std::io::Error::other);
        bytes
            .and_then(|bytes| WholeFile::save(path, &bytes))
            .map_err(|source| RenderError::Save { source, path: path.to_path_buf() })
    }
}
