use glam::{Vec2, Vec3};

use super::field::Field;

/// The eyeball with its lids: a shell over a ball, with an opening as an almond is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    /// Centre of the ball \[m\], on the side of positive x.
    pub(super) center: Vec3,
    /// Radius of the ball \[m\].
    pub(super) radius: f32,
    /// Thickness of the lids \[m\].
    pub(super) lid: f32,
    /// Half of the way from the inner to the outer corner \[m\], along x.
    pub(super) half_width: f32,
    /// Height of the middle line above the corners, in the middle of the eye \[m\].
    pub(super) middle: f32,
    /// Heights of the margins of the upper and the lower lid above and below the middle line \[m\].
    pub(super) margins: [f32; 2],
    /// Way from the margin of the upper lid to its crease \[m\].
    pub(super) crease: f32,
    /// Height of the outer corner above the inner one \[m\].
    pub(super) tilt: f32,
    /// Blend of lids and socket \[m\].
    pub(super) reach: f32,
}

/// Width \[m\] over which a lid's margin falls to the ball.
const MARGIN: f32 = 0.0009;
/// Growth of that width with the height above the lids.
const WIDENING: f32 = 0.4;
/// The socket stays this much \[m\] behind the ball where it is bare.
const CLEAR: f32 = 0.008;
/// The arch of the upper lid is highest nearer to the nose, that of the lower one farther from it: shares.
const SKEW: f32 = 0.22;
/// Crease of the upper lid: half of its width, and depth \[m\].
const CREASE: [f32; 2] = [0.0016, 0.0008];

impl Eye {
    /// Way \[m\] into the opening, as seen from the front; negative on the lids. The gradient lies in the plane.
    pub(super) fn opening(&self, point: Vec3) -> (f32, Vec2) {
        let across = ((point.x - self.center.x) / self.half_width).clamp(-2.0, 2.0);
        let arch = 1.0 - across * across;
        let line = self.middle * arch + 0.5 * self.tilt * across;
        let line_slope = (0.5 * self.tilt - 2.0 * self.middle * across) / self.half_width;
        let above = point.y - self.center.y - line;
        let [skew, margin] = if above >= 0.0 { [-SKEW, self.margins[0]] } else { [SKEW, self.margins[1]] };
        let lean = 1.0 + skew * across;
        let height_slope = margin * (skew * arch - 2.0 * across * lean) / self.half_width;
        let side = if above >= 0.0 { 1.0 } else { -1.0 };
        (margin * lean * arch - above.abs(), Vec2::new(height_slope + side * line_slope, -side))
    }

    /// A place of the margin of a lid \[m\] as seen from the front, by the share of the way from the middle of the eye to its
    /// outer corner, from -1, the inner corner, to 1.
    pub(super) fn margin(&self, across: f32, is_upper: bool) -> Vec2 {
        let arch = 1.0 - across * across;
        let line = self.middle * arch + 0.5 * self.tilt * across;
        let [skew, margin] = if is_upper { [-SKEW, self.margins[0]] } else { [SKEW, -self.margins[1]] };
        let up = line + margin * (1.0 + skew * across) * arch;
        self.center.truncate() + Vec2::new(across * self.half_width, up)
    }

    /// True for a point above the middle line.
    fn is_above(&self, point: Vec3) -> bool {
        let across = ((point.x - self.center.x) / self.half_width).clamp(-2.0, 2.0);
        point.y - self.center.y > self.middle * (1.0 - across * across) + 0.5 * self.tilt * across
    }

    /// Joins ball and lids to the head at a point with x >= 0.
    #[inline]
    pub(super) fn add(&self, point: Vec3, head: &mut Field) {
        let offset = point - self.center;
        let far = offset.length().max(1e-4);
        let outward = offset / far;
        let closed = self.radius + self.lid;
        if far - closed - self.reach > head.value {
            return;
        }
        let mut shell = Field { value: far - closed, gradient: outward };
        let (into, slope) = self.opening(point);
        if offset.z > 0.0 {
            // Farther from the skin the edge is wider, so that the value stays a distance.
            let height = (far - closed).max(0.0);
            let width = MARGIN + WIDENING * height;
            let slope = slope.extend(0.0);
            if into > 0.0 {
                let share = (into / width).min(1.0);
                let open = share * share * (3.0 - 2.0 * share);
                let widening = if height > 0.0 { outward * (WIDENING * into / width) } else { Vec3::ZERO };
                let rise = (slope - widening) * (6.0 * share * (1.0 - share) / width);
                shell.value += self.lid * open;
                shell.gradient += rise * self.lid;
                head.value += CLEAR * open;
                head.gradient += rise * CLEAR;
            } else if self.is_above(point) {
                let [half, depth] = CREASE;
                let off = (into + self.crease) / (half + WIDENING * height);
                let inside = 1.0 - off * off;
                if inside > 0.0 {
                    shell.value += depth * inside * inside;
                    shell.gradient -= slope * (4.0 * depth * inside * off / (half + WIDENING * height));
                }
            }
        }
        *head = head.join(shell, self.reach);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::{Build, Eyes, Mannequin, SignedDistance};

    /// Shares of places before an eye whose value is a distance within a quarter, and is more than that too far.
    fn shares(bust: &Mannequin, skin: &[Vec3], factor: f32) -> [f32; 2] {
        let [mut count, mut good, mut far] = [0.0; 3];
        for index in 0..1200 {
            let mut random = crate::Random::new(5, index);
            let place = Vec3::new(random.unit(), random.unit(), random.unit());
            let place = Vec3::new(0.0155, -0.0290, 0.070) + place * Vec3::new(0.032, 0.025, 0.025);
            let value = factor * bust.distance(place);
            if !(0.001..0.008).contains(&value) {
                continue;
            }
            // Vertices lie 0.6 mm apart: the nearest one is at most 0.1 mm too far at 1 mm.
            let nearest = skin.iter().map(|vertex| vertex.distance(place)).fold(f32::MAX, f32::min);
            count += 1.0;
            good += f32::from(u8::from((0.75 * nearest - 1e-4..1.25 * nearest).contains(&value)));
            far += f32::from(u8::from(value >= 1.25 * nearest));
        }
        assert!(count > 150.0, "{count}");
        [good / count, far / count]
    }

    #[test]
    fn a_lid_ends_at_its_margin() {
        for eyes in Eyes::ALL {
            let eye = Mannequin::of(Build::Medium, eyes).shape.eye;
            for (across, is_upper) in [(-0.9, true), (0.0, true), (0.7, true), (-0.5, false), (0.6, false)] {
                let margin = eye.margin(across, is_upper).extend(0.08);
                let (into, _) = eye.opening(margin);
                assert!(into.abs() < 1e-6, "{eyes:?} {across} {is_upper}: {into}");
                assert_eq!(eye.is_above(margin), is_upper);
            }
        }
    }

    #[test]
    fn the_value_is_a_distance_about_the_lids() {
        for eyes in Eyes::ALL {
            let bust = Mannequin::of(Build::Medium, eyes);
            let near = |vertex: &Vec3| vertex.distance(Vec3::new(0.0315, -0.0165, 0.080)) < 0.04;
            let mesh = bust.figure();
            let skin: Vec<Vec3> = mesh.positions.into_iter().filter(near).collect();
            let [good, far] = shares(&bust, &skin, 1.0);
            // The rest lies over the margins of the lids and in the corner beside the nose.
            assert!(good > 0.88 && far < 0.08, "{eyes:?}: {good} {far}");
            assert!(shares(&bust, &skin, 1.5)[0] < 0.3);
        }
    }
}
