//! Sums over the `test result:` lines of test programs, and the last line of pytest.

/// Lines of a program that tell the results of tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prints {
    /// Nothing: it passes if it succeeds.
    Nothing,
    /// Lines such as `test result: ok. 3 passed; 0 failed; 1 ignored; ...`.
    Tests,
    /// A last line such as `2 failed, 40 passed, 1 skipped in 9.31s`.
    Python,
}

/// Numbers of tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub passed: u64,
    pub failed: u64,
    pub ignored: u64,
}

impl Tally {
    /// The sum over all results in an output, and their number.
    pub fn of(output: &str, prints: Prints) -> (Self, usize) {
        let mut tally = Self::default();
        let results = match prints {
            Prints::Nothing => 0,
            Prints::Tests => output.lines().filter(|line| tally.add(line)).count(),
            Prints::Python => {
                let last =
                    output.lines().rev().find(|line| counted(line, "passed") + counted(line, "failed") > 0);
                let [passed, failed, ignored] =
                    ["passed", "failed", "skipped"].map(|word| counted(last.unwrap_or_default(), word));
                tally = Self { passed, failed, ignored };
                usize::from(last.is_some())
            }
        };
        (tally, results)
    }

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

/// The number before a word in the last line of pytest.
fn counted(line: &str, word: &str) -> u64 {
    let words: Vec<&str> = line.split([' ', ',']).filter(|word| !word.is_empty()).collect();
    let number = words.windows(2).find(|pair| pair[1] == word).and_then(|pair| pair[0].parse().ok());
    number.unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_line_of_pytest_is_counted() {
        let output = "7 passed before\n..F\n2 failed, 40 passed, 1 skipped in 9.31s\na warning at the end\n";
        let (tally, results) = Tally::of(output, Prints::Python);
        assert_eq!((tally, results), (Tally { passed: 40, failed: 2, ignored: 1 }, 1));
        assert_eq!(Tally::of("Fatal Python error", Prints::Python), (Tally::default(), 0));
        assert_eq!(Tally::of(output, Prints::Nothing), (Tally::default(), 0));
    }

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
