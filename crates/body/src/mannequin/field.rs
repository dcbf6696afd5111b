use glam::Vec3;

/// A value of an implicit surface and its gradient.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    /// Value \[m\], negative inside.
    pub(super) value: f32,
    /// Gradient of the value, no unit.
    pub(super) gradient: Vec3,
}

impl Field {
    /// Smooth union: a cubic blend where the two values differ by less than `reach` \[m\], so that
    /// curvature stays continuous; exactly the smaller one elsewhere.
    #[inline]
    pub(super) fn join(self, other: Self, reach: f32) -> Self {
        let (near, far) = if self.value <= other.value { (self, other) } else { (other, self) };
        let overlap = 1.0 - (far.value - near.value) / reach;
        if overlap <= 0.0 {
            return near;
        }
        let share = 0.5 * overlap * overlap;
        Self {
            value: near.value - reach * overlap * overlap * overlap / 6.0,
            gradient: near.gradient * (1.0 - share) + far.gradient * share,
        }
    }

    /// Smooth intersection, the mirror image of [`Field::join`].
    #[inline]
    pub(super) fn cut(self, other: Self, reach: f32) -> Self {
        self.negated().join(other.negated(), reach).negated()
    }

    fn negated(self) -> Self {
        Self { value: -self.value, gradient: -self.gradient }
    }
}

/// An ellipsoid along the axes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipsoid {
    /// Centre \[m\].
    pub(super) center: Vec3,
    /// Half axes \[m\].
    pub(super) radii: Vec3,
}

impl Ellipsoid {
    /// Distance to first order: exact on the surface and along the axes' directions far away.
    #[inline]
    pub(super) fn at(&self, point: Vec3) -> Field {
        let offset = point - self.center;
        let unit = offset / self.radii;
        let slope = unit / self.radii;
        let size = unit.length().max(1e-3);
        let rate = slope.length().max(1e-3);
        let along_size = slope / size;
        let along_rate = slope / (self.radii * self.radii * rate);
        Field {
            value: size * (size - 1.0) / rate,
            gradient: along_size * ((2.0 * size - 1.0) / rate)
                - along_rate * (size * (size - 1.0) / (rate * rate)),
        }
    }
}

/// The hull of two balls.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(super) struct RoundCone {
    /// Centre of the first ball \[m\].
    pub(super) start: Vec3,
    /// Centre of the second ball \[m\].
    pub(super) end: Vec3,
    /// Radius of the first ball \[m\].
    pub(super) start_radius: f32,
    /// Radius of the second ball \[m\].
    pub(super) end_radius: f32,
}

impl RoundCone {
    /// Exact distance.
    #[inline]
    pub(super) fn at(&self, point: Vec3) -> Field {
        let axis = self.end - self.start;
        let length = axis.length();
        let axis = axis / length;
        let offset = point - self.start;
        let along = offset.dot(axis);
        let across = offset - axis * along;
        let across_length = across.length();
        // The flank touches both balls: its foot on the axis is shifted by the slope.
        let sine = (self.start_radius - self.end_radius) / length;
        let cosine = (1.0 - sine * sine).max(1e-6).sqrt();
        let share = ((along - across_length * sine / cosine) / length).clamp(0.0, 1.0);
        let center = self.start + axis * (length * share);
        let radius = self.start_radius + (self.end_radius - self.start_radius) * share;
        let arm = point - center;
        let distance = arm.length();
        Field { value: distance - radius, gradient: arm / distance.max(1e-6) }
    }
}

/// A local swelling (or hollow, when its height is negative) of the skin: compact, with
/// continuous curvature, the same at every distance from the skin under it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub(super) struct Swelling {
    center: Vec3,
    inverse_radii: Vec3,
    height: f32,
    bend: f32,
}

impl Swelling {
    /// `center` \[m\] on the side of positive x; `radii` \[m\] of the region that it reaches; `height` \[m\]
    /// in its centre; `bend` \[1/m\]: the region follows the parabola y = bend x^2 about its centre.
    pub(super) const fn new(center: Vec3, radii: Vec3, height: f32, bend: f32) -> Self {
        let inverse_radii = Vec3::new(1.0 / radii.x, 1.0 / radii.y, 1.0 / radii.z);
        Self { center, inverse_radii, height, bend }
    }

    /// Height \[m\] at a place with x >= 0, its slope added to `slope`; one that crosses the middle
    /// is mirrored.
    #[inline]
    fn height_at(&self, place: Vec3, slope: &mut Vec3) -> f32 {
        let mut height = self.height_about(self.center, place, slope);
        if self.center.x > 0.0 && (place.x + self.center.x) * self.inverse_radii.x < 1.0 {
            let mirrored = Vec3::new(-self.center.x, self.center.y, self.center.z);
            height += self.height_about(mirrored, place, slope);
        }
        height
    }

