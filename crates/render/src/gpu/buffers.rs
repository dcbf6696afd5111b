//! Buffers on the device.

use glam::Quat;
use strandline_gpu::{Buffer, Gpu, GpuError, Scan, Texture, wgpu};
use strandline_groom::Guides;

use super::inputs::{Frame, LightSource, body_stride};
use super::records::{Corner, Curve, Root, Tap, Vertex};
use super::scene::Scene;
use super::shadow::fit::BOX;
use super::skin::Skin;
use super::{MAX_LIGHTS, MAX_SHADOWS, ORDER_STEPS};
use crate::strands::curve::skin_axes;
use crate::{PictureSettings, RenderError};

/// Format of the samples: the widest that blends on every device.
pub(super) const SAMPLES: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of the numbers of triangles.
pub(super) const TRIANGLES: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// Format of depths.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Numbers of the box around the hair, and of what each shadow light sees.
const BOUNDS: usize = BOX + 8 * MAX_SHADOWS;
/// Cells of a line, of a plane and of the grid of the surroundings, at most.
pub(super) const LONGEST_LINE: usize = 44;
pub(super) const PLANE: usize = LONGEST_LINE * LONGEST_LINE;
pub(super) const CELLS: usize = LONGEST_LINE * PLANE;

/// The buffers that depend only on the groom and the body.
pub(super) struct Groom {
    /// With the lights behind it.
    pub frame: Buffer<Frame>,
    pub bounds: Buffer<u32>,
    /// Eight numbers a cell, of which six are used: see surroundings.wesl.
    pub cubes: Buffer<[f32; 4]>,
    pub areas: Buffer<u32>,
    /// Guide points \[m\], world space, `[block][point][component][lane]`.
    pub places: Buffer<f32>,
    pub roots: Buffer<Root>,
    /// Per guide: see tessellate.wesl. Behind them, where the groom has colours or widths along strands, one of each
    /// guide's points: colour and share of the largest width.
    pub clumps: Buffer<[f32; 4]>,
    pub triangles: Buffer<u32>,
    pub vertices: Buffer<Vertex>,
    /// Corners of a body with materials, and these: see surfaces.wesl.
    pub corners: Buffer<Corner>,
    pub surfaces: Buffer<u32>,
    /// True where the materials cut parts of the body away.
    pub cuts: bool,
    /// Per place in the order of depth: see sort.wesl.
    pub starts: Buffer<u32>,
    pub start_totals: Buffer<u32>,
}

impl Groom {
    pub fn new(gpu: &Gpu, guides: &Guides, skin: &Skin) -> Result<Self, GpuError> {
        let own: Vec<[f32; 4]> = own(guides).collect();
        let clumps = Buffer::new(gpu, "clumps", guides.strand_count() + own.len())?;
        clumps.write_at(guides.strand_count(), &own)?;
        let words = skin.surfaces().map_or(&[][..], |surfaces| &surfaces.words);
        Ok(Self {
            frame: Buffer::with_tail::<LightSource>(gpu, "frame and lights", 1, MAX_LIGHTS)?,
            triangles: Buffer::from_slice(gpu, "triangles", skin.corners())?,
            vertices: Buffer::from_slice(gpu, "vertices", &skin.vertices())?,
            corners: Buffer::from_slice(gpu, "corners with materials", &skin.painted_corners())?,
            surfaces: Buffer::from_slice(gpu, "materials and textures", words)?,
            cuts: skin.surfaces().is_some_and(|surfaces| surfaces.cuts),
            bounds: Buffer::new(gpu, "bounds", BOUNDS)?,
            cubes: Buffer::new(gpu, "surroundings", 2 * CELLS)?,
            areas: Buffer::new(gpu, "areas", CELLS)?,
            places: Buffer::from_slice(gpu, "guide points", floats(guides.positions()))?,
            roots: Buffer::from_slice(gpu, "roots", &roots(guides, |_| Quat::IDENTITY))?,
            clumps,
            starts: Buffer::new(gpu, "starts", ORDER_STEPS)?,
            start_totals: Scan::totals(gpu, ORDER_STEPS)?,
        })
    }

    /// Writes what the host knows of a frame; what the device found for the last one stays.
    pub fn write_frame(&self, scene: &Scene) -> Result<(), GpuError> {
        let frame = [Frame::new(scene)];
        let words: &[u32] = bytemuck::cast_slice(&frame);
        self.frame.viewed_as().write(&words[..std::mem::offset_of!(Frame, fitted) / size_of::<u32>()])?;
        self.frame.write_tail(&LightSource::all(scene))
    }

    /// Initial bounds: an empty box.
    pub fn no_bounds() -> Vec<u32> {
        let planes = std::iter::repeat_n([u32::MAX, u32::MAX, 0, 0], 2 * MAX_SHADOWS).flatten();
        [[u32::MAX; 3], [0; 3]].into_iter().flatten().chain(planes).collect()
    }
}

