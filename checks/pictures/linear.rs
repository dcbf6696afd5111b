//! Linear pictures and how far they are from references.

use std::path::{Path, PathBuf};

use glam::Vec3;
use strandline_render::Layers;

/// A linear picture, rows from the top.
pub struct Linear {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<Vec3>,
}

/// The values of a channel, rows from the top.
pub fn channel<'a>(layers: &'a Layers, name: &str) -> &'a [f32] {
    let found = layers.channels.iter().find(|(own, _)| own == name);
    &found.unwrap_or_else(|| panic!("no channel {name}")).1
}

impl Linear {
    /// The light of channels.
    pub fn of(layers: &Layers) -> Self {
        let [red, green, blue] = ["R", "G", "B"].map(|name| channel(layers, name));
        let pixel = |at: usize| Vec3::new(red[at], green[at], blue[at]);
        Self {
            width: layers.width as usize,
            height: layers.height as usize,
            pixels: (0..red.len()).map(pixel).collect(),
        }
    }

    /// Means of boxes of 4 x 4 pixels.
    pub fn boxed(&self) -> Self {
        let (width, height) = (self.width / 4, self.height / 4);
        let mean = |column: usize, row: usize| {
            let pixel = |at: usize| self.pixels[(4 * row + at / 4) * self.width + 4 * column + at % 4];
            (0..16).map(pixel).sum::<Vec3>() / 16.0
        };
        let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        Self { width, height, pixels: places.map(|(column, row)| mean(column, row)).collect() }
    }

    /// A grey picture of its red light.
    pub fn grey(&self) -> Self {
        Self { pixels: self.pixels.iter().map(|pixel| Vec3::splat(pixel.x)).collect(), ..*self }
    }

    /// 8-bit sRGB of the light times a factor, cut off at 1.
    pub fn shown(&self, gain: f32) -> Vec<u8> {
        let encode = |light: f32| {
            let light = (light * gain).clamp(0.0, 1.0);
            let srgb =
                if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
            (255.0 * srgb + 0.5) as u8
        };
        self.pixels.iter().flat_map(|pixel| pixel.to_array().map(encode)).collect()
    }

    pub fn save(&self, name: &str, gain: f32) {
        let Some(folder) = std::env::var_os("STRANDLINE_KEEP") else { return };
        let picture = strandline_render::Picture {
            width: self.width as u32,
            height: self.height as u32,
            pixels: self.shown(gain),
            alpha: None,
        };
        picture.save(Path::new(&folder).join(format!("{name}.png"))).unwrap();
    }
}

pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("pictures/reference")
}

/// The numbers of a .npy file after its header.
pub fn npy(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{error}: {}", path.display()));
    let header = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    bytes[10 + header..].to_vec()
}

pub fn reference(name: &str, width: usize) -> Linear {
    let pixels: Vec<Vec3> = numbers(name).as_chunks::<3>().0.iter().map(|&rgb| rgb.into()).collect();
    Linear { width, height: pixels.len() / width, pixels }
}

/// A reference of red light alone, as a grey picture.
pub fn red(name: &str, width: usize) -> Linear {
    let pixels: Vec<Vec3> = numbers(name).into_iter().map(Vec3::splat).collect();
    Linear { width, height: pixels.len() / width, pixels }
}

fn numbers(name: &str) -> Vec<f32> {
    let bytes = npy(&folder().join("look").join(format!("{name}.npy")));
    bytes.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

/// Differences between a picture and its reference inside a mask.
#[derive(Debug)]
pub struct Measures {
    /// Mean FLIP error.
    pub flip: f32,
    /// Mean radiance over that of the reference.
    pub mean: Vec3,
    /// Relative RMS of the means of 8 x 8 regions.
    pub regions: f32,
}

impl Measures {
    /// True if FLIP and the mean of each channel are within their bounds.
    pub fn sound(&self, flip: f32, mean: f32) -> bool {
        self.flip <= flip && (self.mean - Vec3::ONE).abs().max_element() <= mean
    }
}

pub fn measures(found: &Linear, expected: &Linear, mask: &[bool], gain: f32) -> Measures {
    let (width, height) = (expected.width, expected.height);
    assert_eq!((found.width, found.height), (width, height));
    let image = |picture: &Linear| {
        nv_flip::FlipImageRgb8::with_data(width as u32, height as u32, &picture.shown(gain))
    };
    let errors = nv_flip::flip(image(expected), image(found), nv_flip::DEFAULT_PIXELS_PER_DEGREE).to_vec();
    let inside = mask.iter().filter(|inside| **inside).count() as f32;
    let flip = errors.iter().zip(mask).filter(|(_, inside)| **inside).map(|(error, _)| error).sum::<f32>();
    let sum = |picture: &Linear, keep: &dyn Fn(usize) -> bool| -> Vec3 {
        let pixels = picture.pixels.iter().zip(mask).enumerate();
        pixels.filter(|(at, (_, inside))| **inside && keep(*at)).map(|(_, (pixel, _))| *pixel).sum()
    };
    let (mut error, mut whole) = (0.0, 0.0);
    for region in 0..(width / 8) * (height / 8) {
        let (column, row) = (region % (width / 8), region / (width / 8));
        let keep = |at: usize| at % width / 8 == column && at / width / 8 == row;
        let (one, other) = (sum(found, &keep), sum(expected, &keep));
        error += (one - other).length_squared();
        whole += other.length_squared();
    }
    let all = |_: usize| true;
    Measures {
        flip: flip / inside,
        mean: sum(found, &all) / sum(expected, &all),
        regions: (error / whole).sqrt(),
    }
}
