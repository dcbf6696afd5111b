//! A step as a list of stages, the same on both backends [Chen2011 §4, fig. 11-12].

use crate::{Settings, StrandMethod};

/// A stage of a step. One stem each: its folder or files, the timer label, the check in checks/parity and the row in
/// ARCHITECTURE.md carry its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Roots follow the skin.
    PoseRoots,
    /// Forces, then a prediction; for strands that are constrained.
    Integrate,
    /// Lengths, bends and solids; for strands that are constrained.
    Constrain,
    /// Strands as rods, in place of these two.
    SolveRods,
    /// Points sorted by cell, velocities onto faces; this and what follows for a volume.
    Splat,
    /// What each cell is.
    Mark,
    /// Pressure, and its gradient taken away.
    SolvePressure,
    /// Velocities back to the points.
    Gather,
    /// The new state, the report.
    Advance,
}

impl Stage {
    /// All, in the order of a step.
    pub const ALL: [Self; 9] = [
        Self::PoseRoots,
        Self::Integrate,
        Self::Constrain,
        Self::SolveRods,
        Self::Splat,
        Self::Mark,
        Self::SolvePressure,
        Self::Gather,
        Self::Advance,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::PoseRoots => "pose_roots",
            Self::Integrate => "integrate",
            Self::Constrain => "constrain",
            Self::SolveRods => "solve_rods",
            Self::Splat => "splat",
            Self::Mark => "mark",
            Self::SolvePressure => "solve_pressure",
            Self::Gather => "gather",
            Self::Advance => "advance",
        }
    }

    /// Whether a step with these settings has it.
    fn is_in(self, settings: &Settings) -> bool {
        match self {
            Self::PoseRoots | Self::Advance => true,
            Self::Integrate | Self::Constrain => settings.strands.method == StrandMethod::Constrain,
            Self::SolveRods => settings.strands.method == StrandMethod::Rods,
            Self::Splat | Self::Mark | Self::SolvePressure | Self::Gather => settings.volume.enabled,
        }
    }
}

/// The stages of a step with these settings, in order.
pub(crate) fn stages(settings: &Settings) -> impl Iterator<Item = Stage> {
    Stage::ALL.into_iter().filter(|stage| stage.is_in(settings))
}
