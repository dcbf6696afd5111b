//! Whether there is a GPU to test on, and the software one that can be installed where there is none.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::run::{cargo_command, root};

/// What the tests ask of the machine: a missing adapter is a failure.
pub const REQUIRED: &str = "STRANDLINE_REQUIRE_GPU";

/// What is left out without an adapter.
pub const UNTESTED: &str =
    "no GPU adapter: the parity checks, the laws on the GPU and the backend tests compared nothing";

/// Debian's software Vulkan.
const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// What to do about the adapter before the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plan {
    /// There is one, or none is asked for.
    Go,
    /// Install the software driver, with these words before the package manager's name.
    Install(&'static [&'static str]),
    /// One is required, and cannot be installed from here.
    GiveUp(&'static str),
}

/// What is known of the machine.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    pub adapter: bool,
    pub apt: bool,
    pub root: bool,
    pub sudo: bool,
}

/// Decides, with or without `--setup`, and where an adapter is `required` anyway.
pub fn plan(setup: bool, required: bool, machine: Machine) -> Plan {
    match machine {
        Machine { adapter: true, .. } => Plan::Go,
        _ if !setup && required => Plan::GiveUp("a GPU is required and there is none; try --setup"),
        _ if !setup => Plan::Go,
        Machine { apt: false, .. } => Plan::GiveUp(
            "there is no GPU and no apt-get: install a Vulkan driver by hand, such as Mesa's lavapipe",
        ),
        Machine { root: true, .. } => Plan::Install(&[]),
        Machine { sudo: true, .. } => Plan::Install(&["sudo", "-n"]),
        _ => Plan::GiveUp(
            "there is no GPU and no right to install one: run \
             `sudo apt-get install --no-install-recommends mesa-vulkan-drivers libvulkan1`",
        ),
    }
}

/// Sees to it that there is an adapter, as far as that is asked for: whether there is one, or why the
/// tests cannot start.
pub fn prepare(setup: bool) -> Result<bool, String> {
    let required = std::env::var_os(REQUIRED).is_some_and(|value| value == "1");
    let adapter = is_there()?;
    match plan(setup, required, look(adapter)) {
        Plan::Go => Ok(adapter),
        Plan::GiveUp(why) => Err(why.to_owned()),
        Plan::Install(before) => {
            println!("\nthere is no GPU: installing {}, a software one", PACKAGES.join(" and "));
            if !install(before) {
                return Err("the package manager could not install the software driver".to_owned());
            }
            if is_there()? { Ok(true) } else { Err("the software driver shows no adapter".to_owned()) }
        }
    }
}

/// Asks the kit for the adapters, and prints them; why it cannot be asked.
fn is_there() -> Result<bool, String> {
    println!("\n== adapters");
    let list = ["run", "--quiet", "--package", "strandline-gpu", "--example", "adapters"];
    match cargo_command(&list).status().map(|status| status.code()) {
        Ok(Some(0)) => Ok(true),
        Ok(Some(1)) => Ok(false),
        _ => Err("the list of adapters does not build or run".to_owned()),
    }
}

fn look(adapter: bool) -> Machine {
    let succeeds = |program: &str, arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    let user = Command::new("id").arg("-u").output();
    Machine {
        adapter,
        apt: succeeds("apt-get", &["--version"]),
        root: user.is_ok_and(|output| output.stdout.trim_ascii() == b"0"),
        sudo: succeeds("sudo", &["-n", "true"]),
    }
}

/// Installs from the package lists that there are, and renews them when that fails.
fn install(before: &[&str]) -> bool {
    let apt = |arguments: &[&str]| {
        let words = [before, &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"], arguments].concat();
        println!("{}", words.join(" "));
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).stdin(Stdio::null()).current_dir(root());
        command.status().is_ok_and(|status| status.success())
    };
    let packages = [&["install", "--yes", "--no-install-recommends"], &PACKAGES[..]].concat();
    let listed = Path::new("/var/lib/apt/lists").read_dir().is_ok_and(|mut lists| lists.next().is_some());
    (listed && apt(&packages)) || (apt(&["update"]) && apt(&packages))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BARE: Machine = Machine { adapter: false, apt: true, root: false, sudo: false };

    #[test]
    fn an_adapter_is_enough() {
        for (setup, required) in [(false, false), (false, true), (true, false), (true, true)] {
            assert_eq!(plan(setup, required, Machine { adapter: true, ..BARE }), Plan::Go);
        }
    }

    #[test]
    fn without_setup_nothing_is_installed() {
        assert_eq!(plan(false, false, Machine { root: true, ..BARE }), Plan::Go);
        assert!(matches!(plan(false, true, Machine { root: true, ..BARE }), Plan::GiveUp(_)));
    }

    #[test]
    fn setup_installs_with_the_rights_that_there_are() {
        assert_eq!(plan(true, false, Machine { root: true, ..BARE }), Plan::Install(&[]));
        assert_eq!(plan(true, false, Machine { sudo: true, ..BARE }), Plan::Install(&["sudo", "-n"]));
        for machine in [BARE, Machine { apt: false, root: true, ..BARE }] {
            let Plan::GiveUp(why) = plan(true, false, machine) else { panic!("{machine:?}") };
            assert!(why.contains("install"), "{why}");
        }
    }
}
