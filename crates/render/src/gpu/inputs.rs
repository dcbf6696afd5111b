//! The settings of a frame as the kernels read them.

use glam::Vec3;
use strandline_base::math;
use strandline_gpu::{Rigid, mirror};

use super::scene::Scene;
use super::{MAX_SHADOWS, codes};
use crate::fibre::{Pigment, scheuermann::Numbers};
use crate::level_of_detail::EveryFew;
use crate::shadow::LightView;
use crate::{LightKind, Look, ToneMap};

mirror! {
    /// Light that changes slowly with direction: see cpu/scatter/light_field.rs. Last numbers: the share of its width that a
    /// strand has at the skin; what skin is multiplied with where roots are dense.
    pub(super) struct Around {
        pub a: [f32; 4],
        pub bx: [f32; 4],
        pub by: [f32; 4],
        pub bz: [f32; 4],
        pub xx: [f32; 4],
        pub yy: [f32; 4],
        pub xy: [f32; 4],
        pub xz: [f32; 4],
        pub yz: [f32; 4],
    }
}

impl Around {
    fn new(look: &Look, scalp: Vec3) -> Self {
        let mut parts = look.around();
        let last = [look.root_width, scalp.x, scalp.y, scalp.z];
        parts.iter_mut().zip(last).for_each(|(part, last)| part.w = last);
        let [a, bx, by, bz, xx, yy, xy, xz, yz] = parts.map(|part| part.to_array());
        Self { a, bx, by, bz, xx, yy, xy, xz, yz }
    }
}

mirror! {
    /// Mirrors `Frame` in common.wesl; the lights lie behind it.
    pub(super) struct Frame {
        pub world_from_head: Rigid,
        pub view_from_world: Rigid,
        /// Light from all around.
        pub around: Around,
        /// \[m\]
        pub eye: [f32; 3],
        /// Between the two buffers of guide points, 0 to 1.
        pub share: f32,
        /// \[sample\]
        pub size: [f32; 2],
        /// \[sample\]
        pub focal: f32,
        /// \[m\]
        pub near: f32,
        pub sky: [f32; 3],
        pub tip_width: f32,
        pub ground: [f32; 3],
        pub lift: f32,
        pub root_color: [f32; 3],
        pub variation: f32,
        pub tip_color: [f32; 3],
        pub grey: f32,
        /// Shift, sharpness and peak: see fibre/scheuermann.
        pub first_lobe: [f32; 3],
        /// Greatest shift of the highlights along a strand, as a sum of sines.
        pub jitter: f32,
        pub second_lobe: [f32; 3],
        pub sparkle: f32,
        pub body_color: [f32; 3],
        pub body_wrap: f32,
        pub background_top: [f32; 3],
        pub body_specular: f32,
        pub background_bottom: [f32; 3],
        pub body_roughness: f32,
        /// Ends of the opacity layers \[m\].
        pub layers: [f32; 3],
        /// Logarithm of what one hair lets through.
        pub log_transmission: f32,
        /// \[m\]
        pub body_bias: f32,
        /// \[1/m\]
        pub inverse_softness: f32,
        pub translucency: f32,
        /// Share of light that is scattered as diffuse.
        pub diffuse: f32,
        /// \[m\]
        pub wave_amplitude: f32,
        /// \[m\]
        pub wave_length: f32,
        pub shorter: f32,
        /// Diameter of a drawn strand over that of a hair, at full detail.
        pub widening: f32,
        pub seed: u32,
        pub guide_count: u32,
        pub guide_points: u32,
        pub curve_points: u32,
        pub strands_per_guide: u32,
        pub full_strands: u32,
        pub light_count: u32,
        pub shadow_count: u32,
        pub map_size: u32,
        /// Texels from a row of the body's depths to the next.
        pub body_stride: u32,
        pub vertex_count: u32,
        pub triangle_count: u32,
        /// Exposure as a factor.
        pub gain: f32,
        pub supersampling: u32,
        /// 0 off, 1 filmic, 2 of ACES.
        pub tone_map: u32,
        /// See codes.rs.
        pub body_kind: u32,
        /// Middle of the hair at rest \[m\]: texels and cells keep their places beside it.
        pub middle: [f32; 3],
        /// Drawn attributes, in bits: see codes.rs.
        pub kinds: u32,
        /// Of each eight guides, those whose strands are not drawn.
        pub left_out: f32,
        /// Number of strands that each summed strand stands for in the cells of scattered light.
        pub summed: u32,
        /// Cells along the longest side of the hair.
        pub cells: u32,
        /// Share of the skin's highlight that is as narrow as that of oil.
        pub body_oil: f32,
        /// Mean colour of the body.
        pub reflected: [f32; 3],
        /// Reach of red light in skin around the edge of shadow.
        pub body_softness: f32,
        pub fitted: Fitted,
        then lights: LightSource,
    }
}

