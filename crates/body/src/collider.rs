use std::sync::Arc;

use glam::Vec3;

use crate::{Aabb, BodyError, Caps, DistanceGrid, Mannequin, SignedDistance, SkinSolid};

/// The carrier of a collider.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Carrier {
    /// A piece of the body, by its number in a [`BodyFrame`](crate::BodyFrame): the shape is given in head space.
    Piece(u16),
    /// Nothing: the shape is given in world space and stays.
    World,
    /// A piece, by its number, that moves by itself: the shape is given in the space of the piece, and the body at rest has
    /// no place for it.
    Moved(u16),
}

impl Carrier {
    /// The head.
    pub const HEAD: Self = Self::Piece(0);
}

/// A solid that hair cannot enter.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Centre \[m\].
        center: Vec3,
        /// Radius \[m\].
        radius: f32,
    },
    /// A segment with a radius.
    Capsule {
        /// One end \[m\].
        start: Vec3,
        /// The other end \[m\].
        end: Vec3,
        /// Radius \[m\].
        radius: f32,
    },
    /// The built-in bust, exact.
    Mannequin(Arc<Mannequin>),
    /// A sampled signed distance.
    Grid(Arc<DistanceGrid>),
    /// The skin of a body: where the vertices of a body frame move by themselves its triangles, else the samples.
    Skin(Arc<SkinSolid>),
}

/// Share of the distance between samples of a grid that drawn strands stay away from it, and the most \[m\]: samples err
/// by about so much where the surface curves.
const CLEARANCE: f32 = 0.25;
const MOST_CLEARANCE: f32 = 0.002;

impl Shape {
    /// A ball of `radius` \[m\] about `center` \[m\].
    ///
    /// # Errors
    /// The centre must be finite, the radius finite and above zero.
    pub fn sphere(center: Vec3, radius: f32) -> Result<Self, BodyError> {
        finite("the centre of the sphere", center)?;
        positive("the radius of the sphere", radius)?;
        Ok(Self::Sphere { center, radius })
    }

    /// All points within `radius` \[m\] of the segment from `start` to `end` \[m\];
    /// equal ends make a sphere.
    ///
    /// # Errors
    /// The ends must be finite, the radius finite and above zero.
    pub fn capsule(start: Vec3, end: Vec3, radius: f32) -> Result<Self, BodyError> {
        finite("the start of the capsule", start)?;
        finite("the end of the capsule", end)?;
        positive("the radius of the capsule", radius)?;
        Ok(Self::Capsule { start, end, radius })
    }

    /// Signed distance \[m\] and unit gradient at a point \[m\], both in the shape's space.
    ///
    /// At points without a gradient (the centre of a sphere, the segment of a capsule) it is a unit vector
    /// that leads out of the shape on a shortest path.
    pub fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        match self {
            Self::Sphere { center, radius } => round(point - *center, Vec3::Y, *radius),
            Self::Capsule { start, end, radius } => {
                let axis = *end - *start;
                let nearest = *start + axis * share_along(point - *start, axis);
                let aside = axis.try_normalize().map_or(Vec3::Y, |unit| unit.any_orthonormal_vector());
                round(point - nearest, aside, *radius)
            }
            Self::Mannequin(mannequin) => mannequin.distance_and_gradient(point),
            Self::Grid(grid) => grid.distance_and_gradient(point),
            Self::Skin(skin) => skin.grid().distance_and_gradient(point),
        }
    }

    /// Signed distance \[m\] alone.
    pub fn distance(&self, point: Vec3) -> f32 {
        match self {
            Self::Mannequin(mannequin) => mannequin.distance(point),
            Self::Grid(grid) => grid.distance(point),
            Self::Skin(skin) => skin.grid().distance(point),
            Self::Sphere { .. } | Self::Capsule { .. } => self.distance_and_gradient(point).0,
        }
    }

    /// Lower bound of the distance \[m\] of a point from the shape, 0 for a point that may be inside. It is
    /// cheap where the exact distance is expensive.
    #[inline]
    pub fn distance_at_least(&self, point: Vec3) -> f32 {
        match self {
            Self::Grid(grid) => grid.distance_at_least(point),
            Self::Skin(skin) => skin.grid().distance_at_least(point),
            Self::Mannequin(_) | Self::Sphere { .. } | Self::Capsule { .. } => self.distance(point).max(0.0),
        }
    }

    /// Planes that a part of a bust lies between.
    pub fn caps(&self) -> Option<&Caps> {
        match self {
            Self::Grid(grid) => grid.caps(),
            Self::Sphere { .. } | Self::Capsule { .. } | Self::Mannequin(_) | Self::Skin(_) => None,
        }
    }

    /// True where the planes of the shape tell that it is no nearer to a point \[m\] than a distance \[m\].
    #[inline]
    pub fn is_beyond(&self, point: Vec3, distance: f32) -> bool {
        self.caps().is_some_and(|caps| caps.beyond(point) >= distance)
    }

    /// Distance \[m\] that drawn strands keep from the shape.
    pub fn clearance(&self) -> f32 {
        let of_grid = |grid: &DistanceGrid| (CLEARANCE * grid.spacing()).min(MOST_CLEARANCE);
        match self {
            Self::Grid(grid) => of_grid(grid),
            Self::Skin(skin) => of_grid(skin.grid()),
            Self::Sphere { .. } | Self::Capsule { .. } | Self::Mannequin(_) => 0.0,
        }
    }

    /// True for a shape of the same numbers, or the same grid in memory.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Sphere { center, radius }, Self::Sphere { center: other, radius: to }) => {
                (center, radius) == (other, to)
            }
            (Self::Capsule { start, end, radius }, Self::Capsule { start: from, end: to, radius: other }) => {
                (start, end, radius) == (from, to, other)
            }
            (Self::Mannequin(one), Self::Mannequin(other)) => Arc::ptr_eq(one, other),
            (Self::Grid(one), Self::Grid(other)) => Arc::ptr_eq(one, other),
            (Self::Skin(one), Self::Skin(other)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }

    /// A box that holds the shape.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Sphere { center, radius } => Aabb { min: *center - *radius, max: *center + *radius },
            Self::Capsule { start, end, radius } => {
                Aabb { min: start.min(*end) - *radius, max: start.max(*end) + *radius }
            }
            Self::Mannequin(mannequin) => mannequin.bounds(),
            Self::Grid(grid) => grid.bounds(),
            Self::Skin(skin) => skin.bounds(),
        }
    }
}

