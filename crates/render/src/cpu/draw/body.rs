//! The body on the screen: which triangle each sample shows, and how far it is.

use glam::{Vec2, Vec3, Vec4};
use strandline_base::par::prelude::*;
use strandline_body::{BodyFrame, Mesh, MovedSkin};

use super::occluders::{BLOCK, Occluders, TILE_BLOCKS};
use super::tiles::{TileRect, Tiles};
use crate::cpu::CoarseBody;
use crate::frame::projection::Projection;
use crate::frame::samples::{NO_TRIANGLE, Samples, TILE, TILE_SAMPLES};
use crate::surfaces::Surfaces;

/// Vertices or triangles handled together by one thread.
const CHUNK: usize = 4096;
/// Hair this far under the surface still counts as lying on it \[m\], measured along the normal:
/// a straight segment of 12 mm between two points on a skull of 90 mm radius dips 0.2 mm below it.
const SKIN_DEPTH: f32 = 4e-4;
/// Steepest slope at which that depth is turned into depth along the line of sight, as the cosine
/// between normal and line of sight: hair behind an outline stays hidden.
const MIN_COSINE: f32 = 0.2;
/// Rounding of places on the screen \[sample\].
const ROUNDING: f32 = 1e-2;

/// A body and where it is in this frame.
#[derive(Debug, Default)]
pub struct Body {
    pub mesh: Mesh,
    /// Every edge joins two triangles, so that back faces are never seen.
    closed: bool,
    /// Its materials, where it has some.
    pub surfaces: Option<Surfaces>,
    skin: MovedSkin,
    /// Vertex positions \[m\], world space.
    pub positions: Vec<Vec3>,
    /// Vertex normals, world space.
    pub normals: Vec<Vec3>,
    /// Few triangles that stand for it in shadows.
    pub coarse: CoarseBody,
    /// Density of roots about every vertex, 0 to 1; empty without roots.
    pub roots: Vec<f32>,
    screen: Vec<Vec4>,
    runs: Vec<Vec<ScreenTriangle>>,
    faces: Vec<ScreenTriangle>,
    tiles: Tiles,
}

/// A triangle on the screen: x and y \[sample\], z one over the view depth \[1/m\].
#[derive(Clone, Copy, Debug)]
struct ScreenTriangle {
    corners: [Vec3; 3],
    index: u32,
}

impl Body {
    /// Takes over a mesh.
    pub fn new(mesh: Mesh) -> Self {
        let surfaces = Surfaces::new(&mesh);
        // A body is open where parts of it are cut away.
        let closed = mesh.is_closed() && !surfaces.as_ref().is_some_and(|surfaces| surfaces.cuts);
        Self { mesh, closed, surfaces, ..Self::default() }
    }

    /// The corners of a triangle.
    pub fn triangle(&self, index: u32) -> [usize; 3] {
        self.mesh.triangles[index as usize].map(|corner| corner as usize)
    }

    /// Every triangle's corners.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// Draws the depth of the body, which is in its place, into the samples and notes what it hides.
    pub fn draw(&mut self, projection: &Projection, samples: &mut Samples, occluders: &mut Occluders) {
        self.face(projection);
        let faces = &self.faces;
        self.tiles.fill(samples, faces.len(), |face| Some((faces[face].rect(samples)?, face as u32)));
        let columns = samples.tile_columns();
        occluders.resize(columns, samples.tile_rows());
        let (tiles, body) = (&self.tiles, &*self);
        samples
            .inverse_depths
            .par_chunks_exact_mut(TILE_SAMPLES)
            .zip(samples.triangles.par_chunks_exact_mut(TILE_SAMPLES))
            .zip(occluders.blocks.par_chunks_exact_mut(TILE_BLOCKS * TILE_BLOCKS))
            .enumerate()
            .for_each(|(tile, ((depths, triangles), blocks))| {
                depths.fill(0.0);
                triangles.fill(NO_TRIANGLE);
                let origin = ((tile % columns * TILE) as f32, (tile / columns * TILE) as f32);
                tiles.things(tile).for_each(|face| {
                    let face = &faces[face as usize];
                    match &body.surfaces {
                        Some(surfaces) if surfaces.cuts => {
                            let corner = Vec2::from(origin);
                            let shown = |x, y| {
                                let sight = body.sight(face.index, projection, corner + Vec2::new(x, y));
                                !body.painted(surfaces, face.index, &sight, projection).is_cut()
                            };
                            face.fill(origin, depths, triangles, shown);
                        }
                        _ => face.fill(origin, depths, triangles, |_, _| true),
                    }
                });
                match tiles.things(tile).next() {
                    Some(_) => body.occlude(projection, depths, triangles, blocks),
                    None => blocks.fill(0.0),
                }
            });
    }

