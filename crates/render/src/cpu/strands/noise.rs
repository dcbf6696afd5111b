//! A sine that shaders repeat.

/// sin(2 pi turns) by a parabola refined once; the error is below 1.2e-3.
#[inline]
pub(crate) fn sine(turns: f32) -> f32 {
    let phase = turns - (turns + 0.5).floor();
    let parabola = 8.0 * phase - 16.0 * phase * phase.abs();
    0.775 * parabola + 0.225 * parabola * parabola.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_is_close() {
        for step in -400..400 {
            let turns = step as f32 * 0.0137;
            let exact = (f64::from(turns) * std::f64::consts::TAU).sin() as f32;
            assert!((sine(turns) - exact).abs() < 1.2e-3, "{turns}");
        }
    }
}
