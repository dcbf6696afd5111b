//! `resolve` on both backends: samples become the 8 bits of a picture.

use glam::{Vec2, Vec3};
use strandline_body::Mesh;
use strandline_checks::law;
use strandline_render::{Background, Camera, Environment, LevelOfDetail, Look, PictureSettings, ToneMap};

use crate::drawn::{Drawn, guides};
use crate::terms::plain;

const SIZE: u32 = 48;

/// Straight strands, less than a pixel wide, that cross each other, all of one radiance: wider ones are drawn round.
fn crossing(radiance: Vec3) -> Drawn {
    let lines = (0..5).map(|strand| {
        let (sine, cosine) = (0.3 + 0.7 * strand as f32).sin_cos();
        let (way, at) = (Vec3::new(cosine, sine, 0.0), Vec3::new(0.003 * strand as f32 - 0.006, 0.002, 0.0));
        vec![at - 0.012 * way, at + 0.012 * way]
    });
    // Unhidden surroundings: a white hair shows them as they are.
    let look = Look {
        environment: Environment { sky: Vec3::ONE, ground: Vec3::ONE },
        width_scale: 10.0,
        ..plain(radiance)
    };
    let detail = LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() };
    Drawn { guides: guides(lines, 4), look, lights: Vec::new(), eye: Vec3::Z * 0.1, detail }
}

/// A square picture with opacity and without a tone map.
fn transparent(size: u32, supersampling: u32) -> PictureSettings {
    PictureSettings {
        transparent: true,
        supersampling,
        tone_map: ToneMap::Off,
        ..PictureSettings::sized(size, size)
    }
}

law! {
    fn a_pixel_is_the_mean_of_five_places(on) {
        let drawn = crossing(Vec3::splat(0.9));
        // With one sample a pixel, a picture twice as large shows the samples.
        let samples = drawn.picture(on, &transparent(2 * SIZE, 1)).alpha.unwrap();
        let found = drawn.picture(on, &transparent(SIZE, 2)).alpha.unwrap();
        let sample = |column: i32, row: i32| {
            let inside = |at: i32| at.clamp(0, 2 * SIZE as i32 - 1) as usize;
            f32::from(samples[inside(row) * 2 * SIZE as usize + inside(column)])
        };
        // A place is the corner of four samples.
        let place = |x: i32, y: i32| {
            0.25 * (sample(x - 1, y - 1) + sample(x, y - 1) + sample(x - 1, y) + sample(x, y))
        };
        let mut partly = 0;
        for (pixel, &alpha) in found.iter().enumerate() {
            // [Chen2011 §3.5]: the middle, and four places a sample away from it along the diagonals.
            let (x, y) = (2 * (pixel as i32 % SIZE as i32) + 1, 2 * (pixel as i32 / SIZE as i32) + 1);
            let corners = place(x - 1, y - 1) + place(x + 1, y - 1) + place(x - 1, y + 1) + place(x + 1, y + 1);
            let expected = 0.5 * place(x, y) + 0.125 * corners;
            // Samples and pixel are rounded by half a step each; half floats add a tenth.
            assert!((f32::from(alpha) - expected).abs() < 1.2, "pixel {pixel}: {alpha}, expected {expected}");
            partly += usize::from((20..235).contains(&alpha));
        }
        assert!(partly > 100, "{partly} pixels are half covered");
    }
}

law! {
    fn half_covered_pixels_have_the_colour_of_their_hair(on) {
        // 128, 90 and 188 in sRGB.
        let color = [128, 90, 188];
        let picture = crossing(Vec3::from(color.map(linear))).picture(on, &transparent(SIZE, 2));
        let (mut partly, alpha) = (0, picture.alpha.unwrap());
        for (pixel, (found, &alpha)) in picture.pixels.as_chunks::<3>().0.iter().zip(&alpha).enumerate() {
            if alpha < 8 {
                continue;
            }
            // Colour and opacity are half floats, which are divided: 5e-4 of the light, a tenth of a step, and more
            // where strands lie over each other.
            let off = found.iter().zip(color).map(|(&found, color)| found.abs_diff(color)).max();
            assert!(off <= Some(1), "pixel {pixel} of opacity {alpha}: {found:?}, expected {color:?}");
            partly += usize::from((20..235).contains(&alpha));
        }
        assert!(partly > 100, "{partly} pixels are half covered");
    }
}

law! {
    fn light_is_written_as_srgb(on) {
        for bytes in [[0, 3, 10], [25, 60, 90], [128, 188, 255]] {
            let light = Vec3::from(bytes.map(linear));
            let background = Background { top: light, bottom: light };
            let settings = PictureSettings { transparent: false, background, ..transparent(SIZE, 2) };
            let picture = crossing(Vec3::ZERO).picture(on, &settings);
            // No hair is near the corner. Light is rounded by a quarter of a step at most, in half floats or a table.
            assert_eq!(picture.pixels[..3], bytes, "{light}");
        }
    }
}

law! {
    fn edges_of_a_body_cover_samples_by_share(on) {
        // Seven straight edges before the eye, of as many slopes; hair behind the eye.
        let hair = vec![Vec3::Z, Vec3::new(0.0, 0.01, 1.0)];
        let drawn = Drawn { guides: guides([hair], 4), ..crossing(Vec3::ZERO) };
        let corners: Vec<Vec3> = (0..7)
            .map(|corner| {
                let (sine, cosine) = (0.13 + corner as f32 * std::f32::consts::TAU / 7.0).sin_cos();
                0.02 * Vec3::new(sine, cosine, 0.0)
            })
            .collect();
        let fan = (1..6).map(|last| [0, last, last + 1]).collect();
        let body = Mesh::new(corners.clone(), fan).unwrap();
        let found = drawn.on_body(on, &transparent(SIZE, 1), Some(&body)).0.alpha.unwrap();
        let scale = 0.5 * SIZE as f32 * Camera::front().focal() / drawn.eye.z;
        let place = |at: usize, part: usize| (at as f32 + (part as f32 + 0.5) / 16.0 - 0.5 * SIZE as f32) / scale;
        let is_inside = |x: f32, y: f32| {
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            edges.map(|(a, b)| (*b - *a).truncate().perp_dot(Vec2::new(x, y) - a.truncate())).all(|side| side < 0.0)
        };
        let (mut sum, mut stepped, mut count) = (0.0, 0.0, 0.0);
        for (pixel, &alpha) in found.iter().enumerate() {
            let (column, row) = (pixel % SIZE as usize, pixel / SIZE as usize);
            let shown = (0..256).filter(|part| is_inside(place(column, part % 16), -place(row, part / 16)));
            let share = shown.count() as f32 / 256.0;
            if share > 0.0 && share < 1.0 {
                sum += (f32::from(alpha) / 255.0 - share).powi(2);
                stepped += (share.round() - share).powi(2);
                count += 1.0;
            }
        }
        let [error, stepped] = [sum, stepped].map(|sum: f32| (sum / count).sqrt());
        assert!(count > 60.0 && error < 0.12 && error < 0.45 * stepped, "{count}: {error} {stepped}");
    }
}

/// Linear light of 8-bit sRGB \[IEC61966-2-1\].
fn linear(byte: u8) -> f32 {
    let shown = f32::from(byte) / 255.0;
    if shown <= 0.040_45 { shown / 12.92 } else { ((shown + 0.055) / 1.055).powf(2.4) }
}
