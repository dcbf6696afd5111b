//! Names of looks.

use strandline_base::choices;

choices! {
    /// A look by its name.
    pub enum Preset as "look.preset" {
        /// Brown hair.
        Brown = "brown",
        /// Black hair with a narrow ring of light.
        Black = "black",
        /// Blonde hair, lighter toward the tips.
        Blonde = "blonde" or "blond",
        /// Deep red hair, also named "auburn".
        Red = "red" or "auburn",
        /// Light red hair without dark pigment, also named "ginger".
        Copper = "copper" or "ginger",
        /// Grey hair: white strands among dark ones.
        Grey = "grey" or "gray",
        /// White hair.
        White = "white",
        /// Hair dyed blue.
        Blue = "blue",
        /// Hair dyed pink.
        Pink = "pink",
        /// Hair dyed violet.
        Violet = "violet" or "purple",
        /// Hair dyed green.
        Green = "green",
        /// Brown hair as [Chen2011] lights it: the fibre of [Scheuermann2004], brighter surroundings.
        Thesis = "thesis",
    }
    default Brown
}
