//! A compiler with the target wasm32-unknown-unknown: that of rustup, else Debian's, unpacked below `target`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};

use super::folders::work;
use crate::cargo::cargo_command;

pub const TARGET: &str = "wasm32-unknown-unknown";

/// Debian's compiler for browsers, and the sources of its standard library.
const PACKAGES: [&str; 2] = ["rustc-web", "rust-web-src"];

/// Flags of the compiler: vectors of four numbers are part of every browser since 2023.
const FLAGS: &str = "-C target-feature=+simd128";

/// A compiler for the page.
#[derive(Debug)]
pub struct Compiler {
    /// Compiler and linker other than cargo's own.
    other: Option<[PathBuf; 2]>,
}

impl Compiler {
    /// Cargo for the page.
    pub fn cargo(&self, arguments: &[&str]) -> Command {
        let mut command = cargo_command(arguments);
        command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", FLAGS);
        if let Some([rustc, linker]) = &self.other {
            command.env("RUSTC", rustc).env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
        }
        command
    }
}

/// The compiler that there is; `setup` gets one where there is none.
pub fn compiler(setup: bool) -> Result<Compiler> {
    if let Some(compiler) = found() {
        return Ok(compiler);
    }
    ensure!(
        setup,
        "the compiler has no target {TARGET}: `rustup target add {TARGET}`, or `cargo xtask web --setup` where there is \
         apt-get"
    );
    if succeeds(Command::new("rustup").args(["target", "add", TARGET]))
        && let Some(compiler) = found()
    {
        return Ok(compiler);
    }
    println!("\n== a compiler with {TARGET} from Debian's packages");
    unpacked().context("the compiler of Debian's packages")?;
    found().context("the unpacked compiler has no standard library")
}

/// The own compiler where it has the target, else the unpacked one.
fn found() -> Option<Compiler> {
    let own = std::env::var_os("RUSTC").map_or_else(|| PathBuf::from("rustc"), PathBuf::from);
    if has_target(&own) {
        return Some(Compiler { other: None });
    }
    let other = [tool("rustc"), tool("wasm-ld")];
    has_target(&other[0]).then_some(Compiler { other: Some(other) })
}

fn tool(name: &str) -> PathBuf {
    work().join("bin").join(name)
}

/// Folder of the target's standard library.
fn library(rustc: &Path) -> Option<PathBuf> {
    let output = Command::new(rustc).args(["--print", "target-libdir", "--target", TARGET]).output().ok()?;
    let path = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    Some(PathBuf::from(path.trim()))
}

fn has_target(rustc: &Path) -> bool {
    let names = library(rustc).and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    names.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with("libstd-"))
}

fn succeeds(command: &mut Command) -> bool {
    command.stdin(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Downloads and unpacks compiler and linker, and compiles the standard library, about a minute.
fn unpacked() -> Result<()> {
    let (work, rust) = (work(), work().join("rust"));
    let packages = work.join("packages");
    fs::create_dir_all(packages.join("partial"))?;
    download(&packages, &PACKAGES)?;
    unpack(&packages, &rust)?;
    let libraries = rust.join("usr/lib/x86_64-linux-gnu");
    wrap("rustc", &libraries, &rust.join("usr/bin/rustc"))?;
    let version = Command::new(tool("rustc")).arg("-vV").output()?;
    let version = String::from_utf8(version.stdout)?;
    let llvm = version.lines().find_map(|line| line.strip_prefix("LLVM version: "));
    let llvm = llvm.and_then(|version| version.split('.').next()).context("its version is not told")?;
    download(&packages, &[&format!("lld-{llvm}")])?;
    unpack(&packages, &rust)?;
    wrap("wasm-ld", &libraries, &rust.join(format!("usr/lib/llvm-{llvm}/bin/wasm-ld")))?;
    standard_library(&work.join("std"))
}

fn download(packages: &Path, names: &[&str]) -> Result<()> {
    let archives = format!("Dir::Cache::archives={}", packages.display());
    let options = ["install", "--yes", "--no-install-recommends", "--download-only", "-o", &archives];
    let apt = |words: &[&str]| {
        let sudo = !succeeds(Command::new("sh").args(["-c", "test \"$(id -u)\" = 0"]));
        let mut command = Command::new(if sudo { "sudo" } else { "apt-get" });
        if sudo {
            command.args(["-n", "apt-get"]);
        }
        succeeds(command.args(words))
    };
    let words = [&options, names].concat();
    ensure!(apt(&words) || (apt(&["update"]) && apt(&words)), "apt-get has no {}", names.join(", "));
    Ok(())
}

fn unpack(packages: &Path, folder: &Path) -> Result<()> {
    for entry in fs::read_dir(packages)? {
        let package = entry?.path();
        if package.extension().is_some_and(|ending| ending == "deb") {
            let unpacked = succeeds(Command::new("dpkg-deb").arg("-x").arg(&package).arg(folder));
            ensure!(unpacked, "not unpacked: {}", package.display());
            fs::remove_file(package)?;
        }
    }
    Ok(())
}

/// Writes a script that runs a program with the libraries that it was unpacked with.
fn wrap(name: &str, libraries: &Path, program: &Path) -> Result<()> {
    let script = tool(name);
    fs::create_dir_all(script.parent().context("tools lie in a folder")?)?;
    let text = format!(
        "#!/bin/sh\nexport LD_LIBRARY_PATH=\"{}\"\nexec \"{}\" \"$@\"\n",
        libraries.display(),
        program.display()
    );
    fs::write(&script, text)?;
    ensure!(succeeds(Command::new("chmod").arg("+x").arg(&script)), "not executable: {}", script.display());
    Ok(())
}

/// Compiles the standard library with an empty crate, and puts it where the compiler looks. Later builds need nothing
/// unstable.
fn standard_library(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder.join("src"))?;
    let manifest = "[package]\nname = \"empty\"\nedition = \"2024\"\n[workspace]\n";
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::write(folder.join("src/lib.rs"), "")?;
    let compiler = Compiler { other: Some([tool("rustc"), tool("wasm-ld")]) };
    let words = ["build", "--release", "--target", TARGET, "-Z", "build-std=std,panic_abort"];
    let mut build = compiler.cargo(&words);
    // The module is optimised as a whole, with what it takes of the standard library.
    let flags = format!("{FLAGS} -C embed-bitcode=yes");
    build.current_dir(folder).env("RUSTC_BOOTSTRAP", "1").env_remove("CARGO_TARGET_DIR");
    build.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", flags);
    ensure!(succeeds(&mut build), "the standard library does not compile");
    let Some(library) = library(&tool("rustc")) else { bail!("the compiler does not know {TARGET}") };
    fs::create_dir_all(&library)?;
    for entry in fs::read_dir(folder.join("target").join(TARGET).join("release/deps"))? {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name()))?;
        let is_library = path.extension().is_some_and(|ending| ending == "rlib");
        if is_library && !name.to_string_lossy().starts_with("libempty-") {
            fs::copy(&path, library.join(name))?;
        }
    }
    Ok(())
}
