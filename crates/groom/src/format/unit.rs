//! The unit of grooms without a body, told by their size, by the scalp that roots show, and by the length of fur.

use glam::Vec3;
use strandline_base::math;

use crate::{
    Groom,
    root_ball::{FULL, RootBall, SURELY_FULL, covered},
};

/// Metres that a unit of a file may be, likelier ones first.
pub const UNITS: [f32; 5] = [1.0, 0.01, 0.001, 0.0254, 0.00254];
/// Diagonal \[m\] of the box around a groom, and that of the fur of a large animal.
pub const GROOMS: std::ops::RangeInclusive<f32> = 0.05..=2.0;
const FURS: std::ops::RangeInclusive<f32> = 0.05..=4.0;
/// Width \[m\] of the ball that the roots of a full head of hair lie on: that of a doll to that of a giant, and that of a
/// person.
const SCALPS: std::ops::RangeInclusive<f32> = 0.09..=0.3;
const SCALP: f32 = 0.17;
/// Mean length \[m\] below which strands all over a body are no fur.
const SHORT: f32 = 0.005;
/// Roots that are looked at.
const ROOTS: usize = 800;

/// Metres of a unit of files that make one groom: the first with which it is as large as hair may be, unless roots lie
/// as those of a full head of hair on a ball that is no head with it, or strands cover a whole body and would be shorter
/// than any fur; 1 where none fits.
pub fn unit_alone(grooms: &[&Groom]) -> f32 {
    let corners =
        grooms.iter().map(|groom| groom.bounds_without_strays()).map(|bounds| (bounds.min, bounds.max));
    let corners = corners.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1)));
    let Some(diagonal) = corners.map(|(low, high)| low.distance(high)) else { return 1.0 };
    let first = |sizes: &std::ops::RangeInclusive<f32>| {
        UNITS.into_iter().find(|unit| sizes.contains(&(unit * diagonal)))
    };
    let by_size = first(&GROOMS);
    let roots = roots(grooms);
    let Some(ball) = RootBall::through(&roots) else { return by_size.unwrap_or(1.0) };
    let covered = covered(&roots, ball.middle);
    if (SURELY_FULL..FULL.end).contains(&covered) {
        return by_scalp(2.0 * ball.radius, by_size).or(by_size).unwrap_or(1.0);
    }
    let is_fur = covered >= FULL.end;
    let is_bare = by_size.is_some_and(|unit| unit * mean_length(grooms) < SHORT);
    let by_size = if is_fur && is_bare {
        first(&FURS).filter(|unit| Some(*unit) > by_size).or(by_size)
    } else {
        by_size
    };
    by_size.unwrap_or(1.0)
}

/// The unit with which a scalp of a width \[units\] is most like that of a person, where it is none with another.
fn by_scalp(width: f32, by_size: Option<f32>) -> Option<f32> {
    if by_size.is_some_and(|unit| SCALPS.contains(&(unit * width))) {
        return by_size;
    }
    let odd = |unit: &f32| math::ln(unit * width / SCALP).abs();
    let usual = UNITS.into_iter().filter(|unit| SCALPS.contains(&(unit * width)));
    usual.min_by(|one, two| odd(one).total_cmp(&odd(two)))
}

fn roots(grooms: &[&Groom]) -> Vec<Vec3> {
    let count: usize = grooms.iter().map(|groom| groom.strand_count()).sum();
    let all = grooms.iter().flat_map(|groom| (0..groom.strand_count()).map(|strand| groom.strand(strand)[0]));
    all.step_by(count.div_ceil(ROOTS).max(1)).collect()
}

/// Mean distance of tips from roots \[units\].
fn mean_length(grooms: &[&Groom]) -> f32 {
    let strands =
        grooms.iter().flat_map(|groom| (0..groom.strand_count()).map(|strand| groom.strand(strand)));
    let length = |strand: &[Vec3]| strand[0].distance(strand[strand.len() - 1]);
    let (sum, count) =
        strands.fold((0.0_f64, 0_u64), |(sum, count), strand| (sum + f64::from(length(strand)), count + 1));
    (sum / count.max(1) as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::{LoadOptions, Parsed, prepare};

    /// Strands of a length on the part of a ball above a height, in units of a file; the ball has a radius of 0.09.
    fn ball(lowest: f32, length: f32, units: f32) -> Groom {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..2000 {
            let height = 1.0 - (1.0 - lowest) * (strand as f32 + 0.5) / 2000.0;
            let around = math::unit_at((0.618_034 * strand as f32).fract() * std::f32::consts::TAU);
            let beside = (1.0 - height * height).sqrt() * around;
            let normal = Vec3::new(beside.x, height, beside.y);
            groom.push([0.0, 0.5, 1.0].map(|point| units * (0.09 + length * point) * normal));
        }
        groom
    }

    #[test]
    fn a_scalp_tells_the_unit_of_a_full_head_of_hair() {
        // Tenths of an inch: in centimetres hair and box are those of much hair, and the scalp is 71 cm wide.
        assert_eq!(unit_alone(&[&ball(-0.2, 0.15, 1.0 / 0.00254)]), 0.00254);
        for (unit, length) in [(1.0, 0.3), (0.01, 0.3), (0.01, 0.002), (0.001, 0.1), (0.0254, 0.2)] {
            assert_eq!(unit_alone(&[&ball(-0.2, length, 1.0 / unit)]), unit, "{length}");
        }
    }

    #[test]
    fn the_length_of_fur_tells_the_unit_of_a_whole_animal() {
        let bear = ball(-0.98, 0.004, 10.0 / 0.01);
        assert_eq!(unit_alone(&[&bear]), 0.01, "an animal of two metres has fur of 4 cm");
        assert_eq!(unit_alone(&[&ball(-0.98, 0.01, 1.0 / 0.001)]), 0.001, "one of 20 cm fur of 1 cm");
        assert_eq!(unit_alone(&[&ball(0.8, 0.003, 1.0)]), 1.0, "a patch of stubble is no fur");
    }

    #[test]
    fn a_format_that_defines_metres_is_believed() {
        let read = |format| {
            let parsed = Parsed { format, groom: ball(-0.2, 0.15, 20.0), problems: Vec::new() };
            prepare(parsed, &LoadOptions::default()).unwrap().report
        };
        let [usda, tfx] = [".usda", ".tfx 4"].map(read);
        assert_eq!(usda.scale, 1.0, "{usda:?}");
        assert!(usda.problems.iter().all(|problem| !problem.contains("unit")), "{usda:?}");
        assert!(tfx.scale < 1.0, "{tfx:?}");
    }
}
