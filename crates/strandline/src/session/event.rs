use crate::{
    render::{FrameReport, Picture},
    sim::StepReport,
};

/// An event of hair that plays.
#[derive(Clone, Debug)]
pub enum Event {
    /// Something happened that a person should read; the film continues.
    Note(String),
    /// A step of the simulation ended. Steps on a GPU are reported when their reports have arrived, all of them before
    /// the film ends.
    Stepped(StepReport),
    /// A picture is finished.
    Drawn {
        /// Its number, from 0.
        frame: u32,
        /// The picture.
        picture: Picture,
        /// Its cost.
        report: FrameReport,
    },
}
