//! The encoding of text files, and counts in sentences.

use std::borrow::Cow;
use std::fmt::Display;

/// A count and the words behind it, for one and for another number: "1 strand is", "2 strands are".
pub fn counted<N: Display + PartialEq + From<u8>>(count: N, one: &str, others: &str) -> String {
    let words = if count == N::from(1) { one } else { others };
    format!("{count} {words}")
}

/// Text of a file as UTF-8: without the byte order mark that some editors put before it, and from UTF-16 where such
/// a mark says so. Other bytes stay as they are.
pub fn utf8_text(bytes: &[u8]) -> Cow<'_, [u8]> {
    let wide = |rest: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = rest.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        let text: String =
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        Cow::Owned(text.into_bytes())
    };
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => Cow::Borrowed(rest),
        [0xFF, 0xFE, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => wide(rest, u16::from_be_bytes),
        _ => Cow::Borrowed(bytes),
    }
}

/// Text of a file as [`utf8_text`], one line for each statement: a backslash at the end of a line continues it with
/// the next one. Lines may end with a carriage return alone.
pub fn whole_lines(bytes: &[u8]) -> Cow<'_, [u8]> {
    let mut text = utf8_text(bytes);
    if !text.contains(&b'\n') && text.contains(&b'\r') {
        text.to_mut().iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
    }
    if !text.windows(2).any(|pair| matches!(pair, b"\\\n" | b"\\\r")) {
        return text;
    }
    let mut lines = Vec::with_capacity(text.len());
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        match line.trim_ascii_end().strip_suffix(b"\\") {
            Some(begun) => {
                lines.extend_from_slice(begun);
                lines.push(b' ');
            }
            None => lines.extend_from_slice(line),
        }
    }
    Cow::Owned(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_left_out_and_wide_text_becomes_utf_8() {
        let text = "v 1 2 3\n# ä";
        let wide = |unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
            ['\u{FEFF}'].into_iter().chain(text.chars()).flat_map(|c| unit(c as u16)).collect()
        };
        for bytes in [
            text.as_bytes().to_vec(),
            [b"\xEF\xBB\xBF", text.as_bytes()].concat(),
            wide(u16::to_le_bytes),
            wide(u16::to_be_bytes),
        ] {
            assert_eq!(&*utf8_text(&bytes), text.as_bytes());
        }
        assert_eq!(&*utf8_text(&[0xFF, 0xFE, 0x00, 0xD8, 0x61]), "\u{FFFD}".as_bytes(), "a half pair");
        assert_eq!(&*utf8_text(&[0xFF]), [0xFF]);
    }

    #[test]
    fn one_is_singular_and_every_other_count_plural() {
        let told = |count: usize| counted(count, "strand is", "strands are");
        assert_eq!(
            [0, 1, 2, 21].map(told),
            ["0 strands are", "1 strand is", "2 strands are", "21 strands are"]
        );
    }

    #[test]
    fn continued_lines_become_one() {
        assert_eq!(&*whole_lines(b"l 1 2\\\n 3\nl 4 \\\r\n5\n"), b"l 1 2  3\nl 4  5\n");
        assert!(matches!(whole_lines(b"l 1 2\n"), Cow::Borrowed(b"l 1 2\n")));
        assert_eq!(&*whole_lines(b"v 1\rl 1 2 \\\r3\r"), b"v 1\nl 1 2  3\n", "lines of old Macs");
    }
}
