//! Buffers on the device.

use std::borrow::Cow;

use strandline_base::par::prelude::*;
use strandline_body::{BodyFrame, SkinTable};
use strandline_gpu::{Buffer, Gpu, THREADS};
use strandline_groom::{LANES, RestShape, Vec3Lanes};

use super::air_buffers::ShelterBuffers;
use super::inputs::Step;
use super::motion::{Root, has_roots, part_count};
use super::records::{Outcome, PointBox, PressureState, Report};
use super::rod_buffers::{NUMBERS, RodBuffers, TRAITS};
use super::rod_crowd_buffers::{ContactState, CrowdBuffers};
use super::solids;
use super::volume::Volume;
use crate::grab::{Grab, Grip, NO_POINT};
use crate::masses::Masses;
use crate::strands::rods::hairs::Traits;
use crate::{Model, Settings, SimError, State};

/// Steps whose reports the device keeps until they are read.
pub(super) const REPORTS: usize = 64;
/// Numbers of a point in the buffer of rest shapes.
const REST: usize = 6;
/// Numbers of a contact plane.
const PLANE: usize = 6;
/// Numbers of a root frame there.
const ROOT: usize = size_of::<Root>() / size_of::<f32>();

/// The buffers of a state. Numbers of points lie as on the CPU, `[block][point]` of lanes; where a
/// point has several they lie `[block][point][number]` of lanes.
pub(super) struct Buffers {
    pub strand_count: usize,
    /// Strands and what fills up the last block.
    pub lane_count: usize,
    pub points: usize,
    /// With the colliders behind it: see solids.wesl.
    pub step: Buffer<Step>,
    /// The skins among them.
    pub skins: SkinTable,
    /// Head space \[m\].
    pub rest_positions: Buffer<f32>,
    /// Six numbers: rest direction (with rods the first axis of the section), rest length \[m\], inverse mass
    /// \[1/kg\], clearance at rest \[m\]. Behind those of all points, without rods, per strand from the hand to the
    /// point \[m\] that it holds, and its number; below 0 for none. Behind these the root frames, once there are any: see
    /// roots.wesl.
    pub rest: Buffer<f32>,
    /// Two numbers: rest lengths of the bend and the torsion spring \[m\].
    pub springs: Buffer<f32>,
    /// \[kg\]
    pub mass: Buffer<f32>,
    /// Positions \[m\] of the last two steps; which is the newer changes with every step.
    pub places: [Buffer<f32>; 2],
    /// Velocities of all points \[m/s\], and behind them what the next prediction adds to them; with rods
    /// what solve_rods.wesl says.
    pub velocities: Buffer<f32>,
    /// Six numbers: see strand.wesl.
    pub planes: Buffer<f32>,
    /// Per workgroup of strands.
    pub boxes: Buffer<PointBox>,
    /// Per workgroup of strands.
    pub outcomes: Buffer<Outcome>,
    pub reports: Buffer<Report>,
    /// Report of a step without a volume.
    pub no_pressure: Buffer<PressureState>,
    /// Contacts of strands with each other in the last part of a step.
    pub contacts: Buffer<ContactState>,
    pub volume: Option<Volume>,
    pub rods: Option<RodBuffers>,
}

impl Buffers {
    /// Copies a state to the device.
    pub fn new(gpu: &Gpu, model: &Model, state: &State) -> Result<Self, SimError> {
        let state = &model.with_sections(state);
        let points = model.points_per_strand;
        let lane_count = model.lane_count();
        let count = lane_count * points;
        let workgroups = lane_count.div_ceil(THREADS);
        let (step, skins) = solids::behind_step(gpu, &model.colliders)?;
        let vectors = |name, lanes: &[Vec3Lanes]| Buffer::from_slice(gpu, name, floats(lanes));
        let buffers = Self {
            strand_count: model.strand_count,
            lane_count,
            points,
            step,
            skins,
            rest_positions: vectors("rest positions", &model.positions)?,
            rest: Buffer::new(gpu, "rest shape", (REST * points + 4) * lane_count)?,
            springs: Buffer::new(gpu, "springs", 2 * count)?,
            mass: Buffer::new(gpu, "masses", count)?,
            places: [
                vectors("positions", &state.positions)?,
                vectors("predicted positions", &state.previous_positions)?,
            ],
            velocities: Buffer::from_slice(gpu, "velocities", &speeds(state))?,
            planes: Buffer::new(gpu, "contact planes", PLANE * count)?,
            boxes: Buffer::new(gpu, "boxes", model.strand_count.div_ceil(THREADS))?,
            outcomes: Buffer::new(gpu, "outcomes", workgroups)?,
            reports: Buffer::new(gpu, "reports", REPORTS)?,
            no_pressure: Buffer::new(gpu, "no pressure", 1)?,
            contacts: Buffer::new(gpu, "contacts of strands", 1)?,
            volume: None,
            rods: match &model.rods {
                Some(_) => Some(RodBuffers::new(gpu, model)?),
                None => None,
            },
        };
        buffers.write_rest(model, &state.lengths)?;
        buffers.write_grips(&state.grab)?;
        buffers.write_pairs(state)?;
        Ok(buffers)
    }

