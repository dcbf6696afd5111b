//! Radiance pictures: shared exponents, runs of bytes [Ward1991].

use glam::Vec3;

use super::size::check_size;

/// Longest line of a header \[bytes\], and lines at most.
const LONGEST: usize = 2048;
const LINES: usize = 256;
/// Widths of rows that are stored channel by channel.
const BY_CHANNEL: std::ops::Range<usize> = 8..32_768;

/// Width, height and pixels.
pub(super) fn read(bytes: &[u8]) -> Result<(usize, usize, Vec<Vec3>), String> {
    let mut rest = bytes;
    let (mut exposure, mut has_format) = (1.0_f32, false);
    line(&mut rest)?;
    for _ in 0..LINES {
        let text = line(&mut rest)?;
        if text.is_empty() {
            break;
        }
        if let Some(format) = text.strip_prefix("FORMAT=") {
            has_format = format.trim() == "32-bit_rle_rgbe";
            if !has_format {
                return Err(format!("its format is `{}`, expected `32-bit_rle_rgbe`", shown(format)));
            }
        } else if let Some(number) = text.strip_prefix("EXPOSURE=") {
            let own: f32 =
                number.trim().parse().map_err(|_| format!("its exposure is `{}`", shown(number)))?;
            exposure *= own;
        }
    }
    if !has_format {
        return Err("its header has no line `FORMAT=32-bit_rle_rgbe`".to_owned());
    }
    if !(exposure.is_finite() && exposure > 0.0) {
        return Err(format!("its exposure is {exposure}, expected a number above 0"));
    }
    let (width, height) = size(&line(&mut rest)?)?;
    check_size(width, height)?;
    // A row takes at least two bytes for 127 pixels of each channel.
    if rest.len() < height.saturating_mul(4) {
        return Err(ended());
    }
    let mut pixels = Vec::with_capacity(width * height);
    let mut row = vec![[0_u8; 4]; width];
    for _ in 0..height {
        read_row(&mut rest, &mut row)?;
        pixels.extend(row.iter().map(|&pixel| decoded(pixel) / exposure));
    }
    Ok((width, height, pixels))
}

fn ended() -> String {
    "it ends before its last row".to_owned()
}

/// Text of a file for a message.
fn shown(text: &str) -> String {
    strandline_base::printable(text.trim()).chars().take(40).collect()
}

fn line(rest: &mut &[u8]) -> Result<String, String> {
    let end = rest.iter().take(LONGEST).position(|&byte| byte == b'\n');
    let end = end.ok_or("its header does not end")?;
    let text = String::from_utf8_lossy(&rest[..end]).trim_end_matches('\r').to_owned();
    *rest = &rest[end + 1..];
    Ok(text)
}

/// Width and height of `-Y height +X width`.
fn size(text: &str) -> Result<(usize, usize), String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    if let ["-Y", height, "+X", width] = words[..]
        && let (Ok(width), Ok(height)) = (width.parse(), height.parse())
    {
        return Ok((width, height));
    }
    Err(format!("its size is `{}`, expected `-Y HEIGHT +X WIDTH`: rows from the top", shown(text)))
}

fn read_row(rest: &mut &[u8], row: &mut [[u8; 4]]) -> Result<(), String> {
    let width = row.len();
    let begin = [2, 2, (width >> 8) as u8, width as u8];
    if BY_CHANNEL.contains(&width) && rest.starts_with(&begin) {
        *rest = &rest[4..];
        return (0..4).try_for_each(|channel| read_channel(rest, row, channel));
    }
    let mut at = 0;
    let mut shift = 0;
    while at < width {
        let (pixel, after) = rest.split_first_chunk::<4>().ok_or_else(ended)?;
        *rest = after;
        if pixel[..3] != [1, 1, 1] {
            (row[at], at, shift) = (*pixel, at + 1, 0);
            continue;
        }
        // The pixel before so often again.
        let count = (pixel[3] as usize) << shift;
        if at == 0 || shift > 16 || count > width - at {
            return Err("a run goes beyond its row".to_owned());
        }
        let before = row[at - 1];
        row[at..at + count].fill(before);
        (at, shift) = (at + count, shift + 8);
    }
    Ok(())
}

/// One channel of a row: runs (more than 128) and bytes as they are.
fn read_channel(rest: &mut &[u8], row: &mut [[u8; 4]], channel: usize) -> Result<(), String> {
    let mut at = 0;
    while at < row.len() {
        let (&code, after) = rest.split_first().ok_or_else(ended)?;
        let (count, is_run) = if code > 128 { (code as usize - 128, true) } else { (code as usize, false) };
        if count == 0 || count > row.len() - at {
            return Err("a run goes beyond its row".to_owned());
        }
        let needed = if is_run { 1 } else { count };
        if after.len() < needed {
            return Err(ended());
        }
        let values = &after[..needed];
        for (offset, pixel) in row[at..at + count].iter_mut().enumerate() {
            pixel[channel] = values[if is_run { 0 } else { offset }];
        }
        (*rest, at) = (&after[needed..], at + count);
    }
    Ok(())
}

fn decoded([red, green, blue, exponent]: [u8; 4]) -> Vec3 {
    if exponent == 0 {
        return Vec3::ZERO;
    }
    let scale = 2.0_f32.powi(i32::from(exponent) - 136);
    Vec3::new(f32::from(red) + 0.5, f32::from(green) + 0.5, f32::from(blue) + 0.5) * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(body: &[u8]) -> Vec<u8> {
        [&b"#?RADIANCE\n# of a test\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n"[..], body].concat()
    }

    #[test]
    fn both_kinds_of_rows_are_read() {
        // 128 in a mantissa with exponent 129 is 1, and half a step more.
        let runs: Vec<u8> = [2, 2, 0, 8]
            .into_iter()
            .chain([128 + 8, 128, 128 + 8, 64, 3, 1, 2, 3, 128 + 5, 0, 128 + 8, 129])
            .collect();
        let flat: Vec<u8> = [[128, 64, 0, 129]; 7].concat().into_iter().chain([1, 1, 1, 1]).collect();
        let rows = [&runs[..], &flat, &flat, &runs].concat();
        let (width, height, pixels) = read(&file(&rows)).unwrap();
        assert_eq!((width, height, pixels.len()), (8, 4, 32));
        assert!((pixels[0] - Vec3::new(1.0, 0.5, 0.01)).abs().max_element() < 0.005, "{}", pixels[0]);
        assert_eq!(pixels[8], pixels[15]);
    }

    #[test]
    fn damage_is_reported() {
        let refused = |bytes: &[u8]| read(bytes).unwrap_err();
        assert!(refused(&file(&[0; 20])).contains("ends before"));
        assert!(refused(&file(&[1; 64])).contains("beyond its row"));
        assert!(refused(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n").contains("32-bit_rle_rgbe"));
        let large = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 200000\n";
        assert!(refused(large).contains("at most 8192 x 4096"));
        let square = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 8\n";
        assert!(refused(square).contains("twice as wide as high"));
        assert!(refused(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 8 -Y 4\n").contains("-Y HEIGHT"));
    }
}
