//! Pictures cut, magnified and joined.

use strandline::Picture;

/// Pixels between two pictures of a strip.
const GAP: u32 = 4;
/// Colour of the gaps.
const PAPER: [u8; 3] = [255; 3];

/// Pictures side by side, each in the middle of the strip's height.
pub fn joined(pictures: &[Picture]) -> Picture {
    let height = pictures.iter().map(|picture| picture.height).max().unwrap_or(0);
    let width = pictures.iter().map(|picture| picture.width + GAP).sum::<u32>().saturating_sub(GAP);
    let mut strip = Picture { width, height, pixels: PAPER.repeat((width * height) as usize), alpha: None };
    let mut left = 0;
    for picture in pictures {
        let top = (height - picture.height) / 2;
        for row in 0..picture.height {
            let from = 3 * (row * picture.width) as usize;
            let to = 3 * ((top + row) * width + left) as usize;
            let length = 3 * picture.width as usize;
            strip.pixels[to..to + length].copy_from_slice(&picture.pixels[from..from + length]);
        }
        left += picture.width + GAP;
    }
    strip
}

/// Pictures of one width below each other.
pub fn stacked(pictures: &[Picture]) -> Picture {
    let width = pictures.iter().map(|picture| picture.width).max().unwrap_or(0);
    let between = PAPER.repeat((width * GAP) as usize);
    let rows: Vec<&[u8]> = pictures.iter().map(|picture| picture.pixels.as_slice()).collect();
    let height = pictures.iter().map(|picture| picture.height + GAP).sum::<u32>().saturating_sub(GAP);
    Picture { width, height, pixels: rows.join(between.as_slice()), alpha: None }
}

/// A part of a picture, `[left, top, width, height]` as shares of its size, every pixel shown as
/// `times` x `times`.
pub fn magnified(picture: &Picture, part: [f32; 4], times: u32) -> Picture {
    let size = [picture.width, picture.height, picture.width, picture.height];
    let [left, top, width, height] = [0, 1, 2, 3].map(|i| (part[i] * size[i] as f32).round() as u32);
    let mut pixels = Vec::with_capacity(3 * (width * height * times * times) as usize);
    for row in 0..height * times {
        for column in 0..width * times {
            let at = 3 * ((top + row / times) * picture.width + left + column / times) as usize;
            pixels.extend_from_slice(&picture.pixels[at..at + 3]);
        }
    }
    Picture { width: width * times, height: height * times, pixels, alpha: None }
}
