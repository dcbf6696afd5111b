//! Shadows that keep still: texels stay where they are while hair and lights move a little.

use glam::{Quat, Vec3};
use strandline_checks::{On, law};
use strandline_render::cpu::{opacity_depth, opacity_layers};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{Light, LightKind, Look, Shadow};
use strandline_render::{Shadows, Strands};

use crate::opacity::{mop, renderer, shadows_in, strands};

const DIAMETER: f32 = 4e-4;

/// Shadow maps of one backend.
enum Maps {
    Cpu,
    Gpu(Box<GpuRenderer>),
}

impl Maps {
    fn new(on: &On) -> Self {
        match on {
            On::Cpu => Self::Cpu,
            On::Gpu(gpu) => Self::Gpu(renderer(gpu).into()),
        }
    }

    /// Share of a light that reaches points of hair, with maps of a number of texels per side.
    fn transmittances(&mut self, lines: &[Vec<Vec3>], light: &Light, size: u32, points: &[Vec3]) -> Vec<f32> {
        let strands: Strands = strands(lines, DIAMETER);
        let shadow = Shadow { map_size: size, ..Shadow::default() };
        let shadows = match self {
            Self::Cpu => {
                let mut shadows = Shadows::default();
                let lights = std::slice::from_ref(light);
                opacity_depth(&strands, None, lights, Vec3::ZERO, &shadow, &mut shadows);
                opacity_layers(&strands, &mut shadows);
                shadows
            }
            Self::Gpu(renderer) => {
                shadows_in(renderer, &strands, light, &Look { shadow, follow_strands: 1, ..Look::thesis() })
            }
        };
        let map = shadows.map(0).unwrap();
        points.iter().map(|&point| map.transmittance(point)).collect()
    }
}

/// Mean change from one frame to the next.
fn change(before: &[f32], after: &[f32]) -> f32 {
    before.iter().zip(after).map(|(before, after)| (after - before).abs()).sum::<f32>() / before.len() as f32
}

fn sun() -> Light {
    Light { kind: LightKind::Directional, position: Vec3::new(0.2, 1.0, 0.4), ..Light::default() }
}

law! {
    fn hair_at_rest_keeps_its_shadow_while_other_hair_moves(on) {
        let mut lines = mop(1500);
        let points = lines.concat();
        // One strand beside the others, whose tip goes out by 3 mm a frame.
        let aside = |reach: f32| (0..13).map(move |point| Vec3::new(0.2 + reach * point as f32 / 12.0, 0.1, 0.0));
        let mut maps = Maps::new(on);
        let mut last: Option<Vec<f32>> = None;
        for frame in 0..6 {
            lines.truncate(1500);
            lines.push(aside(0.05 + 0.003 * frame as f32).collect());
            let now = maps.transmittances(&lines, &sun(), 512, &points);
            if let Some(last) = &last {
                // The remaining change is rounding of places in another window: found up to 1.1e-5.
                let change = change(last, &now);
                assert!(change < 1e-3, "frame {frame}: {change}");
            }
            last = Some(now);
        }
    }
}

/// Hair that sways to the side, the more the lower it hangs, and breathes: some ten frames of slow motion,
/// 1 mm a frame at the tips.
fn swaying(lines: &[Vec<Vec3>], frame: usize) -> Vec<Vec<Vec3>> {
    let sway = |line: &Vec<Vec3>| -> Vec<Vec3> {
        let away = |(index, point): (usize, &Vec3)| {
            let share = index as f32 / 12.0;
            *point + Vec3::new(1.0, 0.0, 0.3 * point.z.signum()) * (1e-3 * share * share * frame as f32)
        };
        line.iter().enumerate().map(away).collect()
    };
    lines.iter().map(sway).collect()
}

law! {
    fn slow_hair_changes_its_shadow_slowly(on) {
        let rest = mop(1500);
        // Hair near the roots rests, and the shadow of the hair above it changes a little.
        let upper = |lines: &[Vec<Vec3>]| lines.iter().flat_map(|line| line[..5].to_vec()).collect::<Vec<_>>();
        let mut maps = Maps::new(on);
        let mut mean = |size: u32| {
            let frames: Vec<Vec<f32>> = (0..7)
                .map(|frame| {
                    let lines = swaying(&rest, frame);
                    maps.transmittances(&lines, &sun(), size, &upper(&lines))
                })
                .collect();
            frames.windows(2).map(|pair| change(&pair[0], &pair[1])).sum::<f32>() / 6.0
        };
        let (usual, fine) = (mean(512), mean(2048));
        // Finer maps tell single hairs apart and change more: found 0.009 against 0.023.
        assert!(usual < 0.5 * fine, "{usual}, with maps four times as fine {fine}");
    }
}

/// Changes of light from frame to frame, the least first, while a spot light goes a way; hair and way are turned.
fn lit_on_a_way(maps: &mut Maps, lines: &[Vec<Vec3>], way: &[Vec3], turn: Quat) -> Vec<f32> {
    let lines: Vec<Vec<Vec3>> =
        lines.iter().map(|line| line.iter().map(|&point| turn * point).collect()).collect();
    let (points, target) = (lines.concat(), turn * Vec3::new(0.0, 0.0, 0.01));
    let lit = |&position: &Vec3| {
        let light = Light { position: turn * position, target, ..Light::default() };
        maps.transmittances(&lines, &light, 256, &points)
    };
    let frames: Vec<Vec<f32>> = way.iter().map(lit).collect();
    let mut changes: Vec<f32> = frames.windows(2).map(|pair| change(&pair[0], &pair[1])).collect();
    changes.sort_by(f32::total_cmp);
    changes
}

law! {
    fn a_light_that_passes_a_pole_shades_without_a_jump(on) {
        let lines = mop(1500);
        // Over the head, from the front to the back beside it, and down the side of it: where frames of three
        // common kinds (about the height, about the depth, by the larger share) turn over.
        let over = |step: i32| {
            let turn = 0.2_f32.to_radians() * step as f32;
            Vec3::new(0.002, 1.5 * turn.cos(), 1.5 * turn.sin() + 0.01)
        };
        let beside = |step: i32| {
            let turn = 0.2_f32.to_radians() * step as f32;
            Vec3::new(1.2 * turn.cos(), 0.9, 1.2 * turn.sin() + 0.01)
        };
        let mut maps = Maps::new(on);
        for (name, way) in [("over", over as fn(i32) -> Vec3), ("beside", beside)] {
            let way: Vec<Vec3> = (-4..=4).map(way).collect();
            // The same hair in the same light, both laid on their side: no map turns for it.
            let [changes, laid] = [Quat::IDENTITY, Quat::from_rotation_x(std::f32::consts::FRAC_PI_2)]
                .map(|turn| lit_on_a_way(&mut maps, &lines, &way, turn));
            let (usual, most) = (changes[changes.len() / 2], changes[changes.len() - 1]);
            assert!(most < 1.5 * usual, "{name}: {most}, usually {usual}");
            assert!(usual < 1.5 * laid[laid.len() / 2], "{name}: {usual}, laid on the side {laid:?}");
        }
    }
}
