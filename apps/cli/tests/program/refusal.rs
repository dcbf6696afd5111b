//! Runs that are refused, with a limit on their time: a mistake that the program takes for a good value else draws a
//! whole film.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Most time that a refusal may take. The longest found is a few seconds, beside other work.
const LONGEST: Duration = Duration::from_secs(60);
/// Time between two looks at a run.
const LOOK: Duration = Duration::from_millis(5);

/// Output of a run that ends within a minute, as a refusal does.
pub fn refused(folder: &Path, arguments: &[&str]) -> Output {
    within(folder, arguments, LONGEST)
}

/// Output of a run in a folder, which is ended, and fails the test with its arguments and messages, where it takes longer
/// than a limit.
fn within(folder: &Path, arguments: &[&str], longest: Duration) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_strandline"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let (stdout, stderr) = (read(child.stdout.take()), read(child.stderr.take()));
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begin.elapsed() > longest {
            child.kill().unwrap();
            child.wait().unwrap();
            let said = stderr.join().unwrap();
            panic!("{arguments:?} is not refused within {longest:?}: {}", String::from_utf8_lossy(&said));
        }
        thread::sleep(LOOK);
    };
    Output { status, stdout: stdout.join().unwrap(), stderr: stderr.join().unwrap() }
}

/// Reads a pipe to its end beside the test, so that a full one stops nobody.
fn read(pipe: Option<impl Read + Send + 'static>) -> thread::JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        pipe.unwrap().read_to_end(&mut bytes).unwrap();
        bytes
    })
}

#[test]
#[should_panic(expected = "\"100000\"] is not refused within 500ms: ")]
fn a_run_that_is_not_refused_is_ended() {
    let folder = tempfile::tempdir().unwrap();
    within(folder.path(), &["sim", "--backend", "cpu", "--frames", "100000"], Duration::from_millis(500));
}

#[test]
fn a_refusal_is_read_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let output = refused(folder.path(), &["scene", "--set", "film.frames=0"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{output:?}");
}
