//! Planted faults: small changes that a test has to see. checks/faults lists them.

mod kept;
mod list;
mod report;
mod run;
mod tree;
mod wish;

use std::path::Path;

use anyhow::{Result, bail};

use crate::cargo::root;
use list::{Fault, load};

pub use wish::Wish;

/// Faults of the list that no longer apply, and tests of it that do not exist.
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

/// Plants the requested faults, one after the other, and reports which were seen. False if a fault was not.
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
    use super::list::Edit;
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
