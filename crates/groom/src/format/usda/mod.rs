//! `.usda`: the curves of a text USD at one of its times, as strands in metres, y up.

mod curves;
mod text;
mod transform;

use glam::Mat4;
use strandline_base::{math, utf8_text};

use super::bytes::Source;
use super::{MAX_POINTS, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError, Widths};
use text::{Prim, Value};

/// Reads the `BasisCurves` of a file at its first time; each prim is a group, unless one alone has groups of its own.
///
/// # Errors
/// [`GroomError::Malformed`] with the byte that is wrong, or a file without curves.
pub fn read(bytes: &[u8]) -> Result<Parsed, GroomError> {
    read_at(bytes, None)
}

/// As [`read`], at a time code: values are the last up to it, or the first.
///
/// # Errors
/// As [`read`].
pub fn read_at(bytes: &[u8], frame: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".usda" };
    if bytes.starts_with(b"PXR-USDC") || bytes.starts_with(b"PK") {
        return Err(GroomError::Malformed {
            format: ".usda",
            found: "a binary USD".to_owned(),
            expected: "a text USD".to_owned(),
            mend: "the `strandline` of `pip install 'strandline[usd]'` reads it; or write it as text: `usdcat -o \
                   hair.usda FILE`, or export `.usda` from Blender or Houdini",
        });
    }
    let text = utf8_text(bytes);
    if !text.starts_with(b"#usda") {
        return Err(
            source.error(format!("starts with `{}`", bytes[..bytes.len().min(8)].escape_ascii()), "`#usda`")
        );
    }
    let stage = text::read(&text, is_asked, frame.map(f64::from))
        .map_err(|wrong| source.error(format!("something else at byte {}", wrong.at), wrong.expected))?;
    let mut reading = Reading {
        source,
        frame,
        strands: None,
        first_name: String::new(),
        next_group: 0,
        prims: 0,
        problems: Vec::new(),
    };
    reading.prim(&stage, transform::stage(&stage))?;
    let Reading { strands, mut problems, prims, .. } = reading;
    let groom =
        strands.ok_or_else(|| source.error("no BasisCurves", "curves; references are not followed"))?;
    if prims > 1 {
        problems.push(format!("{prims} prims of curves are read as groups"));
    }
    Ok(Parsed { format: ".usda", groom, problems })
}

/// Properties that curves and their places need.
fn is_asked(name: &str) -> bool {
    const NAMES: [&str; 8] =
        ["points", "curveVertexCounts", "widths", "type", "basis", "wrap", "visibility", "purpose"];
    NAMES.contains(&name) || name.starts_with("xformOp") || name.starts_with("primvars:")
}

struct Reading<'a> {
    source: Source<'a>,
    /// Time code at which values are read, or the first time.
    frame: Option<u32>,
    strands: Option<Groom>,
    /// The name of the first prim: of one alone it is no group's.
    first_name: String,
    /// Number of the next prim's group, once there is a second prim.
    next_group: u32,
    prims: u32,
    problems: Vec<String>,
}

impl Reading<'_> {
    /// Reads a prim and those below it.
    fn prim(&mut self, prim: &Prim, world_from_parent: Mat4) -> Result<(), GroomError> {
        let says =
            |name: &str, word: &str| prim.properties.get(name) == Some(&Value::Texts(vec![word.to_owned()]));
        if prim.is_hidden
            || says("visibility", "invisible")
            || says("purpose", "guide")
            || says("purpose", "proxy")
        {
            return Ok(());
        }
        let world_from_prim = world_from_parent * transform::local(prim, &mut self.problems);
        if prim.kind == "BasisCurves" {
            let mut groom = curves::groom(&self.source, prim, self.frame, &mut self.problems)?;
            for point in &mut groom.points {
                *point = world_from_prim.transform_point3(*point);
            }
            let scale = math::cbrt(glam::Mat3::from_mat4(world_from_prim).determinant().abs());
            if groom.widths != Widths::Constant(0.0) {
                groom.widths = Widths::PerPoint(groom.point_widths().map(|width| scale * width).collect());
            }
            self.append(groom, &prim.name)?;
        }
        prim.children.iter().try_for_each(|child| self.prim(child, world_from_prim))
    }

    /// Adds the curves of a prim.
    fn append(&mut self, mut groom: Groom, name: &str) -> Result<(), GroomError> {
        self.prims += 1;
        let Some(strands) = &mut self.strands else {
            name.clone_into(&mut self.first_name);
            self.strands = Some(groom);
            return Ok(());
        };
        if strands.groups.is_none() {
            strands.groups = Some(vec![0; strands.strand_count()]);
            strands.group_names = [(0, self.first_name.clone())].into();
        }
        if self.next_group == 0 {
            self.next_group = strands.groups.iter().flatten().max().map_or(0, |last| last.saturating_add(1));
        }
        let next = self.next_group;
        self.next_group = next.saturating_add(1);
        groom.groups = Some(vec![next; groom.strand_count()]);
        groom.group_names = [(next, name.to_owned())].into();
        let count = (strands.strand_count() + groom.strand_count()) as u64;
        let points = (strands.points.len() + groom.points.len()) as u64;
        if count > MAX_STRANDS || points > MAX_POINTS {
            let found = format!("{count} curves of {points} points in all");
            return Err(self.source.error(found, format!("{MAX_STRANDS} of {MAX_POINTS} points at most")));
        }
        strands.append(groom);
        Ok(())
    }
}
