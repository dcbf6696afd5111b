//! Solids on the path of a point through a step: continuous collision with signed distances.

use glam::Vec3;

/// A look-up of the signed distance of solids, in the space of their carrier.
#[derive(Clone, Copy, Debug)]
pub struct LookUp {
    /// Position of the look-up \[m\].
    pub place: Vec3,
    /// Signed distance \[m\] there, never more than the true one outside.
    pub distance: f32,
    /// Its unit gradient.
    pub normal: Vec3,
    /// Coulomb friction coefficient.
    pub friction: f32,
}

/// Longest path \[m\] that is not followed: half of it is less than the thickness of an ear lobe.
const SHORT: f32 = 4e-3;
/// Most look-ups along a path.
const LOOKS: usize = 32;
/// Least share of a path in one stride, so that the look-ups suffice for a path that slides along a solid.
const LEAST_STRIDE: f32 = 1.0 / 24.0;
/// Remaining distance \[m\] at which a point has arrived.
const ARRIVED: f32 = 1e-4;

/// Follows a point from `start` to `end` \[m\] and returns the look-up where it stops: at the end, or at a solid before
/// it.
///
/// A stride is as long as the signed distance, within which the path is free [Hart1996]. At a surface the point slides on
/// along it: the motion into the solid is lost, as in an impact without a rebound.
pub fn met(start: Vec3, end: Vec3, nearest: impl Fn(Vec3) -> LookUp) -> LookUp {
    let at_end = nearest(end);
    let way = start.distance(end);
    if way <= SHORT || at_end.distance >= way {
        return at_end;
    }
    let least = SHORT.max(LEAST_STRIDE * way);
    let (mut seen, mut left) = (nearest(start), end - start);
    for _ in 2..LOOKS {
        if seen.distance < least {
            left += seen.normal * (-seen.normal.dot(left) - seen.distance).max(0.0);
        }
        let size = left.length();
        if size < ARRIVED {
            break;
        }
        let stride = left * (seen.distance.max(least) / size).min(1.0);
        left -= stride;
        seen = nearest(seen.place + stride);
    }
    seen
}

impl LookUp {
    /// True if the point must not reach `end` \[m\].
    pub fn is_before(&self, end: Vec3) -> bool {
        self.place.distance(end) > 2.0 * ARRIVED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(place: Vec3) -> LookUp {
        LookUp { place, distance: place.length() - 0.05, normal: place.normalize_or(Vec3::Y), friction: 0.3 }
    }

    #[test]
    fn a_way_that_is_free_ends_at_its_end() {
        // A longer path that passes a solid within a least stride is turned aside, although it is free.
        for end in [Vec3::new(0.05, 0.06, 0.0), Vec3::new(-0.05, 0.3, 0.1), Vec3::new(-0.049, 0.06, 0.0)] {
            let seen = met(Vec3::new(-0.05, 0.06, 0.0), end, ball);
            assert!(!seen.is_before(end), "{end}: {seen:?}");
        }
    }

    #[test]
    fn a_way_through_a_ball_ends_on_its_near_side() {
        for (start, end) in [(Vec3::Y * 0.2, Vec3::NEG_Y * 0.2), (Vec3::Y * 0.051, Vec3::NEG_Y * 0.04)] {
            let seen = met(start, end + Vec3::X * 1e-3, ball);
            // It slides aside by little, as the way lies nearly along the normal.
            assert!(seen.distance.abs() < 1e-3 && seen.is_before(end), "{seen:?}");
            assert!(seen.normal.y > 0.9, "{seen:?}");
        }
    }

    #[test]
    fn a_way_that_ends_just_inside_stops_above_its_end() {
        let seen = met(Vec3::new(0.0, 0.06, 0.0), Vec3::new(0.01, 0.045, 0.0), ball);
        let above = Vec3::new(0.01, 0.045, 0.0).normalize();
        assert!(seen.normal.dot(above) > 0.999, "{seen:?}");
    }
}
