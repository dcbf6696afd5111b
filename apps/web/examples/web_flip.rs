//! Prints how unlike two pictures of the page look (FLIP, 0 to 1), and fails beyond a bound: `web_flip ONE OTHER MOST`.

#![allow(clippy::print_stdout)] // it talks to the command that compares

use std::{error::Error, fs};

/// Width, height and colours of a picture (PPM, one line of header).
fn read(path: &str) -> Result<(u32, u32, Vec<u8>), Box<dyn Error>> {
    let bytes = fs::read(path)?;
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or("no header")?;
    let header = std::str::from_utf8(&bytes[..end])?;
    let [_, width, height, _] = header.split(' ').collect::<Vec<_>>()[..] else {
        return Err("not a PPM".into());
    };
    let (width, height) = (width.parse()?, height.parse()?);
    let colors = bytes[end + 1..].to_vec();
    if colors.len() as u64 != 3 * u64::from(width) * u64::from(height) {
        return Err("cut off".into());
    }
    Ok((width, height, colors))
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [one, other, most] = &words[..] else { return Err("usage: web_flip ONE OTHER MOST".into()) };
    let [one, other] = [read(one)?, read(other)?];
    if (one.0, one.1) != (other.0, other.1) {
        return Err("the pictures have other sizes".into());
    }
    let image = |(width, height, colors): &(u32, u32, Vec<u8>)| {
        nv_flip::FlipImageRgb8::with_data(*width, *height, colors)
    };
    let errors = nv_flip::flip(image(&one), image(&other), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    let mean = nv_flip::FlipPool::from_image(&errors).mean();
    println!("FLIP of the device's picture from the processor's: {mean:.4}, bound {most}");
    if one.2.iter().all(|byte| *byte == one.2[0]) {
        return Err("the picture is blank".into());
    }
    if mean > most.parse()? { Err("the pictures differ".into()) } else { Ok(()) }
}
