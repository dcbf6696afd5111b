use glam::Vec3;
use strandline_base::math;
use strandline_base::{Group, Key, SettingError, choices, settings};

use crate::RenderError;
use crate::light_field::Field;

choices! {
    /// Spread of a light's rays.
    pub enum LightKind as "light.kind" {
        /// Parallel rays from `position` toward `target`, as from the sun.
        Directional = "directional",
        /// A cone from `position` about the way to `target`.
        Spot = "spot",
        /// Every way from `position`.
        Point = "point",
        /// From a rectangle of `width` and `height` about `position` that faces `target`, upright.
        Rectangle = "rectangle",
        /// From a disc of diameter `width` about `position` that faces `target`.
        Disc = "disc",
    }
    default Spot
}

settings! {
    /// A light. Each may cast shadows of hair and body.
    pub struct Light: Copy {
        /// Spread of its rays.
        kind: LightKind = LightKind::default();
        /// Position, world space.
        position: Vec3 = Vec3::new(0.9, 0.9, 1.2), in [-1e6, 1e6] "m";
        /// Target, world space.
        target: Vec3 = Vec3::ZERO, in [-1e6, 1e6] "m";
        /// Colour, linear RGB.
        color: Vec3 = Vec3::ONE, in [0.0, 1000.0];
        /// Radiance of a white matte surface at the target that faces the light; spot and point
        /// lights fall off from there with the square of the distance.
        intensity: f32 = 1.0, in [0.0, 1e6], slider [0.0, 5.0], more "a brighter light";
        /// Angle between the axis and the rim of a spot light's cone.
        cone_angle: f32 = 30.0, in [1.0, 85.0] "degrees", more "a wider cone";
        /// Share of that angle over which the rim fades.
        cone_softness: f32 = 0.3, in [0.0, 1.0], more "a softer rim";
        /// Width of a rectangle, diameter of a disc.
        width: f32 = 0.5, in [1e-3, 1e3] "m", slider [0.05, 2.0], more "softer shadows";
        /// Height of a rectangle.
        height: f32 = 0.5, in [1e-3, 1e3] "m", slider [0.05, 2.0], more "softer shadows";
        /// Places along each side from which a rectangle or disc is taken to shine, each with shadows of its own; on
        /// a GPU all lights together have at most eight places with shadow.
        samples: u32 = 2, in [1, 4], more "smoother shadows, at a cost that grows with its square";
        /// Makes hair and body cast shadows in it.
        shadow: bool = true;
    }
    also Light::apart;
}

/// Light that a light sends to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Unit direction from the point to the light, world space.
    pub to_light: Vec3,
    /// Radiance, linear RGB, of a white matte surface at the point that faces the light; pi times
    /// this is the irradiance. Shadows are not in it.
    pub radiance: Vec3,
}

impl Light {
    /// The light in a world whose origin lies at `origin` \[m\].
    pub fn seen_from(&self, origin: Vec3) -> Self {
        Self { position: self.position - origin, target: self.target - origin, ..*self }
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// The first setting outside its range; a light that stands on its target.
    pub fn validate(&self) -> Result<(), RenderError> {
        Ok(self.check_as("light")?)
    }

    fn apart(&self, key: &Key) -> Result<(), SettingError> {
        if self.position.distance(self.target) > 1e-6 {
            return Ok(());
        }
        Err(SettingError::new(key.of("position"), self.position, "a place apart from the target"))
    }

    /// Light at a point \[m\], world space.
    pub fn at(&self, point: Vec3) -> Illumination {
        self.shining().at(point)
    }

    /// The light for many points.
    pub(crate) fn shining(&self) -> Shining<'_> {
        let axis = self.position - self.target;
        let cosines = if self.kind == LightKind::Spot { self.cone_cosines() } else { [0.0; 2] };
        Shining {
            light: self,
            axis: axis.normalize_or(Vec3::Y),
            square: axis.length_squared(),
            radiance: self.color * self.intensity,
            cosines,
        }
    }

    /// Places that it is taken to shine from.
    pub(crate) fn sample_count(&self) -> usize {
        match self.kind {
            LightKind::Directional | LightKind::Spot | LightKind::Point => 1,
            LightKind::Rectangle | LightKind::Disc => (self.samples * self.samples) as usize,
        }
    }

    /// Directions of the sides of its surface.
    fn sides(&self) -> [Vec3; 2] {
        let forward = (self.target - self.position).normalize_or(Vec3::NEG_Y);
        let right = forward.cross(Vec3::Y).normalize_or(Vec3::X);
        [right, right.cross(forward)]
    }

