//! OpenEXR pictures of surroundings.

use std::io::Cursor;

use exr::image::read::read as reading;
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, RgbChannels};
use glam::Vec3;
use strandline_base::memory;

use super::size::{MAX_PIXELS, check_size};

/// Most bytes of a block of rows or of a tile with all its channels: it is unpacked as a whole.
const MAX_BLOCK: usize = 1 << 27;
/// First bytes of such a file.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Width, height and pixels of the first layer with channels R, G and B.
pub(super) fn read(bytes: &[u8]) -> Result<(usize, usize, Vec<Vec3>), String> {
    let as_text = |error: exr::error::Error| strandline_base::printable(&error.to_string()).into_owned();
    // Sizes are looked at before anything is taken for them.
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), true).map_err(as_text)?;
    for header in &meta.headers {
        let size = header.layer_size;
        if size.0.saturating_mul(size.1) > MAX_PIXELS {
            check_size(size.0, size.1)?;
        }
        let unpacked = size.0.saturating_mul(size.1).saturating_mul(size_of::<Vec3>());
        let most = memory::most_unpacked(bytes.len() as u64);
        if unpacked as u64 > most {
            let (width, height, unpacked) = (size.0, size.1, unpacked >> 20);
            return Err(format!(
                "{width} x {height} pixels, which unpack to {unpacked} MiB, expected {} at most",
                most >> 20
            ));
        }
        let block = header.max_block_pixel_size();
        let bytes = block.0.saturating_mul(block.1).saturating_mul(header.channels.bytes_per_pixel);
        if bytes > MAX_BLOCK {
            return Err(format!(
                "blocks of {bytes} bytes with {} channels, at most {MAX_BLOCK} are read: leave channels out",
                header.channels.list.len()
            ));
        }
    }
    let begin = |size: Vec2<usize>, _: &RgbChannels| (size.0, vec![Vec3::ZERO; size.0 * size.1]);
    let put =
        |(width, pixels): &mut (usize, Vec<Vec3>), at: Vec2<usize>, (red, green, blue): (f32, f32, f32)| {
            if let Some(pixel) = pixels.get_mut(at.1 * *width + at.0) {
                *pixel = Vec3::new(red, green, blue);
            }
        };
    let picture = reading()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(begin, put)
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(as_text)?;
    let (width, pixels) = picture.layer_data.channel_data.pixels;
    let height = pixels.len() / width.max(1);
    check_size(width, height)?;
    Ok((width, height, pixels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Layers;

    fn written(width: u32, height: u32) -> Vec<u8> {
        let count = (width * height) as usize;
        let channel = |name: &str, at: f32| {
            (name.to_owned(), (0..count).map(|pixel| at + pixel as f32).collect::<Vec<f32>>())
        };
        let channels =
            vec![channel("R", 0.25), channel("G", 0.5), channel("B", 0.75), channel("depth.Z", 3.0)];
        Layers { width, height, channels }.encode().unwrap()
    }

    #[test]
    fn what_is_written_is_read() {
        let (width, height, pixels) = read(&written(8, 4)).unwrap();
        assert_eq!((width, height), (8, 4));
        assert_eq!(pixels[9], Vec3::new(9.25, 9.5, 9.75));
    }

    /// A small file can say that a block unpacks to more than there is memory for.
    #[test]
    fn blocks_of_very_many_channels_are_refused() {
        let many = (0..600).map(|index| (format!("c{index:03}"), vec![0.0_f32; 8192])).collect();
        let wide = Layers { width: 8192, height: 1, channels: many }.encode().unwrap();
        assert!(read(&wide).unwrap_err().contains("600 channels"));
    }

    /// A flat picture packs so well that a file of 200 kB would take 400 MB.
    #[test]
    fn small_files_do_not_unpack_to_much() {
        use exr::prelude::{Encoding, Image, SpecificChannels, WritableImage};
        let flat = SpecificChannels::rgb(|_: Vec2<usize>| (0.0_f32, 0.0_f32, 0.0_f32));
        let mut file = Cursor::new(Vec::new());
        let picture = Image::from_encoded_channels((8192, 4096), Encoding::SMALL_LOSSLESS, flat);
        picture.write().non_parallel().to_buffered(&mut file).unwrap();
        let error = read(&file.into_inner()).unwrap_err();
        assert!(error.contains("8192 x 4096 pixels, which unpack to 384 MiB"), "{error}");
    }

    #[test]
    fn other_shapes_and_damage_are_reported() {
        assert!(read(&written(4, 4)).unwrap_err().contains("twice as wide as high"));
        let whole = written(8, 4);
        for end in [5, 40, whole.len() / 2, whole.len() - 1] {
            assert!(read(&whole[..end]).is_err(), "{end}");
        }
    }
}
