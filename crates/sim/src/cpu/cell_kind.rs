//! What the cells of the volume hold.

/// Codes of kinds, which shaders know from here.
pub const AIR: u32 = 0;
pub const FLUID: u32 = 1;
pub const SOLID: u32 = 2;

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
