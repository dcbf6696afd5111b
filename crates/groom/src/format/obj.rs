//! `.obj`, strands as lines: `v` and `l`, with `g` for groups and colours behind the coordinates of vertices.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use glam::Vec3;
use strandline_base::{counted, whole_lines};

use super::bytes::Source;
use super::joining::Lines;
use super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError};

/// Longest name of a group \[byte\].
const MAX_NAME: usize = 4096;

/// The statements of a file up to a line.
#[derive(Default)]
struct Reading {
    vertices: Vec<Vec3>,
    /// Colours of the coloured vertices, and the number of the others.
    colors: Vec<[f32; 3]>,
    /// Numbers of groups by their names, and that of the strands to come.
    numbers: BTreeMap<String, u32>,
    group: Option<u32>,
    /// A number above those of all groups.
    next_group: u32,
    lines: Lines,
    /// Group of each line.
    groups: Vec<u32>,
    skipped: usize,
}

/// Reads the lines of an `.obj` file as strands, root first; lines that share their ends are joined. Other elements
/// are counted and skipped.
///
/// # Errors
/// [`GroomError::Malformed`] with the line that is wrong.
pub fn read(bytes: &[u8]) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".obj" };
    let mut reading = Reading::default();
    reading.lines.starts.push(0);
    for (number, line) in whole_lines(bytes).split(|byte| *byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let wrong =
            |expected: &str| source.error(format!("`{}` in line {}", cut(&line), number + 1), expected);
        reading.line(&line).map_err(|expected| wrong(&expected))?;
    }
    if reading.lines.starts.len() == 1 {
        return Err(source.error("no line (`l`)", "strands as lines; a mesh is a body (`--body`)"));
    }
    let skipped = reading.skipped;
    let (groom, mut problems) = reading.groom();
    if skipped > 0 {
        problems.push(counted(
            skipped,
            "face or other element is not read",
            "faces or other elements are not read",
        ));
    }
    let longest = groom.starts.windows(2).map(|pair| u64::from(pair[1] - pair[0])).max().unwrap_or(0);
    if longest > MAX_POINTS_PER_STRAND || groom.strand_count() as u64 > MAX_STRANDS {
        let found = format!("{} joined strands of up to {longest} points", groom.strand_count());
        let expected = format!("{MAX_STRANDS} strands of {MAX_POINTS_PER_STRAND} points at most");
        return Err(source.error(found, expected));
    }
    Ok(Parsed { format: ".obj", groom, problems })
}

fn cut(line: &str) -> String {
    line.trim().chars().take(60).collect()
}

impl Reading {
    /// Takes a line; a wrong one gives the text that is expected.
    fn line(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => self.vertex(words),
            Some("l") => self.polyline(words),
            Some(word @ ("g" | "o")) => self.name(line.trim_start()[word.len()..].trim()),
            Some("#") => self.comment(line),
            Some("f" | "p" | "curv" | "surf") => {
                self.skipped += 1;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn vertex<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let mut numbers = [0.0_f32; 8];
        let mut count = 0;
        for word in words.take(8) {
            numbers[count] = word.parse().map_err(|_| "numbers behind `v`".to_owned())?;
            count += 1;
        }
        if count < 3 {
            return Err("three coordinates behind `v`".to_owned());
        }
        self.vertices.push(Vec3::from_slice(&numbers));
        // A fourth or seventh number is a weight of rational curves.
        if count == 6 || count == 7 {
            self.colors.push([numbers[count - 3], numbers[count - 2], numbers[count - 1]]);
        }
        if self.vertices.len() as u64 > MAX_POINTS {
            return Err(format!("{MAX_POINTS} vertices at most"));
        }
        Ok(())
    }

    fn polyline<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let count = self.vertices.len() as i64;
        let points = &mut self.lines.points;
        let first = points.len();
        for word in words {
            let index: i64 = word.split('/').next().and_then(|word| word.parse().ok()).unwrap_or(0);
            let vertex = if index < 0 { count + index } else { index - 1 };
            if !(0..count).contains(&vertex) {
                return Err(format!("vertices 1 to {count} behind `l`, or -1 to -{count}"));
            }
            points.push(vertex as u32);
        }
        let (own, all) = ((points.len() - first) as u64, points.len() as u64);
        if own > MAX_POINTS_PER_STRAND || all > MAX_POINTS {
            return Err(format!("{MAX_POINTS_PER_STRAND} points of a strand at most, {MAX_POINTS} of all"));
        }
        // Segments that are joined are fewer strands.
        if self.lines.starts.len() as u64 > MAX_STRANDS && own > 2 {
            return Err(format!("{MAX_STRANDS} strands at most"));
        }
        self.lines.starts.push(all as u32);
        // Lines before any `g` are in a group of that name by the format's own rule.
        if self.group.is_none() {
            self.name("default")?;
        }
        self.groups.push(self.group.unwrap_or_default());
        Ok(())
    }

