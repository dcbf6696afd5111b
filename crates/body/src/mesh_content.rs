//! Files whose ending meshes and strands share: told apart by their content.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use crate::MeshFormat;

/// Longest header of a .ply, and most of an .obj that is looked at \[byte\].
const LONGEST_HEADER: u64 = 1 << 16;
const LONGEST_LOOK: u64 = 1 << 30;

impl MeshFormat {
    /// Tells files that hold a mesh by ending and content: a .ply has faces, and an .obj has faces or no lines. An .obj
    /// that cannot be read counts as a mesh, a .ply does not.
    pub fn is_of(path: &Path) -> bool {
        match Self::of(path) {
            Err(_) => false,
            Ok(Self::Gltf | Self::Stl) => true,
            Ok(Self::Ply) => File::open(path).is_ok_and(|file| has_faces(file.take(LONGEST_HEADER))),
            Ok(Self::Obj) => File::open(path).map_or(true, |file| is_mesh(file.take(LONGEST_LOOK))),
        }
    }
}

/// Lines of a file, as bytes; a file that ends early or cannot be read has no more.
fn lines(file: impl Read) -> impl Iterator<Item = Vec<u8>> {
    let lines = BufReader::new(file).split(b'\n').map_while(Result::ok);
    lines.map(|line| line.strip_suffix(b"\r").map_or(line.clone(), <[u8]>::to_vec))
}

/// True for a .ply whose header counts faces, or strips of triangles.
fn has_faces(file: impl Read) -> bool {
    let mut header = lines(file).take_while(|line| line != b"end_header");
    header.any(|line| {
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        matches!(words[..], [b"element", b"face" | b"tristrips", count] if count.iter().any(|digit| *digit != b'0'))
    })
}

/// True for an .obj unless its lines come before any face.
fn is_mesh(file: impl Read) -> bool {
    let kind = |line: Vec<u8>| match line.trim_ascii_start() {
        [b'f', b' ' | b'\t', ..] => Some(true),
        [b'l', b' ' | b'\t', ..] => Some(false),
        _ => None,
    };
    lines(file).find_map(kind).unwrap_or(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_and_strands_of_one_ending_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let is_mesh = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            MeshFormat::is_of(&path)
        };
        let ply = "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nelement face COUNT\r\nend_header\r\n";
        assert!(is_mesh("a.ply", &ply.replace("COUNT", "1")));
        assert!(!is_mesh("a.PLY", &ply.replace("COUNT", "0")));
        assert!(!is_mesh("b.ply", "ply\nelement vertex 3\nelement edge 2\nend_header\nelement face 1\n"));
        assert!(is_mesh("a.obj", "v 0 0 0\n\tf 1 2 3\nl 1 2\n") && is_mesh("b.obj", "v 0 0 0\n"));
        assert!(!is_mesh("c.obj", "v 0 0 0\nl 1 2\n"));
        assert!(is_mesh("a.stl", "") && !is_mesh("a.hair", "") && is_mesh("a.glb", ""));
        assert!(!MeshFormat::is_of(Path::new("absent.ply")) && MeshFormat::is_of(Path::new("absent.obj")));
    }
}
