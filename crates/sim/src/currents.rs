//! Currents of the air beside the wind: turbulence, and sources.

use glam::Vec3;
use strandline_base::math;

/// Share by which a jet widens on its way [Pope2000].
pub(crate) const WIDENS: f32 = 0.1;
/// Most numbers of each that count.
pub(crate) const MOST_EDDIES: usize = 16;
pub(crate) const MOST_SOURCES: usize = 8;

/// A wave of turbulence: air that goes to and fro across the direction in which the wave changes, so that it is nowhere
/// compressed. Some of different lengths make a field \[Kraichnan1970\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Eddy {
    /// Direction in which it changes, 2 pi over its length \[rad/m\], world space.
    pub wave: Vec3,
    /// Phase at the origin at the end of the step \[rad\].
    pub phase: f32,
    /// Largest velocity \[m/s\], across `wave`.
    pub velocity: Vec3,
}

/// A place from which air blows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Source {
    /// Place \[m\], world space.
    pub place: Vec3,
    /// Unit vector along which a fan blows; 0 for a source that blows to all sides.
    pub direction: Vec3,
    /// Speed of the air at the source \[m/s\]: on the axis of a fan where it begins, else at `radius`.
    pub speed: f32,
    /// Radius \[m\].
    pub radius: f32,
}

/// Currents of the air during a step, beside the wind. Rods under [`Drag::factor`](crate::Drag::factor) with
/// [`Drag::shelter`](crate::Drag::shelter) feel them; the first 16 eddies and the first 8 sources count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Currents {
    /// Turbulence.
    pub eddies: Vec<Eddy>,
    /// Sources.
    pub sources: Vec<Source>,
}

impl Currents {
    /// True for air that has the velocity of the wind everywhere.
    pub fn is_empty(&self) -> bool {
        self.eddies.is_empty() && self.sources.is_empty()
    }

    /// Velocity at a place \[m\], relative to the wind \[m/s\].
    pub fn at(&self, place: Vec3) -> Vec3 {
        let eddies = self.eddies.iter().map(|eddy| {
            let phase = eddy.wave.dot(place) + eddy.phase;
            eddy.velocity * math::sin(phase - std::f32::consts::TAU * (phase / std::f32::consts::TAU).floor())
        });
        let sources = self.sources.iter().map(|source| source.at(place));
        eddies.chain(sources).fold(Vec3::ZERO, |sum, velocity| sum + velocity)
    }

    /// Those that count, without any of which a number is not finite.
    pub(crate) fn sound(&self) -> Self {
        let is_sound =
            |eddy: &&Eddy| eddy.wave.is_finite() && eddy.phase.is_finite() && eddy.velocity.is_finite();
        let blows = |source: &&Source| {
            let vectors = source.place.is_finite() && source.direction.is_finite();
            vectors && source.speed.is_finite() && source.radius > 0.0 && source.radius.is_finite()
        };
        Self {
            eddies: self.eddies.iter().filter(is_sound).take(MOST_EDDIES).copied().collect(),
            sources: self.sources.iter().filter(blows).take(MOST_SOURCES).copied().collect(),
        }
    }

    /// Rows for a kernel: the numbers of eddies and sources, then two rows for each.
    #[cfg(feature = "gpu")]
    pub(crate) fn rows(&self) -> Vec<[f32; 4]> {
        let mut rows = vec![[self.eddies.len() as f32, self.sources.len() as f32, 0.0, 0.0]];
        for eddy in &self.eddies {
            rows.extend([eddy.wave.extend(eddy.phase), eddy.velocity.extend(0.0)].map(|row| row.to_array()));
        }
        for source in &self.sources {
            let place = source.place.extend(source.speed);
            rows.extend([place, source.direction.extend(source.radius)].map(|row| row.to_array()));
        }
        rows
    }
}

impl Source {
    /// Velocity that it gives the air at a place \[m/s\].
    ///
    /// A fan is a round jet: across it the profile of Schlichting, which widens by a tenth of the way and keeps its
    /// momentum [Pope2000]. A source to all sides gives each sphere about it as much air.
    fn at(&self, place: Vec3) -> Vec3 {
        let way = place - self.place;
        if self.direction == Vec3::ZERO {
            let distance = way.length().max(self.radius);
            return way * (self.speed * self.radius * self.radius / (distance * distance * distance));
        }
        let along = way.dot(self.direction);
        let width = self.radius + WIDENS * along.max(0.0);
        let across = (way - self.direction * along).length_squared() / (width * width);
        let profile = 1.0 / ((1.0 + across) * (1.0 + across));
        let ahead = if along > 0.0 { 1.0 } else { 0.0 };
        self.direction * (self.speed * self.radius / width * profile * ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_blow_as_far_as_they_should() {
        let point = Source { speed: 2.0, radius: 0.1, ..Source::default() };
        assert!((point.at(Vec3::X * 0.1) - Vec3::X * 2.0).length() < 1e-6);
        assert!((point.at(Vec3::Y * 0.2) - Vec3::Y * 0.5).length() < 1e-6, "a quarter at twice the distance");
        assert_eq!(point.at(Vec3::ZERO), Vec3::ZERO);
        let fan = Source { direction: Vec3::X, ..point };
        // Twice as wide after ten radii, with half the speed.
        assert!((fan.at(Vec3::X).x - 1.0).abs() < 1e-6);
        assert!((fan.at(Vec3::new(1.0, 0.2, 0.0)).x - 0.25).abs() < 1e-6);
        assert_eq!(fan.at(Vec3::NEG_X), Vec3::ZERO);
        let both = Currents { eddies: Vec::new(), sources: vec![point, fan] };
        assert_eq!(both.at(Vec3::X), point.at(Vec3::X) + fan.at(Vec3::X));
    }

    #[test]
    fn what_is_no_number_and_what_is_too_many_does_not_count() {
        let eddy = Eddy { wave: Vec3::X, phase: 0.5, velocity: Vec3::Y };
        let bad = Eddy { phase: f32::NAN, ..eddy };
        let source = Source { speed: 1.0, radius: 0.1, ..Source::default() };
        let sources = vec![Source { radius: 0.0, ..source }, source];
        let currents = Currents { eddies: [vec![bad], vec![eddy; 20]].concat(), sources };
        let sound = currents.sound();
        assert_eq!((sound.eddies.len(), sound.sources.len()), (MOST_EDDIES, 1));
        assert!(sound.at(Vec3::ONE).is_finite());
    }
}
