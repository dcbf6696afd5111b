/// What the pressure solve did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PressureReport {
    /// Conjugate-gradient iterations.
    pub iterations: usize,
    /// Iterations after which the residual would have met the tolerance as an absolute one \[m/s\].
    pub iterations_absolute: usize,
    /// Residual over the first residual, largest absolute component.
    pub relative_residual: f32,
    /// Residual \[m/s\], largest absolute component: what still flows out of a cell, over the area
    /// of a face.
    pub absolute_residual: f32,
    /// Unknowns: cells that hold hair.
    pub fluid_cells: usize,
}

/// Quality and cost of one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Wall-clock seconds of each stage, in order.
    pub seconds: Vec<(&'static str, f64)>,
    /// The pressure solve.
    pub pressure: PressureReport,
    /// Mean of length / rest length - 1 over all segments.
    pub stretch_mean: f32,
    /// Largest length / rest length - 1 of any segment; not a number where one of them is none.
    pub stretch_max: f32,
    /// Depth \[m\] of the deepest free point inside a collider, looked up where points are after the
    /// step; 0 when none is inside. Of a sampled collider it is as true as the samples.
    pub penetration_max: f32,
    /// Points whose position or velocity is not finite.
    pub non_finite: usize,
    /// The first strand with such a point, from 0; a GPU does not tell.
    pub non_finite_strand: Option<usize>,
}
