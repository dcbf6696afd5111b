//! The search for the triangle that is nearest to a point.

use std::borrow::Cow;

use glam::DVec3;

use crate::layers::Corners;
use crate::triangle::{Plane, nearer_than};

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Most waiting nodes: one for each halving of 2^32 triangles.
const DEPTH: usize = 40;

/// A tree of boxes over triangles.
pub(crate) struct TriangleTree<'a> {
    triangles: Cow<'a, [Corners]>,
    /// Their planes.
    planes: Vec<Plane>,
    /// The triangles of the tree, those of a leaf beside each other.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

/// A box; the left child follows its parent.
struct Node {
    min: DVec3,
    max: DVec3,
    /// Its triangles in `order`.
    range: [u32; 2],
    /// Index of the right child; 0 for a leaf.
    right: u32,
}

/// The nearest triangle known so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Squared distance \[cells\].
    pub squared: f64,
    /// Index of the triangle.
    pub triangle: u32,
}

impl Nearest {
    /// No triangle known.
    pub const NONE: Self = Self { squared: f64::INFINITY, triangle: u32::MAX };
}

impl Node {
    fn distance_squared(&self, point: DVec3) -> f64 {
        (point - point.clamp(self.min, self.max)).length_squared()
    }

    /// Order of two children: by distance, and by their middles if both boxes hold the point.
    fn key(&self, point: DVec3) -> (f64, f64) {
        (self.distance_squared(point), (0.5 * (self.min + self.max) - point).length_squared())
    }
}

impl<'a> TriangleTree<'a> {
    /// A tree over those of the triangles that `order` lists.
    pub fn new(triangles: impl Into<Cow<'a, [Corners]>>, order: Vec<u32>) -> Self {
        let triangles = triangles.into();
        let planes = triangles.iter().map(Plane::of).collect();
        let mut tree = Self { triangles, planes, nodes: Vec::with_capacity(order.len()), order };
        let count = tree.order.len();
        if count > 0 {
            tree.grow(0, count);
        }
        tree
    }

    /// Adds the node of a range of triangles, and those below it.
    fn grow(&mut self, start: usize, end: usize) {
        let middle = |index: u32| self.triangles[index as usize].iter().sum::<DVec3>();
        let order = &mut self.order[start..end];
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for index in order.iter() {
            for corner in &self.triangles[*index as usize] {
                (min, max) = (min.min(*corner), max.max(*corner));
            }
            (low, high) = (low.min(middle(*index)), high.max(middle(*index)));
        }
        let node = self.nodes.len();
        self.nodes.push(Node { min, max, range: [start as u32, end as u32], right: 0 });
        if end - start <= LEAF {
            return;
        }
        let axis = (high - low).max_position();
        let half = (end - start) / 2;
        order.select_nth_unstable_by(half, |one, other| {
            middle(*one)[axis].total_cmp(&middle(*other)[axis]).then(one.cmp(other))
        });
        self.grow(start, start + half);
        self.nodes[node].right = self.nodes.len() as u32;
        self.grow(start + half, end);
    }

    /// The triangles, by their indices.
    pub fn triangles(&self) -> &[Corners] {
        &self.triangles
    }

    /// Takes a triangle for the nearest where it is nearer.
    pub fn offer(&self, triangle: u32, point: DVec3, nearest: &mut Nearest) {
        let at = triangle as usize;
        if let Some(squared) = nearer_than(&self.triangles[at], &self.planes[at], point, nearest.squared) {
            *nearest = Nearest { squared, triangle };
        }
    }

    /// Finds the nearest triangle among at most `budget` that it looks at, and returns how many those were;
    /// with fewer than `budget` the nearest of all is found.
    pub fn search(&self, point: DVec3, budget: u64, nearest: &mut Nearest) -> u64 {
        let mut waiting = [(0.0, 0_u32); DEPTH];
        let mut count = usize::from(!self.nodes.is_empty());
        let mut seen = 0;
        while count > 0 && seen < budget {
            count -= 1;
            let (squared, index) = waiting[count];
            if squared >= nearest.squared {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.right == 0 {
                for triangle in &self.order[node.range[0] as usize..node.range[1] as usize] {
                    self.offer(*triangle, point, nearest);
                    seen += 1;
                }
                continue;
            }
            let children =
                [index + 1, node.right].map(|child| (self.nodes[child as usize].key(point), child));
            let [near, far] =
                if children[0].0 <= children[1].0 { children } else { [children[1], children[0]] };
            for ((squared, _), child) in [far, near] {
                if squared < nearest.squared {
                    waiting[count] = (squared, child);
                    count += 1;
                }
            }
        }
        seen
    }
}
