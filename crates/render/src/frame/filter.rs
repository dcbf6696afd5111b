//! From samples to pixels, in linear light [Chen2011 §3.5].
//!
//! At two samples along each axis a pixel is filtered from five places: its middle and four places one
//! sample away from it along the diagonals. Each place lies on the corner of four samples and takes
//! their mean. The middle weighs 1/2, each of the others 1/8: five weights of sum 1. Every sample
//! gives the same total, 1/4, to the picture, so that thin hairs keep their coverage wherever they lie.

use glam::Vec4;

use super::samples::Samples;
use crate::PictureSettings;

/// The filtered pixels before exposure and tone map: linear RGB times opacity, and opacity, shape
/// `[row][column]`.
pub fn resolve_linear(samples: &Samples, settings: &PictureSettings) -> Vec<Vec4> {
    let mut filter = Filter::new(samples, settings);
    (0..settings.height as usize).flat_map(|row| filter.row(row).to_vec()).collect()
}

/// The filter and its working memory.
pub(crate) struct Filter<'a> {
    samples: &'a Samples,
    doubled: bool,
    /// Sums over four rows and over the middle two, with a column repeated at each end.
    wide: Vec<Vec4>,
    narrow: Vec<Vec4>,
    pixels: Vec<Vec4>,
}

impl<'a> Filter<'a> {
    pub(crate) fn new(samples: &'a Samples, settings: &PictureSettings) -> Self {
        let width = samples.width() + 2;
        Self {
            samples,
            doubled: settings.supersampling == 2,
            wide: vec![Vec4::ZERO; width],
            narrow: vec![Vec4::ZERO; width],
            pixels: vec![Vec4::ZERO; settings.width as usize],
        }
    }

    /// The filtered pixels of a row: linear RGB times opacity, and opacity.
    pub(crate) fn row(&mut self, row: usize) -> &[Vec4] {
        if self.doubled {
            self.sum_rows(row);
            self.sum_columns();
        } else {
            let samples = self.samples.row(row).flatten();
            self.pixels.iter_mut().zip(samples).for_each(|(pixel, sample)| *pixel = *sample);
        }
        &self.pixels
    }

    fn sum_rows(&mut self, row: usize) {
        // Outside the picture the outermost samples are repeated.
        let inside = |row: isize| row.clamp(0, self.samples.height() as isize - 1) as usize;
        let first = 2 * row as isize - 1;
        let [a, b, c, d] = [0, 1, 2, 3].map(|offset| self.samples.row(inside(first + offset)));
        let mut column = 1;
        for (((a, b), c), d) in a.zip(b).zip(c).zip(d) {
            let wide = &mut self.wide[column..][..a.len()];
            let narrow = &mut self.narrow[column..][..a.len()];
            for at in 0..a.len() {
                narrow[at] = b[at] + c[at];
                wide[at] = narrow[at] + (a[at] + d[at]);
            }
            column += a.len();
        }
        for sums in [&mut self.wide, &mut self.narrow] {
            sums[0] = sums[1];
            sums[column] = sums[column - 1];
        }
    }

    fn sum_columns(&mut self) {
        for (column, pixel) in self.pixels.iter_mut().enumerate() {
            let first = 2 * column;
            let wide = &self.wide[first..first + 4];
            let narrow = &self.narrow[first + 1..first + 3];
            // The four outer places together hold each of the 16 samples once, at 1/8 of 1/4; the
            // middle adds 1/2 of 1/4 for the inner four.
            let outer = (wide[0] + wide[1]) + (wide[2] + wide[3]);
            *pixel = outer * (1.0 / 32.0) + (narrow[0] + narrow[1]) * (1.0 / 8.0);
        }
    }
}
