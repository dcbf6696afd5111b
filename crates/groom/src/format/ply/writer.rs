//! Writes `.ply` files.

use std::fmt::Write;

use super::super::Attribute;
use super::super::bytes::{put, put_u32};
use super::super::tfx::longest;
use crate::{Groom, GroomError, Widths};

/// A line of a header where it is wanted.
fn line(out: &mut String, is_wanted: bool, lines: &[&str]) {
    if is_wanted {
        lines.iter().for_each(|line| {
            out.push_str("property ");
            out.push_str(line);
            out.push('\n');
        });
    }
}

/// Writes a binary `.ply` file: vertices, strands with their number of segments, and edges.
///
/// # Errors
/// A strand without a point or of more than 4,096; names of groups of more than one line.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    longest(groom, ".ply")?;
    if let Some(name) =
        groom.group_names.values().find(|name| name.contains(['\n', '\r']) || name.len() > 4096)
    {
        return Err(GroomError::CannotHold {
            format: ".ply",
            found: format!("a group of the name {:?}", name.chars().take(60).collect::<String>()),
            expected: "names of one line of 4096 bytes at most",
            mend: "write a .npz file",
        });
    }
    let mut out = header(groom).into_bytes();
    vertices(groom, &mut out);
    strands(groom, &mut out);
    for strand in 0..groom.strand_count() {
        let range = groom.range(strand);
        for point in range.start + 1..range.end {
            put_u32(&mut out, [point as u32 - 1, point as u32]);
        }
    }
    Ok(out)
}

fn header(groom: &Groom) -> String {
    let (strands, points) = (groom.strand_count(), groom.points.len());
    let mut out =
        String::from("ply\nformat binary_little_endian 1.0\ncomment strands, root first, in metres, y up\n");
    for (number, name) in &groom.group_names {
        let _ = writeln!(out, "comment group {number} {name}");
    }
    let _ = writeln!(out, "element vertex {points}");
    line(&mut out, true, &["float x", "float y", "float z"]);
    line(&mut out, groom.colors.is_some(), &["float red", "float green", "float blue"]);
    line(&mut out, groom.transparencies.is_some(), &["float transparency"]);
    line(&mut out, matches!(groom.widths, Widths::PerPoint(_)), &["float width"]);
    line(&mut out, groom.masses.is_some(), &["float mass"]);
    line(&mut out, groom.velocities.is_some(), &["float vx", "float vy", "float vz"]);
    let _ = writeln!(out, "element strand {strands}");
    line(&mut out, true, &["ushort nsegs"]);
    line(&mut out, of_strands(groom), &["float width"]);
    line(&mut out, groom.root_uvs.is_some(), &["float s", "float t"]);
    line(&mut out, groom.root_normals.is_some(), &["float nx", "float ny", "float nz"]);
    line(&mut out, groom.groups.is_some(), &["uint group"]);
    line(&mut out, groom.guide_flags.is_some(), &["uchar guide"]);
    line(&mut out, groom.influences.is_some(), &["list uchar uint guides", "list uchar float weights"]);
    let _ = writeln!(out, "element edge {}", points - strands);
    line(&mut out, true, &["uint vertex1", "uint vertex2"]);
    out.push_str("end_header\n");
    out
}

/// True if strands have a width each; a default width, taken because a file had none, is not written.
fn of_strands(groom: &Groom) -> bool {
    Attribute::Widths.is_in(groom) && !matches!(groom.widths, Widths::PerPoint(_))
}

fn vertices(groom: &Groom, out: &mut Vec<u8>) {
    for (index, point) in groom.points.iter().enumerate() {
        put(out, point.to_array());
        put(out, groom.colors.iter().flat_map(|all| all[index]));
        put(out, groom.transparencies.iter().map(|all| all[index]));
        if let Widths::PerPoint(widths) = &groom.widths {
            put(out, [widths[index]]);
        }
        put(out, groom.masses.iter().map(|all| all[index]));
        put(out, groom.velocities.iter().flat_map(|all| all[index].to_array()));
    }
}

fn strands(groom: &Groom, out: &mut Vec<u8>) {
    for (strand, width) in groom.root_widths().enumerate() {
        out.extend((groom.range(strand).len() as u16 - 1).to_le_bytes());
        if of_strands(groom) {
            put(out, [width]);
        }
        put(out, groom.root_uvs.iter().flat_map(|all| all[strand].to_array()));
        put(out, groom.root_normals.iter().flat_map(|all| all[strand].to_array()));
        put_u32(out, groom.groups.iter().map(|all| all[strand]));
        out.extend(groom.guide_flags.iter().map(|all| u8::from(all[strand])));
        if let Some(influences) = &groom.influences {
            let each = influences.per_strand() as u8;
            out.push(each);
            put_u32(out, influences.of(strand).map(|(guide, _)| guide as u32));
            out.push(each);
            put(out, influences.of(strand).map(|(_, weight)| weight));
        }
    }
}
