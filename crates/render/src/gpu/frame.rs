//! The stages of a frame, recorded into one submission.

use strandline_gpu::{Amount, Bound, BoundDrawing, Buffer, Recorder, Targets, groups, wgpu};

use super::buffers::{CELLS, Groom, Maps};
use super::inputs::body_stride;
use super::scatter::light_grid::{self, LightGrid};
use super::scene::Scene;
use super::shade::lit_pixels;
use super::shadow::fit;
use super::stages::Stages;
use super::{buffers, codes, draw};
use crate::frame::{DrawnStrands, Stage, stages};
use crate::scatter::ways::{DIRECTIONS, SETS};

/// Kernels, drawings and buffers of a frame.
pub(super) struct FrameKernels<'a> {
    /// Places strands that guides carry; empty without such.
    pub bound: Vec<(Bound, [u32; 3])>,
    pub tessellate: Bound,
    /// Keeps such strands out of solids.
    pub keep_outside: Option<(Bound, [u32; 3])>,
    /// Colours the hair by layers, where that is asked for.
    pub layer_colors: Option<Bound>,
    pub resolve: &'a BoundDrawing,
    pub maps: &'a Maps,
    pub target: &'a wgpu::TextureView,
    pub held: KeptResources<'a>,
}

/// Kernels and buffers that a renderer keeps from frame to frame.
#[derive(Clone, Copy)]
pub(super) struct KeptResources<'a> {
    pub groom: &'a Groom,
    pub stages: &'a Stages,
    /// Scattered light, once a look asked for it.
    pub light_grid: Option<&'a LightGrid>,
    pub indices: &'a Buffer<u32>,
    /// Textures that samples are drawn into.
    pub samples: &'a buffers::Targets,
}

/// A frame while it is recorded.
struct FrameRecording<'a> {
    scene: &'a Scene<'a>,
    bounds: &'a FrameKernels<'a>,
}

/// Records every stage in order.
pub(super) fn record(recorder: &mut Recorder, scene: &Scene, bounds: &FrameKernels) {
    let frame = FrameRecording { scene, bounds };
    let drawn = if bounds.bound.is_empty() { DrawnStrands::Guides } else { DrawnStrands::Carried };
    stages(drawn).for_each(|stage| frame.record(recorder, stage));
}

impl FrameRecording<'_> {
    fn record(&self, recorder: &mut Recorder, stage: Stage) {
        let Self { scene, bounds } = *self;
        let (stages, name) = (bounds.held.stages, stage.name());
        match stage {
            Stage::Bind => recorder.stage(name, &bounds.bound),
            Stage::Tessellate => {
                recorder.stage(name, &[bounds.tessellate.clone().over(scene.guide_count)]);
            }
            Stage::Interpolate => {
                let placed = [stages.interpolate.clone().over(scene.point_count())];
                let list: Vec<_> = placed.into_iter().chain(bounds.keep_outside.clone()).collect();
                recorder.stage(name, &list);
            }
            Stage::OpacityDepth => opacity_depth(recorder, scene, stages, bounds.maps),
            Stage::OpacityLayers => opacity_layers(recorder, scene, stages),
            Stage::Shade => self.shade(recorder),
            Stage::Draw => self.draw(recorder),
            Stage::Resolve => self.resolve(recorder),
        }
    }

    fn shade(&self, recorder: &mut Recorder) {
        let Self { scene, bounds } = *self;
        let (KeptResources { stages, groom, .. }, name) = (bounds.held, Stage::Shade.name());
        let one = |bound: &Bound, threads: usize| [bound.clone().over(threads)];
        let points = scene.point_count();
        recorder.clear(&groom.areas);
        recorder.stage(name, &one(&stages.sum_areas, scene.segment_count()));
        recorder.stage(name, &[(stages.sweep.clone(), [6, 1, 1])]);
        match &scattering(scene, &bounds.held) {
            Some((grid, light)) => {
                recorder.clear(grid.sums());
                recorder.stage(name, &light_stages(scene, grid.rounds(), light));
                recorder.stage(name, &one(&light.shade, points));
            }
            None => recorder.stage(name, &one(&stages.shade, points)),
        }
        bounds.layer_colors.iter().for_each(|layers| recorder.stage(name, &one(layers, points)));
    }

    fn draw(&self, recorder: &mut Recorder) {
        let Self { scene, bounds } = *self;
        let (KeptResources { stages, groom, .. }, name) = (bounds.held, Stage::Draw.name());
        recorder.clear(&groom.starts);
        recorder.stage(name, &[stages.list_segments.clone().over(scene.strand_count())]);
        recorder.stage(name, &stages.scan);
        recorder.stage(name, &[stages.order_segments.clone().over(scene.segment_count())]);
        samples(recorder, scene, &bounds.held);
    }

    fn resolve(&self, recorder: &mut Recorder) {
        let color = Some((self.bounds.target, wgpu::LoadOp::Clear(wgpu::Color::BLACK)));
        let corners = Amount::Vertices { count: 3, instance: 0 };
        let list = [(self.bounds.resolve, corners)];
        recorder.draw(Stage::Resolve.name(), &Targets { color, depth: None }, &list);
    }
}

