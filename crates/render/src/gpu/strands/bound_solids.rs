//! Solids that bound strands stay out of, as the kernels read them.

use strandline_base::SettingError;
use strandline_body::{Carrier, Collider, DistanceGrid, Shape};
use strandline_gpu::{Buffer, Gpu};

use crate::RenderError;

/// Spacing at which the exact mannequin is sampled \[m\], and the air around it that samples cover \[m\].
const MANNEQUIN_SPACING: f32 = 0.003;
const MANNEQUIN_PADDING: f32 = 0.02;

/// One solid, mirrored by the comment in bound_solids.wesl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Header {
    kind: u32,
    carried: u32,
    first_distance: u32,
    /// \[m\]
    clearance: f32,
    /// Centre, start or origin \[m\].
    start: [f32; 3],
    /// Radius or spacing \[m\].
    size: f32,
    end: [f32; 3],
    unused: u32,
    node_counts: [u32; 3],
    unused_too: u32,
}

/// Kinds of solids, and what carries them.
const SPHERE: u32 = 0;
const CAPSULE: u32 = 1;
const GRID: u32 = 2;
const WORLD: u32 = 0;
const HEAD: u32 = 1;
/// Numbers before the headers, and of one.
const COUNTS: usize = 2;
const HEADER: usize = size_of::<Header>() / size_of::<u32>();

/// The number of guides and of solids, the solids with how far \[m\] strands stay away from each, and the distances
/// at the nodes of the grids among them.
pub(crate) fn upload(
    gpu: &Gpu,
    guide_count: usize,
    solids: &[(Collider, f32)],
) -> Result<Buffer<u32>, RenderError> {
    let mut headers = Vec::new();
    let mut distances: Vec<u32> = Vec::new();
    for (collider, clearance) in solids {
        let mut header = Header {
            carried: match collider.carrier {
                Carrier::World => WORLD,
                Carrier::Piece(piece) => HEAD + u32::from(piece),
            },
            clearance: *clearance,
            ..Header::default()
        };
        let mut grid = |grid: &DistanceGrid| {
            header.kind = GRID;
            header.start = grid.origin().to_array();
            header.size = grid.spacing();
            header.node_counts = (grid.cells() + 1).to_array();
            header.first_distance = (COUNTS + HEADER * solids.len() + distances.len()) as u32;
            distances.extend(grid.nodes().iter().map(|node| node.w.to_bits()));
        };
        match &collider.shape {
            Shape::Mannequin(mannequin) => {
                let sampled = DistanceGrid::from_field(&**mannequin, MANNEQUIN_SPACING, MANNEQUIN_PADDING);
                grid(&sampled.map_err(|error| {
                    SettingError::new("the mannequin as a grid", error, "one that fits a GPU")
                })?);
            }
            Shape::Grid(shape) => grid(shape),
            Shape::Sphere { center, radius } => {
                (header.kind, header.start, header.size) = (SPHERE, center.to_array(), *radius);
            }
            Shape::Capsule { start, end, radius } => {
                (header.kind, header.start, header.size) = (CAPSULE, start.to_array(), *radius);
                header.end = end.to_array();
            }
        }
        headers.push(header);
    }
    let mut all = vec![guide_count as u32, solids.len() as u32];
    all.extend_from_slice(bytemuck::cast_slice(&headers));
    all.append(&mut distances);
    Ok(Buffer::from_slice(gpu, "solids of bound strands", &all)?)
}
