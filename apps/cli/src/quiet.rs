//! Keeps a driver's output off the terminal.

/// Mesa's Vulkan layer for the choice of a device looks for a Wayland compositor, and the library that it asks
/// prints two lines to standard error where `XDG_RUNTIME_DIR` is not set, as in containers and over ssh. There
/// is no compositor then: the program restarts itself, once, with that layer disabled. The
/// environment of a process cannot be changed safely while it runs.
#[cfg(target_os = "linux")]
pub fn quiet_mesa() {
    use std::os::unix::process::CommandExt;
    const LAYER: &str = "NODEVICE_SELECT";
    let has_folder =
        std::env::var_os("XDG_RUNTIME_DIR").is_some_and(|path| std::path::Path::new(&path).is_absolute());
    let Ok(program) = std::env::current_exe() else { return };
    if has_folder || std::env::var_os(LAYER).is_some() {
        return;
    }
    let mut arguments = std::env::args_os();
    let name = arguments.next().unwrap_or_default();
    // It comes back only when it fails, and then the lines are printed.
    let _ = std::process::Command::new(program).arg0(name).args(arguments).env(LAYER, "1").exec();
}

/// Other systems have no such driver.
#[cfg(not(target_os = "linux"))]
pub fn quiet_mesa() {}
