//! Pictures on whichever backend draws them.

use std::sync::Arc;

#[cfg(feature = "gpu")]
use strandline_base::SettingError;
use strandline_gpu::Gpu;

use crate::{
    BoundStrands,
    body::Mesh,
    groom::Guides,
    render::{
        FrameInput, FrameReport, Picture, PictureSettings, RenderError, Renderer,
        gpu::{DevicePoints, DeviceSolids, GpuRenderer},
    },
    scene::devices::{Opened, device_name},
};

/// A renderer, and the data to start another one on the CPU.
pub(crate) struct Painter {
    place: AnyRenderer,
    /// Renderer on the CPU for pictures beyond the limits of the GPU; `stands_in` while it draws.
    stand_in: Option<Box<Renderer>>,
    stands_in: bool,
    /// The strands that are drawn, at rest.
    strands: Guides,
    /// Their guides, where they are not simulated themselves.
    bound: Option<BoundStrands>,
    mesh: Option<Arc<Mesh>>,
    settings: PictureSettings,
    /// The light whose layers colour the hair.
    pub layers_of: Option<usize>,
    /// True where pictures are drawn on the CPU when the GPU fails.
    pub fall_back: bool,
    /// Notes, human-readable.
    pub notes: Vec<String>,
}

/// The renderer of either backend.
enum AnyRenderer {
    /// `None` before the first picture: many sessions simulate alone.
    Cpu(Option<Box<Renderer>>),
    Gpu(Box<GpuRenderer>),
}

impl Painter {
    /// A painter on a device, or on the CPU without one. The solids of a simulation may lie on that device.
    pub fn new(
        device: Opened,
        guides: &Guides,
        bound: Option<BoundStrands>,
        mesh: Option<Arc<Mesh>>,
        solids: Option<DeviceSolids>,
    ) -> Result<Self, RenderError> {
        let strands = bound.as_ref().map_or(guides, BoundStrands::strands).clone();
        let settings = PictureSettings::default();
        let mut notes = Vec::new();
        let placed = match &device.gpu {
            Some(gpu) => match on_gpu(gpu, &strands, bound.as_ref(), mesh.as_deref(), &settings, solids) {
                Err(error) if device.fall_back => {
                    notes.push(format!("drawing on the CPU: {error}"));
                    None
                }
                made => Some(AnyRenderer::Gpu(made?.into())),
            },
            None => None,
        };
        Ok(Self {
            place: placed.unwrap_or(AnyRenderer::Cpu(None)),
            stand_in: None,
            stands_in: false,
            strands,
            bound,
            mesh,
            settings,
            layers_of: None,
            fall_back: device.fall_back,
            notes,
        })
    }

    /// Device of the last picture, human-readable.
    pub fn drawn_on(&self) -> String {
        if self.stands_in { device_name(None) } else { device_name(self.gpu()) }
    }

