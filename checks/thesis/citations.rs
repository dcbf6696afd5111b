//! Every citation of \[Chen2011\] names a section, an equation, a figure or a table that its text has.

use std::path::{Path, PathBuf};

/// Its sections, by chapter.
const SECTIONS: [&str; 23] = [
    "1", "1.1", "1.2", "1.3", "2", "2.1", "2.2", "3", "3.1", "3.2", "3.3", "3.4", "3.5", "4", "4.1", "4.2",
    "4.2.1", "4.2.2", "4.2.3", "4.2.4", "5", "6", "7",
];
/// Its last equation, figure and table.
const LAST: [(&str, u32); 3] = [("eq.", 24), ("fig.", 54), ("table", 5)];
/// Folders of citations, below the root of the project.
const FOLDERS: [&str; 8] = ["apps", "bench", "checks", "crates", "docs", "examples", "fuzz", "xtask"];

/// Errors in the citations of a text.
fn wrong(text: &str) -> Vec<String> {
    text.match_indices("Chen2011").filter_map(|(at, key)| wrong_after(&text[at + key.len()..])).collect()
}

/// Error in the citation whose places follow its key.
fn wrong_after(text: &str) -> Option<String> {
    let cited = text.split([']', '\\', ';', '\n']).next().unwrap_or_default();
    // A key without a place; the places that the examples print.
    if !text.starts_with(' ') || cited.contains('{') {
        return None;
    }
    let mut kind = None;
    for place in cited.split(',').map(str::trim) {
        let known = if let Some(section) = place.strip_prefix('§') {
            SECTIONS.contains(&section)
        } else if let Some(letter) = place.strip_prefix("appendix ") {
            ["A", "B", "C"].contains(&letter)
        } else if place.starts_with(|first: char| first.is_ascii_uppercase()) {
            // The key of the next paper.
            return None;
        } else {
            kind = LAST.into_iter().find(|(kind, _)| place.starts_with(kind)).or(kind);
            kind.is_some_and(|(kind, last)| {
                let numbers = place.trim_start_matches(kind).trim();
                numbers.split('-').all(|number| (1..=last).contains(&number.parse().unwrap_or(0)))
            })
        };
        if !known {
            return Some(format!("`{place}` in `Chen2011{cited}`"));
        }
    }
    None
}

/// All text files below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let ending = entry.extension().and_then(|ending| ending.to_str());
        if entry.is_dir() && !entry.ends_with("target") {
            files(&entry, found);
        } else if ending.is_some_and(|ending| ["rs", "wesl", "md", "sh", "toml"].contains(&ending)) {
            found.push(entry);
        }
    }
}

#[test]
fn citations_name_what_the_text_has() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = vec![root.join("ARCHITECTURE.md"), root.join("README.md")];
    FOLDERS.iter().for_each(|folder| files(&root.join(folder), &mut found));
    let mut count = 0;
    for path in found.iter().filter(|path| !path.ends_with(file!())) {
        let text = std::fs::read_to_string(path).unwrap();
        count += text.matches("Chen2011 ").count();
        assert_eq!(wrong(&text), [""; 0], "{}", path.display());
    }
    assert!(count > 60, "only {count} citations found: the folders have moved");
}

#[test]
fn the_comparison_can_fail() {
    let right =
        "[Bridson2008, Chen2011 §4.2.3] [Chen2011 fig. 8, 9] [Chen2011 eq. 4, 19-24; Mueller2007 eq. 9]";
    assert_eq!(wrong(right), [""; 0]);
    for place in
        ["§4.3", "eq. 25", "fig. 8, 55", "table 6", "figure 3", "appendix D", "eq. 0-3", "§4, fig. x"]
    {
        assert_eq!(wrong(&format!("[Chen2011 {place}].")).len(), 1, "{place}");
    }
}
