//! `shelter`: the air among hair, which hair and solids upwind hold back and which hair carries along.

use glam::Vec3;
use strandline_base::par::{self, prelude::*};
use strandline_base::vec3x8::{Vec3x8, load, splat};
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::rod_air::{Air, Around, shares};
use super::wind_box::{Content, Inside, MEAN_SHARE, WindBox};
use crate::cells::grid::REACH;
use crate::contact::Obstacles;
use crate::strands::rods::air::{DENSITY, Wisp};
use crate::wind::{Axes, CELLS, LEAST_SPEED, NO_SPEED, most_speed_sum, per_area};
use crate::{Drive, Model, State};

/// Tasks that sum points.
const MOST_TASKS: usize = 4;

/// Drag area, points and their velocities in a cell, in whole numbers: a sum does not depend on its order.
#[derive(Clone, Copy, Default)]
struct Sum {
    area: u32,
    points: u32,
    speed: [i32; 3],
}

/// The air at points, with the scratch of the stage.
#[derive(Clone, Default)]
pub struct Shelter {
    /// Shape `[task][cell]`.
    sums: Vec<Vec<Sum>>,
    contents: Vec<Content>,
    /// Velocity of the air in the middle of each cell \[m/s\], world space.
    flow: Vec<Vec3>,
    /// Velocity of the air at each point \[m/s\], world space, shape `[block][point]` of lanes.
    pub air: Vec<Vec3Lanes>,
}

/// Finds the air at each point. It passes through the cells of a box about the hair and takes over the velocity of hair by
/// the balance of momentum (Beer's law), with the drag area of all hair that the points stand for; in solids it has their velocity, and
/// behind both the wind mixes in. Each cell takes the air that comes the way the wind blows as seen from its hair: the air in
/// a lock that moves comes along, and where all hair moves alike nothing depends on which of hair and air moves.
pub fn shelter(model: &Model, state: &State, obstacles: &Obstacles, drive: &Drive, space: &mut Shelter) {
    let (wind, currents) = (drive.wind, &drive.currents);
    space.air.resize(state.positions.len(), Vec3Lanes::default());
    let inside = survey(model, state, wind);
    if !inside.blows(!currents.is_empty()) {
        space.air.fill(Vec3Lanes::splat(wind));
        return;
    }
    let cells = WindBox::new(wind, &inside);
    space.sums.resize_with(par::current_num_threads().clamp(1, MOST_TASKS), || vec![Sum::default(); CELLS]);
    space.flow.resize(CELLS, Vec3::ZERO);
    let deposit = Deposit::new(model, wind, &cells, &inside);
    deposit.sum(model, state, &mut space.sums);
    deposit.contents(&space.sums, model.settings.drag.factor, &mut space.contents);
    cells.add_currents(currents, &mut space.contents);
    cells.add_solids(obstacles, &mut space.contents);
    cells.sweep(&space.contents, &mut space.flow);
    let (flow, cells) = (&space.flow, &cells);
    let lanes = space.air.par_iter_mut().zip(&state.positions).with_min_len(512);
    lanes.for_each(|(air, places)| cells.blow(flow, &Vec3x8::load(places), air));
}

/// Bounds of points in the wind's axes, and their largest velocity relative to it along an axis \[m/s\].
fn survey(model: &Model, state: &State, wind: Vec3) -> Inside {
    let points = model.points_per_strand;
    let axes = Axes::along(wind);
    state
        .positions
        .par_chunks(points)
        .zip(state.velocities.par_chunks(points))
        .enumerate()
        .with_min_len(64)
        .map(|(block, (places, velocities))| {
            let live = live_mask(model, block);
            let mut inside = Inside::NONE;
            for (place, velocity) in places.iter().zip(velocities) {
                let local = axes.local(Vec3x8::load(place));
                let speed = axes.local(Vec3x8::load(velocity) - Vec3x8::splat(wind));
                inside.add(local, speed, live & takes_part(local, speed));
            }
            inside
        })
        .reduce(|| Inside::NONE, Inside::with)
}

/// Lanes of a block that hold strands.
fn live_mask(model: &Model, block: usize) -> f32x8 {
    let live = model.live_lanes(block);
    let number: [f32; LANES] = std::array::from_fn(|lane| if lane < live { 1.0 } else { 0.0 });
    f32x8::from(number).simd_gt(f32x8::ZERO)
}

/// Lanes of points that are within reach and no faster than sound a hundred times, which none is that is no number.
fn takes_part(place: Vec3x8, speed: Vec3x8) -> f32x8 {
    let reach = splat(REACH);
    let near = |vector: Vec3x8| {
        vector.x.abs().simd_lt(reach) & vector.y.abs().simd_lt(reach) & vector.z.abs().simd_lt(reach)
    };
    near(place) & near(speed)
}

/// Strands of a block.
struct Hair<'a> {
    places: &'a [Vec3Lanes],
    velocities: &'a [Vec3Lanes],
    lengths: &'a [Lanes],
    live: f32x8,
}

