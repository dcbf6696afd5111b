//! The place of a triangle nearest to a point, in single precision.

use glam::Vec3;

/// Part of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Feature {
    Face,
    /// The edge from this corner to the next.
    Edge(usize),
    Corner(usize),
}

/// The place of a triangle nearest to a point, and the part where it lies.
#[inline]
pub(crate) fn nearest_on([a, b, c]: [Vec3; 3], point: Vec3) -> (Vec3, Feature) {
    let (feature, [to_b, to_c]) = nearest_shares([a, b, c], point);
    let place = match feature {
        Feature::Corner(corner) => [a, b, c][corner],
        Feature::Edge(0) => a + (b - a) * to_b,
        Feature::Edge(1) => b + (c - b) * to_c,
        Feature::Edge(_) => a + (c - a) * to_c,
        Feature::Face => a + (b - a) * to_b + (c - a) * to_c,
    };
    (place, feature)
}

/// The part of a triangle where its place nearest to a point lies, and the shares of the second and the third corner there
/// \[Ericson2005\]; they are no numbers in a face without an area.
#[inline]
pub(crate) fn nearest_shares([a, b, c]: [Vec3; 3], point: Vec3) -> (Feature, [f32; 2]) {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (Feature::Corner(0), [0.0, 0.0]);
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (Feature::Corner(1), [1.0, 0.0]);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (Feature::Edge(0), [d1 / (d1 - d3).max(f32::MIN_POSITIVE), 0.0]);
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (Feature::Corner(2), [0.0, 1.0]);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (Feature::Edge(2), [0.0, d2 / (d2 - d6).max(f32::MIN_POSITIVE)]);
    }
    let va = d3 * d6 - d5 * d4;
    let (to_c, to_b) = (d4 - d3, d5 - d6);
    if va <= 0.0 && to_c >= 0.0 && to_b >= 0.0 {
        let share = to_c / (to_c + to_b).max(f32::MIN_POSITIVE);
        return (Feature::Edge(1), [1.0 - share, share]);
    }
    let sum = va + vb + vc;
    (Feature::Face, [vb / sum, vc / sum])
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;

    #[test]
    fn no_place_of_a_triangle_is_nearer() {
        let corners = [vec3(0.01, 0.0, 0.002), vec3(0.0, 0.012, 0.0), vec3(-0.004, 0.0, 0.009)];
        let [a, b, c] = corners;
        for index in 0..500 {
            let share = index as f32;
            let point = 0.02 * vec3((1.3 * share).sin(), (2.1 * share).cos(), (0.7 * share).sin());
            let (place, feature) = nearest_on(corners, point);
            let shares = (0..=40).flat_map(|u| (0..=40 - u).map(move |v| (u as f32 / 40.0, v as f32 / 40.0)));
            let brute = shares.map(|(u, v)| point.distance(a + (b - a) * u + (c - a) * v));
            let least = brute.fold(f32::INFINITY, f32::min);
            assert!(point.distance(place) < least + 1e-6, "{point}: {feature:?}");
            assert!(point.distance(place) > least - 4e-4, "{point}: {feature:?}");
            if let Feature::Corner(corner) = feature {
                assert_eq!(place, corners[corner]);
            }
        }
    }
}