    /// Carries the body to its place.
    pub fn place(&mut self, body: &BodyFrame) {
        self.skin.take(&self.mesh, body);
        let ([positions, normals], head) = (self.skin.shape(&self.mesh), body.world_from_head());
        let carry = |from: &[Vec3], to: &mut Vec<Vec3>, carry: &(dyn Fn(Vec3) -> Vec3 + Sync)| {
            to.resize(from.len(), Vec3::ZERO);
            to.par_iter_mut().zip(from).with_min_len(CHUNK).for_each(|(to, &from)| *to = carry(from));
        };
        carry(positions, &mut self.positions, &|point| head.point(point));
        carry(normals, &mut self.normals, &|normal| head.direction(normal));
    }

    /// Collects the triangles that face the camera; of open meshes all of them.
    fn face(&mut self, projection: &Projection) {
        self.screen.resize(self.positions.len(), Vec4::ZERO);
        self.screen.par_chunks_mut(CHUNK).zip(self.positions.par_chunks(CHUNK)).for_each(
            |(screen, positions)| {
                let project = |&position| projection.screen(position, 0.0);
                screen.iter_mut().zip(positions).for_each(|(screen, position)| *screen = project(position));
            },
        );
        let triangles = &self.mesh.triangles;
        self.runs.resize_with(triangles.len().div_ceil(CHUNK), Vec::new);
        let (positions, screen, closed) = (&self.positions, &self.screen, self.closed);
        self.runs.par_iter_mut().zip(triangles.par_chunks(CHUNK)).enumerate().for_each(
            |(chunk, (run, triangles))| {
                run.clear();
                for (offset, corners) in triangles.iter().enumerate() {
                    let index = (chunk * CHUNK + offset) as u32;
                    let on_screen = corners.map(|corner| screen[corner as usize]);
                    if on_screen.iter().all(|corner| corner.z > 0.0) {
                        run.push(ScreenTriangle { corners: on_screen.map(Vec4::truncate), index });
                    } else {
                        let corners = corners.map(|corner| positions[corner as usize]);
                        cut(corners, index, projection, run);
                    }
                }
                run.retain_mut(|triangle| triangle.meets_samples() && triangle.turn(closed));
            },
        );
        self.faces.clear();
        self.runs.iter().for_each(|run| self.faces.extend_from_slice(run));
    }

    /// Moves the depths back by [`SKIN_DEPTH`] for the test of hair against them, and notes the
    /// farthest of each block.
    fn occlude(&self, projection: &Projection, depths: &mut [f32], triangles: &[u32], blocks: &mut [f32]) {
        blocks.fill(f32::MAX);
        let eye = projection.eye();
        // Neighbours mostly show the same triangle.
        let (mut known, mut dip) = (NO_TRIANGLE, 0.0);
        for (sample, (depth, &triangle)) in depths.iter_mut().zip(triangles).enumerate() {
            if triangle != known {
                known = triangle;
                dip = if triangle == NO_TRIANGLE { 0.0 } else { self.dip(triangle, eye) };
            }
            *depth /= 1.0 + *depth * dip;
            let block = &mut blocks[sample / TILE / BLOCK * TILE_BLOCKS + sample % TILE / BLOCK];
            *block = block.min(*depth);
        }
    }

    /// [`SKIN_DEPTH`] along the line of sight \[m\].
    fn dip(&self, triangle: u32, eye: Vec3) -> f32 {
        let [a, b, c] = self.triangle(triangle).map(|corner| self.positions[corner]);
        let normal = (b - a).cross(c - a);
        let sight = eye - a;
        let lengths = (normal.length_squared() * sight.length_squared()).sqrt();
        let cosine = normal.dot(sight).abs() / lengths.max(f32::MIN_POSITIVE);
        SKIN_DEPTH / cosine.max(MIN_COSINE)
    }
}

impl ScreenTriangle {
    /// Makes the corners counter-clockwise as seen; `false` for a back face of a closed mesh, an edge-on
    /// triangle and one that is not finite.
    fn turn(&mut self, closed: bool) -> bool {
        let [a, b, c] = self.corners;
        // y points down on the screen: counter-clockwise has a negative area.
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if area > 0.0 && !closed {
            self.corners.swap(1, 2);
        }
        area.is_finite() && (area < 0.0 || (area > 0.0 && !closed))
    }

