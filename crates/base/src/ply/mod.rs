//! `.ply` files as tables of numbers, one for each element that is asked for.

mod header;
mod mismatch;
mod rows;

use header::Header;
pub use mismatch::Mismatch;
use rows::Rows;
pub use rows::{Column, Table};

use crate::utf8_text;

/// The contents of a file.
pub struct File<const N: usize> {
    /// The elements asked for, in that order; empty where the file has none of the name.
    pub tables: [Table; N],
    /// The texts of its comments.
    pub comments: Vec<String>,
}

/// Reads elements of a file, binary of either byte order or text, by name, each with the properties that it names;
/// others are skipped.
///
/// # Errors
/// The first place that is not as the format says; sizes are checked before anything is taken for them.
pub fn read<const N: usize>(bytes: &[u8], asked: [(&str, &[&str]); N]) -> Result<File<N>, Mismatch> {
    let bytes = &*utf8_text(bytes);
    let header = Header::new(bytes)?;
    let mut tables = std::array::from_fn(|_| Table::default());
    let mut rows = Rows::new(bytes, &header);
    for element in &header.elements {
        match asked.iter().position(|(name, _)| *name == element.name) {
            Some(at) => tables[at] = rows.read(element, asked[at].1)?,
            None => drop(rows.read(element, &[])?),
        }
    }
    Ok(File { tables, comments: header.comments })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_read_by_name_whatever_marks_the_text() {
        let text = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty float x\nproperty uchar red\n\
                    element face 1\nproperty list uchar int vertex_indices\nend_header\n0.5 7\n1.5 8\n3 0 1 0\n";
        for bytes in [text.as_bytes().to_vec(), [b"\xEF\xBB\xBF", text.as_bytes()].concat()] {
            let file =
                read(&bytes, [("face", &["vertex_indices"]), ("vertex", &["x"]), ("edge", &[])]).unwrap();
            let [faces, vertices, edges] = &file.tables;
            assert_eq!(vertices.numbers("x"), Some(&[0.5, 1.5][..]));
            assert_eq!(vertices.numbers("red"), None, "not asked for");
            assert_eq!(faces.list("vertex_indices").unwrap().lists().collect::<Vec<_>>(), [[0.0, 1.0, 0.0]]);
            assert_eq!((edges.rows, &file.comments[..]), (0, &["made by hand".to_owned()][..]));
        }
        assert_eq!(read::<0>(b"obj", []).err().unwrap().expected, "`ply`");
    }
}
