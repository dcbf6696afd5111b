//! Curvature and twist at a joint, and how they change [Bergou2008, Bergou2010].

use super::real::{Real, Vector};

/// A segment: length, tangent and rotation of its section.
#[derive(Clone, Copy, Debug)]
pub struct Segment<R> {
    /// Length \[m\].
    pub length: R,
    /// Unit tangent.
    pub tangent: Vector<R>,
    /// First axis of the section, a unit vector across the tangent.
    pub across: Vector<R>,
}

impl<R: Real> Segment<R> {
    /// Second axis of the section.
    #[inline(always)]
    pub fn second(&self) -> Vector<R> {
        self.tangent.cross(self.across)
    }

    /// `yes` where `mask` is above 0, else `no`.
    #[inline(always)]
    pub fn choose(mask: R, yes: Self, no: Self) -> Self {
        Self {
            length: mask.choose(yes.length, no.length),
            tangent: Vector::choose(mask, yes.tangent, no.tangent),
            across: Vector::choose(mask, yes.across, no.across),
        }
    }

    /// The segment with another edge \[m\]: its section is carried along by the smallest rotation
    /// between the tangents, then turned by `angle` \[rad\] about the new one.
    #[inline(always)]
    pub fn moved(&self, edge: Vector<R>, angle: R) -> Self {
        let length = edge.length();
        let tangent = edge * (R::of(1.0) / length);
        let carried = transported(self.across, self.tangent, tangent);
        // Half-angle form: no trigonometry, and a rotation to the last bit.
        let half = angle * R::of(0.5);
        let share = R::of(1.0) / (R::of(1.0) + half * half);
        let turned =
            carried * ((R::of(1.0) - half * half) * share) + tangent.cross(carried) * (angle * share);
        let upright = turned - tangent * turned.dot(tangent);
        Self { length, tangent, across: upright * (R::of(1.0) / upright.length()) }
    }
}

/// Carries a vector across `from` by the smallest rotation that takes the unit vector `from` to `to`.
#[inline(always)]
pub fn transported<R: Real>(vector: Vector<R>, from: Vector<R>, to: Vector<R>) -> Vector<R> {
    let sum = (R::of(1.0) + from.dot(to)).or_more(R::of(SHARPEST));
    vector - (from + to) * (to.dot(vector) / sum)
}

/// 1 + cosine below which a joint counts as folded; keeps quotients finite.
const SHARPEST: f64 = 1e-3;

/// Strains of a joint: two components of the curvature binormal along the section's axes and the
/// twist. Each is 2 tan of half an angle: [Bergou2008 eq. 1] for the curvature, and for the twist the
/// same measure, so that neither needs trigonometry and a joint never turns over.
pub type Strains<R> = [R; 3];

/// Strains of the joint from segment `lower` to segment `upper`.
#[inline(always)]
pub fn strains<R: Real>(lower: &Segment<R>, upper: &Segment<R>) -> Strains<R> {
    Joint::new(lower, upper).strains
}

/// Derivative of one strain by the two edges \[1/m\] and by the two angles \[1/rad\] of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Slope<R> {
    /// By the lower edge.
    pub lower: Vector<R>,
    /// By the upper edge.
    pub upper: Vector<R>,
    /// By the lower angle.
    pub lower_angle: R,
    /// By the upper angle.
    pub upper_angle: R,
}

/// Second derivative of the energy by an angle of a joint, without the squares of the slopes: by the two
/// edges \[N\] and by the angle itself \[N m\].
#[derive(Clone, Copy, Debug)]
pub struct Turning<R> {
    /// By the lower edge.
    pub lower: Vector<R>,
    /// By the upper edge.
    pub upper: Vector<R>,
    /// By the angle itself.
    pub angle: R,
}

/// A joint with what its strains and their derivatives share.
pub struct Joint<R> {
    /// Its strains.
    pub strains: Strains<R>,
    /// Curvature binormal.
    binormal: Vector<R>,
    /// 1 over 1 + cosine of the bend.
    inverse_sum: R,
}

