//! The projection that makes lengths exact: a tridiagonal system along the strand.

use super::real::{Real, Vector};

/// Share of a length by which it may be wrong: about what rounding leaves of a segment of centimetres a metre away. The
/// pass outside the solids makes lengths exact.
const RIGHT: f64 = 3e-5;

/// What the projection works in.
pub struct Lengths<R> {
    tangents: Vec<Vector<R>>,
    upper: Vec<R>,
    tension: Vec<R>,
}

impl<R: Real> Lengths<R> {
    /// For strands of so many points.
    pub fn new(points: usize) -> Self {
        Self {
            tangents: vec![Vector::zero(); points],
            upper: vec![R::of(0.0); points],
            tension: vec![R::of(0.0); points],
        }
    }

    /// Moves the points \[m\], each by its inverse mass \[1/kg\], so that every segment has its length
    /// \[m\]: at most `rounds` Newton steps on all lengths of the strand at once, none for lengths that are right.
    /// Held points have inverse mass 0.
    pub fn project(&mut self, points: &mut [Vector<R>], inverse_mass: &[R], length: &[R], rounds: u32) {
        let last = points.len() - 1;
        for _ in 0..rounds {
            let mut wrong = R::of(0.0);
            for index in 0..last {
                let edge = points[index + 1] - points[index];
                let found = edge.length();
                let excess = found - length[index];
                self.tangents[index] = edge * (R::of(1.0) / found);
                self.tension[index] = excess;
                wrong = wrong.or_more(excess.or_more(-excess) - R::of(RIGHT) * length[index]);
            }
            if !wrong.any_positive() {
                return;
            }
            // Thomas's elimination; a segment between two held points keeps its length.
            let mut before = R::of(0.0);
            for index in 0..last {
                let sum = inverse_mass[index] + inverse_mass[index + 1];
                let coupled = if index > 0 {
                    -(inverse_mass[index] * self.tangents[index].dot(self.tangents[index - 1]))
                } else {
                    R::of(0.0)
                };
                let upper = if index > 0 { self.upper[index - 1] } else { R::of(0.0) };
                let inverse = R::of(1.0) / sum.choose(sum - coupled * upper, R::of(1.0));
                let excess = sum.choose(self.tension[index], R::of(0.0));
                before = (excess - coupled * before) * inverse;
                self.tension[index] = before;
                if index + 1 < last {
                    let next = self.tangents[index].dot(self.tangents[index + 1]);
                    self.upper[index] = -(inverse_mass[index + 1] * next) * inverse;
                }
            }
            self.upper[last - 1] = R::of(0.0);
            let mut tension = R::of(0.0);
            for index in (0..last).rev() {
                tension = self.tension[index] - self.upper[index] * tension;
                self.tension[index] = tension;
            }
            for index in 0..=last {
                let mut pull = Vector::zero();
                if index < last {
                    pull = self.tangents[index] * self.tension[index];
                }
                if index > 0 {
                    pull -= self.tangents[index - 1] * self.tension[index - 1];
                }
                points[index] += pull * inverse_mass[index];
            }
        }
    }
}
