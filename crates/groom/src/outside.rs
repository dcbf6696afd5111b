//! Strands that rest inside a body are put outside before anything moves.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::turned_out;

use crate::{Groom, Guides, LANES};

/// Times that a point is placed again at most when the surface under it curves.
const PLACINGS: usize = 16;
/// Tangent of the angle by which a segment turns at most to come back to its place.
const GENTLE: f32 = 0.25;
/// Depth \[m\] that is tolerated: rounding of positions of some decimetres.
const TOLERATED: f32 = 1e-6;

/// Result of [`Guides::move_outside`] and [`Groom::move_outside`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outside {
    /// Points that lay inside, but for roots.
    pub point_count: usize,
    /// Strands that they belong to.
    pub strand_count: usize,
    /// Depth \[m\] of the deepest point.
    pub depth: f32,
    /// Remaining depth \[m\] of the deepest point, whose segment does not reach out.
    pub depth_left: f32,
}

impl Guides {
    /// Puts every point but the root that lies inside a body onto its surface. Segments keep their
    /// lengths, so the rest of the strand is drawn along; strands without a point inside keep their bits.
    ///
    /// `surface` gives the signed distance \[m\] at a point \[m\], head space, negative inside, and its unit
    /// gradient.
    pub fn move_outside(&mut self, surface: impl Fn(Vec3) -> (f32, Vec3) + Sync) -> Outside {
        let (points, strand_count) = (self.points_per_strand(), self.strand_count());
        let blocks = self.positions_mut().par_chunks_mut(points).enumerate();
        let moved: Vec<Outside> = blocks
            .map(|(block, positions)| {
                let live = (strand_count - block * LANES).min(LANES);
                let moved = (0..LANES).map(|lane| {
                    let mut strand: Vec<Vec3> = positions.iter().map(|point| point.get(lane)).collect();
                    let moved = move_strand(&mut strand, &surface);
                    positions.iter_mut().zip(strand).for_each(|(point, place)| point.set(lane, place));
                    (lane, moved)
                });
                moved
                    .filter(|(lane, _)| *lane < live)
                    .fold(Outside::default(), |sum, (_, one)| sum.with(&one))
            })
            .collect();
        moved.iter().fold(Outside::default(), Outside::with)
    }
}

impl Groom {
    /// As [`Guides::move_outside`], for every strand of a groom.
    pub fn move_outside(&mut self, surface: impl Fn(Vec3) -> (f32, Vec3) + Sync) -> Outside {
        let mut rest = &mut self.points[..];
        let mut strands = Vec::with_capacity(self.starts.len());
        for pair in self.starts.windows(2) {
            let (strand, others) = rest.split_at_mut((pair[1] - pair[0]) as usize);
            strands.push(strand);
            rest = others;
        }
        let moved: Vec<Outside> =
            strands.into_par_iter().map(|strand| move_strand(strand, &surface)).collect();
        moved.iter().fold(Outside::default(), Outside::with)
    }
}

impl Outside {
    fn with(self, other: &Self) -> Self {
        Self {
            point_count: self.point_count + other.point_count,
            strand_count: self.strand_count + other.strand_count,
            depth: self.depth.max(other.depth),
            depth_left: self.depth_left.max(other.depth_left),
        }
    }
}

/// Moves one strand, root first; its root stays.
fn move_strand(points: &mut [Vec3], surface: &impl Fn(Vec3) -> (f32, Vec3)) -> Outside {
    let mut outside = Outside::default();
    let Some((root, points)) = points.split_first_mut() else { return outside };
    let (mut rest, mut before) = (*root, *root);
    for point in points {
        let here = *point;
        let length = here.distance(rest);
        let depth = -surface(here).0;
        if depth > TOLERATED {
            outside.point_count += 1;
            outside.strand_count = 1;
            outside.depth = outside.depth.max(depth);
        }
        let aimed = if before == rest { here } else { before + back(here - rest, before - rest) };
        let (placed, depth) = placed_outside(before, aimed, length, surface);
        outside.depth_left = outside.depth_left.max(depth);
        *point = placed;
        (rest, before) = (here, placed);
    }
    outside
}

