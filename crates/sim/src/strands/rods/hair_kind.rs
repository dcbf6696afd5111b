//! Names of kinds of hair.

use strandline_base::choices;

choices! {
    /// Kind of hair. Radii, density and moduli in air and in water are rounded from \[Robbins2012 chapters 8
    /// and 9\]; the water that hair carries and the cohesion of lacquer are judged, not measured.
    pub enum HairKind as "simulation.strands.rods.hair" {
        /// Fine hair: a radius of 25 um.
        Fine = "fine",
        /// Hair as most people have it: 40 um.
        Medium = "medium",
        /// Coarse hair: 60 um.
        Coarse = "coarse",
        /// Medium hair in water: swollen by an eighth, less than half as stiff, a fifth as stiff against twist, and
        /// half its weight of water on it.
        Wet = "wet",
        /// Medium hair under lacquer: ten hairs in a wisp, glued here and there.
        Sprayed = "sprayed",
    }
    default Medium
}
