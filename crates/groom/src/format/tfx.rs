//! `.tfx`, the format of TressFX: versions 2 (text) and 3 (read) and 4 (read and write).

use super::bytes::{Source, put, put_u32, vec2, vec3};
use super::fitted::Fitted;
use super::{Attribute, MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed, tfx_text};
use crate::{Groom, GroomError, Widths};

const HEADER_3: u64 = 296;
const HEADER_4: u64 = 160;
/// Diameter \[file units\] of a file without one.
const DEFAULT_WIDTH: f32 = 0.0;
/// Points of a strand that TressFX takes, and the fewest strands.
const COUNTS: [usize; 5] = [4, 8, 16, 32, 64];
const FEWEST_STRANDS: usize = 64;

/// Counts of a header and where its arrays begin; 0 is "not there".
struct Layout {
    header: u64,
    strands: u64,
    each: u64,
    positions: u64,
    position_size: u64,
    strand_uvs: u64,
    thickness: u64,
    colors: u64,
    point_uvs: u64,
    followed: u64,
}

/// Reads a `.tfx` file of version 2, 3 or 4; thickness is taken as the diameter.
///
/// # Errors
/// [`GroomError::Malformed`] with the byte or the size that is wrong.
pub fn read(bytes: &[u8]) -> Result<Parsed, GroomError> {
    if tfx_text::is_text(bytes) {
        return tfx_text::read(bytes);
    }
    let source = Source { bytes, format: ".tfx" };
    let version = source.f32("version", 0)?;
    let (format, layout) = match version {
        3.0..4.0 => (".tfx 3", layout_3(&source)?),
        4.0..5.0 => (".tfx 4", layout_4(&source)?),
        _ => {
            return Err(
                source.error(format!("version {version} at byte 0"), "3 or 4, or the text of version 2")
            );
        }
    };
    check(&source, &layout)?;
    let count = layout.strands * layout.each;
    let points: Vec<[f32; 3]> = if layout.position_size == 16 {
        source.groups::<4, 3>("positions", layout.positions, count)?
    } else {
        source.groups::<3, 3>("positions", layout.positions, count)?
    };
    let optional = |offset: u64| (offset != 0).then_some(offset);
    let root_uvs = optional(layout.strand_uvs)
        .map(|offset| source.groups::<2, 2>("strand uv", offset, layout.strands))
        .transpose()?;
    let widths = match optional(layout.thickness) {
        Some(offset) => Widths::PerStrand(source.f32s("thickness", offset, layout.strands)?),
        None => Widths::Constant(DEFAULT_WIDTH),
    };
    let rgba =
        optional(layout.colors).map(|offset| source.groups::<4, 4>("colors", offset, count)).transpose()?;
    let mut problems = Vec::new();
    if rgba.as_ref().is_some_and(|all| all.iter().any(|[.., alpha]| *alpha != 1.0)) {
        problems.push("transparency in the fourth part of colours is not read".to_owned());
    }
    if layout.point_uvs != 0 {
        problems.push("uv of points are not read, those of roots are".to_owned());
    }
    if layout.followed != 0 {
        problems.push("which guides the strands follow is not read".to_owned());
    }
    // Files without coordinates have zeros: AMD's runtime reads them in any case.
    let root_uvs = root_uvs.filter(|uvs| uvs.iter().any(|uv| *uv != [0.0; 2]));
    let groom = Groom {
        starts: (0..=layout.strands).map(|strand| (strand * layout.each) as u32).collect(),
        points: points.into_iter().map(vec3).collect(),
        widths,
        root_uvs: root_uvs.map(|uvs| uvs.into_iter().map(vec2).collect()),
        colors: rgba.map(|all| all.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()),
        ..Groom::empty(0.0)
    };
    Ok(Parsed { format, groom, problems })
}

fn layout_3(source: &Source) -> Result<Layout, GroomError> {
    source.slice("header", 0, HEADER_3, 1)?;
    let offset = |index: u64| source.u32("offset", 144 + 4 * index).map(u64::from);
    Ok(Layout {
        header: HEADER_3,
        strands: u64::from(source.u32("strand count", 4)?),
        each: u64::from(source.u32("points of a strand", 8)?),
        positions: offset(0)?,
        position_size: 12,
        thickness: offset(1)?,
        strand_uvs: offset(2)?,
        colors: offset(3)?,
        followed: offset(4)?,
        point_uvs: offset(5)?,
    })
}

fn layout_4(source: &Source) -> Result<Layout, GroomError> {
    source.slice("header", 0, HEADER_4, 1)?;
    let offset = |index: u64| source.u32("offset", 12 + 4 * index).map(u64::from);
    Ok(Layout {
        header: HEADER_4,
        strands: u64::from(source.u32("strand count", 4)?),
        each: u64::from(source.u32("points of a strand", 8)?),
        positions: offset(0)?,
        position_size: 16,
        strand_uvs: offset(1)?,
        thickness: offset(3)?,
        colors: offset(4)?,
        point_uvs: offset(2)?,
        followed: 0,
    })
}

