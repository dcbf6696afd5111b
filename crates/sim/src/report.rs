/// Report of the pressure solve.
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

/// Report of the solve of rods in a step, for the worst of its parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RodReport {
    /// Largest turn of a segment in the last Newton step of a strand \[rad\].
    pub residual: f32,
    /// Strands that would have needed more Newton steps than `newton_steps`.
    pub unsolved: usize,
    /// Strands that stay where they are, to the bit on the CPU.
    pub resting: usize,
}

impl RodReport {
    /// Joins the reports of two sets of strands.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            residual: self.residual.max(other.residual),
            unsolved: self.unsolved + other.unsolved,
            resting: self.resting + other.resting,
        }
    }
}

/// Report of the contacts of strands with each other after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactReport {
    /// Pairs of segments that press.
    pub pairs: usize,
    /// Depth \[m\] of the deepest: by how much the axes are nearer than the wisps are thick.
    pub deepest: f32,
    /// Pairs whose axes have crossed and that are being pushed back.
    pub crossed: usize,
}

/// Strands of rods that were made stiffer than their material, since their shape would not be stable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffening {
    /// Strands that are stiffer.
    pub strands: usize,
    /// All strands.
    pub of: usize,
    /// Stiffness of the stiffest of them over its own; 1 without any.
    pub most: f32,
}

impl Default for Stiffening {
    fn default() -> Self {
        Self { strands: 0, of: 0, most: 1.0 }
    }
}

impl std::fmt::Display for Stiffening {
    fn fmt(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { strands, of, most } = self;
        write!(text, "{strands} of {of} strands stiffer than their material, up to {most:.1} times")
    }
}

/// Quality and cost of one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Wall-clock seconds of each stage, in order.
    pub seconds: Vec<(&'static str, f64)>,
    /// The pressure solve.
    pub pressure: PressureReport,
    /// The solve of rods; none with another strand solver.
    pub rods: Option<RodReport>,
    /// Contacts of strands with each other; none where they pass through each other.
    pub contacts: Option<ContactReport>,
    /// Mean of length / rest length - 1 over all segments.
    pub stretch_mean: f32,
    /// Largest length / rest length - 1 of any segment; not a number where one of them is none.
    pub stretch_max: f32,
    /// Depth \[m\] of the deepest free point inside a collider, looked up where points are after the
    /// step; 0 when none is inside. Of a sampled collider it is as true as the samples.
    pub penetration_max: f32,
    /// Mean speed of all points \[m/s\]: of what moved in the step, whatever the stored velocities say.
    pub speed_mean: f32,
    /// Largest speed of a point \[m/s\], the same way.
    pub speed_max: f32,
    /// Points whose position or velocity is not finite.
    pub non_finite: usize,
    /// The first strand with such a point, from 0; a GPU does not tell.
    pub non_finite_strand: Option<usize>,
}

/// Mean and largest of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// Mean.
    pub mean: f32,
    /// Largest.
    pub max: f32,
}

impl Extent {
    /// Extent of numbers; 0 without any.
    pub(crate) fn of(numbers: Vec<f32>) -> Self {
        let sum: f64 = numbers.iter().map(|number| f64::from(*number)).sum();
        let max = numbers.iter().copied().fold(0.0, f32::max);
        Self { mean: (sum / numbers.len().max(1) as f64) as f32, max }
    }
}

/// Measures of hair at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Force of the air on a guide over the guide's weight; none where the air takes hair along at a rate.
    pub air: Option<Extent>,
    /// Density around a point over that around it at rest; none without hair.
    pub density: Option<Extent>,
}

/// Distance of points from their rest positions on the head, over the lengths of their strands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Mean over all points.
    pub mean: f32,
    /// Largest of any point.
    pub max: f32,
}