    pub fn point_count(&self) -> usize {
        self.lane_count * self.points
    }

    /// Writes the memory of the pairs of strands, where they push each other.
    pub fn write_pairs(&self, state: &State) -> Result<(), SimError> {
        self.crowd().map_or(Ok(()), |crowd| crowd.write(&state.pairs))
    }

    /// The buffers of strands that push each other.
    pub fn crowd(&self) -> Option<&CrowdBuffers> {
        self.rods.as_ref()?.crowd.as_ref()
    }

    /// The air at the points, where it differs.
    pub fn shelter(&self) -> Option<&ShelterBuffers> {
        self.rods.as_ref()?.shelter.as_ref()
    }

    /// Makes buffers for the air at the points, or drops them, by the settings. Returns true where that changed.
    pub fn fit_shelter(&mut self, gpu: &Gpu, settings: &Settings) -> Result<bool, SimError> {
        let (count, wanted) = (self.point_count(), settings.has_shelter());
        let Some(rods) = self.rods.as_mut().filter(|rods| rods.shelter.is_some() != wanted) else {
            return Ok(false);
        };
        rods.shelter = if wanted { Some(ShelterBuffers::new(gpu, count)?) } else { None };
        Ok(true)
    }

    /// Bytes that a step must move at least, without the rounds of the pressure solve: each number
    /// that a kernel reads or writes, once.
    pub fn bytes_of_step(&self) -> u64 {
        // Numbers of four bytes per point: pose_roots touches two points of each strand only.
        const INTEGRATE: u64 = 3 + 3 + 3 + 2 + 2 + 3;
        const CONSTRAIN: u64 = 3 + 3 + 6 + PLANE as u64 + 3 + 3 + 3;
        const ADVANCE: u64 = 3 + 3 + 2;
        // Bounds, cells, order, sums of faces, gather.
        const VOLUME: u64 = 4 + (4 + 2) + (2 + 3 + 3 + 1 + 8) + 8 + (1 + 3 + 3 + 3);
        // Counts, sums, kinds, rows, faces written and read back.
        const CELL: u64 = 4 + 6 + 2 + 3 + 6 + 6;
        let strands = 4 * self.point_count() as u64 * (INTEGRATE + CONSTRAIN + ADVANCE);
        let volume = self
            .volume
            .as_ref()
            .map_or(0, |volume| 4 * (self.point_count() as u64 * VOLUME + volume.cell_count as u64 * CELL));
        strands + volume
    }

    /// Writes what follows from the settings and the lengths of the strands.
    pub fn write_rest(&self, model: &Model, lengths: &RestShape) -> Result<(), SimError> {
        let masses = Masses::new(model, lengths);
        let mut rest = Vec::with_capacity(REST * LANES * model.positions.len());
        let mut springs = Vec::with_capacity(2 * LANES * model.positions.len());
        let axes = model.rods.as_ref().map_or(&model.directions, |rods| &rods.sections);
        for index in 0..model.positions.len() {
            rest.extend_from_slice(floats(&axes[index..=index]));
            for lanes in [&lengths.stretch, &masses.inverse_mass, &model.rest_clearance] {
                // Infinity has no place in a shader.
                rest.extend(lanes[index].0.map(|number| number.min(f32::MAX)));
            }
            springs.extend_from_slice(&lengths.bend[index].0);
            springs.extend_from_slice(&lengths.torsion[index].0);
        }
        self.rest.write(&rest)?;
        self.springs.write(&springs)?;
        self.mass.write(bytemuck::cast_slice(&masses.mass))?;
        self.write_nodes(model, lengths, &masses)
    }

    /// Writes the nodes of rods with lengths of their strands.
    pub fn write_rods(&self, model: &Model, lengths: &RestShape) -> Result<(), SimError> {
        self.write_nodes(model, lengths, &Masses::new(model, lengths))
    }

