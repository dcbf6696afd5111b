//! Writing of kept frames.

use std::borrow::Cow;
use std::io::Result;
use std::path::Path;

use strandline_base::npz::{Array, Growing, GrowingNpz, Kind};

use super::{Meta, meta::LAYOUT, point_bytes, prefix};
use crate::{
    body::BodyFrame,
    groom::{LANES, Vec3Lanes},
    snapshot::{self, Snapshot},
    strands::bodies::{self, Lists, OF_FRAMES},
};

/// Writes frames with these bodies under a temporary name of the folder, and then under its own. `frame` gives the time
/// \[s\] of motion and wind and the points of one, shape `[block][point]` of lanes. Sums of the frames are set in `meta`;
/// `tell` receives the number of frames that are written.
///
/// # Errors
/// Errors of the system.
pub(crate) fn write<'a>(
    path: &Path,
    mut meta: Meta,
    marks: &[Snapshot],
    bodies: &[BodyFrame],
    frame: impl Fn(usize) -> Result<(f64, Cow<'a, [Vec3Lanes]>)>,
    tell: impl Fn(usize),
) -> Result<()> {
    (meta.layout, meta.written_by) = (LAYOUT, format!("strandline {}", env!("CARGO_PKG_VERSION")));
    let names: Vec<(String, &'static str)> = snapshot::names().collect();
    let lists = Lists::of(bodies);
    let each = u64::from(meta.points) * u64::from(meta.strands).div_ceil(LANES as u64);
    let mut growing = vec![
        Growing { name: "times", kind: Kind::F64, row: vec![] },
        Growing { name: "world_from_head", kind: Kind::F32, row: vec![7] },
    ];
    growing.extend(lists.present().map(|(list, length, width)| Growing {
        name: OF_FRAMES[list],
        kind: Kind::F32,
        row: vec![length as u64, width as u64],
    }));
    growing.push(Growing { name: "points", kind: Kind::F32, row: vec![each, 3, LANES as u64] });
    let states: Vec<Vec<Array>> = marks.iter().map(|mark| mark.arrays(&names)).collect();
    let renamed: Vec<Vec<String>> = states
        .iter()
        .enumerate()
        .map(|(mark, arrays)| arrays.iter().map(|array| prefix(mark) + array.name).collect())
        .collect();
    let fixed: Vec<Array> = states
        .into_iter()
        .flatten()
        .zip(renamed.iter().flatten())
        .map(|(array, name)| Array { name, ..array })
        .collect();
    let part = path.with_added_extension("part");
    // A part that a killed run left.
    let _ = std::fs::remove_file(&part);
    let written = rows_into(&part, meta, &fixed, &growing, (bodies, lists), frame, tell);
    if written.is_err() {
        let _ = std::fs::remove_file(&part);
    }
    written?;
    std::fs::rename(&part, path)
}

/// Writes the arrays to a file: those that are fixed, and the growing ones row by row.
fn rows_into<'a>(
    part: &Path,
    mut meta: Meta,
    fixed: &[Array],
    growing: &[Growing],
    (bodies, lists): (&[BodyFrame], Lists),
    frame: impl Fn(usize) -> Result<(f64, Cow<'a, [Vec3Lanes]>)>,
    tell: impl Fn(usize),
) -> Result<()> {
    let mut npz = GrowingNpz::create(part, fixed, growing, bodies.len().max(1) as u64, &[json(&meta)])?;
    let from = meta.frames.len() - bodies.len();
    for (row, body) in bodies.iter().enumerate() {
        let (time, points) = frame(row)?;
        let KeptBytes { rows, sum } = KeptBytes::of(time, body, &points, lists);
        meta.frames[from + row].sum = sum;
        if npz.wants_tail() {
            npz.set_tail(&[json(&meta)])?;
        }
        npz.append(&rows.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
        tell(row + 1);
    }
    npz.finish(&[json(&meta)])?;
    Ok(())
}

/// A frame as bytes, an array after the other, and their checksum.
struct KeptBytes {
    rows: Vec<Vec<u8>>,
    sum: u32,
}

impl KeptBytes {
    fn of(time: f64, body: &BodyFrame, points: &[Vec3Lanes], lists: Lists) -> Self {
        let bytes = |numbers: Vec<f32>| numbers.into_iter().flat_map(f32::to_le_bytes).collect::<Vec<u8>>();
        let head = bodies::numbers(&body.world_from_head()).to_vec();
        let mut rows = vec![time.to_le_bytes().to_vec(), bytes(head)];
        rows.extend(lists.present().map(|(list, ..)| bytes(lists.numbers(list, body))));
        rows.push(point_bytes(points));
        let mut sum = crc32fast::Hasher::new();
        rows.iter().for_each(|row| sum.update(row));
        Self { rows, sum: sum.finalize() }
    }
}

fn json(meta: &Meta) -> Array<'static> {
    let text = serde_json::to_vec(meta).expect("plain data");
    Array::of("meta", Kind::U8, &[text.len()], text)
}
