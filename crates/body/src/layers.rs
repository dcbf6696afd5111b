//! Triangles by the layers of a lattice that they reach.

use glam::DVec3;

/// A triangle in cells, from the first node of its lattice.
pub(crate) type Corners = [DVec3; 3];

/// Triangles sorted by the lowest layer that they reach, each stored once.
pub(crate) struct Layers<'a> {
    triangles: &'a [Corners],
    /// Indices of the triangles, the lowest first.
    order: Vec<u32>,
}

impl<'a> Layers<'a> {
    /// Layers of the triangles that `order` lists.
    pub fn new(triangles: &'a [Corners], mut order: Vec<u32>) -> Self {
        order.sort_unstable_by(|one, other| {
            let low = |index: u32| low(&triangles[index as usize]);
            low(*one).total_cmp(&low(*other)).then(one.cmp(other))
        });
        Self { triangles, order }
    }

    pub fn triangles(&self) -> &'a [Corners] {
        self.triangles
    }

    /// Indices of the triangles that reach into a slab between two heights \[cells\], the lowest first.
    pub fn between(&self, bottom: f64, top: f64) -> Vec<u32> {
        let end = self.order.partition_point(|index| low(&self.triangles[*index as usize]) <= top);
        let reaches = |index: &u32| high(&self.triangles[*index as usize]) >= bottom;
        self.order[..end].iter().copied().filter(reaches).collect()
    }
}

fn low([a, b, c]: &Corners) -> f64 {
    a.z.min(b.z).min(c.z)
}

fn high([a, b, c]: &Corners) -> f64 {
    a.z.max(b.z).max(c.z)
}
