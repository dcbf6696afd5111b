//! The staggered velocities: u, v and w on the faces between cells \[McAdams2009\].

use wide::f32x4;

/// Two numbers on the lower face of every cell, per component.
///
/// While points are summed they are momentum \[kg m/s\] and mass \[kg\]; afterwards the velocity
/// \[m/s\] and its change \[m/s\] since the points were summed. Pairs lie together, so that a point
/// meets each of the four rows of a component as one vector of four numbers.
#[derive(Clone, Debug)]
pub struct Faces {
    /// Shape `[component][cell][2]`, flat in cell and pair.
    pub components: [Vec<f32>; 3],
}

impl Faces {
    /// All zero.
    pub fn new(cell_count: usize) -> Self {
        Self { components: std::array::from_fn(|_| vec![0.0; 2 * cell_count]) }
    }

    /// Velocity \[m/s\] on the lower face of a cell along an axis.
    #[inline]
    pub fn velocity(&self, axis: usize, cell: usize) -> f32 {
        self.components[axis][2 * cell]
    }

    /// Change \[m/s\] of that velocity since the points were summed.
    pub fn change(&self, axis: usize, cell: usize) -> f32 {
        self.components[axis][2 * cell + 1]
    }

    /// Replaces a velocity \[m/s\].
    #[inline]
    pub fn set(&mut self, axis: usize, cell: usize, velocity: f32) {
        let change = velocity - self.velocity(axis, cell);
        change_by(&mut self.components[axis], cell, change);
    }
}

/// Adds to a velocity \[m/s\] of a component.
#[inline]
pub fn change_by(component: &mut [f32], cell: usize, change: f32) {
    let pair = &mut component[2 * cell..][..2];
    pair[0] += change;
    pair[1] += change;
}

/// Quantities that a point transfers to the faces.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Carried {
    /// Its cell.
    pub cell: u32,
    /// Place in the cell \[cells\].
    pub share: [f32; 3],
    /// Mass \[kg\].
    pub mass: f32,
    /// Velocity \[m/s\].
    pub velocity: [f32; 3],
}

/// The trilinear weights of one component around a point: two faces along x in each of four rows.
#[derive(Clone, Copy, Debug)]
pub struct Stencil {
    base: usize,
    along_x: [f32; 2],
    rows: [f32; 4],
}

impl Stencil {
    /// The weights of a point for the component along `AXIS`: faces of that axis lie on cell
    /// borders, in the other axes half a cell further [Chen2011 §4.2.2].
    #[inline]
    pub fn new<const AXIS: usize>(cell: usize, share: [f32; 3], strides: [usize; 3]) -> Self {
        let mut base = cell;
        let mut upper = [0.0; 3];
        for axis in 0..3 {
            let share = share[axis];
            if axis == AXIS {
                upper[axis] = share;
            } else {
                let before = share < 0.5;
                base -= if before { strides[axis] } else { 0 };
                upper[axis] = if before { share + 0.5 } else { share - 0.5 };
            }
        }
        let [x, y, z] = upper;
        Self {
            base,
            along_x: [1.0 - x, x],
            rows: [(1.0 - y) * (1.0 - z), y * (1.0 - z), (1.0 - y) * z, y * z],
        }
    }

    #[inline]
    fn row_starts(&self, strides: [usize; 3]) -> [usize; 4] {
        [0, strides[1], strides[2], strides[1] + strides[2]].map(|offset| 2 * (self.base + offset))
    }

    /// Adds a point's mass \[kg\] and momentum to those of its faces that a part of the component holds, which
    /// begins at a cell `first` and consists of whole layers.
    #[inline]
    pub fn add(&self, component: &mut [f32], first: usize, strides: [usize; 3], mass: f32, velocity: f32) {
        let near = mass * self.along_x[0];
        let far = mass * self.along_x[1];
        let carried = f32x4::new([near * velocity, near, far * velocity, far]);
        for (start, weight) in self.row_starts(strides).into_iter().zip(self.rows) {
            // Rows before the part wrap around to far behind it.
            let start = start.wrapping_sub(2 * first);
            let row = component.get_mut(start..).and_then(|rest| rest.first_chunk_mut::<4>());
            let Some(row) = row else { continue };
            *row = (f32x4::new(*row) + carried * f32x4::splat(weight)).to_array();
        }
    }

    /// Interpolates velocity and change.
    #[inline]
    pub fn interpolate(&self, component: &[f32], strides: [usize; 3]) -> (f32, f32) {
        let mut sum = f32x4::ZERO;
        for (start, weight) in self.row_starts(strides).into_iter().zip(self.rows) {
            let row: &[f32; 4] = component[start..].first_chunk().expect("the ring holds stencils");
            sum += f32x4::new(*row) * f32x4::splat(weight);
        }
        let [near, near_change, far, far_change] = sum.to_array();
        let [x0, x1] = self.along_x;
        (x0 * near + x1 * far, x0 * near_change + x1 * far_change)
    }
}
