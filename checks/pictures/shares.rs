//! Many strands: every second or fourth stands for all in the sum of scattered light.

use strandline_checks::law;
use strandline_render::{Camera, Layers, Light, Preset};

use crate::crown::Head;
use crate::linear::Linear;

/// Mean light of some pixels.
fn mean(layers: &Layers, mask: &[bool]) -> f32 {
    let pixels = Linear::of(layers).pixels;
    let inside = || (0..mask.len()).filter(|at| mask[*at]);
    assert!(inside().count() > 500, "{} pixels", inside().count());
    inside().map(|at| pixels[at].element_sum()).sum::<f32>() / inside().count() as f32
}

law! {
    fn light_is_scattered_as_much_by_some_of_many_strands_as_by_all_of_few(on) {
        let lights = Light::studio(Camera::front().target).map(|light| Light { samples: 1, ..light });
        // Of the same roots: other roots alone change the light by 4 %.
        let light = |guides, without| {
            let head = Head::without(without, guides, on.short(16, 6), 384);
            let layers = head.lit_by(on, Preset::Blonde, on.short(&lights[..], &lights[..1]));
            mean(&layers, &head.crown(&layers))
        };
        // Of 8,176 strands all are summed, of 8,192 every second; of 16,368 every second, of 16,384 every fourth.
        // In short the pair that has both is drawn.
        for &guides in on.brief(on.short(&[512, 1_024][..], &[1_024]), &[1_024]) {
            let (few, many) = (light(guides, 1), light(guides, 0));
            // Most of the light of blonde hair is scattered; half of the hair scatters far less of it. Found: 4 % on the CPU,
            // whose maps of light hair are fine: half of the strands, each for two, leave more texels empty. Below 3 % with 512 texels.
            assert!((many / few - 1.0).abs() < 0.05, "{guides}: {few} and {many}");
        }
    }
}
