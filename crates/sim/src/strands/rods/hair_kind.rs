//! Names of kinds of hair.

use strandline_base::choices;

choices! {
    /// Kind of hair. Radii, density and moduli in air and in water are rounded from \[Robbins2012 chapters 8
    /// and 9\]; the water that hair carries, the cohesion of lacquer, packing and rubbing are judged, not measured.
    ///
    /// In a scene it brings `look.coat` along, and `film.settle` where hair is wet; a group's brings the second alone.
    pub enum HairKind as "simulation.strands.rods.hair" {
        /// Fine hair: a radius of 25 um.
        Fine = "fine",
        /// Hair as most people have it: 40 um.
        Medium = "medium",
        /// Coarse hair: 60 um.
        Coarse = "coarse",
        /// Medium hair in water: swollen by an eighth, less than half as stiff, a fifth as stiff against twist, and
        /// half its weight of water on it, in wisps twice as dense. A groom is dry hair that droops when wetted.
        Wet = "wet",
        /// Medium hair under lacquer: ten hairs in a wisp, glued here and there, that hold still until more moves them.
        Sprayed = "sprayed",
    }
    default Medium
}
