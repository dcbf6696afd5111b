//! Allowed sizes of surroundings.

/// Most pixels that are read: 8,192 x 4,096.
pub(super) const MAX_PIXELS: usize = 1 << 25;

/// Refuses sizes that no panorama has.
pub(super) fn check_size(width: usize, height: usize) -> Result<(), String> {
    let pixels = width.saturating_mul(height);
    if pixels > MAX_PIXELS {
        return Err(format!("{width} x {height} pixels, at most 8192 x 4096 are read: make it smaller"));
    }
    if pixels == 0 || width != 2 * height {
        return Err(format!(
            "{width} x {height} pixels, expected a picture of all directions that is twice as wide as high"
        ));
    }
    Ok(())
}
