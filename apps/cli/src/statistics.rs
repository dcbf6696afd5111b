//! Medians of times, stage by stage, as they are printed and written.

use serde::Serialize;
use strandline::math::Random;

/// Milliseconds in each stage, in the stages' order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StageTimes(Vec<(String, f64)>);

impl Serialize for StageTimes {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, time)| (name, time)))
    }
}

impl StageTimes {
    /// Every stage and its milliseconds.
    pub fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.0.iter().map(|(name, time)| (name.as_str(), *time))
    }

    /// Milliseconds in some stages together.
    pub fn sum(&self, names: &[&str]) -> f64 {
        self.iter().filter(|(name, _)| names.contains(name)).map(|(_, time)| time).sum()
    }
}

/// Times of a repeated task \[ms\].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// The middle value.
    pub median: f64,
    /// 95 of 100 were faster.
    pub p95: f64,
    /// Median of each stage.
    pub stages: StageTimes,
}

/// Runs that are kept: a quantile of so many chosen at random is off by a hundredth of the ranks.
const KEPT: usize = 4096;

/// Collects the stage times of a repeated thing: all of some thousand runs, and of more than that as many,
/// each as likely as any other [Vitter1985, algorithm R].
#[derive(Clone, Debug)]
pub struct Collector {
    names: Vec<&'static str>,
    runs: Vec<Vec<(&'static str, f64)>>,
    count: usize,
    random: Random,
}

impl Default for Collector {
    fn default() -> Self {
        Self { names: Vec::new(), runs: Vec::new(), count: 0, random: Random::new(1, 0) }
    }
}

impl Collector {
    /// Adds one run: the seconds of each stage. A stage may be missing in some runs.
    pub fn add(&mut self, seconds: &[(&'static str, f64)]) {
        for (name, _) in seconds {
            if !self.names.contains(name) {
                self.names.push(name);
            }
        }
        let run = seconds.iter().map(|(name, seconds)| (*name, 1e3 * seconds)).collect();
        self.count += 1;
        if self.runs.len() < KEPT {
            return self.runs.push(run);
        }
        // The next run is kept with the chance KEPT / count, in the place of any.
        let place = ((u64::from(self.random.bits()) * self.count as u64) >> 32) as usize;
        if let Some(kept) = self.runs.get_mut(place) {
            *kept = run;
        }
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The medians.
    pub fn times(&self) -> Times {
        let totals: Vec<f64> = self.runs.iter().map(|run| run.iter().map(|(_, time)| time).sum()).collect();
        let stage = |wanted: &str| -> Vec<f64> {
            self.runs.iter().flatten().filter(|(name, _)| *name == wanted).map(|(_, time)| *time).collect()
        };
        let stages = self.names.iter().map(|name| ((*name).to_owned(), median(&stage(name)))).collect();
        Times { median: median(&totals), p95: quantile(&totals, 0.95), stages: StageTimes(stages) }
    }
}

/// The median; 0 of no values.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a share of all values lies (nearest rank); 0 of no values.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_nearest_ranks() {
        let values = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(median(&values), 3.0);
        assert_eq!(quantile(&values, 0.95), 5.0);
        assert_eq!(median(&[]), 0.0);
    }

    #[test]
    fn of_many_runs_some_thousand_are_kept_and_speak_for_all() {
        let mut collector = Collector::default();
        // In order, so that the first ones alone would tell something else.
        (0..100_000).for_each(|run| collector.add(&[("a", 1e-5 * f64::from(run))]));
        assert_eq!((collector.len(), collector.runs.len()), (100_000, KEPT));
        let Times { median, p95, .. } = collector.times();
        // A rank among n of all has the standard deviation sqrt(share * (1 - share) / n): here 0.8 % and 0.3 %
        // of the 1,000 ms; four of them.
        assert!((median - 500.0).abs() < 32.0 && (p95 - 950.0).abs() < 14.0, "{median} {p95}");
    }

    #[test]
    fn stages_keep_their_order_and_add_up() {
        let mut collector = Collector::default();
        collector.add(&[("b", 0.001), ("a", 0.003)]);
        collector.add(&[("b", 0.002), ("a", 0.005)]);
        let times = collector.times();
        assert_eq!(times.stages.iter().collect::<Vec<_>>(), [("b", 1.0), ("a", 3.0)]);
        assert_eq!(times.p95, 7.0);
        collector.add(&[("step", 0.004)]);
        assert_eq!(collector.times().stages.iter().last(), Some(("step", 4.0)));
        assert_eq!(serde_json::to_string(&times.stages).unwrap(), r#"{"b":1.0,"a":3.0}"#);
    }
}
