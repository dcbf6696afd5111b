//! `.tfxproj`, a project of TressFX 3: lines of text that name the `.tfx` files of one head of hair.

use std::path::{Component, Path};

use strandline_base::math;

use super::bytes::Source;
use crate::GroomError;

/// Most files of a project.
const MAX_PARTS: usize = 256;
/// Longest name of a part \[byte\].
const MAX_NAME: usize = 4096;

/// Strands of a project.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// Names of files, beside the project's, and of the parts that they are.
    pub parts: Vec<[String; 2]>,
    /// Colour of the hair, linear RGB.
    pub color: Option<[f32; 3]>,
}

/// Reads the text of a project.
///
/// # Errors
/// [`GroomError::Malformed`] with the line that is wrong.
pub fn read(bytes: &[u8]) -> Result<Project, GroomError> {
    let source = Source { bytes, format: ".tfxproj" };
    let mut project = Project::default();
    for (number, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let text = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        let wrong = |expected: &str| {
            let shown: String = text.trim().chars().take(60).collect();
            source.error(format!("`{shown}` in line {}", number + 1), expected)
        };
        match words[..] {
            [file, ..] if is_strands(file) => {
                let inside = Path::new(file).components().all(|part| matches!(part, Component::Normal(_)));
                if !inside || file.len() > MAX_NAME || project.parts.len() >= MAX_PARTS {
                    return Err(wrong("256 files at most, in the folder of the project or below it"));
                }
                let stem = Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned());
                // Follow hairs: their number, radius and separation; the settings' file; the part's name.
                let name = words.get(5).filter(|name| name.len() <= MAX_NAME).map(|name| (*name).to_owned());
                project.parts.push([file.to_owned(), name.or(stem).unwrap_or_default()]);
            }
            ["hairColor", red, green, blue] => {
                let part = |text: &str| text.parse::<f32>().ok().filter(|part| (0.0..=1.0).contains(part));
                let color = part(red).zip(part(green)).zip(part(blue));
                let ((red, green), blue) = color.ok_or_else(|| wrong("three numbers from 0 to 1"))?;
                project.color = Some([red, green, blue].map(linear));
            }
            _ => {}
        }
    }
    if project.parts.is_empty() {
        return Err(source.error("no line that names a .tfx file", "one for each part of the hair"));
    }
    Ok(project)
}

fn is_strands(file: &str) -> bool {
    Path::new(file).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("tfx"))
}

/// A part of a colour of the screen \[IEC 61966-2-1\] as light.
pub(super) fn linear(part: f32) -> f32 {
    if part <= 0.040_45 { part / 12.92 } else { math::powf((part + 0.055) / 1.055, 2.4) }
}
