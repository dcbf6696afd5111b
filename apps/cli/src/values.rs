//! Values of the command line: how texts are read.

use std::str::FromStr;

use glam::Vec3;
use strandline::{
    Look,
    format::{FORMATS, Format, endings},
    look::Preset,
    scene::hex_color,
};

/// The endings of formats that are written.
pub fn written() -> String {
    endings(|format| format.write.is_some())
}

/// Every format of grooms, a line each.
pub fn formats() -> String {
    let line = |format: &Format| format!("  .{:<9}{}\n", format.ending, format.about);
    format!("Formats:\n{}", FORMATS.iter().map(line).collect::<String>())
}

/// A look by its name, or a colour of the hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookChoice {
    Named(Preset),
    /// Linear RGB.
    Color(Vec3),
}

impl LookChoice {
    /// Changes the colours of a look to these.
    pub fn dress(self, look: &mut Look) {
        match self {
            Self::Named(preset) => look.dress(preset),
            Self::Color(color) => {
                look.fibre.chiang.pigment = strandline::look::fibre::Pigment::Color;
                (look.root_color, look.tip_color) = (color, color);
            }
        }
    }
}

pub fn parse_look(text: &str) -> Result<LookChoice, String> {
    if text.starts_with('#') {
        let color = hex_color(text).ok_or_else(|| format!("`{text}` is not a colour, expected #rrggbb"))?;
        return Ok(LookChoice::Color(color.into()));
    }
    Preset::from_str(text).map(LookChoice::Named).map_err(|error| format!("{error}, or a colour #rrggbb"))
}

/// A number within a range.
fn parse_number(text: &str, range: std::ops::RangeInclusive<f32>) -> Result<f32, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("`{text}` is not a number from {} to {}", range.start(), range.end()))
}

pub fn parse_rate(text: &str) -> Result<f32, String> {
    parse_number(text, 1.0..=1000.0)
}

pub fn parse_width(text: &str) -> Result<f32, String> {
    parse_number(text, 0.001..=1000.0)
}

pub fn parse_level(text: &str) -> Result<log::LevelFilter, String> {
    text.parse()
        .map_err(|_| format!("`{text}` is not a level, expected off, error, warn, info, debug or trace"))
}

pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let expected = || format!("`{text}` is not a size, expected WIDTHxHEIGHT such as 800x600");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(expected)?;
    let side =
        |text: &str| text.parse::<u32>().ok().filter(|side| (1..=16_384).contains(side)).ok_or_else(expected);
    Ok((side(width)?, side(height)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_numbers_with_an_x() {
        assert_eq!(parse_size("800x600"), Ok((800, 600)));
        for wrong in ["800", "800x", "x600", "0x600", "800x-1", "800x99999", "axb"] {
            assert!(parse_size(wrong).unwrap_err().contains("expected WIDTHxHEIGHT"), "{wrong}");
        }
    }
}
