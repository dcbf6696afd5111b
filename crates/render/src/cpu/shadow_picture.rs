//! Shadow maps as pictures, to look at.

use glam::Vec4;

use super::fast_math::exp;
use super::shadow::{NOTHING, ShadowMap};
use crate::Picture;

/// Grey of the farthest first hair, from 0 (what holds nothing) to 1 (the nearest).
const FARTHEST: f32 = 0.15;

impl ShadowMap {
    /// The share of light that each of the three layers takes away, as red, green and blue
    /// [Chen2011 fig. 8, 9]: black holds no hair. Neither tone map nor transfer curve is applied.
    pub fn opacity_picture(&self) -> Picture {
        self.picture(|texel| {
            [texel.x, texel.y, texel.z].map(|crossings| 1.0 - exp(crossings * self.log_transmission()))
        })
    }

    /// The depth of the first hair as grey, white the nearest; black holds no hair.
    pub fn depth_picture(&self) -> Picture {
        let depths = || self.texels.iter().map(|texel| texel.w).filter(|&depth| depth < NOTHING);
        let (near, far) = (depths().fold(f32::INFINITY, f32::min), depths().fold(0.0, f32::max));
        let inverse = (1.0 - FARTHEST) / (far - near).max(1e-6);
        self.picture(|texel| [if texel.w < NOTHING { 1.0 - (texel.w - near) * inverse } else { 0.0 }; 3])
    }

    /// Every texel coloured, 0 to 1, as the light sees it, turned by half a turn where that brings
    /// the world's up nearer to the picture's.
    fn picture(&self, color: impl Fn(Vec4) -> [f32; 3]) -> Picture {
        let bytes = |texel: &Vec4| color(*texel).map(|share| (255.0 * share + 0.5) as u8);
        let pixels = if self.view.rows_rise() {
            self.texels.iter().rev().flat_map(bytes).collect()
        } else {
            self.texels.iter().flat_map(bytes).collect()
        };
        Picture { width: self.size as u32, height: self.size as u32, pixels, alpha: None }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::cpu::{Shadows, Strands, opacity_depth, opacity_layers};
    use crate::{Light, LightKind, Shadow};

    const SIZE: u32 = 16;

    fn light(z: f32) -> Light {
        Light {
            kind: LightKind::Directional,
            position: Vec3::new(0.0, 0.0, z),
            target: Vec3::ZERO,
            ..Light::default()
        }
    }

    /// Two upright strands one behind the other in the light of +z, each as wide as a texel; the one
    /// behind is half as high.
    fn map(light: Light) -> ShadowMap {
        let mut strands = Strands::default();
        strands.resize(2, 1, 2);
        strands.positions =
            vec![Vec3::ZERO, Vec3::Y * 0.14, Vec3::new(0.0, 0.0, -0.03), Vec3::new(0.0, 0.07, -0.03)];
        strands.widths.fill(0.01);
        let mut shadows = Shadows::default();
        let settings = Shadow { map_size: SIZE, ..Shadow::default() };
        opacity_depth(&strands, None, &[light], Vec3::ZERO, &settings, &mut shadows);
        opacity_layers(&strands, &mut shadows);
        shadows.map(0).unwrap().clone()
    }

    fn column(picture: &Picture) -> Vec<[u8; 3]> {
        let (pixels, _) = picture.pixels.as_chunks::<3>();
        let used = |column: &usize| pixels.iter().skip(*column).step_by(SIZE as usize).any(|p| *p != [0; 3]);
        let columns: Vec<usize> = (0..SIZE as usize).filter(used).collect();
        assert_eq!(columns.len(), 1);
        pixels.iter().skip(columns[0]).step_by(SIZE as usize).copied().collect()
    }

    #[test]
    fn a_strand_is_red_and_one_behind_it_green() {
        // A hair as wide as a texel takes 0.3 of the light: 76.5 of 255; rounding and the last bits
        // of the texel's coverage may go either way.
        let full = |byte: u8| (75..=78).contains(&byte);
        let pixels = column(&map(light(1.0)).opacity_picture());
        assert_eq!((pixels[0], pixels[15]), ([0; 3], [0; 3]));
        assert!(full(pixels[4][0]) && pixels[4][1..] == [0, 0], "{:?}", pixels[4]);
        assert!(full(pixels[12][0]) && full(pixels[12][1]) && pixels[12][2] == 0, "{:?}", pixels[12]);
    }

    #[test]
    fn up_is_up_from_behind_too_and_the_nearest_is_white() {
        // From behind, the short strand is first where it is, below.
        let pixels = column(&map(light(-1.0)).depth_picture());
        assert_eq!((pixels[0], pixels[15]), ([0; 3], [0; 3]));
        assert_eq!(pixels[12], [255; 3]);
        assert_eq!(pixels[4], [(255.0 * FARTHEST + 0.5) as u8; 3]);
    }
}
