//! A window as a display would show it: triangles of its meshes with their textures, without a device.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{
    self, Color32, ColorImage, ImageData, Pos2, Rect, TextureId, TexturesDelta,
    epaint::{ClippedPrimitive, Mesh, Primitive, Vertex},
};
use egui_kittest::TestRenderer;

/// Textures of a window by their numbers.
#[derive(Clone, Default)]
pub struct Textures(Arc<Mutex<HashMap<TextureId, ColorImage>>>);

impl TestRenderer for Textures {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        let mut textures = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for (id, parts) in delta.set.drain() {
            for part in parts {
                let ImageData::Color(image) = part.image;
                match part.pos {
                    None => _ = textures.insert(id, ColorImage::clone(&image)),
                    Some(corner) => {
                        textures.get_mut(&id).into_iter().for_each(|whole| patch(whole, corner, &image))
                    }
                }
            }
        }
        for id in delta.free.drain() {
            textures.remove(&id);
        }
    }
}

/// Puts a part of a texture in its place.
fn patch(whole: &mut ColorImage, [left, top]: [usize; 2], part: &ColorImage) {
    for (row, pixels) in part.pixels.chunks_exact(part.width().max(1)).enumerate() {
        let from = (top + row) * whole.width() + left;
        whole.pixels[from..from + pixels.len()].copy_from_slice(pixels);
    }
}

impl Textures {
    /// Draws primitives into a picture of a size \[point\].
    pub fn draw(&self, primitives: &[ClippedPrimitive], size: egui::Vec2, scale: f32) -> image::RgbImage {
        let textures = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let [width, height] = [size.x, size.y].map(|side| (side * scale).round() as usize);
        let mut canvas = Canvas { width, height, scale, pixels: vec![[0.0; 3]; width * height] };
        for ClippedPrimitive { clip_rect, primitive } in primitives {
            let Primitive::Mesh(mesh) = primitive else { continue };
            if let Some(texture) = textures.get(&mesh.texture_id) {
                canvas.add(mesh, texture, *clip_rect);
            }
        }
        let byte = |value: f32| (value + 0.5).clamp(0.0, 255.0) as u8;
        let bytes = canvas.pixels.iter().flat_map(|pixel| pixel.map(byte)).collect();
        image::RgbImage::from_raw(width as u32, height as u32, bytes).unwrap()
    }
}

/// A picture that is being drawn.
struct Canvas {
    width: usize,
    height: usize,
    /// Pixels of a point.
    scale: f32,
    pixels: Vec<[f32; 3]>,
}

impl Canvas {
    fn add(&mut self, mesh: &Mesh, texture: &ColorImage, clip: Rect) {
        for corners in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|at| mesh.vertices[corners[at] as usize]);
            self.triangle(corners, texture, clip * self.scale);
        }
    }

    fn triangle(&mut self, corners: [Vertex; 3], texture: &ColorImage, clip: Rect) {
        let [a, b, c] = corners.map(|corner| corner.pos * self.scale);
        let cross = |from: Pos2, to: Pos2, at: Pos2| {
            (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x)
        };
        let area = cross(a, b, c);
        if area == 0.0 {
            return;
        }
        let bounds = Rect::from_points(&[a, b, c]).intersect(clip);
        let range = |low: f32, high: f32, most: usize| {
            (low - 0.5).ceil().max(0.0) as usize
                ..((high - 0.5).floor() + 1.0).clamp(0.0, most as f32) as usize
        };
        // A pixel on an edge belongs to one of its two triangles.
        let owns = |from: Pos2, to: Pos2| {
            let way = (to - from) * area.signum();
            way.y < 0.0 || (way.y == 0.0 && way.x > 0.0)
        };
        let edges = [(b, c), (c, a), (a, b)];
        for y in range(bounds.top(), bounds.bottom(), self.height) {
            for x in range(bounds.left(), bounds.right(), self.width) {
                let at = Pos2::new(x as f32 + 0.5, y as f32 + 0.5);
                let shares = edges.map(|(from, to)| cross(from, to, at) / area);
                let inside = shares
                    .iter()
                    .zip(edges)
                    .all(|(share, (from, to))| *share > 0.0 || (*share == 0.0 && owns(from, to)));
                if inside {
                    self.blend(x, y, &corners, shares, texture);
                }
            }
        }
    }

    fn blend(&mut self, x: usize, y: usize, corners: &[Vertex; 3], shares: [f32; 3], texture: &ColorImage) {
        let mix = |of: &dyn Fn(&Vertex) -> f32| -> f32 {
            corners.iter().zip(shares).map(|(corner, share)| share * of(corner)).sum()
        };
        let texel = sample(texture, mix(&|corner| corner.uv.x), mix(&|corner| corner.uv.y));
        let colour: [f32; 4] = std::array::from_fn(|part| {
            mix(&|corner| f32::from(corner.color.to_array()[part])) * texel[part] / 255.0
        });
        let pixel = &mut self.pixels[y * self.width + x];
        let through = 1.0 - colour[3] / 255.0;
        for part in 0..3 {
            pixel[part] = pixel[part] * through + colour[part];
        }
    }
}

/// A texture between its four nearest pixels.
fn sample(texture: &ColorImage, u: f32, v: f32) -> [f32; 4] {
    let [width, height] = texture.size;
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let at = |x: f32, y: f32| -> Color32 {
        let column = x.clamp(0.0, width as f32 - 1.0) as usize;
        let row = y.clamp(0.0, height as f32 - 1.0) as usize;
        texture.pixels[row * width + column]
    };
    let (left, top) = (x.floor(), y.floor());
    let (right_share, low_share) = (x - left, y - top);
    let corners = [
        (at(left, top), (1.0 - right_share) * (1.0 - low_share)),
        (at(left + 1.0, top), right_share * (1.0 - low_share)),
        (at(left, top + 1.0), (1.0 - right_share) * low_share),
        (at(left + 1.0, top + 1.0), right_share * low_share),
    ];
    std::array::from_fn(|part| {
        corners.iter().map(|(pixel, share)| f32::from(pixel.to_array()[part]) * share).sum()
    })
}
