//! Writes a film as it is drawn: frames, a contact sheet, and a video or an animated image.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use image::{
    Delay, RgbImage,
    codecs::gif::{GifEncoder, Repeat},
    imageops::{self, FilterType},
};

use crate::{
    Error,
    render::{Picture, WholeFile},
};

/// Most pictures on a contact sheet, and how many stand in a row.
const SHEET_PICTURES: u32 = 12;
const SHEET_COLUMNS: u32 = 4;
/// Width of a picture on the sheet \[pixel\].
const SHEET_WIDTH: u32 = 320;
/// Width of the animated image \[pixel\]: its colours are few and its compression is weak.
const ANIMATION_WIDTH: u32 = 400;
/// Speed of the animated image's colour quantisation, 1 (best) to 30.
const ANIMATION_SPEED: i32 = 10;

/// Receives the pictures of a film in order.
///
/// Every file is complete once its call has returned; one that could not be finished is removed.
pub struct Film {
    folder: PathBuf,
    /// Number of frames; none while nobody knows it.
    frames: Option<u32>,
    frames_per_second: f32,
    files: Vec<PathBuf>,
    thumbnails: Vec<RgbImage>,
    moving: Moving,
}

/// The moving picture under way.
enum Moving {
    NotBegun,
    Video(Child, PathBuf),
    Animation(Box<GifEncoder<fs::File>>, PathBuf),
    None,
}

/// What a finished film left behind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilmFiles {
    /// Every file, in the order of writing.
    pub files: Vec<PathBuf>,
    /// What could not be made and why, for a person to read.
    pub notes: Vec<String>,
}

impl Film {
    /// A film of `frames` pictures in a folder, which is made when it is not there.
    ///
    /// # Errors
    /// The folder cannot be made or written.
    pub fn new(folder: &Path, frames: u32, frames_per_second: f32) -> Result<Self, Error> {
        Self::open(folder, Some(frames), frames_per_second)
    }

    /// A film that goes on until it is finished; without a contact sheet.
    ///
    /// # Errors
    /// As [`Film::new`].
    pub fn endless(folder: &Path, frames_per_second: f32) -> Result<Self, Error> {
        Self::open(folder, None, frames_per_second)
    }

    fn open(folder: &Path, frames: Option<u32>, frames_per_second: f32) -> Result<Self, Error> {
        fs::create_dir_all(folder).map_err(Error::write("the output folder", folder))?;
        let probe = folder.join(".strandline-probe");
        fs::write(&probe, b"").map_err(Error::write("into the output folder", folder))?;
        fs::remove_file(&probe).map_err(Error::write("into the output folder", folder))?;
        Ok(Self {
            folder: folder.to_owned(),
            frames,
            frames_per_second,
            files: Vec::new(),
            thumbnails: Vec::new(),
            moving: Moving::NotBegun,
        })
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// The file cannot be written, for example on a full disk; earlier pictures stay.
    pub fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let index = self.files.len() as u32;
        let path = self.folder.join(format!("frame_{index:04}.png"));
        picture.save(&path)?;
        self.files.push(path);
        if self.frames.is_some_and(|frames| is_on_sheet(index, frames)) {
            self.thumbnails.push(thumbnail(picture, SHEET_WIDTH));
        }
        if self.frames != Some(1) {
            self.add_to_moving(picture)?;
        }
        Ok(())
    }

    /// Writes the contact sheet and closes the moving picture.
    ///
    /// # Errors
    /// A file cannot be written; the frames stay.
    pub fn finish(mut self) -> Result<FilmFiles, Error> {
        let mut notes = Vec::new();
        if self.thumbnails.len() > 1 {
            let path = self.folder.join("sheet.png");
            save_sheet(&sheet(&self.thumbnails), &path)?;
            self.files.push(path);
        }
        match std::mem::replace(&mut self.moving, Moving::None) {
            Moving::Video(mut child, path) => {
                drop(child.stdin.take());
                match child.wait() {
                    Ok(status) if status.success() => self.files.push(path),
                    Ok(status) => notes.push(format!("no video: ffmpeg ended with {status}")),
                    Err(error) => notes.push(format!("no video: {error}")),
                }
            }
            Moving::Animation(encoder, path) => {
                drop(encoder);
                let whole = path.with_extension("gif");
                fs::rename(&path, &whole).map_err(Error::write("the animated image", &whole))?;
                self.files.push(whole);
                notes.push("no ffmpeg found: wrote an animated image in place of a video".to_owned());
            }
            Moving::NotBegun | Moving::None => {}
        }
        Ok(FilmFiles { files: std::mem::take(&mut self.files), notes })
    }

