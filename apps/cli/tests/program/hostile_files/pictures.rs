//! Pictures: maps over the scalp and surroundings.

use super::*;

#[test]
fn pictures_that_unpack_to_much() {
    use image::DynamicImage;
    use image::codecs::png::{CompressionType, FilterType, PngEncoder};
    let side = 8192;
    for (name, picture) in [
        ("flat16.png", DynamicImage::new_rgba16(side, side)),
        ("flat8.png", DynamicImage::new_rgb8(side, side)),
        ("grey.png", DynamicImage::new_luma16(side, side)),
    ] {
        let mut file = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::NoFilter);
        picture.write_with_encoder(encoder).unwrap();
        give(name, &file);
    }
}

#[test]
fn surroundings_that_unpack_to_much() {
    // Runs of 127 pixels for each channel: no row takes less.
    let (width, height) = (4096_usize, 2048);
    let channel = [255_u8, 100].repeat(width / 127);
    let rest = [128 + (width % 127) as u8, 100];
    let row = [[2, 2, (width >> 8) as u8, width as u8].to_vec(), [channel, rest.to_vec()].concat().repeat(4)]
        .concat();
    let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    give("flat.hdr", &[head.into_bytes(), row.repeat(height)].concat());
    for size in ["-Y 4096 +X 8192", "-Y 4294967295 +X 8589934590", "-Y 1 +X 2"] {
        give("claims.hdr", format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n").as_bytes());
    }
    // The tests of the reader hold flat ones of OpenEXR; here every number of the header is a very large one.
    let channel = |name: &str| (name.to_owned(), vec![0.5_f32; 128]);
    let layers = strandline::low_level::render::Layers {
        width: 16,
        height: 8,
        channels: ["R", "G", "B"].map(channel).to_vec(),
    };
    let small = layers.encode().unwrap();
    give("small.exr", &small);
    for at in (4..small.len().min(360)).step_by(12) {
        let mut lying = small.clone();
        lying[at..at + 4].copy_from_slice(&0x7fff_ffff_u32.to_le_bytes());
        give("claims.exr", &lying);
    }
}
