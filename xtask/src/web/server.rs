//! A server of the page's files for this machine alone.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result};

/// Port at which a person finds the page.
const PORT: u16 = 8040;
/// Longest request line \[byte\].
const LONGEST: u64 = 4096;

/// Kinds of files by their endings.
const KINDS: [(&str, &str); 7] = [
    ("html", "text/html; charset=utf-8"),
    ("css", "text/css; charset=utf-8"),
    ("js", "text/javascript; charset=utf-8"),
    ("wasm", "application/wasm"),
    ("svg", "image/svg+xml"),
    ("webp", "image/webp"),
    ("webmanifest", "application/manifest+json"),
];

/// Serves a folder until the program is stopped.
pub fn serve_until_stopped(folder: &Path) -> Result<()> {
    let listener = TcpListener::bind(("127.0.0.1", PORT)).with_context(|| format!("port {PORT}"))?;
    println!("http://127.0.0.1:{PORT}/ (stop it with Ctrl+C)");
    serve(&listener, folder);
    Ok(())
}

/// Serves a folder at a free port, on a thread that ends with the program; the address.
pub fn serve_beside(folder: &Path) -> Result<String> {
    let listener = TcpListener::bind(("127.0.0.1", 0))?;
    let address = format!("http://{}/", listener.local_addr()?);
    let folder = folder.to_owned();
    std::thread::spawn(move || serve(&listener, &folder));
    Ok(address)
}

fn serve(listener: &TcpListener, folder: &Path) {
    for stream in listener.incoming().flatten() {
        let folder = folder.to_owned();
        std::thread::spawn(move || answer(stream, &folder));
    }
}

fn answer(mut stream: TcpStream, folder: &Path) -> std::io::Result<()> {
    let mut line = String::new();
    std::io::Read::take(BufReader::new(&stream), LONGEST).read_line(&mut line)?;
    let file = named(&line).and_then(|name| Some((fs::read(folder.join(&name)).ok()?, name)));
    let Some((content, name)) = file else {
        return stream.write_all(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    };
    let ending = name.extension().map(|ending| ending.to_string_lossy().into_owned()).unwrap_or_default();
    let kind =
        KINDS.iter().find(|(known, _)| *known == ending).map_or("application/octet-stream", |kind| kind.1);
    let length = content.len();
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(&content)
}

/// File of a request line, below the folder.
fn named(line: &str) -> Option<PathBuf> {
    let path = line.strip_prefix("GET /")?.split([' ', '?']).next()?;
    let path = Path::new(if path.is_empty() { "index.html" } else { path });
    let is_below = path.components().all(|part| matches!(part, Component::Normal(_)));
    is_below.then(|| path.to_owned())
}

#[cfg(test)]
mod unit_tests {
    use super::*;

    #[test]
    fn requests_name_files_below_the_folder_alone() {
        assert_eq!(named("GET / HTTP/1.1"), Some("index.html".into()));
        assert_eq!(named("GET /page.js?1 HTTP/1.1"), Some("page.js".into()));
        for wrong in ["GET /../Cargo.toml HTTP/1.1", "GET //etc/passwd HTTP/1.1", "POST / HTTP/1.1", ""] {
            assert_eq!(named(wrong), None, "{wrong}");
        }
    }
}
