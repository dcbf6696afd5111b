//! Half floats as a device stores them.

/// The number of a half float as it is stored.
pub(super) fn from_half(bits: u32) -> f32 {
    let (sign, exponent, fraction) = (bits >> 15 & 1, bits >> 10 & 31, bits & 1023);
    let value = match exponent {
        0 => fraction as f32 * 2.0_f32.powi(-24),
        31 => f32::INFINITY,
        _ => (1.0 + fraction as f32 / 1024.0) * 2.0_f32.powi(exponent as i32 - 15),
    };
    if sign == 1 { -value } else { value }
}

/// The half float nearest to a number, as it is stored; beyond their range the greatest.
pub(super) fn to_half(value: f32) -> u32 {
    const GREATEST: f32 = 65_504.0;
    // 2^-112: exponents then begin where those of half floats do.
    let bits = (value.abs().min(GREATEST) * f32::from_bits(15 << 23)).to_bits();
    (bits + 0xfff + (bits >> 13 & 1)) >> 13 | u32::from(value.is_sign_negative()) << 15
}
