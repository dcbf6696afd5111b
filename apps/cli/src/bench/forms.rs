//! One thread per strand against one per point: the rounds of lengths alone [Chen2011 fig. 16-17].

use strandline::measure::{LengthsForm, LengthsInput, lengths_alone};

use super::gpu::{Device, Forms};
use crate::output::print_line;

/// Strands and points of each; the first is the thesis's groom.
const GROOMS: [(usize, usize); 4] = [(1750, 6), (10_000, 16), (10_000, 32), (100_000, 32)];
/// Grooms of a software adapter and of a short run.
const FEW: usize = 2;
const ROUNDS: u32 = 20;
/// The time is the mean of this many runs in a row, the best of a few rows.
const IN_A_ROW: usize = 8;
const ROWS: usize = 3;

impl Device {
    /// Measures both forms, and prints them.
    pub fn forms(&self, quick: bool) -> anyhow::Result<Vec<Forms>> {
        print_line!("\n{ROUNDS} rounds of lengths alone, GPU time [us]");
        print_line!("{:>10}{:>10}{:>22}{:>22}", "strands", "points", "a strand a thread", "a point a thread");
        let count = if quick || self.adapter.software { FEW } else { GROOMS.len() };
        let mut all = Vec::new();
        for (strands, points_per_strand) in GROOMS.into_iter().take(count) {
            let (points, lengths) = stretched(strands, points_per_strand);
            let input =
                LengthsInput { points: &points, lengths: &lengths, points_per_strand, rounds: ROUNDS };
            let mut best = [f64::INFINITY; 2];
            for _ in 0..ROWS {
                for (best, form) in best.iter_mut().zip([LengthsForm::Strand, LengthsForm::Point]) {
                    if let (_, Some(seconds)) = lengths_alone(&self.gpu, &input, form, IN_A_ROW)? {
                        *best = best.min(1e6 * seconds);
                    }
                }
            }
            let [us_strand_a_thread, us_point_a_thread] = best;
            print_line!(
                "{strands:>10}{points_per_strand:>10}{us_strand_a_thread:>22.2}{us_point_a_thread:>22.2}"
            );
            all.push(Forms { strands, points_per_strand, us_strand_a_thread, us_point_a_thread });
        }
        Ok(all)
    }
}

/// Strands a little longer than they should be, held at their first point.
fn stretched(strands: usize, count: usize) -> (Vec<[f32; 4]>, Vec<f32>) {
    let points = (0..strands * count).map(|index| {
        let [strand, point] = [index / count, index % count].map(|number| number as f32);
        [1e-4 * strand, -0.0105 * point, 0.0, if point == 0.0 { 0.0 } else { 1e6 }]
    });
    (points.collect(), vec![0.01; strands * count])
}
