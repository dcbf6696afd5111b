//! What the stages left on the device, for checks and pictures of it.

use glam::{Vec2, Vec3, Vec4};
use strandline_gpu::Buffer;

use super::GpuRenderer;
use crate::cpu::shadow::{LightView, ShadowMap, Shadows, Window};
use crate::{Light, RenderError, Shadow, cpu};

/// Half floats as they are stored.
fn from_half(bits: u32) -> f32 {
    let (sign, exponent, fraction) = (bits >> 15 & 1, bits >> 10 & 31, bits & 1023);
    let value = match exponent {
        0 => fraction as f32 * 2.0_f32.powi(-24),
        31 => f32::INFINITY,
        _ => (1.0 + fraction as f32 / 1024.0) * 2.0_f32.powi(exponent as i32 - 15),
    };
    if sign == 1 { -value } else { value }
}

fn vectors(values: &[[f32; 4]]) -> Vec<Vec3> {
    values.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect()
}

impl GpuRenderer {
    fn room(&self) -> &super::buffers::Strands {
        self.strands.as_ref().expect("a picture was drawn")
    }

    fn first<T: bytemuck::Pod>(buffer: &Buffer<T>, count: usize) -> Result<Vec<T>, RenderError> {
        Ok(buffer.read_first(count)?)
    }

    /// The curves of the last frame: positions \[m\], tangents and normals, shape `[guide][point]`.
    ///
    /// # Errors
    /// The device was lost.
    ///
    /// # Panics
    /// Nothing was drawn yet.
    pub fn curves(&self) -> Result<[Vec<Vec3>; 3], RenderError> {
        let count = 3 * self.guides.strand_count() * self.drawn.curve_points;
        let all = vectors(&Self::first(&self.room().curves, count)?);
        Ok([0, 1, 2].map(|which| all.iter().skip(which).step_by(3).copied().collect()))
    }

    /// The strands of the last frame; tangents are worked out where they are needed and left out here.
    ///
    /// # Errors
    /// The device was lost.
    ///
    /// # Panics
    /// Nothing was drawn yet.
    pub fn strands(&self) -> Result<cpu::Strands, RenderError> {
        let mut strands = cpu::Strands::default();
        let drawn = self.drawn;
        strands.resize(self.guides.strand_count(), drawn.strands_per_guide, drawn.curve_points);
        let count = strands.positions.len();
        let points = Self::first(&self.room().points, count)?;
        strands.positions = vectors(&points);
        strands.widths = points.iter().map(|point| point[3]).collect();
        strands.radiances = Self::first(&self.room().radiances, count)?
            .into_iter()
            .map(|[xy, z]| Vec3::new(from_half(xy), from_half(xy >> 16), from_half(z)))
            .collect();
        strands.tangents.clear();
        Ok(strands)
    }

    /// The deep opacity map of shadow light number `slot` of the last frame: hairs crossed in three
    /// layers, and depth \[m\] of the first hair, shape `[row][column]`.
    ///
    /// # Errors
    /// The device was lost.
    pub fn opacity_texels(&self, slot: usize) -> Result<Vec<Vec4>, RenderError> {
        let Some(maps) = self.maps.as_ref().filter(|_| slot < self.drawn.shadows) else {
            return Ok(Vec::new());
        };
        let size = 4 * (maps.size * maps.size) as usize;
        let all = Self::first(&maps.texels, (slot + 1) * size)?;
        let (texels, _) = all[slot * size..].as_chunks::<4>();
        let depth = |bits: u32| f32::from_bits(if bits >> 31 == 1 { bits & 0x7fff_ffff } else { !bits });
        let texel = |&[first, a, b, c]: &[u32; 4]| {
            (Vec3::new(a as f32, b as f32, c as f32) / 65_536.0).extend(depth(first))
        };
        Ok(texels.iter().map(texel).collect())
    }

    /// The maps of all shadow lights of the last frame as the CPU keeps them, without the body's.
    pub(super) fn shadows(
        &self,
        lights: &[Light],
        settings: &Shadow,
        middle: Vec3,
    ) -> Result<Shadows, RenderError> {
        let mut shadows = Shadows::default();
        let mut slot = 0;
        for light in lights {
            let mut map = ShadowMap::default();
            map.view = LightView::new(light, middle);
            if light.shadow {
                map.set(settings);
                map.texels = self.opacity_texels(slot)?;
                let at = 3 + 2 * slot;
                let [x, y, density, _] = Self::first(&self.groom.fitted, at + 1)?[at];
                map.hair_window = Window { min: Vec2::new(x, y), density };
                slot += 1;
            }
            shadows.maps.push(map);
            shadows.casts.push(light.shadow);
        }
        Ok(shadows)
    }
}
