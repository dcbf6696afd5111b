//! One stage, one stem: a stage listed in a recipe has files of its name, a timer label and a row
//! in ARCHITECTURE.md's stage table, and nothing there is without a stage.

use std::collections::BTreeSet;
use std::path::Path;

use crate::cargo::root;

/// A crate with stages and the file that lists them.
struct Recipe {
    crate_folder: &'static str,
    /// The files that list them, for each backend, and the ending of a kernel where there is one.
    backends: &'static [Backend],
    stages: &'static [&'static str],
}

/// A backend of a crate: its folder, the file that lists its stages, and the endings of the files of
/// a stage.
struct Backend {
    folder: &'static str,
    list: &'static str,
    endings: &'static [&'static str],
}

const RECIPES: [Recipe; 2] = [
    Recipe {
        crate_folder: "crates/sim",
        backends: &[
            Backend { folder: "cpu", list: "src/step.rs", endings: &["rs"] },
            Backend { folder: "gpu", list: "src/gpu/step.rs", endings: &["rs", "wesl"] },
        ],
        stages: &[
            "pose_roots",
            "integrate",
            "constrain",
            "solve_rods",
            "splat",
            "mark",
            "solve_pressure",
            "gather",
            "advance",
        ],
    },
    Recipe {
        crate_folder: "crates/render",
        backends: &[
            Backend { folder: "cpu", list: "src/frame.rs", endings: &["rs"] },
            Backend { folder: "gpu", list: "src/gpu/frame.rs", endings: &["rs", "wesl"] },
        ],
        stages: &["tessellate", "interpolate", "opacity_depth", "opacity_layers", "shade", "draw", "resolve"],
    },
];

/// Prints every stage that lacks its file, its line or its row. True when none does.
pub fn check() -> bool {
    let problems = problems(root());
    for problem in &problems {
        eprintln!("names: {problem}");
    }
    if problems.is_empty() {
        println!("names: every stage has one name everywhere");
    }
    problems.is_empty()
}

fn problems(root: &Path) -> Vec<String> {
    let rows = table_rows(&read(&root.join("ARCHITECTURE.md")));
    let parity = read_all(&root.join("checks/parity"));
    let mut known = BTreeSet::new();
    let mut found = Vec::new();
    for recipe in &RECIPES {
        for backend in recipe.backends {
            found.extend(missing_in_backend(root, recipe, backend));
        }
        for stage in recipe.stages {
            known.insert((*stage).to_owned());
            if recipe.backends.len() > 1 && !parity.contains(&format!("fn {stage}_")) {
                found.push(format!("{stage}: no check in checks/parity named after it"));
            }
            if !rows.contains(*stage) {
                found.push(format!("{stage}: no row in ARCHITECTURE.md's stage table"));
            }
        }
    }
    found.extend(
        rows.difference(&known).map(|row| format!("{row}: a row in ARCHITECTURE.md without a stage")),
    );
    found
}

/// Stages without their files or their timer label in one backend.
fn missing_in_backend(root: &Path, recipe: &Recipe, backend: &Backend) -> Vec<String> {
    let list_file = format!("{}/{}", recipe.crate_folder, backend.list);
    let list = read(&root.join(&list_file));
    let mut found = Vec::new();
    for stage in recipe.stages {
        for ending in backend.endings {
            let file = format!("{}/src/{}/{stage}.{ending}", recipe.crate_folder, backend.folder);
            if !root.join(&file).is_file() {
                found.push(format!("{stage}: no file {file}"));
            }
        }
        if !list.contains(&format!("\"{stage}\"")) {
            found.push(format!("{stage}: no timer label \"{stage}\" in {list_file}"));
        }
    }
    found
}

/// The text of every file of a folder.
fn read_all(folder: &Path) -> String {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    files.map(|file| read(&file.path())).collect()
}

/// The first cells, in backquotes, of the table under the heading "Stages".
fn table_rows(text: &str) -> BTreeSet<String> {
    text.lines()
        .skip_while(|line| !line.starts_with("## Stages"))
        .skip(1)
        .take_while(|line| !line.starts_with("## "))
        .filter_map(|line| line.strip_prefix("| `")?.split('`').next().map(str::to_owned))
        .collect()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_from_the_stage_table_only() {
        let text = "| `no` |\n## Stages\n| stage | x |\n|---|---|\n| `splat` | per face |\n## Next\n| `no` |";
        assert_eq!(table_rows(text), BTreeSet::from(["splat".to_owned()]));
    }

    #[test]
    fn an_empty_folder_lacks_everything() {
        let folder = std::env::temp_dir().join("strandline-names-of-nothing");
        // A row each; a file and a label on the CPU; two files, a label and a check on the GPU.
        assert_eq!(problems(&folder).len(), (9 + 7) * (1 + 2 + 4));
    }
}
