//! Stability of a loaded rest shape, and the stiffening that a strand needs for it.

use super::assemble::row;
use super::front::{Factors, Front, ROWS, UNKNOWNS};
use super::joint::{Joint, Segment};
use super::real::Vector;
use super::rod::Node;

/// Margin of stability: a stable shape is still stable with a tenth less stiffness.
const MARGIN: f64 = 1.1;
/// Largest stiffening of a strand. A stiffer strand would be a wire, which no such load could have bent.
const MOST: f64 = 1e4;

/// Stiffening of bends and twists that makes the shape of a sag-free strand a stable equilibrium, with a
/// margin: 1 for a strand that is stable by itself. `loads` are the generalised forces of each joint's
/// strains under the load, which the stiffness does not change; a joint takes its part of `shares` of the
/// stiffening.
///
/// The shape is stable exactly where the pivots of the second derivative of the energy are positive.
pub fn stiffening(rod: &[Node<f64>], segments: &[Segment<f64>], loads: &[[f64; 3]], shares: &[f64]) -> f64 {
    let curvatures: Vec<_> = (0..segments.len())
        .map(|joint| {
            if joint == 0 {
                [[0.0; 8]; 8]
            } else {
                bent(&segments[joint - 1], &segments[joint], loads[joint])
            }
        })
        .collect();
    let stable = |factor: f64| {
        let factors = |joint: usize| (1.0 + (factor - 1.0) * shares[joint]) / MARGIN;
        is_positive(rod, segments, &curvatures, factors)
    };
    if stable(1.0) {
        return 1.0;
    }
    let (mut below, mut above) = (1.0, 2.0);
    while !stable(above) {
        (below, above) = (above, 2.0 * above);
        if above > MOST {
            return MOST;
        }
    }
    while above / below > 1.02 {
        let middle = (below * above).sqrt();
        if stable(middle) { above = middle } else { below = middle }
    }
    above
}

/// True if the pivots of the second derivative of the energy are positive with the bends and twists of each
/// joint stiffened by these factors under the same load.
fn is_positive(
    rod: &[Node<f64>],
    segments: &[Segment<f64>],
    bent: &[[[f64; 8]; 8]],
    factor: impl Fn(usize) -> f64,
) -> bool {
    let mut front = Front::default();
    let (mut factors, mut solved) = (Factors::zero(), [0.0; UNKNOWNS]);
    for (index, node) in rod.iter().enumerate() {
        if let Some(segment) = segments.get(index) {
            add_stretch(&mut front, node, segment);
        }
        if index + 1 < segments.len() {
            let (lower, upper) = (&segments[index], &segments[index + 1]);
            let slopes = Joint::new(lower, upper).slopes(lower, upper);
            let rows = [row(&slopes[0]), row(&slopes[1]), row(&slopes[2])];
            front.add_squares(&rows, rod[index + 1].stiffness.map(|stiffness| stiffness * factor(index + 1)));
            add_bent(&mut front, &bent[index + 1]);
        }
        let free = [node.free, node.free, node.free, node.free_angle];
        // The factors of an indefinite system are meaningless.
        if front.eliminate(&mut factors, &mut solved, free) == 0.0 {
            return false;
        }
        front.clear_above();
    }
    true
}

/// Second derivative of the stretching energy, compression among it.
fn add_stretch(front: &mut Front<f64>, node: &Node<f64>, segment: &Segment<f64>) {
    let stiffness = node.stretch / node.length;
    let across = stiffness * (segment.length - node.length) / segment.length;
    let tangent = segment.tangent.array();
    for row in 0..3 {
        for column in 0..3 {
            let mut value = (stiffness - across) * tangent[row] * tangent[column];
            if row == column {
                value += across;
            }
            if column <= row {
                front.add(row, column, value);
                front.add(row + UNKNOWNS, column + UNKNOWNS, value);
            }
            front.add(row + UNKNOWNS, column, -value);
        }
    }
}

/// Second derivative of `load . strains` of a joint by its edges and angles: lower edge, upper edge,
/// lower angle, upper angle. Central differences of the slopes, made symmetric.
fn bent(lower: &Segment<f64>, upper: &Segment<f64>, load: [f64; 3]) -> [[f64; 8]; 8] {
    let size = lower.length.min(upper.length);
    let gradient = |axis: usize, step: f64| {
        let nudge = |k: usize| if axis == k { step } else { 0.0 };
        let moved = |segment: &Segment<f64>, first: usize, angle: usize| {
            let edge = Vector::new(nudge(first), nudge(first + 1), nudge(first + 2));
            segment.moved(segment.tangent * segment.length + edge, nudge(angle))
        };
        let (lower, upper) = (moved(lower, 0, 6), moved(upper, 3, 7));
        let slopes = Joint::new(&lower, &upper).slopes(&lower, &upper);
        let mut sum = [0.0; 8];
        for (slope, load) in slopes.iter().zip(load) {
            let [a, b, c] = slope.lower.array();
            let [d, e, f] = slope.upper.array();
            let values = [a, b, c, d, e, f, slope.lower_angle, slope.upper_angle];
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += load * value);
        }
        sum
    };
    let mut second = [[0.0; 8]; 8];
    for axis in 0..8 {
        let step = if axis < 6 { 1e-5 * size } else { 1e-5 };
        let (before, after) = (gradient(axis, -step), gradient(axis, step));
        for other in 0..8 {
            let value = 0.25 * (after[other] - before[other]) / step;
            second[axis][other] += value;
            second[other][axis] += value;
        }
    }
    second
}

/// Adds a derivative by edges and angles to the unknowns of the joint: an edge is the difference of two points.
fn add_bent(front: &mut Front<f64>, second: &[[f64; 8]; 8]) {
    // Places of the eleven unknowns in the eight: (index, sign).
    let parts = |unknown: usize| -> [(usize, f64); 2] {
        match unknown {
            0..3 => [(unknown, -1.0), (0, 0.0)],
            3 => [(6, 1.0), (0, 0.0)],
            4..7 => [(unknown - 4, 1.0), (unknown - 1, -1.0)],
            7 => [(7, 1.0), (0, 0.0)],
            _ => [(unknown - 5, 1.0), (0, 0.0)],
        }
    };
    for row in 0..ROWS {
        for column in 0..=row {
            let mut value = 0.0;
            for (a, sign) in parts(row) {
                for (b, other) in parts(column) {
                    value += sign * other * second[a][b];
                }
            }
            front.add(row, column, value);
        }
    }
}
