//! The projection that makes lengths exact: a tridiagonal system along the strand.

use super::real::{Real, Vector};

/// Share of a length by which it may be wrong: about what rounding leaves of a segment of centimetres a metre away. The
/// pass outside the solids makes lengths exact.
const RIGHT: f64 = 3e-5;

/// Scratch of the projection.
#[derive(Clone)]
pub struct Lengths<R> {
    tangents: Vec<Vector<R>>,
    upper: Vec<R>,
    tension: Vec<R>,
}

impl<R: Real> Lengths<R> {
    /// Room for strands of a number of points.
    pub fn new(points: usize) -> Self {
        Self {
            tangents: vec![Vector::zero(); points],
            upper: vec![R::of(0.0); points],
            tension: vec![R::of(0.0); points],
        }
    }

    /// Moves the points, each by its inverse mass \[1/kg\], so that every segment has its length \[m\]: at most
    /// `rounds` Newton steps on all lengths of the strand at once, none for lengths that are right. A point lies at
    /// its `start` and `moved` from there \[m\], which alone changes. Held points have inverse mass 0.
    pub fn project(
        &mut self,
        start: &[Vector<R>],
        moved: &mut [Vector<R>],
        inverse_mass: &[R],
        length: &[R],
        rounds: u32,
    ) {
        let last = start.len() - 1;
        for _ in 0..rounds {
            let mut wrong = R::of(0.0);
            for index in 0..last {
                let edge = start[index + 1] - start[index] + (moved[index + 1] - moved[index]);
                let found = edge.length();
                let excess = found - length[index];
                self.tangents[index] = edge * (R::of(1.0) / found);
                self.tension[index] = excess;
                wrong = wrong.or_more(excess.or_more(-excess) - R::of(RIGHT) * length[index]);
            }
            if !wrong.any_positive() {
                return;
            }
            // A strand whose lengths are right stays, whatever those beside it need.
            let moves = wrong.choose(R::of(1.0), R::of(0.0));
            // Thomas's elimination; a segment between two held points keeps its length.
            let (mut before, mut tension) = (R::of(0.0), R::of(0.0));
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
            for index in (0..last).rev() {
                tension = self.tension[index] - self.upper[index] * tension;
                self.tension[index] = tension;
            }
            for index in 0..=last {
                let mut pull =
                    if index < last { self.tangents[index] * self.tension[index] } else { Vector::zero() };
                if index > 0 {
                    pull -= self.tangents[index - 1] * self.tension[index - 1];
                }
                moved[index] += pull * (inverse_mass[index] * moves);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wide::f32x8;

    /// Points of eight strands along x, each with its own spacing; lengths are 0.01 m.
    fn projected(spacing: [f32; 8]) -> Vec<Vector<f32x8>> {
        let at = |index: usize| f32x8::from(spacing.map(|spacing| spacing * index as f32));
        let points: Vec<Vector<f32x8>> = (0..5)
            .map(|index| Vector::new(at(index), at(index * index) * f32x8::splat(0.1), f32x8::ZERO))
            .collect();
        let inverse_mass: Vec<f32x8> =
            (0..5).map(|index| f32x8::splat(if index == 0 { 0.0 } else { 1e6 })).collect();
        let mut moved = vec![Vector::zero(); 5];
        Lengths::new(5).project(&points, &mut moved, &inverse_mass, &[f32x8::splat(0.01); 5], 2);
        points.iter().zip(moved).map(|(point, moved)| *point + moved).collect()
    }

    #[test]
    fn a_strand_does_not_know_those_beside_it() {
        let bits = |points: &[Vector<f32x8>]| -> Vec<[u32; 3]> {
            let lane = |value: f32x8| value.to_array()[3].to_bits();
            points.iter().map(|point| [lane(point.x), lane(point.y), lane(point.z)]).collect()
        };
        // Right after one round, beside such that need both; and wrong, beside such that are alike.
        for own in [0.009_95, 0.008] {
            let mut among_others = [0.004; 8];
            among_others[3] = own;
            assert_eq!(bits(&projected(among_others)), bits(&projected([own; 8])), "{own}");
        }
    }
}
