//! Tables of a look's fibre.

use std::sync::Arc;

use super::lattice::Lattice;
use super::source::Source;
use crate::fibre::chiang::Table;

/// Tables of a fibre, and what they were made from.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    pub(crate) from: Source,
    pub(crate) table: Table,
    pub(crate) lattice: Arc<Lattice>,
}

impl Made {
    pub(crate) fn new(from: Source) -> Self {
        let (lobes, unit) = (from.fibre.lobes(), from.absorption());
        let darkest = from.darkest.to_array();
        let absorption = std::array::from_fn(|channel| unit[channel] * f64::from(darkest[channel]));
        let lattice = Arc::new(Lattice::new(&lobes, absorption, from.lightest_of_darkest()));
        Self { from, table: Table::new(&lobes, unit), lattice }
    }
}
