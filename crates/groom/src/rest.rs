use crate::{Guides, Lanes};

/// What the solver keeps of a groom. All shapes are `[block][point]` of lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct RestShape {
    /// Rest length \[m\] from point i to i + 1; the last point holds 0.
    pub stretch: Vec<Lanes>,
    /// Rest distance \[m\] from point i to i + 2; the last two hold 0.
    pub bend: Vec<Lanes>,
    /// Rest distance \[m\] from point i to i + 3; the last three hold 0.
    pub torsion: Vec<Lanes>,
    /// Mass \[kg\] of each point; lanes beyond the last strand hold 0.
    pub mass: Vec<Lanes>,
}

impl RestShape {
    /// The rest shape of guides of hair with a mass per length \[kg/m\].
    pub fn new(_guides: &Guides, _mass_per_length: f32) -> Self {
        unimplemented!("strand solver")
    }
}
