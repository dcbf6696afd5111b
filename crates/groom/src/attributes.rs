//! Attributes of points, resampled with their strands.

use glam::Vec3;
use strandline_base::SettingError;

use crate::arcs::equal_places;
use crate::{Groom, GroomError};

/// Checks that masses and velocities fit the points.
pub(crate) fn check(groom: &Groom) -> Result<(), GroomError> {
    check_masses(groom.masses.as_deref(), groom.points.len())?;
    check_velocities(groom.velocities.as_deref(), groom.points.len())
}

pub(crate) fn check_masses(masses: Option<&[f32]>, points: usize) -> Result<(), GroomError> {
    let Some(masses) = masses else { return Ok(()) };
    check_count("masses", masses.len(), points)?;
    match masses.iter().position(|mass| !(*mass > 0.0 && mass.is_finite())) {
        Some(index) => refuse("masses", format!("{} kg at point {index}", masses[index]), "above 0"),
        None => Ok(()),
    }
}

/// Fastest part of a velocity that hair may begin with \[m/s\]: more than any head moves.
const MOST_SPEED: f32 = 1000.0;

pub(crate) fn check_velocities(velocities: Option<&[Vec3]>, points: usize) -> Result<(), GroomError> {
    let Some(velocities) = velocities else { return Ok(()) };
    check_count("velocities", velocities.len(), points)?;
    let is_slow = |velocity: &Vec3| velocity.to_array().iter().all(|part| part.abs() <= MOST_SPEED);
    match velocities.iter().position(|velocity| !is_slow(velocity)) {
        Some(index) => refuse(
            "velocities",
            format!("{} at point {index}", velocities[index]),
            "numbers from -1000 to 1000 m/s",
        ),
        None => Ok(()),
    }
}

fn check_count(name: &'static str, found: usize, points: usize) -> Result<(), GroomError> {
    if found == points {
        return Ok(());
    }
    refuse(name, format!("given for {found} of {points} points"), "one for each point")
}

fn refuse(name: &'static str, found: String, expected: &'static str) -> Result<(), GroomError> {
    Err(SettingError::new(name, found, expected).into())
}

/// Attribute of points, at `count` points at equal arc length on every strand; `mix` interpolates between two
/// points.
pub(crate) fn along<T: Copy>(
    groom: &Groom,
    values: &[T],
    count: usize,
    mix: impl Fn(T, T, f32) -> T,
) -> Vec<T> {
    let strands = 0..groom.strand_count();
    let mixed = strands.flat_map(|strand| {
        let own = &values[groom.range(strand)];
        let mix = &mix;
        equal_places(groom.strand(strand), count).map(move |(segment, share)| match share {
            1.0 => own[segment + 1],
            _ => mix(own[segment], own[segment + 1], share),
        })
    });
    mixed.collect()
}

/// Masses of a strand \[kg\] at `count` points at equal arc length, of the same sum.
///
/// The mass of a point lies evenly along the halves of its segments; a new point takes what lies along the
/// halves of its own. Points that are at equal arc length already keep their masses, but for rounding.
pub(crate) fn masses(groom: &Groom, strand: usize, count: usize) -> Option<Vec<f32>> {
    let masses = &groom.masses.as_ref()?[groom.range(strand)];
    let points = groom.strand(strand);
    // End of the share of each point \[m\], and the mass up to there [kg].
    let (mut ends, mut sums) = (vec![0.0_f64], vec![0.0_f64]);
    let mut passed = 0.0;
    for (point, mass) in masses.iter().enumerate() {
        let length = points.get(point + 1).map_or(0.0, |next| f64::from(points[point].distance(*next)));
        ends.push(passed + 0.5 * length);
        sums.push(sums[point] + f64::from(*mass));
        passed += length;
    }
    let total = sums[masses.len()];
    let mut part = 0;
    let mut before = 0.0;
    let taken = (0..count).map(|index| {
        let end = passed * (index as f64 + 0.5) / (count - 1) as f64;
        while part + 2 < ends.len() && ends[part + 1] < end {
            part += 1;
        }
        let width = ends[part + 1] - ends[part];
        let share = if width > 0.0 { ((end - ends[part]) / width).clamp(0.0, 1.0) } else { 1.0 };
        let sum = if index + 1 == count { total } else { sums[part] + share * (sums[part + 1] - sums[part]) };
        let mass = sum - before;
        before = sum;
        mass as f32
    });
    Some(taken.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Guides;

    fn strand(points: usize) -> Groom {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::X]);
        groom.push((0..points).map(|point| Vec3::Y * 0.01 * point as f32));
        groom.masses = Some((0..points + 2).map(|point| 1e-6 * (1.0 + point as f32)).collect());
        groom.velocities = Some((0..points + 2).map(|point| Vec3::Z * point as f32).collect());
        groom
    }

    #[test]
    fn what_points_have_stays_with_them() {
        let groom = strand(8);
        let guides = Guides::resample(&groom, 8).unwrap();
        let (masses, velocities) = (guides.masses().unwrap(), guides.velocities().unwrap());
        for point in 0..8 {
            // Rounding of arc lengths.
            assert!((masses[8 + point] / (1e-6 * (3.0 + point as f32)) - 1.0).abs() < 1e-4, "{point}");
            assert!((velocities[8 + point].z - (2.0 + point as f32)).abs() < 1e-4, "{point}");
        }
    }

    #[test]
    fn resampling_keeps_the_mass_of_a_strand_and_where_it_lies() {
        for count in [4, 7, 20] {
            let (whole, guides) = (strand(11), Guides::resample(&strand(11), count).unwrap());
            let expected: f32 = whole.masses.as_ref().unwrap()[2..].iter().sum();
            let masses = &guides.masses().unwrap()[count..];
            assert!((masses.iter().sum::<f32>() / expected - 1.0).abs() < 1e-5, "{count} points");
            let middle: f32 = masses.iter().enumerate().map(|(i, m)| m * i as f32 / (count - 1) as f32).sum();
            let own: f32 = (0..11).map(|i| 1e-6 * (3.0 + i as f32) * i as f32 / 10.0).sum();
            // Ends have half a share: where mass lies is known to half a segment.
            assert!((middle / expected - own / expected).abs() < 0.03, "{count} points");
            let groom = whole.resampled(count).unwrap();
            assert_eq!(groom.masses.unwrap()[count..], *masses);
        }
    }

    #[test]
    fn attributes_that_do_not_fit_are_refused() {
        let refused = |change: fn(&mut Groom)| {
            let mut groom = strand(8);
            change(&mut groom);
            Guides::resample(&groom, 8).unwrap_err().to_string()
        };
        assert_eq!(
            refused(|groom| groom.masses = Some(vec![1.0])),
            "masses is given for 1 of 10 points, expected one for each point"
        );
        assert!(refused(|groom| groom.masses.as_mut().unwrap()[4] = -1.0).contains("-1 kg at point 4"));
        assert!(refused(|groom| groom.velocities.as_mut().unwrap()[3].y = f32::NAN).contains("at point 3"));
        assert!(refused(|groom| groom.velocities.as_mut().unwrap().truncate(9)).contains("for 9 of 10"));
    }
}
