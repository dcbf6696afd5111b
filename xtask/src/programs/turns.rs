//! Runs programs side by side; the output of each is kept whole and printed when it has ended.

use std::collections::VecDeque;
use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::{Prints, Program, Tally, order};
use crate::cargo::root;
use crate::times::{Seconds, of_children};

/// Programs that run side by side at most: each has threads of its own, and memory.
const MOST: usize = 4;
/// Time between two looks at the programs that run.
const LOOK: Duration = Duration::from_millis(20);
/// Lines that are repeated of a failed program that names no failures.
const TAIL: usize = 40;

/// A program that has ended.
#[derive(Debug)]
pub struct Ran {
    pub name: String,
    pub passed: bool,
    pub tally: Tally,
    pub seconds: Seconds,
    output: String,
}

impl Ran {
    /// The end of the output that says what failed.
    pub fn failures(&self) -> String {
        if let Some(begin) = self.output.find("\nfailures:\n") {
            return self.output[begin..].to_owned();
        }
        let lines: Vec<&str> = self.output.lines().collect();
        lines[lines.len().saturating_sub(TAIL)..].join("\n")
    }
}

/// Runs all programs with an environment: as many side by side as there are cores, then those that need the machine for
/// themselves. The others measure their own memory and processor seconds, and wait for up to a minute.
pub fn run(mut programs: Vec<Program>, environment: &[(&str, &str)]) -> Vec<Ran> {
    order::sort(&mut programs);
    let (alone, together): (Vec<_>, Vec<_>) = programs.into_iter().partition(Program::is_alone);
    let jobs =
        |programs: Vec<Program>| programs.into_iter().map(|program| job(program, environment)).collect();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut done = side_by_side(jobs(together), cores.min(MOST));
    done.extend(side_by_side(jobs(alone), 1));
    done
}

fn job(program: Program, environment: &[(&str, &str)]) -> Job {
    let mut command = program.command();
    command.envs(environment.iter().copied());
    Job { name: program.name, prints: program.prints, longest: program.longest, command }
}

/// A program with all that it is started with.
struct Job {
    name: String,
    prints: Prints,
    longest: Duration,
    command: Command,
}

fn side_by_side(jobs: Vec<Job>, at_once: usize) -> Vec<Ran> {
    let mut waiting = VecDeque::from(jobs);
    let mut running: Vec<Running> = Vec::new();
    let mut done = Vec::new();
    loop {
        while running.len() < at_once
            && let Some(job) = waiting.pop_front()
        {
            let name = job.name.clone();
            match Running::start(job) {
                Ok(started) => running.push(started),
                Err(error) => done.push(not_started(name, &error)),
            }
        }
        if running.is_empty() {
            return done;
        }
        std::thread::sleep(LOOK);
        for index in (0..running.len()).rev() {
            let Some((status, seconds)) = running[index].ended() else { continue };
            let ran = running.swap_remove(index).read(status, seconds);
            let cpu = seconds.cpu.map_or_else(String::new, |cpu| format!(", {cpu:.1} s of processors"));
            println!("\n== {}: {:.1} s{cpu}\n{}", ran.name, seconds.wall, ran.output.trim_end());
            done.push(ran);
        }
    }
}

fn not_started(name: String, error: &io::Error) -> Ran {
    let output = format!("{name} does not start: {error}");
    println!("\n== {output}");
    let tally = Tally { failed: 1, ..Tally::default() };
    Ran { name, passed: false, tally, seconds: Seconds { wall: 0.0, cpu: None }, output }
}

/// A program that has not ended.
struct Running {
    name: String,
    prints: Prints,
    longest: Duration,
    child: Child,
    begin: Instant,
    late: bool,
    output: PathBuf,
}

impl Running {
    fn start(Job { name, prints, longest, mut command }: Job) -> io::Result<Self> {
        let folder = root().join("target/xtask/output");
        std::fs::create_dir_all(&folder)?;
        let output = folder.join(format!("{}.txt", name.replace(['/', ' '], "-")));
        let file = File::create(&output)?;
        let child = command.stdin(Stdio::null()).stdout(file.try_clone()?).stderr(file).spawn()?;
        Ok(Self { name, prints, longest, child, begin: Instant::now(), late: false, output })
    }

    /// The program's end and its seconds, once it has ended. The processor seconds are those that one wait
    /// adds, so that no other child may be waited for on another thread.
    fn ended(&mut self) -> Option<(Option<ExitStatus>, Seconds)> {
        let before = of_children();
        if self.begin.elapsed() > self.longest {
            self.late = true;
            let _ = self.child.kill();
        }
        let status = match self.child.try_wait() {
            Ok(None) => return None,
            Ok(Some(status)) => Some(status),
            Err(_) => None,
        };
        let cpu = of_children().zip(before).map(|(now, before)| now - before);
        Some((status, Seconds { wall: self.begin.elapsed().as_secs_f64(), cpu }))
    }

