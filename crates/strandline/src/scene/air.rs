//! Air of a scene at a time: the wind, turbulence and sources.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};
use strandline_base::{math, random::Random};

use super::WindSection;
use crate::sim::{Currents, Drive, Eddy, Source};

/// Waves of turbulence, from its largest length to a quarter of that.
const EDDIES: u32 = 12;
const SHORTEST: f64 = 0.25;

/// The air at a time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Air {
    /// \[m/s\]
    pub wind: Vec3,
    pub currents: Currents,
}

impl From<Vec3> for Air {
    fn from(wind: Vec3) -> Self {
        Self { wind, currents: Currents::default() }
    }
}

impl Air {
    /// This air in a drive.
    pub fn drive(self, drive: Drive) -> Drive {
        Drive { wind: self.wind, currents: self.currents, ..drive }
    }
}

impl WindSection {
    /// The air at a time \[s\], seen from an origin \[m\].
    pub(crate) fn air(&self, time: f64, origin: Vec3) -> Air {
        let wind = self.at(time);
        let sources = self.sources.iter().map(|source| Source {
            place: source.position - origin,
            direction: source.direction.map_or(Vec3::ZERO, Vec3::normalize_or_zero),
            speed: source.speed * self.risen(time),
            radius: source.radius,
        });
        let eddies =
            if self.turbulence > 0.0 { self.eddies(time, origin, wind.length()) } else { Vec::new() };
        Air { wind, currents: Currents { eddies, sources: sources.collect() } }
    }

    /// Waves of random directions and phases, each across its own direction [Kraichnan1970], whose energy falls with the
    /// 5/3 power of their number [Pope2000]. They ride along with the mean wind and change by themselves.
    fn eddies(&self, time: f64, origin: Vec3, speed: f32) -> Vec<Eddy> {
        let mut random = Random::new(u64::from(self.seed), 0);
        let mut unit = || Vec3::new(random.signed(), random.signed(), random.signed()).normalize_or(Vec3::X);
        // Of constant velocity: else a change of the wind would throw all eddies about.
        let carried = self.carrying().as_dvec3();
        let mut eddies = Vec::new();
        for index in 0..EDDIES {
            let share = math::powf(SHORTEST, f64::from(index) / f64::from(EDDIES - 1));
            let length = f64::from(self.turbulence_size) * share;
            let (toward, other, begun) = (unit(), unit(), unit());
            let across = toward.cross(other).normalize_or(toward.any_orthonormal_vector());
            let wave = toward.as_dvec3() * (TAU / length);
            let own = 0.5 * f64::from(self.turbulence) * carried.length() * TAU / length;
            let there = wave.dot(DVec3::from(origin)) - wave.dot(carried) * time + own * time;
            let phase = (there + TAU * f64::from(begun.x)).rem_euclid(TAU);
            let size = math::cbrt(share) as f32;
            eddies.push(Eddy { wave: wave.as_vec3(), phase: phase as f32, velocity: across * size });
        }
        // A wave has half of the square of its largest velocity in the mean.
        let energy: f32 = eddies.iter().map(|eddy| 0.5 * eddy.velocity.length_squared()).sum();
        let scale = self.turbulence * speed / energy.sqrt();
        eddies.iter_mut().for_each(|eddy| eddy.velocity *= scale);
        eddies
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::WindSource;

    fn windy() -> WindSection {
        WindSection { velocity: Vec3::X * 2.0, gust: 0.0, turbulence: 0.3, ..WindSection::default() }
    }

    #[test]
    fn turbulence_has_its_speed_and_rides_along() {
        let wind = windy();
        let currents = wind.air(0.0, Vec3::ZERO).currents;
        let random = &mut Random::new(7, 0);
        let places: Vec<Vec3> =
            (0..4000).map(|_| 20.0 * Vec3::new(random.signed(), random.signed(), random.signed())).collect();
        let square = |places: &[Vec3]| {
            places.iter().map(|place| currents.at(*place).length_squared()).sum::<f32>() / places.len() as f32
        };
        assert!((square(&places).sqrt() / 0.6 - 1.0).abs() < 0.05, "{} m/s", square(&places).sqrt());
        // Nowhere compressed.
        for eddy in &currents.eddies {
            assert!(eddy.velocity.dot(eddy.wave).abs() < 1e-4 * eddy.velocity.length() * eddy.wave.length());
        }
        // A hundredth of a second later the same air is 2 cm farther; elsewhere it is other air.
        let later = wind.air(0.01, Vec3::ZERO).currents;
        let (mut rides, mut stays) = (0.0, 0.0);
        for place in &places[..500] {
            rides += later.at(*place + Vec3::X * 0.02).distance(currents.at(*place));
            stays += later.at(*place).distance(currents.at(*place));
        }
        assert!(rides < 0.5 * stays, "{rides} along, {stays} in place");
    }

    #[test]
    fn the_air_does_not_depend_on_the_origin_nor_on_gusts_before() {
        let mut wind = windy();
        wind.sources.push(WindSource { direction: Some(Vec3::Y * 3.0), ..WindSource::default() });
        let (origin, place) = (Vec3::new(8.0, -2.0, 1.0), Vec3::new(0.02, 0.3, 0.01));
        let [here, there] =
            [Vec3::ZERO, origin].map(|origin| wind.air(0.7, origin).currents.at(place - origin));
        assert!(here.distance(there) < 1e-3, "{here} and {there}");
        assert!(here.y > 1.0, "the fan blows up: {here}");
        wind.seed += 1;
        assert!(wind.air(0.7, Vec3::ZERO).currents.at(place).distance(here) > 0.01, "another seed");
    }
}
