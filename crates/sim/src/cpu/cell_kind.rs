//! What the cells of the volume hold.

/// What a cell is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Holds no hair: the pressure is 0.
    #[default]
    Air,
    /// Holds hair: the pressure is unknown.
    Fluid,
    /// Inside a solid: nothing flows through its faces but what the solid carries along.
    Solid,
}
