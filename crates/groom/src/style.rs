use std::str::FromStr;

use crate::{Groom, GroomError};

/// A style that can be grown on the built-in mannequin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Style {
    /// To the chin, cut level, with a fringe or a side parting.
    Bob,
    /// Below the shoulders, straight, middle parting.
    #[default]
    Long,
    /// Below the shoulders, in waves.
    Wavy,
    /// Shoulder length, in curls.
    Curly,
    /// Short all over, combed from the whorl.
    Pixie,
    /// Combed back and tied, with a falling tail.
    Ponytail,
}

impl Style {
    /// Every style.
    pub const ALL: [Self; 6] = [Self::Bob, Self::Long, Self::Wavy, Self::Curly, Self::Pixie, Self::Ponytail];
}

impl FromStr for Style {
    type Err = GroomError;

    fn from_str(name: &str) -> Result<Self, GroomError> {
        match name {
            "bob" => Ok(Self::Bob),
            "long" => Ok(Self::Long),
            "wavy" => Ok(Self::Wavy),
            "curly" => Ok(Self::Curly),
            "pixie" => Ok(Self::Pixie),
            "ponytail" => Ok(Self::Ponytail),
            other => Err(GroomError::Setting {
                name: "style",
                found: format!("`{other}`"),
                expected: "one of bob, long, wavy, curly, pixie, ponytail",
            }),
        }
    }
}

/// How to grow a style.
#[derive(Clone, Debug, PartialEq)]
pub struct StyleSettings {
    /// The style.
    pub style: Style,
    /// Number of strands.
    pub strand_count: usize,
    /// Seed of every random choice.
    pub seed: u64,
}

impl StyleSettings {
    /// Grows the style on the built-in mannequin.
    ///
    /// # Errors
    /// A strand count outside 1..=8,000,000.
    pub fn grow(&self) -> Result<Groom, GroomError> {
        unimplemented!("styles")
    }
}
