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

/// The place of a triangle nearest to a point, and the part where it lies \[Ericson2005\].
pub(crate) fn nearest_on([a, b, c]: [Vec3; 3], point: Vec3) -> (Vec3, Feature) {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Feature::Corner(0));
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3).max(f32::MIN_POSITIVE)), Feature::Edge(0));
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6).max(f32::MIN_POSITIVE)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    let (to_c, to_b) = (d4 - d3, d5 - d6);
    if va <= 0.0 && to_c >= 0.0 && to_b >= 0.0 {
        return (b + (c - b) * (to_c / (to_c + to_b).max(f32::MIN_POSITIVE)), Feature::Edge(1));
    }
    let sum = va + vb + vc;
    (a + ab * (vb / sum) + ac * (vc / sum), Feature::Face)
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
