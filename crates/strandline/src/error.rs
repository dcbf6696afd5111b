use std::path::{Path, PathBuf};

use strandline_base::{FileProblem, SettingError, memory::MemoryError};
use strandline_gpu::GpuError;

use crate::{body::BodyError, groom::GroomError, render::RenderError, sim::SimError};

/// Error of loading, moving or drawing a scene.
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
    /// Groom and body could lie on each other in several ways, or in none, and a setting decides.
    #[error("cannot place the hair: {problem}: {files}")]
    Placement {
        /// The files of groom and body.
        files: String,
        /// The problem, and the flag and the key that decide.
        problem: String,
    },
    /// The file with the pose of the hair could not be read, or is for other hair.
    #[error("cannot read the pose of the hair: {problem}: {}", path.display())]
    HairPose {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: FileProblem,
    },
    /// The file with masses and velocities could not be read, or is for other hair.
    #[error("cannot read the attributes of the hair: {problem}: {}", path.display())]
    Attributes {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: FileProblem,
    },
    /// A picture with values over the scalp could not be read.
    #[error("cannot read the map: {problem}: {}", path.display())]
    Map {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: FileProblem,
    },
    /// The file of moving hair could not be read, or is for other hair.
    #[error("cannot read the cache: {problem}: {}", path.display())]
    Cache {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: FileProblem,
    },
    /// The name of a file of moving hair belongs to no format.
    #[error(
        "`{found}` names no format of moving hair, expected .npz, .usda, or a name with one number in it for a file \
         a frame, such as hair.%04d.hair{}: {}", by_extra(found, path), path.display()
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
    /// A scene or the pose of its hair could not be saved.
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
    /// Frames that were kept on the disk could not be read again.
    #[error("cannot read the frames that were kept, simulate them again: {0}")]
    KeptFrames(std::io::Error),
    /// The simulation's thread panicked: a fault of the library.
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
    /// From a GPU that was opened or asked to copy points.
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
    /// The scene takes more memory than a run may take: smaller settings help.
    TooLarge,
    /// A file or folder cannot be read or written, or its content is not as expected: another one helps.
    File,
    /// Another run writes the file or folder: waiting or another name helps.
    Busy,
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

    /// Its kind, by what a program may do about it.
    pub fn kind(&self) -> ErrorKind {
        match (self, self.gpu()) {
            (_, Some(GpuError::Lost { .. })) => ErrorKind::DeviceLost,
            (_, Some(GpuError::OutOfMemory { .. } | GpuError::Limit { .. })) => ErrorKind::OutOfMemory,
            (_, Some(_)) => ErrorKind::Refused,
            (_, None) => self.kind_on_host(),
        }
    }

    /// The kind of an error that is no GPU's.
    fn kind_on_host(&self) -> ErrorKind {
        match self {
            Self::Value(_)
            | Self::Placement { .. }
            | Self::Sim(SimError::Setting(_))
            | Self::Render(RenderError::Setting(_)) => ErrorKind::Value,
            Self::Memory(_)
            | Self::Sim(SimError::Memory(_))
            | Self::Render(RenderError::Memory { .. } | RenderError::TooMuch(_)) => ErrorKind::TooLarge,
            Self::Render(RenderError::TooMany { .. }) => ErrorKind::Refused,
            Self::Busy { .. } | Self::BusyFile { .. } => ErrorKind::Busy,
            Self::ReadScene { .. }
            | Self::ParseScene { .. }
            | Self::HairPose { .. }
            | Self::Attributes { .. }
            | Self::Map { .. }
            | Self::Cache { .. }
            | Self::OutName { .. }
            | Self::Save { .. }
            | Self::Write { .. }
            | Self::Render(RenderError::Save { .. } | RenderError::Surroundings { .. })
            | Self::Body(_)
            | Self::KeptFrames(_)
            | Self::Groom(_) => ErrorKind::File,
            Self::Thread(_) | Self::WorkerGone | Self::Sim(_) | Self::Render(_) | Self::Gpu(_) => {
                ErrorKind::Other
            }
        }
    }

    /// For `map_err` on what saves to `path`.
    pub(crate) fn save(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Save { what, path, source }
    }

    /// For a map over the scalp.
    pub(crate) fn map(path: &Path, problem: impl Into<FileProblem>) -> Self {
        Self::Map { path: path.to_owned(), problem: problem.into() }
    }

    /// For a file of moving hair.
    pub(crate) fn cache(path: &Path, problem: impl Into<FileProblem>) -> Self {
        Self::Cache { path: path.to_owned(), problem: problem.into() }
    }

    /// For `map_err` on what writes to `path`.
    pub(crate) fn write(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Write { what, path, source }
    }
}

/// The program that writes moving hair of an ending which this one cannot write, or the fault of a name with numbers.
fn by_extra(ending: &str, path: &Path) -> &'static str {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match ending {
        _ if name.matches('%').count() > 1 => "; this name has more than one",
        "usd" | "usdc" => "; the `strandline` of `pip install 'strandline[usd]'` writes it",
        "abc" => "; the `strandline` of `pip install 'strandline[abc]'` writes it",
        _ => "",
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

    #[test]
    fn a_name_of_moving_hair_is_told_its_fault() {
        let told = |name: &str| {
            let (found, path) =
                (name.rsplit('.').next().unwrap().to_owned(), PathBuf::from("50%").join(name));
            Error::OutName { found, path }.to_string()
        };
        assert!(told("s.%04d%04d.hair").contains("this name has more than one"));
        assert!(!told("s.%x.hair").contains("more than one"));
        assert!(told("s.usdc").contains("strandline[usd]"));
    }

    #[test]
    fn an_error_of_a_file_has_its_kind_and_keeps_that_of_the_system() {
        let path = PathBuf::from("no/such.npz");
        let error = crate::Cache::open(&path).err().unwrap();
        assert_eq!(error.kind(), ErrorKind::File);
        let Error::Cache { problem: FileProblem::Read(source), .. } = error else { panic!("{error:?}") };
        assert_eq!(source.kind(), std::io::ErrorKind::NotFound);
        assert_eq!(Error::cache(&path, "other hair").kind(), ErrorKind::File);
        assert_eq!(Error::Busy { path }.kind(), ErrorKind::Busy);
    }
}