    fn read(self, status: Option<ExitStatus>, seconds: Seconds) -> Ran {
        let mut output = std::fs::read(&self.output)
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
            .unwrap_or_else(|error| format!("its output cannot be read: {error}"));
        let (mut tally, results) = Tally::of(&output, self.prints);
        let succeeded = status.is_some_and(|status| status.success());
        let passed = succeeded && tally.failed == 0 && (results > 0 || self.prints == Prints::Nothing);
        if !passed {
            let why = if self.late { "it took too long" } else { "it ended early" };
            let status = status.map_or_else(|| why.to_owned(), |status| format!("{why}: {status}"));
            if tally.failed == 0 {
                tally.failed = 1;
                output.push_str(&format!("\n{}: {status}", self.name));
            }
        }
        Ran { name: self.name, passed, tally, seconds, output }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::super::LONGEST;
    use super::*;

    /// Runs shell scripts as test programs in a folder of their own.
    fn ran(scripts: &[(&str, &str)], at_once: usize) -> Vec<Ran> {
        let folder = tempfile::tempdir().unwrap();
        let job = |(name, script): &(&str, &str)| {
            let mut command = Command::new("sh");
            command.args(["-c", script]).current_dir(folder.path());
            Job { name: format!("turns {name}"), prints: Prints::Tests, longest: LONGEST, command }
        };
        side_by_side(scripts.iter().map(job).collect(), at_once)
    }

    #[test]
    fn two_run_at_a_time_and_neither_mixes_its_output_with_the_other() {
        // Each waits for a sign of the other.
        let both = |own: &str, other: &str| {
            format!(
                "echo begin; touch {own}; until [ -e {other} ]; do sleep 0.01; done; echo error >&2\n\
                 echo 'test result: ok. 2 passed; 0 failed; 0 ignored'"
            )
        };
        let done = ran(&[("one", &both("a", "b")), ("two", &both("b", "a"))], 2);
        assert_eq!(done.len(), 2);
        for ran in done {
            assert!(ran.passed && ran.tally.passed == 2, "{ran:?}");
            assert!(ran.output.starts_with("begin\nerror\ntest"), "{}", ran.output);
        }
    }

    #[test]
    fn what_fails_or_ends_early_has_failed_and_says_why() {
        let failing = "echo 'test a ... FAILED'; echo; echo failures:; echo '---- a'; \
                       echo 'test result: FAILED. 1 passed; 1 failed; 0 ignored'; exit 101";
        let scripts = [
            ("failing", failing),
            ("killed", "kill -9 $$"),
            ("silent", "exit 0"),
            ("good", "echo 'test result: ok. 0 passed; 0 failed; 1 ignored'"),
        ];
        let done = ran(&scripts, 1);
        let passed: Vec<_> = done.iter().map(|ran| ran.passed).collect();
        assert_eq!(passed, [false, false, false, true]);
        assert_eq!(done.iter().map(|ran| ran.tally.failed).collect::<Vec<_>>(), [1, 1, 1, 0]);
        assert!(done[0].failures().starts_with("\nfailures:\n---- a"), "{}", done[0].failures());
        assert!(done[1].failures().contains("signal: 9"), "{}", done[1].failures());
    }

    #[test]
    fn a_program_that_needs_the_machine_alone_runs_last() {
        let program = |name: &str| Program {
            name: name.into(),
            path: "true".into(),
            folder: root().to_owned(),
            prints: Prints::Nothing,
            arguments: Vec::new(),
            environment: Vec::new(),
            longest: LONGEST,
        };
        let done = run(
            vec![program("strandline-cli/window"), program("turns beside"), program("turns before")],
            &[],
        );
        assert!(done.iter().all(|ran| ran.passed), "{done:?}");
        assert_eq!(done[2].name, "strandline-cli/window");
    }

    #[test]
    fn a_program_that_takes_too_long_is_ended() {
        let mut command = Command::new("sleep");
        command.arg("60");
        let longest = Duration::from_millis(100);
        let job = Job { name: "turns late".into(), prints: Prints::Nothing, longest, command };
        let done = side_by_side(vec![job], 1);
        assert!(!done[0].passed && done[0].seconds.wall < 30.0, "{done:?}");
        assert!(done[0].failures().contains("it took too long"), "{}", done[0].failures());
    }

    #[test]
    fn a_program_that_is_not_there_has_failed() {
        let job = Job {
            name: "turns nothing".into(),
            prints: Prints::Tests,
            longest: LONGEST,
            command: Command::new("/nothing/here"),
        };
        let done = side_by_side(vec![job], 1);
        assert!(!done[0].passed && done[0].tally.failed == 1);
    }
}