/// Distance and gradient of a round shape, `offset` \[m\] from its nearest centre; `aside` is the
/// gradient where the offset has no direction.
fn round(offset: Vec3, aside: Vec3, radius: f32) -> (f32, Vec3) {
    let length = offset.length();
    // Below this the squared length underflows and the direction is noise.
    let gradient = if length > 1e-18 { offset / length } else { aside };
    (length - radius, gradient)
}

/// Parameter of the nearest point along `axis` to the point at `offset` from its start, 0..1; 0 for a
/// zero-length axis.
fn share_along(offset: Vec3, axis: Vec3) -> f32 {
    let squared = axis.length_squared();
    if squared > 0.0 { (offset.dot(axis) / squared).clamp(0.0, 1.0) } else { 0.0 }
}

fn finite(what: &'static str, value: Vec3) -> Result<(), BodyError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(BodyError::Value { what, found: value.to_string(), expected: "three finite numbers [m]" })
}

fn positive(what: &'static str, value: f32) -> Result<(), BodyError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(BodyError::Value { what, found: value.to_string(), expected: "a finite number above zero [m]" })
}

/// A shape, its carrier and its friction.
#[derive(Clone, Debug)]
pub struct Collider {
    /// The solid.
    pub shape: Shape,
    /// Its carrier.
    pub carrier: Carrier,
    /// Coulomb friction coefficient, 0 is frictionless. It acts once per step, for any number of rounds.
    pub friction: f32,
}

impl Collider {
    /// A collider with a Coulomb friction coefficient.
    ///
    /// # Errors
    /// The friction must be finite and not negative; a sphere or capsule must be as
    /// [`Shape::sphere`] and [`Shape::capsule`] ask.
    pub fn new(shape: Shape, carrier: Carrier, friction: f32) -> Result<Self, BodyError> {
        let shape = match shape {
            Shape::Sphere { center, radius } => Shape::sphere(center, radius)?,
            Shape::Capsule { start, end, radius } => Shape::capsule(start, end, radius)?,
            Shape::Mannequin(_) | Shape::Grid(_) | Shape::Skin(_) => shape,
        };
        if !friction.is_finite() || friction < 0.0 {
            return Err(BodyError::Value {
                what: "the friction of the collider",
                found: friction.to_string(),
                expected: "a finite number, zero or more",
            });
        }
        Ok(Self { shape, carrier, friction })
    }

