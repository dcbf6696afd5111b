//! The stage: rods of all strands through a step, in parts, then outside the solids at exact lengths.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::Vec3Lanes;

use super::Scratch;
use super::advance::{Block, NonFinite, recover};
use super::rod_crowd::BLOCKS;
use super::rod_parts::Parts;
use super::rod_room::Room;
use super::rod_strands::Hair;
use crate::contact::Obstacles;
use crate::grab::Pinned;
use crate::loads::Loads;
use crate::strands::rods::workspace::Workspace;
use crate::{Model, RodReport, State};

/// Forces, elasticity, lengths and solids: writes the predicted positions, the sections and the
/// velocities. Returns the points that were not finite, whose strands are back at rest, and how the
/// strands were solved. Without rods nothing is done.
pub fn solve_rods(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    obstacles: &Obstacles,
    wind: Vec3,
) -> (NonFinite, RodReport) {
    let Some(rods) = &model.rods else { return Default::default() };
    if model.settings.has_contact() {
        return solve_crowd(model, state, scratch, obstacles, wind);
    }
    let points = model.points_per_strand;
    let parts = Parts::new(model, obstacles, wind);
    let flow = scratch.shelter.as_ref().map_or(&[][..], |shelter| &shelter.air[..]);
    let nodes = scratch.nodes.as_ref().unwrap_or(&rods.nodes);
    let hair =
        Hair { model, rods, parts: &parts, nodes, lengths: &state.lengths, masses: &scratch.masses, flow };
    let (grab, time_step) = (&state.grab, model.settings.time_step);
    state.loads.fit(&mut state.tensions, state.positions.len() / points, points);
    let Loads { forces, lanes } = &mut state.loads;
    let loads = state.tensions.par_chunks_mut(points).zip(forces.par_chunks_mut(points)).zip(lanes);
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks_mut(points))
        .zip(state.contacts.blocks.par_iter_mut())
        .zip(state.sections.par_chunks_mut(points))
        .zip(state.spins.par_chunks_mut(points))
        .zip(state.corrections.par_chunks_mut(points))
        .zip(loads)
        .enumerate()
        .with_min_len(8)
        .map_init(
            || Workspace::new(points),
            |work, (block, (hair_of, ((tensions, forces), lanes)))| {
                let ((((((predicted, velocities), start), planes), sections), spins), corrections) = hair_of;
                work.set_loads(*lanes, tensions, forces);
                work.load(start, velocities, sections, spins);
                work.load_remainders(corrections, time_step);
                let strands = hair.strands(block);
                let pinned: Vec<Pinned> =
                    grab.pinned(block, predicted, strands.lengths, strands.inverse_mass).collect();
                strands.solve(work, planes, &pinned);
                work.store(predicted, velocities, sections, spins);
                work.store_remainders(corrections, time_step);
                *lanes = work.store_loads(*lanes, tensions, forces);
                let hair = Block { positions: predicted, previous: start, velocities, corrections };
                (recover(model, &obstacles.end, block, hair), work.report)
            },
        )
        .reduce(Default::default, |one, other| (one.0.with(other.0), one.1.with(other.1)))
}

/// As `solve_rods`, of strands that push each other.
pub(super) fn solve_crowd(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    obstacles: &Obstacles,
    wind: Vec3,
) -> (NonFinite, RodReport) {
    let Some(rods) = &model.rods else { return Default::default() };
    let points = model.points_per_strand;
    let parts = Parts::new(model, obstacles, wind);
    let flow = scratch.shelter.as_ref().map_or(&[][..], |shelter| &shelter.air[..]);
    let nodes = scratch.nodes.as_ref().unwrap_or(&rods.nodes);
    let masses = &scratch.masses;
    let hair = Hair { model, rods, parts: &parts, nodes, lengths: &state.lengths, masses, flow };
    let crowd = &mut scratch.crowd;
    crowd.fit(state.positions.len(), points);
    state.loads.fit(&mut state.tensions, state.positions.len() / points, points);
    let time_step = model.settings.time_step;
    begin_rooms(&hair, state, &scratch.predicted, &mut crowd.rooms);
    for part in 0..parts.count {
        crowd.part(&hair, &mut state.contacts.blocks, &mut state.pairs, part);
    }
    let Loads { forces, lanes } = &mut state.loads;
    let loads = state.tensions.par_chunks_mut(points).zip(forces.par_chunks_mut(points)).zip(lanes);
    crowd
        .rooms
        .par_iter_mut()
        .zip(scratch.predicted.par_chunks_mut(points))
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks_mut(points))
        .zip(state.sections.par_chunks_mut(points))
        .zip(state.spins.par_chunks_mut(points))
        .zip(state.corrections.par_chunks_mut(points))
        .zip(loads)
        .enumerate()
        .with_min_len(BLOCKS)
        .map(
            |(
                block,
                (
                    ((((((room, predicted), velocities), previous), sections), spins), corrections),
                    ((tensions, forces), lanes),
                ),
            )| {
                room.space.store_tensions(tensions);
                *lanes = room.space.store_loads(*lanes, &mut [], forces);
                room.space.store(predicted, velocities, sections, spins);
                room.space.store_remainders(corrections, time_step);
                let hair = Block { positions: predicted, previous, velocities, corrections };
                (recover(model, &obstacles.end, block, hair), room.space.report)
            },
        )
        .reduce(Default::default, |one, other| (one.0.with(other.0), one.1.with(other.1)))
}

/// Gives each block its strands, what solids hold of them and the tensions of their segments.
fn begin_rooms(hair: &Hair, state: &State, predicted: &[Vec3Lanes], rooms: &mut [Room]) {
    let (points, time_step) = (hair.model.points_per_strand, hair.model.settings.time_step);
    rooms.par_iter_mut().with_min_len(BLOCKS).enumerate().for_each(|(block, room)| {
        let range = block * points..(block + 1) * points;
        let [places, speeds, sections, corrections, predicted] =
            [&state.positions, &state.velocities, &state.sections, &state.corrections, predicted]
                .map(|vectors| &vectors[range.clone()]);
        room.space.load(places, speeds, sections, &state.spins[range.clone()]);
        room.space.load_remainders(corrections, time_step);
        let strands = hair.strands(block);
        strands.begin(&mut room.space);
        room.space.set_loads(state.loads.lanes[block], &[], &state.loads.forces[range.clone()]);
        room.space.set_tensions(&state.tensions[range]);
        room.pinned.clear();
        room.pinned.extend(state.grab.pinned(block, predicted, strands.lengths, strands.inverse_mass));
    });
}
