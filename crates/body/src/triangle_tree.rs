//! The search for the triangle that is nearest to a point.

use std::borrow::Cow;

use glam::DVec3;
use strandline_base::Tally;

use crate::layers::Corners;
use crate::triangle::{Plane, nearer_than};

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Most waiting nodes: one for each halving of 2^32 triangles.
const DEPTH: usize = 40;

/// A tree of boxes over triangles.
pub(crate) struct TriangleTree<'a> {
    triangles: Cow<'a, [Corners]>,
    /// The triangles of the tree, those of a leaf beside each other.
    order: Vec<u32>,
    /// Their planes, in this order.
    planes: Vec<Plane>,
    /// Place of each triangle in this order; meaningless for one that is not in the tree.
    places: Vec<u32>,
    nodes: Vec<Node>,
    /// Triangles that searches looked at, and those of them whose exact distance they needed.
    looks: [Tally; 2],
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

    /// Squared distance of its middle, which tells the order of two children where both boxes hold the point.
    fn middle_squared(&self, point: DVec3) -> f64 {
        (0.5 * (self.min + self.max) - point).length_squared()
    }
}

impl<'a> TriangleTree<'a> {
    /// A tree over those of the triangles that `order` lists.
    pub fn new(triangles: impl Into<Cow<'a, [Corners]>>, order: Vec<u32>) -> Self {
        let triangles = triangles.into();
        let (planes, places) = (Vec::new(), vec![0; triangles.len()]);
        let nodes = Vec::with_capacity(order.len());
        let mut tree = Self { triangles, planes, places, nodes, order, looks: Default::default() };
        let count = tree.order.len();
        if count > 0 {
            tree.grow(0, count);
        }
        tree.planes = tree.order.iter().map(|index| Plane::of(&tree.triangles[*index as usize])).collect();
        for (place, index) in (0..).zip(&tree.order) {
            tree.places[*index as usize] = place;
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

    /// Takes a triangle of the tree for the nearest where it is nearer.
    pub fn offer(&self, triangle: u32, point: DVec3, nearest: &mut Nearest) {
        self.offer_at(self.places[triangle as usize] as usize, point, nearest);
    }

    /// The same of the triangle at a place of the order. True where its exact distance was needed.
    #[inline]
    fn offer_at(&self, place: usize, point: DVec3, nearest: &mut Nearest) -> bool {
        if self.planes[place].is_farther(point, nearest.squared) {
            return false;
        }
        let triangle = self.order[place];
        let corners = &self.triangles[triangle as usize];
        if let Some(squared) = nearer_than(corners, &self.planes[place], point, nearest.squared) {
            *nearest = Nearest { squared, triangle };
        }
        true
    }

    /// Numbers of triangles that all searches looked at, and of those whose exact distance they needed, in a build with debug
    /// assertions; else 0.
    pub fn looks(&self) -> [u64; 2] {
        [self.looks[0].count(), self.looks[1].count()]
    }

    /// Finds the nearest triangle among at most `budget` that it looks at, and returns how many those were;
    /// with fewer than `budget` the nearest of all is found.
    pub fn search(&self, point: DVec3, budget: u64, nearest: &mut Nearest) -> u64 {
        let mut waiting = [(0.0, 0_u32); DEPTH];
        let mut count = usize::from(!self.nodes.is_empty());
        let (mut seen, mut exact) = (0, 0);
        while count > 0 && seen < budget {
            count -= 1;
            let (squared, index) = waiting[count];
            if squared >= nearest.squared {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.right == 0 {
                for place in node.range[0] as usize..node.range[1] as usize {
                    exact += u64::from(self.offer_at(place, point, nearest));
                    seen += 1;
                }
                continue;
            }
            let children = [index + 1, node.right];
            let [left, right] = children.map(|child| &self.nodes[child as usize]);
            let [here, there] = [left, right].map(|child| child.distance_squared(point));
            let is_left_first =
                here < there || (here == there && left.middle_squared(point) <= right.middle_squared(point));
            let children = [(here, children[0]), (there, children[1])];
            let [near, far] = if is_left_first { children } else { [children[1], children[0]] };
            for (squared, child) in [far, near] {
                if squared < nearest.squared {
                    waiting[count] = (squared, child);
                    count += 1;
                }
            }
        }
        self.looks[0].add(seen);
        self.looks[1].add(exact);
        seen
    }
}
