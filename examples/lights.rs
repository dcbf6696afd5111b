//! Five colours of hair in six lights, docs/gallery/lights.png: a soft box, a light behind, one from the top,
//! surroundings of a room and of a field, and soft boxes on all sides, seen from behind. `cargo run --release -p strandline --example lights`

use std::path::Path;
use std::sync::Arc;

use glam::Vec3;
use strandline::{
    Backend, Camera, Hair, Light, Look, Picture, PictureSettings, Prepared, Scene, Style,
    look::{
        LightKind, Preset,
        surroundings::{Panorama, Surroundings},
    },
    math,
};

const COLOURS: [Preset; 5] = [Preset::Black, Preset::Brown, Preset::Red, Preset::Blonde, Preset::Grey];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::var_os("STRANDLINE_QUICK").is_some();
    let folder = Path::new(if quick { "out/examples" } else { "docs/gallery" });
    std::fs::create_dir_all(folder)?;
    let mut scene = Scene::demo();
    scene.set_style(Style::Wavy);
    scene.style.strand_count = if quick { 40 } else { 1000 };
    scene.look.follow_strands = if quick { 4 } else { scene.look.follow_strands };
    let (width, height) = if quick { (48, 52) } else { (240, 264) };
    scene.body.spacing = if quick { 0.01 } else { scene.body.spacing };
    scene.picture = PictureSettings { width, height, ..scene.picture };
    let mut hair = Hair::from_prepared(Prepared::new(&scene)?, Backend::Cpu)?;
    let room = surroundings(room)?;
    let field = surroundings(field)?;
    let mut rows = Vec::new();
    for lights in 0..6 {
        let mut row = Vec::new();
        for colour in COLOURS.into_iter().step_by(if quick { 3 } else { 1 }) {
            let mut look = Look { follow_strands: scene.look.follow_strands, ..Look::named(colour) };
            look.shadow.map_size = 512;
            hair.set_lights(match lights {
                0 => vec![panel([-0.9, 1.1, 1.35], 0.9, 1.4)],
                1 => vec![panel([0.3, 0.9, -1.4], 0.5, 3.0)],
                2 => vec![panel([0.0, 1.7, 0.1], 0.6, 1.6)],
                5 => Light::all_sides(Vec3::new(0.0, -0.05, 0.0)).to_vec(),
                _ => Vec::new(),
            })?;
            look.surroundings = match lights {
                3 => Some(room.clone()),
                4 => Some(field.clone()),
                _ => None,
            };
            let camera = if lights == 5 { Camera::back() } else { Camera::three_quarter() };
            row.push(hair.picture(&camera, &look)?);
        }
        rows.push(row);
    }
    assert!(rows.iter().flatten().all(|picture| !picture.is_blank()), "a picture shows nothing");
    joined(&rows).save(folder.join("lights.png"))?;
    Ok(())
}

fn panel(position: [f32; 3], side: f32, intensity: f32) -> Light {
    let (position, target) = (Vec3::from(position), Vec3::new(0.0, -0.05, 0.0));
    Light {
        kind: LightKind::Rectangle,
        position,
        target,
        width: side,
        height: side,
        intensity,
        ..Light::default()
    }
}

fn surroundings(light: fn(Vec3) -> Vec3) -> Result<Arc<Surroundings>, String> {
    let (width, height) = (256, 128);
    let pixel = |index: usize| {
        let turn = std::f32::consts::TAU * ((index % width) as f32 / width as f32 - 0.5);
        let (flat, y) = math::sin_cos(std::f32::consts::PI * ((index / width) as f32 + 0.5) / height as f32);
        light(Vec3::new(-math::sin(turn) * flat, y, math::cos(turn) * flat))
    };
    let panorama = Panorama::new(width, height, (0..width * height).map(pixel).collect())?;
    Ok(Arc::new(Surroundings::new(&panorama, 0.0, 1.0)))
}

/// A room with a window on one side and a lamp above the other.
fn room(way: Vec3) -> Vec3 {
    let window = way.distance(Vec3::new(-0.8, 0.25, 0.55)) < 0.35;
    let lamp = way.distance(Vec3::new(0.6, 0.7, -0.35)) < 0.18;
    let walls = Vec3::new(0.09, 0.08, 0.07) * (0.7 + 0.3 * way.y);
    if window {
        Vec3::new(4.5, 5.0, 5.6)
    } else if lamp {
        Vec3::new(9.0, 6.0, 3.4)
    } else {
        walls
    }
}

/// A sunny field.
fn field(way: Vec3) -> Vec3 {
    let sun = way.distance(Vec3::new(0.55, 0.62, 0.56)) < 0.04;
    let sky = Vec3::new(0.22, 0.34, 0.55) * (1.3 - 0.7 * way.y);
    let ground = Vec3::new(0.09, 0.10, 0.05);
    if sun {
        Vec3::new(720.0, 660.0, 560.0)
    } else if way.y > 0.0 {
        sky
    } else {
        ground
    }
}

/// Pictures of one size beside and below one another.
fn joined(rows: &[Vec<Picture>]) -> Picture {
    let one = &rows[0][0];
    let line = |row: &[Picture], at: usize| -> Vec<u8> {
        let bytes = 3 * one.width as usize;
        row.iter().flat_map(|picture| picture.pixels[at * bytes..(at + 1) * bytes].to_vec()).collect()
    };
    let lines = rows.iter().flat_map(|row| (0..one.height as usize).flat_map(move |at| line(row, at)));
    Picture {
        width: one.width * rows[0].len() as u32,
        height: one.height * rows.len() as u32,
        pixels: lines.collect(),
        alpha: None,
    }
}
