//! The stage: rods of all strands through a step, in parts, then outside the solids at exact lengths.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::Lanes;

use super::Scratch;
use super::advance::{Block, NonFinite, recover};
use super::rod_crowd::BLOCKS;
use super::rod_parts::Parts;
use super::rod_strands::Hair;
use crate::contact::Obstacles;
use crate::grab::Pinned;
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
    scratch
        .predicted
        .par_chunks_mut(points)
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks_mut(points))
        .zip(state.contacts.blocks.par_iter_mut())
        .zip(state.sections.par_chunks_mut(points))
        .zip(state.spins.par_chunks_mut(points))
        .zip(state.corrections.par_chunks_mut(points))
        .enumerate()
        .with_min_len(8)
        .map_init(
            || Workspace::new(points),
            |work, (block, ((((((predicted, velocities), start), planes), sections), spins), corrections))| {
                work.load(start, velocities, sections, spins);
                work.load_remainders(corrections, time_step);
                let strands = hair.strands(block);
                let pinned: Vec<Pinned> =
                    grab.pinned(block, predicted, strands.lengths, strands.inverse_mass).collect();
                strands.solve(work, planes, &pinned);
                work.store(predicted, velocities, sections, spins);
                work.store_remainders(corrections, time_step);
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
    let (tensions, time_step) = (&state.tensions, model.settings.time_step);
    crowd.rooms.par_iter_mut().with_min_len(BLOCKS).enumerate().for_each(|(block, room)| {
        let range = block * points..(block + 1) * points;
        let [places, speeds, sections, corrections, predicted] =
            [&state.positions, &state.velocities, &state.sections, &state.corrections, &scratch.predicted]
                .map(|vectors| &vectors[range.clone()]);
        room.space.load(places, speeds, sections, &state.spins[range.clone()]);
        room.space.load_remainders(corrections, time_step);
        let strands = hair.strands(block);
        strands.begin(&mut room.space);
        room.space.set_tensions(tensions.get(range).unwrap_or_default());
        room.pinned.clear();
        room.pinned.extend(state.grab.pinned(block, predicted, strands.lengths, strands.inverse_mass));
    });
    for part in 0..parts.count {
        crowd.part(&hair, &mut state.contacts.blocks, &mut state.pairs, part);
    }
    state.tensions.resize(state.positions.len(), Lanes::default());
    crowd
        .rooms
        .par_iter_mut()
        .zip(scratch.predicted.par_chunks_mut(points))
        .zip(state.velocities.par_chunks_mut(points))
        .zip(state.positions.par_chunks_mut(points))
        .zip(state.sections.par_chunks_mut(points))
        .zip(state.spins.par_chunks_mut(points))
        .zip(state.corrections.par_chunks_mut(points))
        .zip(state.tensions.par_chunks_mut(points))
        .enumerate()
        .with_min_len(BLOCKS)
        .map(
            |(
                block,
                (((((((room, predicted), velocities), previous), sections), spins), corrections), tensions),
            )| {
                room.space.store_tensions(tensions);
                room.space.store(predicted, velocities, sections, spins);
                room.space.store_remainders(corrections, time_step);
                let hair = Block { positions: predicted, previous, velocities, corrections };
                (recover(model, &obstacles.end, block, hair), room.space.report)
            },
        )
        .reduce(Default::default, |one, other| (one.0.with(other.0), one.1.with(other.1)))
}