    /// False where the middle of no sample can lie within: so it is with most triangles that are smaller than a sample.
    fn meets_samples(&self) -> bool {
        let [a, b, c] = self.corners;
        let low = (a.min(b).min(c) - (0.5 + ROUNDING)).ceil();
        let high = (a.max(b).max(c) - (0.5 - ROUNDING)).floor();
        // Written so that a NaN passes: `turn` sorts it out.
        !(low.x > high.x || low.y > high.y)
    }

    fn rect(&self, samples: &Samples) -> Option<TileRect> {
        let [a, b, c] = self.corners;
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        TileRect::of_box(samples, [min.x, min.y], [max.x, max.y])
    }

    /// Draws into one tile where it is shown, from the tile's corner: the nearest triangle wins, of equals the first.
    fn fill(
        &self,
        origin: (f32, f32),
        depths: &mut [f32],
        triangles: &mut [u32],
        shown: impl Fn(f32, f32) -> bool,
    ) {
        let shift = Vec3::new(origin.0, origin.1, 0.0);
        let [a, b, c] = self.corners.map(|corner| corner - shift);
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        // Samples lie at the middle of their square.
        let first = |low: f32| (low - 0.5).ceil().max(0.0) as usize;
        let end = |high: f32| ((high - 0.5).floor() + 1.0).clamp(0.0, TILE as f32) as usize;
        let edges = (edge(a, b), edge(b, c), edge(c, a));
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let (slope_x, slope_y) = (-normal.x / normal.z, -normal.y / normal.z);
        for row in first(min.y)..end(max.y) {
            let y = row as f32 + 0.5;
            for column in first(min.x)..end(max.x) {
                let x = column as f32 + 0.5;
                let inside = edges.0(x, y) <= 0.0 && edges.1(x, y) <= 0.0 && edges.2(x, y) <= 0.0;
                // Within the corners' range, whatever rounding makes of a sliver's slope.
                let depth = (a.z + slope_x * (x - a.x) + slope_y * (y - a.y)).clamp(min.z, max.z);
                let sample = row * TILE + column;
                if inside && depth > depths[sample] && shown(x, y) {
                    depths[sample] = depth;
                    triangles[sample] = self.index;
                }
            }
        }
    }
}

/// Twice the area of the triangle from an edge to a point; negative to one side. Both triangles at an
/// edge compute it from the same end, so that no sample falls between them by rounding.
fn edge(from: Vec3, to: Vec3) -> impl Fn(f32, f32) -> f32 {
    let swap = (from.x, from.y) > (to.x, to.y);
    let (start, end, sign) = if swap { (to, from, -1.0) } else { (from, to, 1.0) };
    let (run, rise) = (end.x - start.x, end.y - start.y);
    move |x, y| sign * (run * (y - start.y) - rise * (x - start.x))
}

