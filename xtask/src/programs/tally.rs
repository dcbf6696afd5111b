//! Sums over the `test result:` lines of test programs.

/// Numbers of tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub passed: u64,
    pub failed: u64,
    pub ignored: u64,
}

impl Tally {
    /// Adds a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; ...`; false when it is not one.
    pub fn add(&mut self, line: &str) -> bool {
        let Some(counts) = line.trim_start().strip_prefix("test result:") else { return false };
        for part in counts.split([';', '.']) {
            let mut words = part.split_whitespace();
            let (Some(number), Some(word)) = (words.next().and_then(|n| n.parse::<u64>().ok()), words.next())
            else {
                continue;
            };
            match word {
                "passed" => self.passed += number,
                "failed" => self.failed += number,
                "ignored" => self.ignored += number,
                _ => {}
            }
        }
        true
    }

    /// Adds another sum.
    pub fn join(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.ignored += other.ignored;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_added_and_other_lines_are_not() {
        let mut tally = Tally::default();
        assert!(tally.add("test result: FAILED. 3 passed; 1 failed; 2 ignored; 0 measured; 4 filtered out"));
        assert!(!tally.add("running 3 tests"));
        assert!(tally.add("test result: ok. 5 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out"));
        assert_eq!(tally, Tally { passed: 8, failed: 1, ignored: 2 });
        tally.join(tally);
        assert_eq!(tally, Tally { passed: 16, failed: 2, ignored: 4 });
    }
}
