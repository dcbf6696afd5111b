//! `.ply`: vertices with `strand` and `edge` elements, as hairutil has them, or bare ones. Other
//! attributes of a groom are further properties, which other readers skip.

mod writer;

use glam::{Vec2, Vec3};
use strandline_base::counted;
use strandline_base::ply::{self, Table};

use super::bytes::Source;
use super::joining::Lines;
use super::npy::{even, split};
use super::project::linear;
use super::rows;
use super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError, Influences, Widths};

pub use writer::write;

/// Properties of vertices and of strands that are read.
const OF_VERTICES: [&str; 13] =
    ["x", "y", "z", "red", "green", "blue", "transparency", "width", "radius", "mass", "vx", "vy", "vz"];
const OF_STRANDS: [&str; 11] =
    ["nsegs", "width", "s", "t", "nx", "ny", "nz", "group", "guide", "guides", "weights"];
const OF_EDGES: [&str; 2] = ["vertex1", "vertex2"];

/// Reads a `.ply` file, binary or of text. Vertices without `strand` and `edge` elements need the points of each
/// strand.
///
/// # Errors
/// [`GroomError::Malformed`] with the error.
pub fn read(bytes: &[u8], per_strand: Option<u32>) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".ply" };
    let asked: [(&str, &[&str]); 5] = [
        ("vertex", &OF_VERTICES),
        ("strand", &OF_STRANDS),
        ("edge", &OF_EDGES),
        ("face", &[]),
        ("tristrips", &[]),
    ];
    let file = ply::read(bytes, asked).map_err(|mismatch| source.error(mismatch.found, mismatch.expected))?;
    let [vertices, strands, edges, faces, strips] = &file.tables;
    let count = vertices.rows as u64;
    if !(1..=MAX_POINTS).contains(&count) {
        return Err(source.error(format!("{count} vertices"), format!("1 to {MAX_POINTS}")));
    }
    let places = vertices.triples(["x", "y", "z"]);
    let places = places.ok_or_else(|| source.error("vertices without coordinates", "x, y and z"))?;
    let places: Vec<Vec3> = places.into_iter().map(Vec3::from_array).collect();
    let mut problems = Vec::new();
    let (starts, order) = match (strands.numbers("nsegs"), per_strand) {
        (Some(segments), _) => chains(&source, segments, edges, count)?,
        (None, Some(each)) => {
            let (strands, each) = split(&source, count, each)?;
            (even(&source, strands, each, |_| Vec::new())?.starts, None)
        }
        (None, None) if edges.rows > 0 => {
            let (chains, notes) = joined(&source, edges, count)?;
            problems = notes;
            chains
        }
        (None, None) if faces.rows + strips.rows > 0 => {
            let found = match strips.rows {
                0 => counted(faces.rows, "face", "faces"),
                count => counted(count, "strip of triangles", "strips of triangles"),
            };
            let found = format!("a mesh of {found}");
            return Err(source.error(found, "strands; a mesh is a body (`--body`)"));
        }
        (None, None) => {
            let expected = format!("`strand` and `edge` elements, or {}", rows::asked(&places));
            return Err(source.error(format!("{count} vertices and nothing that joins them"), expected));
        }
    };
    let mut groom = Groom { starts, points: places, ..Groom::empty(0.0) };
    of_vertices(&mut groom, vertices, order.as_deref());
    if strands.rows == groom.strand_count() {
        of_strands(&mut groom, strands)?;
    }
    groom.group_names = file.comments.iter().filter_map(|comment| group_name(comment)).collect();
    Ok(Parsed { format: ".ply", groom, problems })
}

/// The number and name of a group in a comment `group NUMBER NAME`.
fn group_name(comment: &str) -> Option<(u32, String)> {
    let (number, name) = comment.strip_prefix("group ")?.split_once(' ')?;
    Some((number.parse().ok()?, name.to_owned()))
}

/// First point of each strand, and the vertex of each point unless they are in order.
type Chains = (Vec<u32>, Option<Vec<u32>>);

/// Strands of a number of segments each, along edges if there are any.
fn chains(source: &Source, segments: &[f64], edges: &Table, vertices: u64) -> Result<Chains, GroomError> {
    let strands = segments.len() as u64;
    if !(1..=MAX_STRANDS).contains(&strands) {
        return Err(source.error(format!("{strands} strands"), format!("1 to {MAX_STRANDS}")));
    }
    let most = MAX_POINTS_PER_STRAND - 1;
    if let Some(found) = segments.iter().find(|found| !(0.0..=most as f64).contains(*found)) {
        return Err(source.error(format!("a strand of {found} segments"), format!("0 to {most}")));
    }
    let mut starts = vec![0];
    let total = segments.iter().fold(0, |sum, segments| {
        let end = sum + *segments as u64 + 1;
        starts.push(end as u32);
        end
    });
    let (Some(first), Some(second)) = (edges.numbers("vertex1"), edges.numbers("vertex2")) else {
        if total != vertices {
            let found = format!("strands of {total} points in all");
            return Err(source.error(found, format!("as many as vertices, {vertices}")));
        }
        return Ok((starts, None));
    };
    if first.len() as u64 != total - strands {
        let found = format!("{} edges for strands of {} segments", first.len(), total - strands);
        return Err(source.error(found, "as many edges as segments"));
    }
    // A strand without a segment has no edge that names its vertex: such strands are bad ones in any case.
    let (mut order, mut edge) = (Vec::with_capacity(first.len() + segments.len()), 0);
    for segments in segments {
        let count = *segments as usize;
        let own = first[edge..edge + count].iter().zip(&second[edge..edge + count]);
        order.push(if count == 0 { 0.0 } else { first[edge] });
        for (one, two) in own {
            if order.last() != Some(one) {
                return Err(
                    source.error(format!("edge {edge} begins at vertex {one}"), "where the one before ends")
                );
            }
            order.push(*two);
            edge += 1;
        }
    }
    Ok((starts, Some(indices(source, &order, vertices)?)))
}

