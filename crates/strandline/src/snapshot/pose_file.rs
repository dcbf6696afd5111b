//! The file with a pose of hair: a snapshot by itself, the arrays of a state as in a moving cache.

use std::io::{Read, Seek};

use glam::Vec3;
use serde::{Deserialize, Serialize};
use strandline_base::{
    LANES, block_count,
    npz::{Array, Kind, Npz, pack},
};

use super::{
    LAYOUT, MAX_FRAMES, Snapshot,
    arrays::{check_memory, expect, missing, starts, text},
    check_layout,
    hair_pose::{HairPose, MOST_PIECES, REMEDY, check, vectors},
    names, read,
};
use crate::{
    scene::MAX_FILE_BYTES,
    sim::{Checkpoint, StateArray},
    strands::bodies::{self, Lists},
};

/// The object in the array `meta`, of which a moving cache has more.
#[derive(Serialize, Deserialize)]
#[serde(default)]
struct Meta {
    layout: u32,
    written_by: String,
    units: String,
    up_axis: String,
    /// Guides, and points of each; a moving cache tells them by `starts`.
    guides: Option<[usize; 2]>,
}

impl Default for Meta {
    fn default() -> Self {
        Self {
            layout: 0,
            written_by: String::new(),
            units: "m".to_owned(),
            up_axis: "y".to_owned(),
            guides: None,
        }
    }
}

/// A pose as the bytes of a file.
///
/// # Errors
/// Hair or a body that no file may hold.
pub(super) fn to_bytes(pose: &HairPose) -> Result<Vec<u8>, String> {
    let HairPose { shape, positions, velocities, corrections, sections, spins, body } = pose;
    let lists = Lists::of([body]);
    if lists.0[0] > MOST_PIECES {
        return Err(format!("{} pieces of the body, expected {MOST_PIECES} at most", lists.0[0]));
    }
    let numbers = std::array::from_fn(|list| lists.numbers(list, body));
    bodies::pose(&bodies::numbers(&body.world_from_head()))?;
    bodies::body(body.world_from_head(), &numbers)?;
    let mut parts = Vec::new();
    for (name, vectors) in [
        ("positions", positions),
        ("previous_positions", positions),
        ("velocities", velocities),
        ("corrections", corrections),
        ("sections", sections),
    ] {
        if !vectors.is_empty() {
            parts.push(part(name, *shape, 3, |index, axis| vectors[index][axis])?);
        }
    }
    if !spins.is_empty() {
        parts.push(part("spins", *shape, 1, |index, _| spins[index])?);
    }
    let state = Checkpoint { parts, body: body.clone(), time: 0.0 };
    let bodies = [body.clone(), body.clone(), body.clone()];
    let snapshot = Snapshot { frame: 0, time: 0.0, state, bodies, origin: Vec3::ZERO };
    let names: Vec<_> = names().collect();
    let mut arrays = snapshot.arrays(&names);
    let written_by = format!("strandline {}", env!("CARGO_PKG_VERSION"));
    let meta = Meta { layout: LAYOUT, written_by, guides: Some(*shape), ..Meta::default() };
    let meta = serde_json::to_vec(&meta).expect("plain data");
    arrays.push(Array::of("meta", Kind::U8, &[meta.len()], meta));
    Ok(pack(&arrays))
}

/// An array of a state, from the numbers of a point and a column; lanes beyond the last strand repeat it.
fn part(
    name: &'static str,
    [strands, points]: [usize; 2],
    columns: usize,
    number: impl Fn(usize, usize) -> f32,
) -> Result<StateArray, String> {
    let mut numbers = Vec::with_capacity(block_count(strands) * points * columns * LANES);
    for block in 0..block_count(strands) {
        for point in 0..points {
            for column in 0..columns {
                let strand = |lane: usize| (block * LANES + lane).min(strands - 1);
                numbers.extend((0..LANES).map(|lane| number(strand(lane) * points + point, column)));
            }
        }
    }
    check(name, &numbers)?;
    Ok(StateArray { name, shape: shape_of([strands, points], columns), numbers })
}

/// Shape of an array of a state.
fn shape_of([strands, points]: [usize; 2], columns: usize) -> Vec<usize> {
    let blocks = block_count(strands);
    if columns == 1 { vec![blocks, points, LANES] } else { vec![blocks, points, columns, LANES] }
}

