//! The arguments of `cargo xtask faults`.

/// The arguments of `faults`, parsed.
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
