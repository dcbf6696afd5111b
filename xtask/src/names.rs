//! One stage, one stem: a stage listed in a recipe has a file of its name, a timer label and a row
//! in ARCHITECTURE.md's stage table, and nothing there is without a stage.

use std::collections::BTreeSet;
use std::path::Path;

use crate::run::root;

/// A crate with stages and the file that lists them.
struct Recipe {
    crate_folder: &'static str,
    list: &'static str,
    stages: &'static [&'static str],
}

const RECIPES: [Recipe; 2] = [
    Recipe {
        crate_folder: "crates/sim",
        list: "src/step.rs",
        stages: &[
            "pose_roots",
            "integrate",
            "constrain",
            "splat",
            "mark",
            "solve_pressure",
            "gather",
            "advance",
        ],
    },
    Recipe {
        crate_folder: "crates/render",
        list: "src/frame.rs",
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
    let mut known = BTreeSet::new();
    let mut found = Vec::new();
    for recipe in &RECIPES {
        let list = read(&root.join(recipe.crate_folder).join(recipe.list));
        for stage in recipe.stages {
            known.insert((*stage).to_owned());
            let file = format!("{}/src/cpu/{stage}.rs", recipe.crate_folder);
            if !root.join(&file).is_file() {
                found.push(format!("{stage}: no file {file}"));
            }
            if !list.contains(&format!("\"{stage}\"")) {
                let file = format!("{}/{}", recipe.crate_folder, recipe.list);
                found.push(format!("{stage}: no timer label \"{stage}\" in {file}"));
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
        assert_eq!(problems(&folder).len(), 3 * (8 + 7));
    }
}
