//! What hair is made of, and what that makes of the nodes of a strand.

use super::real::Vector;
use super::rod::Node;

/// Material and section of a hair, and how many hairs a guide stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Radius \[m\] of a hair.
    pub radius: f64,
    /// Young's modulus \[Pa\].
    pub youngs_modulus: f64,
    /// Shear modulus \[Pa\].
    pub shear_modulus: f64,
    /// Density \[kg/m^3\].
    pub density: f64,
    /// Second axis of the section over the first, 1 for a round hair.
    pub ellipticity: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self { radius: 40e-6, youngs_modulus: 3.5e9, shear_modulus: 1.3e9, density: 1300.0, ellipticity: 1.0 }
    }
}

/// Stiffness and weight per length of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Bending stiffness \[N m^2\] about the second and the first axis of the section.
    pub bend: [f64; 2],
    /// Twisting stiffness \[N m^2\].
    pub twist: f64,
    /// Mass per length \[kg/m\].
    pub mass: f64,
    /// Moment of inertia per length about the rod \[kg m\].
    pub inertia: f64,
}

impl Material {
    /// Stiffness and weight of a hair of this material: E I, G J and rho A of an ellipse.
    pub fn section(&self) -> Section {
        let (a, b) = (self.radius, self.radius * self.ellipticity);
        let area = std::f64::consts::PI * a * b;
        let (along, over) = (area * a * a / 4.0, area * b * b / 4.0);
        // Saint-Venant's torsion of an ellipse.
        let torsion = std::f64::consts::PI * (a * b).powi(3) / (a * a + b * b);
        Section {
            bend: [self.youngs_modulus * along, self.youngs_modulus * over],
            twist: self.shear_modulus * torsion,
            mass: self.density * area,
            inertia: self.density * (along + over),
        }
    }
}

/// Tension over strain \[N\] of a strand over the larger of its weight and its bending force B / L^2: lengths
/// are exact to a ten-thousandth before the last projection, and single precision carries it.
const INEXTENSIBLE: f64 = 1e4;

/// The nodes of a strand with points \[m\]; `held` tells which are held. Rest shapes are not set.
///
/// A segment whose both ends are held has no part in the joints beside it: a clamp is half a
/// Voronoi cell.
pub fn nodes(points: &[Vector<f64>], section: &Section, held: impl Fn(usize) -> bool) -> Vec<Node<f64>> {
    let count = points.len();
    let length = |index: usize| (points[index + 1] - points[index]).length();
    let total: f64 = (0..count - 1).map(length).sum();
    let weight = section.mass * total * 9.81;
    let stiffest = section.bend[0].max(section.bend[1]);
    let stretch = INEXTENSIBLE * weight.max(stiffest / (total * total));
    let rigid = |index: usize| held(index) && held(index + 1);
    let mut nodes = vec![Node::zero(); count];
    for (index, node) in nodes.iter_mut().enumerate() {
        node.free = f64::from(!held(index));
        let below = if index > 0 { length(index - 1) } else { 0.0 };
        let above = if index + 1 < count { length(index) } else { 0.0 };
        node.mass = 0.5 * section.mass * (below + above);
        if index + 1 < count {
            node.stretch = stretch;
            node.length = above;
            node.inertia = section.inertia * above;
            node.free_angle = f64::from(!rigid(index));
        }
        if index > 0 && index + 1 < count {
            let cell =
                0.5 * (if rigid(index - 1) { 0.0 } else { below } + if rigid(index) { 0.0 } else { above });
            if cell > 0.0 {
                node.stiffness = [section.bend[0] / cell, section.bend[1] / cell, section.twist / cell];
            }
        }
    }
    nodes
}
