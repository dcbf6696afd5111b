use std::path::PathBuf;

use strandline_base::memory::MemoryError;

/// Why a body could not be loaded or used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BodyError {
    /// More memory than may be taken.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The file could not be opened or read.
    #[error("cannot read the body: {source}: {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// The file of the head's motion could not be opened or read.
    #[error("cannot read the motion of the head: {source}: {}", path.display())]
    ReadMotion {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// The file is not a mesh that can be used.
    #[error("{found}, expected {expected}; {mend}: {}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// Content that was found.
        found: String,
        /// Content that was expected.
        expected: &'static str,
        /// Remedy.
        mend: &'static str,
    },
    /// A mesh with holes has no inside.
    #[error(
        "the mesh is open: {open_edge_count} of its edges have no partner, expected none; \
         close the mesh, or give a collider mesh of its own"
    )]
    OpenMesh {
        /// Edges that are not shared by exactly two triangles of the same winding.
        open_edge_count: usize,
    },
    /// A mesh without triangles or with vertices that are no points.
    #[error("the mesh has {found}, expected {expected}; export it again as triangles")]
    BadMesh {
        /// Content that was found.
        found: String,
        /// Content that was expected.
        expected: &'static str,
    },
    /// A distance grid would be too large.
    #[error(
        "a distance grid of {} x {} x {} cells is too large, expected {limit} nodes at most even at 0.1 m; \
         scale the mesh to metres (`body.scale` of a scene), or look for a vertex that is far off",
        cells[0], cells[1], cells[2]
    )]
    GridTooLarge {
        /// Cells asked for in x, y, z.
        cells: [u64; 3],
        /// The most that are allowed.
        limit: u64,
    },
    /// A value is outside its range.
    #[error("{what} is {found}, expected {expected}")]
    Value {
        /// Name of the value.
        what: &'static str,
        /// Value that was given.
        found: String,
        /// The range.
        expected: &'static str,
    },
    /// A keyframe cannot be used.
    #[error("keyframe {index} has {found}, expected {expected}")]
    Keyframe {
        /// Its place in the list, from 0.
        index: usize,
        /// Content that was found.
        found: String,
        /// Content that was expected.
        expected: &'static str,
    },
}
