//! A frame as a list of stages, recorded into one submission.

use strandline_gpu::{Amount, Bound, BoundDrawing, Buffer, Recorder, Targets, groups, wgpu};

use super::buffers::{CELLS, Groom, Maps};
use super::inputs::body_stride;
use super::scatter::light_grid::{self, LightGrid};
use super::scene::Scene;
use super::shadow::fit;
use super::stages::Stages;
use super::{buffers, draw};
use crate::cpu::scatter::lattice::DIRECTIONS;

/// What a frame is recorded from.
pub(super) struct Bounds<'a> {
    /// What places strands that guides carry; nothing without such.
    pub bound: Vec<(Bound, [u32; 3])>,
    pub tessellate: Bound,
    /// What keeps such strands out of solids.
    pub keep_outside: Option<(Bound, [u32; 3])>,
    /// What colours the hair by layers, where that is asked for.
    pub layer_colors: Option<Bound>,
    pub resolve: &'a BoundDrawing,
    pub maps: &'a Maps,
    pub target: &'a wgpu::TextureView,
    pub held: Held<'a>,
}

/// What a renderer keeps from frame to frame.
#[derive(Clone, Copy)]
pub(super) struct Held<'a> {
    pub groom: &'a Groom,
    pub stages: &'a Stages,
    /// Scattered light, once a look asked for it.
    pub light_grid: Option<&'a LightGrid>,
    pub indices: &'a Buffer<u32>,
    /// What samples are drawn into.
    pub samples: &'a buffers::Targets,
}

/// Records every stage in order.
pub(super) fn record(recorder: &mut Recorder, scene: &Scene, bounds: &Bounds) {
    let Held { stages, groom, .. } = bounds.held;
    let (strands, segments) = (scene.strand_count(), scene.strand_count() * (scene.curve_points() - 1));
    let points = scene.strand_count() * scene.curve_points();
    let one = |bound: &Bound, threads: usize| [bound.clone().over(threads)];

    if !bounds.bound.is_empty() {
        recorder.stage("bind", &bounds.bound);
    }
    recorder.stage("tessellate", &one(&bounds.tessellate, scene.guide_count));
    let interpolate = one(&stages.interpolate, points).into_iter().chain(bounds.keep_outside.clone());
    recorder.stage("interpolate", &interpolate.collect::<Vec<_>>());
    record_opacity(recorder, scene, stages, bounds.maps);
    recorder.clear(&groom.areas);
    recorder.stage("shade", &one(&stages.sum_areas, segments));
    recorder.stage("shade", &[(stages.sweep.clone(), [6, 1, 1])]);
    match &scattering(scene, &bounds.held) {
        Some((grid, light)) => {
            recorder.clear(grid.sums());
            recorder.stage("shade", &light_stages(scene, light, segments));
            recorder.stage("shade", &one(&light.shade, points));
        }
        None => recorder.stage("shade", &one(&stages.shade, points)),
    }
    if let Some(layer_colors) = &bounds.layer_colors {
        recorder.stage("shade", &one(layer_colors, points));
    }
    recorder.clear(&groom.starts);
    recorder.stage("draw", &one(&stages.list_segments, strands));
    recorder.stage("draw", &stages.scan);
    recorder.stage("draw", &one(&stages.order_segments, segments));
    samples(recorder, scene, &bounds.held);
    let target =
        Targets { color: Some((bounds.target, wgpu::LoadOp::Clear(wgpu::Color::BLACK))), depth: None };
    recorder.draw("resolve", &target, &[(bounds.resolve, Amount::Vertices { count: 3, instance: 0 })]);
}

/// Scattered light, where the look has it.
fn scattering<'a>(scene: &Scene, held: &Held<'a>) -> Option<(&'a LightGrid, &'a light_grid::Bounds)> {
    let scatters = scene.input.look.fibre.model.scatters_many_times();
    let grid = held.light_grid.filter(|_| scatters)?;
    Some((grid, grid.bounds()?))
}

/// Hair and skin summed into cells, and light carried through them.
fn light_stages(scene: &Scene, light: &light_grid::Bounds, segments: usize) -> Vec<(Bound, [u32; 3])> {
    let mut list = vec![light.sum_hair.clone().over(segments)];
    if scene.triangle_count > 0 {
        list.push(light.sum_skin.clone().over(scene.triangle_count));
    }
    list.push(light.prepare.clone().over(CELLS));
    let [x, y, _] = light.carry.groups(light_grid::LINES);
    let carry = (light.carry.clone(), [x, y, DIRECTIONS as u32]);
    for _ in 0..scene.input.look.fibre.chiang.scatterings {
        list.push(carry.clone());
        list.push((light.scatter.clone(), groups(CELLS, 1)));
    }
    list.push(carry);
    list.push(light.gather.clone().over(CELLS));
    list
}

/// Records the deep opacity maps of every light with shadow.
pub(super) fn record_opacity(recorder: &mut Recorder, scene: &Scene, stages: &Stages, maps: &Maps) {
    let strands = scene.strand_count();
    let segments = strands * (scene.curve_points() - 1);
    let lit = |bound: &Bound| [for_each_light(bound, segments, scene)];
    recorder.stage("opacity_depth", &fitting(scene, stages, strands * scene.curve_points()));
    if scene.shadow_count() > 0 {
        body_depths(recorder, scene, stages, maps);
        recorder.stage("opacity_depth", &lit(&stages.opacity_depth));
        recorder.stage("opacity_layers", &lit(&stages.opacity_layers));
    }
}

/// So many threads for every light with shadow.
fn for_each_light(bound: &Bound, threads: usize, scene: &Scene) -> (Bound, [u32; 3]) {
    let [x, y, _] = bound.groups(threads);
    (bound.clone(), [x, y, scene.shadow_count().max(1) as u32])
}

/// Where everything lies, and empty maps.
fn fitting(scene: &Scene, stages: &Stages, points: usize) -> Vec<(Bound, [u32; 3])> {
    let measured = |bound: &Bound, count: usize| for_each_light(bound, count.div_ceil(fit::RUN), scene);
    let texels = scene.shadow_count() * (scene.input.look.shadow.map_size as usize).pow(2);
    let mut list = vec![measured(&stages.measure_hair, points)];
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
    let row_bytes = 4 * body_stride(maps.size);
    for slot in 0..scene.shadow_count() {
        let depth = Some((maps.body_depth.view(), wgpu::LoadOp::Clear(1.0)));
        let amount = Amount::Vertices { count, instance: slot as u32 };
        recorder.draw("opacity_depth", &Targets { color: None, depth }, &[(&stages.body_depth, amount)]);
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
pub(super) fn samples(recorder: &mut Recorder, scene: &Scene, held: &Held) {
    let segments = scene.strand_count() * (scene.curve_points() - 1);
    let instances = segments.div_ceil(draw::BATCH) as u32;
    let mut list = Vec::new();
    if !scene.settings.transparent {
        list.push((&held.stages.backdrop, Amount::Vertices { count: 3, instance: 0 }));
    }
    if scene.triangle_count > 0 {
        let count = 3 * scene.triangle_count as u32;
        let body = scattering(scene, held).map_or(&held.stages.body, |(_, light)| &light.body);
        list.push((body, Amount::Vertices { count, instance: 0 }));
    }
    list.push((&held.stages.hair, Amount::Instanced { indices: held.indices, instances }));
    let targets = Targets {
        color: Some((held.samples.samples.view(), wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))),
        depth: Some((held.samples.depth.view(), wgpu::LoadOp::Clear(0.0))),
    };
    recorder.draw("draw", &targets, &list);
}
