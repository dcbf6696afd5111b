//! A grown style on a body from a file: the built-in head's scalp is fitted to the head of the body.

use glam::{Vec2, Vec3};

use super::{marked, skull::Skull};
use crate::{
    Error,
    body::{Mesh, Shape},
    groom::Groom,
};

/// Rounds that move a root to the surface, and the largest distance \[m\] that its strand moves along.
const STEPS: usize = 4;
const REACH: f32 = 0.1;

/// Fits the strands of a grown style to a body, or to the scalp that it marks, and leads their roots to its surface;
/// what is to be said of it.
///
/// # Errors
/// The scalp is no such.
pub(super) fn onto(
    groom: &mut Groom,
    mesh: &Mesh,
    marked: Option<&Mesh>,
    shape: Option<&Shape>,
) -> Result<Option<String>, Error> {
    let (from, Some(to)) = (Skull::BUILT_IN, Skull::of_body(mesh)) else { return Ok(None) };
    let ratio = to.size / from.size;
    let scale = Vec3::new(ratio.x, ratio.x, ratio.y);
    let place = |point: Vec3| {
        let beside = point - Vec3::new(from.middle.x, from.top, from.middle.y);
        beside * scale + Vec3::new(to.middle.x, to.top, to.middle.y)
    };
    groom.points.iter_mut().for_each(|point| *point = place(*point));
    let on_scalp = marked.map(|marked| marked::onto(groom, marked, &to, place)).transpose()?;
    if let Some(shape) = shape {
        lead(groom, shape);
    }
    Ok(on_scalp.or_else(|| Some(note(ratio))))
}

/// The note on a head of other width and depth than the built-in one, with what to do about one of no person's size.
fn note(ratio: Vec2) -> String {
    let is_of_a_person = A_HEAD.contains(&ratio.x) && A_HEAD.contains(&ratio.y);
    let mend = if is_of_a_person {
        ""
    } else {
        "; `body.scale` makes a body that is not in metres as large as a person"
    };
    format!(
        "the style grows on the highest part of the body: {:.0} % as wide and {:.0} % as deep as the built-in head{mend}",
        100.0 * ratio.x,
        100.0 * ratio.y
    )
}

/// Widths and depths of heads, of people and of figures, over those of the built-in head.
const A_HEAD: std::ops::RangeInclusive<f32> = 1.0 / 3.0..=3.0;

/// Leads the roots of strands to a surface, and each strand with its root.
pub(super) fn lead(groom: &mut Groom, shape: &Shape) {
    for strand in 0..groom.strand_count() {
        let range = groom.range(strand);
        let root = groom.points[range.start];
        let (skin, normal) = settled(shape, root);
        let way = (skin - root).clamp_length_max(REACH);
        groom.points[range].iter_mut().for_each(|point| *point += way);
        if let Some(normals) = &mut groom.root_normals {
            normals[strand] = normal;
        }
    }
}

/// The place of a surface near a point \[m\], and its unit normal there.
fn settled(shape: &Shape, point: Vec3) -> (Vec3, Vec3) {
    let mut place = point;
    let mut normal = Vec3::Y;
    for _ in 0..STEPS {
        let (distance, gradient) = shape.distance_and_gradient(place);
        (place, normal) = (place - gradient * distance, gradient);
    }
    (place, normal)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::groom::{Style, StyleSettings};

    /// A ball of a head on a neck and shoulders: its radii \[m\], from ear to ear and from front to back, and its
    /// middle \[m\].
    fn bust(radii: Vec2, middle: Vec3) -> Mesh {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        let rings = 60;
        for ring in 0..=rings {
            for step in 0..48_u32 {
                let (share, around) =
                    (ring as f32 / rings as f32, step as f32 / 48.0 * std::f32::consts::TAU);
                // Down the ball, then out over the shoulders.
                let (flat, height) = if share < 0.75 {
                    let polar = share / 0.75 * 2.7;
                    (radii * polar.sin(), radii.x * polar.cos())
                } else {
                    let out = (share - 0.75) / 0.25;
                    (radii * (0.43 + 2.0 * out), radii.x * (-0.9 - out))
                };
                let beside = Vec3::new(flat.x * around.cos(), height, flat.y * around.sin());
                positions.push(middle + beside);
                if ring < rings {
                    let corner = |ring: u32, step: u32| 48 * ring + step % 48;
                    triangles.push([corner(ring, step), corner(ring, step + 1), corner(ring + 1, step)]);
                    triangles.push([
                        corner(ring + 1, step),
                        corner(ring, step + 1),
                        corner(ring + 1, step + 1),
                    ]);
                }
            }
        }
        Mesh::new(positions, triangles).unwrap()
    }

    #[test]
    fn a_skull_is_found_above_shoulders() {
        let skull = Skull::of(&bust(Vec2::new(0.1, 0.13), Vec3::new(0.3, 2.0, -0.4)).positions).unwrap();
        assert!((skull.top - 2.1).abs() < 1e-4, "{skull:?}");
        // Rings of vertices 5 mm apart.
        assert!((skull.size - Vec2::new(0.2, 0.26)).abs().max_element() < 0.006, "{skull:?}");
        assert!((skull.middle - Vec2::new(0.3, -0.4)).abs().max_element() < 1e-3, "{skull:?}");
    }

    #[test]
    fn roots_of_a_style_lie_on_a_foreign_head() {
        let (radius, middle) = (0.14, Vec3::new(0.2, 1.7, 0.1));
        let mut groom = StyleSettings { strand_count: 300, ..StyleSettings::new(Style::Bob) }.grow().unwrap();
        let lengths = groom.lengths();
        let ball = Shape::sphere(middle, radius).unwrap();
        let note = onto(&mut groom, &bust(Vec2::splat(radius), middle), None, Some(&ball)).unwrap().unwrap();
        for root in groom.roots() {
            assert!((root.distance(middle) - radius).abs() < 1e-5, "{root}");
            // Hair of a bob ends in the nape.
            assert!(root.y > middle.y - 0.98 * radius, "{root}");
        }
        let highest = groom.roots().map(|root| root.y).fold(f32::NEG_INFINITY, f32::max);
        assert!(highest > middle.y + 0.95 * radius, "{highest}");
        assert!(groom.lengths()[0] > 1.2 * lengths[0] && note.contains("% as wide"), "{note}");
    }

    #[test]
    fn a_head_of_no_persons_size_is_told_the_setting_that_scales_it() {
        assert!(!note(Vec2::new(1.5, 0.8)).contains("body.scale"));
        assert!(note(Vec2::new(84.0, 41.0)).contains("body.scale"));
        assert!(note(Vec2::new(1.0, 0.01)).contains("body.scale"));
    }
}