fn check(source: &Source, layout: &Layout) -> Result<(), GroomError> {
    let range = |what: &str, found: u64, at: u64, least: u64, most: u64| {
        if (least..=most).contains(&found) {
            return Ok(());
        }
        Err(source.error(format!("{found} {what} at byte {at}"), format!("{least} to {most}")))
    };
    range("strands", layout.strands, 4, 1, MAX_STRANDS)?;
    range("points of a strand", layout.each, 8, 2, MAX_POINTS_PER_STRAND)?;
    range("points", layout.strands * layout.each, 4, 2, MAX_POINTS)?;
    if !layout.positions.is_multiple_of(4) || layout.positions < layout.header {
        let expected = format!("a multiple of 4 behind the header of {} bytes", layout.header);
        return Err(source.error(format!("positions at byte {}", layout.positions), expected));
    }
    for (what, at) in
        [("strand uv", layout.strand_uvs), ("thickness", layout.thickness), ("colors", layout.colors)]
    {
        if (1..layout.header).contains(&at) {
            let expected = format!("0 for none, or a place behind the header of {} bytes", layout.header);
            return Err(source.error(format!("{what} at byte {at}"), expected));
        }
    }
    Ok(())
}

/// Resamples a groom to a number of points that TressFX takes, where it has another one; notes on that.
///
/// # Errors
/// A groom that cannot be resampled.
pub(super) fn fitted(groom: &Groom) -> Result<Fitted, GroomError> {
    let mut notes = Vec::new();
    if groom.strand_count() < FEWEST_STRANDS {
        notes.push(format!(
            "TressFX takes {FEWEST_STRANDS} strands or more: the file has {}",
            groom.strand_count()
        ));
    }
    let counts = || groom.starts.windows(2).map(|pair| (pair[1] - pair[0]) as usize);
    let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
    if least == most && COUNTS.contains(&most) {
        return Ok(Fitted { groom: None, notes });
    }
    let count = COUNTS.into_iter().find(|count| *count >= most).unwrap_or(COUNTS[COUNTS.len() - 1]);
    let found = if least == most { most.to_string() } else { format!("{least} to {most}") };
    notes.push(format!(
        "TressFX takes 4, 8, 16, 32 or 64 points a strand: strands of {found} are resampled to {count}"
    ));
    Ok(Fitted { groom: Some(groom.resampled(count)?), notes })
}

/// Writes a `.tfx` file of version 4: the first two points of each strand are marked as fixed.
///
/// # Errors
/// Strands of different point counts, or of counts that the format cannot hold.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let each = each(groom, ".tfx")?;
    let strands = groom.strand_count();
    let (mut body, mut offsets) = (Vec::new(), [0_u32; 5]);
    let here = |body: &Vec<u8>| HEADER_4 as u32 + body.len() as u32;
    offsets[0] = here(&body);
    for (index, point) in groom.points.iter().enumerate() {
        let free = if index % (each as usize) < 2 { 0.0 } else { 1.0 };
        put(&mut body, [point.x, point.y, point.z, free]);
    }
    // AMD's runtime reads root coordinates even if a file has none.
    offsets[1] = here(&body);
    match &groom.root_uvs {
        Some(uvs) => put(&mut body, uvs.iter().flat_map(|uv| uv.to_array())),
        None => put(&mut body, std::iter::repeat_n(0.0, 2 * strands)),
    }
    // A default width, taken because a file had none, is no attribute.
    if Attribute::Widths.is_in(groom) {
        offsets[3] = here(&body);
        let starts = groom.starts.iter().take(strands);
        put(&mut body, starts.enumerate().map(|(strand, first)| groom.widths.at(strand, *first as usize)));
    }
    if let Some(colors) = &groom.colors {
        offsets[4] = here(&body);
        put(&mut body, colors.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]));
    }
    let mut out = Vec::with_capacity(HEADER_4 as usize + body.len());
    put(&mut out, [4.0]);
    put_u32(&mut out, [strands as u32, each]);
    put_u32(&mut out, offsets);
    out.resize(HEADER_4 as usize, 0);
    out.append(&mut body);
    Ok(out)
}

/// The number of points that every strand has.
pub(super) fn each(groom: &Groom, format: &'static str) -> Result<u32, GroomError> {
    let each = longest(groom, format)?;
    match groom.starts.windows(2).find(|pair| pair[1] - pair[0] != each) {
        None => Ok(each),
        Some(pair) => Err(GroomError::CannotHold {
            format,
            found: format!("strands of {} and of {each} points", pair[1] - pair[0]),
            expected: "the same number of points on every strand",
            mend: "resample it (`--points N`)",
        }),
    }
}

/// Most points of a strand.
pub(super) fn longest(groom: &Groom, format: &'static str) -> Result<u32, GroomError> {
    let counts = || groom.starts.windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
    if least >= 2 && most <= MAX_POINTS_PER_STRAND as u32 {
        return Ok(most);
    }
    Err(GroomError::CannotHold {
        format,
        found: format!("strands of {least} to {most} points"),
        expected: "2 to 4096 points",
        mend: "resample it (`--points N`)",
    })
}
