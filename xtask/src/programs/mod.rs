//! Test programs, examples and tests in Python: found in cargo's messages, run side by side, the longest first.

mod order;
mod tally;
mod turns;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

pub use order::keep;
pub use tally::{Prints, Tally};
pub use turns::{Ran, run};

/// Programs that need the machine for themselves, with the reason. They run last, one after the other.
const ALONE: [(&str, &str); 1] =
    [("strandline-cli/window", "a click or a drag that falls into one slow pass of the window is none")];

/// A program that runs longer than this is ended and has failed, unless it has a limit of its own.
pub const LONGEST: Duration = Duration::from_secs(1800);

/// An executable that cargo built, or one that runs its tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// `PACKAGE/TARGET` as faults name tests (`strandline/it`, `strandline-sim/lib`), or `example NAME`.
    pub name: String,
    /// The executable.
    pub path: PathBuf,
    /// The folder in which cargo would run it.
    pub folder: PathBuf,
    /// Lines that tell the results of its tests.
    pub prints: Prints,
    /// Its words.
    pub arguments: Vec<String>,
    /// Variables of its own.
    pub environment: Vec<(String, String)>,
    /// Time that it may take.
    pub longest: Duration,
}

impl Program {
    /// True for a program that needs the machine for itself.
    fn is_alone(&self) -> bool {
        ALONE.iter().any(|(name, _)| *name == self.name)
    }

    /// The program with the environment of `cargo test`.
    fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command.current_dir(&self.folder).env("CARGO_MANIFEST_DIR", &self.folder);
        command.args(&self.arguments).envs(self.environment.iter().cloned());
        if self.prints == Prints::Nothing {
            command.env("STRANDLINE_QUICK", "1");
        }
        command
    }
}

/// Test programs, and the examples that lie in `examples` of the root, in messages of `cargo test --no-run`.
pub fn found(messages: &str, examples: &[String]) -> Vec<Program> {
    artifacts(messages).filter_map(|message| program(&message, examples)).collect()
}

/// Artifacts of our own packages that cargo built although nothing had changed.
pub fn stale(messages: &str) -> Vec<String> {
    let stale = artifacts(messages).filter(|message| message["fresh"] == false);
    stale.map(|message| format!("{}: {}", package(&message), message["target"]["name"])).collect()
}

/// Artifacts of packages of the workspace.
fn artifacts(messages: &str) -> impl Iterator<Item = Value> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    messages.filter(|message| {
        let own = message["package_id"].as_str().is_some_and(|id| id.starts_with("path+"));
        own && message["reason"] == "compiler-artifact"
    })
}

/// The package's name: `path+file:///a/NAME#0.1.0` or `path+file:///a/b#NAME@0.1.0`.
fn package(message: &Value) -> String {
    let id = message["package_id"].as_str().unwrap_or_default();
    let (path, version) = id.split_once('#').unwrap_or((id, ""));
    let name = version.split_once('@').map(|(name, _)| name);
    name.unwrap_or_else(|| path.rsplit('/').next().unwrap_or(path)).to_owned()
}

fn program(message: &Value, examples: &[String]) -> Option<Program> {
    let path = PathBuf::from(message["executable"].as_str()?);
    let (target, kind) = (message["target"]["name"].as_str()?, message["target"]["kind"][0].as_str()?);
    let tests = message["profile"]["test"] == true;
    let folder = Path::new(message["manifest_path"].as_str()?).parent()?.to_owned();
    let name = match kind {
        "example" if !tests && examples.iter().any(|example| example == target) => {
            format!("example {target}")
        }
        _ if !tests => return None,
        "lib" => format!("{}/lib", package(message)),
        _ => format!("{}/{target}", package(message)),
    };
    let (folder, prints) =
        if tests { (folder, Prints::Tests) } else { (crate::cargo::root().to_owned(), Prints::Nothing) };
    Some(Program {
        name,
        path,
        folder,
        prints,
        arguments: Vec::new(),
        environment: Vec::new(),
        longest: LONGEST,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const MESSAGES: &str = r#"not json
{"reason":"compiler-artifact","package_id":"registry+x#glam@0.34.0","target":{"kind":["lib"],"name":"glam"},"profile":{"test":false},"executable":null,"fresh":false}
{"reason":"compiler-artifact","package_id":"path+file:///r/crates/strandline#0.1.0","manifest_path":"/r/crates/strandline/Cargo.toml","target":{"kind":["lib"],"name":"strandline"},"profile":{"test":false},"executable":null,"fresh":true}
{"reason":"compiler-artifact","package_id":"path+file:///r/crates/strandline#0.1.0","manifest_path":"/r/crates/strandline/Cargo.toml","target":{"kind":["test"],"name":"it"},"profile":{"test":true},"executable":"/t/it-1","fresh":true}
{"reason":"compiler-artifact","package_id":"path+file:///r/crates/strandline#0.1.0","manifest_path":"/r/crates/strandline/Cargo.toml","target":{"kind":["example"],"name":"hello"},"profile":{"test":false},"executable":"/t/examples/hello","fresh":true}
{"reason":"compiler-artifact","package_id":"path+file:///r/crates/gpu#strandline-gpu@0.1.0","manifest_path":"/r/crates/gpu/Cargo.toml","target":{"kind":["example"],"name":"adapters"},"profile":{"test":false},"executable":"/t/examples/adapters","fresh":true}
{"reason":"compiler-artifact","package_id":"path+file:///r/crates/sim#strandline-sim@0.1.0","manifest_path":"/r/crates/sim/Cargo.toml","target":{"kind":["lib"],"name":"strandline_sim"},"profile":{"test":true},"executable":"/t/sim-2","fresh":false}
{"reason":"compiler-artifact","package_id":"path+file:///r/apps/cli#strandline-cli@0.1.0","manifest_path":"/r/apps/cli/Cargo.toml","target":{"kind":["bin"],"name":"strandline"},"profile":{"test":false},"executable":"/t/strandline","fresh":true}"#;

    #[test]
    fn test_programs_and_examples_are_found_with_their_folders() {
        let programs = found(MESSAGES, &["hello".into(), "length".into()]);
        let names: Vec<_> = programs.iter().map(|program| program.name.as_str()).collect();
        assert_eq!(names, ["strandline/it", "example hello", "strandline-sim/lib"]);
        let folders: Vec<_> = programs.iter().map(|program| program.folder.as_path()).collect();
        assert_eq!(
            folders,
            [Path::new("/r/crates/strandline"), crate::cargo::root(), Path::new("/r/crates/sim")]
        );
    }

    #[test]
    fn what_was_built_anew_is_found_and_others_code_is_not_looked_at() {
        assert_eq!(stale(MESSAGES), [r#"strandline-sim: "strandline_sim""#]);
    }
}
