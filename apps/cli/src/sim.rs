//! `strandline sim`: steps without pictures.

use strandline::file::counted;
use strandline::mesh::Placement;
use strandline::{
    Cache, Drift, Event, Jump, Measures, OutSettings, Player, Scene, StepReport, Stiffening, Written,
};

use crate::arguments::SimOptions;
use crate::interrupt::Stoppable;
use crate::non_finite::{NonFinite, larger};
use crate::output::{self, print_line};
use crate::progress::{LOADING, Progress, Waiting};
use crate::sim_report::{Contacts, JumpReport, OutReport, Pcg, Rods, SimReport, Spread, Stretch};
use crate::statistics::Collector;

/// Gathers step reports: sums and largest values.
#[derive(Debug, Default)]
pub struct Steps {
    times: Collector,
    stretch: f64,
    iterations: f64,
    iterations_absolute: f64,
    fluid_cells: f64,
    residual_max: f32,
    /// Of each step \[m/s\].
    absolute_residuals: Vec<f32>,
    stretch_max: f32,
    penetration_max: f32,
    /// Mean and largest speed of each step.
    speeds: Vec<(f32, f32)>,
    rods: Option<Rods>,
    contacts: Option<Contacts>,
    non_finite: NonFinite,
}

/// State of a simulation after its last step.
pub struct Ended {
    /// The device.
    pub backend: String,
    pub strands: usize,
    pub points_per_strand: usize,
    pub drift: Drift,
    pub measures: Measures,
    pub stiffening: Stiffening,
    pub jumps: Vec<Jump>,
    pub placement: Placement,
    /// \[s\].
    pub time_step: f32,
    /// Of the pressure solve.
    pub tolerance: f32,
}

impl Ended {
    /// State of a player's simulation.
    ///
    /// # Errors
    /// The GPU was lost.
    pub fn of(player: &Player, scene: &Scene) -> Result<Self, strandline::Error> {
        let guides = player.guides();
        Ok(Self {
            backend: player.simulated_on(),
            strands: guides.strand_count(),
            points_per_strand: guides.points_per_strand(),
            drift: player.drift()?,
            measures: player.measures()?,
            stiffening: player.stiffening(),
            jumps: player.jumps(),
            placement: player.placement(),
            time_step: scene.simulation.time_step,
            tolerance: scene.simulation.volume.tolerance,
        })
    }
}

impl Steps {
    /// Adds a step of a frame; returns notes for the user.
    pub fn add(&mut self, report: &StepReport, frame: u32) -> Option<String> {
        self.times.add(&report.seconds);
        self.stretch += f64::from(report.stretch_mean);
        self.iterations += report.pressure.iterations as f64;
        self.iterations_absolute += report.pressure.iterations_absolute as f64;
        self.fluid_cells += report.pressure.fluid_cells as f64;
        self.residual_max = self.residual_max.max(report.pressure.relative_residual);
        self.absolute_residuals.push(report.pressure.absolute_residual);
        self.stretch_max = larger(self.stretch_max, report.stretch_max);
        self.penetration_max = self.penetration_max.max(report.penetration_max);
        self.speeds.push((report.speed_mean, report.speed_max));
        if let Some(step) = &report.rods {
            let rods = self.rods.get_or_insert_default();
            rods.residual_max_rad = rods.residual_max_rad.max(step.residual);
            rods.unsolved_max = rods.unsolved_max.max(step.unsolved);
            rods.resting = step.resting;
        }
        if let Some(step) = &report.contacts {
            let contacts = self.contacts.get_or_insert_default();
            contacts.pairs = step.pairs;
            contacts.deepest_m = contacts.deepest_m.max(step.deepest);
            contacts.crossed_max = contacts.crossed_max.max(step.crossed);
        }
        self.non_finite.add(report, frame)
    }

    /// Mean and largest speed \[m/s\] of the last steps.
    fn speed(&self, count: usize) -> Spread {
        let last = &self.speeds[self.speeds.len().saturating_sub(count)..];
        // The sum of nothing is -0.
        let mean = last.iter().map(|(mean, _)| mean).sum::<f32>() / last.len().max(1) as f32 + 0.0;
        Spread { mean, max: last.iter().fold(0.0, |most: f32, (_, max)| most.max(*max)) }
    }

