use glam::{Vec2, Vec3};

/// Strand diameters \[m\].
#[derive(Clone, Debug, PartialEq)]
pub enum Widths {
    /// One diameter for all.
    Constant(f32),
    /// One diameter for each strand.
    PerStrand(Vec<f32>),
    /// One diameter for each point.
    PerPoint(Vec<f32>),
}

impl Widths {
    /// Diameter \[m\] at a point, given its strand and its index among all points.
    pub fn at(&self, strand: usize, point: usize) -> f32 {
        match self {
            Self::Constant(width) => *width,
            Self::PerStrand(widths) => widths[strand],
            Self::PerPoint(widths) => widths[point],
        }
    }
}

/// A set of strands at rest, root first, in head space. It has no time.
#[derive(Clone, Debug, PartialEq)]
pub struct Groom {
    /// First point of each strand, then the number of points: shape `[strand + 1]`.
    pub starts: Vec<u32>,
    /// Positions \[m\], shape `[point]`, strand after strand, root first.
    pub points: Vec<Vec3>,
    /// Diameters \[m\].
    pub widths: Widths,
    /// Position of each root on the scalp, 0..1, shape `[strand]`.
    pub root_uvs: Option<Vec<Vec2>>,
    /// Unit normal of the skin at each root, shape `[strand]`.
    pub root_normals: Option<Vec<Vec3>>,
    /// A group number for each strand, shape `[strand]`.
    pub groups: Option<Vec<u32>>,
    /// Linear RGB, 0..1, shape `[point]`.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Transparency, 0 opaque .. 1, shape `[point]`.
    pub transparencies: Option<Vec<f32>>,
}

impl Groom {
    /// A groom without a strand.
    pub fn empty(width: f32) -> Self {
        Self {
            starts: vec![0],
            points: Vec::new(),
            widths: Widths::Constant(width),
            root_uvs: None,
            root_normals: None,
            groups: None,
            colors: None,
            transparencies: None,
        }
    }

    /// Appends a strand, root first.
    pub fn push(&mut self, points: impl IntoIterator<Item = Vec3>) {
        self.points.extend(points);
        self.starts.push(self.points.len() as u32);
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The points of a strand \[m\], root first.
    pub fn strand(&self, index: usize) -> &[Vec3] {
        &self.points[self.starts[index] as usize..self.starts[index + 1] as usize]
    }
}
