//! The contact sheet: a few pictures of a film, small and side by side.

use std::path::Path;

use image::{
    RgbImage,
    imageops::{self, FilterType},
};
use strandline_base::WholeFile;

use crate::{Error, render::Picture};

/// Most pictures on a contact sheet, and how many stand in a row.
const PICTURES: u32 = 12;
const COLUMNS: u32 = 4;
/// Width of a picture on the sheet \[pixel\].
pub(super) const WIDTH: u32 = 320;

/// True for pictures spread evenly over the sheet: picture `index` of `count`.
pub(super) fn is_shown(index: u32, count: u32) -> bool {
    let shown = count.min(PICTURES);
    (0..shown).any(|slot| slot * count / shown == index)
}

/// The picture, no wider than `width` \[pixel\].
pub(super) fn thumbnail(picture: &Picture, width: u32) -> RgbImage {
    let whole = RgbImage::from_raw(picture.width, picture.height, picture.pixels.clone())
        .expect("a picture holds three bytes a pixel");
    if picture.width <= width {
        return whole;
    }
    let height = (u64::from(picture.height) * u64::from(width) / u64::from(picture.width)).max(1) as u32;
    imageops::resize(&whole, width, height, FilterType::Triangle)
}

/// Writes the sheet.
pub(super) fn save(thumbnails: &[RgbImage], path: &Path) -> Result<(), Error> {
    let sheet = sheet(thumbnails);
    let write = |file: &mut _| sheet.write_to(file, image::ImageFormat::Png).map_err(std::io::Error::other);
    WholeFile::write(path, write).and_then(WholeFile::keep).map_err(Error::write("the contact sheet", path))
}

fn sheet(thumbnails: &[RgbImage]) -> RgbImage {
    let (width, height) = thumbnails[0].dimensions();
    let rows = (thumbnails.len() as u32).div_ceil(COLUMNS);
    let mut sheet = RgbImage::new(width * COLUMNS.min(thumbnails.len() as u32), height * rows);
    for (index, thumbnail) in thumbnails.iter().enumerate() {
        let index = index as u32;
        let (x, y) = (index % COLUMNS * width, index / COLUMNS * height);
        imageops::replace(&mut sheet, thumbnail, i64::from(x), i64::from(y));
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_shows_the_first_picture_and_twelve_at_most() {
        for count in [1, 2, 11, 12, 13, 120, 121] {
            let shown: Vec<u32> = (0..count).filter(|index| is_shown(*index, count)).collect();
            assert_eq!(shown.len() as u32, count.min(12), "{count}");
            assert_eq!(shown[0], 0);
        }
    }
}
