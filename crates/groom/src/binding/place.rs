//! Where bound strands are: eight at a time, one lane a strand.

use glam::{Mat3, Vec3, Vec4};
use rayon::prelude::*;
use strandline_body::Pose;
use wide::f32x8;

use super::frames::{Frame, Frames};
use super::influence::{Followed, MOST_INFLUENCES};
use super::{Binding, Surface};
use crate::{LANES, Vec3Lanes, outside::placed_outside};

/// Vectors of eight strands: x, y and z.
type Vectors = [f32x8; 3];

fn load(lanes: &Vec3Lanes) -> Vectors {
    [lanes.x, lanes.y, lanes.z].map(f32x8::from)
}

fn store(vectors: Vectors) -> Vec3Lanes {
    let [x, y, z] = vectors.map(f32x8::to_array);
    Vec3Lanes { x, y, z }
}

fn minus(one: Vectors, two: Vectors) -> Vectors {
    [one[0] - two[0], one[1] - two[1], one[2] - two[2]]
}

fn squared(vectors: Vectors) -> f32x8 {
    vectors[0] * vectors[0] + vectors[1] * vectors[1] + vectors[2] * vectors[2]
}

/// The head's turn.
struct Turn {
    columns: [Vec3; 3],
    translation: Vec3,
}

impl Turn {
    fn new(pose: &Pose) -> Self {
        let Mat3 { x_axis, y_axis, z_axis } = Mat3::from_quat(pose.rotation);
        Self { columns: [x_axis, y_axis, z_axis], translation: pose.translation }
    }

    fn directions(&self, vectors: Vectors) -> Vectors {
        let [x, y, z] = self.columns;
        std::array::from_fn(|axis| vectors[0] * x[axis] + vectors[1] * y[axis] + vectors[2] * z[axis])
    }

    fn points(&self, vectors: Vectors) -> Vectors {
        let turned = self.directions(vectors);
        std::array::from_fn(|axis| turned[axis] + f32x8::splat(self.translation[axis]))
    }
}

impl Binding {
    /// Where all strands are \[m\], world space, shape `[block][point]` of lanes, given where the guides are
    /// ([`Binding::follow`]). Roots move with the head, segments have the lengths that they have at rest, or that
    /// share of them that those of the guides have; points inside the body are put onto its surface.
    pub fn place(
        &self,
        frames: &Frames,
        world_from_head: &Pose,
        surface: Option<&Surface>,
        out: &mut Vec<Vec3Lanes>,
    ) {
        let count = self.strands.points_per_strand();
        let turn = Turn::new(world_from_head);
        out.resize(self.strands.positions().len(), Vec3Lanes::default());
        let blocks = out.par_chunks_mut(count).zip_eq(self.strands.positions().par_chunks(count));
        blocks.zip_eq(&self.blocks).for_each(|((places, rest), followed)| {
            place_block(rest, followed, frames, &turn, surface, places);
        });
    }
}

/// Places the strands of a block, at rest at `rest` \[m\].
fn place_block(
    rest: &[Vec3Lanes],
    followed: &[Followed; MOST_INFLUENCES],
    frames: &Frames,
    turn: &Turn,
    surface: Option<&Surface>,
    places: &mut [Vec3Lanes],
) {
    let count = rest.len();
    let scale = scales(followed, frames);
    let mut here = load(&rest[0]);
    let mut before = turn.points(here);
    // Where the frames have the point before: segments lead as from one such place to the next.
    let mut blended_before = before;
    // How far \[m\] the surface is at least.
    let mut clear = f32x8::ZERO;
    places[0] = store(before);
    for point in 1..count {
        let next = load(&rest[point]);
        let blended = blend(followed, &frames.points, point, count, &rest[point]);
        let (segment, step) = (minus(next, here), minus(blended, blended_before));
        let (own, stretched) = (squared(segment), squared(step));
        let moves = stretched.simd_gt(f32x8::ZERO);
        let mut factor = scale * (own / stretched).sqrt();
        let mut way = step;
        if !moves.all() {
            let carried = turn.directions(segment);
            way = std::array::from_fn(|axis| moves.select(step[axis], carried[axis]));
            factor = moves.select(factor, scale);
        }
        let mut placed: Vectors = std::array::from_fn(|axis| before[axis] + way[axis] * factor);
        if let Some(surface) = surface {
            let length = scale * own.sqrt();
            clear -= length;
            let close = clear.simd_le(f32x8::ZERO).to_bitmask();
            if close != 0 {
                (placed, clear) = outside(close, before, placed, length, clear, surface);
            }
        }
        places[point] = store(placed);
        (here, before, blended_before) = (next, placed, blended);
    }
}

/// How long the guides are that strands follow, over their lengths at rest.
fn scales(followed: &[Followed; MOST_INFLUENCES], frames: &Frames) -> f32x8 {
    followed.iter().fold(f32x8::ZERO, |sum, one| {
        let of_guides = one.guides.map(|guide| frames.scales[guide as usize]);
        sum + f32x8::from(one.weights) * f32x8::from(of_guides)
    })
}

/// Where the guides have a point of their strands, which is at `rest` at rest \[m\].
fn blend(
    followed: &[Followed; MOST_INFLUENCES],
    frames: &[Frame],
    point: usize,
    count: usize,
    rest: &Vec3Lanes,
) -> Vectors {
    let last = (count - 1) as f32;
    let along = followed.each_ref().map(|one| {
        (f32x8::from(one.paces) * point as f32).fast_min(f32x8::splat(last)).fast_trunc_int().to_array()
    });
    let mut found = Vec3Lanes::default();
    for lane in 0..LANES {
        let (x, y, z) = (rest.x[lane], rest.y[lane], rest.z[lane]);
        let mut sum = Vec4::ZERO;
        for (one, along) in followed.iter().zip(&along) {
            let frame = &frames[one.guides[lane] as usize * count + along[lane] as usize];
            let [first, second, third, translation] = frame.columns;
            sum += (first * x + second * y + third * z + translation) * one.weights[lane];
        }
        found.set(lane, sum.truncate());
    }
    load(&found)
}

/// Puts those strands' points that may lie inside onto the surface: `close` has a bit for each.
fn outside(
    close: u32,
    before: Vectors,
    placed: Vectors,
    length: f32x8,
    clear: f32x8,
    surface: &Surface,
) -> (Vectors, f32x8) {
    let (before, mut placed) = (store(before), store(placed));
    let (length, mut clear) = (length.to_array(), clear.to_array());
    for lane in (0..LANES).filter(|lane| close >> lane & 1 == 1) {
        let point = placed.get(lane);
        clear[lane] = (surface.at_least)(point);
        if clear[lane] > 0.0 {
            continue;
        }
        clear[lane] = (surface.at)(point).0;
        if clear[lane] < 0.0 {
            let moved = placed_outside(before.get(lane), point, length[lane], &surface.at);
            placed.set(lane, moved.0);
            clear[lane] = 0.0;
        }
    }
    (load(&placed), f32x8::from(clear))
}
