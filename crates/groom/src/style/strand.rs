//! Strands while they are shaped, and where they may be.

use glam::Vec3;
use strandline_base::math;
use strandline_body::{Mannequin, Root, Scalp};

use super::comb::{WHORL, in_fringe, smooth};
use super::{Style, StyleSettings};

/// Distance \[m\] from the skin that all hair keeps once it has left the root.
pub const CLEARANCE: f32 = 0.0015;

/// Diameter of a hair \[m\].
pub const WIDTH: f32 = 8e-5;
/// Distance \[m\] from the parting within which roots of guides are drawn toward it, and those of the hair between them:
/// skin shows where few hairs come from between it and the parting.
const PARTING_REACH: [f32; 2] = [0.014, 0.048];
/// Distance \[m\] from the whorl within which roots of hair between guides are drawn toward it, and the power of their
/// share of it.
const WHORL_REACH: (f32, f32) = (0.060, 1.9);

/// Depth \[m\] on the scalp up to which roots of hair between guides are drawn toward the hairline where all hair is tied
/// behind the head, the share of their depth that is left on the hairline itself, and the distance \[m\] along which the
/// depth is measured.
const HAIRLINE_REACH: (f32, f32) = (0.140, 0.2);
const PROBE: f32 = 0.001;

/// Distance \[m\] before the hairline in which single hairs of the forehead and the temples of tied hair are rooted, and the
/// depth up to which such a hair would be rooted else.
const FEATHERED: f32 = 0.008;
const FEATHERED_DEPTH: f32 = 0.010;

/// A strand with the inputs of its shaping.
pub struct Strand {
    /// Its root.
    pub root: Root,
    /// The side of the parting that it falls to, -1 or 1; 0 for a strand of the fringe.
    pub side: f32,
    /// Its points \[m\], evenly spaced.
    pub points: Vec<Vec3>,
}

/// Moves a root near the parting toward it, so that the parting is a line rather than a lane.
pub fn beside_parting(settings: &StyleSettings, mannequin: &Mannequin, root: Root) -> Root {
    toward_parting(settings, mannequin, root, PARTING_REACH[0], f32::sqrt)
}

/// Draws the root of hair between guides toward the parting, the whorl or the hairline that it runs from: at a distance
/// from there only the hair that is rooted nearer lies over the skin.
pub fn nearer(settings: &StyleSettings, mannequin: &Mannequin, scalp: &Scalp, root: Root) -> Root {
    if settings.style.is_tied() {
        // None comes into the fringe.
        let moved = toward_hairline(mannequin, scalp, root);
        return if in_fringe(settings, &root) || in_fringe(settings, &moved) { root } else { moved };
    }
    if settings.style == Style::Pixie {
        let (reach, power) = WHORL_REACH;
        let way = root.position - WHORL;
        let share = way.length() / reach;
        return if share < 1.0 {
            moved(mannequin, root, WHORL + way * math::powf(share, power - 1.0))
        } else {
            root
        };
    }
    toward_parting(settings, mannequin, root, PARTING_REACH[1], |share| share)
}

fn toward_parting(
    settings: &StyleSettings,
    mannequin: &Mannequin,
    root: Root,
    reach: f32,
    drawn: impl Fn(f32) -> f32,
) -> Root {
    let across = root.position.x - settings.parting;
    let share = across.abs() / reach;
    if !settings.style.is_parted() || share >= 1.0 || root.position.y < 0.0 {
        return root;
    }
    moved(mannequin, root, root.position.with_x(settings.parting + across * drawn(share)))
}

fn toward_hairline(mannequin: &Mannequin, scalp: &Scalp, root: Root) -> Root {
    let (reach, least) = HAIRLINE_REACH;
    let depth = scalp.depth(root.position);
    let share = depth / reach;
    if !(0.0..1.0).contains(&share) {
        return root;
    }
    moved(mannequin, root, root.position - inward(scalp, &root) * (depth * (1.0 - least) * (1.0 - share)))
}

/// Moves the root of a tied hair on the hairline of forehead and temples before it, by a chance of 0 to 1: farther in some
/// places than in others, so that the hairline is no line.
pub fn before_hairline(mannequin: &Mannequin, scalp: &Scalp, root: Root, chance: f32) -> Root {
    let place = root.position;
    let near = smooth(FEATHERED_DEPTH, 0.0, scalp.depth(place)) * smooth(0.02, 0.04, place.z);
    if near == 0.0 {
        return root;
    }
    let waves =
        math::sin(240.0 * place.x + 90.0 * place.y + 0.7) + math::sin(530.0 * place.x - 310.0 * place.y);
    let reach = FEATHERED * (0.5 + 0.25 * waves);
    moved(mannequin, root, place - inward(scalp, &root) * (reach * near * chance * chance))
}

/// Direction on the skin in which the hairline lies farther away.
fn inward(scalp: &Scalp, root: &Root) -> Vec3 {
    let depth = scalp.depth(root.position);
    let [first, second]: [Vec3; 2] = root.normal.any_orthonormal_pair().into();
    let slope = [first, second].map(|way| scalp.depth(root.position + way * PROBE) - depth);
    (first * slope[0] + second * slope[1]).normalize_or_zero()
}

/// A root at the skin's place nearest to another \[m\].
fn moved(mannequin: &Mannequin, root: Root, place: Vec3) -> Root {
    let (position, normal) = mannequin.nearest_skin(place);
    Root { position, normal, ..root }
}