/// A segment that leads a strand which lies `aside` \[m\] of its place back there, by a gentle bend.
fn back(segment: Vec3, aside: Vec3) -> Vec3 {
    let length = segment.length();
    (segment - aside.clamp_length_max(GENTLE * length)).normalize_or_zero() * length
}

/// The place near `aimed` that lies at `length` \[m\] from `before` and not inside; how deep it still lies.
pub(crate) fn placed_outside(
    before: Vec3,
    aimed: Vec3,
    length: f32,
    surface: &impl Fn(Vec3) -> (f32, Vec3),
) -> (Vec3, f32) {
    let mut placed = aimed;
    let mut best = (aimed, f32::INFINITY);
    for _ in 0..PLACINGS {
        let (distance, normal) = surface(placed);
        if -distance < best.1 {
            best = (placed, -distance);
        }
        if distance >= -TOLERATED {
            return (best.0, best.1.max(0.0));
        }
        // Intersection of the plane of the surface and the sphere of the length.
        let across = placed - before;
        let rise = (normal.dot(across) - distance).min(length);
        let aside = across.reject_from_normalized(normal);
        let aside = aside.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        placed = before + normal * rise + aside * (length * length - rise * rise).max(0.0).sqrt();
    }
    let turned = turned_out(before, best.0, surface(before).1, |point| surface(point).0 >= 0.0);
    let depth = -surface(turned).0;
    if depth < best.1 { (turned, depth.max(0.0)) } else { best }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f32 = 0.1;

    fn ball(point: Vec3) -> (f32, Vec3) {
        (point.length() - RADIUS, point.normalize_or(Vec3::Y))
    }

    /// Strands that begin on the ball: one leaves it, one runs through it just under its skin, one leads
    /// straight to its middle.
    fn guides() -> Guides {
        let mut groom = Groom::empty(8e-5);
        let root = Vec3::Y * RADIUS;
        groom.push([root, root + Vec3::new(0.1, 0.1, 0.0)]);
        groom.push([root, Vec3::new(0.08, 0.05, 0.0), Vec3::new(0.1, -0.1, 0.0)]);
        groom.push([root, Vec3::Y * 0.02]);
        Guides::resample(&groom, 12).unwrap()
    }

    #[test]
    fn points_inside_come_to_the_surface_and_lengths_stay() {
        let (rest, mut moved) = (guides(), guides());
        let found = moved.move_outside(ball);
        assert_eq!(found.strand_count, 2);
        assert!(found.depth > 0.07 && found.depth_left < 1e-5, "{found:?}");
        let inside = |guides: &Guides, strand: usize| {
            (1..12).filter(|point| ball(guides.position(strand, *point)).0 < -1e-5).count()
        };
        assert_eq!(found.point_count, inside(&rest, 1) + inside(&rest, 2));
        for strand in 0..3 {
            assert_eq!(inside(&moved, strand), 0, "strand {strand}");
            assert_eq!(moved.position(strand, 0), rest.position(strand, 0), "roots stay");
            for point in 1..12 {
                let length = |guides: &Guides| {
                    guides.position(strand, point).distance(guides.position(strand, point - 1))
                };
                assert!((length(&moved) / length(&rest) - 1.0).abs() < 1e-5, "strand {strand}");
            }
        }
        for point in 0..12 {
            assert_eq!(moved.position(0, point), rest.position(0, point), "what lies outside keeps its bits");
        }
        // Lanes beyond the last strand repeat it.
        assert_eq!(moved.positions()[5].get(7), moved.position(2, 5));
        // It returns to its place, but for the length that the detour took: found 0.0127.
        let aside = moved.position(1, 11).distance(rest.position(1, 11));
        assert!(aside < 0.015, "{aside}");
    }

    #[test]
    fn what_no_segment_reaches_is_reported() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::X * 0.03]);
        let mut guides = Guides::resample(&groom, 4).unwrap();
        let found = guides.move_outside(ball);
        assert_eq!((found.point_count, found.strand_count), (3, 1));
        assert!((found.depth - 0.09).abs() < 1e-5 && (found.depth_left - 0.09).abs() < 1e-5, "{found:?}");
    }
}
