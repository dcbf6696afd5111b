//! Options of reading a groom file, shared by the commands that read one.

use std::str::FromStr;

use clap::Args;
use strandline::format::{Cleaning, LoadOptions, RootEnd, Scale, Up};

/// Reading of a groom file.
#[derive(Args, Clone, Copy, Debug)]
pub struct Reading {
    /// Metres per unit of the file, or auto: the first unit that makes it as large as hair can be.
    #[arg(long, value_name = "F|auto", default_value = "auto", value_parser = parse_scale)]
    pub scale: Scale,
    /// The axis of the file that points up: y or z.
    #[arg(long, value_name = "AXIS", default_value = "y", value_parser = Up::from_str)]
    pub up: Up,
    /// Points of each strand, for files that do not give strands.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub per_strand: Option<u32>,
    /// Frame of moving hair, from 0, in USD a time code; without it the first.
    #[arg(long, value_name = "N")]
    pub frame: Option<u32>,
    /// The end of each strand at which its root is: first, last, or auto, which widths and the other strands show.
    #[arg(long, value_name = "END", default_value = "auto", value_parser = RootEnd::from_str)]
    pub root_end: RootEnd,
}

impl Reading {
    /// Bad strands are left out and counted.
    pub fn options(&self) -> LoadOptions {
        LoadOptions {
            strict: false,
            scale: self.scale,
            up: self.up,
            per_strand: self.per_strand,
            frame: self.frame,
            root_end: self.root_end,
            cleaning: Cleaning::Named,
        }
    }
}

/// A scale in metres per unit, or `auto`.
pub fn parse_scale(text: &str) -> Result<Scale, String> {
    let factor = text.parse().ok().filter(|factor: &f32| (1e-6..=1e6).contains(factor));
    match (text, factor) {
        ("auto", _) => Ok(Scale::Auto),
        (_, Some(factor)) => Ok(Scale::Factor(factor)),
        _ => Err(format!("`{text}` is not a scale, expected auto or a number from 0.000001 to 1000000")),
    }
}