/// The roots of all strands, their axes turned in head space.
pub(super) fn roots(guides: &Guides, turn: impl Fn(usize) -> Quat) -> Vec<Root> {
    let spread = |guide: usize| guides.spreads().map_or(1.0, |spreads| spreads[guide]);
    let each = guides.root_normals().iter().zip(guides.widths()).enumerate();
    each.map(|(guide, (&normal, &width))| {
        let [first, second] = skin_axes(normal).map(|axis| (turn(guide) * axis).to_array());
        let normal = (turn(guide) * normal).to_array();
        Root { normal, width, first, spread: spread(guide), second, unused: 0.0 }
    })
    .collect()
}

/// Colour and share of the largest width at every guide point, where the groom has either.
fn own(guides: &Guides) -> impl Iterator<Item = [f32; 4]> + '_ {
    let (colors, profiles) = (guides.colors(), guides.profiles());
    let has_some = colors.is_some() || profiles.is_some();
    let count = if has_some { guides.strand_count() * guides.points_per_strand() } else { 0 };
    (0..count).map(move |point| {
        let [red, green, blue] = colors.map_or([0.0; 3], |all| all[point]);
        [red, green, blue, profiles.map_or(1.0, |all| all[point])]
    })
}

/// Lanes as the numbers that they are.
pub(super) fn floats(lanes: &[strandline_groom::Vec3Lanes]) -> &[f32] {
    bytemuck::cast_slice(lanes)
}

/// The buffers that grow with the strands drawn.
pub(super) struct Strands {
    /// Strands of a guide and points of a strand that there is room for.
    pub strands_per_guide: usize,
    pub curve_points: usize,
    pub tables: Buffer<Tap>,
    pub scales: Buffer<f32>,
    pub curves: Buffer<Curve>,
    /// Position \[m\] and diameter \[m\], shape `[strand][point]`.
    pub points: Buffer<[f32; 4]>,
    /// Half floats, shape `[strand][point]`.
    pub radiances: Buffer<[u32; 2]>,
    pub keys: Buffer<u32>,
    pub order: Buffer<u32>,
}

/// Most points that a picture draws: an index with its marks is one number.
pub(super) const MAX_POINTS: usize = 1 << 26;

impl Strands {
    pub fn new(
        gpu: &Gpu,
        guide_count: usize,
        strands_per_guide: usize,
        curve_points: usize,
    ) -> Result<Self, GpuError> {
        let strands = guide_count * strands_per_guide;
        let (points, segments) = (strands * curve_points, strands * (curve_points - 1));
        debug_assert!(points <= MAX_POINTS);
        Ok(Self {
            strands_per_guide,
            curve_points,
            points: Buffer::new(gpu, "points of all drawn strands", points)?,
            tables: Buffer::new(gpu, "curve tables", curve_points)?,
            scales: Buffer::new(gpu, "widths of follow strands", strands_per_guide)?,
            curves: Buffer::new(gpu, "curves", guide_count * curve_points)?,
            radiances: Buffer::new(gpu, "radiances", points)?,
            keys: Buffer::new(gpu, "keys of segments", segments)?,
            order: Buffer::new(gpu, "order of segments", segments)?,
        })
    }
}

/// The maps of the shadow lights.
pub(super) struct Maps {
    pub size: u32,
    pub shadows: usize,
    /// Four numbers a texel: see opacity_depth.wesl.
    pub texels: Buffer<[u32; 4]>,
    /// Depths of the body, rows of [`body_stride`].
    pub body: Buffer<f32>,
    pub body_depth: Texture,
}

impl Maps {
    pub fn new(gpu: &Gpu, size: u32, shadows: usize) -> Result<Self, GpuError> {
        let texels = shadows * (size * size) as usize;
        let stride = body_stride(size);
        Ok(Self {
            size,
            shadows,
            texels: Buffer::new(gpu, "the maps of all shadow lights", texels)?,
            body: Buffer::new(gpu, "depths of the body", shadows * (stride * size) as usize)?,
            body_depth: Texture::new(gpu, "depth of the body", [size; 2], DEPTH)?,
        })
    }
}

/// Targets of a picture.
pub(super) struct Targets {
    pub samples: Texture,
    /// One more than the number of the body's triangle that a sample shows, 0 for none.
    pub triangles: Texture,
    pub depth: Texture,
}

impl Targets {
    pub fn new(gpu: &Gpu, settings: &PictureSettings) -> Result<Self, RenderError> {
        let size = [settings.width, settings.height].map(|length| length * settings.supersampling);
        Ok(Self {
            samples: Texture::written(gpu, "samples", size, SAMPLES)?,
            triangles: Texture::new(gpu, "triangles of samples", size, TRIANGLES)?,
            depth: Texture::new(gpu, "depths of samples", size, DEPTH)?,
        })
    }
}
