//! Styles grown on the built-in mannequin.

mod comb;
mod finish;
mod grow;
mod hair;
mod locks;
mod near;
mod settings;
mod strand;

use strandline_base::choices;

pub use settings::StyleSettings;

choices! {
    /// A style that can be grown on the built-in mannequin.
    pub enum Style as "style" {
        /// To the chin, cut level, with a side parting.
        Bob = "bob",
        /// Below the shoulders, straight, middle parting.
        Long = "long",
        /// Below the shoulders, in waves.
        Wavy = "wavy",
        /// To the shoulders, in curls.
        Curly = "curly",
        /// Short all over, combed from the whorl.
        Pixie = "pixie",
        /// Combed back and tied, with a falling tail.
        Ponytail = "ponytail",
    }
    default Long
}

impl Style {
    /// True if hair falls to both sides of a parting.
    pub(crate) fn is_parted(self) -> bool {
        match self {
            Self::Bob | Self::Long | Self::Wavy | Self::Curly => true,
            Self::Pixie | Self::Ponytail => false,
        }
    }
}
