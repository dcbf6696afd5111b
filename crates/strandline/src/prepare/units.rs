//! Units of files, told by the width of a head.

use strandline_base::math;

use super::sample::FURTHER;
use crate::groom::format::{Scale, UNITS};

/// Distance from ear to ear \[m\] of the roots on a head: that of a doll to that of a giant, and that of a person, which a
/// head that no unit brings there is given.
pub(super) const SCALPS: std::ops::RangeInclusive<f32> = 0.09..=0.3;
const SCALP: f32 = 0.15;

/// The unit that a scene gives.
pub(super) fn given_unit(scale: Scale) -> Option<f32> {
    match scale {
        Scale::Auto => None,
        Scale::Factor(factor) => Some(factor),
    }
}

/// The first unit with which a length \[units\] is one of some \[m\]; a metre where none is.
pub(super) fn first_of(length: f32, lengths: &std::ops::RangeInclusive<f32>) -> f32 {
    UNITS.into_iter().find(|unit| lengths.contains(&(unit * length))).unwrap_or(1.0)
}

/// The unit with which a head of a width \[units\] is most like that of a person; with it the width again where none is.
pub(super) fn unit_of_width(width: f32) -> (f32, Option<f32>) {
    let odd = |unit: &f32| math::ln(unit * width / SCALP).abs();
    let usual = UNITS.into_iter().filter(|unit| SCALPS.contains(&(unit * width)));
    let found = usual.min_by(|one, two| odd(one).total_cmp(&odd(two)));
    match found.or_else(|| FURTHER.into_iter().find(|unit| SCALPS.contains(&(unit * width)))) {
        Some(unit) => (unit, None),
        None => (as_written(SCALP / width), Some(width)),
    }
}

/// A scale of two digits, as a person would write it.
fn as_written(scale: f32) -> f32 {
    let digits = math::powf(10.0, 1.0 - math::log10(scale).floor());
    (scale * digits).round() / digits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_a_head_are_usual_ones_then_others_then_what_makes_it_a_person() {
        assert_eq!(unit_of_width(15.0), (0.01, None));
        assert_eq!(unit_of_width(0.51), (0.3048, None));
        assert_eq!(unit_of_width(1.5), (0.1, None));
        assert_eq!(unit_of_width(3.2), (0.047, Some(3.2)), "two digits, as they are written");
    }
}
