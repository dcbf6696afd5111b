use glam::Vec2;

/// Angle from the front \[degrees\] and height \[mm\] of places along the hairline of one side:
/// forehead, recess of the temple, sideburn, over the ear, behind it, nape.
const PLACES: [Vec2; 20] = [
    Vec2::new(0.0, 53.0),
    Vec2::new(12.0, 53.5),
    Vec2::new(24.0, 56.5),
    Vec2::new(34.0, 58.0),
    Vec2::new(43.0, 52.0),
    Vec2::new(52.0, 36.0),
    Vec2::new(60.0, 16.0),
    Vec2::new(66.0, -4.0),
    Vec2::new(71.0, -22.0),
    Vec2::new(75.0, -31.0),
    Vec2::new(79.0, -31.0),
    Vec2::new(83.0, -14.0),
    Vec2::new(88.0, 2.0),
    Vec2::new(95.0, 5.0),
    Vec2::new(102.0, 2.0),
    Vec2::new(109.0, -18.0),
    Vec2::new(117.0, -46.0),
    Vec2::new(127.0, -68.0),
    Vec2::new(145.0, -78.0),
    Vec2::new(180.0, -81.0),
];

/// Height \[m\] of the hairline at an angle from the front \[rad\], 0..pi: a cubic through the places,
/// level where they turn, so that it never overshoots \[Fritsch1980\].
pub(super) fn height(angle: f32) -> f32 {
    let angle = angle.to_degrees().clamp(0.0, 180.0);
    let next = PLACES.partition_point(|place| place.x <= angle).clamp(1, PLACES.len() - 1);
    let (start, end) = (PLACES[next - 1], PLACES[next]);
    let width = end.x - start.x;
    let share = (angle - start.x) / width;
    let (square, cube) = (share * share, share * share * share);
    let millimetres = start.y * (2.0 * cube - 3.0 * square + 1.0)
        + end.y * (3.0 * square - 2.0 * cube)
        + slope(next - 1) * width * (cube - 2.0 * square + share)
        + slope(next) * width * (cube - square);
    millimetres * 1e-3
}

/// Slope at a place \[mm/degree\]: the harmonic mean of the slopes on both sides, 0 where they differ in sign.
fn slope(place: usize) -> f32 {
    if place == 0 || place + 1 == PLACES.len() {
        return 0.0;
    }
    let rise = |from: Vec2, to: Vec2| (to.y - from.y) / (to.x - from.x);
    let (before, after) = (rise(PLACES[place - 1], PLACES[place]), rise(PLACES[place], PLACES[place + 1]));
    if before * after <= 0.0 { 0.0 } else { 2.0 * before * after / (before + after) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hairline_passes_its_places_without_a_jump() {
        for place in PLACES {
            assert!((height(place.x.to_radians()) - place.y * 1e-3).abs() < 1e-6);
        }
        // The steepest stretch falls 4.5 mm per degree.
        for step in 0..1800 {
            let (here, there) = ((step as f32 * 0.1).to_radians(), ((step + 1) as f32 * 0.1).to_radians());
            assert!((height(here) - height(there)).abs() < 0.7e-3);
        }
    }
}
