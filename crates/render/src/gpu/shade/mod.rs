//! Light toward the camera, from every point of the hair (`shade`) and from the body where it is seen.

use strandline_gpu::{Bound, Gpu, Kernel, THREADS, kernel};

use crate::gpu::buffers::{Groom, Maps, Strands};
use crate::gpu::inputs::Frame;
use crate::gpu::records::{Corner, Vertex};
use crate::lights::first_sample;
use crate::{Light, PictureSettings, RenderError};

kernel! {
    /// Radiances of points by the layer of a light's map instead; one thread is one point.
    pub(crate) struct LayerColors in "shade" (crate::gpu::linked::SHADE), entry "layer_colors" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        4 maps: Read [u32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

kernel! {
    /// Numbers of points in the place of their light; one thread is one point.
    pub(crate) struct Numbers in "shade" (crate::gpu::linked::SHADE), entry "numbers" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

kernel! {
    /// One thread is one point.
    pub(crate) struct Shade in "shade" (crate::gpu::linked::SHADE), entry "shade" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

kernel! {
    /// One thread is one pixel: the body's light in those of its samples that show the body.
    pub(crate) struct LightSkin in "skin" (crate::gpu::linked::SKIN), entry "light_skin" {
        0 frame: Read Frame,
        1 triangle_numbers: Texture u32,
        2 depths: Texture f32,
        3 samples: Written f32,
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 triangles: Read u32,
        8 vertices: Read Vertex,
        9 corners: Read Corner,
        10 surfaces: Read u32,
    }
}

/// Pixels along a side of the square that a workgroup of `light_skin` lights.
const SIDE: usize = 8;
const _: () = assert!(SIDE * SIDE == THREADS);

/// Threads of `light_skin` for a picture: its last squares reach beyond it.
pub(crate) fn lit_pixels(settings: &PictureSettings) -> usize {
    let squares = |length: u32| (length as usize).div_ceil(SIDE);
    squares(settings.width) * squares(settings.height) * THREADS
}

/// Hair coloured by the layers of a light's map, where that is asked for.
#[derive(Default)]
pub(crate) struct LayerColoring {
    /// The light, as the host counts lights.
    pub light: Option<usize>,
    /// The kernel for a place of it.
    compiled: Option<(usize, Kernel<LayerColors<'static>>)>,
}

impl LayerColoring {
    /// Kernel that colours the hair by layers, if a light with shadow is chosen for it.
    pub fn bind(
        &mut self,
        gpu: &Gpu,
        lights: &[Light],
        groom: &Groom,
        strands: &Strands,
        maps: &Maps,
    ) -> Result<Option<Bound>, RenderError> {
        let chosen = self.light.filter(|&light| lights.get(light).is_some_and(|light| light.shadow));
        let Some(light) = chosen.map(|light| first_sample(lights, light)) else { return Ok(None) };
        if self.compiled.as_ref().is_none_or(|(compiled, _)| *compiled != light) {
            self.compiled = Some((light, Kernel::new(gpu, &[("LAYERS_OF", light as f64)])?));
        }
        let Groom { frame, .. } = groom;
        let Strands { points, radiances, .. } = strands;
        let buffers = LayerColors { frame, points, maps: &maps.texels, radiances };
        let bind = |(_, kernel): &(usize, Kernel<LayerColors>)| kernel.bind(gpu, &buffers);
        Ok(self.compiled.as_ref().map(bind).transpose()?)
    }
}
