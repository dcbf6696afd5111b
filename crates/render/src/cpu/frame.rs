//! A frame while it runs on the CPU, and what its stages work in.

use glam::Vec3;
use strandline_body::{Aabb, Mesh};
use strandline_groom::Guides;

use super::shade::skin::Skin;
use super::strands::bind::{Carried, bind, drawn_points};
use super::{
    Curves, Draw, DrawInput, LazyRadiances, Lit, LitRuns, Occlusion, Radiances, Resolve, Scattering,
    Scheuermann, Shading, SkinColor, interpolate, keep_outside, layer_colors, opacity_depth, opacity_layers,
    tessellate,
};
use crate::fibre::FibreModel;
use crate::frame::edges::smooth_edges;
use crate::frame::samples::Samples;
use crate::frame::{Stage, bounds};
use crate::scatter::source::OwnColors;
use crate::shadow::Shadows;
use crate::strands::{Strands, roots::RootTurns, scalp::root_densities};
use crate::{DetailLevel, FrameInput, Picture, PictureSettings};

/// Input of the stages that stays, and memory that they use again from frame to frame.
#[derive(Debug)]
pub(super) struct Scratch {
    pub guides: Guides,
    /// The strands that are drawn, where guides carry them.
    pub carried: Option<Carried>,
    /// Box around the strands at rest \[m\], head space.
    pub bounds: Aabb,
    pub turns: RootTurns,
    pub curves: Curves,
    pub strands: Strands,
    pub shadows: Shadows,
    pub occlusion: Occlusion,
    pub scattering: Scattering,
    pub found: LitRuns,
    /// Colours of the groom.
    pub own_colors: Option<OwnColors>,
    pub samples: Samples,
    pub draw: Draw,
    pub resolve: Resolve,
}

impl Scratch {
    /// Scratch of pictures of guides on a body, head space.
    pub fn new(guides: &Guides, body: Option<&Mesh>) -> Self {
        let mut draw = Draw::new(body.cloned());
        draw.set_roots(body.map(|body| root_densities(&body.positions, guides)).unwrap_or_default());
        Self {
            guides: guides.clone(),
            carried: None,
            bounds: bounds(guides),
            turns: RootTurns::default(),
            curves: Curves::default(),
            strands: Strands::default(),
            shadows: Shadows::default(),
            occlusion: Occlusion::default(),
            scattering: Scattering::default(),
            found: LitRuns::default(),
            own_colors: OwnColors::of(guides),
            samples: Samples::default(),
            draw,
            resolve: Resolve::default(),
        }
    }
}

/// A frame while it runs.
pub(super) struct FrameRun<'a> {
    pub scratch: &'a mut Scratch,
    pub settings: &'a PictureSettings,
    /// Lights with an area as the places on them.
    pub input: &'a FrameInput<'a>,
    pub level: DetailLevel,
    /// The light whose layers colour the hair.
    pub layers_of: Option<usize>,
    /// Target of `resolve`.
    pub picture: Option<&'a mut Picture>,
}

