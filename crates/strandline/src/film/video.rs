//! The video, which the user's ffmpeg makes of raw pictures on its standard input.

use std::ffi::OsString;
use std::io::{Read, Result, Write};
use std::path::{Path, absolute};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, sleep};
use std::time::Duration;

use strandline_base::WholeFile;

use crate::render::Picture;

/// Time without a sign of progress after which ffmpeg counts as stuck.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);
/// Between two looks at whether it ended.
const LOOK: Duration = Duration::from_millis(10);
/// Bytes of ffmpeg's messages that are kept.
const SAID: usize = 4096;

/// A video under way: ffmpeg writes it under a temporary name, and it gets its own when it is whole.
///
/// Nothing here waits for ffmpeg without an end: a thread of its own feeds it, and one that is stuck is ended.
/// Programs that it may have started are ended with it where the system has groups of processes; the threads that talk
/// to it are never waited for.
pub(super) struct Video {
    child: Child,
    /// Pictures on their way; `None` once it ended or has to end.
    pictures: Option<Sender<Vec<u8>>>,
    /// One for each picture that ffmpeg took.
    taken: Receiver<()>,
    under_way: usize,
    said: Arc<Mutex<Vec<u8>>>,
    hearing: thread::JoinHandle<()>,
    patience: Duration,
    /// Why there will be no video.
    failed: Option<String>,
    file: Option<WholeFile>,
}

impl Video {
    /// Starts ffmpeg for pictures of this size. The inner error: ffmpeg cannot be started.
    pub fn begin(
        program: &Path,
        picture: &Picture,
        frames_per_second: f32,
        path: &Path,
        patience: Duration,
    ) -> Result<Result<Self>> {
        let file = WholeFile::for_program(path)?;
        let mut child = match start(program, picture, frames_per_second, file.temporary()) {
            Ok(child) => child,
            Err(error) => return Ok(Err(error)),
        };
        let (pictures, waiting) = channel();
        let (written, taken) = channel();
        let pipe = child.stdin.take();
        thread::Builder::new()
            .name("feeding ffmpeg".to_owned())
            .spawn(move || feed(pipe, &waiting, &written))?;
        let (said, stderr) = (Arc::default(), child.stderr.take());
        let words = Arc::clone(&said);
        let hearing = thread::Builder::new()
            .name("messages of ffmpeg".to_owned())
            .spawn(move || collect(stderr, &words))?;
        let (pictures, file) = (Some(pictures), Some(file));
        Ok(Ok(Self { child, pictures, taken, under_way: 0, said, hearing, patience, failed: None, file }))
    }

    /// Hands a picture over when the one before was taken. Errors are reported at the end.
    pub fn add(&mut self, picture: &Picture) {
        if self.pictures.is_none() {
            return;
        }
        if self.under_way > 0 {
            match wait(&self.taken, self.patience) {
                Ok(()) => self.under_way -= 1,
                Err(RecvTimeoutError::Timeout) => return self.give_up("took no picture"),
                Err(RecvTimeoutError::Disconnected) => {
                    self.pictures = None;
                    return;
                }
            }
        }
        let sent = self.pictures.as_ref().is_some_and(|pipe| pipe.send(picture.pixels.clone()).is_ok());
        self.under_way += usize::from(sent);
    }

    /// Lets ffmpeg finish. The file is to be kept; else why there is none.
    pub fn finish(mut self) -> std::result::Result<WholeFile, String> {
        self.pictures = None;
        let (mut idle, mut length) = (Duration::ZERO, 0);
        let status = loop {
            if let Some(failed) = self.failed.take() {
                return Err(failed);
            }
            let ended = self.child.try_wait();
            let part = self.file.as_ref().and_then(|file| file.temporary().metadata().ok());
            let written = part.map_or(0, |part| part.len());
            idle = if written == length { idle + LOOK } else { Duration::ZERO };
            length = written;
            match ended {
                Ok(Some(status)) => break status,
                Ok(None) => {}
                Err(error) => return Err(format!("ffmpeg cannot be waited for: {error}")),
            }
            if idle >= self.patience {
                self.give_up("did not finish");
            }
            sleep(LOOK);
        };
        match self.file.take() {
            Some(_) if status.success() && length == 0 => Err("ffmpeg wrote nothing".to_owned()),
            Some(file) if status.success() => Ok(file),
            _ => Err(format!("ffmpeg ended with {status}{}", self.last_words())),
        }
    }

