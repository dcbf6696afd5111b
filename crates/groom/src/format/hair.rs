//! `.hair`, Cem Yuksel's HAIR format: a header of 128 bytes, then arrays in the order of their bits.

use strandline_base::counted;

use super::bytes::{Source, put, put_u32, vec3};
use super::{Attribute, MAX_POINTS, MAX_STRANDS, Parsed, headerless};
use crate::{Groom, GroomError, Widths};

const HEADER: u64 = 128;
const SEGMENTS: u32 = 1;
const POINTS: u32 = 2;
const THICKNESS: u32 = 4;
const TRANSPARENCY: u32 = 8;
const COLORS: u32 = 16;
const KNOWN: u32 = 31;

struct Header {
    strands: u64,
    points: u64,
    arrays: u32,
    segments: u32,
    thickness: f32,
    transparency: f32,
    color: [f32; 3],
}

/// Colours of the header that writers without colours put there.
const NO_COLORS: [[f32; 3]; 2] = [[0.0; 3], [1.0; 3]];

/// Reads a `.hair` file; thickness is taken as the diameter. Of files without the format's first word, those that
/// reconstructions write are read where their size agrees: counts and points, or bare points with `per_strand`.
///
/// # Errors
/// [`GroomError::Malformed`] with the byte or the size that is wrong.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".hair" };
    if !bytes.starts_with(b"HAIR")
        && let Some(parsed) = with_counts(&source).or_else(|| headerless::read(bytes, ".hair", per_strand))
    {
        return Ok(parsed);
    }
    let header = header(&source)?;
    let mut problems = Vec::new();
    let mut offset = HEADER;
    let mut take = |bit: u32, count: u64, size: u64| {
        let here = offset;
        offset += if header.arrays & bit == 0 { 0 } else { count * size };
        here
    };
    let segments_at = take(SEGMENTS, header.strands, 2);
    let points_at = take(POINTS, header.points, 12);
    let thickness_at = take(THICKNESS, header.points, 4);
    let transparency_at = take(TRANSPARENCY, header.points, 4);
    let colors_at = take(COLORS, header.points, 12);
    if offset > bytes.len() as u64 {
        return Err(
            source.error(format!("{} bytes", bytes.len()), format!("{offset} bytes for the arrays it names"))
        );
    }
    if offset < bytes.len() as u64 {
        let more = counted(bytes.len() as u64 - offset, "byte", "bytes");
        problems.push(format!("{more} after the last array: ignored"));
    }
    let starts = starts(&source, &header, segments_at, &mut problems)?;
    let has = |bit: u32| header.arrays & bit != 0;
    let points = source.groups::<3, 3>("points", points_at, header.points)?;
    let widths = if has(THICKNESS) {
        Widths::PerPoint(source.f32s("thickness", thickness_at, header.points)?)
    } else {
        Widths::Constant(header.thickness)
    };
    let transparencies = if has(TRANSPARENCY) {
        Some(source.f32s("transparency", transparency_at, header.points)?)
    } else {
        (header.transparency != 0.0).then(|| vec![header.transparency; header.points as usize])
    };
    if !has(COLORS) && !NO_COLORS.contains(&header.color) {
        let [r, g, b] = header.color;
        problems
            .push(format!("the header's one colour for all strands, linear ({r}, {g}, {b}), is not taken"));
    }
    let colors =
        if has(COLORS) { Some(source.groups::<3, 3>("colors", colors_at, header.points)?) } else { None };
    let groom = Groom {
        starts,
        points: points.into_iter().map(vec3).collect(),
        widths,
        colors,
        transparencies,
        ..Groom::empty(0.0)
    };
    Ok(Parsed { format: ".hair", groom, problems })
}

/// Strands as HairStep, NeuralHDHair and MonoHair write them: the numbers of strands and of points (32 bits), the
/// points of each strand (16 bits), then coordinates. `None` where the size of the file does not agree.
fn with_counts(source: &Source) -> Option<Parsed> {
    let [strands, points] = [source.u32("strands", 0).ok()?, source.u32("points", 4).ok()?].map(u64::from);
    let length = strands.checked_mul(2)?.checked_add(points.checked_mul(12)?)?.checked_add(8)?;
    let is_within = (1..=MAX_STRANDS).contains(&strands) && (1..=MAX_POINTS).contains(&points);
    if !is_within || length != source.bytes.len() as u64 {
        return None;
    }
    let counts = source.slice("points of strands", 8, strands, 2).ok()?;
    let mut starts = vec![0_u32];
    let total = counts.chunks_exact(2).fold(0, |sum, count| {
        let end = sum + u64::from(u16::from_le_bytes([count[0], count[1]]));
        starts.push(end as u32);
        end
    });
    let places = source.groups::<3, 3>("points", 8 + 2 * strands, points).ok()?;
    let points_of_strands = places.into_iter().map(vec3).collect();
    let groom = Groom { starts, points: points_of_strands, ..Groom::empty(0.0) };
    (total == points).then_some(Parsed { format: ".hair without a header", groom, problems: Vec::new() })
}