impl FrameRun<'_> {
    /// Runs a stage.
    pub fn run(&mut self, stage: Stage) {
        let Self { settings, input, level, picture, .. } = self;
        let Scratch { guides, carried, turns, curves, strands, shadows, .. } = &mut *self.scratch;
        match stage {
            Stage::Bind => {
                let bind = |carried| bind(carried, level.drawn_lanes(), input.positions, input.body);
                carried.iter_mut().for_each(bind);
            }
            Stage::Tessellate => {
                let points = drawn_points(carried.as_ref(), input.positions, guides, level);
                turns.place(input.body, carried.as_ref().map(Carried::binding), guides.strand_count());
                tessellate(&points, guides, turns, level, curves);
            }
            Stage::Interpolate => {
                interpolate(curves, guides, turns, input.look, level, strands);
                if let Some(carried) = carried {
                    let solids = carried.solids().placed(input.body);
                    keep_outside(strands, curves, guides.points_per_strand(), &solids);
                }
            }
            Stage::OpacityDepth => self.opacity_depth(),
            Stage::OpacityLayers => opacity_layers(strands, shadows),
            Stage::Shade => self.shade(),
            Stage::Draw => self.draw(),
            Stage::Resolve => {
                let Scratch { resolve, samples, .. } = &mut *self.scratch;
                if let Some(picture) = picture {
                    smooth_edges(samples);
                    resolve.resolve(samples, settings, picture);
                }
            }
        }
    }

    /// Middle of the hair \[m\], world space.
    fn middle(&self) -> Vec3 {
        self.input.middle(self.scratch.bounds)
    }

    fn opacity_depth(&mut self) {
        let middle = self.middle();
        let FrameInput { body, lights, look, .. } = *self.input;
        let Scratch { strands, shadows, draw, .. } = &mut *self.scratch;
        draw.place_body(body);
        let coarse = look.shadow.simple;
        if coarse {
            draw.place_coarse_body(body);
        }
        opacity_depth(strands, draw.shadow_body_of(coarse), lights, middle, &look.hair_shadow(), shadows);
    }

    /// Finds what the light of every point needs of all others; the light of a point is found where it is drawn.
    fn shade(&mut self) {
        let (middle, layers_of) = (self.middle(), self.layers_of);
        let FrameInput { look, body_look, .. } = *self.input;
        let Scratch { strands, shadows, occlusion, scattering, found, own_colors, draw, .. } =
            &mut *self.scratch;
        occlusion.set_grid(middle, look.fibre.grid_cells());
        if let Some(map) = layers_of.and_then(|light| shadows.map(light)) {
            layer_colors(strands, map);
        }
        let reflected = match draw.surfaces().filter(|_| body_look.materials) {
            Some(surfaces) => surfaces.mean_color(body_look.color),
            None => body_look.color,
        };
        let own = own_colors.as_ref().map(|own| own.mean);
        let skin = SkinColor::new(reflected, body_look, look, own);
        let body = draw.shadow_body_of(look.shadow.simple).map(|body| (body, skin));
        let lit = Lit { body, ..lit(self.input, shadows, own_colors.as_ref()) };
        match look.fibre.model {
            FibreModel::Scheuermann => occlusion.fill(strands, &look.shadow),
            FibreModel::Chiang => scattering.prepare(strands, &lit, occlusion),
        }
        found.begin(strands);
    }

    fn draw(&mut self) {
        let FrameRun { settings, input, layers_of, .. } = *self;
        let FrameInput { look, body_look, lights, camera, .. } = *input;
        let Scratch { strands, shadows, occlusion, scattering, found, own_colors, draw, samples, .. } =
            &mut *self.scratch;
        let (strands, shadows, own_colors) = (&*strands, &*shadows, own_colors.as_ref());
        let layered = layers_of.is_some_and(|light| shadows.map(light).is_some());
        let lit = lit(input, shadows, own_colors);
        let shading = shading(strands, &lit, occlusion, scattering);
        let light = match shading.as_deref() {
            Some(shading) if !layered => Radiances::Lazy(LazyRadiances::new(strands, found, shading)),
            _ => Radiances::Known(strands),
        };
        let draw_input = DrawInput {
            strands,
            light,
            camera,
            background: (!settings.transparent).then_some(settings.background),
            supersampling: settings.supersampling,
            round: !layered,
        };
        let skin = Skin {
            look: body_look,
            lights,
            shadows,
            occlusion,
            scalp: look.scalp(body_look.scalp, own_colors.map(|own| own.mean)),
            grid: look.fibre.model.scatters_many_times().then(|| scattering.grid()),
            environment: &look.gradient(),
            eye: camera.position,
        };
        draw.draw(&draw_input, &skin, samples);
    }
}

/// The light of a frame, without the body in it.
fn lit<'a>(input: &FrameInput<'a>, shadows: &'a Shadows, own_colors: Option<&'a OwnColors>) -> Lit<'a> {
    let FrameInput { lights, look, camera, .. } = *input;
    Lit { lights, shadows, body: None, look, own_colors, eye: camera.position }
}

/// The shading of points, after `shade`.
fn shading<'a>(
    strands: &'a Strands,
    lit: &'a Lit,
    occlusion: &'a Occlusion,
    scattering: &'a Scattering,
) -> Option<Box<dyn Shading + 'a>> {
    let Lit { shadows, lights, look, eye, .. } = *lit;
    match look.fibre.model {
        FibreModel::Scheuermann => {
            Some(Box::new(Scheuermann::new(strands, shadows, lights, look, eye, occlusion)))
        }
        FibreModel::Chiang => Some(Box::new(scattering.shading(strands, lit, occlusion)?)),
    }
}
