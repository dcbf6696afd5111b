//! Names of parts, as a file is read.

use std::collections::BTreeSet;

/// Names that are kept of a file.
const MOST_NAMES: usize = 1000;

/// The name that is asked for, and all that a file has.
pub(crate) struct Names {
    asked: String,
    found: BTreeSet<String>,
}

impl Names {
    pub fn new(asked: &str) -> Self {
        Self { asked: asked.to_owned(), found: BTreeSet::new() }
    }

    /// Those that were found, in the order of letters.
    pub fn all(self) -> Vec<String> {
        self.found.into_iter().collect()
    }

    /// Notes a name; true if it is the wanted one.
    pub fn add(&mut self, name: &str) -> bool {
        if !name.is_empty() && !self.found.contains(name) && self.found.len() < MOST_NAMES {
            self.found.insert(name.to_owned());
        }
        !name.is_empty() && name.eq_ignore_ascii_case(&self.asked)
    }
}