/// Scattered light, where the look has it.
fn scattering<'a>(
    scene: &Scene,
    held: &KeptResources<'a>,
) -> Option<(&'a LightGrid, &'a light_grid::GridKernels)> {
    let scatters = scene.input.look.fibre.model.scatters_many_times();
    let grid = held.light_grid.filter(|_| scatters)?;
    Some((grid, grid.bounds()?))
}

/// Hair and skin summed into cells, and light carried through them.
fn light_stages(scene: &Scene, rounds: u32, light: &light_grid::GridKernels) -> Vec<(Bound, [u32; 3])> {
    let mut list = vec![light.sum_hair.clone().over(scene.segment_count())];
    if scene.triangle_count > 0 {
        list.push(light.sum_skin.clone().over(scene.triangle_count));
    }
    list.push(light.prepare.clone().over(CELLS));
    let lines = |bound: &Bound, count: usize| {
        let [x, y, _] = bound.groups(light_grid::LINES);
        (bound.clone(), [x, y, count as u32])
    };
    if scene.shadow_count() > 0 {
        list.push(lines(&light.weigh, scene.shadow_count()));
    }
    // The set that is carried first enters last, since the next one takes its place; the first set is carried last.
    let rounds = rounds as usize;
    for set in (rounds + 1..=rounds + SETS).map(|turn| turn % SETS) {
        list.push(light.sets[set].enter.clone().over(CELLS));
    }
    for round in (1..=rounds).rev() {
        let set = &light.sets[round % SETS];
        list.push(lines(&set.carry, DIRECTIONS));
        if round < SETS {
            list.push(set.gather.clone().over(CELLS));
        }
        list.push((set.scatter.clone(), groups(CELLS, 1)));
    }
    list.push(lines(&light.sets[0].carry, DIRECTIONS));
    list.push(light.sets[0].gather.clone().over(CELLS));
    list
}

/// Records the windows of the maps, and the first depths in those of every light with shadow.
pub(super) fn opacity_depth(recorder: &mut Recorder, scene: &Scene, stages: &Stages, maps: &Maps) {
    let name = Stage::OpacityDepth.name();
    recorder.stage(name, &fitting(scene, stages));
    if scene.shadow_count() > 0 {
        body_depths(recorder, scene, stages, maps);
        recorder.stage(name, &[for_each_light(&stages.opacity_depth, scene.segment_count(), scene)]);
    }
}

/// Records the layers in the maps of every light with shadow.
pub(super) fn opacity_layers(recorder: &mut Recorder, scene: &Scene, stages: &Stages) {
    if scene.shadow_count() > 0 {
        let layers = for_each_light(&stages.opacity_layers, scene.segment_count(), scene);
        recorder.stage(Stage::OpacityLayers.name(), &[layers]);
    }
}

/// A number of threads for each light with shadow.
fn for_each_light(bound: &Bound, threads: usize, scene: &Scene) -> (Bound, [u32; 3]) {
    let [x, y, _] = bound.groups(threads);
    (bound.clone(), [x, y, scene.shadow_count().max(1) as u32])
}

