//! Finds a GPU to test on and a display for windows, and installs software ones if asked to.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::cargo::{example, root};

/// Variable that makes a missing adapter a failure.
pub const REQUIRED: &str = "STRANDLINE_REQUIRE_GPU";

/// Summary of the tests that need an adapter.
pub const UNTESTED: &str =
    "no GPU adapter: the parity checks, the laws on the GPU and the backend tests compared nothing";

/// Variable that makes a missing display a failure.
pub const DISPLAY_REQUIRED: &str = "STRANDLINE_REQUIRE_DISPLAY";

/// Summary of the tests that need a display.
pub const NO_WINDOW: &str = "no Xvfb or no X libraries: the window was not opened";

/// Debian's software Vulkan.
const VULKAN: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];
/// Debian's display without a screen, and the libraries that a window loads.
const DISPLAY: [&str; 5] = ["xvfb", "libx11-xcb1", "libxcursor1", "libxi6", "libxkbcommon-x11-0"];
const LIBRARIES: [&str; 4] = ["libX11-xcb.so.1", "libXcursor.so.1", "libXi.so.6", "libxkbcommon-x11.so.0"];

/// Action on the adapter before the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plan {
    /// There is an adapter, or none is required.
    Go,
    /// Install the missing packages, with these words before the package manager's name.
    Install(&'static [&'static str]),
    /// An adapter is required and cannot be installed from here.
    GiveUp(&'static str),
}

/// State of the machine.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    pub adapter: bool,
    /// True if windows can be opened without a screen.
    pub display: bool,
    pub apt: bool,
    pub root: bool,
    pub sudo: bool,
}

/// Decides, with or without `--setup`, and where an adapter is `required` anyway.
pub fn plan(setup: bool, required: bool, machine: Machine) -> Plan {
    match machine {
        Machine { adapter: true, display: true, .. } => Plan::Go,
        Machine { adapter: true, .. } if !setup => Plan::Go,
        _ if !setup && required => Plan::GiveUp("a GPU is required and there is none; try --setup"),
        _ if !setup => Plan::Go,
        Machine { apt: false, .. } => Plan::GiveUp(
            "there is no apt-get: install a Vulkan driver, such as Mesa's lavapipe, and Xvfb by hand",
        ),
        Machine { root: true, .. } => Plan::Install(&[]),
        Machine { sudo: true, .. } => Plan::Install(&["sudo", "-n"]),
        _ => Plan::GiveUp(
            "no right to install what is missing: run `sudo apt-get install --no-install-recommends \
             mesa-vulkan-drivers libvulkan1 xvfb libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0`",
        ),
    }
}

/// Devices that the tests can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct There {
    pub adapter: bool,
    pub display: bool,
}

/// Installs an adapter and a display if asked to. Returns the devices, or why the
/// tests cannot start.
pub fn prepare(setup: bool) -> Result<There, String> {
    let required = std::env::var_os(REQUIRED).is_some_and(|value| value == "1");
    let there = There { adapter: is_there()?, display: has_display() };
    match plan(setup, required, look(there)) {
        Plan::Go => Ok(there),
        Plan::GiveUp(why) => Err(why.to_owned()),
        Plan::Install(before) => {
            let mut packages = Vec::new();
            packages.extend(VULKAN.iter().filter(|_| !there.adapter));
            packages.extend(DISPLAY.iter().filter(|_| !there.display));
            println!("\ninstalling {}", packages.join(", "));
            if !install(before, &packages) {
                return Err(format!("the package manager could not install {}", packages.join(", ")));
            }
            if !is_there()? {
                return Err("the software driver shows no adapter".to_owned());
            }
            if !has_display() {
                return Err(NO_WINDOW.to_owned());
            }
            Ok(There { adapter: true, display: true })
        }
    }
}

/// True if Xvfb and the libraries of a window are installed.
fn has_display() -> bool {
    let mut server = Command::new("Xvfb");
    let server =
        server.arg("-help").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let known = Command::new("ldconfig").arg("-p").output();
    let known = known.or_else(|_| Command::new("/sbin/ldconfig").arg("-p").output());
    let known = known.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    server.is_ok() && LIBRARIES.iter().all(|library| known.contains(library))
}

/// Asks the kit for the adapters, and prints them; why it cannot be asked.
fn is_there() -> Result<bool, String> {
    println!("\n== adapters");
    let list = example("adapters").and_then(|mut list| list.status().ok());
    match list.map(|status| status.code()) {
        Some(Some(0)) => Ok(true),
        Some(Some(1)) => Ok(false),
        _ => Err("the list of adapters does not build or run".to_owned()),
    }
}

/// Installs packages with the rights that there are.
pub fn install_packages(packages: &[&str]) -> bool {
    let machine = look(There { adapter: false, display: false });
    match plan(true, false, machine) {
        Plan::Install(before) => install(before, packages),
        Plan::Go | Plan::GiveUp(_) => false,
    }
}

fn look(There { adapter, display }: There) -> Machine {
    let succeeds = |program: &str, arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    let user = Command::new("id").arg("-u").output();
    Machine {
        adapter,
        display,
        apt: succeeds("apt-get", &["--version"]),
        root: user.is_ok_and(|output| output.stdout.trim_ascii() == b"0"),
        sudo: succeeds("sudo", &["-n", "true"]),
    }
}

/// Installs from the package lists that there are, and renews them when that fails.
fn install(before: &[&str], packages: &[&str]) -> bool {
    let apt = |arguments: &[&str]| {
        let words = [before, &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"], arguments].concat();
        println!("{}", words.join(" "));
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).stdin(Stdio::null()).current_dir(root());
        command.status().is_ok_and(|status| status.success())
    };
    let packages = [&["install", "--yes", "--no-install-recommends"], packages].concat();
    let listed = Path::new("/var/lib/apt/lists").read_dir().is_ok_and(|mut lists| lists.next().is_some());
    (listed && apt(&packages)) || (apt(&["update"]) && apt(&packages))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BARE: Machine = Machine { adapter: false, display: false, apt: true, root: false, sudo: false };

    #[test]
    fn an_adapter_and_a_display_are_enough() {
        for (setup, required) in [(false, false), (false, true), (true, false), (true, true)] {
            let machine = Machine { adapter: true, display: true, ..BARE };
            assert_eq!(plan(setup, required, machine), Plan::Go);
        }
        let machine = Machine { adapter: true, root: true, ..BARE };
        assert_eq!(plan(false, true, machine), Plan::Go);
        assert_eq!(plan(true, false, machine), Plan::Install(&[]), "a display is missing");
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
