//! The GitHub workflows, checked with actionlint.

use std::process::{Command, Stdio};

use crate::cargo::root;

/// Summary of the checks that need actionlint.
pub const NOT_INSTALLED: &str = "GitHub workflows: actionlint is not installed \
                                 (`go install github.com/rhysd/actionlint/cmd/actionlint@latest`)";

/// Checks .github/workflows with actionlint; `None` if it is not installed.
pub fn check_if_installed() -> Option<bool> {
    let mut version = Command::new("actionlint");
    let version =
        version.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    version.ok().filter(|status| status.success())?;
    println!("\n== actionlint");
    Some(Command::new("actionlint").current_dir(root()).status().is_ok_and(|status| status.success()))
}
