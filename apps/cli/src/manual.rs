//! `strandline completions` and `man`: what clap knows of the commands, for shells and for `man`.

use clap::CommandFactory;
use strandline::file::WholeFile;

use crate::arguments::{Arguments, CompletionOptions, ManOptions};
use crate::output;

/// Name of the program.
const PROGRAM: &str = "strandline";

/// Prints the completions for a shell.
pub fn completions(options: &CompletionOptions) -> anyhow::Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Arguments::command(), PROGRAM, &mut text);
    output::program(&String::from_utf8_lossy(&text));
    Ok(())
}

/// Writes a page for the program and one for each command.
pub fn pages(options: &ManOptions) -> anyhow::Result<()> {
    let folder = &options.folder;
    let made = std::fs::create_dir_all(folder);
    made.map_err(|error| anyhow::anyhow!("cannot make the folder: {error}: {}", folder.display()))?;
    let mut program = Arguments::command();
    program.build();
    // Commands are named as pages are: `strandline-render`.
    let commands: Vec<clap::Command> = program.get_subcommands().cloned().collect();
    let count = commands.len() + 1;
    for command in std::iter::once(program).chain(commands) {
        let name = command.get_display_name().unwrap_or(command.get_name());
        let path = folder.join(format!("{name}.1"));
        let mut page = Vec::new();
        clap_mangen::Man::new(command).render(&mut page)?;
        let saved = WholeFile::save(&path, &page);
        saved.map_err(|error| anyhow::anyhow!("cannot write the page: {error}: {}", path.display()))?;
    }
    crate::output::print_line!("wrote {count} pages: look at `man {}/{PROGRAM}.1`", folder.display());
    Ok(())
}
