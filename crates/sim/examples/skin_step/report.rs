//! The file of the figures: one run for each number of threads.

use std::path::Path;

/// Milliseconds: the median, and the one that a tenth of them lie below.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    pub median: f64,
    pub tenth: f64,
}

impl Times {
    pub fn of(times: &[f64]) -> Self {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        Self { median: sorted[sorted.len() / 2], tenth: sorted[sorted.len() / 10] }
    }
}

/// Steps of a rate \[1/s\]: times on the moving skin, on the skin at rest and on the rigid body.
pub struct Step {
    pub rate: f32,
    pub steps: usize,
    pub clock: [Option<Times>; 3],
    pub processor: [Option<Times>; 3],
}

/// Stages of a load.
pub struct Load {
    pub triangles: usize,
    /// True where times are of the processor.
    pub of_processor: bool,
    pub stages: Vec<(&'static str, Times)>,
}

/// All figures of a run.
pub struct Report {
    pub steps: Vec<Step>,
    pub load: Option<Load>,
}

/// First line of a run in the file: one run is one line.
fn key(threads: usize) -> String {
    format!("    {{ \"threads\": {threads}, ")
}

impl Report {
    /// Writes the run into a file, in the place of one with as many threads.
    pub fn save(&self, path: &Path) {
        let threads = strandline_base::par::current_num_threads();
        let old = std::fs::read_to_string(path).unwrap_or_default();
        let others = old
            .lines()
            .filter(|line| line.starts_with("    { \"threads\": ") && !line.starts_with(&key(threads)));
        let mut runs: Vec<String> = others.map(|line| line.trim_end_matches(',').to_owned()).collect();
        runs.push(self.line(threads));
        runs.sort();
        let text = format!("{{\n  \"bench\": \"skin\",\n  \"runs\": [\n{}\n  ]\n}}\n", runs.join(",\n"));
        std::fs::write(path, text).expect("a file that can be written");
    }

    fn line(&self, threads: usize) -> String {
        let release = !cfg!(debug_assertions);
        let steps: Vec<String> = self.steps.iter().map(Step::json).collect();
        let load = self.load.as_ref().map_or("null".to_owned(), Load::json);
        format!(
            "{}\"release\": {release}, \"cpu\": \"{}\", \"steps\": [{}], \"load\": {load} }}",
            key(threads),
            processor(),
            steps.join(", ")
        )
    }
}

impl Step {
    fn json(&self) -> String {
        let three = |times: [Option<Times>; 3]| match times {
            [Some(skin), Some(resting), Some(rigid)] => format!(
                "{{ \"skin\": {}, \"resting_skin\": {}, \"rigid\": {}, \"more\": {:.2} }}",
                skin.json(),
                resting.json(),
                rigid.json(),
                skin.median - rigid.median
            ),
            _ => "null".to_owned(),
        };
        // The clock tells little beside times of the processor: these are taken on busy machines.
        let clock = if self.processor[0].is_some() { [None; 3] } else { self.clock };
        let [clock, processor] = [three(clock), three(self.processor)];
        format!(
            "{{ \"steps_per_second\": {}, \"steps\": {}, \"ms\": {clock}, \"processor_ms\": {processor} }}",
            self.rate, self.steps
        )
    }
}

impl Load {
    fn json(&self) -> String {
        let unit = if self.of_processor { "processor_ms" } else { "ms" };
        let stages: Vec<String> = self
            .stages
            .iter()
            .map(|(name, times)| format!("\"{}\": {}", name.trim_start_matches("= "), times.json()))
            .collect();
        format!("{{ \"triangles\": {}, \"{unit}\": {{ {} }} }}", self.triangles, stages.join(", "))
    }
}

impl Times {
    fn json(self) -> String {
        format!("[{:.2}, {:.2}]", self.median, self.tenth)
    }
}

/// Name of the processor, as Linux tells it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or("unknown", |(_, name)| name.trim()).replace('"', "")
}