    /// Sides \[m\] of the part of it that each of these places stands for: of a disc a square of the same area.
    pub(crate) fn part(&self) -> [Vec3; 2] {
        let [right, up] = self.sides();
        let count = self.samples as f32;
        match self.kind {
            LightKind::Directional | LightKind::Spot | LightKind::Point => [Vec3::ZERO; 2],
            LightKind::Rectangle => [right * (self.width / count), up * (self.height / count)],
            LightKind::Disc => {
                let side = 0.5 * std::f32::consts::PI.sqrt() * self.width / count;
                [right * side, up * side]
            }
        }
    }

    /// Area \[m^2\] of that part.
    pub(crate) fn part_area(&self) -> f32 {
        let count = self.sample_count() as f32;
        match self.kind {
            LightKind::Directional | LightKind::Spot | LightKind::Point => 0.0,
            LightKind::Rectangle => self.width * self.height / count,
            LightKind::Disc => 0.25 * std::f32::consts::PI * self.width * self.width / count,
        }
    }

    /// The lights at these places that stand for it.
    fn at_samples(self) -> impl Iterator<Item = Self> {
        let count = self.sample_count();
        let [right, up] = self.sides();
        (0..count).map(move |index| {
            let [x, y] = self.sample(index);
            let offset = if count == 1 { Vec3::ZERO } else { right * x + up * y };
            Self {
                position: self.position + offset,
                target: self.target + offset,
                intensity: self.intensity / count as f32,
                ..self
            }
        })
    }

    /// A place beside the middle \[m\].
    fn sample(&self, index: usize) -> [f32; 2] {
        let side = self.samples as usize;
        let middle = |at: usize| (at as f32 + 0.5) / side as f32 - 0.5;
        let place = [middle(index % side), middle(index / side)];
        if self.kind == LightKind::Disc {
            on_disc(place, self.samples as f32).map(|place| self.width * place)
        } else {
            [self.width * place[0], self.height * place[1]]
        }
    }

    /// Cosines of a spot light's rim and of where it begins to fade.
    pub(crate) fn cone_cosines(&self) -> [f32; 2] {
        let rim = self.cone_angle.to_radians();
        let full = rim * (1.0 - self.cone_softness.clamp(1e-3, 1.0));
        [math::cos(rim), math::cos(full)]
    }
}

/// Middle of one of the equal squares along the sides of a square, on a disc that the square is mapped onto,
/// rings onto rings [Shirley1997]: the centroid of the square's image. Both have the side or diameter 1.
fn on_disc([x, y]: [f32; 2], count: f32) -> [f32; 2] {
    const QUARTER: f32 = std::f32::consts::FRAC_PI_4;
    let most = x.abs().max(y.abs());
    if most < 0.25 / count {
        return [0.0; 2];
    }
    // Of a sector of a ring: both have their own factor.
    let [outer, inner] = [2.0 * most + 1.0 / count, 2.0 * most - 1.0 / count];
    let half_turn = QUARTER / (2.0 * most * count);
    let radius = (outer.powi(3) - inner.powi(3)) / (3.0 * (outer * outer - inner * inner));
    let radius = radius * math::sin(half_turn) / half_turn;
    let aside = if x.abs() >= y.abs() { y / x } else { x / y };
    let (sine, cosine) = math::sin_cos(QUARTER * aside);
    if x.abs() >= y.abs() {
        [radius * cosine * x.signum(), radius * sine * x.signum()]
    } else {
        [radius * sine * y.signum(), radius * cosine * y.signum()]
    }
}

/// A light with what it is to all points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shining<'a> {
    light: &'a Light,
    /// Unit direction to it from its target, and the square of their distance \[m^2\].
    axis: Vec3,
    square: f32,
    /// Radiance at the target, linear RGB.
    radiance: Vec3,
    /// Of a spot light's rim and of where it begins to fade.
    cosines: [f32; 2],
}

impl Shining<'_> {
    /// Light at a point \[m\], world space.
    #[inline]
    pub(crate) fn at(&self, point: Vec3) -> Illumination {
        if self.light.kind == LightKind::Directional {
            return Illumination { to_light: self.axis, radiance: self.radiance };
        }
        let way = self.light.position - point;
        let to_light = way.normalize_or(Vec3::Y);
        let falloff = self.square / way.length_squared().max(1e-6);
        let facing = to_light.dot(self.axis);
        let cone = match self.light.kind {
            LightKind::Directional | LightKind::Point => 1.0,
            LightKind::Spot => self.cone(facing),
            // A matte surface.
            LightKind::Rectangle | LightKind::Disc => facing.max(0.0),
        };
        Illumination { to_light, radiance: self.radiance * (falloff * cone) }
    }

    /// Share of a spot light at a cosine from its axis.
    fn cone(&self, cosine: f32) -> f32 {
        let [rim, full] = self.cosines;
        let share = ((cosine - rim) / (full - rim)).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }
}

