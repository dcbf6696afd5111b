//! Numbers and vectors that the same code computes with: one strand in double precision, or eight in single.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use glam::Vec3;
use wide::f32x8;

/// A number, or one number for each strand of a block.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The number, in every lane.
    fn of(number: f64) -> Self;
    /// Square root.
    fn root(self) -> Self;
    /// The larger of two.
    fn or_more(self, other: Self) -> Self;
    /// The smaller of two.
    fn or_less(self, other: Self) -> Self;
    /// `yes` where this is above 0, else `no`.
    fn choose(self, yes: Self, no: Self) -> Self;
    /// True if it is above 0 in any lane.
    fn any_positive(self) -> bool;
}

impl Real for f64 {
    #[inline]
    fn of(number: f64) -> Self {
        number
    }

    #[inline]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline]
    fn or_more(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline]
    fn or_less(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline]
    fn choose(self, yes: Self, no: Self) -> Self {
        if self > 0.0 { yes } else { no }
    }

    #[inline]
    fn any_positive(self) -> bool {
        self > 0.0
    }
}

impl Real for f32x8 {
    #[inline(always)]
    fn of(number: f64) -> Self {
        Self::splat(number as f32)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        self.fast_max(other)
    }

    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        self.fast_min(other)
    }

    #[inline(always)]
    fn choose(self, yes: Self, no: Self) -> Self {
        self.simd_gt(Self::ZERO).bitselect(yes, no)
    }

    #[inline(always)]
    fn any_positive(self) -> bool {
        self.simd_gt(Self::ZERO).any()
    }
}

/// A vector of three numbers.
#[derive(Clone, Copy, Debug)]
pub struct Vector<R> {
    /// First component.
    pub x: R,
    /// Second component.
    pub y: R,
    /// Third component.
    pub z: R,
}

impl From<Vec3> for Vector<f64> {
    fn from(vector: Vec3) -> Self {
        let [x, y, z] = vector.to_array().map(f64::from);
        Self { x, y, z }
    }
}

impl<R: Real> Vector<R> {
    /// From its components.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }

    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { x: R::of(0.0), y: R::of(0.0), z: R::of(0.0) }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Length, never 0, so that it may divide.
    #[inline(always)]
    pub fn length(self) -> R {
        (self.dot(self) + R::of(1e-30)).root()
    }

    /// `yes` where `mask` is above 0, else `no`.
    #[inline(always)]
    pub fn choose(mask: R, yes: Self, no: Self) -> Self {
        Self { x: mask.choose(yes.x, no.x), y: mask.choose(yes.y, no.y), z: mask.choose(yes.z, no.z) }
    }

    /// Component along an axis, 0 to 2.
    #[inline(always)]
    pub fn axis<const AXIS: usize>(self) -> R {
        match AXIS {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    /// Components in order.
    #[inline(always)]
    pub fn array(self) -> [R; 3] {
        [self.x, self.y, self.z]
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<R: Real> Mul<R> for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: R) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<R: Real> Neg for Vector<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<R: Real> AddAssign for Vector<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<R: Real> SubAssign for Vector<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
