//! What a person may set of rods.

use strandline_base::{choices, settings};

use super::material::Material;

settings! {
    /// Hair as rods: bending and twisting follow from what a hair is made of.
    ///
    /// Stiffness goes with the fourth power of the radius, weight with its square.
    pub struct RodSettings: Copy {
        /// Radius of a hair; fine hair has 25, coarse 60.
        radius: f32 = 40.0, in [1.0, 1000.0] "um", slider [15.0, 100.0],
            more "stiffer, heavier hair";
        /// Young's modulus.
        youngs_modulus: f32 = 3.5, in [1e-3, 1e5] "GPa", slider [0.1, 20.0],
            more "hair that bends and twists less, at the same weight";
        /// Poisson's ratio: twisting stiffness over bending stiffness is 1 over 1 plus it.
        poisson_ratio: f32 = 0.35, in [0.0, 0.5], more "curls that unwind a little more easily";
        /// Density.
        density: f32 = 1300.0, in [1.0, 20_000.0] "kg/m^3", slider [200.0, 4000.0],
            more "heavier hair that swings more slowly";
        /// Relaxation time of bends and twists: what they lag behind their rest.
        damping: f32 = 0.002, in [0.0, 10.0] "s", slider [0.0, 0.1],
            more "bends that swing back more slowly and tremble less";
        /// What the shape of the groom is.
        rest: Rest = Rest::default();
        /// Parts of a step that are solved one after the other.
        substeps: u32 = 2, in [1, 64], slider [1, 8], more "hair that swings longer, at a higher cost";
        /// Most Newton steps of each part; strands that move gently need one or two.
        newton_steps: u32 = 4, in [1, 64], slider [1, 16],
            more "violent motion that is followed more closely, at a higher cost where it is needed";
    }
}

choices! {
    /// What the shape of a groom is.
    pub enum Rest as "simulation.strands.rods.rest" {
        /// The equilibrium under gravity, which hair keeps.
        SagFree = "sag_free",
        /// The shape without any load: it sags.
        Unstressed = "unstressed",
    }
    default SagFree
}

impl RodSettings {
    /// The material of a hair, in SI units.
    pub fn material(&self) -> Material {
        let youngs_modulus = f64::from(self.youngs_modulus) * 1e9;
        Material {
            radius: f64::from(self.radius) * 1e-6,
            youngs_modulus,
            // Of an isotropic solid.
            shear_modulus: youngs_modulus / (2.0 * (1.0 + f64::from(self.poisson_ratio))),
            density: f64::from(self.density),
            ellipticity: 1.0,
        }
    }

    /// Mass of hair per length \[kg/m\].
    pub fn mass_per_length(&self) -> f32 {
        self.material().section().mass as f32
    }
}
