//! Parts of a step of rods: what all strands share.

use glam::Vec3;
use strandline_body::{BodyFrame, Pose};
use strandline_groom::LANES;
use wide::f32x8;

use super::fall::Fall;
use super::rod_air::Air;
use crate::Model;
use crate::contact::Obstacles;
use crate::contact::contacts::Solids;
use crate::strands::rods::hairs::Traits;
use crate::strands::rods::settings::RodSettings;
use crate::strands::rods::workspace::Carry;

/// Inputs of a step that all strands share.
pub(super) struct Parts<'a> {
    pub(super) settings: &'a RodSettings,
    pub(super) count: u32,
    pub(super) time_step: f64,
    pub(super) fall: Fall,
    pub(super) air: Air,
    pub(super) solids: Solids<'a>,
    /// Body at the start and at the end of the step.
    body: [&'a BodyFrame; 2],
    /// Rides of the head, one for each part.
    pub(super) head: Vec<Ride>,
}

/// The motion of a root frame through a part of a step.
pub(super) struct Ride {
    /// At the end of the part.
    pub(super) world_from_root: Carry,
    /// From its start to its end; `None` where nothing moves.
    pub(super) moved: Option<Carry>,
}

impl<'a> Parts<'a> {
    pub(super) fn new(model: &'a Model, obstacles: &'a Obstacles<'a>, wind: Vec3) -> Self {
        let settings = &model.settings.strands.rods;
        let count = settings.substeps;
        let time_step = model.settings.time_step / count as f32;
        let body = [&obstacles.start, &obstacles.end];
        let head = body.map(BodyFrame::world_from_head);
        let ride = |part| {
            let (world_from_root, moved) = head[0].part_of_way(&head[1], part, count);
            let moved = (moved != Pose::IDENTITY).then(|| Carry::new(&moved));
            Ride { world_from_root: Carry::new(&world_from_root), moved }
        };
        Self {
            settings,
            count,
            time_step: f64::from(time_step),
            fall: Fall::of_rods(model, time_step, wind),
            air: Air::new(model, time_step, wind),
            solids: Solids::in_parts(obstacles, model.points_per_strand, count),
            body,
            head: (0..count).map(ride).collect(),
        }
    }

    /// Poses of the head, `world_from_head`, at the start and at the end of a part.
    pub(super) fn head_through(&self, part: u32) -> [Pose; 2] {
        let [start, end] = self.body.map(BodyFrame::world_from_head);
        let before = part.checked_sub(1).map_or(start, |part| start.part_of_way(&end, part, self.count).0);
        [before, start.part_of_way(&end, part, self.count).0]
    }

    /// True where root frames are the strands' own.
    pub(super) fn has_roots(&self) -> bool {
        self.body.iter().any(|body| body.roots().is_some())
    }

    /// The ride of a block of strands with root frames of their own.
    pub(super) fn ride(&self, model: &Model, block: usize, part: u32) -> Ride {
        let [starts, ends] = self.body.map(|body| model.roots(body, block));
        let through: [(Pose, Pose); LANES] =
            std::array::from_fn(|lane| starts[lane].part_of_way(&ends[lane], part, self.count));
        let moved = through.map(|(_, moved)| moved);
        let moves = moved.iter().any(|moved| *moved != Pose::IDENTITY);
        Ride {
            world_from_root: Carry::of_lanes(&through.map(|(after, _)| after)),
            moved: moves.then(|| Carry::of_lanes(&moved)),
        }
    }

    /// Mask of the strands of a block whose root frames move: they do not rest.
    pub(super) fn driven(&self, model: &Model, block: usize) -> f32x8 {
        let [starts, ends] = self.body.map(|body| model.roots(body, block));
        let moves: [f32; LANES] =
            std::array::from_fn(|lane| if starts[lane] == ends[lane] { 0.0 } else { 1.0 });
        f32x8::from(moves).simd_gt(f32x8::ZERO)
    }

    /// Relaxation times of a block's strands over the length of a part.
    pub(super) fn viscous(&self, strands: &[Traits]) -> f32x8 {
        let of = |lane: usize| (f64::from(strands[lane].damping) / self.time_step) as f32;
        f32x8::from(std::array::from_fn::<f32, LANES, _>(of))
    }
}
