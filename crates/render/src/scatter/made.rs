//! Tables of a look's fibre.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::math;

use super::lattice::Lattice;
use super::source::Source;
use crate::fibre::chiang::Table;

/// Share of the scattered light that may be left out.
const LEFT_OUT: f32 = 0.01;
/// Share of the light that leaves a hair deep inside the groom and meets hair again.
const KEPT: f32 = 0.96;

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
        let alike = from.darkest == Vec3::ONE;
        let table = if alike { lattice.table().clone() } else { Table::new(&lobes, unit) };
        Self { from, table, lattice }
    }

    /// Number of scatterings after which next to nothing is left to scatter, and no more than the look allows.
    pub(crate) fn rounds(&self) -> u32 {
        let kept = KEPT * self.lattice.most_albedo().max_element();
        let needed = math::ln(LEFT_OUT) / math::ln(kept.clamp(f32::MIN_POSITIVE, KEPT));
        self.from.fibre.scatterings.min(needed.ceil() as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Look, Preset};

    #[test]
    fn lighter_hair_scatters_light_more_often() {
        let rounds = |change: fn(&mut Look)| {
            let mut look = Look::named(Preset::Brown);
            change(&mut look);
            Made::new(Source::new(&look, None)).rounds()
        };
        let black = rounds(|look| look.fibre.chiang.eumelanin = 8.0);
        let brown = rounds(|_| ());
        let blonde = rounds(|look| look.fibre.chiang.eumelanin = 0.3);
        assert!(1 <= black && black < brown && brown < blonde, "{black} {brown} {blonde}");
        let white = |look: &mut Look| [look.fibre.chiang.eumelanin, look.fibre.chiang.pheomelanin] = [0.0; 2];
        assert_eq!(rounds(white), Look::brown().fibre.chiang.scatterings);
        assert_eq!(rounds(|look| look.fibre.chiang.scatterings = 0), 0);
    }
}