    /// The device, unless all pictures are drawn on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        match &self.place {
            AnyRenderer::Gpu(renderer) => Some(renderer.gpu()),
            AnyRenderer::Cpu(_) => None,
        }
    }

    /// The strands that guides carry, where there are such.
    pub fn bound(&self) -> Option<&BoundStrands> {
        self.bound.as_ref()
    }

    /// Points of each strand that is drawn, before it is made rounder.
    pub fn points_per_strand(&self) -> usize {
        self.strands.points_per_strand()
    }

    /// The body that is drawn, head space.
    pub fn mesh(&self) -> Option<&Mesh> {
        self.mesh.as_deref()
    }

    /// Changes size and finish of the pictures; nothing changes when that fails.
    pub fn set_picture(&mut self, settings: &PictureSettings) -> Result<(), RenderError> {
        let changed = match &mut self.place {
            AnyRenderer::Cpu(Some(renderer)) => renderer.set_picture(settings),
            AnyRenderer::Cpu(None) => settings.validate(),
            AnyRenderer::Gpu(renderer) => renderer.set_picture(settings),
        };
        if let Err(failure) = changed {
            self.recover(failure, settings)?;
        }
        self.settings = *settings;
        self.stand_in.take_if(|renderer| renderer.set_picture(settings).is_err());
        Ok(())
    }

    /// Draws a picture. `points` are those of the input, where they lie on the same device; `None` where
    /// the input holds them. When the GPU fails it is the caller's to draw again with points that the input holds, if
    /// [`Painter::recover_from`] can help.
    pub fn draw(
        &mut self,
        input: &FrameInput,
        points: Option<DevicePoints>,
    ) -> Result<(Picture, FrameReport), RenderError> {
        let mut picture = Picture::default();
        let drawn = match &mut self.place {
            AnyRenderer::Cpu(_) => self.draw_on_cpu(input, &mut picture),
            AnyRenderer::Gpu(renderer) => {
                renderer.show_layers(self.layers_of);
                renderer.draw_into(input, points, &mut picture)
            }
        };
        let too_many = matches!(drawn, Err(RenderError::TooMany { .. }));
        self.stands_in = self.fall_back && too_many && points.is_none();
        let report = match drawn {
            Err(failure) if self.stands_in => {
                if self.stand_in.is_none() {
                    self.notes.push(format!("drawing on the CPU until the scene fits the GPU: {failure}"));
                }
                self.draw_on_cpu(input, &mut picture)
            }
            drawn => drawn,
        };
        Ok((picture, report?))
    }

    /// Draws a picture into a texture of the host on the device of the pictures, and does not wait for it.
    #[cfg(feature = "gpu")]
    pub fn draw_to(
        &mut self,
        input: &FrameInput,
        points: Option<DevicePoints>,
        target: &strandline_gpu::wgpu::TextureView,
        format: strandline_gpu::wgpu::TextureFormat,
    ) -> Result<FrameReport, RenderError> {
        match &mut self.place {
            AnyRenderer::Gpu(renderer) => {
                renderer.show_layers(self.layers_of);
                renderer.draw_to(input, points, target, format)
            }
            AnyRenderer::Cpu(_) => {
                let found = "pictures that the CPU draws".to_owned();
                let expected = "hair on the device of the texture, as `FrameLoop::with_device` opens it";
                Err(SettingError::new("the target texture", found, expected).into())
            }
        }
    }

    /// Draws on the CPU, whose renderer is made for the first picture.
    fn draw_on_cpu(&mut self, input: &FrameInput, picture: &mut Picture) -> Result<FrameReport, RenderError> {
        let place = match &mut self.place {
            AnyRenderer::Cpu(renderer) => renderer,
            AnyRenderer::Gpu(_) => &mut self.stand_in,
        };
        let made = match place.take() {
            Some(renderer) => renderer,
            None => on_cpu(&self.strands, self.bound.as_ref(), self.mesh.as_deref(), &self.settings)?,
        };
        let renderer = place.insert(made);
        renderer.show_layers(self.layers_of);
        renderer.draw_into(input, picture)
    }

    /// The opacity map of a light, and the depths of its first hair.
    pub fn maps(&self, light: usize) -> Result<Option<[Picture; 2]>, RenderError> {
        let pair = match (&self.place, self.stand_in.as_ref().filter(|_| self.stands_in)) {
            (_, Some(renderer)) => (renderer.opacity_map(light), renderer.depth_map(light)),
            (AnyRenderer::Cpu(Some(renderer)), None) => {
                (renderer.opacity_map(light), renderer.depth_map(light))
            }
            (AnyRenderer::Cpu(None), None) => return Ok(None),
            (AnyRenderer::Gpu(renderer), None) => (renderer.opacity_map(light)?, renderer.depth_map(light)?),
        };
        Ok(pair.0.zip(pair.1).map(|(opacity, depth)| [opacity, depth]))
    }

    /// Falls back to the CPU, if that is allowed and the failure is the GPU's; where a picture is beyond the limits of the
    /// GPU, only until it fits.
    pub fn recover_from(&mut self, failure: RenderError) -> Result<(), RenderError> {
        if self.fall_back && self.gpu().is_some() && matches!(failure, RenderError::TooMany { .. }) {
            return Ok(());
        }
        let settings = self.settings;
        self.recover(failure, &settings)
    }

    fn recover(&mut self, failure: RenderError, settings: &PictureSettings) -> Result<(), RenderError> {
        if !(self.fall_back && failure.is_of_gpu() && self.gpu().is_some()) {
            return Err(failure);
        }
        self.fall_back_after(&failure.to_string(), settings)
    }

    /// Draws on the CPU from now on, after a failure of the device.
    pub fn fall_back_after(&mut self, failure: &str, settings: &PictureSettings) -> Result<(), RenderError> {
        if self.gpu().is_some() {
            let made = on_cpu(&self.strands, self.bound.as_ref(), self.mesh.as_deref(), settings)?;
            self.place = AnyRenderer::Cpu(Some(made));
            self.notes.push(format!("drawing on the CPU from here on: {failure}"));
        }
        Ok(())
    }
}

/// A renderer on the CPU, which places bound strands.
fn on_cpu(
    strands: &Guides,
    bound: Option<&BoundStrands>,
    mesh: Option<&Mesh>,
    settings: &PictureSettings,
) -> Result<Box<Renderer>, RenderError> {
    let mut renderer = Renderer::new(strands, mesh, settings)?;
    if let Some(bound) = bound {
        renderer.bind(bound.binding(), bound.solids())?;
    }
    Ok(renderer.into())
}

/// A renderer on a GPU, which places bound strands.
fn on_gpu(
    gpu: &Gpu,
    strands: &Guides,
    bound: Option<&BoundStrands>,
    mesh: Option<&Mesh>,
    settings: &PictureSettings,
    solids: Option<DeviceSolids>,
) -> Result<GpuRenderer, RenderError> {
    let mut renderer = GpuRenderer::new(gpu, strands, mesh, settings)?;
    if let Some(bound) = bound {
        renderer.bind(bound.binding(), bound.solids(), solids)?;
    }
    Ok(renderer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Prepared, Scene};

    #[test]
    fn the_cpu_has_a_renderer_from_the_first_picture_on() {
        let mut scene = Scene::demo();
        (scene.style.strand_count, scene.groom.bound, scene.body.spacing) = (8, Some(0), 0.02);
        let prepared = Prepared::new(&scene).unwrap();
        let device = Opened { gpu: None, fall_back: false };
        let mut painter = Painter::new(device, &prepared.guides, None, None, None).unwrap();
        let small = PictureSettings { width: 16, height: 12, ..PictureSettings::default() };
        painter.set_picture(&small).unwrap();
        assert!(matches!(painter.place, AnyRenderer::Cpu(None)) && painter.maps(0).unwrap().is_none());
        // A size is refused before there is a renderer.
        assert!(painter.set_picture(&PictureSettings { width: 0, ..small }).is_err());
        assert_eq!([painter.settings.width, painter.settings.height], [16, 12]);
    }
}