    /// Raises the skin where the point itself lies in the region: for shells that are too thin to
    /// tell which side a point belongs to. Not mirrored.
    #[inline]
    pub(super) fn raise_here(&self, point: Vec3, field: &mut Field) {
        let mut slope = Vec3::ZERO;
        field.value -= self.height_about(self.center, point, &mut slope);
        field.gradient -= slope;
    }

    #[inline]
    fn height_about(&self, center: Vec3, place: Vec3, slope: &mut Vec3) -> f32 {
        let mut offset = place - center;
        let bent = self.bend * offset.x;
        offset.y -= bent * offset.x;
        let unit = offset * self.inverse_radii;
        let inside = 1.0 - unit.length_squared();
        if inside <= 0.0 {
            return 0.0;
        }
        let rate = unit * self.inverse_radii * (-6.0 * self.height * inside * inside);
        *slope += Vec3::new(rate.x - 2.0 * bent * rate.y, rate.y, rate.z);
        self.height * inside * inside * inside
    }
}

/// Radius of curvature \[m\] of skin, with which slopes spread away from it.
const CURVATURE_RADIUS: f32 = 0.08;

/// Raises the skin at a point with x >= 0 by the swellings at the foot of the point on it.
#[inline]
pub(super) fn raise(swellings: &[Swelling], point: Vec3, field: &mut Field) {
    let steepness = field.gradient.length_recip();
    let normal = field.gradient * steepness;
    let above = field.value * steepness;
    let foot = point - normal * above;
    let (mut height, mut slope) = (0.0, Vec3::ZERO);
    for swelling in swellings {
        height += swelling.height_at(foot, &mut slope);
    }
    let spread = CURVATURE_RADIUS / (CURVATURE_RADIUS + above).max(0.5 * CURVATURE_RADIUS);
    field.value -= height;
    field.gradient -= (slope - normal * slope.dot(normal)) * spread;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences at 1 mm; f32 rounding of 0.1 m values leaves 1e-4.
    fn check_gradient(at: impl Fn(Vec3) -> Field, point: Vec3) {
        let step = 1e-3;
        let slope =
            |axis: Vec3| (at(point + axis * step).value - at(point - axis * step).value) / (2.0 * step);
        let expected = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z));
        let found = at(point).gradient;
        assert!((found - expected).length() < 5e-3, "{point}: {found} is not {expected}");
    }

    #[test]
    fn gradients_are_the_slopes_of_the_values() {
        let ball = Ellipsoid { center: Vec3::new(0.01, 0.0, 0.02), radii: Vec3::new(0.07, 0.1, 0.09) };
        let cone = RoundCone {
            start: Vec3::new(0.0, -0.1, 0.0),
            end: Vec3::new(0.1, -0.15, 0.02),
            start_radius: 0.05,
            end_radius: 0.03,
        };
        let all = |point: Vec3| {
            let field = ball.at(point).join(cone.at(point), 0.04);
            field.cut(Field { value: point.y - 0.12, gradient: Vec3::Y }, 0.02)
        };
        for point in [
            Vec3::new(0.03, 0.04, 0.1),
            Vec3::new(0.01, 0.02, 0.1),
            Vec3::new(0.06, -0.08, 0.03),
            Vec3::new(0.02, 0.11, 0.0),
            Vec3::new(0.2, -0.2, 0.1),
        ] {
            check_gradient(all, point);
        }
    }

    #[test]
    fn a_swelling_has_its_height_and_its_slope_on_the_skin() {
        let radius = CURVATURE_RADIUS;
        let ball = Ellipsoid { center: Vec3::ZERO, radii: Vec3::splat(radius) };
        let swelling = Swelling::new(Vec3::new(0.02, 0.0, 0.077), Vec3::new(0.04, 0.03, 0.05), 0.005, 6.0);
        let raised = |point: Vec3| {
            let mut field = ball.at(point);
            raise(&[swelling], point, &mut field);
            field
        };
        let top = Vec3::new(0.02, 0.0, 0.077).normalize();
        for above in [0.0, 0.02] {
            let value = raised(top * (radius + above)).value;
            assert!((value - (above - 0.005)).abs() < 1e-4, "{value}");
        }
        for point in [Vec3::new(0.03, 0.01, 0.075), Vec3::new(0.005, 0.0, 0.08), Vec3::new(0.02, -0.01, 0.09)]
        {
            check_gradient(raised, point);
        }
    }
}