/// Windows of maps: two for each light with shadow.
const WINDOWS: usize = 2 * MAX_SHADOWS;

mirror! {
    /// Places in a frame, found by the device. Mirrors `Fitted` in common.wesl.
    pub(super) struct Fitted {
        /// Least corner of the grid of `occlude` \[m\].
        pub low: [f32; 3],
        /// Size of a cell \[m\].
        pub cell: f32,
        /// Cells along x, y and z.
        pub counts: [f32; 3],
        /// Bits of the least inverse depth of the hair \[1/m\].
        pub farthest: f32,
        /// Places in the order of depth in one of these bits.
        pub places: f32,
        pub unused_a: f32,
        pub unused_b: f32,
        pub unused_c: f32,
        /// Of the maps of each shadow light, of hair and of the body: least plane coordinates, texels in a plane unit.
        pub windows: [[f32; 4]; WINDOWS],
    }
}

/// As resolve.wesl has it.
fn tone_map_code(tone_map: ToneMap) -> u32 {
    match tone_map {
        ToneMap::Off => codes::TONE_OFF,
        ToneMap::Filmic => codes::TONE_FILMIC,
        ToneMap::Aces => codes::TONE_ACES,
    }
}

mirror! {
    /// Mirrors `LightSource` in common.wesl.
    pub(super) struct LightSource {
        /// \[m\]
        pub position: [f32; 3],
        /// 0 directional, 1 spot, 2 point, 3 a place on a surface.
        pub kind: u32,
        /// Unit direction from the target to the light.
        pub axis: [f32; 3],
        /// Square of the distance to the target \[m^2\].
        pub axis_square: f32,
        pub radiance: [f32; 3],
        /// Number among the lights with shadows, [`NO_MAP`] for none.
        pub slot: u32,
        pub right: [f32; 3],
        /// Greatest coordinate on the plane that the light reaches.
        pub reach: f32,
        pub up: [f32; 3],
        /// Cosine at the rim of the cone.
        pub rim: f32,
        pub forward: [f32; 3],
        /// Cosine within which the cone is at its full.
        pub full: f32,
        /// Least depth that the map of the body holds, and how much more it can \[m\].
        pub first_depth: f32,
        pub depth_range: f32,
        /// The light that is shadow light number (place of this element).
        pub caster: u32,
        /// One over `depth_range` \[1/m\].
        pub depth_scale: f32,
        /// Sides of the part that it stands for, along right and up, of both \[m\].
        pub part: [f32; 4],
        /// Places of its light, of which it is one; those of a light follow each other.
        pub places: u32,
        /// Area of that part \[m^2\].
        pub area: f32,
        /// Rays of a place of skin to each.
        pub rays: u32,
        pub unused_last: u32,
    }
}

/// Texels from a row of the body's depths to the next: copies of textures have rows of whole 256 bytes.
pub(super) fn body_stride(map_size: u32) -> u32 {
    map_size.next_multiple_of(64)
}

/// No shadow.
pub(super) const NO_MAP: u32 = u32::MAX;

impl Frame {
    /// Inputs of a frame.
    pub fn new(scene: &Scene) -> Self {
        let Scene { input, settings, level, .. } = scene;
        let (width, height) = (settings.width as f32, settings.height as f32);
        let (scale, map_size) = (settings.supersampling as f32, input.look.shadow.size());
        Self {
            world_from_head: Rigid::from(&input.body.world_from_head()),
            view_from_world: Rigid::from(&input.camera.view_from_world()),
            eye: input.camera.position.to_array(),
            share: scene.share,
            size: [width * scale, height * scale],
            focal: 0.5 * height * scale * input.camera.focal(),
            near: input.camera.near,
            background_top: settings.background.top.to_array(),
            background_bottom: settings.background.bottom.to_array(),
            widening: crate::strands::clump::widening(input.look, scene.hair_strands),
            guide_count: scene.guide_count as u32,
            guide_points: scene.guide_points as u32,
            curve_points: scene.curve_points() as u32,
            strands_per_guide: level.strand_count() as u32,
            full_strands: level.full_follow_strands as u32,
            light_count: input.lights.len() as u32,
            shadow_count: scene.shadow_count() as u32,
            map_size,
            body_stride: body_stride(map_size),
            vertex_count: scene.vertex_count as u32,
            triangle_count: scene.triangle_count as u32,
            gain: math::exp2(settings.exposure),
            supersampling: settings.supersampling,
            tone_map: tone_map_code(settings.tone_map),
            body_kind: scene.body_kind,
            middle: scene.middle.to_array(),
            left_out: level.left_out,
            summed: EveryFew::of(scene.full_count()).stands_for(),
            ..Self::of_looks(scene)
        }
    }

