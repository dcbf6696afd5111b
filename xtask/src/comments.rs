//! English that a reader need not turn around: comments, docstrings and documents name their subject first, and no name
//! comes from the theatre.

use std::path::Path;

use crate::cargo::root;

/// Words that no comment begins with.
const HEADLESS: [&str; 8] =
    ["What ", "Whether ", "Where ", "Who ", "How ", "Which ", "That of ", "Those of "];
/// Words that no sentence begins with, in documents either.
const SUBJECTS: [&str; 2] = ["What ", "Whether "];
/// Signs before the beginning of a sentence.
const ENDS: [&str; 8] = [". ", ": ", "? ", "! ", "| ", ".) ", "** ", "- "];
/// Names of the theatre and the court.
const THEATRE: [&str; 5] = ["Course", "Desk", "Scribe", "Sitting", "Studio"];
/// Folders of code and documents.
const FOLDERS: [&str; 9] =
    ["apps", "bench", "checks", "crates", "docs", "examples", "fuzz", "python", "xtask"];
/// This file, which has all of these words.
const OWN: &str = "xtask/src/comments.rs";

/// Places where the English is not so.
pub fn problems() -> Vec<String> {
    let mut found = Vec::new();
    for (name, entry) in entries(root()) {
        if entry.is_file() && name.ends_with(".md") {
            found.extend(wrong(&name, &read(&entry)));
        }
    }
    for folder in FOLDERS {
        look(&root().join(folder), folder, &mut found);
    }
    found
}

/// Adds the problems of a folder, whose path in the tree is `name`.
fn look(folder: &Path, name: &str, found: &mut Vec<String>) {
    for (file, entry) in entries(folder) {
        let name = format!("{name}/{file}");
        if !entry.is_dir() {
            if name != OWN && [".rs", ".wesl", ".py", ".md"].iter().any(|ending| file.ends_with(ending)) {
                found.extend(wrong(&name, &read(&entry)));
            }
        } else if file != "target" {
            look(&entry, &name, found);
        }
    }
}

/// Names and paths of the entries of a folder, by name.
fn entries(folder: &Path) -> Vec<(String, std::path::PathBuf)> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut named: Vec<_> =
        entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path())).collect();
    named.sort();
    named
}

fn read(file: &Path) -> String {
    std::fs::read_to_string(file).unwrap_or_default()
}

/// Problems of a file, each with its place.
fn wrong(file: &str, text: &str) -> Vec<String> {
    let mut is_code = false;
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        let mut problem =
            |what: &str, text: &str| found.push(format!("{file}:{}: {what}: {text}", index + 1));
        is_code ^= file.ends_with(".md") && line.starts_with("```");
        let prose = prose(file, line).filter(|_| !is_code);
        if let Some((text, words)) = prose
            && (begins(text, words) || sentences(text).any(|sentence| begins(sentence, &SUBJECTS)))
        {
            problem("a headless sentence", text);
        }
        if let Some(word) = THEATRE.iter().find(|word| has_word(line, word)) {
            problem("a word of the theatre", word);
        }
    }
    found
}

/// The prose of a line of a file, and the words that it must not begin with: a comment, the first line of a docstring, a
/// line of a document. Further lines of a docstring are not told from code.
fn prose<'a>(file: &str, line: &'a str) -> Option<(&'a str, &'static [&'static str])> {
    if file.ends_with(".md") {
        return Some((line.trim_start_matches(['#', '*', '|', '>', ' ']), &SUBJECTS));
    }
    let text = match file.ends_with(".py") {
        true => line.strip_prefix("\"\"\"").or_else(|| line.strip_prefix('#'))?,
        false => line.strip_prefix("//")?.trim_start_matches(['/', '!']),
    };
    Some((text.trim_start(), &HEADLESS))
}

fn begins(text: &str, words: &[&str]) -> bool {
    words.iter().any(|word| text.starts_with(word))
}

/// The texts behind the beginnings of further sentences of a line.
fn sentences(text: &str) -> impl Iterator<Item = &str> {
    ENDS.iter().flat_map(move |end| text.match_indices(end).map(move |(at, end)| &text[at + end.len()..]))
}

/// True for a line that has the word by itself.
fn has_word(line: &str, word: &str) -> bool {
    let is_part =
        |letter: Option<char>| letter.is_some_and(|letter| letter.is_alphanumeric() || letter == '_');
    line.match_indices(word).any(|(at, _)| {
        !is_part(line[..at].chars().next_back()) && !is_part(line[at + word.len()..].chars().next())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of the lines with problems.
    fn lines(file: &str, text: &str) -> Vec<usize> {
        let number = |problem: &String| problem.split(':').nth(1).and_then(|number| number.parse().ok());
        wrong(file, text).iter().filter_map(number).collect()
    }

    #[test]
    fn headless_comments_are_seen() {
        let code = "//! What it is.\n/// The sum.\n    // Whether it holds.\nlet what = \"// What\";\n/// Whatever.\n\
                    //How odd.\n/// A sum. What is left is none.\n/// A sum. Where it is, it is.";
        assert_eq!(lines("a/lib.rs", code), [1, 3, 6, 7]);
        assert_eq!(
            lines("a/sum.wesl", "// One thread per cell.\n// It adds: whether it may. Whether it did."),
            [2]
        );
    }

    #[test]
    fn headless_docstrings_and_comments_of_python_are_seen() {
        let code = "def a():\n    \"\"\"What it does.\"\"\"\n    # Whether it does.\n    b = \"What is it\"\n\
                    def c():\n    \"\"\"Sums. What is left is none.\"\"\"\n    \"\"\"Sums what is there.\"\"\"";
        assert_eq!(lines("python/a.py", code), [2, 3, 6]);
    }

    #[test]
    fn headless_sentences_of_documents_are_seen() {
        let text = "# What it does\nIt does. What it does not, others do.\n* Whether it does\n| `a` | What it is. |\n\
                    ```\nWhat a terminal prints\n```\nWhatever. It says what it does.\n## How it works\n**So.** What else";
        assert_eq!(lines("docs/a.md", text), [1, 2, 3, 4, 10]);
    }

    #[test]
    fn words_of_the_theatre_are_seen_by_themselves() {
        let code = "struct Studio;\nfn studio() {}\nstruct StudioLight;\n// Of course.\nlet a = Desk::new();";
        assert_eq!(lines("a/lib.rs", code), [1, 5]);
    }
}
