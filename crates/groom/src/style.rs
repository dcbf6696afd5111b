//! Styles grown on the built-in mannequin.

mod comb;
mod finish;
mod grow;
mod settings;

use std::str::FromStr;

use crate::GroomError;

pub use settings::StyleSettings;

/// A style that can be grown on the built-in mannequin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Style {
    /// To the chin, cut level, with a side parting.
    Bob,
    /// Below the shoulders, straight, middle parting.
    #[default]
    Long,
    /// Below the shoulders, in waves.
    Wavy,
    /// To the shoulders, in curls.
    Curly,
    /// Short all over, combed from the whorl.
    Pixie,
    /// Combed back and tied, with a falling tail.
    Ponytail,
}

impl Style {
    /// Every style.
    pub const ALL: [Self; 6] = [Self::Bob, Self::Long, Self::Wavy, Self::Curly, Self::Pixie, Self::Ponytail];

    /// Its name, as in scenes and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bob => "bob",
            Self::Long => "long",
            Self::Wavy => "wavy",
            Self::Curly => "curly",
            Self::Pixie => "pixie",
            Self::Ponytail => "ponytail",
        }
    }
}

impl FromStr for Style {
    type Err = GroomError;

    fn from_str(name: &str) -> Result<Self, GroomError> {
        Self::ALL.into_iter().find(|style| style.name() == name).ok_or_else(|| GroomError::Setting {
            name: "style",
            found: format!("`{name}`"),
            expected: "one of bob, long, wavy, curly, pixie, ponytail",
        })
    }
}
