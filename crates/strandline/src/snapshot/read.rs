//! A snapshot as it is read.

use std::io::{Read, Seek};

use glam::Vec3;
use strandline_base::npz::{Kind, Npz, f32s, f64s};

use super::{
    ORIGIN, Snapshot,
    arrays::{check_memory, expect, numbers, text},
    names,
};
use crate::{
    sim::StateArray,
    strands::bodies::{LISTS, OF_STATE, WIDTHS},
};

/// Most numbers that a part of a state has for a point: the planes of all carriers that a body may have.
const NUMBERS_PER_POINT: u64 = 8 * 64;

/// State of the run whose arrays have names with `before` in front; the number of points includes those that fill up the
/// last block.
pub(crate) fn read<R: Read + Seek>(
    npz: &mut Npz<R>,
    before: &str,
    points: u64,
) -> Result<Option<Snapshot>, String> {
    let named = |name: &str| format!("{before}{name}");
    let clock_name = named("state_clock");
    let Some(mut clock) = npz.open(&clock_name).map_err(text)? else { return Ok(None) };
    expect(&clock, &clock_name, Kind::F64, &[Some(3)])?;
    let clock: Vec<f64> = f64s(&npz.all(&mut clock).map_err(text)?).collect();
    let f32s_of = |bytes: &[u8]| f32s(bytes).collect::<Vec<_>>();
    let poses = numbers(npz, &named("state_poses"), Kind::F32, &[Some(4), Some(7)], f32s_of)?;
    let mut lists: [Vec<f32>; LISTS] = Default::default();
    for ((name, width), list) in OF_STATE.into_iter().zip(WIDTHS).zip(&mut lists) {
        let name = named(name);
        if npz.open(&name).map_err(text)?.is_some() {
            let shape = [Some(4), None, Some(width as u64)];
            *list = numbers(npz, &name, Kind::F32, &shape, f32s_of)?;
        }
    }
    let mut parts = Vec::new();
    for (name, part) in names() {
        let name = named(&name);
        let Some(mut rows) = npz.open(&name).map_err(text)? else { continue };
        if rows.kind() != Kind::F32 {
            return Err(format!("{name} of type {}, expected {}", rows.kind().name(), Kind::F32.name()));
        }
        if rows.bytes() > 4 * NUMBERS_PER_POINT * points {
            let (shape, kind) = (rows.shape(), rows.kind().name());
            return Err(format!(
                "{name} of type {kind} and shape {shape:?}, but the scene's hair has {points} points"
            ));
        }
        check_memory(&name, rows.bytes(), 2)?;
        let shape = rows.shape().iter().map(|count| *count as usize).collect();
        let numbers = f32s_of(&npz.all(&mut rows).map_err(text)?);
        parts.push(StateArray { name: part, shape, numbers });
    }
    let snapshot = Snapshot::new(&clock, &poses, &lists, parts)?;
    let origin_name = named(ORIGIN);
    if npz.open(&origin_name).map_err(text)?.is_none() {
        return Ok(Some(snapshot));
    }
    let origin = numbers(npz, &origin_name, Kind::F32, &[Some(3)], f32s_of)?;
    Ok(Some(Snapshot { origin: Vec3::from_slice(&origin), ..snapshot }))
}
