//! Names of looks.

use strandline_base::choices;

choices! {
    /// A look by its name.
    pub enum Preset as "look.preset" {
        /// Brown hair.
        Brown = "brown",
        /// Black hair.
        Black = "black",
        /// Blonde hair, lighter toward the tips.
        Blonde = "blonde" or "blond",
        /// Red hair, also named "copper".
        Red = "red" or "copper" or "ginger",
        /// Grey hair: white strands among dark ones.
        Grey = "grey" or "gray",
        /// Brown hair as [Chen2011] lights it: the fibre of [Scheuermann2004], brighter surroundings.
        Thesis = "thesis",
    }
    default Brown
}
