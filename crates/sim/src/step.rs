//! A step as a list of stages, the same on both backends [Chen2011 §4, fig. 11-12].

use crate::{Settings, StrandMethod};

/// Names the stages, in the order of a step, each with the settings that it is there for.
macro_rules! stages {
    ($($(#[$sentence:meta])* $stage:ident = $name:literal, $is_in:ident;)*) => {
        /// A stage of a step. One stem each: its files, the timer label, the check in checks/parity and the row in
        /// ARCHITECTURE.md carry its name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Stage {
            $($(#[$sentence])* $stage,)*
        }

        impl Stage {
            /// All, in the order of a step.
            pub const ALL: &[Self] = &[$(Self::$stage,)*];

            /// Its name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$stage => $name,)*
                }
            }

            /// True if a step with these settings has the stage.
            fn is_in(self, settings: &Settings) -> bool {
                match self {
                    $(Self::$stage => $is_in(settings),)*
                }
            }
        }
    };
}

stages! {
    /// Roots follow the skin.
    PoseRoots = "pose_roots", always;
    /// Air at the points, behind hair and solids.
    Shelter = "shelter", sheltered;
    /// Forces, then a prediction.
    Integrate = "integrate", constrained;
    /// Lengths, bends and solids.
    Constrain = "constrain", constrained;
    /// Strands as rods, in place of these two.
    SolveRods = "solve_rods", rods;
    /// Points sorted by cell, velocities onto faces.
    Splat = "splat", volume;
    /// Kind of each cell.
    Mark = "mark", volume;
    /// Pressure, and its gradient taken away.
    SolvePressure = "solve_pressure", volume;
    /// Velocities back to the points.
    Gather = "gather", volume;
    /// The new state, the report.
    Advance = "advance", always;
}

fn always(_: &Settings) -> bool {
    true
}

fn sheltered(settings: &Settings) -> bool {
    settings.has_shelter()
}

fn constrained(settings: &Settings) -> bool {
    settings.strands.method == StrandMethod::Constrain
}

fn rods(settings: &Settings) -> bool {
    settings.strands.method == StrandMethod::Rods
}

fn volume(settings: &Settings) -> bool {
    settings.volume.enabled
}

/// The stages of a step with these settings, in order.
pub(crate) fn stages(settings: &Settings) -> impl Iterator<Item = Stage> {
    Stage::ALL.iter().copied().filter(|stage| stage.is_in(settings))
}
