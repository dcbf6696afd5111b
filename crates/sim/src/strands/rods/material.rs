//! Materials of hair, and the nodes of a strand made of them.

use strandline_base::math;

use super::real::Vector;
use super::rod::Node;

/// Material and section of a hair, how these change along it, and how many hairs a guide stands for.
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
    /// Hairs that a guide stands for.
    pub hairs: f64,
    /// Sharing of load: 0 lets each bend by itself, 1 glues them to one.
    pub cohesion: f64,
    /// Changes of hair from root to tip.
    pub along: Along,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            radius: 40e-6,
            youngs_modulus: 3.5e9,
            shear_modulus: 1.3e9,
            density: 1300.0,
            ellipticity: 1.0,
            hairs: 1.0,
            cohesion: 0.0,
            along: Along::EVEN,
        }
    }
}

/// Changes of a hair from its root, at a share of 0 of its length, to its tip, at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Radius at the tip over that at the root.
    pub tip: f64,
    /// Share of the length from which on the radius falls evenly.
    pub start: f64,
    /// Stiffness at root, middle and tip over that of the material, evenly between.
    pub stiffness: [f64; 3],
}

impl Along {
    /// The same everywhere.
    pub const EVEN: Self = Self { tip: 1.0, start: 0.5, stiffness: [1.0; 3] };

    /// Radius at a share of the length over that at the root.
    pub fn radius(&self, share: f64) -> f64 {
        let tapered = ((share - self.start) / (1.0 - self.start)).clamp(0.0, 1.0);
        1.0 + (self.tip - 1.0) * tapered
    }

    /// Weight per length at a share of the length over that at the root.
    pub fn weight(&self, share: f64) -> f64 {
        self.radius(share).powi(2)
    }

    /// Stiffness there over that of the material at the root.
    pub fn stiffness(&self, share: f64) -> f64 {
        let [root, middle, tip] = self.stiffness;
        let (half, from, to) = if share < 0.5 { (0.0, root, middle) } else { (0.5, middle, tip) };
        let profile = from + (to - from) * 2.0 * (share - half).min(0.5);
        self.radius(share).powi(4) * profile
    }
}

/// Stiffness and weight per length of a rod at its root.
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
    /// Changes along it.
    pub along: Along,
}

impl Material {
    /// Diameter \[m\] of a round hair of the same area.
    pub fn diameter(&self) -> f64 {
        2.0 * self.radius * self.ellipticity.sqrt()
    }

    /// Stiffness and weight of the hairs that a guide stands for: E I, G J and rho A of an ellipse times their number;
    /// glued hairs have the second moments of one bundle of their area.
    pub fn section(&self) -> Section {
        let (a, b) = (self.radius, self.radius * self.ellipticity);
        let area = std::f64::consts::PI * a * b;
        let (along, over) = (area * a * a / 4.0, area * b * b / 4.0);
        // Saint-Venant's torsion of an ellipse.
        let torsion = std::f64::consts::PI * (a * b).powi(3) / (a * a + b * b);
        let resisting = math::powf(self.hairs, 1.0 + self.cohesion);
        Section {
            bend: [along, over].map(|moment| resisting * self.youngs_modulus * moment),
            twist: resisting * self.shear_modulus * torsion,
            mass: self.hairs * self.density * area,
            inertia: resisting * self.density * (along + over),
            along: self.along,
        }
    }
}

/// Tension over strain \[N\] of a strand over the larger of its weight and its bending force B / L^2: lengths
/// are exact to a ten-thousandth before the last projection, and single precision carries it.
pub(super) const INEXTENSIBLE: f64 = 1e4;

/// w L / (B / L^2): below, a strand that is clamped at its root stands upright [Greenhill1881], and a solid at its tip may
/// press it with more than its weight.
const STANDS: f64 = 7.837;
/// Stiffness of a solid's spring over that of such a strand along itself: it may not sink in before it bends.
const END_ON: f64 = 2.0;

/// The nodes of a strand with points \[m\]; `held` tells which are held. Rest shapes are not set.
///
/// A segment with both ends held takes no part in the joints beside it: a clamp is half a
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
    let mut passed = 0.0;
    for (index, node) in nodes.iter_mut().enumerate() {
        node.free = f64::from(!held(index));
        let below = if index > 0 { length(index - 1) } else { 0.0 };
        let above = if index + 1 < count { length(index) } else { 0.0 };
        let share = |way: f64| way / total;
        let weight = |from: f64, length: f64| length * section.along.weight(share(from + 0.5 * length));
        node.mass = 0.5 * section.mass * (weight(passed - below, below) + weight(passed, above));
        if index + 1 < count {
            node.stretch = stretch;
            node.length = above;
            node.inertia =
                section.inertia * above * section.along.weight(share(passed + 0.5 * above)).powi(2);
            node.free_angle = f64::from(!rigid(index));
        }
        if index > 0 && index + 1 < count {
            let cell =
                0.5 * (if rigid(index - 1) { 0.0 } else { below } + if rigid(index) { 0.0 } else { above });
            if cell > 0.0 {
                let stiffness = section.along.stiffness(share(passed)) / cell;
                node.stiffness = [section.bend[0], section.bend[1], section.twist].map(|one| one * stiffness);
            }
        }
        passed += above;
    }
    let stands = STANDS * stiffest / (total * total) > weight;
    let is_loose = (1..count).all(|index| held(index - 1) || !held(index));
    if stands && is_loose {
        nodes[count - 1].stretch = END_ON * stretch / total;
    }
    nodes
}
