use std::sync::Arc;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{Aabb, DistanceGrid, Mannequin};

/// What a collider moves with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Carrier {
    /// The head: the shape is given in head space.
    #[default]
    Head,
    /// Nothing: the shape is given in world space and stays.
    World,
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
}

impl Shape {
    /// Signed distance \[m\] and unit gradient at a point \[m\], both in the shape's space.
    pub fn distance_and_gradient(&self, _point: Vec3) -> (f32, Vec3) {
        unimplemented!("body mechanics")
    }

    /// A box that holds the shape.
    pub fn bounds(&self) -> Aabb {
        unimplemented!("body mechanics")
    }
}

/// A shape, what carries it, and how it rubs.
#[derive(Clone, Debug)]
pub struct Collider {
    /// The solid.
    pub shape: Shape,
    /// What it moves with.
    pub carrier: Carrier,
    /// Coulomb friction coefficient, 0 is frictionless.
    pub friction: f32,
}