    pub fn report(&self, end: Ended) -> SimReport {
        let Ended { backend, strands, points_per_strand, drift, .. } = end;
        let mean = |sum: f64| sum / self.times.len().max(1) as f64;
        SimReport {
            backend,
            strands,
            points_per_strand,
            steps: self.times.len(),
            placement: end.placement,
            ms_per_step: self.times.times(),
            stretch: Stretch { mean: mean(self.stretch), max: self.stretch_max },
            penetration_max_m: self.penetration_max,
            drift: Spread { mean: drift.mean, max: drift.max },
            air: end.measures.air.map(Spread::from),
            density: end.measures.density.map(Spread::from),
            speed: self.speed((1.0 / end.time_step).round() as usize),
            stiffened: end.stiffening.strands,
            stiffest: end.stiffening.most,
            rods: self.rods,
            contacts: self.contacts,
            jumps: end.jumps.into_iter().map(JumpReport::from).collect(),
            non_finite: self.non_finite.clone(),
            pcg: Pcg {
                iterations_mean: mean(self.iterations),
                iterations_absolute_mean: mean(self.iterations_absolute),
                absolute_unmet: self
                    .absolute_residuals
                    .iter()
                    .filter(|found| **found > end.tolerance)
                    .count(),
                residual_max: self.residual_max,
            },
            fluid_cells_mean: mean(self.fluid_cells),
            out: None,
        }
    }
}

pub fn sim(options: &SimOptions) -> anyhow::Result<()> {
    let inputs = &options.inputs;
    let mut former = options.resume.as_deref().map(Cache::open_to_resume).transpose()?;
    let scene = match &former {
        Some(cache) => inputs.scene_of(cache)?,
        None => inputs.scene()?,
    };
    let out = out_settings(options, former.as_ref());
    out.as_ref().map_or(Ok(()), OutSettings::check)?;
    let (mut player, stoppable) = begin(&scene, out, former.as_mut())?;
    drop(former);
    let mut steps = Steps::default();
    let played = play(&mut player, &mut steps, &stoppable, inputs.json);
    let written = close(&mut player, played)?;
    stoppable.finish();
    let mut report = steps.report(Ended::of(&player, &scene)?);
    report.out = written.map(|written| OutReport {
        path: written.place,
        frames: written.frames,
        strands: written.strands,
        points: written.points,
        bytes: written.bytes,
        seconds: written.time.as_secs_f64(),
    });
    if inputs.json {
        output::program(&format!("{}\n", serde_json::to_string(&report)?));
    } else {
        print(&report);
    }
    Ok(report.non_finite.outcome()?)
}

/// Settings of the output: those of the command line, or those of a cache that is resumed.
fn out_settings(options: &SimOptions, former: Option<&Cache>) -> Option<OutSettings> {
    let mut settings = OutSettings::new(options.out.as_ref().or(options.resume.as_ref())?);
    settings.what = options.what.or(former.map(Cache::what)).unwrap_or_default();
    settings.every = options.every.or(former.map(Cache::every)).unwrap_or(1);
    settings.first = options.from.or(former.map(Cache::first)).unwrap_or(0);
    settings.target = options.target.unwrap_or_default();
    Some(settings)
}

/// Player with its output; a request to stop waits until the file is closed.
fn begin(
    scene: &Scene,
    out: Option<OutSettings>,
    former: Option<&mut Cache>,
) -> anyhow::Result<(Player, Stoppable)> {
    let waiting = Waiting::begin(LOADING);
    let mut player = Player::new(scene, scene.devices, false)?;
    drop(waiting);
    let stoppable = Stoppable::begin();
    let resumed = out.map_or(Ok(()), |settings| player.set_out(&settings)).and_then(|()| match former {
        Some(former) => player.resume(former),
        None => Ok(()),
    });
    player.notes().iter().for_each(|note| output::note(note));
    let stiffening = player.stiffening();
    if stiffening.strands > 0 {
        output::note(&format!("{stiffening}: their shape would not be stable"));
    }
    resumed?;
    Ok((player, stoppable))
}

