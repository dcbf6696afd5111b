use std::sync::Arc;

use glam::{Vec2, Vec3};
use strandline_base::Recent;

use super::field::Field;
use super::person::{Build, Eyes};
use super::shape::BustShape;
use crate::{Aabb, BodyError, DistanceGrid, SignedDistance};

/// The built-in bust: a smooth signed-distance model of skull, jaw, nose, ears, neck and shoulders.
///
/// Head space: the centre of the skull is near the origin, y up, the face looks along +z.
/// Everything is symmetric in x.
#[derive(Clone, Debug)]
pub struct Mannequin {
    pub(super) shape: BustShape,
    build: Build,
    eyes: Eyes,
}

/// Within this distance \[m\] of the skin the value is divided by the length of its gradient,
/// which makes it a distance to first order; the correction has faded out at twice as much.
const CORRECTED: f32 = 0.015;
/// In creases, where the gradient is shorter than this, the division would promise too much.
const STEEP_ENOUGH: f32 = 0.75;
/// Ways \[m\] from the middle of an eye up to which nothing is multiplied, and from which on all is as elsewhere.
const ABOUT_EYES: [f32; 2] = [0.028, 0.040];
/// From this distance \[m\] on the value grows by [`FAR_RATE`] of the way, because the skin under a
/// place need not be the nearest skin.
const FAR: f32 = 0.010;
const FAR_RATE: f32 = 0.7;

impl Mannequin {
    /// The one model, shared: of medium build, with open eyes.
    pub fn new() -> Arc<Self> {
        Arc::new(Self::default())
    }

    /// The model of a build. Skull, scalp and ears are those of any other; the distance differs at cheeks, jaw, lids,
    /// neck and shoulders alone.
    pub fn of(build: Build, eyes: Eyes) -> Self {
        Self { shape: BustShape::of(build, eyes), build, eyes }
    }

    /// The shortest gradient by which a value is divided: about the eyes, where brow, lids and cheek fold, none promises
    /// too much.
    fn steep_enough(&self, point: Vec3) -> f32 {
        let [near, far] = ABOUT_EYES;
        let half = Vec3::new(point.x.abs(), point.y, point.z);
        let off = (half.distance(self.shape.eye.center) - near) / (far - near);
        STEEP_ENOUGH + (1.0 - STEEP_ENOUGH) * (1.0 - off).clamp(0.0, 1.0)
    }

    /// Distance \[m\] from the skin and direction away from it at a point, from the field there.
    pub(super) fn distance_of(&self, point: Vec3, field: &Field) -> (f32, Vec3) {
        let steepness = field.gradient.length().max(self.steep_enough(point));
        let fade = (2.0 - field.value.abs() / CORRECTED).clamp(0.0, 1.0);
        let value = field.value / (1.0 + (steepness - 1.0) * fade);
        let distance = if value > FAR { FAR + FAR_RATE * (value - FAR) } else { value };
        (distance, field.gradient.normalize_or(Vec3::Y))
    }

    /// Build and eyes, of which all of the model is a function.
    pub(super) fn kind(&self) -> (Build, Eyes) {
        (self.build, self.eyes)
    }

    /// The signed distance sampled at `spacing` \[m\], padded by `padding` \[m\], as [`DistanceGrid::from_field`]
    /// makes it. The process keeps the last two.
    ///
    /// # Errors
    /// As [`DistanceGrid::from_field`].
    pub fn grid(&self, spacing: f32, padding: f32) -> Result<Arc<DistanceGrid>, BodyError> {
        static GRIDS: Recent<(Build, Eyes, [u32; 2]), DistanceGrid, 2> = Recent::new();
        let key = (self.build, self.eyes, [spacing, padding].map(f32::to_bits));
        GRIDS.get(key, || DistanceGrid::from_field(self, spacing, padding))
    }

    /// Build and eyes.
    pub(crate) fn person(&self) -> (Build, Eyes) {
        (self.build, self.eyes)
    }

    /// True where the eyeballs show.
    pub(super) fn has_open_eyes(&self) -> bool {
        self.eyes == Eyes::Open
    }

    /// Distance \[m\] to the nearer ear alone.
    pub fn ear_distance(&self, point: Vec3) -> f32 {
        self.shape.ear_distance(point)
    }

    /// True if an ear is nearer than a distance \[m\]: quicker than the distance itself where both are far.
    pub(crate) fn is_ear_within(&self, point: Vec3, distance: f32) -> bool {
        self.shape.is_ear_within(point, distance)
    }

    /// A place of the margin of a lid of the eye on the side of positive x \[m\], as seen from the front. `across` is the share
    /// of the way from the middle of the eye to its outer corner, from -1, the inner corner, to 1.
    pub fn lid_margin(&self, across: f32, is_upper: bool) -> Vec2 {
        self.shape.eye.margin(across, is_upper)
    }

