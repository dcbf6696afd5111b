//! Rods that push each other: strands and the forces between them answer each other in rounds, by the augmented
//! Lagrangian in alternating directions with the factors of the Newton steps kept [Daviet2023].

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::{LANES, Vec3Lanes};

use super::rod_neighbours::Neighbours;
use super::rod_room::Room;
use super::rod_strands::Hair;
use crate::ContactReport;
use crate::contact::planes::Plane;
use crate::strands::rods::real::Vector;
use crate::wisps::pair::{Friction, Near, Pair};

/// Blocks and pairs that a thread takes at a time.
pub(super) const BLOCKS: usize = 4;
const PAIRS: usize = 256;
/// Distance over that of touching within which a pair is remembered.
const REMEMBERED: f32 = 1.5;
/// Speed \[m/s\] from which a pair slides: what is slower sticks again.
const SLIPS: f32 = 5e-3;

/// Scratch of strands that push each other, kept from step to step.
#[derive(Clone, Default)]
pub(crate) struct Crowd {
    pub(super) rooms: Vec<Room>,
    points: usize,
    /// Places where a part begins, and motions from there at the earlier velocities and as found \[m\], world space, shape
    /// `[block][point]` of lanes.
    start: Vec<Vec3Lanes>,
    coast: Vec<Vec3Lanes>,
    ways: Vec<Vec3Lanes>,
    neighbours: Neighbours,
    near: Vec<Near>,
    /// Of the last part.
    pub(crate) report: ContactReport,
}

impl Crowd {
    /// Makes room for strands of a number of points.
    pub(super) fn fit(&mut self, places: usize, points: usize) {
        if self.points != points || self.start.len() != places {
            *self = Self {
                rooms: (0..places / points).map(|_| Room::new(points)).collect(),
                points,
                start: vec![Vec3Lanes::default(); places],
                coast: vec![Vec3Lanes::default(); places],
                ways: vec![Vec3Lanes::default(); places],
                ..Self::default()
            };
        }
    }

    /// Takes the strands through a part of a step.
    pub(super) fn part(&mut self, hair: &Hair, planes: &mut [Vec<Plane>], pairs: &mut Vec<Pair>, part: u32) {
        let points = self.points;
        let starts = self.start.par_chunks_mut(points).zip(self.coast.par_chunks_mut(points));
        self.rooms
            .par_iter_mut()
            .zip(planes.par_iter_mut())
            .zip(starts)
            .enumerate()
            .with_min_len(BLOCKS)
            .for_each(|(block, ((room, planes), (start, coast)))| {
                room.begin(hair, planes, block, part, (start, coast));
            });
        self.neighbours.find(hair, (&self.start, &self.coast), part, pairs, &mut self.near);
        self.share_out();
        self.solve(hair);
        let ends = self.start.par_chunks(points).zip(self.ways.par_chunks_mut(points));
        let near = &self.near;
        self.rooms
            .par_iter_mut()
            .zip(planes.par_iter_mut())
            .zip(ends)
            .enumerate()
            .with_min_len(BLOCKS)
            .for_each(|(block, ((room, planes), (start, ways)))| {
                room.end(hair, planes, block, near);
                for (point, (way, start)) in ways.iter_mut().zip(start).enumerate() {
                    (room.space.points[point] - Vector::load(start)).store(way);
                }
            });
        self.remember(pairs, SLIPS * hair.parts.time_step as f32);
    }

    /// Gives each block its pairs, in their order.
    fn share_out(&mut self) {
        self.rooms.iter_mut().for_each(Room::part_from_all);
        let lanes = self.points * LANES;
        for (index, near) in self.near.iter().enumerate() {
            for side in 0..2 {
                self.rooms[near.segments[side] as usize / lanes].meet(index, near, side);
            }
        }
    }

    /// Newton steps of all strands, and rounds after each.
    fn solve(&mut self, hair: &Hair) {
        let (points, contact) = (self.points, &hair.model.settings.contact);
        let friction =
            Friction { sticks: contact.friction, slides: contact.sliding_friction.min(contact.friction) };
        let newton_steps = hair.parts.settings.newton_steps;
        let rounds = contact.rounds.div_ceil(newton_steps);
        let Self { rooms, ways, coast, near, .. } = self;
        for newton in 0..newton_steps {
            if newton > 0 {
                answer(near, ways, friction);
            }
            let each = rooms.par_iter_mut().zip(ways.par_chunks_mut(points)).zip(coast.par_chunks(points));
            each.enumerate().with_min_len(BLOCKS).for_each(|(block, ((room, ways), coast))| {
                if newton == 0 {
                    room.hold(near, hair, block, ways);
                }
                room.push(near, hair, block, newton, (ways, coast));
            });
            if near.is_empty() {
                continue;
            }
            for _ in 0..rounds {
                answer(near, ways, friction);
                let each = rooms.par_iter_mut().zip(ways.par_chunks_mut(points));
                each.enumerate()
                    .with_min_len(BLOCKS)
                    .for_each(|(block, (room, ways))| room.round(near, hair, block, ways));
            }
            rooms.par_iter_mut().with_min_len(BLOCKS).for_each(Room::settle);
        }
    }

    /// Keeps the pairs that touch or nearly do, and measures them; those slide that move by more than `slip` \[m\].
    fn remember(&mut self, pairs: &mut Vec<Pair>, slip: f32) {
        pairs.clear();
        let mut report = ContactReport::default();
        for near in &self.near {
            let way = relative(&self.ways, near);
            let along = near.normal.dot(way);
            let (gap, slips) = (near.gap + along, (way - near.normal * along).length() > slip);
            let presses = near.force != Vec3::ZERO;
            if !gap.is_finite() || !(presses || gap < REMEMBERED * near.touch) {
                continue;
            }
            report.pairs += usize::from(near.normal.dot(near.force) > 0.0);
            report.deepest = report.deepest.max(near.touch - gap);
            report.crossed += usize::from(gap < 0.0);
            pairs.push(Pair {
                segments: near.segments,
                normal: near.normal.to_array(),
                force: near.force.to_array(),
                gap: if near.pulls > 0.0 { near.held_at } else { gap },
                slides: f32::from(u8::from(near.slides && slips)),
            });
        }
        self.report = report;
    }
}

/// A round of all pairs.
fn answer(near: &mut [Near], ways: &[Vec3Lanes], friction: Friction) {
    near.par_iter_mut().with_min_len(PAIRS).for_each(|near| near.answer(relative(ways, near), friction));
}

/// Way \[m\] of the first place of a pair against the second.
#[inline]
fn relative(ways: &[Vec3Lanes], near: &Near) -> Vec3 {
    let way = |side: usize| {
        let (index, lane) = (near.segments[side] as usize / LANES, near.segments[side] as usize % LANES);
        ways[index].get(lane).lerp(ways[index + 1].get(lane), near.shares[side])
    };
    way(0) - way(1)
}
