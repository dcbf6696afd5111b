//! The arrays of a snapshot and of a moving cache as they are read: of the type and shape that they should have, and no
//! larger.

use std::io::{Read, Seek};

use strandline_base::{
    memory::{self, Need},
    npz::{Kind, Npz, NpzError, Rows, u32s},
};

use super::MAX_FRAMES;
use crate::groom::format::{MAX_POINTS, MAX_STRANDS};

pub(crate) fn text(error: NpzError) -> String {
    error.to_string()
}

pub(crate) fn missing<R: Read + Seek>(npz: &Npz<R>, name: &str) -> String {
    let names: Vec<&str> = npz.names().take(20).collect();
    format!("holds {names:?}, expected {name} and the other arrays that docs/cache.md lists")
}

/// The length of the first axis of an array that has to have a type and a shape.
pub(crate) fn expect(rows: &Rows, name: &str, kind: Kind, shape: &[Option<u64>]) -> Result<u64, String> {
    let fits = rows.shape().len() == shape.len()
        && rows.shape().iter().zip(shape).all(|(found, wanted)| wanted.is_none_or(|wanted| wanted == *found));
    if rows.kind() != kind || !fits {
        let wanted: Vec<String> =
            shape.iter().map(|count| count.map_or("frame".to_owned(), |count| count.to_string())).collect();
        return Err(format!(
            "{name} of type {} and shape {:?}, expected {} and [{}]",
            rows.kind().name(),
            rows.shape(),
            kind.name(),
            wanted.join(", ")
        ));
    }
    let first = rows.shape().first().copied().unwrap_or(0);
    if shape.first() == Some(&None) && first > MAX_FRAMES {
        return Err(format!("{name} of {first} frames, expected {MAX_FRAMES} at most"));
    }
    Ok(first)
}

/// Refuses an array that would take too much memory: its bytes in the file times a factor.
pub(crate) fn check_memory(name: &str, bytes: u64, times: u64) -> Result<(), String> {
    memory::check(&[Need::new(format!("the array {name}"), bytes, times)]).map_err(|error| error.to_string())
}

/// All numbers of an array that has to be there.
pub(crate) fn numbers<R: Read + Seek, T>(
    npz: &mut Npz<R>,
    name: &str,
    kind: Kind,
    shape: &[Option<u64>],
    convert: impl Fn(&[u8]) -> T,
) -> Result<T, String> {
    let Some(mut rows) = npz.open(name).map_err(text)? else { return Err(missing(npz, name)) };
    expect(&rows, name, kind, shape)?;
    check_memory(name, rows.bytes(), 2)?;
    Ok(convert(&npz.all(&mut rows).map_err(text)?))
}

/// First point of each strand, then the number of points.
pub(crate) fn starts<R: Read + Seek>(npz: &mut Npz<R>) -> Result<Vec<u32>, String> {
    let Some(mut rows) = npz.open("starts").map_err(text)? else { return Err(missing(npz, "starts")) };
    if rows.kind() != Kind::U32
        || rows.shape().len() != 1
        || !(2..=MAX_STRANDS + 1).contains(&rows.shape()[0])
    {
        let (kind, shape) = (rows.kind().name(), rows.shape());
        return Err(format!("starts of type {kind} and shape {shape:?}, expected <u4 and [strand + 1]"));
    }
    let starts: Vec<u32> = u32s(&npz.all(&mut rows).map_err(text)?).collect();
    let rise = starts[0] == 0 && starts.windows(2).all(|pair| pair[0] < pair[1]);
    let count = u64::from(starts[starts.len() - 1]);
    if !rise || count > MAX_POINTS {
        return Err(format!("starts that end with {count}, expected to rise from 0 to {MAX_POINTS} at most"));
    }
    Ok(starts)
}
