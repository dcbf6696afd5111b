use std::collections::HashMap;

use strandline_base::SettingError;

use crate::GroomError;

/// The guides that each strand of a groom follows, and how much it follows each.
///
/// Guides are strands of the same groom. Weights are not below 0 and sum to 1, or are all 0 where a strand
/// follows none.
#[derive(Clone, Debug, PartialEq)]
pub struct Influences {
    per_strand: usize,
    guides: Vec<u32>,
    weights: Vec<f32>,
}

impl Influences {
    /// Most guides that a strand may follow.
    pub const MAX_PER_STRAND: usize = 64;

    /// From guides and weights, both of shape `[strand][per_strand]`. Weights are scaled so that they sum to 1.
    ///
    /// # Errors
    /// Another number of guides than of weights; a guide that is no strand; a weight below 0 or not finite.
    pub fn new(
        per_strand: usize,
        guides: Vec<u32>,
        weights: Vec<f32>,
        strand_count: usize,
    ) -> Result<Self, GroomError> {
        let refuse = |found: String, expected: String| {
            Err(GroomError::from(SettingError::new("the guides of strands", found, expected)))
        };
        if !(1..=Self::MAX_PER_STRAND).contains(&per_strand) {
            return refuse(format!("{per_strand} for each strand"), "1 to 64".to_owned());
        }
        let expected = per_strand.checked_mul(strand_count);
        if expected != Some(guides.len()) || expected != Some(weights.len()) {
            let found = format!("{} guides and {} weights", guides.len(), weights.len());
            return refuse(found, format!("{per_strand} of each for each of {strand_count} strands"));
        }
        if let Some(guide) = guides.iter().find(|guide| **guide as usize >= strand_count) {
            return refuse(format!("strand {guide}"), format!("a strand below {strand_count}"));
        }
        if let Some(weight) = weights.iter().find(|weight| !(weight.is_finite() && **weight >= 0.0)) {
            return refuse(format!("the weight {weight}"), "a finite number not below 0".to_owned());
        }
        let mut influences = Self { per_strand, guides, weights };
        influences.normalize();
        Ok(influences)
    }

    /// Guides of each strand.
    pub fn per_strand(&self) -> usize {
        self.per_strand
    }

    /// Strands that are followed, shape `[strand][per_strand]`.
    pub fn guides(&self) -> &[u32] {
        &self.guides
    }

    /// Weights of the guides, shape `[strand][per_strand]`.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// The guides of one strand and how much it follows each.
    pub fn of(&self, strand: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let range = strand * self.per_strand..(strand + 1) * self.per_strand;
        self.guides[range.clone()]
            .iter()
            .map(|guide| *guide as usize)
            .zip(self.weights[range].iter().copied())
    }

    /// Influences of some strands, in their order, which are then the whole groom: guides that are not among them
    /// weigh nothing.
    pub(crate) fn select(&self, strands: &[usize]) -> Self {
        let places: HashMap<usize, u32> =
            strands.iter().enumerate().map(|(place, strand)| (*strand, place as u32)).collect();
        let influences = || strands.iter().flat_map(|strand| self.of(*strand));
        let place = |guide: usize| places.get(&guide).copied();
        let mut selected = Self {
            per_strand: self.per_strand,
            guides: influences().map(|(guide, _)| place(guide).unwrap_or(0)).collect(),
            weights: influences().map(|(guide, weight)| place(guide).map_or(0.0, |_| weight)).collect(),
        };
        selected.normalize();
        selected
    }

    /// Adds those of another groom, whose strands stand behind the first `strands`.
    pub(crate) fn append(&mut self, other: Self, strands: usize) {
        let each = self.per_strand.max(other.per_strand);
        let wider = |rows: &Self, first: usize| {
            let count = rows.guides.len() / rows.per_strand;
            let row = |strand: usize| {
                let own = rows.of(strand).map(|(guide, weight)| ((first + guide) as u32, weight));
                own.chain(std::iter::repeat_n((first as u32, 0.0), each - rows.per_strand))
                    .collect::<Vec<_>>()
            };
            (0..count).flat_map(row).unzip::<_, _, Vec<_>, Vec<_>>()
        };
        if each != self.per_strand {
            (self.guides, self.weights) = wider(self, 0);
            self.per_strand = each;
        }
        let (guides, weights) = wider(&other, strands);
        self.guides.extend(guides);
        self.weights.extend(weights);
    }

    /// Number of strands, of some in rising order, that follow a guide that is not among them.
    pub fn torn_by(&self, strands: &[usize]) -> usize {
        let is_gone = |guide: usize| strands.binary_search(&guide).is_err();
        let is_torn = |strand: usize| self.of(strand).any(|(guide, weight)| weight > 0.0 && is_gone(guide));
        strands.iter().filter(|strand| is_torn(**strand)).count()
    }

    fn normalize(&mut self) {
        for weights in self.weights.chunks_exact_mut(self.per_strand) {
            let sum: f64 = weights.iter().map(|weight| f64::from(*weight)).sum();
            // Weights that sum to 1 but for rounding keep their bits, so that reading a written file changes
            // nothing.
            if sum > 0.0 && (sum - 1.0).abs() > 1e-6 {
                weights.iter_mut().for_each(|weight| *weight = (f64::from(*weight) / sum) as f32);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_guides_keep_their_strands() {
        let influences = Influences::new(2, vec![1, 2, 0, 2, 0, 1], vec![1.0, 3.0, 2.0, 2.0, 0.0, 0.0], 3);
        let influences = influences.unwrap();
        assert_eq!(influences.weights(), [0.25, 0.75, 0.5, 0.5, 0.0, 0.0]);
        let selected = influences.select(&[2, 0]);
        // Strand 1 is gone, and strand 2 has become strand 0.
        assert_eq!(selected.of(1).collect::<Vec<_>>(), [(0, 0.0), (0, 1.0)]);
        assert_eq!(selected.of(0).map(|(_, weight)| weight).sum::<f32>(), 0.0);
    }

    #[test]
    fn those_of_two_grooms_keep_their_own_guides() {
        let mut one = Influences::new(1, vec![1, 1], vec![1.0, 0.0], 2).unwrap();
        one.append(Influences::new(2, vec![0, 0, 0, 1], vec![1.0, 0.0, 0.25, 0.75], 2).unwrap(), 2);
        let of = |strand| one.of(strand).filter(|(_, weight)| *weight > 0.0).collect::<Vec<_>>();
        assert_eq!((of(0), of(1)), (vec![(1, 1.0)], vec![]));
        assert_eq!((of(2), of(3)), (vec![(2, 1.0)], vec![(2, 0.25), (3, 0.75)]));
        assert_eq!((one.torn_by(&[0, 1, 2, 3]), one.torn_by(&[0, 1, 2]), one.torn_by(&[0, 2, 3])), (0, 0, 1));
    }

    #[test]
    fn what_is_no_guide_is_refused() {
        let refused = |guides, weights| Influences::new(1, guides, weights, 2).unwrap_err().to_string();
        assert!(refused(vec![0], vec![1.0]).contains("1 of each for each of 2 strands"));
        assert!(refused(vec![0, 2], vec![1.0, 1.0]).contains("strand 2, expected a strand below 2"));
        assert!(refused(vec![0, 1], vec![1.0, -1.0]).contains("the weight -1"));
        assert!(refused(vec![0, 1], vec![1.0, f32::NAN]).contains("the weight NaN"));
    }
}