    /// The collider in a world whose origin lies at `origin` \[m\]; none for a grid or a mannequin that stays in the world,
    /// whose samples lie where they are.
    pub fn seen_from(&self, origin: Vec3) -> Option<Self> {
        let shape = match (&self.shape, self.carrier) {
            (shape, Carrier::Piece(_) | Carrier::Moved(_)) => shape.clone(),
            (Shape::Sphere { center, radius }, Carrier::World) => {
                Shape::Sphere { center: *center - origin, radius: *radius }
            }
            (Shape::Capsule { start, end, radius }, Carrier::World) => {
                Shape::Capsule { start: *start - origin, end: *end - origin, radius: *radius }
            }
            (Shape::Mannequin(_) | Shape::Grid(_) | Shape::Skin(_), Carrier::World) => return None,
        };
        Some(Self { shape, ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Single precision over lengths of about 1 m.
    const ROUNDING: f32 = 1e-6;

    fn points() -> impl Iterator<Item = Vec3> {
        (0..343).map(|i| Vec3::new((i % 7) as f32, (i / 7 % 7) as f32, (i / 49) as f32) / 3.0 - 1.0)
    }

    #[test]
    fn a_sphere_is_exact() {
        let shape = Shape::sphere(Vec3::new(0.1, 0.2, -0.3), 0.4).unwrap();
        let (distance, gradient) = shape.distance_and_gradient(Vec3::new(0.1, 1.2, -0.3));
        assert!((distance - 0.6).abs() < ROUNDING);
        assert!((gradient - Vec3::Y).length() < ROUNDING);
        let (distance, _) = shape.distance_and_gradient(Vec3::new(0.2, 0.2, -0.3));
        assert!((distance + 0.3).abs() < ROUNDING);
    }

    #[test]
    fn a_capsule_is_the_nearest_sphere_on_its_segment() {
        let (start, end, radius) = (Vec3::new(-0.3, 0.1, 0.0), Vec3::new(0.4, -0.2, 0.5), 0.2);
        let shape = Shape::capsule(start, end, radius).unwrap();
        for point in points() {
            let brute = (0..=2000)
                .map(|i| point.distance(start.lerp(end, i as f32 / 2000.0)) - radius)
                .fold(f32::INFINITY, f32::min);
            let (distance, gradient) = shape.distance_and_gradient(point);
            // The brute force looks at points 0.45 mm apart: it is at most
            // half of that too far when the point lies on the segment.
            assert!(distance <= brute + ROUNDING && brute - distance < 2.3e-4, "{point}");
            assert!((gradient.length() - 1.0).abs() < ROUNDING);
            let further = shape.distance_and_gradient(point + gradient * 1e-2).0;
            // Rounding of two distances of about 1 m.
            assert!((further - distance - 1e-2).abs() < 2.0 * ROUNDING, "{point}");
        }
    }

    #[test]
    fn a_capsule_of_no_length_is_a_sphere() {
        let center = Vec3::new(0.1, 0.2, 0.3);
        let capsule = Shape::capsule(center, center, 0.25).unwrap();
        let sphere = Shape::sphere(center, 0.25).unwrap();
        for point in points().chain([center]) {
            assert_eq!(capsule.distance_and_gradient(point), sphere.distance_and_gradient(point));
        }
    }

    #[test]
    fn the_gradient_is_a_unit_vector_where_it_does_not_exist() {
        let sphere = Shape::sphere(Vec3::ONE, 0.5).unwrap();
        let capsule = Shape::capsule(Vec3::ZERO, Vec3::X, 0.5).unwrap();
        for (shape, point) in [(&sphere, Vec3::ONE), (&capsule, Vec3::X * 0.5), (&capsule, Vec3::ZERO)] {
            let (distance, gradient) = shape.distance_and_gradient(point);
            assert_eq!(distance, -0.5);
            assert!((gradient.length() - 1.0).abs() < ROUNDING);
            // Following it leads out: 0.5 m away the surface is reached.
            assert!(shape.distance_and_gradient(point + gradient * 0.5).0.abs() < ROUNDING);
        }
    }

    #[test]
    fn the_bounds_touch_the_shape() {
        let capsule = Shape::capsule(Vec3::new(0.0, 1.0, 0.0), Vec3::X, 0.5).unwrap();
        assert_eq!(capsule.bounds(), Aabb { min: Vec3::splat(-0.5), max: Vec3::new(1.5, 1.5, 0.5) });
        let sphere = Shape::sphere(Vec3::X, 0.5).unwrap();
        assert_eq!(sphere.bounds(), Aabb { min: Vec3::new(0.5, -0.5, -0.5), max: Vec3::new(1.5, 0.5, 0.5) });
    }

    #[test]
    fn impossible_values_are_refused_by_name() {
        for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let error = Shape::sphere(Vec3::ZERO, radius).unwrap_err().to_string();
            assert!(error.contains("the radius of the sphere") && error.contains(&radius.to_string()));
            assert!(Shape::capsule(Vec3::ZERO, Vec3::X, radius).is_err());
        }
        assert!(Shape::capsule(Vec3::NAN, Vec3::X, 1.0).is_err());
        let shape = Shape::Sphere { center: Vec3::ZERO, radius: -1.0 };
        assert!(Collider::new(shape, Carrier::HEAD, 0.3).is_err());
        let shape = Shape::Sphere { center: Vec3::ZERO, radius: 1.0 };
        assert!(Collider::new(shape.clone(), Carrier::HEAD, -0.1).is_err());
        assert!(Collider::new(shape.clone(), Carrier::HEAD, f32::NAN).is_err());
        assert!(Collider::new(shape, Carrier::HEAD, 0.0).is_ok());
    }
}
