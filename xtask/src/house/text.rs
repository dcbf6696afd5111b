//! Rust code as the other checks want it: comments and strings blanked, tests left out.

/// The same text with comments, strings and characters as blanks; lines stay where they are.
pub fn blanked(code: &str) -> String {
    let mut left = code;
    let mut out = String::with_capacity(code.len());
    while let Some(next) = left.chars().next() {
        let skipped = skipped(left, out.chars().next_back());
        if skipped == 0 {
            out.push(next);
            left = &left[next.len_utf8()..];
        } else {
            out.extend(left[..skipped].chars().map(|letter| if letter == '\n' { '\n' } else { ' ' }));
            left = &left[skipped..];
        }
    }
    out
}

/// Length of the comment, string or character that a text begins with; 0 for other text.
fn skipped(text: &str, before: Option<char>) -> usize {
    if text.starts_with("//") {
        return text.find('\n').unwrap_or(text.len());
    }
    if text.starts_with("/*") {
        return block_comment(text);
    }
    if text.starts_with('"') {
        return quoted(text, 1, '"');
    }
    let in_word = before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_');
    if !in_word && (text.starts_with("r\"") || text.starts_with("r#\"") || text.starts_with("r##\"")) {
        let marks = text[1..].chars().take_while(|letter| *letter == '#').count();
        let end = format!("\"{}", "#".repeat(marks));
        let begin = 2 + marks;
        return text[begin..].find(&end).map_or(text.len(), |at| begin + at + end.len());
    }
    if text.starts_with('\'') {
        // A lifetime has no closing mark behind its first letter.
        let mut letters = text.chars().skip(1);
        let first = letters.next();
        if first == Some('\\') || letters.next() == Some('\'') {
            return quoted(text, 1, '\'');
        }
    }
    0
}

fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        let here = &text[at..];
        if here.starts_with("/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if here.starts_with("*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return at;
            }
        } else {
            at += here.chars().next().map_or(1, char::len_utf8);
        }
    }
    text.len()
}

fn quoted(text: &str, begin: usize, mark: char) -> usize {
    let mut escaped = false;
    for (at, letter) in text[begin..].char_indices() {
        if !escaped && letter == mark {
            return begin + at + letter.len_utf8();
        }
        escaped = !escaped && letter == '\\';
    }
    text.len()
}

/// The text behind a place up to the brace that closes the first one there; `None` if no brace opens.
pub fn braced(text: &str) -> Option<usize> {
    let open = text.find('{')?;
    let mut depth = 0;
    for (at, letter) in text[open..].char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(open + at + 1);
        }
    }
    None
}

/// Blanked code without what only tests compile, and the names of the modules of tests in files of their own.
pub fn without_tests(code: &str) -> (String, Vec<String>) {
    /// A test build alone, or one of some systems.
    const MARKS: [&str; 2] = ["#[cfg(test)]", "#[cfg(all(test,"];
    let (mut out, mut modules, mut left) = (String::new(), Vec::new(), code);
    while let Some(at) = MARKS.iter().filter_map(|mark| left.find(mark)).min() {
        out.push_str(&left[..at]);
        let marked = &left[at..];
        let item = marked.find(']').map_or("", |end| &marked[end + 1..]);
        let end_of_line = item.find(';').map_or(item.len(), |at| at + 1);
        let end = match braced(item) {
            Some(end) if item[..end].find('{').is_some_and(|open| open < end_of_line) => end,
            _ => end_of_line,
        };
        if let Some(name) = item[..end].trim().strip_prefix("mod ").and_then(|name| name.strip_suffix(';')) {
            modules.push(name.trim().to_owned());
        }
        left = &item[end..];
    }
    out.push_str(left);
    (out, modules)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_strings_and_characters_are_blanks() {
        let code = "a // b { \"\n/* c /* d */ e */ 'x' '\\'' \"f\\\"}\" r#\"g\"}\"# 'life h";
        let found = blanked(code);
        assert_eq!(found.split_whitespace().collect::<Vec<_>>(), ["a", "'life", "h"]);
        assert_eq!(found.lines().count(), code.lines().count());
    }

    #[test]
    fn tests_are_left_out_and_their_files_known() {
        let (code, modules) =
            without_tests("fn a() {}\n#[cfg(test)]\nmod tests { fn b() { {} } }\nfn c() {}");
        assert!(code.contains("fn a") && code.contains("fn c") && !code.contains("fn b"));
        assert!(modules.is_empty());
        let (code, modules) = without_tests("#[cfg(test)]\nmod tests;\nmod d { }");
        assert!(code.contains("mod d"));
        assert_eq!(modules, ["tests"]);
        let (code, _) =
            without_tests("fn a() {}\n#[cfg(all(test, unix))]\nmod tests { fn b() {} }\nfn c() {}");
        assert!(code.contains("fn a") && code.contains("fn c") && !code.contains("fn b"));
    }
}
