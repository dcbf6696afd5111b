//! Styles grown on the built-in mannequin.

mod beside;
mod comb;
mod face;
mod finish;
mod grow;
mod hair;
mod lashes;
mod locks;
mod near;
mod settings;
mod skin;
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
        /// A centimetre all over, standing off the skin.
        Buzz = "buzz",
        /// To the jaw, swept from a deep side parting over the head.
        SideSwept = "side_swept",
        /// Standing off the head all around, in tight coils.
        Afro = "afro",
        /// To the jaw, in falling coils the width of a pencil.
        Coils = "coils",
        /// Combed back, tied, and wound about the tie.
        Bun = "bun",
        /// Combed back, tied, and plaited of three tresses.
        Braid = "braid",
        /// A full beard of two centimetres with a moustache; nothing on the scalp.
        Beard = "beard",
        /// Eyebrows; nothing on the scalp.
        Brows = "brows",
        /// Eyelashes of both lids; nothing on the scalp.
        Lashes = "lashes",
    }
    default Long
}

impl Style {
    /// True if hair falls to both sides of a parting.
    pub fn is_parted(self) -> bool {
        match self {
            Self::Bob | Self::Long | Self::Wavy | Self::Curly | Self::SideSwept | Self::Coils => true,
            Self::Pixie | Self::Buzz | Self::Afro | Self::Ponytail | Self::Bun | Self::Braid => false,
            Self::Beard | Self::Brows | Self::Lashes => false,
        }
    }

    /// Points of a strand that its curls need, with which scenes simulate and draw it.
    pub fn points_per_strand(self) -> u32 {
        match self {
            Self::Curly | Self::Coils | Self::Braid => 56,
            Self::Afro | Self::Bun => 48,
            Self::Wavy | Self::SideSwept => 28,
            Self::Buzz | Self::Beard | Self::Brows | Self::Lashes => 8,
            Self::Pixie | Self::Ponytail | Self::Bob | Self::Long => 16,
        }
    }

    /// True if hair grows on the face and not on the scalp.
    pub fn is_of_face(self) -> bool {
        matches!(self, Self::Beard | Self::Brows | Self::Lashes)
    }

    /// True if all hair runs through a tie behind the head.
    pub(crate) fn is_tied(self) -> bool {
        matches!(self, Self::Ponytail | Self::Bun | Self::Braid)
    }
}
