//! The arguments of `cargo xtask faults`.

/// The arguments of `faults`, parsed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    /// Faults by name; without names, all that have no result for the current tree.
    pub names: Vec<String>,
    /// Lists the faults with their meaning.
    pub list: bool,
    /// Prints the table of the last results.
    pub table: bool,
    /// Leaves out the tests on a GPU.
    pub cpu: bool,
}

impl Wish {
    /// `None` for an unknown option.
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
