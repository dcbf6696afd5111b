//! docs/cli.md is written from the arguments of the program, and measured figures of README.md are those of bench.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::{Arg, Args, Command, CommandFactory};
use serde_json::Value;

use crate::arguments::{Arguments, Inputs};

/// Rows of measured figures: words of the row, file of bench, place in it, decimals and unit.
const MEASURED: [(&str, &str, &str, usize, &str); 5] = [
    ("11,400 strands of 16 points", "scaling", "/results/aims/2/run/ms_per_step/median", 0, "ms"),
    ("1,750 strands of 6 points", "scaling", "/results/aims/1/run/ms_per_step/median", 1, "ms"),
    ("560,000 segments", "thesis", "/results/pictures_on_cpu/ms_alone/median", 0, "ms"),
    ("placed by 2,000 guides", "groom", "/results/bound/0/ms", 0, "ms"),
    ("48,000 strands", "groom", "/results/first_pictures/0/seconds", 1, "s"),
];

/// Rows of README.md beside others: words of the row, times of ours and of the other in bench/peers.json, words before the
/// ratio.
const BESIDE: [(&str, &str, &str, &str); 3] = [
    (
        "11,400 strands of 16 points",
        "/steps/strandline, rods, 2 threads",
        "/steps/Jolt, two halves of the hair on 2 threads",
        "Jolt's hair on two threads: ",
    ),
    (
        "1,750 strands of 6 points",
        "/sizes/1,750 x 6, 32^3/rods_ms",
        "/sizes/1,750 x 6, 32^3/jolt_2_threads_ms",
        "Jolt's hair on two threads: ",
    ),
    (
        "560,000 segments",
        "/pictures_800x600/strandline, the thesis's look/171,000 segments",
        "/pictures_800x600/Cycles, 1 sample per pixel/171,000 segments",
        "Cycles, 1 sample per pixel: ",
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap()
}

/// The page of all commands.
fn page() -> String {
    let mut program = Arguments::command();
    program.build();
    let mut page =
        "# Commands\n\n<!-- Written by `cargo xtask docs` from the arguments of the program. -->\n\n"
            .to_owned();
    let about = program.get_long_about().or(program.get_about()).unwrap();
    writeln!(page, "{about}\n\n| argument of every command | meaning |\n|---|---|").unwrap();
    page.extend(program.get_arguments().filter(|argument| argument.is_global_set()).map(row));
    let inputs = Inputs::augment_args(Command::new("inputs"));
    page.push_str("\n| input of `view`, `render` and `sim` | meaning |\n|---|---|\n");
    page.extend(inputs.get_arguments().map(row));
    for command in program.get_subcommands().filter(|command| command.get_name() != "help") {
        page.push_str(&section(command, &inputs));
    }
    page
}

/// A command: its purpose, its usage, and a row for each argument that is no input of several commands.
fn section(command: &Command, inputs: &Command) -> String {
    let is_input = |argument: &Arg| {
        let same =
            |input: &Arg| input.get_id() == argument.get_id() && input.get_help() == argument.get_help();
        inputs.get_arguments().any(same)
    };
    let usage = command.clone().render_usage().to_string();
    let mut section = format!(
        "\n## {}\n\n{}\n\n```\n{}\n```\n",
        command.get_name(),
        command.get_about().unwrap(),
        usage.trim_start_matches("Usage: ").trim()
    );
    let own = command.get_arguments().filter(|argument| !argument.is_global_set() && !is_input(argument));
    let rows: String = own.map(row).collect();
    if !rows.is_empty() {
        write!(section, "\n| argument | meaning |\n|---|---|\n{rows}").unwrap();
    }
    if let Some(after) = command.get_after_help() {
        write!(section, "\n```\n{}\n```\n", after.to_string().trim_end()).unwrap();
    }
    section
}

/// An argument with its help, its choices and its default; empty for `--help`.
fn row(argument: &Arg) -> String {
    if ["help", "version"].contains(&argument.get_id().as_str()) {
        return String::new();
    }
    let values = argument.get_value_names().unwrap_or_default().join(" ");
    let name = match argument.get_long() {
        Some(long) if argument.get_action().takes_values() => format!("--{long} {values}"),
        Some(long) => format!("--{long}"),
        None => values,
    };
    let help = argument.get_long_help().or(argument.get_help()).unwrap().to_string();
    let choices: Vec<String> = argument
        .get_possible_values()
        .iter()
        .filter(|_| argument.get_action().takes_values())
        .map(|choice| match choice.get_help() {
            Some(help) => format!("`{}`: {help}", choice.get_name()),
            None => format!("`{}`", choice.get_name()),
        })
        .collect();
    let default: Vec<_> = argument.get_default_values().iter().map(|value| value.to_string_lossy()).collect();
    let mut cell = help.trim_end_matches('.').to_owned() + ".";
    if !choices.is_empty() {
        write!(cell, " {}", choices.join(" ")).unwrap();
    }
    if !default.is_empty() && argument.get_action().takes_values() {
        write!(cell, " [default: {}]", default.join(" ")).unwrap();
    }
    format!("| `{}` | {} |\n", name.replace('|', "\\|"), cell.replace('|', "\\|"))
}

/// A file of bench.
fn bench(file: &str) -> Value {
    serde_json::from_str(&read(&format!("bench/{file}.json"))).unwrap()
}

/// Rows of the README that do not show the figure of bench, or the ratio to another program.
fn other_figures(document: &str) -> Vec<String> {
    let absent = |words: &str, shown: &str| {
        let found = document.lines().any(|line| line.contains(words) && line.contains(shown));
        (!found).then(|| format!("no row of \"{words}\" has `{shown}`"))
    };
    let figures = MEASURED.iter().filter_map(|&(words, file, place, decimals, unit)| {
        let figure = bench(file).pointer(place).and_then(Value::as_f64).unwrap();
        absent(words, &format!("| {figure:.decimals$} {unit}"))
    });
    let peers = bench("peers");
    let ratios = BESIDE.iter().filter_map(|&(words, ours, other, before)| {
        let [ours, other] = [ours, other].map(|place| {
            let row = peers.pointer(place).unwrap();
            row.get("ms").unwrap_or(row)["median"].as_f64().unwrap()
        });
        absent(words, &format!("{before}{:.1} times", other / ours))
    });
    figures.chain(ratios).collect()
}

/// Rows of the tables beside others that a document lacks.
fn lacking_rows(document: &str) -> Vec<String> {
    let peers = bench("peers");
    let rows = |table: &str| peers[table].as_object().unwrap().clone();
    let steps = rows("steps");
    let ours = steps["strandline, rods, 2 threads"]["ms"]["median"].as_f64().unwrap();
    let steps = steps.iter().map(|(name, row)| {
        let ms = &row["ms"];
        let ratio = ms["median"].as_f64().unwrap() / ours;
        let ratio = if ratio == 1.0 { "1".to_owned() } else { format!("{ratio:.1}") };
        [format!("| {name} "), format!("| {} ({} to {}) | {ratio} |", ms["median"], ms["min"], ms["max"])]
    });
    let pictures = rows("pictures_800x600").into_iter().map(|(name, row)| {
        let cells = ["171,000 segments", "2,052,000 segments"].map(|segments| {
            row[segments]["ms"]["median"].as_u64().map_or_else(|| " |".to_owned(), |ms| format!(" {ms} ms |"))
        });
        [format!("| {name} "), format!("|{}{}", cells[0], cells[1])]
    });
    let lines: Vec<String> = document.lines().map(|line| line.replace(',', "")).collect();
    let shows = |[name, cells]: &[String; 2]| {
        let name = name.replace(',', "");
        lines.iter().any(|line| line.starts_with(name.trim_end()) && line.contains(cells.as_str()))
    };
    steps.chain(pictures).filter(|row| !shows(row)).map(|row| row.concat()).collect()
}

#[test]
fn the_page_of_commands_is_that_of_the_program() {
    let expected = page();
    if std::env::var_os("STRANDLINE_BLESS").is_some() {
        std::fs::write(root().join("docs/cli.md"), &expected).unwrap();
    }
    let found = read("docs/cli.md");
    let first = found.lines().zip(expected.lines()).find(|(found, expected)| found != expected);
    assert!(found == expected, "docs/cli.md differs: run `cargo xtask docs`; first at {first:?}");
}

#[test]
fn measured_figures_of_the_readme_are_those_of_bench() {
    let readme = read("README.md");
    assert_eq!(other_figures(&readme), [""; 0]);
    for (right, wrong) in [("| 50 ms", "| 51 ms"), ("1.6 times", "2.1 times"), ("3.9 times", "3.8 times")] {
        assert_eq!(other_figures(&readme.replace(right, wrong)).len(), 1, "{wrong}");
    }
}

#[test]
fn tables_beside_others_are_those_of_bench() {
    let page = read("docs/performance.md");
    assert_eq!(lacking_rows(&page), [""; 0]);
    for (right, wrong) in [("53.8 to 71.0", "53.8 to 61.0"), ("| 1.6 |", "| 1.7 |"), ("594 ms", "595 ms")] {
        assert_eq!(lacking_rows(&page.replacen(right, wrong, 1)).len(), 1, "{wrong}");
    }
}

#[test]
fn links_of_the_documents_lead_to_files() {
    let folders = ["", "docs", "docs/methods"];
    let mut count = 0;
    for folder in folders {
        for entry in std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.extension().is_none_or(|ending| ending != "md") {
                continue;
            }
            for link in links(&std::fs::read_to_string(&entry).unwrap()) {
                count += 1;
                assert!(entry.parent().unwrap().join(&link).exists(), "{link} in {}", entry.display());
            }
        }
    }
    assert!(count > 60, "only {count} links found");
}

