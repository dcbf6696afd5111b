use crate::Groom;

/// A groom made ready for a format that cannot hold every groom, and notes on the changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fitted {
    /// The changed groom; `None` where it is written as it is.
    pub groom: Option<Groom>,
    /// Changes, human-readable.
    pub notes: Vec<String>,
}
