//! Seconds of steps and programs: by the clock, and of processors where the system reports them.

use std::fmt::Write;
use std::time::Instant;

/// Rows of the list of the slowest.
const SLOWEST: usize = 10;
/// Ticks of a processor second in /proc, on every Linux.
const TICKS: f64 = 100.0;

/// Seconds that something ran.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seconds {
    pub wall: f64,
    /// Processor seconds of all threads and children; `None` where the system does not report them.
    pub cpu: Option<f64>,
}

/// A clock for one child, or for several that run one after the other.
pub struct Clock {
    begin: Instant,
    before: Option<f64>,
}

impl Clock {
    pub fn start() -> Self {
        Self { begin: Instant::now(), before: of_children() }
    }

    /// Seconds since the start; processor seconds are those of the children waited for since then.
    pub fn stop(&self) -> Seconds {
        let cpu = of_children().zip(self.before).map(|(now, before)| now - before);
        Seconds { wall: self.begin.elapsed().as_secs_f64(), cpu }
    }
}

/// Processor seconds of all children that were waited for, theirs included. `None` without /proc.
pub fn of_children() -> Option<f64> {
    children_ticks(&std::fs::read_to_string("/proc/self/stat").ok()?).map(|ticks| ticks as f64 / TICKS)
}

/// `cutime` + `cstime` of a /proc/PID/stat line, proc(5).
fn children_ticks(stat: &str) -> Option<u64> {
    // The name in parentheses may hold spaces and parentheses itself; field 3 follows it.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(16 - 3);
    let mut next = || fields.next()?.parse::<u64>().ok();
    Some(next()? + next()?)
}

/// Named seconds of a run, in order.
#[derive(Default)]
pub struct Times {
    rows: Vec<(String, Seconds)>,
    sums: Vec<(String, Seconds)>,
}

impl Times {
    /// Adds a step or a program.
    pub fn add(&mut self, name: &str, seconds: Seconds) {
        self.rows.push((name.to_owned(), seconds));
    }

    /// Adds the seconds of several rows together.
    pub fn add_sum(&mut self, name: &str, seconds: Seconds) {
        self.sums.push((name.to_owned(), seconds));
    }

    /// A table of everything in the order in which it ran, then the slowest ten by the clock, then the sums.
    pub fn table(&self) -> String {
        let mut sorted: Vec<_> = self.rows.iter().collect();
        sorted.sort_by(|a, b| b.1.wall.total_cmp(&a.1.wall));
        let mut text = String::from("seconds:     wall      CPU\n");
        self.rows.iter().for_each(|row| line(&mut text, row));
        text.push_str("\nslowest ten: wall      CPU\n");
        sorted.into_iter().take(SLOWEST).for_each(|row| line(&mut text, row));
        text.push_str("\ntogether:    wall      CPU\n");
        self.sums.iter().for_each(|row| line(&mut text, row));
        text
    }
}

fn line(text: &mut String, (name, Seconds { wall, cpu }): &(String, Seconds)) {
    let cpu = cpu.map_or_else(|| "-".to_owned(), |cpu| format!("{cpu:.1}"));
    let _ = writeln!(text, "{wall:>17.1} {cpu:>8}  {name}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_of_children_are_read_behind_any_name() {
        let stat = "7 (a) b (c)) S 1 2 3 4 5 6 7 8 9 10 11 12 130 140 20 0 1";
        assert_eq!(children_ticks(stat), Some(270));
        assert_eq!(children_ticks("7 (cut) S 1 2"), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn work_of_a_child_is_counted() {
        let clock = Clock::start();
        let work = "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done";
        assert!(std::process::Command::new("sh").args(["-c", work]).status().unwrap().success());
        assert!(clock.stop().cpu.unwrap() > 0.0);
    }

    #[test]
    fn the_slowest_ten_come_last_and_slowest_first() {
        let mut times = Times::default();
        for number in 0..12 {
            times.add(&format!("step {number}"), Seconds { wall: f64::from(number), cpu: None });
        }
        times.add_sum("all", Seconds { wall: 66.0, cpu: Some(1.5) });
        let table = times.table();
        let (slowest, sums) = table.split_once("slowest ten").unwrap().1.split_once("\n\n").unwrap();
        assert!(sums.ends_with("66.0      1.5  all\n"), "{sums}");
        let names: Vec<_> = slowest.lines().skip(1).map(|line| line.rsplit("  ").next().unwrap()).collect();
        let wanted: Vec<_> = (2..12).rev().map(|number| format!("step {number}")).collect();
        assert_eq!(names, wanted);
    }
}