/// Reads a pose for guides of this shape, on a mesh of `vertices` if their number is known.
///
/// # Errors
/// Content of another kind, or of other hair or another mesh.
pub(super) fn read<R: Read + Seek>(
    source: R,
    shape: [usize; 2],
    vertices: Option<usize>,
) -> Result<HairPose, String> {
    let mut npz = Npz::new(source).map_err(text)?;
    check_hair(&mut npz, shape)?;
    let [strands, points] = shape;
    let snapshot = read::read(&mut npz, "", (block_count(strands) * LANES * points) as u64)?;
    let Some(Snapshot { state: Checkpoint { parts, body, .. }, origin, .. }) = snapshot else {
        return Err(missing(&npz, "state_clock"));
    };
    body.check(Some(strands), vertices).map_err(|error| error.to_string())?;
    let numbers = |name, columns| numbers(&parts, name, shape, columns);
    let all = |name| numbers(name, 3)?.ok_or_else(|| format!("no array state_{name}: {REMEDY}"));
    let sections = numbers("sections", 3)?.unwrap_or_default();
    let spins = numbers("spins", 1)?.unwrap_or_default();
    if sections.is_empty() != spins.is_empty() {
        return Err("one of state_sections and state_spins, expected both or none".to_owned());
    }
    let pose = HairPose {
        shape,
        positions: vectors(&all("positions")?),
        velocities: vectors(&all("velocities")?),
        corrections: vectors(&all("corrections")?),
        sections: vectors(&sections),
        spins,
        body,
    };
    Ok(pose.moved(origin))
}

/// Most bytes of `meta`: that of a moving cache has a scene, spelled as JSON, and some measures of each frame.
const MOST_META: u64 = 2 * MAX_FILE_BYTES + 160 * MAX_FRAMES;

/// Refuses a file of another layout, or of other guides than those of a shape.
fn check_hair<R: Read + Seek>(npz: &mut Npz<R>, shape: [usize; 2]) -> Result<(), String> {
    let Some(mut rows) = npz.open("meta").map_err(text)? else { return Err(missing(npz, "meta")) };
    expect(&rows, "meta", Kind::U8, &[Some(rows.bytes())])?;
    if rows.bytes() > MOST_META {
        return Err(format!("meta of {} bytes, expected {MOST_META} at most", rows.bytes()));
    }
    check_memory("meta", rows.bytes(), 2)?;
    let bytes = npz.all(&mut rows).map_err(text)?;
    let meta: Meta = serde_json::from_slice(&bytes).map_err(|error| format!("meta: {error}"))?;
    check_layout(meta.layout, &meta.units, &meta.up_axis)?;
    let [strands, points] = shape;
    let refuse = |found: String| {
        Err(format!("{found}, but the scene's hair has {strands} strands of {points} points: {REMEDY}"))
    };
    match meta.guides {
        Some(guides) if guides == shape => Ok(()),
        Some([strands, points]) => refuse(format!("{strands} strands of {points} points")),
        None => {
            let starts = starts(npz)?;
            let mut all = starts.iter().enumerate();
            match starts.len() == strands + 1 && all.all(|(strand, start)| *start as usize == strand * points)
            {
                true => Ok(()),
                false => refuse(format!("{} strands of other points", starts.len() - 1)),
            }
        }
    }
}

