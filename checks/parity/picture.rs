//! The stages before a picture is drawn, on both backends.

use glam::{Quat, Vec3, Vec4};
use strandline_body::{BodyFrame, Mannequin, Mesh, Pose};
use strandline_checks::gpu;
use strandline_groom::{Guides, Style, StyleSettings, Widths};
use strandline_render::cpu::shadow::layer_colors::{LAYER_COLORS, layer_colors};
use strandline_render::cpu::{
    Curves, Occlusion, ShadowBody, interpolate, opacity_depth, opacity_layers, shade, tessellate,
};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, DetailLevel, FrameInput, LevelOfDetail, Light, LightKind, Look, PictureSettings,
};
use strandline_render::{Shadow, Shadows, Strands};

/// Guides, and texels along the sides of shadow maps. Both and the triangles of the body are fewer than in pictures:
/// a software adapter spends its time in them, and both backends differ in few as in many.
const STRANDS: usize = 100;
const MAP: u32 = 256;

/// All inputs of a picture, and the results of both backends.
pub(crate) struct Both {
    pub(crate) guides: Guides,
    pub(crate) mesh: Mesh,
    pub(crate) body: BodyFrame,
    pub(crate) look: Look,
    pub(crate) lights: Vec<Light>,
    pub(crate) camera: Camera,
    detail: LevelOfDetail,
    pub(crate) settings: PictureSettings,
}

impl Both {
    pub(crate) fn new(style: Style, points: usize) -> Self {
        let groom = StyleSettings { strand_count: STRANDS, ..StyleSettings::new(style) }.grow().unwrap();
        let camera = Camera::three_quarter();
        let mut lights = Light::three_point(camera.target).to_vec();
        lights.push(Light {
            kind: LightKind::Point,
            position: Vec3::new(0.5, 0.1, 0.6),
            intensity: 0.2,
            ..Light::default()
        });
        lights.push(Light { kind: LightKind::Directional, intensity: 0.3, ..lights[0] });
        Self {
            guides: Guides::resample(&groom, points).unwrap(),
            mesh: Mannequin::new().coarse_mesh(3.0),
            // Turned, so that head and world space differ.
            body: Pose { rotation: Quat::from_rotation_y(0.4), translation: Vec3::new(0.02, -0.01, 0.03) }
                .into(),
            look: Look {
                grey: 0.2,
                shadow: Shadow { map_size: MAP, ..Look::thesis().shadow },
                ..Look::thesis()
            },
            lights,
            camera,
            // All that a picture of common size draws: these are small.
            detail: LevelOfDetail { by_pixel: false, ..LevelOfDetail::default() },
            settings: PictureSettings::sized(160, 160),
        }
    }

    /// The same of a groom with colours and widths of its own, which change along its strands.
    pub(crate) fn colored() -> Self {
        let both = Self::new(Style::Bob, 12);
        let mut groom =
            StyleSettings { strand_count: STRANDS, ..StyleSettings::new(Style::Bob) }.grow().unwrap();
        let count = groom.points.len();
        let number = |point: usize, step: f32| (step * point as f32).fract();
        groom.widths =
            Widths::PerPoint((0..count).map(|point| 1e-4 * (0.2 + number(point, 0.618))).collect());
        groom.colors =
            Some((0..count).map(|point| [0.31, 0.57, 0.73].map(|step| number(point, step))).collect());
        Self { guides: Guides::resample(&groom, 12).unwrap(), ..both }
    }

    /// Guide points as they hang at rest from the head's pose.
    pub(crate) fn positions(&self) -> Vec<strandline_groom::Vec3Lanes> {
        let mut placed = self.guides.positions().to_vec();
        for lanes in &mut placed {
            for lane in 0..strandline_groom::LANES {
                lanes.set(lane, self.body.world_from_head().point(lanes.get(lane)));
            }
        }
        placed
    }

    pub(crate) fn input<'a>(&'a self, positions: &'a [strandline_groom::Vec3Lanes]) -> FrameInput<'a> {
        FrameInput {
            positions,
            body: &self.body,
            camera: &self.camera,
            look: &self.look,
            body_look: const {
                &BodyLook {
                    materials: true,
                    color: Vec3::splat(0.3),
                    wrap: 0.2,
                    softness: 0.4,
                    oil: 0.3,
                    specular: 0.03,
                    roughness: 0.5,
                    scalp: 0.7,
                }
            },
            lights: &self.lights,
            level_of_detail: &self.detail,
        }
    }

    pub(crate) fn level(&self) -> DetailLevel {
        let distance = self.camera.position.distance(self.middle());
        self.detail.level(distance, self.look.follow_strands)
    }

