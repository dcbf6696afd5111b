//! Solids as rows of four words, which the shaders of simulation and pictures read: solid_table.wesl.

use strandline_base::SettingError;

use crate::skin_table::{SkinTable, places, rows};
use crate::{Carrier, Collider, DistanceGrid, Shape};

/// Spacing at which the exact mannequin is sampled \[m\], and the air around it that samples cover \[m\]: shaders know
/// grids alone.
const MANNEQUIN_SPACING: f32 = 0.003;
const MANNEQUIN_PADDING: f32 = 0.02;

/// Kinds of solids.
const SPHERE: u32 = 0;
const CAPSULE: u32 = 1;
const GRID: u32 = 2;
/// A skin that moves by itself: a grid in every other moment.
const SKIN: u32 = 3;
/// Carriers: the world, then the pieces of the body, the head first.
const WORLD: u32 = 0;
const HEAD: u32 = 1;
/// Rows of a solid.
const HEADER: usize = 4;

/// The pipeline constant SKINS (skins.wesl), by its number, for kernels that read a table of these solids.
pub fn skins_constant<'a>(solids: impl IntoIterator<Item = &'a Collider>) -> (&'static str, f64) {
    let has_skin = solids.into_iter().any(|solid| matches!(solid.shape, Shape::Skin(_)));
    ("2", if has_skin { 1.0 } else { 0.0 })
}

/// Rows of solids, each with the distance \[m\] that drawn strands keep from it; `before` rows lie before these in their
/// buffer.
///
/// Four rows per solid: kind, carrier, first node, friction; centre, start or origin \[m\] and radius or spacing \[m\]; end
/// \[m\] and the distance that is kept; nodes along x, y and z. Behind all of them the nodes of the grids, gradient and
/// distance \[m\], and the trees of skins, which ride the head until the table of skins says otherwise. Numbers are given
/// by their bits.
///
/// # Errors
/// A mannequin that cannot be sampled.
pub fn solid_rows<'a>(
    solids: impl ExactSizeIterator<Item = (&'a Collider, f32)>,
    before: usize,
) -> Result<(Vec<[u32; 4]>, SkinTable), SettingError> {
    let mut skins = SkinTable::default();
    let first_node = before + HEADER * solids.len();
    let (mut rows, mut nodes) = (Vec::with_capacity(HEADER * solids.len()), Vec::new());
    for (solid, kept) in solids {
        let mut add_grid = |grid: &DistanceGrid| {
            let first = first_node + nodes.len();
            nodes.extend(grid.nodes().iter().map(|node| node.to_array().map(f32::to_bits)));
            Numbers {
                kind: GRID,
                first_node: first as u32,
                start: grid.origin().to_array(),
                size: grid.spacing(),
                node_counts: (grid.cells() + 1).to_array(),
                ..Numbers::default()
            }
        };
        let numbers = match &solid.shape {
            Shape::Sphere { center, radius } => {
                Numbers { kind: SPHERE, start: center.to_array(), size: *radius, ..Numbers::default() }
            }
            Shape::Capsule { start, end, radius } => Numbers {
                kind: CAPSULE,
                start: start.to_array(),
                size: *radius,
                end: end.to_array(),
                ..Numbers::default()
            },
            Shape::Mannequin(mannequin) => {
                let sampled = DistanceGrid::from_field(&**mannequin, MANNEQUIN_SPACING, MANNEQUIN_PADDING);
                add_grid(&sampled.map_err(|error| {
                    SettingError::new("the mannequin as a grid", error, "one that fits a GPU")
                })?)
            }
            Shape::Grid(grid) => add_grid(grid),
            Shape::Skin(skin) => {
                let numbers = add_grid(skin.grid());
                let first = first_node + nodes.len();
                nodes.extend(self::rows(skin));
                Numbers { skin: places(skin, first), ..numbers }
            }
        };
        let header = numbers.rows(solid, kept);
        if let Shape::Skin(_) = &solid.shape {
            let [_, carrier, node, friction] = header[0];
            let kinds = [GRID, SKIN].map(|kind| [kind, carrier, node, friction]);
            skins.add(solid, before + rows.len(), kinds, numbers.skin[0] as usize);
        }
        rows.extend(header);
    }
    rows.append(&mut nodes);
    Ok((rows, skins))
}

/// Numbers of a shape.
#[derive(Default)]
struct Numbers {
    kind: u32,
    first_node: u32,
    start: [f32; 3],
    size: f32,
    end: [f32; 3],
    node_counts: [u32; 3],
    /// Rows where the parts of a skin begin.
    skin: [u32; 4],
}

impl Numbers {
    fn rows(&self, solid: &Collider, kept: f32) -> [[u32; 4]; HEADER] {
        let carrier = match solid.carrier {
            Carrier::World => WORLD,
            Carrier::Piece(piece) | Carrier::Moved(piece) => HEAD + u32::from(piece),
        };
        let vector = |[x, y, z]: [f32; 3], last: f32| [x, y, z, last].map(f32::to_bits);
        let [x, y, z] = self.node_counts;
        let [node, vertex, triangle, around] = self.skin;
        let end = match solid.shape {
            Shape::Skin(_) => [node, vertex, triangle, kept.to_bits()],
            _ => vector(self.end, kept),
        };
        [
            [self.kind, carrier, self.first_node, solid.friction.to_bits()],
            vector(self.start, self.size),
            end,
            [x, y, z, around],
        ]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::SignedDistance;

    #[test]
    fn rows_name_the_nodes_of_each_grid_behind_all_solids() {
        let ball = Shape::sphere(Vec3::X, 0.25).unwrap();
        let grid = |radius: f32| DistanceGrid::from_field(&Ball(radius), 0.1, 0.2).unwrap();
        let (one, other) = (grid(0.2), grid(0.3));
        let shapes = [Shape::Grid(one.clone().into()), ball, Shape::Grid(other.clone().into())];
        let solids: Vec<Collider> = shapes
            .into_iter()
            .zip([Carrier::HEAD, Carrier::World, Carrier::Piece(2)])
            .map(|(shape, carrier)| Collider::new(shape, carrier, 0.5).unwrap())
            .collect();
        let (rows, _) = solid_rows(solids.iter().map(|solid| (solid, 0.01)), 7).unwrap();
        let number = |bits: u32| f32::from_bits(bits);
        assert_eq!(rows[0][..2], [GRID, HEAD]);
        assert_eq!(rows[4][..2], [SPHERE, WORLD]);
        assert_eq!(rows[5].map(number), [1.0, 0.0, 0.0, 0.25]);
        assert_eq!((rows[8][..2].to_vec(), number(rows[8][3])), (vec![GRID, HEAD + 2], 0.5));
        assert_eq!(number(rows[10][3]), 0.01);
        for (header, grid) in [(0, &one), (8, &other)] {
            let first = rows[header][2] as usize - 7;
            assert_eq!(rows[header + 3][..3], (grid.cells() + 1).to_array());
            assert_eq!(rows[first].map(number), grid.nodes()[0].to_array());
            let last = grid.nodes().len() - 1;
            assert_eq!(rows[first + last].map(number), grid.nodes()[last].to_array());
        }
        assert_eq!(rows.len(), 12 + one.nodes().len() + other.nodes().len());
    }

    struct Ball(f32);

    impl SignedDistance for Ball {
        fn distance(&self, point: Vec3) -> f32 {
            point.length() - self.0
        }

        fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
            (self.distance(point), point.normalize_or(Vec3::Y))
        }

        fn bounds(&self) -> crate::Aabb {
            crate::Aabb { min: Vec3::splat(-self.0), max: Vec3::splat(self.0) }
        }
    }
}
