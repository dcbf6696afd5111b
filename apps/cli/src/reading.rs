//! Options of reading a groom file, shared by the commands that read one.

use std::str::FromStr;

use clap::Args;
use glam::Vec3;
use strandline::format::{Cleaning, LoadOptions, RootEnd, Scale, Up};

/// Reading of a groom file.
#[derive(Args, Clone, Copy, Debug)]
pub struct Reading {
    /// Metres per unit of the file, or auto: the first unit that makes it as large as hair can be.
    #[arg(long, value_name = "F|auto", default_value = "auto", value_parser = parse_scale)]
    pub scale: Scale,
    /// The axis of the file that points up: x, y, z, -x, -y or -z.
    #[arg(long, value_name = "AXIS", default_value = "y", value_parser = parse_up, allow_hyphen_values = true)]
    pub up: Up,
    /// Turn the strands: degrees about x, y and z, y first, then x, then z.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub turn: Option<Vec3>,
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
            turn: self.turn.unwrap_or_default(),
            per_strand: self.per_strand,
            frame: self.frame,
            root_end: self.root_end,
            cleaning: Cleaning::Named,
        }
    }
}

/// An axis with or without a sign.
pub fn parse_up(text: &str) -> Result<Up, String> {
    Up::from_str(text.trim_start_matches('+')).map_err(|error| error.to_string())
}

/// Three numbers.
pub fn parse_vector(text: &str) -> Result<Vec3, String> {
    let expected = || format!("`{text}` is not three numbers, expected X,Y,Z such as 0,90,0");
    let numbers: Vec<f32> =
        text.split(',').map(str::parse).collect::<Result<_, _>>().map_err(|_| expected())?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|number| number.abs() <= 1e6) => Ok(Vec3::new(x, y, z)),
        _ => Err(expected()),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_three_numbers() {
        assert_eq!(parse_vector("0,-90,1.5"), Ok(Vec3::new(0.0, -90.0, 1.5)));
        for wrong in ["1,2", "1,2,3,4", "a,b,c", "nan,0,0", "1e9,0,0"] {
            assert!(parse_vector(wrong).unwrap_err().contains("expected X,Y,Z"), "{wrong}");
        }
    }

    #[test]
    fn axes_have_signs() {
        let ups = ["y", "-y", "+x", "-x", "-z"].map(|text| parse_up(text).unwrap());
        assert_eq!(ups, [Up::Y, Up::MinusY, Up::X, Up::MinusX, Up::MinusZ]);
        assert!(parse_up("w").unwrap_err().contains("-x"));
    }
}