    fn write_nodes(&self, model: &Model, lengths: &RestShape, masses: &Masses) -> Result<(), SimError> {
        let (Some(buffers), Some(nodes)) = (&self.rods, model.nodes_with(lengths, &masses.mass)) else {
            return Ok(());
        };
        let mut numbers = Vec::with_capacity(buffers.nodes.len());
        for (position, node) in model.positions.iter().zip(&nodes) {
            numbers.extend_from_slice(floats(std::slice::from_ref(position)));
            let [one, two, three] = node.rest;
            for lanes in [node.length, node.stretch, node.stiffness[0], one, two, three, node.inertia] {
                numbers.extend(lanes.to_array());
            }
        }
        buffers.nodes.write(&numbers)?;
        let traits = model.rods.iter().flat_map(|rods| &rods.traits);
        let numbers_of = |one: &Traits| -> [f32; TRAITS] {
            let Traits { bend_ratio, twist_ratio, damping, crowding, diameter, tip, taper_start, .. } = *one;
            let Traits { hairs, packing, .. } = *one;
            [bend_ratio, twist_ratio, damping, crowding, diameter, tip, taper_start, hairs, packing]
        };
        let traits: Vec<f32> = traits.flat_map(numbers_of).collect();
        // The grips lie before them.
        Ok(buffers.nodes.write_at(numbers.len() + 4 * self.lane_count, &traits)?)
    }

    /// Makes room for root frames behind the rest shape. Returns true where there was none, and kernels have to be
    /// bound anew.
    pub fn make_room_for_roots(
        &mut self,
        gpu: &Gpu,
        model: &Model,
        lengths: &RestShape,
        grab: &Grab,
    ) -> Result<bool, SimError> {
        let count = self.first_root() + ROOT * self.lane_count;
        if self.rest.len() == count {
            return Ok(false);
        }
        self.rest = Buffer::new(gpu, "rest shape and root frames", count)?;
        self.write_rest(model, lengths)?;
        self.write_grips(grab)?;
        Ok(true)
    }

    /// Index of the first number of the root frames in the buffer of rest shapes.
    fn first_root(&self) -> usize {
        REST * self.point_count() + 4 * self.lane_count
    }

    /// Writes the root frames of a step between two frames of the body; nothing where they ride the head.
    pub fn write_roots(&self, model: &Model, [start, end]: [&BodyFrame; 2]) -> Result<(), SimError> {
        if !has_roots(start, end) {
            return Ok(());
        }
        let (parts, last) = (part_count(model), model.strand_count - 1);
        let strands = (0..self.lane_count).into_par_iter().map(|lane| lane.min(last));
        let root = |strand| Root::new(&start.root(strand), &end.root(strand), parts);
        let roots: Vec<Root> = strands.map(root).collect();
        Ok(self.rest.write_at(self.first_root(), bytemuck::cast_slice(&roots))?)
    }

    /// Writes what a hand holds; with an empty hand it is not read.
    pub fn write_grips(&self, grab: &Grab) -> Result<(), SimError> {
        if grab.grips.is_empty() {
            return Ok(());
        }
        let grips: Vec<_> =
            grab.grips.iter().flat_map(|block| (0..LANES).map(|lane| grip(block, lane))).collect();
        match &self.rods {
            Some(rods) => {
                Ok(rods.nodes.write_at(NUMBERS * self.point_count(), bytemuck::cast_slice(&grips))?)
            }
            None => Ok(self.rest.write_at(REST * self.point_count(), bytemuck::cast_slice(&grips))?),
        }
    }
}

/// A grip as the kernel reads it.
fn grip(grip: &Grip, lane: usize) -> [f32; 4] {
    let point = grip.points[lane];
    let number = if point == NO_POINT { -1.0 } else { point as f32 };
    grip.offsets.get(lane).extend(number).to_array()
}

/// Velocities and what the next prediction adds to them, as the device has them; of rods sections and their
/// speeds, room for how strands were solved, then what the next prediction adds, and last what solids hold and tensions.
pub(super) fn speeds(state: &State) -> Vec<f32> {
    if state.sections.is_empty() {
        return [floats(&state.velocities), floats(&state.corrections)].concat();
    }
    let blocks = state.length_scale.len();
    let outcomes = vec![0.0; 2 * LANES * blocks];
    let spins: &[f32] = bytemuck::cast_slice(&state.spins);
    let corrections = floats(&state.corrections);
    let (velocities, sections) = (floats(&state.velocities), floats(&state.sections));
    let count = state.positions.len() * LANES;
    let of_solids = [
        or_none(floats(&state.loads.forces), 3 * count),
        or_none(bytemuck::cast_slice(&state.tensions), count),
    ];
    let [forces, tensions] = &of_solids;
    [velocities, sections, spins, &outcomes, corrections, forces, tensions].concat()
}

/// A number of values, 0 where there are none.
fn or_none(values: &[f32], count: usize) -> Cow<'_, [f32]> {
    if values.is_empty() { Cow::Owned(vec![0.0; count]) } else { Cow::Borrowed(values) }
}

/// Vectors as the numbers that they are.
pub(super) fn floats(lanes: &[Vec3Lanes]) -> &[f32] {
    bytemuck::cast_slice(lanes)
}

/// Vectors as the numbers that they are, to be written.
pub(super) fn floats_mut(lanes: &mut [Vec3Lanes]) -> &mut [f32] {
    bytemuck::cast_slice_mut(lanes)
}