impl<R: Real> Joint<R> {
    /// The joint from segment `lower` to segment `upper`.
    #[inline(always)]
    pub fn new(lower: &Segment<R>, upper: &Segment<R>) -> Self {
        let half = R::of(0.5);
        let sum = (R::of(1.0) + lower.tangent.dot(upper.tangent)).or_more(R::of(SHARPEST));
        let inverse_sum = R::of(1.0) / sum;
        let binormal = lower.tangent.cross(upper.tangent) * (R::of(2.0) * inverse_sum);
        let first = (lower.second() + upper.second()).dot(binormal) * half;
        let second = -((lower.across + upper.across).dot(binormal) * half);
        let carried = transported(lower.across, lower.tangent, upper.tangent);
        let sine = carried.cross(upper.across).dot(upper.tangent);
        let cosine_sum = (R::of(1.0) + carried.dot(upper.across)).or_more(R::of(SHARPEST));
        let twist = R::of(2.0) * sine / cosine_sum;
        Self { strains: [first, second, twist], binormal, inverse_sum }
    }

    /// Derivatives of the three strains [Bergou2010, appendix].
    #[inline(always)]
    pub fn slopes(&self, lower: &Segment<R>, upper: &Segment<R>) -> [Slope<R>; 3] {
        let half = R::of(0.5);
        let (per_lower, per_upper) = (R::of(1.0) / lower.length, R::of(1.0) / upper.length);
        let mean_tangent = (lower.tangent + upper.tangent) * self.inverse_sum;
        let mean_across = (lower.across + upper.across) * self.inverse_sum;
        let (lower_second, upper_second) = (lower.second(), upper.second());
        let mean_second = (lower_second + upper_second) * self.inverse_sum;
        let [first, second, twist] = self.strains;
        let turn = R::of(1.0) + twist * twist * R::of(0.25);
        let along = self.binormal * (half * turn);
        [
            Slope {
                lower: (upper.tangent.cross(mean_second) - mean_tangent * first) * per_lower,
                upper: (-(lower.tangent.cross(mean_second)) - mean_tangent * first) * per_upper,
                lower_angle: -(lower.across.dot(self.binormal) * half),
                upper_angle: -(upper.across.dot(self.binormal) * half),
            },
            Slope {
                lower: (-(upper.tangent.cross(mean_across)) - mean_tangent * second) * per_lower,
                upper: (lower.tangent.cross(mean_across) - mean_tangent * second) * per_upper,
                lower_angle: -(lower_second.dot(self.binormal) * half),
                upper_angle: -(upper_second.dot(self.binormal) * half),
            },
            Slope {
                lower: along * per_lower,
                upper: along * per_upper,
                lower_angle: -turn,
                upper_angle: turn,
            },
        ]
    }

    /// Change of the bending moments \[N m\] of a joint with the turns of its two sections: moments turn with
    /// them, which the squares of the slopes leave out. Without this term Newton's method gains a digit in
    /// three steps under moments as large as those of a style's weight.
    #[inline(always)]
    pub fn turnings(&self, lower: &Segment<R>, upper: &Segment<R>, moments: [R; 2]) -> [Turning<R>; 2] {
        [self.turning(lower, lower, upper, moments), self.turning(upper, lower, upper, moments)]
    }

