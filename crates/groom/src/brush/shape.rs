//! Shapes of one strand under a brush. Each takes points \[m\], root first, and returns as many; the root stays.

use std::f32::consts::TAU;

use glam::Vec3;
use strandline_base::math;

/// Points of a strand in a turn, at least.
const POINTS_PER_TURN: f32 = 6.0;
/// Share of a length of hair that lies across its curl, at most: the rest leads on.
const STEEPEST: f32 = 0.95;

/// The strand after its points were drawn along a way \[m\], each by its share of the length. Its segments keep their
/// lengths: each point follows the one before it.
pub(super) fn comb(points: &[Vec3], way: Vec3) -> Vec<Vec3> {
    let shares = shares(points);
    following(points, |point| points[point] + shares[point] * way)
}

/// The strand scaled about its root until it is longer by a length \[m\].
pub(super) fn lengthen(points: &[Vec3], more: f32) -> Vec<Vec3> {
    let length = length(points);
    let scale = if length > 0.0 { (length + more) / length } else { 1.0 };
    points.iter().map(|point| points[0] + scale * (*point - points[0])).collect()
}

/// Moves a strand toward the strand in the middle by a share of the way, which grows from none at the root to all of it
/// at the tip.
pub(super) fn clump(points: &[Vec3], middle: &[Vec3], share: f32) -> Vec<Vec3> {
    let (shares, to) = (shares(points), self::shares(middle));
    following(points, |point| {
        let goal = at(middle, &to, shares[point]);
        points[point].lerp(goal, share * shares[point])
    })
}

/// The strand wound about its own line, in turns of a radius and a length of hair \[m\]. The radius grows from the root
/// over the first turn; a helix has no wider turn than its length of hair allows.
pub(super) fn curl(points: &[Vec3], radius: f32, pitch: f32) -> Vec<Vec3> {
    let length = length(points);
    let spacing = length / (points.len().max(2) - 1) as f32;
    let pitch = pitch.max(POINTS_PER_TURN * spacing);
    let slope = (TAU * radius / pitch).min(STEEPEST);
    let mut found: Vec<Vec3> = points.first().copied().into_iter().collect();
    let mut passed = 0.0;
    for ([along, across], pair) in frames(points).into_iter().zip(points.windows(2)) {
        let segment = pair[0].distance(pair[1]);
        let turns = (passed + 0.5 * segment) / pitch;
        passed += segment;
        let beside = along.cross(across);
        let (sin, cos) = math::sin_cos(TAU * turns);
        // Directions of a helix: as steep everywhere, so that each segment keeps its length.
        let slope = slope * turns.min(1.0);
        let way = (1.0 - slope * slope).sqrt() * along + slope * (cos * beside - sin * across);
        found.extend(found.last().map(|before| *before + segment * way));
    }
    found
}

/// Points that follow goals, each at the length of its segment from the one before.
fn following(points: &[Vec3], goal: impl Fn(usize) -> Vec3) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = points.first().copied().into_iter().collect();
    for point in 1..points.len() {
        let (before, segment) = (found[point - 1], points[point] - points[point - 1]);
        let way = (goal(point) - before).try_normalize();
        found.push(before + way.map_or(segment, |way| way * segment.length()));
    }
    found
}

fn length(points: &[Vec3]) -> f32 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Share of the length up to each point: 0 at the root, 1 at the tip.
fn shares(points: &[Vec3]) -> Vec<f32> {
    let length = length(points).max(1e-12);
    let mut passed = 0.0;
    let ends = points.windows(2).map(|pair| {
        passed += pair[0].distance(pair[1]);
        (passed / length).min(1.0)
    });
    std::iter::once(0.0).chain(ends).take(points.len()).collect()
}

/// The place at a share of the length of a strand.
fn at(points: &[Vec3], shares: &[f32], share: f32) -> Vec3 {
    let after = shares.partition_point(|end| *end < share).clamp(1, points.len().max(2) - 1);
    let (Some(start), Some(end)) = (points.get(after - 1), points.get(after)) else { return points[0] };
    let room = (shares[after] - shares[after - 1]).max(1e-12);
    start.lerp(*end, ((share - shares[after - 1]) / room).clamp(0.0, 1.0))
}

/// Direction of each segment and one across it, carried along the strand without twist [Bergou2008].
fn frames(points: &[Vec3]) -> Vec<[Vec3; 2]> {
    let mut along = Vec3::NEG_Y;
    let mut across = None;
    let frame = |pair: &[Vec3]| {
        along = (pair[1] - pair[0]).normalize_or(along);
        // Never x: a mirrored strand has the mirrored frame.
        let axis = if along.y.abs() < 0.8 { Vec3::Y } else { Vec3::Z };
        let before: Vec3 = across.unwrap_or(axis);
        let found = before.reject_from_normalized(along).normalize_or(axis);
        across = Some(found);
        [along, found]
    };
    points.windows(2).map(frame).collect()
}