/// The lights with those that have an area as the places that they shine from, in order; behind them the suns of the
/// surroundings.
pub(crate) fn at_samples(lights: &[Light], suns: &[Light]) -> Vec<Light> {
    lights.iter().flat_map(|light| light.at_samples()).chain(suns.iter().copied()).collect()
}

/// Number of places with shadow of all lights and of the suns of the surroundings.
pub(crate) fn shadow_places(lights: &[Light], suns: &[Light]) -> u64 {
    let casting = lights.iter().filter(|light| light.shadow);
    casting.map(|light| light.sample_count() as u64).sum::<u64>() + suns.len() as u64
}

/// Number of the first place of a light among those of all lights.
pub(crate) fn first_sample(lights: &[Light], light: usize) -> usize {
    lights.iter().take(light).map(Light::sample_count).sum()
}

settings! {
    /// Light from all around: a sky above and a ground below, even between.
    pub struct Environment: Copy {
        /// Radiance from straight above, linear RGB.
        sky: Vec3 = Vec3::new(0.13, 0.145, 0.165), in [0.0, 1000.0];
        /// Radiance from straight below, linear RGB.
        ground: Vec3 = Vec3::new(0.065, 0.055, 0.05), in [0.0, 1000.0];
    }
}

impl Environment {
    /// The same as spherical harmonics.
    pub fn field(&self) -> Field {
        let mut field = Field::default();
        field[0] = (0.5 * (self.sky + self.ground)).extend(0.0);
        field[2] = (0.5 * (self.sky - self.ground)).extend(0.0);
        field
    }

    /// Radiance from a unit direction, linear RGB.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        self.ground.lerp(self.sky, 0.5 + 0.5 * direction.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_shines_as_its_places_do() {
        let light = Light { kind: LightKind::Rectangle, position: Vec3::Y, samples: 4, ..Light::default() };
        let lights = [light, Light { kind: LightKind::Disc, ..light }, Light::default()];
        let places = at_samples(&lights, &[]);
        assert_eq!(places.len(), 33);
        assert_eq!(first_sample(&[light, light], 1), 16);
        // Over a square of 0.5 m at 1 m: the integral of cosine^4 / pi by finer places than these.
        let shown: f32 = places[..16].iter().map(|place| place.at(Vec3::ZERO).radiance.x).sum();
        let exact: f32 = (0..10_000)
            .map(|at| [at % 100, at / 100].map(|at| (at as f32 + 0.5) / 200.0 - 0.25))
            .map(|[x, y]| (1.0 + x * x + y * y).powi(-2) * 1e-4 * (1.0 + x * x + y * y).sqrt())
            .sum();
        assert!((shown / exact - 1.0).abs() < 0.03, "{shown} {exact}");
        let areas = [places[0], places[16], places[32]].map(|place| place.part_area());
        let sides = places[0].part().map(Vec3::length);
        assert!((areas[0] - sides[0] * sides[1]).abs() < 1e-7 && areas[2] == 0.0, "{areas:?}");
        assert!((areas[1] / areas[0] - 0.25 * std::f32::consts::PI).abs() < 1e-5);
        // Nothing shines backward, and all places lie on the disc.
        assert_eq!(places[0].at(Vec3::Y * 2.0).radiance, Vec3::ZERO);
        assert!(places[16..32].iter().all(|place| place.position.distance(Vec3::Y) <= 0.25));
    }

    #[test]
    fn a_spot_fades_to_its_rim_and_with_distance() {
        let light = Light { position: Vec3::Y, ..Light::default() };
        assert_eq!(light.at(Vec3::ZERO).radiance, Vec3::ONE);
        let below = light.at(Vec3::NEG_Y).radiance.x;
        assert!((below - 0.25).abs() < 1e-6);
        assert_eq!(light.at(Vec3::X).radiance, Vec3::ZERO);
        let half = light.at(Vec3::new(0.5, 0.0, 0.0)).radiance.x;
        assert!(half > 0.05 && half < 0.8, "{half}");
    }

    #[test]
    fn bad_lights_are_refused() {
        assert!(Light::all_sides(Vec3::ZERO).iter().all(|light| light.validate().is_ok()));
        assert!(Light::three_point(Vec3::ZERO).iter().all(|light| light.validate().is_ok()));
        assert!(Light::studio(Vec3::ONE).iter().all(|light| light.validate().is_ok()));
        assert!(Light { position: Vec3::ZERO, ..Light::default() }.validate().is_err());
        assert!(Light { intensity: -1.0, ..Light::default() }.validate().is_err());
        assert!(Light { color: Vec3::splat(f32::NAN), ..Light::default() }.validate().is_err());
        assert!(Light { cone_angle: 0.0, ..Light::default() }.validate().is_err());
    }
}
