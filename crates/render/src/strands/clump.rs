//! Clump radii along strands, and how much wider drawn strands are than hairs.

use strandline_base::math;
use strandline_groom::closing;

use crate::Look;
use crate::look::Clump;

/// Most hairs that few drawn strands cover as much as: fifty heads of hair. The time of a picture grows with them.
const MOST_HAIRS: f32 = 5e6;
/// Diameter of a drawn strand over that of a hair up to which there may be more.
const WIDER: f32 = 4.0;

/// Clump radius \[m\] at each parameter, 0 to 1.
pub(crate) fn tapers(parameters: &[f32], clump: &Clump) -> Vec<f32> {
    let radius = |share: &f32| {
        let loose =
            clump.root_radius + (clump.tip_radius - clump.root_radius) * math::powf(*share, clump.taper);
        loose * (1.0 - clump.together * closing(*share))
    };
    parameters.iter().map(radius).collect()
}

/// Diameter of a drawn strand over that of a hair, at full detail.
pub(crate) fn widening(look: &Look, guide_count: usize) -> f32 {
    let [drawn, wanted] = hairs(look, guide_count);
    wanted.min(MOST_HAIRS.max(WIDER * drawn)) / drawn
}

/// Drawn strands of a look, and the hairs of a groom's width that they are to cover as much as.
fn hairs(look: &Look, guide_count: usize) -> [f32; 2] {
    let drawn = guide_count as f32 * look.follow_strands.max(1) as f32;
    let stands_for = if look.hair_count == 0 { drawn } else { look.hair_count as f32 };
    [drawn, look.width_scale * stands_for]
}

impl Look {
    /// The hairs that the strands of some guides cover as much as, where `hair_count` and `width_scale` ask for more.
    pub fn fewer_hairs(&self, guide_count: usize) -> Option<f32> {
        let [drawn, wanted] = hairs(self, guide_count);
        let most = MOST_HAIRS.max(WIDER * drawn);
        (wanted > most).then_some(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_strands_cover_no_more_than_fifty_heads_of_hair() {
        let look = |hair_count: u32, width_scale: f32| Look { hair_count, width_scale, ..Look::brown() };
        let covered = |look: &Look, guides: usize| {
            widening(look, guides) * (guides as u32 * look.follow_strands) as f32
        };
        for (hair_count, width_scale, guides, expected) in [
            (100_000, 1.0, 2, 1e5),
            (5_000_000, 1.0, 2000, 5e6),
            (100_000_000, 1.0, 2000, 5e6),
            (100_000, 1000.0, 2000, 5e6),
            (0, 4.0, 1_000_000, 6.4e7),
            (0, 5.0, 1_000_000, 6.4e7),
        ] {
            let look = look(hair_count, width_scale);
            let found = covered(&look, guides);
            assert!((found / expected - 1.0).abs() < 1e-5, "{hair_count} x {width_scale}: {found}");
            let asked = width_scale * if hair_count == 0 { 1.6e7 } else { hair_count as f32 };
            assert_eq!(
                look.fewer_hairs(guides).is_some(),
                asked > 1.01 * expected,
                "{hair_count} x {width_scale}"
            );
        }
    }
}
