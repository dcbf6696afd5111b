//! Limits of memory, checked before any allocation that a setting scales.

use std::path::Path;

/// Default limit of memory \[MiB\]. Addresses of 32 bits are those of a browser page, which has 1 GiB in all: a scene of its
/// kind takes about six tenths of its estimate.
pub const DEFAULT: u64 = if usize::BITS < 64 { 1200 } else { 8192 };
/// The environment's variable that allows more or less \[MiB\].
pub const VARIABLE: &str = "STRANDLINE_MEMORY";

/// Memory of one part of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The part, by the keys that scale it.
    pub what: String,
    /// An upper estimate \[byte\].
    pub bytes: u64,
}

impl Need {
    /// `count` things of `bytes` each.
    pub fn new(what: impl Into<String>, count: u64, bytes: u64) -> Self {
        Self { what: what.into(), bytes: count.saturating_mul(bytes) }
    }
}

/// Why memory is not taken.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MemoryError {
    /// More than is allowed.
    #[error(
        "{what} would take {needed} MiB of {total} MiB in all, more than the {allowed} MiB that may be \
         taken: ask for less, or allow more with the environment's STRANDLINE_MEMORY=MIB"
    )]
    TooMuch {
        /// The largest part.
        what: String,
        /// Memory of that part \[MiB\].
        needed: u64,
        /// Memory of all parts \[MiB\].
        total: u64,
        /// Allowed memory \[MiB\].
        allowed: u64,
    },
    /// The variable holds no number.
    #[error("STRANDLINE_MEMORY is `{found}`, expected a number of MiB, 64 or more")]
    Variable {
        /// Its value.
        found: String,
    },
}

/// Refuses needs that are together more than may be taken, by the largest of them.
///
/// # Errors
/// See [`MemoryError`].
pub fn check(needs: &[Need]) -> Result<(), MemoryError> {
    check_within(needs, allowed(std::env::var_os(VARIABLE))?)
}

/// Refuses a file whose reader would take more than is allowed: `taken` bytes for each of its own. A file longer than
/// `limit` \[byte\] is left to its reader.
///
/// # Errors
/// See [`MemoryError`].
pub fn check_file(what: &str, path: &Path, limit: u64, taken: u64) -> Result<(), MemoryError> {
    match std::fs::metadata(path).map_or(0, |found| found.len()) {
        length if length <= limit => {
            check(&[Need::new(format!("{what} of {}", path.display()), length, taken)])
        }
        _ => Ok(()),
    }
}

/// Largest size to which a packed file may unpack \[byte\]: a uniform picture packs so well that a small file
/// could exhaust memory.
pub const fn most_unpacked(file_length: u64) -> u64 {
    (256 << 20) + 64 * file_length
}

/// Allowed memory \[MiB\], by the value of the variable.
fn allowed(variable: Option<std::ffi::OsString>) -> Result<u64, MemoryError> {
    let Some(text) = variable else { return Ok(DEFAULT) };
    let number = text.to_str().and_then(|text| text.trim().parse().ok());
    number
        .filter(|mebibytes| *mebibytes >= 64)
        .ok_or_else(|| MemoryError::Variable { found: text.to_string_lossy().into_owned() })
}

fn check_within(needs: &[Need], allowed: u64) -> Result<(), MemoryError> {
    let mebibytes = |bytes: u64| bytes.div_ceil(1 << 20);
    let total = mebibytes(needs.iter().fold(0, |sum: u64, need| sum.saturating_add(need.bytes)));
    let Some(largest) = needs.iter().max_by_key(|need| need.bytes) else { return Ok(()) };
    if total <= allowed {
        return Ok(());
    }
    let (what, needed) = (largest.what.clone(), mebibytes(largest.bytes));
    Err(MemoryError::TooMuch { what, needed, total, allowed })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_refused_by_its_largest_part() {
        let needs = [Need::new("maps", 3, 1 << 20), Need::new("points", 5 << 20, 1), Need::new("none", 0, 9)];
        check_within(&needs, 8).unwrap();
        let error = check_within(&needs, 7).unwrap_err();
        let MemoryError::TooMuch { what, needed, total, allowed } = &error else { panic!("{error}") };
        assert_eq!((what.as_str(), *needed, *total, *allowed), ("points", 5, 8, 7));
        // More than 64 bits can count is more than is allowed.
        assert!(check_within(&[Need::new("a", u64::MAX, 9), Need::new("b", 1, 1)], DEFAULT).is_err());
        check_within(&[], 0).unwrap();
    }

    #[test]
    fn the_variable_is_a_number_or_refused() {
        assert_eq!(allowed(None), Ok(DEFAULT));
        assert_eq!(allowed(Some("100".into())), Ok(100));
        for found in ["", "8G", "-1", "0", "63"] {
            let error = allowed(Some(found.into())).unwrap_err().to_string();
            assert!(error.contains(&format!("`{found}`")), "{error}");
        }
    }
}
