//! The skull of a head, as it is found from above.

use glam::{Vec2, Vec3};

/// Depth below the crown over the width of the skull at which it is widest, above brows and ears.
const WIDEST: f32 = 0.6;
/// Width at which the search begins over the height of the body.
const START: f32 = 0.12;
/// Rounds in which the width is found, and what it changes by in the last one, as a share of it.
const ROUNDS: usize = 64;
const CONVERGED: f32 = 1e-3;

/// The upper part of a head, where hair grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Skull {
    /// Height of the crown \[m\].
    pub top: f32,
    /// From ear to ear and from front to back \[m\].
    pub size: Vec2,
    /// The middle, seen from above \[m\].
    pub middle: Vec2,
}

impl Skull {
    /// That of the highest part of a body, given its vertices, or of a head, given the roots of its hair \[m\]. It stands
    /// upright and looks along z.
    pub fn of(places: &[Vec3]) -> Option<Self> {
        let heights = places.iter().map(|place| place.y);
        let (low, top) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, top), height| {
            (low.min(height), top.max(height))
        });
        let above = |width: f32| {
            let start = (Vec2::INFINITY, Vec2::NEG_INFINITY);
            let upper = places.iter().filter(|place| place.y >= top - WIDEST * width);
            upper
                .map(|place| Vec2::new(place.x, place.z))
                .fold(start, |(low, high), place| (low.min(place), high.max(place)))
        };
        // From above, so that no shoulder is taken for it.
        let mut width = START * (top - low);
        for _ in 0..ROUNDS {
            let (low, high) = above(width);
            let found = (high.x - low.x).max(width);
            if found - width < CONVERGED * width {
                let size = high - low;
                return (size.min_element() > 0.0).then_some(Self { top, size, middle: 0.5 * (low + high) });
            }
            width = found;
        }
        None
    }
}
