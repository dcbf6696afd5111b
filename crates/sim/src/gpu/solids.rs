//! The colliders as the kernels read them.

use strandline_base::SettingError;
use strandline_body::{BodyFrame, Carrier, Collider, DistanceGrid, Mannequin, Shape};
use strandline_gpu::{Buffer, Gpu, GpuError};

use super::inputs::Step;
use super::motion::{Piece, part_count, piece_count};
use crate::{Model, SimError};

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

/// Kinds of colliders, and their carriers: the world, the head, then the other pieces of the body.
const SPHERE: u32 = 0;
const CAPSULE: u32 = 1;
const GRID: u32 = 2;
const WORLD: u32 = 0;
const HEAD: u32 = 1;
/// Vectors of a piece behind the head, which lie before the headers.
const PIECE: usize = size_of::<Piece>() / size_of::<[f32; 4]>();
/// Vectors of a header.
const HEADER: usize = size_of::<Header>() / size_of::<[f32; 4]>();

/// Writes the pieces behind the head for a step between two frames of the body.
///
/// # Errors
/// The device was lost.
pub(super) fn write_pieces(
    buffer: &Buffer<Step>,
    model: &Model,
    [start, end]: [&BodyFrame; 2],
) -> Result<(), GpuError> {
    let count = piece_count(&model.colliders);
    if count == 1 {
        return Ok(());
    }
    let parts = part_count(model);
    let piece = |piece| Piece::new(&start.piece(piece), &end.piece(piece), parts);
    buffer.write_tail(&(1..count).map(piece).collect::<Vec<_>>())
}

/// Room for the settings of a step, and behind it the pieces behind the head, the headers of all colliders, then the nodes of the grids among them.
pub(super) fn behind_step(gpu: &Gpu, colliders: &[Collider]) -> Result<Buffer<Step>, SimError> {
    let before = PIECE * (piece_count(colliders) - 1);
    let mut headers = Vec::new();
    let mut nodes: Vec<[f32; 4]> = Vec::new();
    let first_node = before + colliders.len() * HEADER;
    for collider in colliders {
        let mut header = Header {
            carried: match collider.carrier {
                Carrier::World => WORLD,
                Carrier::Piece(piece) => HEAD + u32::from(piece),
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
            Shape::Mannequin(mannequin) => header.add_grid(&sampled(mannequin)?, first_node, &mut nodes),
            Shape::Grid(grid) => header.add_grid(grid, first_node, &mut nodes),
        }
        headers.push(header);
    }
    let mut all = vec![[0; 4]; before];
    all.extend_from_slice(bytemuck::cast_slice(&headers));
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
    fn add_grid(&mut self, grid: &DistanceGrid, first_node: usize, nodes: &mut Vec<[f32; 4]>) {
        self.kind = GRID;
        self.start = grid.origin().to_array();
        self.size = grid.spacing();
        self.node_counts = (grid.cells() + 1).to_array();
        self.first_node = (first_node + nodes.len()) as u32;
        nodes.extend(grid.nodes().iter().map(|node| node.to_array()));
    }
}
