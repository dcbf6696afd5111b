use glam::Vec3;
use strandline_base::math;

/// Halvings of a turn: to a few degrees.
const HALVINGS: usize = 6;

/// Turns a segment from `before` to `end` \[m\] toward the unit normal at `before`, by as little as makes its
/// end `is_out`; `end` itself when the normal is not out either.
///
/// For ends in a crease, which the planes of its two sides push to and fro.
pub fn turned_out(before: Vec3, end: Vec3, normal: Vec3, is_out: impl Fn(Vec3) -> bool) -> Vec3 {
    let across = end - before;
    let length = across.length();
    let aside = across.reject_from_normalized(normal);
    let aside = aside.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    let turned = |angle: f32| before + (normal * math::cos(angle) + aside * math::sin(angle)) * length;
    // From the normal: the largest angle that is out, the least that is inside.
    let (mut out, mut inside) = (0.0, normal.angle_between(across));
    if !is_out(turned(out)) {
        return end;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + out);
        *if is_out(turned(middle)) { &mut out } else { &mut inside } = middle;
    }
    turned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_turns_no_farther_than_it_must() {
        let is_out = |point: Vec3| point.y > 0.5;
        let end = turned_out(Vec3::ZERO, Vec3::new(1.0, -0.2, 0.0).normalize(), Vec3::Y, is_out);
        // Out from 30 degrees on; 101 degrees halved six times are 1.6.
        let elevation = end.y.asin().to_degrees();
        assert!((30.0..32.0).contains(&elevation) && (end.length() - 1.0).abs() < 1e-6, "{end}");
        assert_eq!(turned_out(Vec3::ZERO, Vec3::X, Vec3::Y, |_| false), Vec3::X, "no turn helps");
        let straight = turned_out(Vec3::ZERO, Vec3::NEG_Y, Vec3::Y, is_out);
        assert!(straight.y > 0.5 && (straight.length() - 1.0).abs() < 1e-6, "{straight}");
    }
}