/// Files that a page links to, without addresses of the web and places within pages.
fn links(page: &str) -> Vec<String> {
    let targets = page.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let files = targets.map(|target| target.split('#').next().unwrap_or_default());
    files.filter(|file| !file.is_empty() && !file.contains("://")).map(str::to_owned).collect()
}

#[test]
fn links_are_found_in_pages() {
    let page = "[a](b.md#c) ![d](e/f.png) [g](https://h.i) [j](#k)";
    assert_eq!(links(page), ["b.md", "e/f.png"]);
}

#[test]
fn files_that_the_documents_name_exist() {
    let mut files = Vec::new();
    for folder in ["apps", "bench", "checks", "crates", "docs", "examples", "fuzz", "xtask"] {
        below(&root().join(folder), &mut files);
    }
    let mut documents = vec!["ARCHITECTURE.md".to_owned(), "CONTRIBUTING.md".to_owned()];
    let methods = std::fs::read_dir(root().join("docs/methods")).unwrap();
    documents.extend(methods.map(|page| format!("docs/methods/{}", page.unwrap().file_name().display())));
    let mut count = 0;
    for document in documents {
        for name in paths(&read(&document)) {
            count += 1;
            let endings = ["", ".rs", ".wesl"].map(|ending| format!("/{name}{ending}"));
            let exists = files.iter().any(|file| endings.iter().any(|end| file.ends_with(end.as_str())));
            assert!(exists, "{name} in {document}");
        }
    }
    assert!(count > 20, "only {count} files found");
}

/// Names in backquotes that are paths: words of small letters with slashes between them.
fn paths(page: &str) -> Vec<&str> {
    let quoted = page.split('`').skip(1).step_by(2);
    let is_word = |word: &str| {
        !["", ".."].contains(&word)
            && word.chars().all(|letter| letter.is_ascii_lowercase() || "_.0123456789".contains(letter))
    };
    quoted.filter(|text| text.contains('/') && text.split('/').all(is_word)).collect()
}

/// Adds all files and folders below a folder.
fn below(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        found.push(entry.display().to_string().replace('\\', "/"));
        if entry.is_dir() && !entry.ends_with("target") {
            below(&entry, found);
        }
    }
}

#[test]
fn paths_are_found_in_pages() {
    let page = "`cpu/a_b.rs` and `x::y`, `A/b`, `c/d`, cpu/e `f` `../g`";
    assert_eq!(paths(page), ["cpu/a_b.rs", "c/d"]);
}
