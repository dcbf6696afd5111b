use std::borrow::Cow;
use std::fmt::Write;

/// Characters of a line that are shown.
const LINE: usize = 500;
/// Lines that are shown.
const LINES: usize = 60;

/// Text that may quote a file, for a terminal: characters that could move its cursor, change
/// its colours or turn the direction of writing are spelled out (`\u{1b}`), lines of more than 500 characters
/// and texts of more than 60 lines are cut.
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_fine = |text: &str| {
        !text.contains(is_control)
            && text.lines().count() <= LINES
            && text.lines().all(|line| line.len() <= LINE)
    };
    if is_fine(text) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::new();
    for (index, line) in text.split('\n').enumerate() {
        if index > 0 {
            shown.push('\n');
        }
        if index == LINES {
            shown.push_str("...");
            break;
        }
        push_line(&mut shown, line);
    }
    Cow::Owned(shown)
}

fn push_line(shown: &mut String, line: &str) {
    for (index, character) in line.chars().enumerate() {
        if index == LINE {
            shown.push_str("...");
            break;
        }
        if is_control(character) {
            // Writing to a string never fails.
            let _ = write!(shown, "{}", character.escape_unicode());
        } else {
            shown.push(character);
        }
    }
}

/// True if a terminal may interpret the character as a command.
fn is_control(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        // Marks that turn the direction of writing, and separators of lines.
        '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        other => other.is_control(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_spelled_out() {
        assert_eq!(
            printable("a\u{1b}[2J\u{7}\rb\u{9b}c\u{202e}d"),
            "a\\u{1b}[2J\\u{7}\\u{d}b\\u{9b}c\\u{202e}d"
        );
        for same in ["", "plain", "two\nlines\tand a tab\n", "Größe 長さ"] {
            assert_eq!(printable(same), same);
        }
    }

    #[test]
    fn long_lines_and_texts_are_cut() {
        assert_eq!(printable(&"x".repeat(200_000)), format!("{}...", "x".repeat(LINE)));
        let text = printable(&"y\n".repeat(10_000)).into_owned();
        assert_eq!((text.lines().count(), text.ends_with("\n...")), (LINES + 1, true));
        // Many bytes are not many characters.
        assert_eq!(printable(&"ä".repeat(LINE)), "ä".repeat(LINE));
    }
}
