//! Vertices at the same position, which count as one.

use std::collections::HashMap;

use glam::Vec3;

/// For each vertex the first one at its exact position. The map is only looked up, never walked, so its
/// order does not matter.
pub(crate) fn welded_vertices(positions: &[Vec3]) -> Vec<u32> {
    let mut first_at = HashMap::with_capacity(positions.len());
    let welded = positions.iter().enumerate().map(|(index, position)| {
        // Adding zero makes -0 equal to 0 in bits too.
        let bits = (*position + 0.0).to_array().map(f32::to_bits);
        *first_at.entry(bits).or_insert(index as u32)
    });
    welded.collect()
}