/// Strands along edges that share vertices, and notes on how edges became them.
fn joined(source: &Source, edges: &Table, vertices: u64) -> Result<(Chains, Vec<String>), GroomError> {
    let both = edges.numbers("vertex1").zip(edges.numbers("vertex2"));
    let (first, second) = both.ok_or_else(|| source.error("edges without ends", "vertex1 and vertex2"))?;
    let ends: Vec<f64> = first.iter().zip(second).flat_map(|(one, two)| [*one, *two]).collect();
    if ends.len() as u64 > 2 * MAX_POINTS {
        return Err(source.error(format!("{} edges", ends.len() / 2), format!("{MAX_POINTS} at most")));
    }
    let points = indices(source, &ends, vertices)?;
    let starts = (0..=points.len() as u32).step_by(2).collect();
    let joined = Lines { starts, points }.joined(vertices as usize);
    let Lines { starts, points } = &joined.lines;
    let longest = starts.windows(2).map(|pair| u64::from(pair[1] - pair[0])).max().unwrap_or(0);
    if longest > MAX_POINTS_PER_STRAND
        || starts.len() as u64 > MAX_STRANDS
        || points.len() as u64 > MAX_POINTS
    {
        let expected = format!("{MAX_STRANDS} strands of {MAX_POINTS_PER_STRAND} points at most");
        return Err(source.error(format!("{} strands of up to {longest} points", starts.len() - 1), expected));
    }
    // Edges are how the format has strands: joining them is no problem to tell.
    let problems = joined.problems(joined.firsts.len());
    Ok(((joined.lines.starts, Some(joined.lines.points)), problems))
}

fn indices(source: &Source, order: &[f64], vertices: u64) -> Result<Vec<u32>, GroomError> {
    match order.iter().find(|vertex| !(0.0..vertices as f64).contains(*vertex)) {
        Some(found) => {
            Err(source.error(format!("vertex {found} in an edge"), format!("0 to {}", vertices - 1)))
        }
        None => Ok(order.iter().map(|vertex| *vertex as u32).collect()),
    }
}

/// Gives points the attributes of their vertices; `order` names the vertex of each point.
fn of_vertices(groom: &mut Groom, vertices: &Table, order: Option<&[u32]>) {
    fn placed<T: Copy>(values: Vec<T>, order: Option<&[u32]>) -> Vec<T> {
        match order {
            Some(order) => order.iter().map(|vertex| values[*vertex as usize]).collect(),
            None => values,
        }
    }
    let one = |name| vertices.floats(name).map(|all| placed(all, order));
    groom.points = placed(std::mem::take(&mut groom.points), order);
    let colors = vertices.triples(["red", "green", "blue"]).map(|all| placed(all, order));
    // Whole numbers of a byte are those of a picture, as scanners and mesh tools write them.
    let part = if vertices.is_byte("red") { |byte: f32| linear(byte / 255.0) } else { |part: f32| part };
    groom.colors = colors.map(|all| all.into_iter().map(|color| color.map(part)).collect());
    let doubled = || Some(one("radius")?.into_iter().map(|radius| 2.0 * radius).collect());
    if let Some(widths) = one("width").or_else(doubled) {
        groom.widths = Widths::PerPoint(widths);
    }
    groom.transparencies = one("transparency");
    groom.masses = one("mass");
    let velocities = vertices.triples(["vx", "vy", "vz"]).map(|all| placed(all, order));
    groom.velocities = velocities.map(|all| all.into_iter().map(Vec3::from_array).collect());
}

fn of_strands(groom: &mut Groom, strands: &Table) -> Result<(), GroomError> {
    if let Some(widths) = strands.floats("width") {
        groom.widths = Widths::PerStrand(widths);
    }
    let uvs = strands.floats("s").zip(strands.floats("t"));
    groom.root_uvs = uvs.map(|(s, t)| s.into_iter().zip(t).map(|(s, t)| Vec2::new(s, t)).collect());
    let normals = strands.triples(["nx", "ny", "nz"]);
    groom.root_normals = normals.map(|all| all.into_iter().map(Vec3::from_array).collect());
    let whole = |name| Some(strands.numbers(name)?.iter().map(|number| *number as u32).collect::<Vec<u32>>());
    groom.groups = whole("group");
    groom.guide_flags = whole("guide").map(|all| all.into_iter().map(|flag| flag != 0).collect());
    if let Some((guides, weights)) = strands.list("guides").zip(strands.list("weights"))
        && let Some(each) = guides.even().filter(|each| *each > 0)
    {
        let guides = guides.values.iter().map(|guide| *guide as u32).collect();
        let weights = weights.values.iter().map(|weight| *weight as f32).collect();
        groom.influences = Some(Influences::new(each, guides, weights, strands.rows)?);
    }
    Ok(())
}
