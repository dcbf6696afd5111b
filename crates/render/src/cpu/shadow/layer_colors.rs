//! Hair coloured by the layer of a light's opacity map in which it lies, to look at [Chen2011 fig. 8].

use glam::Vec3;
use strandline_base::par::prelude::*;

use crate::shadow::{NOTHING, ShadowMap};
use crate::strands::Strands;

/// Radiance of hair in each layer, and of hair behind the last one or beside the map, linear RGB.
pub const LAYER_COLORS: [Vec3; 4] = [
    Vec3::new(0.9, 0.05, 0.05),
    Vec3::new(0.05, 0.6, 0.05),
    Vec3::new(0.05, 0.1, 0.9),
    Vec3::new(0.2, 0.2, 0.2),
];

/// Replaces the radiances of all strands by the colour of their layer in a light's map.
pub fn layer_colors(strands: &mut Strands, map: &ShadowMap) {
    strands.radiances.resize(strands.positions.len(), Vec3::ZERO);
    strands
        .radiances
        .par_iter_mut()
        .zip_eq(strands.positions.par_iter())
        .for_each(|(radiance, position)| *radiance = LAYER_COLORS[map.layer(*position)]);
}

impl ShadowMap {
    /// The layer in which a point \[m\] lies, world space: 0 to 2; 3 behind the last one, beside the map and
    /// where the map holds nothing. The texel before the point is asked, as when the layers are summed.
    fn layer(&self, point: Vec3) -> usize {
        let behind = self.view.project(point).and_then(|projected| {
            let texel = self.hair_window.texel(projected.truncate());
            if !(texel.min_element() >= 0.0 && texel.max_element() < self.size as f32) {
                return None;
            }
            let first = self.texels.get(texel.y as usize * self.size + texel.x as usize)?.w;
            (first < NOTHING).then_some(projected.z - first)
        });
        behind.map_or(3, |behind| self.borders.iter().filter(|border| behind > **border).count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::{opacity_depth, opacity_layers};
    use crate::shadow::Shadows;
    use crate::{Light, LightKind, Shadow};

    /// Radiances in the middle of upright strands at depths \[m\] behind one another in the light of +z.
    fn colors(depths: &[f32]) -> Vec<Vec3> {
        let mut strands = Strands::default();
        strands.resize(depths.len(), 1, 3);
        let strand = |depth: &f32| [0.0, 0.06, 0.14].map(|height| Vec3::new(0.0, height, -depth));
        strands.positions = depths.iter().flat_map(strand).collect();
        strands.widths.fill(0.01);
        let light = Light { kind: LightKind::Directional, position: Vec3::Z, ..Light::default() };
        let mut shadows = Shadows::default();
        let settings = Shadow { map_size: 16, ..Shadow::default() };
        opacity_depth(&strands, None, &[light], Vec3::ZERO, &settings, &mut shadows);
        opacity_layers(&strands, &mut shadows);
        layer_colors(&mut strands, shadows.map(0).unwrap());
        strands.radiances.chunks(3).map(|strand| strand[1]).collect()
    }

    #[test]
    fn strands_behind_one_another_take_the_colours_of_the_layers() {
        let [red, green, blue, grey] = LAYER_COLORS;
        // The layers end 15, 50 and 150 mm behind the first hair.
        assert_eq!(colors(&[0.0, 0.014, 0.016, 0.049]), [red, red, green, green]);
        assert_eq!(colors(&[0.0, 0.051, 0.149, 0.151]), [red, blue, blue, grey]);
        // They follow the first hair, wherever it is.
        assert_eq!(colors(&[0.2, 0.23, 0.3, 0.4]), [red, green, blue, grey]);
    }
}
