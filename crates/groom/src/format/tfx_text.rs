//! `.tfx` of TressFX 2: text with a line for each point.

use std::str::SplitWhitespace;

use glam::{Vec2, Vec3};
use strandline_base::{counted, utf8_text};

use super::bytes::Source;
use super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS, Parsed};
use crate::{Groom, GroomError};

/// Tells the text of version 2 from the binary versions.
pub fn is_text(bytes: &[u8]) -> bool {
    utf8_text(&bytes[..bytes.len().min(64)]).trim_ascii_start().starts_with(b"version")
}

/// Values of a header that change its strands.
struct Header {
    scale: f32,
    translation: Vec3,
    strands: Option<u64>,
    problems: Vec<String>,
}

/// Reads a `.tfx` file of version 2; the point of a line is scaled and moved as its header says.
///
/// # Errors
/// [`GroomError::Malformed`] with the line that is wrong.
pub fn read(bytes: &[u8]) -> Result<Parsed, GroomError> {
    let source = Source { bytes, format: ".tfx 2" };
    let text = utf8_text(bytes);
    let mut header = Header { scale: 1.0, translation: Vec3::ZERO, strands: None, problems: Vec::new() };
    let mut groom = Groom::empty(0.0);
    let mut uvs = Vec::new();
    // Points that the strand under way still lacks.
    let mut missing = 0;
    for (number, line) in text.split(|byte| *byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line).replace(',', " ");
        let wrong = |expected: &str| {
            let line: String = line.trim().chars().take(60).collect();
            source.error(format!("`{line}` in line {}", number + 1), expected)
        };
        let mut words = line.split_whitespace();
        let Some(word) = words.clone().next() else { continue };
        if missing > 0 {
            groom.points.push(vector(words).ok_or_else(|| wrong("the three coordinates of a point"))?);
            missing -= 1;
            if missing == 0 {
                groom.starts.push(groom.points.len() as u32);
            }
        } else if word == "strand" {
            let (count, uv) =
                strand(words).ok_or_else(|| wrong("`strand INDEX numVerts COUNT texcoord U V`"))?;
            missing = count;
            uvs.push(uv);
            if uvs.len() as u64 > MAX_STRANDS || groom.points.len() as u64 + missing > MAX_POINTS {
                return Err(wrong(&format!("{MAX_STRANDS} strands of {MAX_POINTS} points at most")));
            }
        } else {
            words.next();
            header.line(word, words).ok_or_else(|| wrong("a header of TressFX 2"))?;
        }
    }
    if missing > 0 || header.strands.is_some_and(|stated| stated != uvs.len() as u64) {
        let stated = header.strands.map_or("all".to_owned(), |stated| stated.to_string());
        let found = format!("{} whole strands", groom.strand_count());
        return Err(source.error(found, format!("{stated} strands with all their points")));
    }
    groom.transform(header.scale, glam::Quat::IDENTITY, header.translation);
    // Files without coordinates have zeros.
    groom.root_uvs = uvs.iter().any(|uv| *uv != Vec2::ZERO).then_some(uvs);
    Ok(Parsed { format: ".tfx 2", groom, problems: header.problems })
}

impl Header {
    /// Takes a line by its first word; `None` for one that is wrong.
    fn line(&mut self, word: &str, mut rest: SplitWhitespace) -> Option<()> {
        match word {
            "version" => rest.next()?.starts_with('2').then_some(())?,
            "scale" => {
                self.scale =
                    rest.next()?.parse().ok().filter(|scale: &f32| scale.is_finite() && *scale > 0.0)?;
            }
            "translation" => self.translation = vector(rest).filter(|translation| translation.is_finite())?,
            "rotation" if vector(rest.clone())? != Vec3::ZERO => {
                self.problems.push("the rotation of the header is not applied".to_owned());
            }
            "numStrands" => self.strands = Some(rest.next()?.parse().ok()?),
            "numFollowHairsPerGuideHair" => {
                if let Ok(count @ 1..) = rest.next()?.parse::<u32>() {
                    let hairs = counted(
                        count,
                        "hair that TressFX adds to each guide is",
                        "hairs that TressFX adds to each guide are",
                    );
                    self.problems.push(format!("{hairs} not added"));
                }
            }
            // A point that no strand has.
            _ if word.parse::<f32>().is_ok() => return None,
            // Others, such as `is sorted 1`, change nothing here.
            _ => {}
        }
        Some(())
    }
}

fn vector(mut words: SplitWhitespace) -> Option<Vec3> {
    let mut number = || words.next()?.parse().ok();
    Some(Vec3::new(number()?, number()?, number()?))
}

/// The points and the root coordinates of a strand, from its line.
fn strand(mut words: SplitWhitespace) -> Option<(u64, Vec2)> {
    let count = words.by_ref().skip_while(|word| *word != "numVerts").nth(1)?.parse().ok()?;
    let mut uv = words.skip_while(|word| *word != "texcoord").skip(1).map_while(|word| word.parse().ok());
    let uv = Vec2::new(uv.next().unwrap_or(0.0), uv.next().unwrap_or(0.0));
    (1..=MAX_POINTS_PER_STRAND).contains(&count).then_some((count, uv))
}
