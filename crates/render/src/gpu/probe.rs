//! Results that the stages left on the device, for checks and pictures of them.

use glam::{Vec2, Vec3, Vec4};
use strandline_gpu::{Buffer, Recorder};
use strandline_groom::Vec3Lanes;

use super::GpuRenderer;
use super::frame::{opacity_depth, opacity_layers};
use super::half::from_half;
use super::records::Curve;
use super::renderer::LastFrame;
use super::scene::Scene;
use crate::shadow::{LightView, ShadowMap, Shadows, Window};
use crate::strands::Strands;
use crate::{DetailLevel, FrameInput, Light, Picture, RenderError, Shadow};

pub(super) fn vectors(values: &[[f32; 4]]) -> Vec<Vec3> {
    values.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect()
}

impl GpuRenderer {
    fn room(&self) -> &super::buffers::Strands {
        self.strands.as_ref().expect("a picture was drawn")
    }

    fn first<T: bytemuck::Pod>(buffer: &Buffer<T>, count: usize) -> Result<Vec<T>, RenderError> {
        Ok(buffer.read_first(count)?)
    }

    /// Times that moved vertices of the body were written to the device.
    pub fn skin_writes(&self) -> u64 {
        self.skin.writes()
    }

    /// Strands of the last frame \[m\], world space, shape `[block][point]` of lanes: the host's points, or
    /// those of bound strands.
    ///
    /// # Errors
    /// The device was lost.
    pub fn places(&self) -> Result<Vec<Vec3Lanes>, RenderError> {
        Self::first(&self.groom.places.viewed_as::<Vec3Lanes>(), self.guides.positions().len())
    }

    /// The curves of the last frame: positions \[m\], tangents and normals, shape `[guide][point]`.
    ///
    /// # Errors
    /// The device was lost.
    ///
    /// # Panics
    /// Nothing was drawn yet.
    pub fn curves(&self) -> Result<[Vec<Vec3>; 3], RenderError> {
        let count = self.guides.strand_count() * self.drawn.curve_points;
        let all = Self::first(&self.room().curves, count)?;
        let part = |of: fn(&Curve) -> [f32; 4]| vectors(&all.iter().map(of).collect::<Vec<_>>());
        Ok([part(|at| at.position), part(|at| at.tangent), part(|at| at.normal)])
    }

    /// The strands of the last frame; tangents are worked out where they are needed and left out here.
    ///
    /// # Errors
    /// The device was lost.
    ///
    /// # Panics
    /// Nothing was drawn yet.
    pub fn strands(&self) -> Result<Strands, RenderError> {
        let points = self.points()?;
        let radiances = Self::first(&self.room().radiances, points.len())?;
        let mut strands = self.drawn_of(&points);
        let place = |index| self.drawn.place(index);
        strands.radiances = (0..strands.positions.len())
            .map(|index| radiances[place(index)])
            .map(|[xy, z]| Vec3::new(from_half(xy), from_half(xy >> 16), from_half(z)))
            .collect();
        Ok(strands)
    }

    /// Points \[m\] and widths \[m\] of the last frame as the device has them, also those of guides that are left out.
    pub(super) fn points(&self) -> Result<Vec<[f32; 4]>, RenderError> {
        let per_guide = self.drawn.strands_per_guide * self.drawn.curve_points;
        Self::first(&self.room().points, self.guides.strand_count() * per_guide)
    }

    /// The strands that are drawn, without tangents and light, from all points of the device.
    pub(super) fn drawn_of(&self, points: &[[f32; 4]]) -> Strands {
        let (drawn, mut strands) = (self.drawn, Strands::default());
        let guides = drawn.lanes.count_of(self.guides.strand_count());
        strands.resize(guides, drawn.strands_per_guide, drawn.curve_points);
        strands.lanes = drawn.lanes;
        let own = (0..strands.positions.len()).map(|index| points[drawn.place(index)]).collect::<Vec<_>>();
        strands.positions = vectors(&own);
        strands.widths = own.iter().map(|point| point[3]).collect();
        strands.radiances.clear();
        strands.tangents.clear();
        strands
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
        let size = (maps.size * maps.size) as usize;
        let all = Self::first(&maps.texels, (slot + 1) * size)?;
        let depth = |bits: u32| f32::from_bits(if bits >> 31 == 1 { bits & 0x7fff_ffff } else { !bits });
        let texel = |&[first, a, b, c]: &[u32; 4]| {
            (Vec3::new(a as f32, b as f32, c as f32) / 65_536.0).extend(depth(first))
        };
        Ok(all[slot * size..].iter().map(texel).collect())
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
                let [x, y, density, _] = Self::first(&self.groom.frame, 1)?[0].fitted.windows[2 * slot];
                map.hair_window = Window { min: Vec2::new(x, y), density };
                slot += 1;
            }
            shadows.maps.push(map);
            shadows.casts.push(light.shadow);
        }
        Ok(shadows)
    }

    /// The shadows of strands as they are: `opacity_depth` and `opacity_layers` alone, for checks. The
    /// shadow of the body is left out.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn shadows_of(&mut self, strands: &Strands, input: &FrameInput) -> Result<Shadows, RenderError> {
        let settings = self.settings;
        let scene = Scene {
            level: DetailLevel::full(1, 1),
            guide_count: strands.strand_count,
            hair_strands: strands.strand_count,
            guide_points: strands.points_per_strand,
            ..self.scene(input, &settings, 1.0)
        };
        self.strands = None;
        self.prepare(&scene)?;
        self.write(&scene, false)?;
        let (Some(stages), Some(maps)) = (&self.stages, &self.maps) else { unreachable!("prepared above") };
        let with_width = strands.positions.iter().zip(&strands.widths);
        let points: Vec<_> = with_width.map(|(point, &width)| point.extend(width).to_array()).collect();
        self.strands.iter().try_for_each(|room| room.points.write(&points))?;
        self.gpu.ask("opacity maps", || {
            let mut recorder = Recorder::new(&self.gpu, None);
            opacity_depth(&mut recorder, &scene, stages, maps);
            opacity_layers(&mut recorder, &scene, stages);
            self.gpu.queue().submit([recorder.finish(|_| ())]);
        })?;
        self.drawn = LastFrame { shadows: scene.shadow_count(), ..LastFrame::default() };
        let shadows = self.shadows(input.lights, &input.look.shadow, scene.middle);
        self.strands = None;
        shadows
    }

    /// As [`Renderer::opacity_map`](crate::Renderer::opacity_map).
    ///
    /// # Errors
    /// The device was lost.
    pub fn opacity_map(&self, light: usize) -> Result<Option<Picture>, RenderError> {
        let (lights, settings, middle) = &self.lit;
        Ok(self.shadows(lights, settings, *middle)?.map(light).map(ShadowMap::opacity_picture))
    }

    /// As [`Renderer::depth_map`](crate::Renderer::depth_map).
    ///
    /// # Errors
    /// The device was lost.
    pub fn depth_map(&self, light: usize) -> Result<Option<Picture>, RenderError> {
        let (lights, settings, middle) = &self.lit;
        Ok(self.shadows(lights, settings, *middle)?.map(light).map(ShadowMap::depth_picture))
    }
}
