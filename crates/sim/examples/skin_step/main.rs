//! Time of a step on a body that moves by itself, beside that of the same step on its skin at rest and on a rigid body, stage
//! by stage, and time of the load of such a body.
//!
//! ```text
//! cargo run -p strandline-body --example bust -- out/character.glb 0.0077
//! cargo run --release -p strandline-sim --example skin_step -- out/character.glb [steps] [bench/skin.json]
//! ```
//!
//! The first line makes a character of 20,000 triangles, whose clip `nod` of 2 s is loaded. `RAYON_NUM_THREADS=1` gives
//! processor time. In the place of the first file `-` leaves the load out. A row of the last file that has the
//! same number of threads is replaced, and the others stay.

#![allow(clippy::disallowed_methods, clippy::print_stdout)] // it prints times, and nothing depends on its bits

mod character;
mod report;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use character::{PADDING, POINTS, SPACING, frame, guides, mesh};
use glam::{Quat, Vec3};
use report::{Load, Report, Step, Times};
use strandline_base::Stopwatch;
use strandline_body::{
    BodyFrame, Carrier, Collider, DistanceGrid, Mesh, Playback, Shape, SkinMotion, SkinRoots, SkinSolid,
};
use strandline_groom::Guides;
use strandline_sim::{CpuRunner, Drive, Model, Settings, State};

const STRANDS: usize = 2000;
/// Rates of steps \[1/s\].
const RATES: [f32; 2] = [120.0, 60.0];
/// Loads of which the least and the median are told.
const LOADS: usize = 7;

/// Milliseconds of the clock, and of the processor, where the system tells.
struct Watch {
    clock: Stopwatch,
    processor: Option<f64>,
}

impl Watch {
    fn start() -> Self {
        Self { clock: Stopwatch::start(), processor: processor_ms() }
    }

    fn clock(&self) -> f64 {
        1e3 * self.clock.seconds()
    }

    fn processor(&self) -> Option<f64> {
        Some(processor_ms()? - self.processor?)
    }

    /// Processor time of one thread, which others on the machine disturb least; else that of the clock.
    fn own(&self) -> f64 {
        self.processor().filter(|_| one_thread()).unwrap_or_else(|| self.clock())
    }
}

fn one_thread() -> bool {
    strandline_base::par::current_num_threads() == 1
}

/// Milliseconds of the processor that all threads have used.
fn processor_ms() -> Option<f64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let of_task = |task: std::io::Result<std::fs::DirEntry>| {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        text.split(' ').next()?.parse::<f64>().ok()
    };
    Some(1e-6 * tasks.filter_map(of_task).sum::<f64>())
}

/// One of the bodies with its hair, and the milliseconds of each stage in each step.
struct Side {
    runner: CpuRunner,
    state: State,
    times: BTreeMap<&'static str, Vec<f64>>,
}

impl Side {
    fn new(guides: &Guides, settings: &Settings, shape: Shape) -> Self {
        let solid = Collider::new(shape, Carrier::HEAD, 0.3).expect("a solid");
        let model = Model::new(guides, settings, vec![solid]).expect("a model");
        let state = model.rest_state(BodyFrame::REST);
        Self { runner: model.into(), state, times: BTreeMap::new() }
    }

    fn step(&mut self, body: impl FnOnce(&BodyFrame) -> BodyFrame) {
        let watch = Watch::start();
        let body = body(&self.state.body);
        let roots = watch.clock();
        let report = self.runner.step(&mut self.state, &Drive::of(body));
        let (all, processor) = (watch.clock(), watch.processor());
        let stages: f64 = report.seconds.iter().map(|(_, seconds)| 1e3 * seconds).sum();
        let rows = report.seconds.iter().map(|(name, seconds)| (*name, 1e3 * seconds));
        let own = [("0 roots", roots), ("1 tree", all - roots - stages), ("= all", all)];
        let processor = processor.map(|processor| ("= processor", processor));
        for (name, ms) in rows.chain(own).chain(processor) {
            self.times.entry(name).or_default().push(ms);
        }
    }

    fn times(&self, name: &str) -> Option<Times> {
        self.times.get(name).map(|times| Times::of(times))
    }
}

/// A sum that tells whether numbers are the same to the bit.
fn bits(numbers: impl Iterator<Item = f32>) -> u64 {
    numbers.fold(0, |sum: u64, number| sum.rotate_left(5) ^ u64::from(number.to_bits()))
}

