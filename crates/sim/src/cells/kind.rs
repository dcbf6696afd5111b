//! Contents of the cells of the volume.

/// Codes of kinds, which shaders know from here.
pub const AIR: u32 = 0;
pub const FLUID: u32 = 1;
pub const SOLID: u32 = 2;

/// The content of a cell.
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

impl Kind {
    /// Its code in shaders.
    pub(crate) fn code(self) -> u32 {
        match self {
            Self::Air => AIR,
            Self::Fluid => FLUID,
            Self::Solid => SOLID,
        }
    }

    /// The kind of a code; unknown codes are air.
    pub(crate) fn of_code(code: u32) -> Self {
        match code {
            FLUID => Self::Fluid,
            SOLID => Self::Solid,
            _ => Self::Air,
        }
    }
}
