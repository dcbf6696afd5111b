use strandline::{Backend, Error, Event, Player, Scene};

use crate::progress::Progress;
use crate::sim::{Ended, Steps};
use crate::sim_report::SimReport;
use crate::statistics::{Collector, Times};

/// Plays a scene on the CPU and measures its steps, and its pictures when `draw`.
pub fn measure(scene: &Scene, draw: bool, what: &'static str) -> Result<(SimReport, Times, usize), Error> {
    let mut player = Player::new(scene, Backend::Cpu, draw)?;
    let (mut steps, mut pictures) = (Steps::default(), Collector::default());
    let mut segments = 0;
    let mut progress = Progress::new(u64::from(player.frames()), what, false);
    while let Some(event) = player.next() {
        match event? {
            Event::Note(note) => progress.note(&note),
            Event::Stepped(report) => {
                let note = steps.add(&report, player.frames_done());
                note.into_iter().for_each(|note| progress.note(&note));
            }
            Event::Drawn { report, .. } => {
                pictures.add(&report.seconds);
                segments = report.segments;
            }
        }
        progress.reached(u64::from(player.frames_done()));
    }
    let report = steps.report(Ended { backend: "cpu".to_owned(), ..Ended::of(&player, scene)? });
    Ok((report, pictures.times(), segments))
}
