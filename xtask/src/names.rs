//! One stage, one stem: a stage listed in a recipe has files of its name, a timer label and a row
//! in ARCHITECTURE.md's stage table, and every row there has a stage.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::cargo::root;
use crate::comments;

/// A crate with stages: its CPU backend says which there are.
struct Recipe {
    crate_folder: &'static str,
    cpu: Backend,
    gpu: Backend,
}

/// A backend of a crate: its folder, the file that lists its stages in order, each with its timer label, and the
/// endings of the files of a stage.
struct Backend {
    folder: &'static str,
    list: &'static str,
    endings: &'static [&'static str],
}

const RECIPES: [Recipe; 2] = [
    Recipe {
        crate_folder: "crates/sim",
        cpu: Backend { folder: "cpu", list: "src/step.rs", endings: &["rs"] },
        gpu: Backend { folder: "gpu", list: "src/step.rs", endings: &["rs", "wesl"] },
    },
    Recipe {
        crate_folder: "crates/render",
        cpu: Backend { folder: "cpu", list: "src/frame.rs", endings: &["rs"] },
        gpu: Backend { folder: "gpu", list: "src/gpu/frame.rs", endings: &["rs", "wesl"] },
    },
];

/// Prints every stage that lacks its file, its line or its row. True if all are complete.
pub fn check() -> bool {
    let mut problems = problems(root());
    problems.extend(comments::problems());
    for problem in &problems {
        eprintln!("names: {problem}");
    }
    if problems.is_empty() {
        println!("names: every stage has one name everywhere, and comments name their subject first");
    }
    problems.is_empty()
}

fn problems(root: &Path) -> Vec<String> {
    let rows = table_rows(&read(&root.join("ARCHITECTURE.md")));
    let parity = read_all(&root.join("checks/parity"));
    let mut known = BTreeSet::new();
    let mut found = Vec::new();
    for recipe in &RECIPES {
        let stages = timed(&read(&root.join(recipe.list(&recipe.cpu))));
        if stages.is_empty() {
            found.push(format!("no stage is timed in {}", recipe.list(&recipe.cpu)));
        }
        for backend in [&recipe.cpu, &recipe.gpu] {
            found.extend(recipe.missing(root, backend, &stages));
        }
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
    /// The file in which a backend lists its stages.
    fn list(&self, backend: &Backend) -> String {
        format!("{}/{}", self.crate_folder, backend.list)
    }

    /// Stages without their files or their timer label in one backend. The files may lie in any folder of the
    /// backend; a folder that is called after its stage has it in its `mod.rs`.
    fn missing(&self, root: &Path, backend: &Backend, stages: &[String]) -> Vec<String> {
        let list = read(&root.join(self.list(backend)));
        let folder = format!("{}/src/{}", self.crate_folder, backend.folder);
        let files = files_below(&root.join(&folder));
        let mut found = Vec::new();
        for stage in stages {
            for ending in backend.endings {
                let file = format!("{stage}.{ending}");
                let room = format!("{stage}/mod.{ending}");
                if !files.iter().any(|path| path.ends_with(&file) || path.ends_with(&room)) {
                    found.push(format!("{stage}: no file {file} below {folder}"));
                }
            }
            if !list.contains(&format!("\"{stage}\"")) {
                found.push(format!("{stage}: no timer label \"{stage}\" in {}", self.list(backend)));
            }
        }
        found
    }
}

/// The stages that a text lists: the names in its calls of `timed`, or in its lines of `stages!`.
fn timed(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let calls = code.split("timed(").skip(1);
    let called = calls.filter_map(|call| Some(call.split(';').next()?.split('"').nth(1)?.to_owned()));
    let lines = code.lines().filter(|line| line.ends_with(';'));
    let named = lines.filter_map(|line| Some(line.split_once(" = \"")?.1.split_once("\", ")?.0.to_owned()));
    called.chain(named).collect()
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
    fn stages_are_those_that_are_timed() {
        let list = "use x::timed;\ntimed(seconds, \"splat\", || splat());\nlet a = timed(\n    s,\n    \"mark\", f);\n\
                    fn timed(s: S);\n#[cfg(test)]\nmod tests { timed(s, \"no\", f); }";
        assert_eq!(timed(list), ["splat", "mark"]);
        assert_eq!(timed("stages! {\n    /// Sorted.\n    Splat = \"splat\", volume;\n}\n"), ["splat"]);
    }

    #[test]
    fn a_stage_lies_in_any_folder_of_its_backend_and_a_longer_name_is_another() {
        let folder = tempfile::tempdir().unwrap();
        let backend = Backend { folder: "cpu", list: "list.rs", endings: &["rs"] };
        let recipe =
            Recipe { crate_folder: "a", cpu: backend, gpu: Backend { folder: "gpu", ..RECIPES[0].gpu } };
        let cpu = folder.path().join("a/src/cpu");
        for file in ["draw/mod.rs", "shadow/depth.rs", "shadow/other_sort.rs"] {
            std::fs::create_dir_all(cpu.join(file).parent().unwrap()).unwrap();
            std::fs::write(cpu.join(file), "").unwrap();
        }
        std::fs::write(folder.path().join("a/list.rs"), "\"draw\" \"depth\" \"sort\"").unwrap();
        let stages = ["draw", "depth", "sort"].map(str::to_owned);
        let missing = recipe.missing(folder.path(), &recipe.cpu, &stages);
        assert_eq!(missing, ["sort: no file sort.rs below a/src/cpu"]);
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
        std::fs::write(folder.path().join("crates/sim/src/step.rs"), "timed(s, \"new\", f);").unwrap();
        // A file on the CPU; two files on the GPU; a check and a row; and no stage of pictures.
        assert_eq!(problems(folder.path()).len(), 1 + 2 + 2 + 1);
    }
}