/// Boxes of hair and body, windows of the maps in them, and empty maps.
fn fitting(scene: &Scene, stages: &Stages) -> Vec<(Bound, [u32; 3])> {
    let measured = |bound: &Bound, count: usize| for_each_light(bound, count.div_ceil(fit::RUN), scene);
    let texels = scene.shadow_count() * (scene.input.look.shadow.size() as usize).pow(2);
    let mut list = vec![measured(&stages.measure_hair, scene.point_count())];
    if scene.vertex_count > 0 && scene.shadow_count() > 0 {
        list.push(measured(&stages.measure_body, scene.vertex_count));
    }
    list.push((stages.fit.clone(), [1; 3]));
    list.push(stages.clear_maps.clone().over(texels));
    list
}

/// The body as each shadow light sees it, one after the other through one texture.
fn body_depths(recorder: &mut Recorder, scene: &Scene, stages: &Stages, maps: &Maps) {
    if scene.triangle_count == 0 {
        return;
    }
    let count = 3 * scene.triangle_count as u32;
    let drawing = stages.cut_depth.as_ref().unwrap_or(&stages.body_depth);
    let row_bytes = 4 * body_stride(maps.size);
    for slot in 0..scene.shadow_count() {
        let depth = Some((maps.body_depth.view(), wgpu::LoadOp::Clear(1.0)));
        let amount = Amount::Vertices { count, instance: slot as u32 };
        let targets = Targets { color: None, depth };
        recorder.draw(Stage::OpacityDepth.name(), &targets, &[(drawing, amount)]);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: slot as u64 * u64::from(row_bytes) * u64::from(maps.size),
            bytes_per_row: Some(row_bytes),
            rows_per_image: None,
        };
        recorder.encoder().copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                aspect: wgpu::TextureAspect::DepthOnly,
                ..maps.body_depth.raw().as_image_copy()
            },
            wgpu::TexelCopyBufferInfo { buffer: maps.body.raw(), layout },
            maps.body_depth.raw().size(),
        );
    }
}

/// Background, body and hair, in this order.
pub(super) fn samples(recorder: &mut Recorder, scene: &Scene, held: &KeptResources) {
    let name = Stage::Draw.name();
    let KeptResources { stages, samples: to, .. } = held;
    let has_body = scene.triangle_count > 0;
    if has_body {
        body_triangles(recorder, scene, held);
    }
    let backdrop = (!scene.settings.transparent)
        .then_some((&stages.backdrop, Amount::Vertices { count: 3, instance: 0 }));
    let color = Some((to.samples.view(), wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)));
    recorder.draw(name, &Targets { color, depth: None }, backdrop.as_slice());
    if has_body {
        let skin = scattering(scene, held).map_or(&stages.light_skin, |(_, light)| &light.light_skin);
        recorder.stage(name, &[skin.clone().over(lit_pixels(scene.settings))]);
    }
    let instances = scene.segment_count().div_ceil(draw::BATCH) as u32;
    let hair = (&stages.hair, Amount::Instanced { indices: held.indices, instances });
    let color = Some((to.samples.view(), wgpu::LoadOp::Load));
    let depth = Some((to.depth.view(), if has_body { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(0.0) }));
    recorder.draw(name, &Targets { color, depth }, &[hair]);
}

/// The body's triangle and depth in every sample.
fn body_triangles(recorder: &mut Recorder, scene: &Scene, held: &KeptResources) {
    let KeptResources { stages, samples: to, .. } = held;
    let body = stages.cut_body.as_ref().filter(|_| scene.paint & codes::CUT != 0).unwrap_or(&stages.body);
    let amount = Amount::Vertices { count: 3 * scene.triangle_count as u32, instance: 0 };
    let color = Some((to.triangles.view(), wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)));
    let depth = Some((to.depth.view(), wgpu::LoadOp::Clear(0.0)));
    recorder.draw(Stage::Draw.name(), &Targets { color, depth }, &[(body, amount)]);
}