    fn add_to_moving(&mut self, picture: &Picture) -> Result<(), Error> {
        if matches!(self.moving, Moving::NotBegun) {
            self.moving = self.begin_moving(picture)?;
        }
        match &mut self.moving {
            Moving::Video(child, _) => {
                let fed = child.stdin.as_mut().map_or(Ok(()), |pipe| pipe.write_all(&picture.pixels));
                // A broken pipe means that ffmpeg ended; `finish` says how.
                if fed.is_err() {
                    drop(child.stdin.take());
                }
                Ok(())
            }
            Moving::Animation(encoder, path) => {
                // Centiseconds are all that it can tell, and fewer than two are not kept to.
                let (rate, index) = (self.frames_per_second, self.files.len() - 1);
                let stride = (rate / 50.0).ceil().max(1.0) as usize;
                if !index.is_multiple_of(stride) {
                    return Ok(());
                }
                let at = |index: usize| (100.0 * index as f32 / rate).round();
                let small = image::DynamicImage::ImageRgb8(thumbnail(picture, ANIMATION_WIDTH)).into_rgba8();
                let shown = std::time::Duration::from_millis(10 * (at(index + stride) - at(index)) as u64);
                let delay = Delay::from_saturating_duration(shown);
                let frame = image::Frame::from_parts(small, 0, 0, delay);
                encoder
                    .encode_frame(frame)
                    .map_err(|error| Error::write("the animated image", path)(std::io::Error::other(error)))
            }
            Moving::NotBegun | Moving::None => Ok(()),
        }
    }

    fn begin_moving(&self, picture: &Picture) -> Result<Moving, Error> {
        let video = self.folder.join("video.mp4");
        if let Ok(child) = ffmpeg(picture, self.frames_per_second, &video) {
            return Ok(Moving::Video(child, video));
        }
        let path = self.folder.join("animation.part");
        let whole = Error::write("the animated image", &path);
        let file = fs::File::create(&path).map_err(whole)?;
        let mut encoder = GifEncoder::new_with_speed(file, ANIMATION_SPEED);
        encoder
            .set_repeat(Repeat::Infinite)
            .map_err(|error| Error::write("the animated image", &path)(std::io::Error::other(error)))?;
        Ok(Moving::Animation(Box::new(encoder), path))
    }
}

impl Drop for Film {
    /// A film that was broken off leaves its frames, and no half moving picture.
    fn drop(&mut self) {
        match &mut self.moving {
            Moving::Video(child, path) => {
                let _ = child.kill();
                let _ = child.wait();
                let _ = fs::remove_file(path);
            }
            Moving::Animation(_, path) => {
                let _ = fs::remove_file(path);
            }
            Moving::NotBegun | Moving::None => {}
        }
    }
}

/// Starts the user's ffmpeg, which reads raw pictures from its standard input.
fn ffmpeg(picture: &Picture, frames_per_second: f32, path: &Path) -> std::io::Result<Child> {
    let size = format!("{}x{}", picture.width, picture.height);
    Command::new("ffmpeg")
        .args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", &size])
        .args(["-framerate", &frames_per_second.to_string(), "-i", "-"])
        .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-crf", "18"])
        .arg(path)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
}

/// Whether picture `index` of `count` is one of those spread evenly over the sheet.
fn is_on_sheet(index: u32, count: u32) -> bool {
    let shown = count.min(SHEET_PICTURES);
    (0..shown).any(|slot| slot * count / shown == index)
}

fn thumbnail(picture: &Picture, width: u32) -> RgbImage {
    let whole = RgbImage::from_raw(picture.width, picture.height, picture.pixels.clone())
        .expect("a picture holds three bytes a pixel");
    if picture.width <= width {
        return whole;
    }
    let height = (u64::from(picture.height) * u64::from(width) / u64::from(picture.width)).max(1) as u32;
    imageops::resize(&whole, width, height, FilterType::Triangle)
}

fn sheet(thumbnails: &[RgbImage]) -> RgbImage {
    let (width, height) = thumbnails[0].dimensions();
    let rows = (thumbnails.len() as u32).div_ceil(SHEET_COLUMNS);
    let mut sheet = RgbImage::new(width * SHEET_COLUMNS.min(thumbnails.len() as u32), height * rows);
    for (index, thumbnail) in thumbnails.iter().enumerate() {
        let index = index as u32;
        let (x, y) = (index % SHEET_COLUMNS * width, index / SHEET_COLUMNS * height);
        imageops::replace(&mut sheet, thumbnail, i64::from(x), i64::from(y));
    }
    sheet
}

fn save_sheet(sheet: &RgbImage, path: &Path) -> Result<(), Error> {
    let write = |file: &mut _| sheet.write_to(file, image::ImageFormat::Png).map_err(std::io::Error::other);
    WholeFile::write(path, write).and_then(WholeFile::keep).map_err(Error::write("the contact sheet", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_shows_the_first_picture_and_twelve_at_most() {
        for count in [1, 2, 11, 12, 13, 120, 121] {
            let shown: Vec<u32> = (0..count).filter(|index| is_on_sheet(*index, count)).collect();
            assert_eq!(shown.len() as u32, count.min(12), "{count}");
            assert_eq!(shown[0], 0);
        }
    }

    fn filled(width: u32, height: u32) -> Picture {
        Picture { width, height, pixels: vec![128; (width * height * 3) as usize], ..Picture::default() }
    }

    #[test]
    fn a_film_that_is_broken_off_leaves_only_whole_frames() {
        let folder = tempfile::tempdir().unwrap();
        let mut film = Film::new(folder.path(), 3, 30.0).unwrap();
        film.add(&filled(16, 8)).unwrap();
        drop(film);
        let names: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(names, ["frame_0000.png"]);
        assert!(image::open(folder.path().join("frame_0000.png")).is_ok());
    }

    #[test]
    fn a_folder_under_a_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"x").unwrap();
        let error = Film::new(&file.join("out"), 3, 30.0).err().unwrap().to_string();
        assert!(error.contains("cannot write the output folder"), "{error}");
    }
}
