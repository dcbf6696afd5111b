//! Settings of strands of springs and constraints.

use strandline_base::{gone, settings};

settings! {
    /// Strands of springs and rounds of constraints [Chen2011 §4].
    pub struct ConstrainSettings: Copy {
        /// Rounds of the constraints in a step [Chen2011 §6].
        iterations: u32 = 20, in [1, 10_000], slider [1, 100],
            more "stiffer bends and firmer contacts, at a higher cost";
        /// Mass of hair per length; the default is that of a hair 80 um thick. Points with masses of their own keep
        /// them.
        mass_per_length: f32 = 6.5e-6, in [1e-9, 1.0] "kg/m", slider [1e-6, 5e-5],
            more "springs that move hair less", invalidates masses;
        /// Elastic springs, each can be off.
        springs: Springs = Springs::default();
        /// Bends at the points of a strand.
        angles: Angles = Angles::default();
        /// The pass that makes lengths exact.
        length_pass: LengthPass = LengthPass::default();
    }
}

impl ConstrainSettings {
    /// The thesis as printed: 20 rounds of distance constraints, springs, no shape and no length pass
    /// [Chen2011 §4, §6].
    pub fn thesis() -> Self {
        Self {
            angles: Angles::OFF,
            length_pass: LengthPass { enabled: false, ..LengthPass::default() },
            ..Self::default()
        }
    }
}

settings! {
    /// Elastic springs along a strand [Chen2011 §4].
    ///
    /// They are integrated explicitly, so a step cannot carry more stiffness than `m / (12 dt^2)` nor
    /// more damping than `m / (12 dt)`, where m is the smaller mass of the two ends; what is above is
    /// cut off there.
    pub struct Springs: Copy {
        /// From point i to i + 1.
        stretch: Spring = Spring { stiffness: 2e-5, ..Spring::default() };
        /// From point i to i + 2.
        bend: Spring = Spring { stiffness: 1e-5, ..Spring::default() };
        /// From point i to i + 3.
        torsion: Spring = Spring { stiffness: 5e-6, ..Spring::default() };
    }
}

impl Springs {
    /// No springs.
    pub const OFF: Self = Self { stretch: Spring::OFF, bend: Spring::OFF, torsion: Spring::OFF };
}

settings! {
    /// A damped elastic spring.
    pub struct Spring: Copy {
        /// Enables the spring.
        enabled: bool = true;
        /// Force over extension.
        stiffness: f32 = 1e-5, in [0.0, 1e30] "N/m", slider [0.0, 2e-4],
            more "a strand that springs back faster, up to what a step can carry";
        /// Force over speed of extension.
        damping: f32 = 2e-7, in [0.0, 1e30] "N s/m", slider [0.0, 2e-6],
            more "springs that swing less, up to what a step can carry";
    }
}

impl Spring {
    /// No spring.
    pub const OFF: Self = Self { enabled: false, stiffness: 0.0, damping: 0.0 };
}

settings! {
    /// Bends at the points of a strand, measured from the rest direction that frames carry from the
    /// head along the strand.
    pub struct Angles: Copy {
        /// Largest bend away from rest at a point; pi is no limit.
        limit: f32 = 0.6, in [0.0, std::f32::consts::PI] "rad", slider [0.05, std::f32::consts::PI],
            more "strands that may fold more sharply";
        /// Angular frequency at which a lone bent segment would swing back to rest; 0 is off.
        stiffness: f32 = 25.0, in [0.0, 10_000.0] "1/s", slider [0.0, 100.0],
            more "hair that keeps its shape against gravity";
        moved { hold: NoHold => "simulation.strands.rods" }
    }
}

gone! {
    /// The rate at which segments once turned back to their style.
    NoHold, "`simulation.angles.hold` is gone: rods keep a style by the stiffness of hair. Leave it out, and set \
             `simulation.strands.rods.youngs_modulus` or `radius` if hair is to be stiffer or softer; or take the \
             strands without it, `simulation.strands.method = \"constrain\"`"
}

impl Angles {
    /// Bends are free.
    pub const OFF: Self = Self { limit: std::f32::consts::PI, stiffness: 0.0 };

    /// True if bends are free.
    pub fn is_off(&self) -> bool {
        self.limit >= std::f32::consts::PI && self.stiffness == 0.0
    }
}

settings! {
    /// The pass from root to tip that makes lengths exact \[Mueller2012\].
    pub struct LengthPass: Copy {
        /// Makes lengths exact; without it strands stretch as in the thesis.
        enabled: bool = true;
        /// Share of the correction of a point that the next prediction of the point before it gives back
        /// [Mueller2012 eq. 9]. It is the same share in a step of any length: what the pass corrects is an
        /// acceleration times the square of the step, so that what it keeps back adds up to as much
        /// velocity in a second.
        correction: f32 = 0.9, in [0.0, 1.0], more "hair that swings on longer, 1 without loss";
    }
}
