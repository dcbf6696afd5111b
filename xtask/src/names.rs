//! One stage, one stem: a stage that is listed has files of its name, a check in checks/parity and a row in
//! ARCHITECTURE.md's stage table, and no row there is without a stage. Timers take their labels from the list.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::cargo::root;
use crate::comments;

/// A crate with stages, and the file that lists them in order, with their names: one list for both backends.
struct Recipe {
    crate_folder: &'static str,
    list: &'static str,
}

const RECIPES: [Recipe; 2] = [
    Recipe { crate_folder: "crates/sim", list: "src/step.rs" },
    Recipe { crate_folder: "crates/render", list: "src/frame/mod.rs" },
];

/// The folder of each backend, and the endings of the files of a stage there.
const BACKENDS: [(&str, &[&str]); 2] = [("cpu", &["rs"]), ("gpu", &["rs", "wesl"])];

/// Prints every stage that lacks its file, its line or its row. True if all are complete.
pub fn check() -> bool {
    let mut problems = problems(root());
    problems.extend(comments::problems());
    for problem in &problems {
        eprintln!("names: {problem}");
    }
    if problems.is_empty() {
        println!("names: every stage has one name everywhere, and sentences name their subject first");
    }
    problems.is_empty()
}

fn problems(root: &Path) -> Vec<String> {
    let rows = table_rows(&read(&root.join("ARCHITECTURE.md")));
    let parity = read_all(&root.join("checks/parity"));
    let mut known = BTreeSet::new();
    let mut found = Vec::new();
    for recipe in &RECIPES {
        let list = format!("{}/{}", recipe.crate_folder, recipe.list);
        let stages = listed(&read(&root.join(&list)));
        if stages.is_empty() {
            found.push(format!("no stage is listed in {list}"));
        }
        found.extend(recipe.missing(root, &stages));
        for stage in stages {
            if !parity.contains(&format!("fn {stage}_")) {
                found.push(format!("{stage}: no check in checks/parity named after it"));
            }
            if !rows.contains(&stage) {
                found.push(format!("{stage}: no row in ARCHITECTURE.md's stage table"));
            }
            known.insert(stage);
        }
    }
    found.extend(
        rows.difference(&known).map(|row| format!("{row}: a row in ARCHITECTURE.md without a stage")),
    );
    found
}

impl Recipe {
    /// Files that stages lack in either backend. The files may lie in any folder of it; a folder that is called after
    /// its stage has it in its `mod.rs`.
    fn missing(&self, root: &Path, stages: &[String]) -> Vec<String> {
        let mut found = Vec::new();
        for (backend, endings) in BACKENDS {
            let folder = format!("{}/src/{backend}", self.crate_folder);
            let files = files_below(&root.join(&folder));
            for stage in stages {
                for ending in endings {
                    let file = format!("{stage}.{ending}");
                    let room = format!("{stage}/mod.{ending}");
                    if !files.iter().any(|path| path.ends_with(&file) || path.ends_with(&room)) {
                        found.push(format!("{stage}: no file {file} below {folder}"));
                    }
                }
            }
        }
        found
    }
}

/// The stages that a text lists: the names in its lines of `stages!`.
fn listed(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = code.lines().filter(|line| line.ends_with(';'));
    lines.filter_map(|line| Some(line.split_once(" = \"")?.1.split_once("\", ")?.0.to_owned())).collect()
}

/// The files below a folder.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let paths = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|file| file.path());
    paths.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
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
    fn stages_are_the_lines_of_the_list() {
        let list = "stages! {\n    /// Sorted.\n    Splat = \"splat\", volume;\n    Mark = \"mark\", always;\n}\n\
                    fn f() { g(\"no\", h); }\n#[cfg(test)]\nmod tests {\n    No = \"no\", always;\n}";
        assert_eq!(listed(list), ["splat", "mark"]);
    }

    #[test]
    fn a_stage_lies_in_any_folder_of_its_backend_and_a_longer_name_is_another() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["cpu/draw/mod.rs", "cpu/shadow/depth.rs", "cpu/shadow/other_sort.rs"];
        let all = files.into_iter().chain(["gpu/draw/mod.rs", "gpu/draw/draw.wesl", "gpu/depth.rs"]);
        for file in all.map(|file| folder.path().join("a/src").join(file)) {
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, "").unwrap();
        }
        let recipe = Recipe { crate_folder: "a", list: "list.rs" };
        let missing = recipe.missing(folder.path(), &["draw", "depth", "sort"].map(str::to_owned));
        let expected = ["sort.rs below a/src/cpu", "depth.wesl below a/src/gpu", "sort.rs below a/src/gpu"];
        let expected = expected.map(|file| format!("{}: no file {file}", file.split('.').next().unwrap()));
        assert_eq!(missing[..3], expected);
        assert_eq!(missing.len(), 4);
    }

    #[test]
    fn an_empty_folder_lacks_everything() {
        let folder = std::env::temp_dir().join("strandline-names-of-nothing");
        assert_eq!(problems(&folder).len(), RECIPES.len());
    }

    #[test]
    fn a_stage_that_has_nothing_else_is_missed_everywhere() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("crates/sim/src")).unwrap();
        std::fs::write(folder.path().join("crates/sim/src/step.rs"), "    New = \"new\", always;").unwrap();
        // A file on the CPU; two files on the GPU; a check and a row; and no stage of pictures.
        assert_eq!(problems(folder.path()).len(), 1 + 2 + 2 + 1);
    }
}
