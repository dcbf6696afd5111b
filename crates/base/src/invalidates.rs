/// Compiled parts that a change of settings invalidates; none where settings are read anew each time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Invalidates {
    /// Shape at rest.
    pub rest_shape: bool,
    /// Masses, and with them the shape at rest.
    pub masses: bool,
    /// The list of stages, or which kernels a stage has.
    pub stages: bool,
    /// The layout of states, and with it all else.
    pub buffers: bool,
}

impl Invalidates {
    /// Nothing.
    pub const NOTHING: Self = Self { rest_shape: false, masses: false, stages: false, buffers: false };

    /// Parts that one of both changes invalidates.
    pub const fn and(self, other: Self) -> Self {
        Self {
            rest_shape: self.rest_shape || other.rest_shape,
            masses: self.masses || other.masses,
            stages: self.stages || other.stages,
            buffers: self.buffers || other.buffers,
        }
    }
}
