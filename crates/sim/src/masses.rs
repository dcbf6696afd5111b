use strandline_base::par::prelude::*;
use strandline_groom::{Lanes, RestShape};

use crate::Model;

/// Masses of the points of a state, and what follows from them; shapes are `[block][point]` of lanes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Masses {
    /// Mass \[kg\]; lanes beyond the last strand hold 0.
    pub mass: Vec<Lanes>,
    /// 1 over the mass \[1/kg\], 0 for a rooted point.
    pub inverse_mass: Vec<Lanes>,
    /// Share of a length correction that point i takes from segment i, i + 1.
    pub share_lower: Vec<Lanes>,
    /// Share of a length correction that point i + 1 takes from segment i, i + 1.
    pub share_upper: Vec<Lanes>,
    /// The model's key of the masses from which they follow.
    pub key: u64,
}

impl Masses {
    /// The masses of a model's points, each as the length of its two segments has it.
    pub fn new(model: &Model, lengths: &RestShape) -> Self {
        let points = model.points_per_strand;
        let around = |lanes: &[Lanes], index: usize, lane: usize| {
            let before = if index.is_multiple_of(points) { 0.0 } else { lanes[index - 1].0[lane] };
            before + lanes[index].0[lane]
        };
        let factor = |index: usize, lane: usize| {
            around(&lengths.stretch, index, lane) / around(&model.rest.stretch, index, lane)
        };
        let each = |value: &(dyn Fn(usize, usize) -> f32 + Sync)| -> Vec<Lanes> {
            (0..model.rest.mass.len())
                .into_par_iter()
                .map(|index| Lanes(std::array::from_fn(|lane| value(index, lane))))
                .collect()
        };
        let mass = each(&|index, lane| model.rest.mass[index].0[lane] * factor(index, lane));
        let inverse_mass = each(&|index, lane| model.inverse_mass[index].0[lane] / factor(index, lane));
        // Shares of the two ends of each segment in its correction, by inverse mass [Mueller2007 eq. 10-11].
        let share = |index: usize, lane: usize, taker: usize| {
            if (index + 1).is_multiple_of(points) {
                return 0.0;
            }
            let sum = inverse_mass[index].0[lane] + inverse_mass[index + 1].0[lane];
            if sum > 0.0 { inverse_mass[taker].0[lane] / sum } else { 0.0 }
        };
        let share_lower = each(&|index, lane| share(index, lane, index));
        let share_upper = each(&|index, lane| share(index, lane, index + 1));
        Self { mass, inverse_mass, share_lower, share_upper, key: model.mass_key() }
    }
}
