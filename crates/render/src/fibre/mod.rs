//! Scattering by one fibre: the models, each in a folder of its own, and the choice among them.

pub mod chiang;
pub mod scheuermann;

use strandline_base::{choices, settings};

use chiang::MOST_CELLS;
pub use chiang::{Chiang, Pigment};
pub use scheuermann::{Highlight, Scheuermann};

settings! {
    /// Scattering by one hair.
    pub struct Fibre: Copy {
        /// The model.
        model: FibreModel = FibreModel::default();
        /// The rough dielectric fibre, for `model = "chiang"`.
        chiang: Chiang = Chiang::default();
        /// The thesis's fibre, for `model = "scheuermann"`.
        scheuermann: Scheuermann = Scheuermann::default();
    }
}

choices! {
    /// A model of how one hair scatters light.
    pub enum FibreModel as "look.fibre.model" {
        /// Light about the strand and two highlights from shifted tangents [Scheuermann2004], coloured by
        /// `look.root_color` and `look.tip_color`.
        Scheuermann = "scheuermann",
        /// A rough dielectric fibre with absorption [Chiang2016], and light that is scattered many times.
        Chiang = "chiang",
    }
    default Chiang
}

impl FibreModel {
    /// True if light goes from fibre to fibre many times, carried through a grid of cells: light that meets a
    /// hair then does not go straight on.
    pub fn scatters_many_times(self) -> bool {
        match self {
            Self::Scheuermann => false,
            Self::Chiang => true,
        }
    }
}

impl Fibre {
    /// Cells along the longest side of the hair of the grid that light is carried through.
    pub(crate) fn grid_cells(&self) -> u32 {
        if self.model.scatters_many_times() { self.chiang.cells } else { MOST_CELLS }
    }

    /// True if the look's colours are those of the hair; otherwise its pigment is.
    pub fn shows_colors(&self) -> bool {
        match self.model {
            FibreModel::Scheuermann => true,
            FibreModel::Chiang => self.chiang.pigment == Pigment::Color,
        }
    }
}
