//! Clump radii along strands, and how much wider drawn strands are than hairs.

use strandline_base::math;

use crate::Look;
use crate::look::Clump;

/// Clump radius \[m\] at each parameter, 0 to 1.
pub(crate) fn tapers(parameters: &[f32], clump: &Clump) -> Vec<f32> {
    let radius = |share: &f32| {
        clump.root_radius + (clump.tip_radius - clump.root_radius) * math::powf(*share, clump.taper)
    };
    parameters.iter().map(radius).collect()
}

/// Diameter of a drawn strand over that of a hair, at full detail.
pub(crate) fn widening(look: &Look, guide_count: usize) -> f32 {
    let drawn = guide_count as f32 * look.follow_strands.max(1) as f32;
    let stands_for = if look.hair_count == 0 { drawn } else { look.hair_count as f32 };
    look.width_scale * stands_for / drawn
}
