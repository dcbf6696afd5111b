use strandline_body::{Collider, Pose};
use strandline_groom::{Guides, RestShape};

use crate::{Drive, Settings, SimError, State, StepReport};

/// The compiled solver: rest shape, settings and colliders. It does not change while time passes.
pub struct Solver {
    pub(crate) settings: Settings,
    pub(crate) rest: RestShape,
    pub(crate) colliders: Vec<Collider>,
}

impl Solver {
    /// Compiles a solver.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn new(_guides: &Guides, _settings: &Settings, _colliders: Vec<Collider>) -> Result<Self, SimError> {
        unimplemented!("strand solver")
    }

    /// The guides at rest, carried by a pose of the head.
    pub fn rest_state(&self, _world_from_head: Pose) -> State {
        unimplemented!("strand solver")
    }

    /// Advances a state by one step of `settings.time_step`.
    pub fn step(&self, _state: &mut State, _drive: &Drive) -> StepReport {
        unimplemented!("strand solver")
    }
}
