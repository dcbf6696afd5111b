//! Every kernel and drawing of a frame, and their buffers.

use strandline_gpu::{
    Bindings, Bound, BoundDrawing, Declaration, Dispatches, Drawing, Gpu, GpuError, Kernel, Scan,
};

use super::buffers::{Groom, Maps, Strands, Targets};
use super::draw::{background, body, sort};
use super::scatter::{light_grid, occlude};
use super::shadow::{fit, opacity_depth, opacity_layers};
use super::strands::{bind, interpolate, tessellate};
use super::{draw, resolve, shade};

/// Declares the kernels and drawings that are bound once for all pictures: each with its buffers, a drawing also with its
/// blend mode. The code that compiles, keeps and binds them derives from that.
macro_rules! stages {
    (
        |$groom:ident, $strands:ident, $maps:ident, $targets:ident| { $($rooms:tt)* }
        kernels { $($kernel:ident: $kernel_in:ident::$Kernel:ident { $($kernel_buffers:tt)* })* }
        drawings { $($drawing:ident: $drawing_in:ident::$Drawing:ident, $output:ident { $($drawing_buffers:tt)* })* }
    ) => {
        /// Every kernel and drawing, compiled.
        pub(super) struct Kernels {
            pub tessellate: Kernel<tessellate::Tessellate<'static>>,
            pub scan: Scan,
            $(pub $kernel: Kernel<$kernel_in::$Kernel<'static>>,)*
            $(pub $drawing: Drawing<$drawing_in::$Drawing<'static>>,)*
        }

        impl Kernels {
            /// Compiles them.
            pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
                Ok(Self {
                    tessellate: Kernel::new(gpu, &[])?,
                    scan: Scan::new(gpu)?,
                    $($kernel: Kernel::new(gpu, &[])?,)*
                    $($drawing: Drawing::new(gpu, &draw::$output(), &[])?,)*
                })
            }
        }

        /// Every kernel but `tessellate`, bound to the buffers of the moment.
        pub(super) struct Stages {
            pub scan: Dispatches,
            /// In place of `body_depth` and `body` where materials cut parts of the body away.
            pub cut_depth: Option<BoundDrawing>,
            pub cut_body: Option<BoundDrawing>,
            $(pub $kernel: Bound,)*
            $(pub $drawing: BoundDrawing,)*
        }

        impl Stages {
            /// Binds every kernel but `tessellate`.
            pub fn new(
                gpu: &Gpu,
                kernels: &Kernels,
                $groom: &Groom,
                $strands: &Strands,
                $maps: &Maps,
                $targets: &Targets,
            ) -> Result<Self, GpuError> {
                $($rooms)*
                Ok(Self {
                    scan: kernels.scan.bind(gpu, &$groom.starts, &$groom.start_totals)?,
                    cut_depth: if $groom.cuts { Some(cut_depth(gpu, $groom)?) } else { None },
                    cut_body: if $groom.cuts { Some(cut_body(gpu, $groom)?) } else { None },
                    $($kernel: kernels.$kernel.bind(gpu, &$kernel_in::$Kernel { $($kernel_buffers)* })?,)*
                    $($drawing: kernels.$drawing.bind(gpu, &$drawing_in::$Drawing { $($drawing_buffers)* })?,)*
                })
            }
        }

        /// Their declarations.
        fn of_stages() -> Vec<Declaration> {
            vec![
                $($kernel_in::$Kernel::declaration(),)*
                $($drawing_in::$Drawing::declaration(),)*
            ]
        }
    };
}

stages! {
    |groom, strands, maps, targets| {
        let Groom { frame, bounds, cubes, areas, roots, clumps, .. } = groom;
        let Groom { triangles, vertices, corners, surfaces, starts, .. } = groom;
        let Strands { tables, scales, curves, points, radiances, keys, order, .. } = strands;
        let Maps { texels, body: body_depths, .. } = maps;
        let Targets { samples, triangles: triangle_numbers, depth: depths } = targets;
        // Kernels that add to them see single numbers.
        let (texel_numbers, cube_numbers) = (&texels.viewed_as(), &cubes.viewed_as());
    }
    kernels {
        interpolate: interpolate::Interpolate {
            frame, points, radiances, roots, tables, curves, clumps, scales
        }
        measure_hair: fit::MeasureHair { frame, points, bounds }
        measure_body: fit::MeasureBody { frame, bounds, vertices }
        fit: fit::Fit { frame, bounds }
        clear_maps: opacity_depth::ClearMaps { frame, maps: texel_numbers }
        opacity_depth: opacity_depth::OpacityDepth { frame, points, maps: texel_numbers }
        opacity_layers: opacity_layers::OpacityLayers { frame, points, maps: texel_numbers }
        sum_areas: occlude::SumAreas { frame, points, areas }
        sweep: occlude::Sweep { frame, cubes: cube_numbers, areas }
        shade: shade::Shade { frame, points, maps: texels, body_depths, cubes, radiances }
        light_skin: shade::LightSkin {
            frame, triangle_numbers, depths, samples, maps: texels, body_depths, cubes, triangles, vertices, corners,
            surfaces
        }
        list_segments: sort::ListSegments { frame, points, keys, starts }
        order_segments: sort::OrderSegments { frame, keys, starts, order }
    }
    drawings {
        body_depth: opacity_depth::BodyDepth, body_depth_output { frame, triangles, vertices }
        hair: draw::Hair, hair_output { frame, points, radiances, starts, order }
        body: body::Body, body_output { frame, triangles, vertices }
        backdrop: background::Backdrop, background_output { frame }
    }
}

/// Draws depths of a body whose materials cut parts of it away.
fn cut_depth(gpu: &Gpu, groom: &Groom) -> Result<BoundDrawing, GpuError> {
    let Groom { frame, triangles, vertices, corners, surfaces, .. } = groom;
    let buffers = opacity_depth::CutDepth { frame, triangles, vertices, corners, surfaces };
    let drawing = Drawing::<opacity_depth::CutDepth<'static>>::new(gpu, &draw::body_depth_output(), &[])?;
    drawing.bind(gpu, &buffers)
}

/// Draws such a body.
fn cut_body(gpu: &Gpu, groom: &Groom) -> Result<BoundDrawing, GpuError> {
    let Groom { frame, triangles, vertices, corners, surfaces, .. } = groom;
    let buffers = body::CutBody { frame, triangles, vertices, corners, surfaces };
    Drawing::<body::CutBody<'static>>::new(gpu, &draw::body_output(), &[])?.bind(gpu, &buffers)
}

/// Every kernel's and drawing's declaration, to be held against its shader: those of every frame, and those that are
/// bound where a groom, a look or a picture asks for them.
pub fn declarations() -> Vec<Declaration> {
    let mut all = of_stages();
    all.extend(bind::declarations());
    all.extend(light_grid::declarations());
    all.extend([
        tessellate::Tessellate::declaration(),
        opacity_depth::CutDepth::declaration(),
        body::CutBody::declaration(),
        shade::LayerColors::declaration(),
        shade::Numbers::declaration(),
        resolve::Resolve::declaration(),
    ]);
    all
}
