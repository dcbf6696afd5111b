//! The skull of a head, as it is found from above.

use glam::{Vec2, Vec3};

use super::sample::surface;
use crate::body::Mesh;

/// Depth below the crown over the width of the skull at which it is widest, above brows and ears.
const WIDEST: f32 = 0.6;
/// Widths at which the search begins over the height of the body: that of a bust, and where its head is narrower, that of
/// a whole person.
const STARTS: [f32; 2] = [0.12, 0.06];
/// Rounds in which the width is found, and what it changes by in the last one, as a share of it.
const ROUNDS: usize = 64;
const CONVERGED: f32 = 1e-3;
/// Slices from front to back in which the width is measured, and the rank of the one that ears do not reach with the
/// share of the whole width that it has.
const SLICES: usize = 12;
const BESIDE_EARS: usize = 3;
const OF_WIDTH: f32 = 0.95;
/// Width over that without ears above which there are ears.
const EARS: f32 = 1.25;
/// Half of the width of the strip in the middle in which the crown is, over that of the skull, and the height of ears
/// above it that count.
const STRIP: f32 = 0.12;
const ABOVE: f32 = 0.03;
/// Places of a body's surface that are looked at.
const PLACES: usize = 6000;

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
    /// Measures of the built-in head, which takes a fifth of a second to make.
    pub const BUILT_IN: Self = Self {
        top: 0.10466226,
        size: Vec2::new(0.15351063, 0.19609678),
        middle: Vec2::new(0.0, 0.0009142235),
    };

    /// The middle of the head \[m\].
    pub fn center(&self) -> Vec3 {
        Vec3::new(self.middle.x, self.top - WIDEST * 0.5 * self.size.element_sum(), self.middle.y)
    }

    /// Measures of the highest part of a body, given its vertices, or of a head, given the roots of its hair \[m\]. It stands
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
        let (middle, size) = grown(top - low, |width| {
            let (low, high) = above(width);
            (high.x - low.x, (0.5 * (low + high), high - low))
        })?;
        (size.min_element() > 0.0).then_some(Self { top, size, middle })
    }

    /// Measures of the highest part of a body, without ears that stand out or up.
    pub fn of_body(mesh: &Mesh) -> Option<Self> {
        let plain = Self::of(&mesh.positions)?;
        let Some(bare) = Self::without_ears(&surface(mesh, PLACES)) else { return Some(plain) };
        let has_ears = plain.size.x > EARS * bare.size.x || plain.top > bare.top + STRIP * bare.size.x;
        Some(if has_ears { bare } else { plain })
    }

    /// Measures of the highest part of a body without ears, given places all over its surface \[m\].
    pub fn without_ears(places: &[Vec3]) -> Option<Self> {
        let heights = places.iter().map(|place| place.y);
        let (low, mut top) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, top), height| {
            (low.min(height), top.max(height))
        });
        let mut found = Self::below(places, top, low)?;
        for _ in 0..SLICES {
            let strip = places
                .iter()
                .filter(|place| place.y <= top && (place.x - found.middle.x).abs() < STRIP * found.size.x);
            let crown = strip.map(|place| place.y).fold(f32::NEG_INFINITY, f32::max);
            if crown >= top - ABOVE * found.size.x || crown <= low {
                break;
            }
            top = crown;
            found = Self::below(places, top, low)?;
        }
        (found.size.min_element() > 0.0).then_some(found)
    }

    /// That whose crown is at a height, its width without ears.
    fn below(places: &[Vec3], top: f32, low: f32) -> Option<Self> {
        let (middle, size) = grown(top - low, |width| {
            let upper = places.iter().filter(|place| (top - WIDEST * width..=top).contains(&place.y));
            let upper: Vec<Vec2> = upper.map(|place| Vec2::new(place.x, place.z)).collect();
            let start = (Vec2::INFINITY, Vec2::NEG_INFINITY);
            let (min, max) = upper.iter().fold(start, |(low, high), at| (low.min(*at), high.max(*at)));
            let found = bare_width(&upper, min, max);
            (found, (0.5 * (min + max), Vec2::new(found.max(width), max.y - min.y)))
        })?;
        size.is_finite().then_some(Self { top, size, middle })
    }
}

/// The middle and the size of a skull, found from above, so that no shoulder is taken for it: `above` gives the width, and
/// both, of the part of a body that a head of a width would have. The body has a height.
fn grown(height: f32, above: impl Fn(f32) -> (f32, (Vec2, Vec2))) -> Option<(Vec2, Vec2)> {
    for start in STARTS {
        let mut width = start * height;
        for round in 0..ROUNDS {
            let (found, skull) = above(width);
            if round == 0 && found < width && start != STARTS[1] {
                break;
            }
            if found.max(width) - width < CONVERGED * width {
                return Some(skull);
            }
            width = found;
        }
    }
    None
}

/// The width of places seen from above, without what stands out to both sides in few slices.
fn bare_width(places: &[Vec2], min: Vec2, max: Vec2) -> f32 {
    let whole = max.x - min.x;
    let mut slices = [(f32::INFINITY, f32::NEG_INFINITY); SLICES];
    for place in places {
        let slice = (place.y - min.y) / (max.y - min.y).max(f32::MIN_POSITIVE) * SLICES as f32;
        let (low, high) = &mut slices[(slice as usize).min(SLICES - 1)];
        (*low, *high) = (low.min(place.x), high.max(place.x));
    }
    let mut widths = slices.map(|(low, high)| (high - low).max(0.0));
    widths.sort_by(f32::total_cmp);
    let bare = widths[SLICES - 1 - BESIDE_EARS] / OF_WIDTH;
    if whole > EARS * bare && bare > 0.0 { bare } else { whole }
}