/// Cuts a triangle \[m, world space\] at the near plane: none, one or two triangles remain.
fn cut(corners: [Vec3; 3], index: u32, projection: &Projection, found: &mut Vec<ScreenTriangle>) {
    let mut polygon = [Vec3::ZERO; 4];
    let mut count = 0;
    let mut push = |corner: Vec4| {
        polygon[count] = corner.truncate();
        count += 1;
    };
    for (&start, &end) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (seen, next_seen) = (projection.screen(start, 0.0), projection.screen(end, 0.0));
        if seen.z > 0.0 {
            push(seen);
        }
        if (seen.z > 0.0) != (next_seen.z > 0.0) {
            push(projection.near_crossing(start, end, [0.0; 2]).1);
        }
    }
    for last in 2..count {
        let corners = [polygon[0], polygon[last - 1], polygon[last]];
        found.push(ScreenTriangle { corners, index });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    /// A ball of `radius` \[m\].
    fn ball(radius: f32) -> Mesh {
        let (rings, turns) = (24, 40);
        let mut positions = vec![Vec3::Y * radius, Vec3::NEG_Y * radius];
        for ring in 1..rings {
            for turn in 0..turns {
                let (height, angle) = (ring as f32 / rings as f32, turn as f32 / turns as f32);
                let (sine, cosine) = (height * std::f32::consts::PI).sin_cos();
                let (side, front) = (angle * std::f32::consts::TAU).sin_cos();
                positions.push(radius * Vec3::new(sine * side, cosine, sine * front));
            }
        }
        let at = |ring: u32, turn: u32| 2 + (ring - 1) * turns + turn % turns;
        let mut triangles = Vec::new();
        for turn in 0..turns {
            triangles.push([0, at(1, turn), at(1, turn + 1)]);
            triangles.push([1, at(rings - 1, turn + 1), at(rings - 1, turn)]);
            for ring in 1..rings - 1 {
                triangles.push([at(ring, turn), at(ring + 1, turn), at(ring, turn + 1)]);
                triangles.push([at(ring, turn + 1), at(ring + 1, turn), at(ring + 1, turn + 1)]);
            }
        }
        Mesh::new(positions, triangles).unwrap()
    }

    fn drawn(mesh: Mesh, camera: &Camera) -> (Body, Samples, Occluders, Projection) {
        let mut samples = Samples::default();
        samples.resize(300, 260);
        let projection = Projection::new(camera, &samples);
        let (mut body, mut occluders) = (Body::new(mesh), Occluders::default());
        body.place(&BodyFrame::REST);
        body.draw(&projection, &mut samples, &mut occluders);
        (body, samples, occluders, projection)
    }

    #[test]
    fn a_ball_is_drawn_without_holes_at_its_depth() {
        let camera = Camera { position: Vec3::new(0.3, 0.2, 0.9), target: Vec3::ZERO, ..Camera::front() };
        let (body, samples, ..) = drawn(ball(0.1), &camera);
        assert!(body.closed);
        let (distance, focal) = (camera.position.length(), 130.0 * camera.focal());
        // The outline of a ball is a circle seen under this angle; flat facets cut 0.4 % off.
        let outline = focal * (0.1 / distance).asin().tan();
        for row in 0..260 {
            for column in 0..300 {
                let (x, y) = (column as f32 + 0.5 - 150.0, row as f32 + 0.5 - 130.0);
                let index = samples.index(column, row);
                let depth = samples.inverse_depths[index];
                let out = x.hypot(y);
                assert_eq!(samples.triangles[index] == NO_TRIANGLE, depth == 0.0);
                if out > outline + 0.1 {
                    assert_eq!(depth, 0.0, "at {column}, {row}");
                } else if out < outline * 0.99 - 0.5 {
                    // The ball's depth along this line of sight, by the quadratic formula.
                    let slope = Vec3::new(x / focal, y / focal, 1.0);
                    let (a, b) = (slope.length_squared(), distance);
                    let near = (b - (b * b - a * (b * b - 0.01)).sqrt()) / a;
                    let found = 1.0 / depth;
                    // Facets lie up to 0.4 % of the radius inside, and the depth for hair is moved back
                    // by the skin's depth, both along a line that meets the surface on a slant.
                    let slack = 2.0 * (0.01 * 0.1 + SKIN_DEPTH / MIN_COSINE);
                    assert!(found > near - 1e-5 && found < near + slack, "{found} and {near}");
                }
            }
        }
    }

    #[test]
    fn what_is_behind_the_ball_is_hidden_and_nothing_else() {
        let camera = Camera { position: Vec3::Z, target: Vec3::ZERO, ..Camera::front() };
        let (.., occluders, projection) = drawn(ball(0.12), &camera);
        let hidden = |start: Vec3, end: Vec3| {
            occluders.hide(projection.screen(start, 1e-4), projection.screen(end, 1e-4))
        };
        assert!(hidden(Vec3::new(-0.01, 0.0, -0.2), Vec3::new(0.01, 0.02, -0.2)));
        assert!(!hidden(Vec3::new(-0.01, 0.0, 0.2), Vec3::new(0.01, 0.02, 0.2)));
        assert!(!hidden(Vec3::new(0.0, 0.0, -0.2), Vec3::new(0.2, 0.0, -0.2)));
        assert!(!hidden(Vec3::new(0.3, 0.0, -0.2), Vec3::new(0.31, 0.0, -0.2)));
    }

    #[test]
    fn a_triangle_through_the_near_plane_fills_what_is_seen_of_it() {
        let camera = Camera { position: Vec3::Z, target: Vec3::ZERO, ..Camera::front() };
        // A floor from far in front of the camera to behind it, 0.1 m below.
        let corner = |x: f32, z: f32| Vec3::new(x, -0.1, z);
        let floor =
            Mesh::new(vec![corner(-90.0, -50.0), corner(90.0, -50.0), corner(0.0, 9.0)], vec![[0, 2, 1]])
                .unwrap();
        let (_, samples, ..) = drawn(floor, &camera);
        let focal = 130.0 * camera.focal();
        for row in 140..260 {
            let depth = samples.inverse_depths[samples.index(150, row)];
            let expected = (row as f32 + 0.5 - 130.0) / focal / 0.1;
            // One over depth is exact on a plane up to rounding and the skin's depth on a slant.
            assert!(
                (depth / expected - 1.0).abs() < 2.0 * SKIN_DEPTH / MIN_COSINE * expected,
                "{row}: {depth}"
            );
        }
        assert_eq!(samples.inverse_depths[samples.index(150, 120)], 0.0);
    }
}
