//! Comments name their subject first: they do not begin with a word that turns the sentence around.

use std::path::Path;

use crate::cargo::root;

/// Words that no line of a comment begins with.
const HEADLESS: [&str; 5] = ["What ", "Whether ", "Where ", "Who ", "How "];
/// Folders of code.
const FOLDERS: [&str; 7] = ["apps", "checks", "crates", "examples", "fuzz", "python", "xtask"];
/// Folders that still have such comments. A clean folder must leave the list.
const NOT_YET: [&str; 0] = [];

/// Headless comments outside the listed folders, and listed folders without any.
pub fn problems() -> Vec<String> {
    let mut found = Vec::new();
    for folder in FOLDERS {
        look(&root().join(folder), folder, &mut found);
    }
    judged(&found, &NOT_YET)
}

/// Problems among comments, each with its path in front, for a list of folders that may have some.
fn judged(found: &[String], allowed: &[&str]) -> Vec<String> {
    let below =
        |line: &str, folder: &str| line.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'));
    let new = found.iter().filter(|line| !allowed.iter().any(|folder| below(line, folder))).cloned();
    let clean = allowed.iter().filter(|folder| !found.iter().any(|line| below(line, folder)));
    new.chain(clean.map(|folder| format!("{folder} is clean: take it out of xtask/src/comments.rs")))
        .collect()
}

/// Adds the headless comments of a folder, whose path in the tree is `name`.
fn look(folder: &Path, name: &str, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let file = entry.file_name();
        let file = file.to_string_lossy();
        let name = format!("{name}/{file}");
        if entry.path().is_dir() {
            if file != "target" {
                look(&entry.path(), &name, found);
            }
        } else if file.ends_with(".rs") || file.ends_with(".wesl") {
            let text = std::fs::read_to_string(entry.path()).unwrap_or_default();
            found.extend(
                headless(&text).map(|(line, text)| format!("{name}:{line}: a headless comment: {text}")),
            );
        }
    }
}

/// Lines of comments that begin with one of the words, with their numbers.
fn headless(code: &str) -> impl Iterator<Item = (usize, &str)> {
    code.lines().enumerate().filter_map(|(index, line)| {
        let comment = line.trim_start().strip_prefix("//")?;
        let text = comment.trim_start_matches(['/', '!']).trim_start();
        HEADLESS.iter().any(|word| text.starts_with(word)).then_some((index + 1, text))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headless_comments_are_seen() {
        let code = "//! What it is.\n/// The sum.\n    // Whether it holds.\nlet what = \"// What\";\n/// Whatever.\n//How odd.";
        let lines: Vec<_> = headless(code).map(|(line, _)| line).collect();
        assert_eq!(lines, [1, 3, 6]);
    }

    #[test]
    fn listed_folders_may_have_some_and_must_not_be_clean() {
        let found = ["crates/a/src/lib.rs:1: x".to_owned(), "crates/ab/src/lib.rs:2: y".to_owned()];
        assert_eq!(judged(&found, &["crates/a"]), [found[1].clone()]);
        assert_eq!(judged(&found[..1], &["crates/a", "crates/ab"]).len(), 1);
        assert_eq!(judged(&found, &["crates/a", "crates/ab"]), [""; 0]);
    }
}
