//! Nearest places of two segments, and the side from which they touch.

use glam::Vec3;

/// Weight of the middle of the overlap of two segments against their distance: places of parallel segments stay there.
const TO_THE_MIDDLE: f32 = 1e-3;
/// Share of the distance at which two wisps touch below which the vector between their axes has no direction.
const NO_DIRECTION: f32 = 0.2;
/// Looks at the way of a pair within a part of a step.
const LOOKS: usize = 5;
/// Distance over that of touching within which a pair that does not approach is looked at in a part.
pub const NEAR: f32 = 1.15;
/// Distance over that of touching beyond which no pair has a memory.
const REMEMBERED: f32 = 2.0;

/// Two segments: the ends of the one, then of the other.
pub type Ends = [Vec3; 4];

/// Shares of two segments at which they are nearest.
pub fn nearest([a, b, c, d]: &Ends) -> [f32; 2] {
    let (one, other, apart) = (*b - *a, *d - *c, *a - *c);
    let (long, wide) = (one.length_squared().max(1e-20), other.length_squared().max(1e-20));
    let (across, first, second) = (one.dot(other), one.dot(apart), other.dot(apart));
    // Middle of the overlap, seen along the first segment.
    let (from, to) = (-first / long, (across - first) / long);
    let middle = 0.5 * (from.min(to).clamp(0.0, 1.0) + from.max(to).clamp(0.0, 1.0));
    let partner = ((second + across * middle) / wide).clamp(0.0, 1.0);
    let more = 1.0 + TO_THE_MIDDLE;
    let (p, q) = (TO_THE_MIDDLE * long * middle - first, TO_THE_MIDDLE * wide * partner + second);
    let (l, w) = (more * long, more * wide);
    let determinant = l * w - across * across;
    let s = ((p * w + across * q) / determinant).clamp(0.0, 1.0);
    let t = ((q + across * s) / w).clamp(0.0, 1.0);
    let s = ((p + across * t) / l).clamp(0.0, 1.0);
    [s, t]
}

/// Vector from the second segment to the first at shares of both.
pub fn between(ends: &Ends, [s, t]: [f32; 2]) -> Vec3 {
    ends[0] + (ends[1] - ends[0]) * s - (ends[2] + (ends[3] - ends[2]) * t)
}

/// Distance \[m\] of two segments at the least, where that of their places, which are drawn to the middle of their overlap,
/// is `distance`.
pub fn least_distance([a, b, c, d]: &Ends, distance: f32) -> f32 {
    let drawn = TO_THE_MIDDLE * ((*b - *a).length_squared() + (*d - *c).length_squared());
    (distance * distance - drawn).max(0.0).sqrt()
}

/// Plane of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Shares of both segments.
    pub shares: [f32; 2],
    /// Unit vector from the second segment to the first, on the side where they belong.
    pub normal: Vec3,
    /// Distance \[m\] along the normal where the part begins.
    pub gap: f32,
}

/// Place where two segments touch, or may come to touch within a part of a step, at a distance `touch` \[m\] of their
/// axes; none where they stay apart. `start` are their ends at the beginning of the part and `shares` where these are
/// nearest, `ways` the motion that is expected; `side` is the normal of the last round.
pub fn look(
    start: &Ends,
    ways: &Ends,
    touch: f32,
    shares: [f32; 2],
    side: impl FnOnce() -> Option<Vec3>,
) -> Option<Approach> {
    let vector = between(start, shares);
    let distance = vector.length();
    if !distance.is_finite() {
        return None;
    }
    if distance < REMEMBERED * touch
        && let Some(side) = side()
    {
        // Forces of pairs that have crossed feed a tangle: they are let go.
        if vector.dot(side) < 0.0 {
            return None;
        }
        if distance < touch {
            let normal = oriented(start, vector, distance, touch, side);
            return Some(Approach { shares, normal, gap: normal.dot(vector) });
        }
    }
    ahead(start, ways, touch, shares, distance)
}

