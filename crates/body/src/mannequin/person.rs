use strandline_base::choices;

choices! {
    /// Build of the mannequin. Skull, scalp and ears are the same.
    pub enum Build as "body.build" {
        /// A narrow neck and narrow shoulders, lean cheeks.
        Slender = "slender" or "slim",
        /// Between the others.
        Medium = "medium",
        /// A strong neck and wide shoulders, full cheeks and a wide jaw.
        Broad = "broad" or "sturdy",
    }
    default Medium
}

choices! {
    /// Eyes of the mannequin.
    pub enum Eyes as "body.eyes" {
        /// They look ahead.
        Open = "open",
        /// The lids are closed.
        Closed = "closed" or "shut",
    }
    default Open
}

impl Build {
    /// From -1, slender, to 1, broad.
    pub(super) const fn breadth(self) -> f32 {
        match self {
            Self::Slender => -1.0,
            Self::Medium => 0.0,
            Self::Broad => 1.0,
        }
    }
}