    fn name(&mut self, name: &str) -> Result<(), String> {
        if name.len() > MAX_NAME {
            return Err(format!("a name of {MAX_NAME} bytes at most"));
        }
        if let Some(number) = self.numbers.get(name) {
            self.group = Some(*number);
            return Ok(());
        }
        let next = self.next_group;
        self.next_group = next.saturating_add(1);
        self.numbers.insert(name.to_owned(), next);
        self.group = Some(next);
        Ok(())
    }

    /// `# group NUMBER NAME`, as [`write()`] has it, says which number a group is to have.
    fn comment(&mut self, line: &str) -> Result<(), String> {
        let Some(rest) = line.trim().strip_prefix("# group ") else { return Ok(()) };
        let (number, name) = rest.split_once(' ').unwrap_or((rest, ""));
        let Ok(number) = number.parse() else { return Ok(()) };
        let name = if name.is_empty() { unnamed(number) } else { name.to_owned() };
        if name.len() > MAX_NAME {
            return Err(format!("a name of {MAX_NAME} bytes at most"));
        }
        self.numbers.insert(name, number);
        self.next_group = self.next_group.max(number.saturating_add(1));
        Ok(())
    }

    /// The strands, and notes on how lines became them.
    fn groom(self) -> (Groom, Vec<String>) {
        let listed = self.groups.len();
        let joined = self.lines.joined(self.vertices.len());
        let problems = joined.problems(listed);
        let colored = self.colors.len() == self.vertices.len();
        let points = || joined.lines.points.iter().map(|vertex| *vertex as usize);
        let mut groom = Groom {
            points: points().map(|vertex| self.vertices[vertex]).collect(),
            colors: colored.then(|| points().map(|vertex| self.colors[vertex]).collect()),
            ..Groom::empty(0.0)
        };
        let only_default = self.numbers.len() == 1 && self.numbers.contains_key("default");
        if !only_default {
            groom.groups = Some(joined.firsts.iter().map(|line| self.groups[*line as usize]).collect());
            let named = self.numbers.into_iter().filter(|(name, number)| *name != unnamed(*number));
            groom.group_names = named.map(|(name, number)| (number, name)).collect();
        }
        groom.starts = joined.lines.starts;
        (groom, problems)
    }
}

/// The name of a group that has none.
fn unnamed(number: u32) -> String {
    format!("group_{number}")
}

/// Writes the lines of an `.obj` file.
///
/// # Errors
/// Names of groups that a line cannot hold, or two groups of one name.
pub fn write(groom: &Groom) -> Result<Vec<u8>, GroomError> {
    let names = names(groom)?;
    let mut out = String::with_capacity(40 * groom.points.len());
    for (number, name) in &names {
        let _ = match groom.group_names.contains_key(number) {
            true => writeln!(out, "# group {number} {name}"),
            false => writeln!(out, "# group {number}"),
        };
    }
    let mut last = None;
    for strand in 0..groom.strand_count() {
        let group = groom.groups.as_ref().map(|groups| groups[strand]);
        if let Some(group) = group.filter(|_| group != last) {
            let _ = writeln!(out, "g {}", names[&group]);
        }
        last = group;
        for point in groom.range(strand) {
            let [x, y, z] = groom.points[point].to_array();
            let _ = write!(out, "v {x} {y} {z}");
            if let Some(colors) = &groom.colors {
                let [red, green, blue] = colors[point];
                let _ = write!(out, " {red} {green} {blue}");
            }
            out.push('\n');
        }
        out.push('l');
        for point in groom.range(strand) {
            let _ = write!(out, " {}", point + 1);
        }
        out.push('\n');
    }
    Ok(out.into_bytes())
}

/// A name for every group that strands are in.
fn names(groom: &Groom) -> Result<BTreeMap<u32, String>, GroomError> {
    let numbers = groom.groups.iter().flatten().chain(groom.group_names.keys());
    let name = |number: &u32| groom.group_names.get(number).cloned().unwrap_or_else(|| unnamed(*number));
    let names: BTreeMap<u32, String> = numbers.map(|number| (*number, name(number))).collect();
    let whole = |name: &String| {
        name.trim() == name && !name.is_empty() && !name.contains(['\n', '\r']) && name.len() <= MAX_NAME
    };
    let apart: BTreeSet<&String> = names.values().collect();
    if apart.len() < names.len() || !names.values().all(whole) {
        return Err(GroomError::CannotHold {
            format: ".obj",
            found: format!("groups of the names {:?}", names.values().take(8).collect::<Vec<_>>()),
            expected: "names of one line, each once",
            mend: "write a .ply or .npz file",
        });
    }
    Ok(names)
}
