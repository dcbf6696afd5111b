//! Shadow maps as pictures, to look at.

use glam::{Vec2, Vec4};

use super::{NOTHING, ShadowMap};
use crate::Picture;
use crate::fast_math::exp;

/// Grey of the farthest first hair, from 0 (what holds nothing) to 1 (the nearest).
const FARTHEST: f32 = 0.15;

impl ShadowMap {
    /// The share of light that the first layer takes away as red, the first two as green and all three
    /// as blue [Chen2011 fig. 9]: hair in the first layer is white, in the second cyan, in the third blue; black is free
    /// of hair. Neither tone map nor transfer curve is applied.
    pub fn opacity_picture(&self) -> Picture {
        self.picture(|texel| {
            [texel.x, texel.x + texel.y, texel.x + texel.y + texel.z]
                .map(|crossings| 1.0 - exp(crossings * self.log_transmission()))
        })
    }

    /// The depth of the first hair as grey, white the nearest; black holds no hair.
    pub fn depth_picture(&self) -> Picture {
        let depths = || self.texels.iter().map(|texel| texel.w).filter(|&depth| depth < NOTHING);
        let (near, far) = (depths().fold(f32::INFINITY, f32::min), depths().fold(0.0, f32::max));
        let inverse = (1.0 - FARTHEST) / (far - near).max(1e-6);
        self.picture(|texel| [if texel.w < NOTHING { 1.0 - (texel.w - near) * inverse } else { 0.0 }; 3])
    }

    /// The texels coloured, 0 to 1, as the light sees them, turned so that down is down in the world, and all
    /// of them inside the picture.
    fn picture(&self, color: impl Fn(Vec4) -> [f32; 3]) -> Picture {
        let down = self.view.down();
        let right = Vec2::new(down.y, -down.x);
        let (half, scale) = (0.5 * self.size as f32, down.x.abs() + down.y.abs());
        let texel = |column: usize, row: usize| {
            let (x, y) = (column as f32 + 0.5 - half, row as f32 + 0.5 - half);
            let at = Vec2::splat(half) + (right * x + down * y) * scale;
            let inside = at.min_element() >= 0.0 && at.max_element() < self.size as f32;
            inside.then(|| self.texels[at.y as usize * self.size + at.x as usize])
        };
        let bytes = |texel: Vec4| color(texel).map(|share| (255.0 * share + 0.5) as u8);
        let places = (0..self.size).flat_map(|row| (0..self.size).map(move |column| (column, row)));
        let pixels = places.flat_map(|(column, row)| texel(column, row).map_or([0; 3], bytes)).collect();
        Picture { width: self.size as u32, height: self.size as u32, pixels, alpha: None }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::cpu::{opacity_depth, opacity_layers};
    use crate::shadow::Shadows;
    use crate::strands::Strands;
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

    /// A place in the middle of a column of texels of 1/80 m, at a height \[texel\] and a depth \[m\].
    fn place(height: f32, depth: f32) -> Vec3 {
        Vec3::new(0.5 / 80.0, height / 80.0, -depth)
    }

    /// Two upright strands one behind the other in the light of +z, each as wide as a texel; the one behind is
    /// half as high. They are a little shorter than whole texels, so that each texel has one piece.
    fn map(light: Light) -> ShadowMap {
        map_of(&[place(0.0, 0.0), place(10.95, 0.0), place(0.0, 0.03), place(4.95, 0.03)], light)
    }

    fn map_of(points: &[Vec3], light: Light) -> ShadowMap {
        let mut strands = Strands::default();
        strands.resize(points.len() / 2, 1, 2);
        strands.positions = points.to_vec();
        strands.widths.fill(1.0 / 80.0);
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
    fn a_strand_is_white_one_behind_it_adds_cyan_and_the_last_layer_blue() {
        // A hair as wide as a texel takes 0.3 of the light, 76.5 of 255, two take 0.51, three 0.657;
        // rounding and the last bits of the texel's coverage may go either way.
        let near = |byte: u8, expected: u8| byte.abs_diff(expected) <= 2;
        let is = |pixel: [u8; 3], expected: [u8; 3]| (0..3).all(|i| near(pixel[i], expected[i]));
        let pixels = column(&map(light(1.0)).opacity_picture());
        assert_eq!((pixels[0], pixels[15]), ([0; 3], [0; 3]));
        assert!(is(pixels[4], [77, 77, 77]), "{:?}", pixels[4]);
        assert!(is(pixels[12], [77, 130, 130]), "{:?}", pixels[12]);
        let points = [0.0, 0.03, 0.1].map(|depth| [place(0.0, depth), place(10.95, depth)]).concat();
        let pixels = column(&map_of(&points, light(1.0)).opacity_picture());
        assert!(is(pixels[4], [77, 130, 168]), "{:?}", pixels[4]);
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
