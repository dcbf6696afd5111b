//! The machine of the measurements: its description and its measured speed.

use std::hint::black_box;
use std::time::Instant;

use serde::Serialize;

use crate::output::print_line;

/// The machine of the measurements.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// Name of the processor, where the system reports it.
    pub cpu: String,
    /// Cores of the processor, where the system reports them; a virtual machine may be shown threads as cores.
    pub cores: Option<usize>,
    /// Threads that can run at once.
    pub threads: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Multiplications with an addition that a loop of this program does in single precision \[1/s\].
    pub multiply_adds_per_second: Rates,
    /// Bytes that a copy of 64 MiB reads and writes \[1/s\].
    pub copy_bytes_per_second: Rates,
    /// Largest memory that this process held \[MB\], where the system reports it.
    pub peak_memory_mb: Option<f64>,
}

/// Operations per second, the best of a few runs.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rates {
    pub one_thread: f64,
    pub all_threads: f64,
}

impl Machine {
    /// This machine, now; takes about half a second.
    pub fn measured() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let rates = |on: fn(usize) -> f64| Rates { one_thread: on(1), all_threads: on(threads) };
        let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        Self {
            cpu: field(&text, "model name").unwrap_or_else(|| "unknown processor".to_owned()),
            cores: cores(&text),
            threads,
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            multiply_adds_per_second: rates(multiply_adds),
            copy_bytes_per_second: rates(copied_bytes),
            peak_memory_mb: peak_memory_mb(),
        }
    }

    /// Prints the machine and its speed.
    pub fn print(&self) {
        let cores = self.cores.map_or(String::new(), |cores| format!("{cores} cores, "));
        print_line!("machine: {}, {cores}{} threads, {}", self.cpu, self.threads, self.system);
        let [adds, copies] = [self.multiply_adds_per_second, self.copy_bytes_per_second];
        print_line!(
            "  on one thread it multiplies and adds {:.1} G times a second and copies {:.1} GB/s, on all {:.1} G and {:.1} GB/s",
            1e-9 * adds.one_thread,
            1e-9 * copies.one_thread,
            1e-9 * adds.all_threads,
            1e-9 * copies.all_threads
        );
    }
}

/// Largest memory that this process held \[MB\], where the system reports it.
pub fn peak_memory_mb() -> Option<f64> {
    peak_memory_mb_of("self")
}

/// The same of a process by its number.
pub fn peak_memory_mb_of(process: &str) -> Option<f64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let kilobytes = field(&text, "VmHWM")?.split_whitespace().next()?.parse::<f64>().ok()?;
    Some(kilobytes * 1024e-6)
}

/// The first `name: value` of a system file.
fn field(text: &str, name: &str) -> Option<String> {
    text.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == name).then(|| value.trim().to_owned())
    })
}

/// Different pairs of processor and core among the threads of `/proc/cpuinfo`.
fn cores(text: &str) -> Option<usize> {
    let threads = text.split("\n\n");
    let pairs = threads.filter_map(|thread| Some((field(thread, "physical id")?, field(thread, "core id")?)));
    let count = pairs.collect::<std::collections::BTreeSet<_>>().len();
    (count > 0).then_some(count)
}

/// Runs of a measurement, of which the best counts.
const RUNS: usize = 5;

/// Numbers that a thread holds, enough for the processor to work on several at once.
const NUMBERS: usize = 48;
/// Multiplications and additions of each of them in a run.
const ROUNDS: usize = 400_000;

/// Multiplications with an addition per second, on a number of threads.
fn multiply_adds(threads: usize) -> f64 {
    best(threads, (threads * NUMBERS * ROUNDS) as f64, |_| {
        // To 1.5 and no farther, so that no number grows or vanishes.
        let [factor, term] = black_box([0.999_f32, 0.0015]);
        let mut numbers = [black_box(1.0_f32); NUMBERS];
        for _ in 0..ROUNDS {
            for number in &mut numbers {
                *number = *number * factor + term;
            }
        }
        black_box(numbers);
    })
}

/// Bytes of the copy, shared out among the threads.
const COPIED: usize = 64 << 20;

/// Bytes read and written per second, on a number of threads.
fn copied_bytes(threads: usize) -> f64 {
    let part = COPIED.div_ceil(threads);
    let source = vec![1_u8; COPIED];
    let mut target = vec![0_u8; COPIED];
    let parts: Vec<_> = source.chunks(part).zip(target.chunks_mut(part)).map(std::sync::Mutex::new).collect();
    best(parts.len(), 2.0 * COPIED as f64, |thread| {
        // Never held by two: each thread has a part of its own.
        if let Ok(mut pair) = parts[thread].lock() {
            let (source, target) = &mut *pair;
            target.copy_from_slice(black_box(source));
            black_box(target);
        }
    })
}

/// Work over the time of the quickest run, in which all threads do theirs at once.
fn best(threads: usize, work: f64, act: impl Fn(usize) + Sync) -> f64 {
    let seconds = (0..RUNS).map(|_| {
        let begin = Instant::now();
        std::thread::scope(|scope| {
            (0..threads).for_each(|thread| {
                drop(scope.spawn({
                    let act = &act;
                    move || act(thread)
                }))
            })
        });
        begin.elapsed().as_secs_f64()
    });
    work / seconds.fold(f64::INFINITY, f64::min).max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_of_one_core_are_counted_once() {
        let thread = |processor: u32, core: u32| format!("physical id\t: {processor}\ncore id\t\t: {core}\n");
        let text = [thread(0, 0), thread(0, 1), thread(0, 0), thread(1, 0)].join("\n");
        assert_eq!(cores(&text), Some(3));
        assert_eq!(cores("model name : x\n"), None);
        assert_eq!(
            field("a : 1\nmodel name\t: An Example 9\n", "model name").as_deref(),
            Some("An Example 9")
        );
    }

    #[test]
    fn rates_are_those_of_a_processor() {
        // From a hundredth of a small core's to more than any core's: a loop that was left out, or a wrong
        // unit, lies outside.
        let adds = multiply_adds(1);
        assert!((1e7..2e11).contains(&adds), "{adds} multiplications and additions a second");
        let bytes = copied_bytes(1);
        assert!((1e7..1e12).contains(&bytes), "{bytes} bytes a second");
    }
}
