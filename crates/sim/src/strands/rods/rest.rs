//! The rest shape of a rod: lengths, bends and twists without moments, or those that keep its shape in equilibrium under a
//! load.

use glam::Vec3;

use super::joint::Joint;
use super::joint::Segment;
use super::material::Section;
use super::real::Vector;
use super::rod::Node;
use super::stability::stiffening;

/// Segments along points \[m\]: the first section is turned towards `across`, the others follow
/// without twist. Points that coincide keep the direction before them.
pub fn segments(points: &[Vector<f64>], across: Vector<f64>) -> Vec<Segment<f64>> {
    let mut segments: Vec<Segment<f64>> = Vec::with_capacity(points.len() - 1);
    for pair in points.windows(2) {
        let edge = pair[1] - pair[0];
        let next = match segments.last() {
            Some(before) if edge.length() < 1e-9 => Segment { length: 1e-9, ..*before },
            Some(before) => before.moved(edge, 0.0),
            None => {
                let length = edge.length();
                let tangent = edge * (1.0 / length);
                let upright = across - tangent * across.dot(tangent);
                Segment { length, tangent, across: upright * (1.0 / upright.length()) }
            }
        };
        segments.push(next);
    }
    segments
}

/// A direction across the first segment, the same for strands that begin alike.
pub fn across(points: &[Vector<f64>]) -> Vector<f64> {
    let [x, y, z] = (points[1] - points[0]).array().map(f64::abs);
    if x <= y && x <= z {
        Vector::new(1.0, 0.0, 0.0)
    } else if y <= z {
        Vector::new(0.0, 1.0, 0.0)
    } else {
        Vector::new(0.0, 0.0, 1.0)
    }
}

/// Makes a shape free of moments: its rest strains are its own strains.
pub fn unstressed(rod: &mut [Node<f64>], segments: &[Segment<f64>]) {
    for (node, segment) in rod.iter_mut().zip(segments) {
        node.length = segment.length;
    }
    for joint in 1..segments.len() {
        rod[joint].rest = Joint::new(&segments[joint - 1], &segments[joint]).strains;
    }
}

/// Makes a shape an equilibrium under forces on its points \[N\]: subtracts the bends, twists and stretches of the load
/// from the rest strains and lengths, from tip to root, in closed form.
///
/// The moment that a joint carries is that of all forces beyond it; three strains give any moment.
/// An unstable equilibrium is stabilised by stiffer bends and twists, each joint in proportion to the moment that it
/// carries, so that hanging hair stays supple. Returns the largest factor of stiffness, 1 where nothing changed.
pub fn sag_free(
    rod: &mut [Node<f64>],
    points: &[Vector<f64>],
    segments: &[Segment<f64>],
    forces: &[Vector<f64>],
) -> f64 {
    unstressed(rod, segments);
    let (mut loads, mut moments) = (vec![[0.0; 3]; rod.len()], vec![0.0; rod.len()]);
    let mut force = Vector::zero();
    // Moment of the forces beyond about the origin.
    let mut moment = Vector::zero();
    for index in (0..segments.len()).rev() {
        force += forces[index + 1];
        moment += points[index + 1].cross(forces[index + 1]);
        let segment = &segments[index];
        let tension = force.dot(segment.tangent);
        // tension = stretch (length / rest - 1)
        rod[index].length = segment.length / (1.0 + tension / rod[index].stretch).max(0.5);
        if index == 0 {
            break;
        }
        let about = moment - points[index].cross(force);
        loads[index] = strains_under(&segments[index - 1], segment, about);
        moments[index] = about.length();
    }
    let length: f64 = segments.iter().map(|segment| segment.length).sum();
    let shares = shares(&moments, EVEN * force.length() * length);
    let stiffer = stiffening(rod, segments, &loads, &shares);
    for ((node, load), share) in rod.iter_mut().zip(loads).zip(shares) {
        for axis in 0..3 {
            node.stiffness[axis] *= 1.0 + (stiffer - 1.0) * share;
            if node.stiffness[axis] > 0.0 {
                node.rest[axis] -= load[axis] / node.stiffness[axis];
            }
        }
    }
    stiffer
}

/// Hair when it took its shape, as shares of what it is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Former {
    /// Mass per length.
    pub weight: f64,
    /// Stiffness of both bends and of the twist.
    pub stiffness: [f64; 3],
}

impl Former {
    /// Hair that has not changed.
    pub const SAME: Self = Self { weight: 1.0, stiffness: [1.0; 3] };

    /// Hair of a section before it had the section of now.
    pub fn new(before: &Section, now: &Section) -> Self {
        let stiffness = |section: &Section| [section.bend[0], section.bend[1], section.twist];
        let [before_stiffness, stiffness] = [before, now].map(stiffness);
        Self {
            weight: before.mass / now.mass,
            stiffness: std::array::from_fn(|axis| before_stiffness[axis] / stiffness[axis]),
        }
    }

    /// Makes a shape the equilibrium of this hair under gravity \[m/s^2\], as [`sag_free`] does.
    pub fn sag_free(
        &self,
        rod: &mut [Node<f64>],
        points: &[Vector<f64>],
        segments: &[Segment<f64>],
        gravity: Vec3,
    ) -> f64 {
        let forces: Vec<_> =
            rod.iter().map(|node| Vector::from(gravity) * (node.mass * self.weight)).collect();
        for node in &mut *rod {
            node.stiffness = std::array::from_fn(|axis| node.stiffness[axis] * self.stiffness[axis]);
        }
        let stiffer = sag_free(rod, points, segments, &forces);
        for node in rod {
            node.stiffness = std::array::from_fn(|axis| node.stiffness[axis] / self.stiffness[axis]);
        }
        stiffer
    }
}

/// Moment that each joint is taken to carry beyond its own, over that of the whole load at the length of the strand:
/// a strand that stands upright carries none, and is stiffened evenly.
const EVEN: f64 = 0.01;

/// Share of each joint in the stiffening of its strand, 1 where the moment \[N m\] is largest.
fn shares(moments: &[f64], even: f64) -> Vec<f64> {
    let most = moments.iter().fold(0.0_f64, |most, moment| most.max(*moment));
    moments
        .iter()
        .map(|moment| if most + even > 0.0 { (moment + even) / (most + even) } else { 1.0 })
        .collect()
}

/// Generalised forces of the three strains of a joint \[N m\] that carry a moment \[N m\].
fn strains_under(lower: &Segment<f64>, upper: &Segment<f64>, moment: Vector<f64>) -> [f64; 3] {
    // Change of each strain by a rotation of everything beyond the joint.
    let columns = Joint::new(lower, upper)
        .slopes(lower, upper)
        .map(|slope| (upper.tangent * upper.length).cross(slope.upper) + upper.tangent * slope.upper_angle);
    let [a, b, c] = columns;
    let volume = a.dot(b.cross(c));
    if volume.abs() < 1e-12 {
        return [0.0; 3];
    }
    [moment.dot(b.cross(c)) / volume, moment.dot(c.cross(a)) / volume, moment.dot(a.cross(b)) / volume]
}
