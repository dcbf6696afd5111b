//! Cargo and its outputs, from the root.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// The repository's root.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the root")
}

/// A program that cargo calls in place of rustc for our crates, and the variable that tells it so.
static INSTEAD: OnceLock<(PathBuf, &str)> = OnceLock::new();

/// Lets each following call of cargo compile our crates through a program, for which a variable is set; once.
pub fn compile_through(program: PathBuf, variable: &'static str) -> bool {
    INSTEAD.set((program, variable)).is_ok()
}

/// The program of [`compile_through`].
pub fn wrapper() -> Option<&'static Path> {
    INSTEAD.get().map(|(program, _)| program.as_path())
}

/// Cargo in the root.
pub fn cargo_command(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(root());
    if let Some((program, called)) = INSTEAD.get() {
        command.env("RUSTC_WORKSPACE_WRAPPER", program).env(called, "1");
    }
    command
}

/// An example's program, built with the workspace: a package by itself has other features of its dependencies, so
/// that all of them would be built once more. `None` if it does not build.
pub fn example(name: &str) -> Option<Command> {
    let build = ["build", "--workspace", "--quiet", "--example", name];
    let mut command = cargo_command(&build);
    let output = command.arg("--message-format=json-render-diagnostics").stderr(Stdio::inherit()).output();
    let output = output.ok().filter(|output| output.status.success())?;
    let mut program = Command::new(executable(&String::from_utf8_lossy(&output.stdout), name)?);
    program.current_dir(root());
    Some(program)
}

/// The file of an example in the messages of cargo, a line each.
fn executable(messages: &str, name: &str) -> Option<PathBuf> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    messages.filter(|message| message["target"]["name"] == name).find_map(|message| {
        let is_example = message["target"]["kind"].as_array()?.iter().any(|kind| kind == "example");
        message["executable"].as_str().filter(|_| is_example).map(PathBuf::from)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_of_an_example_is_found_in_what_cargo_tells() {
        let messages = r#"not json
{"reason":"compiler-artifact","target":{"kind":["lib"],"name":"hello"},"executable":null}
{"reason":"compiler-artifact","target":{"kind":["bin"],"name":"hello"},"executable":"/t/hello"}
{"reason":"compiler-artifact","target":{"kind":["example"],"name":"length"},"executable":"/t/examples/length"}
{"reason":"compiler-artifact","target":{"kind":["example"],"name":"hello"},"executable":"/t/examples/hello"}"#;
        assert_eq!(executable(messages, "hello"), Some("/t/examples/hello".into()));
        assert_eq!(executable(messages, "gallery"), None);
    }
}