    // Not a closure: one that is not inlined would make a call of every operation.
    #[inline(always)]
    fn turning(
        &self,
        section: &Segment<R>,
        lower: &Segment<R>,
        upper: &Segment<R>,
        moments: [R; 2],
    ) -> Turning<R> {
        let half = R::of(0.5);
        let mean_tangent = (lower.tangent + upper.tangent) * self.inverse_sum;
        let (per_lower, per_upper) = (R::of(1.0) / lower.length, R::of(1.0) / upper.length);
        let (across, second) = (section.across, section.second());
        let moment = across * moments[0] + second * moments[1];
        let other = second * moments[0] - across * moments[1];
        let along = mean_tangent * (moment.dot(self.binormal) * half);
        let moment = moment * self.inverse_sum;
        Turning {
            lower: (along - upper.tangent.cross(moment)) * per_lower,
            upper: (along + lower.tangent.cross(moment)) * per_upper,
            angle: -(other.dot(self.binormal) * half),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent() -> [Segment<f64>; 2] {
        let start =
            Segment { length: 1.0, tangent: Vector::new(0.0, 0.0, 1.0), across: Vector::new(1.0, 0.0, 0.0) };
        [start.moved(Vector::new(0.3, -0.2, 0.9), 0.4), start.moved(Vector::new(-0.4, 0.7, 0.8), 1.3)]
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_strains() {
        let [lower, upper] = bent();
        let slopes = Joint::new(&lower, &upper).slopes(&lower, &upper);
        let step = 1e-6;
        for axis in 0..8 {
            let moved = |sign: f64| {
                let nudge = |k: usize| if axis == k { sign * step } else { 0.0 };
                let edge = |segment: &Segment<f64>, first: usize| {
                    segment.tangent * segment.length
                        + Vector::new(nudge(first), nudge(first + 1), nudge(first + 2))
                };
                strains(&lower.moved(edge(&lower, 0), nudge(6)), &upper.moved(edge(&upper, 3), nudge(7)))
            };
            let (before, after) = (moved(-1.0), moved(1.0));
            for (strain, slope) in slopes.iter().enumerate() {
                let [a, b, c] = slope.lower.array();
                let [d, e, f] = slope.upper.array();
                let expected = [a, b, c, d, e, f, slope.lower_angle, slope.upper_angle][axis];
                let found = (after[strain] - before[strain]) / (2.0 * step);
                // A central difference with this step is good to some 1e-10.
                assert!((found - expected).abs() < 1e-8, "strain {strain}, axis {axis}: {found} {expected}");
            }
        }
    }

    #[test]
    fn turnings_are_the_derivatives_of_the_moments_about_the_sections() {
        let [lower, upper] = bent();
        let moments = [0.7, -0.4];
        let turnings = Joint::new(&lower, &upper).turnings(&lower, &upper, moments);
        let step = 1e-6;
        // The moment about each section, of the two bends.
        let about = |lower: &Segment<f64>, upper: &Segment<f64>| {
            let [first, second, _] = Joint::new(lower, upper).slopes(lower, upper);
            let sum =
                |angle: fn(&Slope<f64>) -> f64| moments[0] * angle(&first) + moments[1] * angle(&second);
            [sum(|slope| slope.lower_angle), sum(|slope| slope.upper_angle)]
        };
        for axis in 0..8 {
            let moved = |sign: f64| {
                let nudge = |k: usize| if axis == k { sign * step } else { 0.0 };
                let edge = |segment: &Segment<f64>, first: usize| {
                    segment.tangent * segment.length
                        + Vector::new(nudge(first), nudge(first + 1), nudge(first + 2))
                };
                about(&lower.moved(edge(&lower, 0), nudge(6)), &upper.moved(edge(&upper, 3), nudge(7)))
            };
            let (before, after) = (moved(-1.0), moved(1.0));
            for (section, turning) in turnings.iter().enumerate() {
                let [a, b, c] = turning.lower.array();
                let [d, e, f] = turning.upper.array();
                let angles = if section == 0 { [turning.angle, 0.0] } else { [0.0, turning.angle] };
                let expected = [a, b, c, d, e, f, angles[0], angles[1]][axis];
                let found = (after[section] - before[section]) / (2.0 * step);
                assert!(
                    (found - expected).abs() < 1e-8,
                    "section {section}, axis {axis}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_section_turned_by_an_angle_has_its_twist() {
        let segment =
            Segment { length: 1.0, tangent: Vector::new(0.0, 0.0, 1.0), across: Vector::new(1.0, 0.0, 0.0) };
        let angle: f64 = 0.7;
        let half = 2.0 * (angle / 2.0).tan();
        let turned = segment.moved(Vector::new(0.0, 0.0, 1.0), half);
        let [first, second, twist] = strains(&segment, &turned);
        assert!(first.abs() < 1e-12 && second.abs() < 1e-12);
        assert!((twist - half).abs() < 1e-12, "{twist}");
    }
}
