//! Hair under water in pictures: darker, with a narrower highlight, in thinner locks.

use glam::Vec3;
use strandline_checks::{On, law};
use strandline_render::{Background, Clump, Coat, LevelOfDetail, Light, Look, PictureSettings};

use crate::drawn::{Drawn, guides};

const HEIGHT: usize = 96;
const WIDTH: usize = 64;

/// Light of each row of a picture of hair over nothing, and columns of each row that show hair.
fn rows(on: &On, drawn: &Drawn) -> (Vec<f64>, Vec<usize>) {
    let mut settings = PictureSettings::sized(WIDTH as u32, HEIGHT as u32);
    settings.background = Background { top: Vec3::ZERO, bottom: Vec3::ZERO };
    let picture = drawn.picture(on, &settings);
    let pixels = picture.interleaved();
    let linear = |byte: u8| (f64::from(byte) / 255.0).powf(2.2);
    let light =
        |pixel: &[u8]| 0.2126 * linear(pixel[0]) + 0.7152 * linear(pixel[1]) + 0.0722 * linear(pixel[2]);
    let rows = pixels.chunks(4 * WIDTH).map(|row| row.chunks(4).map(light).collect::<Vec<_>>());
    rows.map(|row| {
        (row.iter().sum::<f64>() / WIDTH as f64, row.iter().filter(|light| **light > 1e-3).count())
    })
    .unzip()
}

/// A sheet of hair bent over a roll, lit from beside the eye.
fn sheet(coat: Coat) -> Drawn {
    let arc = |strand: usize| {
        let x = 0.0008 * (strand as f32 - 47.5);
        (0..33).map(move |point| {
            let angle = std::f32::consts::PI * point as f32 / 32.0;
            Vec3::new(x, 0.05 * angle.cos(), 0.05 * angle.sin())
        })
    };
    let clump = Clump { root_radius: 0.001, tip_radius: 0.001, wave_amplitude: 0.0, ..Clump::default() };
    let mut look = Look { coat, clump, follow_strands: 6, hair_count: 8_000, ..Look::blonde() };
    (look.fibre.chiang.cells, look.fibre.chiang.scatterings, look.shadow.map_size) = (8, 4, 64);
    Drawn {
        guides: guides((0..96).map(|strand| arc(strand).collect()), 24),
        look,
        lights: vec![Light { position: Vec3::new(0.0, 0.15, 0.6), ..Light::default() }],
        eye: Vec3::new(0.0, 0.0, 0.4),
        detail: LevelOfDetail::full(),
    }
}

/// Greatest light of a profile over its mean.
fn peak(profile: &[f64]) -> f64 {
    profile.iter().fold(0.0_f64, |most, light| most.max(*light)) * profile.len() as f64
        / profile.iter().sum::<f64>()
}

law! {
    fn wet_hair_is_darker_and_glossier(on) {
        let profile = |coat| rows(on, &sheet(coat)).0;
        let mean = |profile: &[f64]| profile.iter().sum::<f64>() / profile.len() as f64;
        let dry = profile(Coat::NONE);
        let wet = [
            Coat { gather: 0.0, ..Coat::WATER },
            Coat { pigment: Coat::WATER.pigment, ..Coat::NONE },
            Coat { roughness: Coat::WATER.roughness, ..Coat::NONE },
        ];
        // A software adapter draws slowly.
        let wet = wet.map(|coat| (coat == wet[0] || on.either(true, false)).then(|| profile(coat)));
        let [both, pigment, roughness] = wet.map(|profile| profile.unwrap_or_else(|| dry.clone()));
        for darker in [&both, &pigment] {
            let share = mean(darker) / mean(&dry);
            // 0.45 of both, 0.49 of the pigment alone.
            assert!(*darker == dry || (0.35..0.65).contains(&share), "{share}");
        }
        for sharper in [&both, &roughness] {
            let share = peak(sharper) / peak(&dry);
            // 2.2 of both, of which the pigment alone has a part.
            assert!(*sharper == dry || share > 1.15, "{share}");
        }
        assert!(both != dry && on.either(pigment != dry && roughness != dry, true));
    }
}

law! {
    fn strands_of_a_wet_lock_come_together(on) {
        let lock = |coat| {
            let clump = Clump { root_radius: 0.008, tip_radius: 0.008, lift: 0.0, shorter: 0.0, ..Clump::default() };
            Drawn {
                guides: guides([vec![Vec3::Y * 0.05, Vec3::NEG_Y * 0.05]], 12),
                look: Look { coat, clump, follow_strands: 200, hair_count: 1_500, ..Look::blonde() },
                lights: vec![Light { position: Vec3::new(0.0, 0.0, 0.6), ..Light::default() }],
                eye: Vec3::new(0.0, 0.0, 0.3),
                detail: LevelOfDetail::full(),
            }
        };
        let widths = |coat| rows(on, &lock(coat)).1;
        let [dry, wet] = [Coat::NONE, Coat::WATER].map(widths);
        let hair: Vec<usize> = (0..HEIGHT).filter(|row| dry[*row] > 0).collect();
        let (root, tip) = (hair[0] + 1, hair[hair.len() - 1] - 2);
        assert!(wet[root] > dry[root] * 3 / 4, "{} of {} columns at the root", wet[root], dry[root]);
        assert!(wet[tip] < dry[tip] / 2, "{} of {} columns at the tip", wet[tip], dry[tip]);
    }
}
