//! A groom file for every frame.

use std::path::{Path, PathBuf};

use strandline_base::FolderLock;

use super::{CacheFrame, shape::Shape};
use crate::{
    Error,
    groom::{Groom, Influences, Widths},
};

/// Frames as files of a folder.
pub(super) struct Files {
    folder: PathBuf,
    /// Text before and behind the number, and its digits.
    pattern: (String, usize, String),
    groom: Groom,
    left_out: Vec<String>,
    notes: Vec<String>,
    bytes: u64,
    _lock: FolderLock,
}

/// The parts of a name around `%04d` or the like.
fn pattern(name: &str) -> Option<(String, usize, String)> {
    let (before, rest) = name.split_once('%')?;
    let (digits, after) = rest.split_once('d')?;
    let count = if digits.is_empty() { 1 } else { digits.strip_prefix('0')?.parse().ok()? };
    let is_one = !after.contains('%');
    (is_one && (1..=9).contains(&count)).then(|| (before.to_owned(), count, after.to_owned()))
}

/// The size of a file \[byte\].
pub(super) fn size(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |file| file.len())
}

/// True where a path names a file for every frame.
pub(super) fn is_sequence(path: &Path) -> bool {
    path.file_name().is_some_and(|name| pattern(&name.to_string_lossy()).is_some())
}

impl Files {
    /// Begins a sequence; the folder is made when it is not there.
    pub fn new(path: &Path, shape: &Shape) -> Result<Self, Error> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let pattern = pattern(&name)
            .ok_or_else(|| Error::OutName { found: name.into_owned(), path: path.to_owned() })?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let lock = crate::film::claim_name(path)?;
        let mut groom = Groom::empty(0.0);
        groom.starts.clone_from(&shape.starts);
        let attributes = &shape.attributes;
        if let Some(widths) = &attributes.widths {
            groom.widths = Widths::PerPoint(widths.clone());
        }
        groom.colors.clone_from(&attributes.colors);
        groom.root_uvs = attributes.root_uvs.as_ref().map(|uvs| uvs.iter().map(|uv| (*uv).into()).collect());
        groom.groups =
            attributes.groups.as_ref().map(|groups| groups.iter().map(|group| u32::from(*group)).collect());
        groom.guide_flags.clone_from(&attributes.guide_flags);
        if let (Some(_), Some(binding)) = (&attributes.guide_flags, &attributes.binding) {
            let (each, strands) = (binding.guides_per_strand, groom.strand_count());
            let influences =
                Influences::new(each, binding.indices.clone(), binding.weights.clone(), strands)?;
            groom.influences = Some(influences);
        }
        let names = (0..).zip(&attributes.group_names).filter(|(_, name)| !name.is_empty());
        groom.group_names = names.map(|(group, name)| (group, name.clone())).collect();
        let (left_out, notes) = (Vec::new(), Vec::new());
        Ok(Self { folder: folder.to_owned(), pattern, groom, left_out, notes, bytes: 0, _lock: lock })
    }

    /// Writes the file of a frame.
    pub fn add(&mut self, frame: &CacheFrame) -> Result<(), Error> {
        self.groom.points.clear();
        self.groom.points.extend_from_slice(frame.points);
        let (before, digits, after) = &self.pattern;
        let path = self.folder.join(format!("{before}{:0digits$}{after}", frame.number));
        let saved = self.groom.save(&path)?;
        let own = |part: &'static str| part.to_owned();
        let both = [
            (&mut self.left_out, saved.left_out.into_iter().map(own).collect()),
            (&mut self.notes, saved.notes),
        ];
        // Frames are alike: what is said of one is said of all.
        for (known, found) in both {
            let new: Vec<String> = found.into_iter().filter(|text| !known.contains(text)).collect();
            known.extend(new);
        }
        self.bytes += size(&path);
        Ok(())
    }

    /// Bytes of all files, the folder, attributes that the format could not hold, and notes on changes.
    pub fn finish(self) -> (u64, PathBuf, Vec<String>, Vec<String>) {
        (self.bytes, self.folder, self.left_out, self.notes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_a_number_in_it_is_a_sequence() {
        assert_eq!(pattern("a.%04d.hair"), Some(("a.".to_owned(), 4, ".hair".to_owned())));
        assert_eq!(pattern("%d.tfx"), Some((String::new(), 1, ".tfx".to_owned())));
        for name in ["a.hair", "a%.hair", "%4d.hair", "%00d.hair", "%099d.hair", "%sd", "s.%04d%04d.hair"] {
            assert_eq!(pattern(name), None, "{name}");
        }
        assert!(is_sequence(Path::new("x/%03d.hair")) && !is_sequence(Path::new("%03d/a.hair")));
    }
}
