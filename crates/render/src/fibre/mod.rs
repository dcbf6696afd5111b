//! How one fibre scatters light: the models, each in a folder of its own, and the choice among them.

pub mod chiang;
pub mod scheuermann;

use strandline_base::{choices, settings};

pub use chiang::{Chiang, Pigment};

settings! {
    /// How one hair scatters light.
    pub struct Fibre: Copy {
        /// The model.
        model: FibreModel = FibreModel::default();
        /// The rough dielectric fibre, for `model = "chiang"`.
        chiang: Chiang = Chiang::default();
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
