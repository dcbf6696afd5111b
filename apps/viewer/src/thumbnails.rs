//! Small pictures of styles and looks, which `cargo run --release -p strandline --example styles` draws.

use eframe::egui::{self, ColorImage, Image, Rect, TextureHandle, TextureOptions, Ui};
use strandline::{Style, look::Preset};

/// Side of a picture in its row \[pixel\], and as it is shown \[point\].
const SIDE: usize = 64;
const SHOWN: f32 = 36.0;

/// The rows of pictures: a style or a look after the other, in the order of `Style::ALL` and `Preset::ALL`.
static STYLES: &[u8] = include_bytes!("../assets/styles.jpg");
static LOOKS: &[u8] = include_bytes!("../assets/looks.jpg");

/// The picture of a style, on the built-in head.
pub fn style(style: Style, ui: &Ui) -> Image<'static> {
    let index = Style::ALL.iter().position(|other| *other == style);
    picture(("styles", STYLES), index.unwrap_or_default(), Style::ALL.len(), ui)
}

/// The picture of a look, on short hair.
pub fn look(preset: Preset, ui: &Ui) -> Image<'static> {
    let index = Preset::ALL.iter().position(|other| *other == preset);
    picture(("looks", LOOKS), index.unwrap_or_default(), Preset::ALL.len(), ui)
}

/// A picture of a row, which is decoded once.
fn picture((name, row): (&'static str, &[u8]), index: usize, count: usize, ui: &Ui) -> Image<'static> {
    let id = egui::Id::unique(("thumbnails", name));
    let known = ui.data(|data| data.get_temp::<TextureHandle>(id));
    let texture = known.unwrap_or_else(|| {
        let made = ui.ctx().load_texture(name, decoded(row), TextureOptions::LINEAR);
        ui.data_mut(|data| data.insert_temp(id, made.clone()));
        made
    });
    let [left, right] = [index, index + 1].map(|edge| edge as f32 / count as f32);
    let part = Rect::from_min_max(egui::pos2(left, 0.0), egui::pos2(right, 1.0));
    Image::new((texture.id(), egui::Vec2::splat(SHOWN))).uv(part).fit_to_exact_size(egui::Vec2::splat(SHOWN))
}

/// The pixels of a row; black if it cannot be read.
fn decoded(row: &[u8]) -> ColorImage {
    match image::load_from_memory_with_format(row, image::ImageFormat::Jpeg) {
        Ok(picture) => {
            let picture = picture.to_rgb8();
            ColorImage::from_rgb([picture.width() as usize, picture.height() as usize], picture.as_raw())
        }
        Err(_) => ColorImage::filled([SIDE, SIDE], egui::Color32::BLACK),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_style_and_each_look_has_a_picture_of_its_own() {
        for (row, count) in [(STYLES, Style::ALL.len()), (LOOKS, Preset::ALL.len())] {
            let pixels = decoded(row);
            assert_eq!(pixels.size, [SIDE * count, SIDE]);
            let middle = |index: usize| {
                let of = |y: usize| pixels.pixels[y * SIDE * count + index * SIDE..][..SIDE].to_vec();
                (0..SIDE).flat_map(of).collect::<Vec<_>>()
            };
            for index in 1..count {
                assert!(middle(index) != middle(index - 1), "{index}");
            }
        }
    }
}
