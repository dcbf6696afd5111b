//! `shade`: light from every point of the hair toward the camera.

use strandline_gpu::{Bound, Kernel, kernel};

use super::GpuRenderer;
use super::buffers::{Groom, Strands};
use super::inputs::{Frame, LightSource};
use crate::lights::first_sample;
use crate::{Light, RenderError};

kernel! {
    /// Radiances of points by the layer of a light's map instead; one thread is one point.
    pub(super) struct LayerColors in "shade" (super::linked::SHADE), entry "layer_colors" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        2 lights: Read LightSource,
        3 fitted: Read [f32; 4],
        4 maps: Read [u32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

kernel! {
    /// Numbers of points in the place of their light; one thread is one point.
    pub(super) struct Numbers in "shade" (super::linked::SHADE), entry "numbers" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

kernel! {
    /// One thread is one point.
    pub(super) struct Shade in "shade" (super::linked::SHADE), entry "shade" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        2 lights: Read LightSource,
        3 fitted: Read [f32; 4],
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

impl GpuRenderer {
    /// As [`Renderer::show_layers`](crate::Renderer::show_layers).
    pub fn show_layers(&mut self, light: Option<usize>) {
        self.layers_of = light;
    }

    /// What colours the hair by layers, if a light with shadow is chosen for it.
    pub(super) fn layer_colors(&mut self, lights: &[Light]) -> Result<Option<Bound>, RenderError> {
        let chosen = self.layers_of.filter(|&light| lights.get(light).is_some_and(|light| light.shadow));
        let chosen = chosen.map(|light| first_sample(lights, light));
        let (Some(light), Some(strands), Some(maps)) = (chosen, &self.strands, &self.maps) else {
            return Ok(None);
        };
        if self.layer_colors.as_ref().is_none_or(|(compiled, _)| *compiled != light) {
            self.layer_colors = Some((light, Kernel::new(&self.gpu, &[("LAYERS_OF", light as f64)])?));
        }
        let Groom { frame, lights, fitted, .. } = &self.groom;
        let Strands { points, radiances, .. } = strands;
        let buffers = LayerColors { frame, points, lights, fitted, maps: &maps.texels, radiances };
        let bind = |(_, kernel): &(usize, Kernel<LayerColors>)| kernel.bind(&self.gpu, &buffers);
        Ok(self.layer_colors.as_ref().map(bind).transpose()?)
    }
}