    /// Inputs that follow from the looks of hair and body; the others are 0.
    fn of_looks(scene: &Scene) -> Self {
        let (look, body, shadow) = (scene.input.look, scene.input.body_look, &scene.input.look.hair_shadow());
        let gradient = look.gradient();
        let Numbers { highlights: [first_lobe, second_lobe], diffuse, translucency } =
            look.fibre.scheuermann.numbers();
        Self {
            around: Around::new(look, look.scalp(body.scalp, scene.own_color)),
            sky: gradient.sky.to_array(),
            tip_width: look.tip_width,
            ground: gradient.ground.to_array(),
            lift: look.clump.lift,
            root_color: look.root_color.to_array(),
            variation: look.variation,
            tip_color: look.tip_color.to_array(),
            grey: look.grey,
            first_lobe,
            jitter: 2.0 * look.highlight_noise.to_radians(),
            second_lobe,
            sparkle: look.fibre.scheuermann.sparkle,
            body_color: body.color.to_array(),
            body_wrap: body.wrap,
            body_softness: body.softness,
            body_oil: body.oil,
            body_specular: body.specular,
            body_roughness: body.roughness,
            layers: shadow.layers,
            log_transmission: shadow.log_transmission(),
            body_bias: shadow.body_bias,
            inverse_softness: 1.0 / shadow.body_softness,
            translucency,
            diffuse,
            wave_amplitude: look.clump.wave_amplitude,
            wave_length: look.clump.wave_length,
            shorter: look.clump.shorter,
            seed: look.seed,
            cells: look.fibre.grid_cells(),
            reflected: scene.reflected.to_array(),
            kinds: scene.own
                | scene.paint
                | if look.fibre.model.scatters_many_times() { codes::SCATTERS } else { 0 }
                | if look.fibre.chiang.pigment == Pigment::Color { codes::COLORED } else { 0 },
            ..bytemuck::Zeroable::zeroed()
        }
    }
}

impl LightSource {
    /// The lights of a frame; those with shadow are numbered in their order.
    pub fn all(scene: &Scene) -> Vec<Self> {
        let (center, radius) = scene.body_ball;
        let center = scene.input.body.world_from_head().point(center);
        let mut slot = 0;
        let mut casters = Vec::new();
        let mut sources = Vec::new();
        for (index, light) in scene.input.lights.iter().enumerate() {
            let view = LightView::new(light, scene.middle);
            let depth = (center - view.origin).dot(view.forward) - radius;
            let [rim, full] = light.cone_cosines();
            let axis = light.position - light.target;
            let mut source = Self {
                position: light.position.to_array(),
                kind: match light.kind {
                    LightKind::Directional => codes::DIRECTIONAL,
                    LightKind::Spot => codes::SPOT,
                    LightKind::Point => codes::POINT,
                    LightKind::Rectangle | LightKind::Disc => codes::SURFACE,
                },
                axis: axis.normalize_or(Vec3::Y).to_array(),
                axis_square: axis.length_squared(),
                radiance: (light.color * light.intensity).to_array(),
                slot: NO_MAP,
                right: view.right.to_array(),
                reach: view.reach.min(f32::MAX),
                up: view.up.to_array(),
                rim,
                forward: view.forward.to_array(),
                full,
                first_depth: depth,
                depth_range: (2.0 * radius).max(1e-3),
                caster: 0,
                depth_scale: 1.0 / (2.0 * radius).max(1e-3),
                part: {
                    let [across, along] = view.part;
                    [across.x, across.y, along.x, along.y]
                },
                places: light.sample_count() as u32,
                area: light.part_area(),
                rays: scene.input.look.shadow.rays_of(light.sample_count()) as u32,
                unused_last: 0,
            };
            if light.shadow {
                source.slot = slot;
                casters.push(index as u32);
                slot += 1;
            }
            sources.push(source);
        }
        for (source, caster) in sources.iter_mut().zip(casters) {
            source.caster = caster;
        }
        sources
    }
}