fn play(player: &mut Player, steps: &mut Steps, stoppable: &Stoppable, quiet: bool) -> anyhow::Result<()> {
    let mut progress = Progress::new(u64::from(player.frames()), "frames", quiet);
    while let Some(event) = player.next() {
        match event? {
            Event::Note(note) => progress.note(&note),
            // Its frame is taken and counts as done.
            Event::Stepped(report) => {
                let note = steps.add(&report, player.frames_done().saturating_sub(1));
                note.into_iter().for_each(|note| progress.note(&note));
            }
            Event::Drawn { .. } => {}
        }
        let (done, frames) = (u64::from(player.frames_done()), u64::from(player.frames()));
        progress.reached(done);
        if done < frames {
            stoppable.check(done, frames, "frames")?;
        }
    }
    Ok(())
}

/// Closes the output, also of a run that was stopped early, and then reports its files.
fn close(player: &mut Player, played: anyhow::Result<()>) -> anyhow::Result<Option<Written>> {
    let written = player.close_out();
    let Err(error) = played else {
        let written = written?;
        for part in written.iter().flat_map(|written| &written.left_out) {
            output::note(&format!("the format cannot hold {part}: left out"));
        }
        written.iter().flat_map(|written| &written.notes).for_each(|note| output::note(note));
        return Ok(written);
    };
    match written {
        Ok(Some(written)) if written.frames > 0 => output::note(&format!(
            "the {} whole; `sim --resume` continues from a cache: {}",
            counted(written.frames, "frame so far is", "frames so far are"),
            written.place.display()
        )),
        // One error is enough.
        Ok(_) | Err(_) => {}
    }
    Err(error)
}

fn print(report: &SimReport) {
    let SimReport { strands, points_per_strand, steps, ms_per_step, stretch, pcg, .. } = report;
    let [strands, steps] = [counted(*strands, "strand", "strands"), counted(*steps, "step", "steps")];
    print_line!("{strands} x {points_per_strand} points, {steps} on {}", report.backend);
    print_line!("a step takes {:.2} ms (95 of 100 at most {:.2} ms)", ms_per_step.median, ms_per_step.p95);
    for (name, time) in ms_per_step.stages.iter() {
        print_line!("  {name:<15}{time:>8.3} ms");
    }
    print_line!("stretch: mean {:.4} %, largest {:.3} %", 100.0 * stretch.mean, 100.0 * stretch.max);
    print_line!("deepest point inside a solid: {:.2} mm", 1e3 * report.penetration_max_m);
    print_line!(
        "from the groom as loaded: mean {:.3} %, largest {:.2} % of a strand",
        100.0 * report.drift.mean,
        100.0 * report.drift.max
    );
    print_line!("in the last second: mean {:.4} m/s, largest {:.3} m/s", report.speed.mean, report.speed.max);
    if let Some(air) = &report.air {
        print_line!("air: mean {:.2}, largest {:.2} of a guide's weight", air.mean, air.max);
    }
    if let Some(density) = &report.density {
        print_line!("density over that at rest: mean {:.2}, largest {:.2}", density.mean, density.max);
    }
    if let Some(rods) = &report.rods {
        print_line!(
            "rods: {} stiffened, up to {:.1} times, {} at rest, at most {} in a step not solved, residual {:.1e} rad",
            report.stiffened,
            report.stiffest,
            rods.resting,
            rods.unsolved_max,
            rods.residual_max_rad
        );
    }
    if let Some(contacts) = &report.contacts {
        print_line!(
            "strands on strands: {} pairs press, deepest {:.2} mm, at most {} crossed in a step",
            contacts.pairs,
            1e3 * contacts.deepest_m,
            contacts.crossed_max
        );
    }
    print_line!("points that are not finite: {}", report.non_finite.points);
    print_line!(
        "pressure: {:.1} iterations on {:.0} fluid cells, largest residual {:.1e}",
        pcg.iterations_mean,
        report.fluid_cells_mean,
        pcg.residual_max
    );
    if let Some(OutReport { path, frames, strands, points, bytes, .. }) = &report.out {
        let megabytes = 1e-6 * *bytes as f64;
        print_line!(
            "wrote {} of {}, {}, {megabytes:.1} MB to {}",
            counted(*frames, "frame", "frames"),
            counted(*strands, "strand", "strands"),
            counted(*points, "point", "points"),
            path.display()
        );
    }
}
