//! Every kernel and drawing of a frame, and their buffers.

use strandline_gpu::{
    Bindings, Bound, BoundDrawing, Declaration, Dispatches, Drawing, Gpu, GpuError, Kernel, Scan,
};

use super::buffers::{Groom, Maps, Strands};
use super::{
    background, body, bound, draw, fit, interpolate, light_grid, occlude, opacity_depth, opacity_layers,
    resolve, shade, sort, tessellate,
};

/// Every kernel and drawing, compiled.
pub(super) struct Kernels {
    pub tessellate: Kernel<tessellate::Tessellate<'static>>,
    pub interpolate: Kernel<interpolate::Interpolate<'static>>,
    pub measure_hair: Kernel<fit::MeasureHair<'static>>,
    pub measure_body: Kernel<fit::MeasureBody<'static>>,
    pub fit: Kernel<fit::Fit<'static>>,
    pub clear_maps: Kernel<opacity_depth::ClearMaps<'static>>,
    pub opacity_depth: Kernel<opacity_depth::OpacityDepth<'static>>,
    pub body_depth: Drawing<opacity_depth::BodyDepth<'static>>,
    pub opacity_layers: Kernel<opacity_layers::OpacityLayers<'static>>,
    pub sum_areas: Kernel<occlude::SumAreas<'static>>,
    pub sweep: Kernel<occlude::Sweep<'static>>,
    pub shade: Kernel<shade::Shade<'static>>,
    pub list_segments: Kernel<sort::ListSegments<'static>>,
    pub order_segments: Kernel<sort::OrderSegments<'static>>,
    pub scan: Scan,
    pub hair: Drawing<draw::Hair<'static>>,
    pub body: Drawing<body::Body<'static>>,
    pub backdrop: Drawing<background::Backdrop<'static>>,
}

impl Kernels {
    /// Compiles them.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            tessellate: Kernel::new(gpu, &[])?,
            interpolate: Kernel::new(gpu, &[])?,
            measure_hair: Kernel::new(gpu, &[])?,
            measure_body: Kernel::new(gpu, &[])?,
            fit: Kernel::new(gpu, &[])?,
            clear_maps: Kernel::new(gpu, &[])?,
            opacity_depth: Kernel::new(gpu, &[])?,
            body_depth: Drawing::new(gpu, &draw::body_depth_output(), &[])?,
            opacity_layers: Kernel::new(gpu, &[])?,
            sum_areas: Kernel::new(gpu, &[])?,
            sweep: Kernel::new(gpu, &[])?,
            shade: Kernel::new(gpu, &[])?,
            list_segments: Kernel::new(gpu, &[])?,
            order_segments: Kernel::new(gpu, &[])?,
            scan: Scan::new(gpu)?,
            hair: Drawing::new(gpu, &draw::hair_output(), &[])?,
            body: Drawing::new(gpu, &draw::body_output(), &[])?,
            backdrop: Drawing::new(gpu, &draw::background_output(), &[])?,
        })
    }
}

/// Every kernel but `tessellate`, bound to the buffers of the moment.
pub(super) struct Stages {
    pub interpolate: Bound,
    pub measure_hair: Bound,
    pub measure_body: Bound,
    pub fit: Bound,
    pub clear_maps: Bound,
    pub opacity_depth: Bound,
    pub body_depth: BoundDrawing,
    pub opacity_layers: Bound,
    pub sum_areas: Bound,
    pub sweep: Bound,
    pub shade: Bound,
    pub list_segments: Bound,
    pub scan: Dispatches,
    pub order_segments: Bound,
    pub hair: BoundDrawing,
    pub body: BoundDrawing,
    pub backdrop: BoundDrawing,
}

