//! Sheets of hair in motion: strands of constraints above, rods below.

use glam::Vec3;
use strandline::{Look, Pose, Style, scene::MotionName, settings::StrandMethod};

use crate::setup::{FRAME, Figure, Moving, Setup, THREE_QUARTER, bust};
use crate::strip::{joined, stacked};

/// Size of a picture \[pixel\].
const SIZE: u32 = 128;
/// When pictures are taken \[s\]: the first of all shows hair that nothing has moved yet.
const TIMES: [f64; 7] = [0.0, 0.2, 0.4, 0.6, 0.9, 1.2, 1.8];
/// When the head comes to rest \[s\], and the hand lets go.
const REST: f64 = 0.65;
/// Distance that the hand pulls \[m\].
const PULL: Vec3 = Vec3::new(0.12, 0.10, 0.06);
/// Radius of the hand \[m\].
const HAND: f32 = 0.03;

/// Cause of the motion.
#[derive(Clone, Copy)]
enum Drive {
    /// The head, and then it rests.
    Head(MotionName),
    /// Air from the head's right.
    Wind,
    /// A hand at a lock on the left, which lets go.
    Hand,
}

/// All causes of motion.
const DRIVES: [Drive; 5] = [
    Drive::Head(MotionName::Shake),
    Drive::Head(MotionName::Nod),
    Drive::Head(MotionName::Turn),
    Drive::Wind,
    Drive::Hand,
];

/// Two rows for each way to be moved: with constraints and as rods. A quick sheet has one way, the next style the next.
pub fn sheet(setup: &Setup, style: Style) -> Figure {
    let mut rows = Vec::new();
    let drives = if setup.quick { &DRIVES[style as usize % DRIVES.len()..][..1] } else { &DRIVES };
    for &drive in drives {
        for method in [StrandMethod::Constrain, StrandMethod::Rods] {
            rows.push(row(setup, style, drive, method)?);
        }
    }
    Ok(stacked(&rows))
}

fn row(setup: &Setup, style: Style, drive: Drive, method: StrandMethod) -> Figure {
    let motion = if let Drive::Head(name) = drive { name } else { MotionName::Still };
    let mut scene = setup.scene(style, motion);
    scene.simulation.strands.method = method;
    let mut moving = setup.settled(&scene, SIZE, SIZE)?;
    let camera = bust(THREE_QUARTER);
    let mut look = Look { follow_strands: scene.look.follow_strands.min(8), ..scene.look.clone() };
    if setup.quick {
        // Most of the time of a small picture goes into its shadow maps.
        look.shadow.map_size = 128;
    }
    let (rest, mut pictures) = (setup.lasting(REST), Vec::new());
    // The first and the last.
    let every = if setup.quick { TIMES.len() - 1 } else { 1 };
    for time in TIMES.into_iter().step_by(every) {
        moved(&mut moving, drive, setup.lasting(time), rest)?;
        pictures.push(moving.hair.picture(&camera, &look)?);
    }
    Ok(joined(&pictures))
}

/// Lets hair move on to a time \[s\]; at `rest` \[s\] the head comes to rest, and the hand lets go.
fn moved(moving: &mut Moving, drive: Drive, time: f64, rest: f64) -> Result<(), Box<dyn std::error::Error>> {
    match drive {
        Drive::Head(_) => moving.play_to_and_rest(time, rest)?,
        Drive::Wind => {
            moving.hair.wind = if time > 0.0 { Vec3::new(4.0, 0.0, 0.0) } else { Vec3::ZERO };
            moving.play_to(time)?;
        }
        Drive::Hand => pulled(moving, time, rest)?,
    }
    Ok(())
}

/// The hand takes a lock at once, pulls it evenly and lets go when it is there, at `rest` \[s\].
fn pulled(moving: &mut Moving, time: f64, rest: f64) -> Result<(), strandline::Error> {
    if time == 0.0 {
        let guides = moving.hair.guides();
        let last = guides.points_per_strand() - 1;
        let tips = (0..guides.strand_count()).map(|strand| guides.position(strand, last));
        // The tip that is farthest to the left and to the front.
        let aside = |tip: &Vec3| tip.x + tip.z;
        let taken = tips.max_by(|one, two| aside(one).total_cmp(&aside(two))).unwrap_or_default();
        moving.hair.grab(taken, HAND)?;
        moving.held = Some(taken);
    }
    while moving.time < time - 0.5 * FRAME {
        if let Some(taken) = moving.held {
            let share = ((moving.time + FRAME) / rest).min(1.0) as f32;
            moving.hair.move_hand(taken + PULL * share);
            if share == 1.0 {
                moving.hair.release()?;
                moving.held = None;
            }
        }
        moving.hair.step(FRAME, Pose::IDENTITY)?;
        moving.time += FRAME;
    }
    Ok(())
}