    pub(crate) fn middle(&self) -> Vec3 {
        let all = |f: fn(Vec3, Vec3) -> Vec3, start: Vec3| {
            let count = self.guides.points_per_strand();
            (0..self.guides.strand_count())
                .flat_map(|strand| (0..count).map(move |point| (strand, point)))
                .fold(start, |known, (strand, point)| f(known, self.guides.position(strand, point)))
        };
        self.body.world_from_head().point(0.5 * (all(Vec3::min, Vec3::MAX) + all(Vec3::max, Vec3::MIN)))
    }

    /// Result of the CPU's stages up to `shade`, without a body's shadow.
    fn on_cpu(&self, positions: &[strandline_groom::Vec3Lanes]) -> (Curves, Strands, Shadows) {
        self.shadowed_on_cpu(positions, None)
    }

    fn shadowed_on_cpu(
        &self,
        positions: &[strandline_groom::Vec3Lanes],
        body: Option<ShadowBody>,
    ) -> (Curves, Strands, Shadows) {
        let (mut curves, mut strands, mut shadows) =
            (Curves::default(), Strands::default(), Shadows::default());
        let level = self.level();
        tessellate(positions, &self.guides, &self.body.world_from_head(), &level, &mut curves);
        interpolate(&curves, &self.guides, &self.body.world_from_head(), &self.look, &level, &mut strands);
        opacity_depth(&strands, body, &self.lights, self.middle(), &self.look.shadow, &mut shadows);
        opacity_layers(&strands, &mut shadows);
        let mut occlusion = Occlusion::default();
        occlusion.set_grid(self.middle(), self.look.fibre.chiang.cells);
        shade(&mut strands, &shadows, &self.lights, &self.look, self.camera.position, &mut occlusion);
        (curves, strands, shadows)
    }
}

pub(crate) fn drawn_on_gpu(
    both: &Both,
    positions: &[strandline_groom::Vec3Lanes],
    body: bool,
) -> Option<GpuRenderer> {
    let gpu = gpu()?;
    let mesh = body.then_some(&both.mesh);
    let mut renderer = GpuRenderer::new(&gpu, &both.guides, mesh, &both.settings).unwrap();
    renderer.draw(&both.input(positions)).unwrap();
    Some(renderer)
}

fn greatest(pairs: impl Iterator<Item = (Vec3, Vec3)>) -> f32 {
    pairs.fold(0.0, |most, (one, other)| most.max((one - other).abs().max_element()))
}

/// Twice the size of a head [m]: the unit of 1e-6.
const SIZE: f32 = 0.5;

#[test]
fn tessellate_agrees_in_place_tangent_and_frame() {
    for (style, points) in [(Style::Long, 16), (Style::Curly, 24), (Style::Pixie, 4)] {
        let both = Both::new(style, points);
        let positions = both.positions();
        let Some(renderer) = drawn_on_gpu(&both, &positions, false) else { return };
        let (curves, ..) = both.on_cpu(&positions);
        let count = curves.points_per_curve;
        let found = renderer.curves().unwrap();
        // Frames are carried from point to point: their rounding adds up. An H200 is 3.1e-6 off in a tangent
        // of curls.
        for (which, bound) in [1e-6 * SIZE, 5e-6, 1e-5].into_iter().enumerate() {
            let all = (0..curves.guide_count).flat_map(|guide| (0..count).map(move |point| (guide, point)));
            let expected = all.map(|(guide, point)| curves.point(guide, point)[which]);
            assert_eq!(found[which].len(), curves.guide_count * count);
            let off = greatest(expected.zip(found[which].iter().copied()));
            assert!(off <= bound, "{style:?}: {which} is off by {off}");
        }
    }
}

#[test]
fn interpolate_agrees_in_place_and_width() {
    for (style, distance) in [(Style::Wavy, 1.0), (Style::Curly, 4.3), (Style::Bob, 9.0)] {
        let mut both = Both::new(style, 12);
        // Farther away fewer follow strands are drawn, the last of them thinner.
        both.camera.position = both.camera.target + distance * Vec3::new(0.6, 0.2, 0.7).normalize();
        // Hair of the face, which has hairs of its own, beside some bobs.
        both.guides.set_beside(if style == Style::Bob { STRANDS / 4 } else { 0 }).unwrap();
        let positions = both.positions();
        let Some(renderer) = drawn_on_gpu(&both, &positions, false) else { return };
        let (_, strands, _) = both.on_cpu(&positions);
        let found = renderer.strands().unwrap();
        assert_eq!(found.positions.len(), strands.positions.len());
        let off = greatest(strands.positions.iter().copied().zip(found.positions.iter().copied()));
        assert!(off <= 1e-6 * SIZE, "{style:?}: off by {off} m");
        for (expected, width) in strands.widths.iter().zip(&found.widths) {
            assert!((width - expected).abs() <= 1e-6 * expected, "{width} and {expected}");
        }
    }
}

