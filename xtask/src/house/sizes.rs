//! Lengths of files and functions.

use super::text::braced;

/// The functions of blanked Rust or WESL code that are longer than `most` lines: their names and lines.
pub fn long_functions(code: &str, most: usize) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    let mut begin = 0;
    while let Some(at) = code[begin..].find("fn ").map(|at| begin + at) {
        begin = at + 3;
        let before = code[..at].chars().next_back();
        if before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_') {
            continue;
        }
        let item = &code[at..];
        let name: String =
            item[3..].chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect();
        // A declaration ends without a body.
        let Some(end) = body(item).and_then(|open| Some(open + braced(&item[open..])?)) else { continue };
        let lines = item[..end].lines().count();
        if !name.is_empty() && lines > most {
            found.push((name, lines));
        }
    }
    found
}

/// Place where the body of a function opens; `None` without a body.
fn body(item: &str) -> Option<usize> {
    let mut depth = 0;
    for (at, letter) in item.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            '{' if depth == 0 => return Some(at),
            ';' if depth == 0 => return None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_long_functions_are_found() {
        let long = format!("fn long(\n a: [u8; 3]) {{\n{}}}\n", "    a();\n".repeat(5));
        let code = format!("trait T {{ fn none(a: [u8; 3]); }}\nfn short() {{\n}}\n{long}");
        assert!(long_functions(&code, 8).is_empty());
        assert_eq!(long_functions("fn a() {\n\n\n}\nfn b();", 3), [("a".to_owned(), 4)]);
    }
}
