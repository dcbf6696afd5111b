use std::path::{Path, PathBuf};

use strandline_base::{SettingError, memory::MemoryError};
use strandline_gpu::GpuError;

use crate::{body::BodyError, groom::GroomError, render::RenderError, sim::SimError};

/// Why a scene could not be loaded, moved or drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene file could not be read.
    #[error("cannot read the scene: {source}: {}", path.display())]
    ReadScene {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The scene is not valid TOML, or a key is unknown or has a value of the wrong kind.
    #[error("not a valid scene: {message}: {origin}")]
    ParseScene {
        /// The file, or `scene` for text from memory.
        origin: String,
        /// Line, what was found and what was expected.
        message: String,
    },
    /// A value of the scene is outside its range.
    #[error(transparent)]
    Value(#[from] SettingError),
    /// The file with where the hair is could not be read, or is for other hair.
    #[error("cannot read the pose of the hair: {message}: {}", path.display())]
    HairPose {
        /// The file.
        path: PathBuf,
        /// The problem.
        message: String,
    },
    /// The file with masses and velocities could not be read, or is for other hair.
    #[error("cannot read the attributes of the hair: {message}: {}", path.display())]
    Attributes {
        /// The file.
        path: PathBuf,
        /// The problem.
        message: String,
    },
    /// A picture with values over the scalp could not be read.
    #[error("cannot read the map: {message}: {}", path.display())]
    Map {
        /// The file.
        path: PathBuf,
        /// The problem and the expectation.
        message: String,
    },
    /// The file with hair that moved could not be read, or is for other hair.
    #[error("cannot read the cache: {message}: {}", path.display())]
    Cache {
        /// The file.
        path: PathBuf,
        /// The problem.
        message: String,
    },
    /// A name that no format of moving hair has.
    #[error(
        "`{found}` names no format of moving hair, expected .npz, .usda, or a name with a number in it for a file \
         a frame, such as hair.%04d.hair: {}", path.display()
    )]
    OutName {
        /// The ending.
        found: String,
        /// The file.
        path: PathBuf,
    },
    /// Another run writes the file.
    #[error("another run is writing that file, wait for it or choose another name: {}", path.display())]
    BusyFile {
        /// The file.
        path: PathBuf,
    },
    /// A scene, or where its hair is, could not be saved.
    #[error("cannot save {what}: {source}: {}", path.display())]
    Save {
        /// The content.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// An output file or folder could not be written.
    #[error("cannot write {what}: {source}: {}", path.display())]
    Write {
        /// The content.
        what: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// Another run writes into the output folder.
    #[error("another run is writing a film there, wait for it or choose another folder: {}", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// The system gave no thread for the simulation.
    #[error("cannot start the simulation's thread: {0}")]
    Thread(std::io::Error),
    /// The simulation's thread ended in the middle: a fault of ours.
    #[error("the simulation stopped with an error of the program's own")]
    WorkerGone,
    /// The scene takes more memory than a run may take.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// From the body.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// From the groom.
    #[error(transparent)]
    Groom(#[from] GroomError),
    /// From the simulation.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// From the renderer.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// From a GPU that was asked for something beside steps and pictures: to be opened, or to copy points.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Kind of an error, by what a program may do about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A GPU is gone: the CPU can continue, or the program opens the device again.
    DeviceLost,
    /// A GPU has no memory left, or no room within its limits: smaller settings or the CPU help.
    OutOfMemory,
    /// A GPU refused something else: the CPU helps.
    Refused,
    /// A value is outside its range: another value helps.
    Value,
    /// Anything else: its message says what helps.
    Other,
}

impl Error {
    /// The GPU's refusal, if it is one, whichever part asked.
    pub fn gpu(&self) -> Option<&GpuError> {
        match self {
            Self::Gpu(source) | Self::Render(RenderError::Gpu(source)) => Some(source),
            Self::Sim(error) => error.gpu(),
            _ => None,
        }
    }

    /// Its kind: what may be done about it.
    pub fn kind(&self) -> ErrorKind {
        match (self, self.gpu()) {
            (_, Some(GpuError::Lost { .. })) => ErrorKind::DeviceLost,
            (_, Some(GpuError::OutOfMemory { .. } | GpuError::Limit { .. })) => ErrorKind::OutOfMemory,
            (_, Some(_)) | (Self::Render(RenderError::TooMany { .. }), None) => ErrorKind::Refused,
            (
                Self::Value(_) | Self::Sim(SimError::Setting(_)) | Self::Render(RenderError::Setting(_)),
                None,
            ) => ErrorKind::Value,
            (_, None) => ErrorKind::Other,
        }
    }

    /// For `map_err` on what saves to `path`.
    pub(crate) fn save(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Save { what, path, source }
    }

    /// For a map over the scalp.
    pub(crate) fn map(path: &Path, message: String) -> Self {
        Self::Map { path: path.to_owned(), message }
    }

    /// For `map_err` on what writes to `path`.
    pub(crate) fn write(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Write { what, path, source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_of_a_gpu_has_its_kind_whichever_part_asked() {
        let lost = GpuError::Lost { adapter: String::new(), reason: "gone".to_owned() };
        let full = GpuError::OutOfMemory { adapter: String::new(), what: "points".to_owned(), bytes: 4 };
        for (source, kind) in [(&lost, ErrorKind::DeviceLost), (&full, ErrorKind::OutOfMemory)] {
            let errors: [Error; 3] = [
                source.clone().into(),
                SimError::from(source.clone()).into(),
                RenderError::from(source.clone()).into(),
            ];
            for error in errors {
                assert_eq!(error.kind(), kind, "{error:?}");
                assert_eq!(error.to_string(), source.to_string());
            }
        }
        let cells = SimError::Cells { cells: [64; 3], source: full };
        assert_eq!(Error::from(cells).kind(), ErrorKind::OutOfMemory);
        let value = SettingError::new("wind", "NaN", "a finite number");
        assert_eq!(Error::from(SimError::from(value.clone())).kind(), ErrorKind::Value);
        assert_eq!(Error::from(value).kind(), ErrorKind::Value);
        assert_eq!(Error::WorkerGone.kind(), ErrorKind::Other);
    }
}