/// Checks both opacity stages of every shadow light. Where rounding moves a piece of hair to the texel
/// beside, two texels differ: some ten of 30,000 do.
fn check_maps(both: &Both, check: impl Fn(&[Vec4], &[Vec4])) {
    let positions = both.positions();
    let Some(renderer) = drawn_on_gpu(both, &positions, false) else { return };
    let (.., shadows) = both.on_cpu(&positions);
    let maps: Vec<_> = (0..both.lights.len()).filter_map(|light| shadows.map(light)).collect();
    assert_eq!(maps.len(), 4);
    for (slot, map) in maps.into_iter().enumerate() {
        check(map.texels(), &renderer.opacity_texels(slot).unwrap());
    }
}

#[test]
fn opacity_depth_agrees_texel_by_texel() {
    check_maps(&Both::new(Style::Wavy, 16), |expected, found| {
        assert_eq!(expected.len(), found.len());
        let off = expected.iter().zip(found).filter(|(one, other)| (one.w - other.w).abs() > 1e-6).count();
        let filled = expected.iter().filter(|texel| texel.w < 1e3).count();
        assert!(filled > 10_000 && off * 1000 <= filled, "{off} of {filled}");
    });
}

#[test]
fn opacity_layers_agree_texel_by_texel() {
    check_maps(&Both::new(Style::Wavy, 16), |expected, found| {
        let layers = |texel: &Vec4| texel.truncate();
        let all: f32 = expected.iter().map(|texel| layers(texel).element_sum()).sum();
        let off: f32 = expected
            .iter()
            .zip(found)
            .map(|(one, other)| (layers(one) - layers(other)).abs().element_sum())
            .sum();
        assert!(all > 1e5 && off <= 1e-3 * all, "{off} of {all}");
    });
}

#[test]
fn shade_agrees_point_by_point() {
    for style in [Style::Long, Style::Curly] {
        let both = Both::new(style, 16);
        let positions = both.positions();
        let Some(renderer) = drawn_on_gpu(&both, &positions, false) else { return };
        let (_, strands, _) = both.on_cpu(&positions);
        let found = renderer.strands().unwrap().radiances;
        let all: f32 = strands.radiances.iter().map(|radiance| radiance.element_sum()).sum();
        let pairs = strands.radiances.iter().zip(&found);
        let off: f32 = pairs.clone().map(|(one, other)| (*one - *other).abs().element_sum()).sum();
        // Half floats round by 2.4e-4 of the value at most, by half of that in the mean.
        assert!(off <= 5e-4 * all, "{style:?}: {off} of {all}");
        // A texel that differs changes the light by that of one hair.
        let worst = pairs.filter(|(one, other)| (**one - **other).abs().max_element() > 0.01).count();
        assert!(worst * 10_000 <= found.len(), "{style:?}: {worst} of {}", found.len());
    }
}

#[test]
fn colours_and_widths_of_the_groom_are_drawn_alike() {
    let both = Both::colored();
    let positions = both.positions();
    let (_, strands, _) = both.on_cpu(&positions);
    let plain = Both::new(Style::Bob, 12);
    let (_, of_look, _) = plain.on_cpu(&positions);
    let change = |one: f32, other: f32| (one - other).abs() > 0.1 * other;
    let thinner =
        strands.widths.iter().zip(&of_look.widths).filter(|(one, other)| change(**one, **other)).count();
    assert!(thinner * 2 > strands.widths.len(), "the groom's widths count: {thinner}");
    let green = |strands: &Strands| strands.radiances.iter().map(|radiance| radiance.y).sum::<f32>();
    assert!(change(green(&strands), green(&of_look)), "the groom's colours count");
    let Some(renderer) = drawn_on_gpu(&both, &positions, false) else { return };
    let found = renderer.strands().unwrap();
    for (expected, width) in strands.widths.iter().zip(&found.widths) {
        // Shares of 1 are mixed, then multiplied: four roundings.
        assert!((width - expected).abs() <= 4e-6 * expected.max(1e-6), "{width} and {expected}");
    }
    let all: f32 = strands.radiances.iter().map(|radiance| radiance.element_sum()).sum();
    let pairs = strands.radiances.iter().zip(&found.radiances);
    let off: f32 = pairs.map(|(one, other)| (*one - *other).abs().element_sum()).sum();
    // Half floats of colours, then of radiances: each rounds by 1.2e-4 of the value in the mean.
    assert!(off <= 1e-3 * all, "{off} of {all}");
}

