//! Numbers of the box of cells along the wind that both backends need.

use glam::Vec3;
use strandline_base::vec3x8::{Vec3x8, load};
use wide::f32x8;

use crate::Model;
use crate::strands::rods::air::{DENSITY, Wisp};
use crate::strands::rods::hairs::Traits;

/// Cells along each axis, without the ring around them.
pub(crate) const SIDE: usize = 16;
/// Cells along each axis, with it.
pub(crate) const WIDE: usize = SIDE + 2;
/// All cells.
pub(crate) const CELLS: usize = WIDE * WIDE * WIDE;
/// Speed \[m/s\] below which air that passes hair is as good as none.
pub(crate) const NO_SPEED: f32 = 1e-6;
/// Speed \[m/s\] of air relative to hair below which the drag area is that at this speed.
pub(crate) const LEAST_SPEED: f32 = 0.05;
/// Whole number that areas, and speeds, of all points add up to at most: no sum of a cell overflows.
const LARGEST_SUM: f32 = (1 << 30) as f32;

/// Unit vectors along the wind, upward from it, and aside; those of the world without wind.
#[derive(Clone, Copy)]
pub(crate) struct Axes(pub [Vec3; 3]);

impl Axes {
    #[inline(always)]
    pub fn local(&self, vector: Vec3x8) -> Vec3x8 {
        let [x, y, z] = self.0.map(|axis| Vec3x8::splat(axis).dot(vector));
        Vec3x8 { x, y, z }
    }

    pub fn world(&self, vector: Vec3) -> Vec3 {
        self.0[0] * vector.x + self.0[1] * vector.y + self.0[2] * vector.z
    }

    /// Axes along a wind.
    pub fn along(wind: Vec3) -> Self {
        let toward = if wind.length() > NO_SPEED { wind.normalize() } else { Vec3::X };
        let up = if toward.y.abs() < 0.9 { Vec3::Y } else { Vec3::Z };
        let aside = toward.cross(up).normalize();
        Self([toward, aside.cross(toward), aside])
    }
}

/// Whole number that the velocity of a point along an axis has at most.
pub(crate) fn most_speed_sum(model: &Model) -> f32 {
    LARGEST_SUM / (model.strand_count * model.points_per_strand) as f32
}

/// Whole numbers in a square metre of drag area.
pub(crate) fn per_area(model: &Model) -> f32 {
    let Some(rods) = &model.rods else { return 1.0 };
    let own = |traits: &Traits| model.settings.drag.hairs.unwrap_or(traits.hairs);
    let wisps = rods.traits.iter().map(|traits| [traits.diameter, own(traits), traits.packing]);
    // Strands of one kind lie one behind the other.
    let (mut last, mut largest) = ([0.0; 3], 0.0);
    for wisp in wisps {
        if wisp != last {
            last = wisp;
            let [diameter, hairs, packing] = wisp.map(f64::from);
            // As a file has it, not as the nearest number of single precision.
            let packing = (1e4 * packing).round() / 1e4;
            let slow = f64::from(LEAST_SPEED);
            largest = Wisp::new(diameter, hairs, hairs, packing).drag(slow)[0].max(largest);
        }
    }
    let lengths = model.rest.stretch.iter().fold(f32x8::ZERO, |sum, lanes| sum + load(lanes));
    // Strands grow to twice their length.
    let length = 2.0 * lengths.to_array().iter().sum::<f32>();
    let area = length * (largest / (f64::from(LEAST_SPEED) * DENSITY)) as f32;
    // Rounding adds up to half a number a point.
    0.5 * LARGEST_SUM / area.max(1e-20)
}
