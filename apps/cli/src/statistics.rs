//! Medians of times, stage by stage, as they are printed and written.

use serde::Serialize;

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

/// What a repeated thing cost \[ms\].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// The middle value.
    pub median: f64,
    /// 95 of 100 were faster.
    pub p95: f64,
    /// Median of each stage.
    pub stages: StageTimes,
}

/// Collects the stage times of a repeated thing.
#[derive(Clone, Debug, Default)]
pub struct Collector {
    names: Vec<&'static str>,
    runs: Vec<Vec<(&'static str, f64)>>,
}

impl Collector {
    /// Adds one run: the seconds of each stage. A stage may be missing in some runs.
    pub fn add(&mut self, seconds: &[(&'static str, f64)]) {
        for (name, _) in seconds {
            if !self.names.contains(name) {
                self.names.push(name);
            }
        }
        self.runs.push(seconds.iter().map(|(name, seconds)| (*name, 1e3 * seconds)).collect());
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.runs.len()
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

/// The middle value; 0 of nothing.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a share of all values lies (nearest rank); 0 of nothing.
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