    /// Centre of the eyeball on the side of positive x \[m\].
    pub fn eye_center(&self) -> Vec3 {
        self.shape.eye.center
    }

    /// The point \[m\] about which the head nods and turns: between the base of the skull and the
    /// uppermost vertebra.
    pub fn neck_pivot(&self) -> Vec3 {
        Vec3::new(0.0, -0.062, -0.016)
    }
}

impl Default for Mannequin {
    fn default() -> Self {
        Self::of(Build::default(), Eyes::default())
    }
}

impl SignedDistance for Mannequin {
    fn distance(&self, point: Vec3) -> f32 {
        self.distance_and_gradient(point).0
    }

    fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        self.distance_of(point, &self.shape.at(point))
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        let side = match self.build {
            Build::Slender | Build::Medium => 0.217,
            Build::Broad => 0.236,
        };
        Aabb { min: Vec3::new(-side, -0.265, -0.115), max: Vec3::new(side, 0.112, 0.122) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    /// Places spread over the box of the bust.
    fn places(count: usize) -> impl Iterator<Item = Vec3> {
        let bounds = Mannequin::default().bounds();
        (0..count).map(move |index| {
            let mut random = Random::new(11, index as u64);
            let share = Vec3::new(random.unit(), random.unit(), random.unit());
            bounds.min + share * (bounds.max - bounds.min)
        })
    }

    #[test]
    fn the_head_has_the_size_of_a_head() {
        let bust = Mannequin::default();
        let reach = |direction: Vec3, from: Vec3| {
            (0..4000)
                .map(|step| step as f32 * 1e-4)
                .find(|&far| bust.distance(from + direction * far) > 0.0)
                .unwrap()
        };
        let vertex = reach(Vec3::Y, Vec3::ZERO);
        let chin = reach(Vec3::NEG_Y, Vec3::new(0.0, -0.08, 0.075)) + 0.08;
        assert!((0.225..0.235).contains(&(vertex + chin)), "height {}", vertex + chin);
        let above_ears = Vec3::new(0.0, 0.02, 0.0);
        let breadth = 2.0 * reach(Vec3::X, above_ears);
        assert!((0.148..0.160).contains(&breadth), "breadth {breadth}");
        let length = reach(Vec3::Z, above_ears) + reach(Vec3::NEG_Z, above_ears);
        assert!((0.188..0.202).contains(&length), "length {length}");
    }

    #[test]
    fn both_sides_are_the_same() {
        let bust = Mannequin::default();
        for place in places(2000) {
            let mirror = Vec3::new(-1.0, 1.0, 1.0);
            let (distance, gradient) = bust.distance_and_gradient(place);
            assert_eq!((distance, gradient * mirror), bust.distance_and_gradient(place * mirror));
        }
    }

    #[test]
    fn the_value_is_a_distance_near_the_skin() {
        let bust = Mannequin::default();
        let step = 5e-4;
        let (mut near, mut good) = ([0; 2], [0; 2]);
        for place in places(60_000) {
            let distance = bust.distance(place);
            if !(0.0..FAR - step).contains(&distance) {
                continue;
            }
            let slope = |axis: Vec3| bust.distance(place + axis * step) - bust.distance(place - axis * step);
            let length = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).length() / (2.0 * step);
            let band = usize::from(distance > 0.5 * FAR);
            near[band] += 1;
            good[band] += usize::from((0.9..1.1).contains(&length));
        }
        assert!(near[0] > 1500 && near[1] > 1500);
        // The rest lies in ears and between lips, nose and chin, where a distance has creases itself.
        assert!(good[0] as f32 > 0.95 * near[0] as f32, "{good:?} of {near:?}");
        assert!(good[1] as f32 > 0.88 * near[1] as f32, "{good:?} of {near:?}");
    }

    #[test]
    fn the_value_never_promises_too_much() {
        let bust = Mannequin::default();
        let mesh = bust.mesh();
        for place in places(300).filter(|&place| bust.distance(place) > 0.003) {
            let nearest = mesh.positions.iter().map(|vertex| vertex.distance(place)).fold(f32::MAX, f32::min);
            // Vertices lie 2.2 mm apart, so the nearest one may be off by 1.3 mm sideways: 0.3 mm at 3 mm.
            assert!(
                bust.distance(place) < 1.02 * nearest + 3e-4,
                "{place}: {} {nearest}",
                bust.distance(place)
            );
        }
    }

    #[test]
    fn the_bust_fits_its_bounds() {
        let bust = Mannequin::default();
        let bounds = bust.bounds();
        for vertex in bust.mesh().positions {
            assert!(vertex.cmpge(bounds.min).all() && vertex.cmple(bounds.max).all(), "{vertex}");
        }
    }
}