impl Stages {
    /// Binds every kernel but `tessellate`.
    pub fn new(
        gpu: &Gpu,
        kernels: &Kernels,
        groom: &Groom,
        strands: &Strands,
        maps: &Maps,
    ) -> Result<Self, GpuError> {
        let Groom { frame, lights, fitted, bounds, cubes, areas, roots, clumps, .. } = groom;
        let Groom { triangles, vertices, starts, .. } = groom;
        let Strands { tables, scales, curves, points, radiances, keys, order, .. } = strands;
        let Maps { texels, body: body_depths, .. } = maps;
        // Kernels that add to them see single numbers.
        let (texel_numbers, cube_numbers) = (&texels.viewed_as(), &cubes.viewed_as());
        let interpolate =
            interpolate::Interpolate { frame, points, radiances, roots, tables, curves, clumps, scales };
        let depth = opacity_depth::OpacityDepth { frame, points, lights, fitted, maps: texel_numbers };
        let layers = opacity_layers::OpacityLayers { frame, points, lights, fitted, maps: texel_numbers };
        let body_depth = opacity_depth::BodyDepth { frame, lights, fitted, triangles, vertices };
        let shade =
            shade::Shade { frame, points, lights, fitted, maps: texels, body_depths, cubes, radiances };
        let body =
            body::Body { frame, lights, fitted, maps: texels, body_depths, cubes, triangles, vertices };
        Ok(Self {
            interpolate: kernels.interpolate.bind(gpu, &interpolate)?,
            measure_hair: kernels
                .measure_hair
                .bind(gpu, &fit::MeasureHair { frame, points, lights, bounds })?,
            measure_body: kernels
                .measure_body
                .bind(gpu, &fit::MeasureBody { frame, lights, bounds, vertices })?,
            fit: kernels.fit.bind(gpu, &fit::Fit { frame, lights, fitted, bounds })?,
            clear_maps: kernels
                .clear_maps
                .bind(gpu, &opacity_depth::ClearMaps { frame, maps: texel_numbers })?,
            opacity_depth: kernels.opacity_depth.bind(gpu, &depth)?,
            body_depth: kernels.body_depth.bind(gpu, &body_depth)?,
            opacity_layers: kernels.opacity_layers.bind(gpu, &layers)?,
            sum_areas: kernels.sum_areas.bind(gpu, &occlude::SumAreas { frame, points, fitted, areas })?,
            sweep: kernels.sweep.bind(gpu, &occlude::Sweep { frame, fitted, cubes: cube_numbers, areas })?,
            shade: kernels.shade.bind(gpu, &shade)?,
            list_segments: kernels
                .list_segments
                .bind(gpu, &sort::ListSegments { frame, points, fitted, keys, starts })?,
            scan: kernels.scan.bind(gpu, starts, &groom.start_totals)?,
            order_segments: kernels
                .order_segments
                .bind(gpu, &sort::OrderSegments { frame, keys, starts, order })?,
            hair: kernels.hair.bind(gpu, &draw::Hair { frame, points, radiances, starts, order })?,
            body: kernels.body.bind(gpu, &body)?,
            backdrop: kernels.backdrop.bind(gpu, &background::Backdrop { frame })?,
        })
    }
}

/// Every kernel's and drawing's declaration, to be held against its shader.
pub fn declarations() -> Vec<Declaration> {
    vec![
        bound::FollowGuides::declaration(),
        bound::PlaceBound::declaration(),
        bound::KeepOutside::declaration(),
        tessellate::Tessellate::declaration(),
        interpolate::Interpolate::declaration(),
        fit::MeasureHair::declaration(),
        fit::MeasureBody::declaration(),
        fit::Fit::declaration(),
        opacity_depth::ClearMaps::declaration(),
        opacity_depth::OpacityDepth::declaration(),
        opacity_depth::BodyDepth::declaration(),
        opacity_layers::OpacityLayers::declaration(),
        occlude::SumAreas::declaration(),
        occlude::Sweep::declaration(),
        shade::Shade::declaration(),
        shade::LayerColors::declaration(),
        shade::Numbers::declaration(),
        light_grid::SumHair::declaration(),
        light_grid::SumSkin::declaration(),
        light_grid::Prepare::declaration(),
        light_grid::Carry::declaration(),
        light_grid::Scatter::declaration(),
        light_grid::Gather::declaration(),
        light_grid::ShadeChiang::declaration(),
        sort::ListSegments::declaration(),
        sort::OrderSegments::declaration(),
        draw::Hair::declaration(),
        body::Body::declaration(),
        background::Backdrop::declaration(),
        resolve::Resolve::declaration(),
    ]
}
