//! Planted faults: small changes that a test has to see. checks/faults lists them.

mod report;
mod run;
mod tree;

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

use crate::run::root;

/// Where the lists are.
const FOLDER: &str = "checks/faults";

/// What the words behind `faults` ask for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    /// Faults by name; all that have no result for the tree as it is where there are none.
    pub names: Vec<String>,
    /// Names the faults and what they do.
    pub list: bool,
    /// Prints the table of the last results.
    pub table: bool,
    /// Leaves out the tests on a GPU.
    pub cpu: bool,
}

impl Wish {
    /// `None` for an option that there is not.
    pub fn parse(words: &[&str]) -> Option<Self> {
        let mut wish = Self::default();
        for word in words {
            match *word {
                "--list" => wish.list = true,
                "--table" => wish.table = true,
                "--cpu" => wish.cpu = true,
                option if option.starts_with('-') => return None,
                name => wish.names.push(name.to_owned()),
            }
        }
        Some(wish)
    }
}

/// A file of faults.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    fault: Vec<Fault>,
}

/// A fault: what it changes, and the tests that have to see it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Fault {
    name: String,
    /// What goes wrong, in words.
    what: String,
    /// The backends that it spoils: each has to see it.
    #[serde(default)]
    on: Backends,
    /// Tests: `laws FILTER`, a test target of `strandline-checks` and a part of the names of tests; or
    /// `PACKAGE/TARGET FILTER`, where the target `lib` is the unit tests.
    seen_by: Vec<String>,
    edit: Vec<Edit>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Backends {
    #[default]
    Both,
    Cpu,
    Gpu,
}

/// A text that stands once in a file, and what is put in its place.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    file: String,
    find: String,
    put: String,
}

impl Edit {
    /// The file's text with the fault in it.
    fn apply(&self, text: &str) -> Result<String> {
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
fn load(root: &Path) -> Result<Vec<Fault>> {
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

/// What is wrong with the list: faults that no longer apply, and tests that are not there.
fn problems(root: &Path, faults: &[Fault]) -> Vec<String> {
    let mut found = Vec::new();
    for fault in faults {
        for edit in &fault.edit {
            let text = std::fs::read_to_string(root.join(&edit.file)).unwrap_or_default();
            if let Err(error) = edit.apply(&text) {
                found.push(format!("{}: {error}", fault.name));
            }
        }
        for test in &fault.seen_by {
            if let Err(error) = run::Target::parse(test) {
                found.push(format!("{}: {error}", fault.name));
            }
        }
    }
    found
}

/// Plants the faults that are wished for, one after the other, and tells which were seen. False where one was not.
pub fn faults(wish: &Wish) -> bool {
    match try_faults(wish) {
        Ok(seen) => seen,
        Err(error) => {
            eprintln!("faults: {error:#}");
            false
        }
    }
}

fn try_faults(wish: &Wish) -> Result<bool> {
    let all = load(root())?;
    if let Some(name) = wish.names.iter().find(|name| all.iter().all(|fault| fault.name != **name)) {
        bail!("no fault of the name {name}; `cargo xtask faults --list` names them");
    }
    let wanted = |fault: &&Fault| wish.names.is_empty() || wish.names.contains(&fault.name);
    let chosen: Vec<Fault> = all.iter().filter(wanted).cloned().collect();
    if wish.list {
        chosen.iter().for_each(|fault| println!("{:<32} {}", fault.name, fault.what));
        return Ok(true);
    }
    if wish.table {
        print!("{}", report::page(&chosen)?);
        return Ok(true);
    }
    let broken = problems(root(), &chosen);
    broken.iter().for_each(|problem| println!("does not apply: {problem}"));
    let seen = run::all(&chosen, wish)?;
    Ok(seen && broken.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_still_applies() {
        let faults = load(root()).unwrap();
        assert!(faults.len() >= 40, "{} faults", faults.len());
        let problems = problems(root(), &faults);
        assert!(problems.is_empty(), "{}", problems.join("\n"));
    }

    #[test]
    fn a_text_that_is_gone_or_stands_twice_is_noticed() {
        let edit = |find: &str| Edit { file: "x.rs".into(), find: find.into(), put: "-".into() };
        assert_eq!(edit("b").apply("abc").unwrap(), "a-c");
        assert!(edit("d").apply("abc").unwrap_err().to_string().contains("0 times"));
        assert!(edit("b").apply("abcb").unwrap_err().to_string().contains("2 times"));
        assert!(edit("-").apply("a-c").unwrap_err().to_string().contains("changes nothing"));
    }

    #[test]
    fn wishes_are_read() {
        let wish = Wish::parse(&["one", "--cpu", "two"]).unwrap();
        assert!(wish.cpu && !wish.list && wish.names == ["one", "two"]);
        assert_eq!(Wish::parse(&["--lst"]), None);
    }
}
