//! The colliders as the kernels read them.

use strandline_base::SettingError;
use strandline_body::{Carrier, Collider, DistanceGrid, Mannequin, Shape};
use strandline_gpu::{Buffer, Gpu};

use super::inputs::Step;
use crate::SimError;

/// Spacing at which the exact mannequin is sampled \[m\]: kernels know grids only.
const MANNEQUIN_SPACING: f32 = 0.003;
/// Air around the mannequin that its samples cover \[m\].
const MANNEQUIN_PADDING: f32 = 0.02;

/// One collider, mirrored by the comment in `solids.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Header {
    kind: u32,
    carried: u32,
    first_node: u32,
    friction: f32,
    /// Centre, start or origin \[m\].
    start: [f32; 3],
    /// Radius or spacing \[m\].
    size: f32,
    end: [f32; 3],
    unused: u32,
    node_counts: [u32; 3],
    unused_too: u32,
}

/// Kinds of colliders, and what carries them.
const SPHERE: u32 = 0;
const CAPSULE: u32 = 1;
const GRID: u32 = 2;
const WORLD: u32 = 0;
const HEAD: u32 = 1;
/// Vectors of a header.
const HEADER: usize = size_of::<Header>() / size_of::<[f32; 4]>();

/// Room for the settings of a step, and behind it the headers of all colliders, then the nodes of the grids among them.
pub(super) fn behind_step(gpu: &Gpu, colliders: &[Collider]) -> Result<Buffer<Step>, SimError> {
    let mut headers = Vec::new();
    let mut nodes: Vec<[f32; 4]> = Vec::new();
    for collider in colliders {
        let mut header = Header {
            carried: match collider.carrier {
                Carrier::World => WORLD,
                Carrier::Head => HEAD,
            },
            friction: collider.friction,
            ..Header::default()
        };
        match &collider.shape {
            Shape::Sphere { center, radius } => {
                header.kind = SPHERE;
                header.start = center.to_array();
                header.size = *radius;
            }
            Shape::Capsule { start, end, radius } => {
                header.kind = CAPSULE;
                header.start = start.to_array();
                header.end = end.to_array();
                header.size = *radius;
            }
            Shape::Mannequin(mannequin) => header.add_grid(&sampled(mannequin)?, colliders.len(), &mut nodes),
            Shape::Grid(grid) => header.add_grid(grid, colliders.len(), &mut nodes),
        }
        headers.push(header);
    }
    let mut all: Vec<[u32; 4]> = bytemuck::cast_slice(&headers).to_vec();
    all.extend(nodes.iter().map(|node| node.map(f32::to_bits)));
    let buffer = Buffer::with_tail::<[u32; 4]>(gpu, "step and solids", 1, all.len())?;
    buffer.write_tail(&all)?;
    Ok(buffer)
}

fn sampled(mannequin: &Mannequin) -> Result<DistanceGrid, SimError> {
    DistanceGrid::from_field(mannequin, MANNEQUIN_SPACING, MANNEQUIN_PADDING)
        .map_err(|error| SettingError::new("the mannequin as a grid", error, "one that fits a GPU").into())
}

impl Header {
    fn add_grid(&mut self, grid: &DistanceGrid, collider_count: usize, nodes: &mut Vec<[f32; 4]>) {
        self.kind = GRID;
        self.start = grid.origin().to_array();
        self.size = grid.spacing();
        self.node_counts = (grid.cells() + 1).to_array();
        self.first_node = (collider_count * HEADER + nodes.len()) as u32;
        nodes.extend(grid.nodes().iter().map(|node| node.to_array()));
    }
}