fn header(source: &Source) -> Result<Header, GroomError> {
    let magic = &source.bytes[..source.bytes.len().min(4)];
    if magic != b"HAIR" {
        let found = format!("starts with `{}`", magic.escape_ascii());
        return Err(source.error(found, "`HAIR`"));
    }
    source.slice("header", 0, HEADER, 1)?;
    let header = Header {
        strands: u64::from(source.u32("hair count", 4)?),
        points: u64::from(source.u32("point count", 8)?),
        arrays: source.u32("arrays", 12)?,
        segments: source.u32("segments", 16)?,
        thickness: source.f32("thickness", 20)?,
        transparency: source.f32("transparency", 24)?,
        color: [source.f32("color", 28)?, source.f32("color", 32)?, source.f32("color", 36)?],
    };
    if header.arrays & !KNOWN != 0 {
        return Err(source.error(format!("array bits {:#x} at byte 12", header.arrays), "bits 0 to 4 only"));
    }
    if header.arrays & POINTS == 0 {
        return Err(source.error("no array of points (bit 1 at byte 12)", "points"));
    }
    if !(1..=MAX_STRANDS).contains(&header.strands) {
        return Err(
            source.error(format!("{} strands at byte 4", header.strands), format!("1 to {MAX_STRANDS}"))
        );
    }
    if !(1..=MAX_POINTS).contains(&header.points) {
        return Err(source.error(format!("{} points at byte 8", header.points), format!("1 to {MAX_POINTS}")));
    }
    Ok(header)
}

/// First point of each strand, then the number of points.
fn starts(
    source: &Source,
    header: &Header,
    at: u64,
    problems: &mut Vec<String>,
) -> Result<Vec<u32>, GroomError> {
    if header.arrays & SEGMENTS == 0 {
        let each = u64::from(header.segments) + 1;
        if header.segments == 0 || header.strands.checked_mul(each) != Some(header.points) {
            return Err(source.error(
                format!("{} points at byte 8", header.points),
                format!("{} strands x {each} points", header.strands),
            ));
        }
        return Ok((0..=header.strands).map(|strand| (strand * each) as u32).collect());
    }
    let counts = source.slice("segments", at, header.strands, 2)?.chunks_exact(2);
    let counts = counts.map(|bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])));
    let sum: u64 = counts.clone().map(|segments| u64::from(segments) + 1).sum();
    let empty = counts.clone().filter(|segments| *segments == 0).count() as u64;
    // A strand without segments has one point for some writers and no point for others.
    let lone = match header.points {
        points if points == sum => 1,
        points if points == sum - empty => 0,
        points => {
            return Err(source.error(
                format!("{points} points at byte 8"),
                format!("{sum}, the sum of segments + 1 over all strands"),
            ));
        }
    };
    let mut starts = Vec::with_capacity(header.strands as usize + 1);
    let mut sum = 0;
    starts.push(0);
    for segments in counts {
        sum += if segments == 0 { lone } else { segments + 1 };
        starts.push(sum);
    }
    if empty > 0 {
        problems.push(counted(empty, "strand has no segment", "strands have no segment"));
    }
    Ok(starts)
}

/// Writes a `.hair` file. Arrays that are constant become the header's defaults.
///
/// # Errors
/// A strand of more than 65,536 points.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let counts = || groom.starts.windows(2).map(|pair| pair[1] - pair[0]);
    if let Some(points) = counts().find(|points| !(1..=65_536).contains(points)) {
        return Err(GroomError::CannotHold {
            format: ".hair",
            found: format!("a strand of {points} points"),
            expected: "1 to 65536",
            mend: "resample it",
        });
    }
    let thickness = per_point_widths(groom);
    let transparencies = groom.transparencies.as_deref();
    let constant = transparencies.filter(|all| all.iter().all(|value| *value == all[0]));
    let varying = if constant.is_some() { None } else { transparencies };
    let bit = |on: bool, bit: u32| if on { bit } else { 0 };
    let arrays = SEGMENTS
        | POINTS
        | bit(thickness.is_err(), THICKNESS)
        | bit(varying.is_some(), TRANSPARENCY)
        | bit(groom.colors.is_some(), COLORS);
    let mut out = Vec::with_capacity(HEADER as usize + 34 * groom.points.len());
    out.extend_from_slice(b"HAIR");
    put_u32(&mut out, [groom.strand_count() as u32, groom.points.len() as u32, arrays, 0]);
    let default_transparency = constant.and_then(|all| all.first()).copied().unwrap_or(0.0);
    put(&mut out, [*thickness.as_ref().unwrap_or(&0.0), default_transparency, 1.0, 1.0, 1.0]);
    out.resize(HEADER as usize, 0);
    for points in counts() {
        out.extend_from_slice(&((points - 1) as u16).to_le_bytes());
    }
    put(&mut out, groom.points.iter().flat_map(|point| point.to_array()));
    put(&mut out, thickness.err().into_iter().flatten());
    put(&mut out, varying.into_iter().flatten().copied());
    put(&mut out, groom.colors.iter().flatten().flatten().copied());
    Ok(out)
}

/// The common diameter of all points, or a diameter for each.
fn per_point_widths(groom: &Groom) -> Result<f32, Vec<f32>> {
    match &groom.widths {
        // A default width, taken because a file had none, is no attribute.
        Widths::Constant(width) => Ok(if Attribute::Widths.is_in(groom) { *width } else { 0.0 }),
        Widths::PerPoint(widths) => Err(widths.clone()),
        Widths::PerStrand(widths) => {
            let counts = groom.starts.windows(2).map(|pair| (pair[1] - pair[0]) as usize);
            Err(widths
                .iter()
                .zip(counts)
                .flat_map(|(width, count)| std::iter::repeat_n(*width, count))
                .collect())
        }
    }
}
