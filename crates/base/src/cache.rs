//! The folder of results that take long to build, kept from run to run.

use std::ffi::OsString;
use std::path::PathBuf;

use crate::plain_file::HAS_FILES;

/// The environment's variable that names the folder; `off` keeps nothing.
pub const VARIABLE: &str = "STRANDLINE_CACHE";

/// The folder, which may not exist yet; `None` if the cache is off or no folder is known.
///
/// `STRANDLINE_CACHE` where it is set, else `strandline` in the user's folder for such files: `XDG_CACHE_HOME`,
/// `LOCALAPPDATA` or `.cache` in `HOME`, whichever the system sets. A variable that is no whole path is passed
/// over, so that nothing is left in the folder of the day.
pub fn folder() -> Option<PathBuf> {
    if HAS_FILES { found(|name| std::env::var_os(name)) } else { None }
}

fn found(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    if let Some(named) = variable(VARIABLE) {
        return (named != "off" && !named.is_empty()).then(|| PathBuf::from(named));
    }
    let whole = |name| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let cache = whole("XDG_CACHE_HOME").or_else(|| whole("LOCALAPPDATA"));
    Some(cache.or_else(|| Some(whole("HOME")?.join(".cache")))?.join("strandline"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(variables: &[(&str, &str)]) -> Option<PathBuf> {
        found(|name| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into()))
    }

    #[test]
    fn the_folder_is_the_users_own_unless_one_is_named_or_none_is_wanted() {
        let home = ("HOME", "/home/ada");
        assert_eq!(with(&[home]), Some("/home/ada/.cache/strandline".into()));
        assert_eq!(with(&[home, ("XDG_CACHE_HOME", "/x")]), Some("/x/strandline".into()));
        assert_eq!(with(&[home, ("XDG_CACHE_HOME", "x")]), Some("/home/ada/.cache/strandline".into()));
        assert_eq!(with(&[home, (VARIABLE, "kept")]), Some("kept".into()));
        assert_eq!(with(&[home, (VARIABLE, "off")]), None);
        assert_eq!(with(&[home, (VARIABLE, "")]), None);
        assert_eq!(with(&[]), None);
    }
}
