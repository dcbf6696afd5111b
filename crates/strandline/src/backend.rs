use std::str::FromStr;

use crate::Error;

/// Where stages run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// Plain Rust on every core.
    #[default]
    Cpu,
}

impl Backend {
    /// The fastest backend of this machine.
    pub fn auto() -> Self {
        Self::Cpu
    }

    /// Its name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
        }
    }
}

impl FromStr for Backend {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        match name {
            "auto" => Ok(Self::auto()),
            "cpu" => Ok(Self::Cpu),
            found => Err(Error::Backend { found: found.to_owned() }),
        }
    }
}