#[test]
fn shade_agrees_in_the_shadow_of_the_body() {
    let mut both = Both::new(Style::Wavy, 12);
    // Rows of the body's depths are longer than those of the map.
    both.look.shadow.map_size = 300;
    let positions = both.positions();
    let Some(mut renderer) = drawn_on_gpu(&both, &positions, true) else { return };
    let placed: Vec<Vec3> =
        both.mesh.positions.iter().map(|&point| both.body.world_from_head().point(point)).collect();
    // Another size of the maps in the same renderer, and back.
    for map_size in [300, 128, 300] {
        both.look.shadow.map_size = map_size;
        let body = ShadowBody { positions: &placed, triangles: &both.mesh.triangles, roots: &[], cuts: None };
        let (_, strands, shadows) = both.shadowed_on_cpu(&positions, Some(body));
        renderer.draw(&both.input(&positions)).unwrap();
        let found = renderer.strands().unwrap().radiances;
        let dark = strands
            .positions
            .iter()
            .filter(|&&point| shadows.map(0).is_some_and(|map| map.body_visibility(point) < 0.5));
        assert!(dark.count() * 10 > strands.positions.len(), "the head shades its hair");
        let all: f32 = strands.radiances.iter().map(|radiance| radiance.element_sum()).sum();
        let pairs = strands.radiances.iter().zip(&found);
        let off: f32 = pairs.map(|(one, other)| (*one - *other).abs().element_sum()).sum();
        // As above; outlines of the head fall on one texel or the next.
        assert!(off <= 2e-3 * all, "{map_size}: {off} of {all}");
    }
}

#[test]
fn shade_agrees_on_the_colours_of_layers() {
    // Small, since only points are compared.
    let both = Both { settings: PictureSettings::sized(16, 16), ..Both::new(Style::Wavy, 12) };
    let positions = both.positions();
    let Some(mut renderer) = drawn_on_gpu(&both, &positions, false) else { return };
    let lit = renderer.strands().unwrap().radiances;
    let (_, strands, shadows) = both.on_cpu(&positions);
    let mut colored = |light| {
        renderer.show_layers(Some(light));
        renderer.draw(&both.input(&positions)).unwrap();
        renderer.strands().unwrap().radiances
    };
    // Half floats round by 2.4e-4 of a colour's components; colours differ by 0.15 and more.
    let off = |one: &[Vec3], other: &[Vec3]| {
        one.iter().zip(other).filter(|(one, other)| (**one - **other).abs().max_element() > 1e-3).count()
    };
    for light in [0, 3, 4] {
        let mut expected = strands.clone();
        layer_colors(&mut expected, shadows.map(light).unwrap());
        let found = colored(light);
        // A point that lies on the border of a layer or of a texel to the last bit may fall to either side.
        let different = off(&expected.radiances, &found);
        assert!(different * 1000 <= found.len(), "{light}: {different} of {}", found.len());
        for color in &LAYER_COLORS[..3] {
            let count = expected.radiances.iter().filter(|found| *found == color).count();
            assert!(count * 100 > found.len(), "light {light} shows {count} points in {color}");
        }
        assert!(off(&lit, &found) * 2 > found.len(), "light {light} still lights");
    }
    let [first, last] = [0, 4].map(&mut colored);
    assert!(off(&first, &last) * 100 > first.len(), "two lights have the same layers");
    assert_eq!(off(&lit, &colored(2)), 0, "a light without shadow has no layers");
}

#[test]
fn interpolate_fills_more_than_a_row_of_workgroups() {
    let mut both = Both::new(Style::Pixie, 16);
    // 100 x 768 strands of 61 points: more than 65,535 workgroups of 64.
    both.look.follow_strands = 768;
    both.lights.truncate(1);
    both.settings = PictureSettings::sized(16, 16);
    let positions = both.positions();
    let Some(renderer) = drawn_on_gpu(&both, &positions, false) else { return };
    let (_, strands, _) = both.on_cpu(&positions);
    assert!(strands.positions.len() > 64 * 65_535);
    let found = renderer.strands().unwrap();
    let off = greatest(strands.positions.iter().copied().zip(found.positions.iter().copied()));
    assert!(off <= 1e-6 * SIZE, "off by {off} m");
}

#[test]
fn interpolate_refuses_more_points_than_the_device_holds() {
    let mut both = Both::new(Style::Bob, 24);
    let positions = both.positions();
    let Some(mut renderer) = drawn_on_gpu(&both, &positions, false) else { return };
    both.look.follow_strands = 1024;
    // 100 guides of 1,024 strands of 93 points: 152 MB, more than the 128 MiB of a binding.
    let error = renderer.draw(&both.input(&positions)).unwrap_err().to_string();
    assert!(error.contains("points of all drawn strands") && error.contains("134217728"), "{error}");
    both.look.follow_strands = 4;
    renderer.draw(&both.input(&positions)).unwrap();
}
