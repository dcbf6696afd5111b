//! The program as a person or a script calls it: commands, limits, hostile files, files for others.

mod clips;
mod command_line;
mod exported;
mod flags;
#[cfg(target_os = "linux")]
mod hostile_files;
#[cfg(target_os = "linux")]
mod limits;
mod moved;
mod refusal;
mod set;
mod sim_motion;