    fn give_up(&mut self, what: &str) {
        self.pictures = None;
        self.end();
        let seconds = self.patience.as_secs_f32();
        self.failed = Some(format!("ffmpeg {what} for {seconds:.0} s and was ended{}", self.last_words()));
    }

    /// Ends ffmpeg, and lets the system forget it.
    fn end(&mut self) {
        // It may have ended by itself.
        #[cfg(unix)]
        let _ = end_group(self.child.id());
        let _ = self.child.kill();
        for _ in 0..100 {
            if !matches!(self.child.try_wait(), Ok(None)) {
                return;
            }
            sleep(LOOK);
        }
    }

    /// Output of ffmpeg, in one line.
    fn last_words(&self) -> String {
        for _ in 0..20 {
            if self.hearing.is_finished() {
                break;
            }
            sleep(LOOK);
        }
        let said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(&said);
        let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        if lines.is_empty() { String::new() } else { format!(": {}", lines.join("; ")) }
    }
}

impl Drop for Video {
    /// One that is stopped early leaves nothing.
    fn drop(&mut self) {
        if self.file.is_some() {
            self.end();
        }
    }
}

/// Ends all programs of a group of processes.
#[cfg(unix)]
fn end_group(number: u32) -> Result<std::process::ExitStatus> {
    let group = format!("-{number}");
    Command::new("kill").args(["-KILL", "--", &group]).stderr(Stdio::null()).status()
}

fn start(program: &Path, picture: &Picture, frames_per_second: f32, part: &Path) -> Result<Child> {
    let size = format!("{}x{}", picture.width, picture.height);
    // Neither an option nor an address, whatever the folder is called.
    let mut target = OsString::from("file:");
    target.push(absolute(part)?);
    let mut command = Command::new(program);
    command
        .args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", &size])
        .args(["-framerate", &frames_per_second.to_string(), "-i", "-"])
        .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-crf", "18"])
        // The encoder divides its work among threads, and its bytes depend on their number.
        .args(["-threads", "1", "-f", "mp4"])
        .arg(target)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    // The terminal's Ctrl-C is for us: ffmpeg ends when its input does.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn()
}

fn feed(pipe: Option<ChildStdin>, waiting: &Receiver<Vec<u8>>, written: &Sender<()>) {
    let Some(mut pipe) = pipe else { return };
    for picture in waiting {
        // A broken pipe means that ffmpeg ended; `finish` says how.
        if pipe.write_all(&picture).is_err() || written.send(()).is_err() {
            return;
        }
    }
}

/// Reads to the end, so that ffmpeg never waits, and keeps the beginning.
fn collect(from: Option<impl Read>, said: &Mutex<Vec<u8>>) {
    let Some(mut from) = from else { return };
    let mut bytes = [0; 1024];
    while let Ok(count @ 1..) = from.read(&mut bytes) {
        let mut said = said.lock().unwrap_or_else(PoisonError::into_inner);
        let room = SAID.saturating_sub(said.len());
        said.extend_from_slice(&bytes[..count.min(room)]);
    }
}

