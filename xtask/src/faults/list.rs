//! The faults that checks/faults lists.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

/// Folder of the lists.
const FOLDER: &str = "checks/faults";

/// A file of faults.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    fault: Vec<Fault>,
}

/// A fault: its change of the code, and the tests that have to see it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    pub name: String,
    /// The fault, in words.
    pub what: String,
    /// The backends that it spoils: each has to see it.
    #[serde(default)]
    pub on: Backends,
    /// Tests: `laws FILTER`, a test target of `strandline-checks` and a part of the names of tests; or
    /// `PACKAGE/TARGET FILTER`, where the target `lib` is the unit tests.
    pub seen_by: Vec<String>,
    pub edit: Vec<Edit>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Backends {
    #[default]
    Both,
    Cpu,
    Gpu,
}

/// A text that stands once in a file, and its replacement.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    pub file: String,
    pub find: String,
    pub put: String,
}

impl Edit {
    /// The file's text with the fault in it.
    pub fn apply(&self, text: &str) -> Result<String> {
        let count = text.matches(&self.find).count();
        ensure!(
            count == 1,
            "its text stands {count} times, expected once, in {}: {:?}",
            self.file,
            self.find
        );
        ensure!(self.find != self.put, "it changes nothing in {}: {:?}", self.file, self.find);
        Ok(text.replacen(&self.find, &self.put, 1))
    }
}

/// All faults, in the order of the files and in them.
pub fn load(root: &Path) -> Result<Vec<Fault>> {
    let folder = root.join(FOLDER);
    let read = std::fs::read_dir(&folder).with_context(|| format!("no faults: {}", folder.display()))?;
    let mut files: Vec<_> = read.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let mut faults = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path)?;
        let list: List = toml::from_str(&text).with_context(|| path.display().to_string())?;
        faults.extend(list.fault);
    }
    let mut known = BTreeSet::new();
    for fault in &faults {
        ensure!(known.insert(&fault.name), "two faults of one name: {}", fault.name);
        ensure!(!fault.edit.is_empty() && !fault.seen_by.is_empty(), "{}: no edit, or no test", fault.name);
    }
    Ok(faults)
}