/// Sums points into cells.
struct Deposit<'a> {
    cells: &'a WindBox,
    wind: Vec3x8,
    /// Whole numbers in a metre per second, and in a square metre.
    per_speed: f32,
    per_area: f32,
}

impl<'a> Deposit<'a> {
    fn new(model: &Model, wind: Vec3, cells: &'a WindBox, inside: &Inside) -> Self {
        Self {
            cells,
            wind: Vec3x8::splat(wind),
            per_speed: most_speed_sum(model) / inside.speed.max(NO_SPEED),
            per_area: per_area(model),
        }
    }

    fn sum(&self, model: &Model, state: &State, sums: &mut [Vec<Sum>]) {
        let Some(rods) = &model.rods else { return };
        let (points, blocks) = (model.points_per_strand, state.positions.len() / model.points_per_strand);
        let (air, tasks) = (Air::new(model, model.settings.time_step, Vec3::ZERO), sums.len());
        sums.par_iter_mut().enumerate().for_each(|(task, sums)| {
            sums.fill(Sum::default());
            for block in task * blocks / tasks..(task + 1) * blocks / tasks {
                let range = block * points..(block + 1) * points;
                let hair = Hair {
                    places: &state.positions[range.clone()],
                    velocities: &state.velocities[range.clone()],
                    lengths: &state.lengths.stretch[range],
                    live: live_mask(model, block),
                };
                self.add(&hair, &air.of(&rods.traits[block * LANES..]), sums);
            }
        });
    }

    fn add(&self, hair: &Hair, around: &Around, sums: &mut [Sum]) {
        let last = hair.places.len() - 1;
        let at = |point: usize| Vec3x8::load(&hair.places[point]);
        let lengths: Vec<f32x8> = hair.lengths.iter().map(load).collect();
        let mut along = lengths.clone();
        shares(&lengths, &mut along);
        for point in 0..=last {
            let relative = Vec3x8::load(&hair.velocities[point]) - self.wind;
            let (place, speed) = (self.cells.axes.local(at(point)), self.cells.axes.local(relative));
            let takes_part = (hair.live & takes_part(place, speed)).to_bitmask();
            let before = if point > 0 { lengths[point - 1] } else { f32x8::ZERO };
            let after = if point < last { lengths[point] } else { f32x8::ZERO };
            let tangent = at(last.min(point + 1)) - at(point.saturating_sub(1));
            let area =
                drag_area(&around.wisp_at(along[point]), tangent, relative) * (before + after) * splat(0.5);
            let area = (area * splat(self.per_area) + splat(0.5)).to_array();
            let cells = self.cells.cells_of(place);
            let whole =
                (speed * splat(self.per_speed)).array().map(|along| along.round_ties_even().to_array());
            for lane in (0..LANES).filter(|lane| takes_part & (1 << lane) != 0) {
                let sum = &mut sums[cells[lane] as usize];
                // A number below 0, or none, is 0.
                sum.area += area[lane] as u32;
                sum.points += 1;
                (0..3).for_each(|axis| sum.speed[axis] += whole[axis][lane] as i32);
            }
        }
    }

    /// Contents of the cells, without solids, where the force of the air has a factor.
    fn contents(&self, sums: &[Vec<Sum>], factor: f32, contents: &mut Vec<Content>) {
        let volume = self.cells.volume();
        contents.clear();
        contents.extend((0..CELLS).map(|cell| {
            let (mut area, mut points, mut speed) = (0_u32, 0_u32, [0_i32; 3]);
            for sum in sums.iter().map(|sums| sums[cell]) {
                (area, points) = (area + sum.area, points + sum.points);
                (0..3).for_each(|axis| speed[axis] += sum.speed[axis]);
            }
            let per_point = 1.0 / (points.max(1) as f32 * self.per_speed);
            let speed = Vec3::from(speed.map(|sum| sum as f32)) * per_point;
            Content {
                speed,
                points,
                depth: area as f32 / self.per_area / volume * factor,
                ..Content::default()
            }
        }));
        let total: u32 = contents.iter().map(|content| content.points).sum();
        let whole =
            contents.iter().fold(Vec3::ZERO, |sum, content| sum + content.speed * content.points as f32);
        let mean = whole / total.max(1) as f32;
        contents.iter_mut().for_each(|content| content.toward = -(content.speed + mean * MEAN_SHARE));
    }
}

/// Drag area \[m^2\] of a metre of all hair that each guide stands for, at its velocity relative to the wind \[m/s\]:
/// the force over density and square of the speed.
fn drag_area(wisp: &Wisp<f32x8>, tangent: Vec3x8, relative: Vec3x8) -> f32x8 {
    let square = relative.dot(relative);
    let towards = tangent.dot(relative);
    // Square of the share of the flow along the strand.
    let along = towards * towards / (tangent.dot(tangent) * square + splat(1e-30));
    let along = along.fast_min(splat(1.0));
    let across = splat(1.0) - along;
    let speed = square.sqrt().fast_max(splat(LEAST_SPEED));
    let [push, pull] = wisp.together().drag(speed * across.sqrt());
    (push * across + pull * along) / (speed * splat(DENSITY as f32))
}
