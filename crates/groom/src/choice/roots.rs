//! Strands by the cells of a grid in which their roots lie, to find near ones without testing all.

use glam::{IVec3, Vec3};

use super::Feature;

/// Strands of a cell, about, and most cells of a side.
const PER_CELL: f32 = 4.0;
const MOST: f32 = 96.0;
/// Cells for each strand, the empty ones with them: roots that fill their box have no more, and larger ones.
const CELLS: f32 = 4.0;

/// A grid over roots.
pub struct Roots {
    origin: Vec3,
    cell: f32,
    size: IVec3,
    /// First member of each cell, then their number.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Roots {
    pub fn new(features: &[Feature]) -> Self {
        let start = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
        let (low, high) = features
            .iter()
            .fold(start, |(low, high), feature| (low.min(feature.root), high.max(feature.root)));
        let extent = (high - low).max(Vec3::ZERO);
        // Roots lie on a surface, whose area is about that of the largest side of their box.
        let side = extent.max_element();
        let rows = (features.len() as f32 / PER_CELL).sqrt().clamp(1.0, MOST);
        let mut cell = (side / rows).max(1e-9);
        let size_at =
            |cell: f32| (extent / cell).as_ivec3().clamp(IVec3::ZERO, IVec3::splat(MOST as i32)) + 1;
        let mut size = size_at(cell);
        while size.as_vec3().element_product() > CELLS * features.len() as f32 + 8.0 {
            cell *= 1.1;
            size = size_at(cell);
        }
        let mut roots = Self { origin: low, cell, size, starts: Vec::new(), members: Vec::new() };
        let cells: Vec<usize> =
            features.iter().map(|feature| roots.index(roots.cell_of(feature.root))).collect();
        roots.starts = vec![0; (size.x * size.y * size.z) as usize + 1];
        cells.iter().for_each(|cell| roots.starts[cell + 1] += 1);
        (1..roots.starts.len()).for_each(|cell| roots.starts[cell] += roots.starts[cell - 1]);
        let mut next = roots.starts.clone();
        roots.members = vec![0; features.len()];
        for (strand, cell) in cells.iter().enumerate() {
            roots.members[next[*cell] as usize] = strand as u32;
            next[*cell] += 1;
        }
        roots
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The cells that hold a root.
    pub fn occupied(&self) -> Vec<usize> {
        (0..self.cell_count()).filter(|cell| self.starts[*cell] < self.starts[cell + 1]).collect()
    }

    /// The strands of a cell, rising.
    pub fn members(&self, cell: usize) -> &[u32] {
        &self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// All cells with something within a radius \[m\] of a place \[m\], and some beyond it.
    pub fn cells_around(&self, place: Vec3, radius: f32) -> impl Iterator<Item = usize> + '_ {
        let low = self.cell_of(place - radius);
        let high = self.cell_of(place + radius);
        let plane =
            move |z| (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| IVec3::new(x, y, z)));
        (low.z..=high.z).flat_map(plane).map(|cell| self.index(cell))
    }

    /// Visits strands from near to far, ring of cells by ring; `visit` says how far \[m\] is far enough.
    pub fn outward(&self, place: Vec3, mut visit: impl FnMut(usize) -> f32) {
        let middle = self.cell_of(place);
        let mut reach = f32::INFINITY;
        for ring in 0..self.size.max_element() {
            let (low, high) = ((middle - ring).max(IVec3::ZERO), (middle + ring).min(self.size - 1));
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    let is_face = (z - middle.z).abs() == ring || (y - middle.y).abs() == ring;
                    // Within the ring only the two ends of a row are new.
                    let step = if is_face { 1 } else { (2 * ring).max(1) };
                    let first = if is_face { low.x } else { middle.x - ring };
                    let row = (first..=middle.x + ring).step_by(step as usize);
                    for x in row.filter(|x| (low.x..=high.x).contains(x)) {
                        for strand in self.members(self.index(IVec3::new(x, y, z))) {
                            reach = visit(*strand as usize);
                        }
                    }
                }
            }
            // Roots in rings further out are at least so far away.
            if reach <= ring as f32 * self.cell {
                return;
            }
        }
    }

    fn cell_of(&self, place: Vec3) -> IVec3 {
        ((place - self.origin) / self.cell).floor().as_ivec3().clamp(IVec3::ZERO, self.size - 1)
    }

    fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roots that fill a box, not a surface: cells as for a surface would be 96 x 96 x 96.
    #[test]
    fn roots_in_a_box_have_few_cells_for_each() {
        let features: Vec<_> = (0..40_000_i32)
            .map(|root| {
                let place = IVec3::new(root % 34, root / 34 % 34, root / 34 / 34);
                Feature { root: place.as_vec3(), shape: [Vec3::ZERO; 3], group: 0 }
            })
            .collect();
        let roots = Roots::new(&features);
        assert!(roots.cell_count() <= 4 * features.len() + 8, "{} cells", roots.cell_count());
        assert_eq!(roots.occupied().iter().map(|cell| roots.members(*cell).len()).sum::<usize>(), 40_000);
    }

    /// The number of roots searched for each is about constant for any total, on a surface and in a box.
    #[test]
    fn looks_for_each_do_not_grow_with_all() {
        let looks = |place: fn(i32) -> IVec3, count: i32| {
            let feature = |root| Feature { root: place(root).as_vec3(), shape: [Vec3::ZERO; 3], group: 0 };
            let features: Vec<_> = (0..count).map(feature).collect();
            let roots = Roots::new(&features);
            let mut looks = 0.0;
            for feature in &features {
                let mut nearest = [f32::INFINITY; 4];
                roots.outward(feature.root, |other| {
                    looks += 1.0;
                    nearest[3] = nearest[3].min(features[other].root.distance(feature.root));
                    nearest.sort_by(f32::total_cmp);
                    nearest[3]
                });
            }
            looks / f64::from(count)
        };
        let surface = |root| IVec3::new(root % 100, 0, root / 100);
        let full = |root| IVec3::new(root % 20, root / 20 % 20, root / 400);
        for (place, count) in [(surface as fn(i32) -> IVec3, 5000), (full, 4000)] {
            let (few, many) = (looks(place, count), looks(place, 4 * count));
            assert!(many < 1.3 * few, "{few} looks become {many}");
        }
    }
}
