//! Settings of rods.

use strandline_base::{Overrides, Value, choices, settings};

use super::hair_kind::HairKind;
use super::material::{Along, Material};

settings! {
    /// Hair as rods: bending and twisting follow from what a hair is made of.
    ///
    /// Stiffness goes with the fourth power of the radius, weight with its square. `hair` sets the defaults of what
    /// hair is made of, `radius` to `damping`, of `rubbing`, and of the groom's shape where hair is wet.
    pub struct RodSettings: Copy {
        /// Kind of hair.
        hair: HairKind = HairKind::default();
        /// Radius of a hair.
        radius: f32 = 40.0, in [1.0, 1000.0] "um", slider [15.0, 100.0],
            more "stiffer, heavier hair", invalidates masses;
        /// Young's modulus.
        youngs_modulus: f32 = 3.5, in [1e-3, 1e5] "GPa", slider [0.1, 20.0],
            more "hair that bends and twists less, at the same weight", invalidates rest_shape;
        /// Poisson's ratio: twisting stiffness over bending stiffness is 1 over 1 plus it.
        poisson_ratio: f32 = 0.35, in [0.0, 0.5], more "curls that unwind a little more easily", invalidates rest_shape;
        /// Shear modulus; without it that of Young's modulus and Poisson's ratio.
        shear_modulus: Option<f32> = None, in [1e-3, 1e5] "GPa", more "hair that twists less", invalidates rest_shape;
        /// Density.
        density: f32 = 1300.0, in [1.0, 20_000.0] "kg/m^3", slider [200.0, 4000.0],
            more "heavier hair that swings more slowly", invalidates masses;
        /// Mass of what hair carries, water or lacquer, over its own.
        load: f32 = 0.0, in [0.0, 20.0], slider [0.0, 3.0], more "hair that gives way more easily", invalidates masses;
        /// Hairs that a guide stands for: they weigh and resist together.
        wisp_hairs: u32 = 1, in [1, 10_000], slider [1, 200],
            more "stiffer hair where `cohesion` is above 0; where it is 0 the air alone moves it otherwise", invalidates masses;
        /// Sharing of load among the hairs of a guide: 0 lets each bend by itself, so that n hairs are n
        /// times as stiff as one; 1 glues them to one, n^2 times; between, n^(1 + cohesion).
        cohesion: f32 = 0.0, in [0.0, 1.0], more "locks that bend as one", invalidates rest_shape;
        /// Share of the section of a wisp that its hairs fill: the air meets no more of them than a cylinder as wide as the wisp.
        packing: f32 = 0.3, in [0.01, 1.0], more "thinner wisps that the wind moves less", invalidates rest_shape;
        /// Relaxation time of bends and twists: what they lag behind their rest.
        damping: f32 = 0.002, in [0.0, 10.0] "s", slider [0.0, 0.1],
            more "bends that swing back more slowly and tremble less", invalidates rest_shape;
        /// Second axis of the section over the first; 1 is round. The first axis, the radius, lies across the
        /// root in the direction of the coordinate axis that the root is farthest from.
        ellipticity: f32 = 1.0, in [0.1, 1.0], more "a rounder hair", invalidates masses;
        /// Radius at the tip over that at the root: it falls evenly from `taper_start` on.
        tip_radius: f32 = 1.0, in [0.05, 1.0], more "tips that are as stiff and heavy as the rest", invalidates masses;
        /// Share of the length where hair begins to taper.
        taper_start: f32 = 0.5, in [0.0, 0.99], more "a shorter taper", invalidates masses;
        /// Stiffness at the root, in the middle and at the tip over that of the material, evenly between.
        profile: [f32; 3] = [1.0; 3], in [0.01, 100.0], slider [0.1, 10.0],
            more "hair that bends less there", invalidates rest_shape;
        /// Deceleration by hairs that rub against each other, relative to the head. A shape at rest among other hair may be
        /// off by what this much gravity bends it; of a strand without others beside it by a twentieth of that, and while
        /// slow it loses 4 of its speed in a second at most.
        rubbing: f32 = 0.2, in [0.0, 100.0] "m/s^2", slider [0.0, 1.0],
            more "hair that comes to rest sooner after its last small swings";
        /// Meaning of the groom's shape.
        rest: Rest = Rest::default(), invalidates rest_shape;
        /// Parts of a step that are solved one after the other.
        substeps: u32 = 2, in [1, 64], slider [1, 8], more "hair that swings longer, at a higher cost";
        /// Most Newton steps of each part; strands that move gently need one or two. With one, hair that comes down onto
        /// a solid is put out of it without friction.
        newton_steps: u32 = 4, in [1, 64], slider [1, 16],
            more "violent motion that is followed more closely, at a higher cost where it is needed";
        /// A strand is solved when a Newton step turns none of its segments farther. The angle that is left is a
        /// tenth to a hundredth of it; hair that rubs comes to the same rest.
        tolerance: f32 = 0.01, in [1e-5, 1.0] "rad", slider [1e-4, 0.05],
            more "fewer Newton steps, motion that is followed less closely";
    }
    prepare RodSettings::prepare;
}