/// Waits in short pieces: of a time in which this process stood still as a whole, only one counts.
fn wait(taken: &Receiver<()>, patience: Duration) -> std::result::Result<(), RecvTimeoutError> {
    let piece = patience / 60;
    for _ in 0..60 {
        match taken.recv_timeout(piece) {
            Err(RecvTimeoutError::Timeout) => {}
            other => return other,
        }
    }
    Err(RecvTimeoutError::Timeout)
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs;
    use std::os::unix::fs::PermissionsExt;
    use std::path::PathBuf;
    use std::time::Instant;

    use super::*;

    /// Makes a video of three pictures with a program in the place of ffmpeg.
    fn film(script: &str) -> (std::result::Result<(), String>, Vec<String>, Duration) {
        let folder = tempfile::tempdir().unwrap();
        let programs = tempfile::tempdir().unwrap();
        let program = programs.path().join("ffmpeg");
        // Written by another program: a file that is open for writing here, in whatever thread, cannot be run.
        let mut shell =
            Command::new("sh").args(["-c", "cat > \"$0\""]).arg(&program).stdin(Stdio::piped()).spawn();
        shell.as_mut().unwrap().stdin.take().unwrap().write_all(script.as_bytes()).unwrap();
        assert!(shell.unwrap().wait().unwrap().success());
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let path = folder.path().join("video.mp4");
        fs::write(&path, b"former").unwrap();
        let picture =
            Picture { width: 256, height: 256, pixels: vec![7; 256 * 256 * 3], ..Picture::default() };
        let begin = Instant::now();
        let patience = Duration::from_millis(600);
        let mut video = Video::begin(&program, &picture, 30.0, &path, patience).unwrap().unwrap();
        (0..3).for_each(|_| video.add(&picture));
        let finished = video.finish().and_then(|file| file.keep().map_err(|error| error.to_string()));
        let took = begin.elapsed();
        let former = fs::read(&path).unwrap() == b"former";
        assert_eq!(former, finished.is_err(), "the former video stays until there is a whole one");
        let names =
            fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        (finished, names.collect(), took)
    }

    #[test]
    fn a_video_gets_its_name_when_it_is_whole() {
        let target = "for last; do true; done\n";
        let (finished, names, _) = film(&format!("#!/bin/sh\n{target}cat > \"${{last#file:}}\"\n"));
        assert_eq!((finished, names), (Ok(()), vec!["video.mp4".to_owned()]));
    }

    #[test]
    fn a_program_that_fails_is_quoted_and_leaves_nothing() {
        let half = "for last; do true; done\nhead -c 1000 > \"${last#file:}\"\n";
        let (finished, names, _) =
            film(&format!("#!/bin/sh\n{half}echo 'no such encoder' >&2\necho 'bye' >&2\nexit 3\n"));
        let error = finished.unwrap_err();
        assert!(error.contains("exit status: 3: no such encoder; bye"), "{error}");
        assert_eq!(names, ["video.mp4"]);
        let (finished, ..) = film("#!/bin/sh\nexit 0\n");
        assert_eq!(finished, Err("ffmpeg wrote nothing".to_owned()), "though it says that it went well");
    }

    /// A program that ffmpeg started may be stuck too and hold the pipes open.
    #[test]
    fn a_program_that_is_stuck_is_ended() {
        let stuck = "sleep 4\n";
        for (script, what) in [
            (format!("#!/bin/sh\n{stuck}true\n"), "took no picture for 1 s"),
            (format!("#!/bin/sh\nexec {stuck}"), "took no picture for 1 s"),
            (format!("#!/bin/sh\ncat > /dev/null\n{stuck}true\n"), "did not finish for 1 s"),
        ] {
            let (finished, names, took) = film(&script);
            let error = finished.unwrap_err();
            assert!(error.contains(what), "{error}");
            assert_eq!(names, ["video.mp4"]);
            assert!(took < Duration::from_secs(4), "{took:?}");
        }
    }

    #[test]
    fn what_a_stuck_program_has_started_ends_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let number = folder.path().join("number");
        let (finished, ..) =
            film(&format!("#!/bin/sh\nsleep 60 &\necho $! > '{}'\nwait\n", number.display()));
        assert!(finished.unwrap_err().contains("took no picture"));
        let number = fs::read_to_string(number).unwrap();
        let is_there = || Command::new("kill").args(["-0", number.trim()]).stderr(Stdio::null()).status();
        let begin = Instant::now();
        while is_there().unwrap().success() {
            assert!(begin.elapsed() < Duration::from_secs(20), "process {number} lives on");
            sleep(LOOK);
        }
    }

    #[test]
    fn the_encoder_has_one_thread_on_every_machine() {
        let target = "for last; do true; done\n";
        let (finished, ..) = film(&format!(
            "#!/bin/sh\n{target}case \"$*\" in *' -threads 1 '*) cat > \"${{last#file:}}\";; *) exit 4;; esac\n"
        ));
        assert_eq!(finished, Ok(()));
    }

    #[test]
    fn a_program_that_is_not_there_is_an_error_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Picture { width: 2, height: 2, pixels: vec![0; 12], ..Picture::default() };
        let path = folder.path().join("video.mp4");
        let begun = Video::begin(&PathBuf::from("/no/ffmpeg"), &picture, 30.0, &path, PATIENCE).unwrap();
        assert_eq!(begun.err().unwrap().kind(), std::io::ErrorKind::NotFound);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
