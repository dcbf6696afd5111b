//! Sources of the bytes of a buffer: a file beside the glTF, or text within it.

use std::path::{Path, PathBuf};

use crate::beside;

/// The file that a relative address names, below a folder: `%20` and the like become bytes again.
///
/// `None` for other addresses, for what is one only after that, and for links that lead out of the folder.
pub(super) fn file_below(folder: &Path, uri: &str) -> Option<PathBuf> {
    let mut parts = uri.split('%');
    let mut name = parts.next()?.as_bytes().to_vec();
    for part in parts {
        name.push(u8::from_str_radix(part.get(..2)?, 16).ok()?);
        name.extend_from_slice(&part.as_bytes()[2..]);
    }
    beside::file_below(folder, &String::from_utf8(name).ok()?)
}

/// The bytes of text in base 64 \[RFC4648 §4\], with or without `=` at its end.
pub(super) fn from_base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for four in text.chunks(4) {
        let mut bits = 0_u32;
        for digit in four {
            let value = match digit {
                b'A'..=b'Z' => digit - b'A',
                b'a'..=b'z' => digit - b'a' + 26,
                b'0'..=b'9' => digit - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        // Six bits a digit: one digit alone is no byte.
        let count = four.len() * 6 / 8;
        if count == 0 {
            return None;
        }
        bits <<= 32 - 6 * four.len() as u32;
        bytes.extend(&bits.to_be_bytes()[..count]);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_in_base_64_is_read() {
        // [RFC4648 §10]
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg", "foob"),
            ("Zm9vYmFy", "foobar"),
        ] {
            assert_eq!(from_base64(text).as_deref(), Some(bytes.as_bytes()), "{text}");
        }
        assert_eq!(from_base64("+/+/"), Some(vec![0xfb, 0xff, 0xbf]));
        for text in ["Zm9vY", "Zm 9v", "Zm-_", "Zg=v"] {
            assert_eq!(from_base64(text), None, "{text}");
        }
    }
}
