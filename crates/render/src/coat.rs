//! Water or lacquer on hair.

use strandline_base::settings;

settings! {
    /// Water or lacquer on hair: it darkens hair, smooths its scales and draws strands together.
    ///
    /// `simulation.strands.rods.hair` brings it along, whatever the look. Under the thesis's fibre the colours of strands of
    /// a file, a map or a group stay.
    pub struct Coat: Copy {
        /// Multiple of the pigment that light meets: the surface of a film throws light back into the hair.
        pigment: f32 = 1.0, in [0.1, 10.0], slider [1.0, 4.0], more "darker hair";
        /// Multiple of the roughness of hair along it, and of the noise of its highlights: a film fills the steps between
        /// scales.
        roughness: f32 = 1.0, in [0.1, 2.0], more "a wider, duller highlight";
        /// Share by which strands come together on their way to the tips, each toward its guide. A scene takes it in for
        /// strands that follow guides when it is loaded.
        gather: f32 = 0.0, in [0.0, 1.0], more "thinner, pointed locks";
    }
}

impl Coat {
    /// Nothing on hair.
    pub const NONE: Self = Self { pigment: 1.0, roughness: 1.0, gather: 0.0 };
    /// Water that drips no more.
    pub const WATER: Self = Self { pigment: 2.0, roughness: 0.5, gather: 0.8 };
    /// Lacquer that has set.
    pub const LACQUER: Self = Self { pigment: 1.1, roughness: 0.8, gather: 0.35 };
}