/// Steps at a rate by turns on the skin that moves, on the same skin while it keeps its shape, and on the rigid body.
fn steps(mesh: &Mesh, grid: &Arc<DistanceGrid>, guides: &Guides, count: usize, rate: f32) -> Step {
    let skin = Arc::new(SkinSolid::new(mesh, Arc::clone(grid)).expect("a skin"));
    let roots: Vec<Vec3> = (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect();
    let roots = SkinRoots::new(mesh, &roots);
    let settings = Settings { time_step: 1.0 / rate, ..Settings::default() };
    let side = |shape: Shape| Side::new(guides, &settings, shape);
    let mut sides = [
        side(Shape::Skin(Arc::clone(&skin))),
        side(Shape::Skin(Arc::clone(&skin))),
        side(Shape::Grid(Arc::clone(grid))),
    ];
    let mut work = [0; 3];
    for frame in (1..=count).map(|step| frame(mesh, step as f32 / rate)) {
        let head = frame.world_from_head();
        let before = skin.work();
        sides[0].step(|last| roots.placed(frame, last));
        let after = skin.work();
        (0..3).for_each(|index| work[index] += after[index] - before[index]);
        sides[1].step(|last| roots.placed(BodyFrame::from(head).with_skin(mesh.positions.clone()), last));
        sides[2].step(|_| head.into());
    }
    println!(
        "\n{} triangles, {STRANDS} strands of {POINTS} points, {rate} steps a second",
        skin.triangle_count()
    );
    println!("median (least tenth) [ms] on the skin, on it at rest, on the rigid body");
    for name in sides[0].times.keys() {
        let row = sides.each_ref().map(|side| side.times(name).unwrap_or_default());
        let row = row.map(|Times { median, tenth }| format!("{median:8.2} ({tenth:6.2})"));
        println!("{name:16} {}", row.join(" "));
    }
    let numbers = sides[0].state.positions.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten();
    println!("bits {:016x}", bits(numbers));
    let [searches, looks, lines] = work.map(|work| work as f64 / count as f64);
    if searches > 0.0 {
        println!("a step: {searches:.0} searches, {:.1} triangles each, {lines:.0} lines", looks / searches);
    }
    let of = |name: &str| sides.each_ref().map(|side| side.times(name));
    Step {
        rate,
        steps: count,
        clock: of("= all"),
        processor: of("= processor").map(|times| times.filter(|_| one_thread())),
    }
}

/// Stages of the load of a body in a file with its clip, whose samples no earlier run has kept, once.
fn load(path: &Path, clip: &str, roots: &[Vec3]) -> (usize, Vec<(&'static str, f64)>) {
    let mut stages = Vec::new();
    let mut watch = Watch::start();
    let mut done =
        |stage: &'static str| stages.push((stage, std::mem::replace(&mut watch, Watch::start()).own()));
    let (mesh, motion, _) = Mesh::load_moving(path, clip).expect("a body with that clip");
    done("file");
    let grid = Arc::new(DistanceGrid::of_mesh(&mesh, SPACING, PADDING).expect("samples"));
    done("samples");
    SkinSolid::new(&mesh, grid).expect("a skin");
    done("skin");
    let body = SkinMotion::new(motion, Playback::default(), &mesh.positions, (1.0, Quat::IDENTITY), &[]);
    let body = body.expect("a motion of the body");
    done("motion");
    SkinRoots::new(&mesh, roots).placed(body.frame(0.0), &BodyFrame::REST);
    done("roots");
    (mesh.triangles.len(), stages)
}

fn loads(path: &Path, guides: &Guides) -> Load {
    let roots: Vec<Vec3> = (0..guides.strand_count()).map(|strand| guides.position(strand, 0)).collect();
    let mut all: BTreeMap<&'static str, Vec<f64>> = BTreeMap::new();
    let mut triangles = 0;
    for _ in 0..LOADS {
        let (count, stages) = load(path, "nod", &roots);
        triangles = count;
        let sum = stages.iter().map(|(_, ms)| ms).sum();
        stages
            .into_iter()
            .chain([("= all", sum)])
            .for_each(|(name, ms)| all.entry(name).or_default().push(ms));
    }
    let stages: Vec<_> = all.iter().map(|(name, times)| (*name, Times::of(times))).collect();
    println!("\nload of {triangles} triangles with a clip, of one thread in processor time");
    stages.iter().for_each(|(name, Times { median, tenth })| {
        println!("{name:16} {median:8.1} ms (least {tenth:8.1})");
    });
    Load { triangles, of_processor: one_thread() && processor_ms().is_some(), stages }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let steps_wanted = words.get(1).map_or(60, |text| text.parse().expect("a number of steps"));
    let bust = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb");
    let (mesh, guides) = (mesh(&bust), guides(STRANDS));
    let load = words.first().filter(|path| path.as_str() != "-").map(|path| loads(Path::new(path), &guides));
    let grid = Arc::new(DistanceGrid::of_mesh(&mesh, SPACING, PADDING).expect("samples"));
    let nodes = grid.nodes();
    println!("\nsamples: {}, bits {:016x}", nodes.len(), bits(nodes.iter().map(|node| node.w)));
    let [looks, exact] = grid.looks().map(|looks| looks as f64 / nodes.len() as f64);
    if looks > 0.0 {
        println!("each looked at {looks:.2} triangles, {exact:.2} exactly");
    }
    let steps = RATES.map(|rate| steps(&mesh, &grid, &guides, steps_wanted, rate));
    if let Some(path) = words.get(2) {
        Report { steps: steps.into(), load }.save(Path::new(path));
        println!("\nwrote {path}");
    }
}
