//! Writes a groom to a file of any of the formats.

use std::path::Path;

use strandline_base::WholeFile;

use super::{Attribute, Fitted, Format, endings};
use crate::{Groom, GroomError};

/// Attributes that the writer left out, and changes that it made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Saved {
    /// Parts of the groom that the format cannot hold.
    pub left_out: Vec<&'static str>,
    /// Changes that made the groom fit the format, human-readable.
    pub notes: Vec<String>,
    /// Number of points in the file.
    pub points: usize,
}

impl Groom {
    /// Writes a file of the format that its ending names; returns the attributes that the format could not hold and the
    /// changes that made the groom fit.
    ///
    /// # Errors
    /// See [`GroomError`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<Saved, GroomError> {
        save(self, path.as_ref())
    }
}

/// Writes a file of the format that its ending names. The file is whole or not there.
///
/// # Errors
/// A format that is not written or cannot hold the groom, or a folder that cannot be written.
pub fn save(groom: &Groom, path: &Path) -> Result<Saved, GroomError> {
    let format = Format::of(path)?;
    let Some(write) = format.write else {
        return Err(GroomError::NotWritten {
            ending: format.ending,
            expected: endings(|format| format.write.is_some()),
            path: path.to_owned(),
        });
    };
    let is_lost = |attribute: &Attribute| attribute.is_in(groom) && !format.holds.contains(attribute);
    let mut lost: Vec<Attribute> = Attribute::ALL.into_iter().filter(is_lost).collect();
    // One of the two says it all.
    if lost.contains(&Attribute::Widths) {
        lost.retain(|attribute| *attribute != Attribute::WidthsAlong);
    }
    let fitted = format.fit.map(|fit| fit(groom)).transpose().map_err(|error| error.of(path))?;
    let Fitted { groom: changed, notes } = fitted.unwrap_or_default();
    let written = changed.as_ref().unwrap_or(groom);
    let bytes = write(written).map_err(|error| error.of(path))?;
    WholeFile::save(path, &bytes).map_err(|source| GroomError::File {
        action: "write",
        path: path.to_owned(),
        source,
    })?;
    let left_out = lost.into_iter().map(Attribute::name).collect();
    Ok(Saved { left_out, notes, points: written.points.len() })
}