choices! {
    /// Meaning of a groom's shape.
    pub enum Rest as "simulation.strands.rods.rest" {
        /// The equilibrium under gravity, which hair keeps.
        SagFree = "sag_free",
        /// The shape without any load: it sags.
        Unstressed = "unstressed",
        /// The equilibrium under gravity of the same hair when it was dry: under water or lacquer it droops.
        Dry = "dry",
    }
    default SagFree
}

settings! {
    /// Hair of a group of the groom that is made of something else than the rest. Values that it does not give are
    /// those of `[simulation.strands.rods]`.
    pub struct GroupSettings {
        /// The group: its name in the groom, or its number.
        group: String = String::new(), required true;
        overrides RodSettings {
            hair: HairKind,
            radius: f32,
            youngs_modulus: f32,
            poisson_ratio: f32,
            shear_modulus: f32,
            density: f32,
            load: f32,
            wisp_hairs: u32,
            cohesion: f32,
            packing: f32,
            damping: f32,
            ellipticity: f32,
            tip_radius: f32,
            taper_start: f32,
            profile: [f32; 3],
        }
    }
}

impl RodSettings {
    /// A file that names a kind of hair begins with its numbers.
    fn prepare(&mut self, given: &<Self as Value>::Given) {
        if let Some(hair) = given.hair {
            self.set_hair(hair);
        }
    }

    /// The material of a hair, in SI units.
    pub fn material(&self) -> Material {
        let youngs_modulus = f64::from(self.youngs_modulus) * 1e9;
        Material {
            radius: f64::from(self.radius) * 1e-6,
            youngs_modulus,
            shear_modulus: match self.shear_modulus {
                Some(modulus) => f64::from(modulus) * 1e9,
                // Of an isotropic solid.
                None => youngs_modulus / (2.0 * (1.0 + f64::from(self.poisson_ratio))),
            },
            density: f64::from(self.density) * (1.0 + f64::from(self.load)),
            ellipticity: f64::from(self.ellipticity),
            hairs: f64::from(self.wisp_hairs),
            cohesion: f64::from(self.cohesion),
            along: Along {
                tip: f64::from(self.tip_radius),
                start: f64::from(self.taper_start),
                stiffness: self.profile.map(f64::from),
            },
        }
    }

    /// These settings with those that a group overrides.
    pub fn of_group(&self, group: &GroupSettings) -> Self {
        let mut kind = *self;
        if let Some(hair) = group.hair {
            kind.set_hair(hair);
        }
        let mut rods = Self { rest: kind.rest, ..group.over(self) };
        if group.shear_modulus.is_none() {
            let share = |shear| shear * rods.youngs_modulus / kind.youngs_modulus;
            rods.shear_modulus = kind.shear_modulus.filter(|_| group.poisson_ratio.is_none()).map(share);
        }
        rods
    }

    /// Bending stiffness E I \[N m^2\] of what a guide stands for, about the weaker axis of its section, at a share of the
    /// length from the root.
    pub fn bend_stiffness(&self, share: f32) -> f32 {
        let section = self.material().section();
        (section.bend[0].min(section.bend[1]) * section.along.stiffness(f64::from(share))) as f32
    }

    /// Mass per length at the root of what a guide stands for \[kg/m\].
    pub fn mass_per_length(&self) -> f32 {
        self.material().section().mass as f32
    }
}