/// The place of two segments that begin apart.
fn ahead(start: &Ends, ways: &Ends, touch: f32, shares: [f32; 2], distance: f32) -> Option<Approach> {
    let fastest = [(0, 2), (0, 3), (1, 2), (1, 3)]
        .into_iter()
        .fold(0.0_f32, |most, (one, other)| most.max((ways[one] - ways[other]).length_squared()))
        .sqrt();
    if distance > NEAR * touch + 1.25 * fastest {
        return None;
    }
    let (mut shares, mut vector, mut distance, mut time) = (shares, between(start, shares), distance, 0.0);
    for _ in 0..LOOKS {
        let passes = (distance - touch) / fastest.max(1e-12);
        if passes <= 0.05 * touch / fastest.max(1e-12) || time >= 1.0 {
            break;
        }
        time = (time + passes).min(1.0);
        let then: Ends = std::array::from_fn(|end| start[end] + ways[end] * time);
        shares = nearest(&then);
        vector = between(&then, shares);
        distance = vector.length();
    }
    if distance > NEAR * touch {
        return None;
    }
    let normal = if distance > 1e-9 { vector / distance } else { crosswise(start).unwrap_or(Vec3::X) };
    Some(Approach { shares, normal, gap: normal.dot(between(start, shares)) })
}

/// The normal of a pair that touches, on its side.
fn oriented(ends: &Ends, vector: Vec3, distance: f32, touch: f32, side: Vec3) -> Vec3 {
    let turned = |normal: Vec3| if normal.dot(side) < 0.0 { -normal } else { normal };
    if distance > NO_DIRECTION * touch {
        return turned(vector / distance);
    }
    crosswise(ends).map_or(side, turned)
}

/// Unit vector across both segments; none where they are nearly parallel.
fn crosswise([a, b, c, d]: &Ends) -> Option<Vec3> {
    let (one, other) = (*b - *a, *d - *c);
    let across = one.cross(other);
    let sine = across.length() / (one.length() * other.length()).max(1e-20);
    (sine > 0.1).then(|| across.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(start: &Ends, ways: &Ends, touch: f32, side: impl FnOnce() -> Option<Vec3>) -> Option<Approach> {
        super::look(start, ways, touch, nearest(start), side)
    }

    fn ends(height: f32) -> Ends {
        [Vec3::new(-1.0, height, 0.0), Vec3::new(1.0, height, 0.0), Vec3::NEG_Z, Vec3::Z]
    }

    #[test]
    fn a_pair_that_crosses_within_a_part_is_caught() {
        let falls = [Vec3::NEG_Y, Vec3::NEG_Y, Vec3::ZERO, Vec3::ZERO];
        let place = look(&ends(0.5), &falls, 0.1, || None).unwrap();
        assert!((place.normal - Vec3::Y).length() < 1e-6 && (place.gap - 0.5).abs() < 1e-6, "{place:?}");
        assert!(look(&ends(0.5), &falls.map(|way| -way), 0.1, || None).is_none(), "it rises");
        assert!(look(&ends(2.0), &falls, 0.1, || None).is_none(), "it falls short");
    }

    #[test]
    fn a_pair_remembers_its_side_and_is_let_go_beyond() {
        let still = [Vec3::ZERO; 4];
        let place = look(&ends(0.05), &still, 0.1, || Some(Vec3::Y)).unwrap();
        assert!(place.normal.y > 0.99 && (place.gap - 0.05).abs() < 1e-6, "{place:?}");
        assert!(look(&ends(-0.05), &still, 0.1, || Some(Vec3::Y)).is_none());
        let place = look(&ends(-0.05), &still, 0.1, || None).unwrap();
        assert!(place.normal.y < -0.99);
    }

    #[test]
    fn parallel_segments_touch_in_the_middle_of_their_overlap() {
        let pair = [Vec3::ZERO, Vec3::X, Vec3::new(0.6, 0.1, 0.0), Vec3::new(1.6, 0.1, 0.0)];
        let [s, t] = nearest(&pair);
        assert!((s - 0.8).abs() < 1e-3 && (t - 0.2).abs() < 1e-3, "{s} {t}");
    }
}
