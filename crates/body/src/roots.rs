//! Even spreads of points over the scalp.

use glam::{Vec2, Vec3};

use crate::mannequin::Mannequin;
use crate::{Mesh, SignedDistance};

/// Candidates for each wanted point; more make the spread more even.
const CANDIDATES: usize = 12;
/// Above this many points each is a candidate of its own: so dense a spread needs no elimination.
const DENSE: usize = 250_000;
/// By how much the least distance shrinks from pass to pass.
const SHRINK: f32 = 0.965;
/// The hexagonal packing's distance for unit area a point, where the passes begin.
const PACKED: f32 = 1.0746;

/// A small generator of random numbers (PCG, 64-bit state) [ONeill2014].
pub struct Random(u64);

impl Random {
    /// Of a seed; `stream` makes independent ones.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut random =
            Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ stream.wrapping_mul(0xD1B5_4A32_D192_ED03));
        random.next();
        random
    }

    fn next(&mut self) -> u32 {
        let state = self.0;
        self.0 = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let shifted = (((state >> 18) ^ state) >> 27) as u32;
        shifted.rotate_right((state >> 59) as u32)
    }

    /// Evenly from 0 to below 1.
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 8) as f32 / (1 << 24) as f32
    }
}

/// The triangles of the skin on which hair grows.
pub struct ScalpTriangles {
    corners: Vec<[Vec3; 3]>,
    /// Area of all triangles up to and including each \[m^2\].
    areas: Vec<f64>,
}

impl ScalpTriangles {
    /// Those whose middle `grows`.
    pub fn new(mannequin: &Mannequin, grows: impl Fn(Vec3) -> bool) -> Self {
        let Mesh { positions, triangles, .. } = mannequin.mesh();
        let (mut corners, mut areas, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
            if grows((a + b + c) / 3.0) {
                sum += 0.5 * f64::from((b - a).cross(c - a).length());
                corners.push([a, b, c]);
                areas.push(sum);
            }
        }
        Self { corners, areas }
    }

    fn area(&self) -> f32 {
        self.areas.last().copied().unwrap_or(0.0) as f32
    }

    /// `count` points, one in each of as many pieces of equal area, in the order of the triangles.
    fn sample(&self, count: usize, random: &mut Random) -> Vec<Vec3> {
        let total = self.areas.last().copied().unwrap_or(0.0);
        let mut triangle = 0;
        (0..count)
            .map(|index| {
                let area = total * (index as f64 + f64::from(random.unit())) / count as f64;
                while triangle + 1 < self.areas.len() && self.areas[triangle] < area {
                    triangle += 1;
                }
                let [a, b, c] = self.corners[triangle];
                let (root, share) = (random.unit().sqrt(), random.unit());
                a * (1.0 - root) + b * (root * (1.0 - share)) + c * (root * share)
            })
            .collect()
    }
}

/// `count` points on the skin and their normals: of many candidates in random order those are
/// taken that keep a least distance, which shrinks until there are enough.
pub fn spread(
    triangles: &ScalpTriangles,
    mannequin: &Mannequin,
    count: usize,
    seed: u64,
) -> Vec<(Vec3, Vec3)> {
    let mut random = Random::new(seed, 1);
    let settle = |point: Vec3| {
        let mut point = point;
        for _ in 0..4 {
            let (distance, normal) = mannequin.distance_and_gradient(point);
            point -= normal * distance;
        }
        (point, mannequin.distance_and_gradient(point).1)
    };
    if count > DENSE {
        return triangles.sample(count, &mut random).into_iter().map(settle).collect();
    }
    let mut candidates = triangles.sample(CANDIDATES * count.max(8), &mut random);
    for index in (1..candidates.len()).rev() {
        let other = (random.unit() * (index + 1) as f32) as usize;
        candidates.swap(index, other.min(index));
    }
    let mut gap = PACKED * (triangles.area() / count as f32).sqrt();
    let mut taken = Buckets::new(gap);
    while taken.points.len() < count {
        candidates.retain(|candidate| {
            if taken.points.len() == count || taken.is_near(*candidate, gap) {
                return true;
            }
            taken.insert(*candidate);
            false
        });
        gap *= SHRINK;
    }
    taken.points.into_iter().map(settle).collect()
}

/// Points in cubes with an edge of the largest least distance.
struct Buckets {
    edge: f32,
    points: Vec<Vec3>,
    heads: Vec<u32>,
    links: Vec<u32>,
}

const NONE: u32 = u32::MAX;
/// Cubes along each side; the whole reaches 0.16 m to each side of the origin.
const SIDE: i32 = 128;

impl Buckets {
    fn new(gap: f32) -> Self {
        let edge = gap.max(0.32 / SIDE as f32);
        Self { edge, points: Vec::new(), heads: vec![NONE; (SIDE * SIDE * SIDE) as usize], links: Vec::new() }
    }

    fn cube(&self, point: Vec3) -> [i32; 3] {
        (point / self.edge).floor().to_array().map(|along| (along as i32 + SIDE / 2).clamp(0, SIDE - 1))
    }

    fn insert(&mut self, point: Vec3) {
        let [x, y, z] = self.cube(point);
        let cube = (x + SIDE * (y + SIDE * z)) as usize;
        self.links.push(std::mem::replace(&mut self.heads[cube], self.points.len() as u32));
        self.points.push(point);
    }

    fn is_near(&self, point: Vec3, gap: f32) -> bool {
        let [x, y, z] = self.cube(point);
        let range = |at: i32| (at - 1).max(0)..=(at + 1).min(SIDE - 1);
        for z in range(z) {
            for y in range(y) {
                for x in range(x) {
                    let mut next = self.heads[(x + SIDE * (y + SIDE * z)) as usize];
                    while next != NONE {
                        if self.points[next as usize].distance_squared(point) < gap * gap {
                            return true;
                        }
                        next = self.links[next as usize];
                    }
                }
            }
        }
        false
    }
}

/// Place of a point of the unit square along the Z-order curve.
pub fn curve_index(uv: Vec2) -> u32 {
    let spread = |value: f32| {
        let mut bits = (value.clamp(0.0, 1.0) * 65_535.0) as u32;
        bits = (bits | bits << 8) & 0x00FF_00FF;
        bits = (bits | bits << 4) & 0x0F0F_0F0F;
        bits = (bits | bits << 2) & 0x3333_3333;
        (bits | bits << 1) & 0x5555_5555
    };
    spread(uv.x) | spread(uv.y) << 1
}
