//! The animated image, where there is no ffmpeg.

use std::io::{Error, Result, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use image::{
    Delay, DynamicImage, Frame,
    codecs::gif::{GifEncoder, Repeat},
};
use strandline_base::WholeFile;

use super::sheet::thumbnail;
use crate::render::Picture;

/// Width \[pixel\]: the colours are few and the compression is weak.
const WIDTH: u32 = 400;
/// Speed of the colour quantisation, 1 (best) to 30.
const SPEED: i32 = 10;

/// An animated image under way.
pub(super) struct Animation {
    encoder: GifEncoder<Sink>,
    sink: Sink,
    frames_per_second: f32,
    frames: usize,
}

impl Animation {
    pub fn begin(path: &Path, frames_per_second: f32) -> Result<Self> {
        let sink = Sink(Arc::new(Mutex::new((WholeFile::create(path)?, None))));
        let mut encoder = GifEncoder::new_with_speed(sink.clone(), SPEED);
        encoder.set_repeat(Repeat::Infinite).map_err(Error::other)?;
        Ok(Self { encoder, sink, frames_per_second, frames: 0 })
    }

    pub fn add(&mut self, picture: &Picture) -> Result<()> {
        // Centiseconds are all that it can say, and fewer than two are not kept to.
        let (rate, index) = (self.frames_per_second, self.frames);
        self.frames += 1;
        let stride = (rate / 50.0).ceil().max(1.0) as usize;
        if !index.is_multiple_of(stride) {
            return Ok(());
        }
        let at = |index: usize| (100.0 * index as f32 / rate).round();
        let small = DynamicImage::ImageRgb8(thumbnail(picture, WIDTH)).into_rgba8();
        let shown = Duration::from_millis(10 * (at(index + stride) - at(index)) as u64);
        let frame = Frame::from_parts(small, 0, 0, Delay::from_saturating_duration(shown));
        self.encoder.encode_frame(frame).map_err(Error::other)
    }

    /// Closes it; the file is to be kept.
    pub fn finish(self) -> Result<WholeFile> {
        // The encoder writes the end when it is dropped, and does not report whether it could.
        drop(self.encoder);
        let sink = Arc::into_inner(self.sink.0).ok_or_else(|| Error::other("the image is still written"))?;
        let (file, failed) = sink.into_inner().unwrap_or_else(PoisonError::into_inner);
        failed.map_or(Ok(file), Err)
    }
}

/// The file that the encoder owns, and the first error that it met.
#[derive(Clone)]
struct Sink(Arc<Mutex<(WholeFile, Option<Error>)>>);

impl Sink {
    fn act<T>(&self, act: impl FnOnce(&mut WholeFile) -> Result<T>) -> Result<T> {
        let mut sink = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut sink.0).inspect_err(|error| {
            sink.1.get_or_insert_with(|| Error::new(error.kind(), error.to_string()));
        })
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.act(|file| file.write(bytes))
    }

    fn flush(&mut self) -> Result<()> {
        self.act(WholeFile::flush)
    }
}