/// The numbers of an array of a state, strand after strand; `None` where there is no such array.
fn numbers(
    parts: &[StateArray],
    name: &str,
    [strands, points]: [usize; 2],
    columns: usize,
) -> Result<Option<Vec<f32>>, String> {
    let Some(part) = parts.iter().find(|part| part.name == name) else { return Ok(None) };
    let shape = shape_of([strands, points], columns);
    if part.shape != shape {
        let found = &part.shape;
        return Err(format!("state_{name} of shape {found:?}, expected {shape:?}: {REMEDY}"));
    }
    check(name, &part.numbers)?;
    let places = (0..strands).flat_map(|strand| (0..points).map(move |point| (strand, point)));
    let number = |strand: usize, point: usize, column: usize| {
        let row = (strand / LANES * points + point) * columns + column;
        part.numbers[row * LANES + strand % LANES]
    };
    let number = &number;
    let rows =
        places.flat_map(|(strand, point)| (0..columns).map(move |column| number(strand, point, column)));
    Ok(Some(rows.collect()))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use glam::Quat;
    use strandline_base::npz::f32s;

    use super::super::hair_pose::tests::{SHAPE, pose};
    use super::*;
    use crate::{
        body::{BodyFrame, Pose},
        sim::MOST_SPIN,
    };

    fn read_again(pose: &HairPose, vertices: Option<usize>) -> Result<HairPose, String> {
        read(Cursor::new(to_bytes(pose)?), SHAPE, vertices)
    }

    #[test]
    fn it_survives_its_file() {
        assert_eq!(read_again(&pose(), None).unwrap(), pose());
        let count = SHAPE[0] * SHAPE[1];
        let sections = (0..count).map(|index| Vec3::X * index as f32).collect();
        // Any state that the simulation can reach can be saved.
        let rods = HairPose { sections, spins: vec![MOST_SPIN; count], ..pose() };
        assert_eq!(read_again(&rods, None).unwrap(), rods);
    }

    #[test]
    fn a_body_of_several_pieces_survives_the_file() {
        let at = |x: f32| Pose { rotation: Quat::from_rotation_x(x), translation: Vec3::X * x };
        let body = pose().body.with_pieces([at(0.2), at(-0.4)]).with_roots([at(0.1); SHAPE[0]]);
        let body = body.with_skin([Vec3::Y, Vec3::Z, Vec3::X, Vec3::ONE]);
        let moved = HairPose { body, ..pose() };
        assert_eq!(read_again(&moved, Some(4)).unwrap(), moved);
        let refused = read_again(&moved, Some(5)).unwrap_err();
        assert!(refused.contains("skin vertices is 4, for a mesh of 5"), "{refused}");
        let few = HairPose { body: BodyFrame::REST.with_roots([at(0.1)]), ..pose() };
        let refused = read_again(&few, None).unwrap_err();
        assert!(refused.contains("root frames is 1, for 11 strands"), "{refused}");
        let many = HairPose { body: BodyFrame::REST.with_pieces(vec![at(0.0); MOST_PIECES + 1]), ..pose() };
        assert!(to_bytes(&many).unwrap_err().contains("1025 pieces of the body"));
    }

    #[test]
    fn hair_that_no_file_may_hold_is_refused() {
        let count = SHAPE[0] * SHAPE[1];
        let spins = vec![2.0 * MOST_SPIN; count];
        let spun = HairPose { sections: vec![Vec3::X; count], spins, ..pose() };
        assert!(to_bytes(&spun).unwrap_err().contains("spins hold 2000000"));
        let fast = HairPose { velocities: vec![Vec3::splat(1e9); count], ..pose() };
        assert!(to_bytes(&fast).unwrap_err().contains("velocities hold 1000000000"));
        let rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.5);
        let squeezed = HairPose { body: Pose { rotation, ..Pose::IDENTITY }.into(), ..pose() };
        assert!(to_bytes(&squeezed).unwrap_err().contains("expected one of length 1"));
    }

    /// The file of a pose with the bytes of its first array of a name changed.
    fn with(name: &str, change: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
        let mut npz = Npz::new(Cursor::new(to_bytes(&pose()).unwrap())).unwrap();
        let names: Vec<String> = npz.names().map(|name| name.trim_end_matches(".npy").to_owned()).collect();
        let arrays = names.iter().map(|own| {
            let mut rows = npz.open(own).unwrap().unwrap();
            let mut bytes = npz.all(&mut rows).unwrap();
            let mut shape = rows.shape().to_vec();
            if own == name {
                change(&mut bytes);
                if rows.kind() == Kind::U8 {
                    shape = vec![bytes.len() as u64];
                }
            }
            Array { name: own, kind: rows.kind(), shape, bytes: bytes.into() }
        });
        let arrays: Vec<Array> = arrays.collect();
        pack(&arrays)
    }

    #[test]
    fn a_file_of_another_version_of_other_hair_or_with_wild_numbers_is_refused() {
        let refused = |bytes: Vec<u8>| read(Cursor::new(bytes), SHAPE, None).unwrap_err();
        let meta = |text: &'static str| with("meta", |bytes| *bytes = text.into());
        assert!(refused(meta(r#"{"layout": 3, "guides": [11, 5]}"#)).contains("layout 3, expected 1 to 2"));
        assert!(refused(meta(r#"{"guides": [11, 5]}"#)).contains("layout 0"));
        let other = refused(meta(r#"{"layout": 2, "guides": [9, 5]}"#));
        assert!(other.contains("9 strands of 5 points, but the scene's hair has 11"), "{other}");
        // As many blocks, but nothing that tells the strands.
        assert!(refused(meta(r#"{"layout": 2}"#)).contains("expected starts"));
        let lied = with("meta", |bytes| *bytes = r#"{"layout": 2, "guides": [11, 6]}"#.into());
        let lied = read(Cursor::new(lied), [11, 6], None).unwrap_err();
        assert!(lied.contains("state_positions of shape [2, 5, 3, 8], expected [2, 6, 3, 8]"), "{lied}");
        let wild = with("state_velocities", |bytes| bytes[..4].copy_from_slice(&f32::NAN.to_le_bytes()));
        assert!(refused(wild).contains("velocities hold NaN"));
        let turned = with("state_poses", |bytes| {
            let numbers: Vec<f32> = f32s(bytes).map(|number| 2.0 * number).collect();
            *bytes = numbers.into_iter().flat_map(f32::to_le_bytes).collect();
        });
        assert!(refused(turned).contains("expected one of length 1"));
        // Cut anywhere it is refused, and with any byte of a head changed refused or read: nothing panics.
        let good = to_bytes(&pose()).unwrap();
        for cut in (0..good.len()).step_by(7) {
            refused(good[..cut].to_vec());
        }
        for at in 0..300 {
            for flip in [1, 0x80, 0xff] {
                let mut bad = good.clone();
                bad[at] ^= flip;
                let _ = read(Cursor::new(bad), SHAPE, None);
            }
        }
    }
}
