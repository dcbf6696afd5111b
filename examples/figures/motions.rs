//! Sheets of hair in motion: strands of constraints above, rods below.

use glam::Vec3;
use strandline::{Camera, Look, Picture, Pose, Scene, Style, scene::MotionName, settings::StrandMethod};

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

/// Two rows for each way to be moved: with constraints and as rods.
pub fn sheet(setup: &Setup, style: Style) -> Figure {
    let heads = [MotionName::Shake, MotionName::Nod, MotionName::Turn].map(Drive::Head);
    let mut rows = Vec::new();
    for drive in heads.into_iter().chain([Drive::Wind, Drive::Hand]) {
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
    let mut pictures = Vec::new();
    for time in TIMES {
        moved(&mut moving, drive, time)?;
        pictures.push(picture(&mut moving, &scene, &camera)?);
    }
    Ok(joined(&pictures))
}

fn picture(moving: &mut Moving, scene: &Scene, camera: &Camera) -> Result<Picture, strandline::Error> {
    let look = Look { follow_strands: scene.look.follow_strands.min(8), ..scene.look.clone() };
    moving.hair.picture(camera, &look)
}

/// Lets hair move on to a time \[s\].
fn moved(moving: &mut Moving, drive: Drive, time: f64) -> Result<(), Box<dyn std::error::Error>> {
    match drive {
        Drive::Head(_) => moving.play_to_and_rest(time, REST)?,
        Drive::Wind => {
            moving.hair.wind = if time > 0.0 { Vec3::new(4.0, 0.0, 0.0) } else { Vec3::ZERO };
            moving.play_to(time)?;
        }
        Drive::Hand => pulled(moving, time)?,
    }
    Ok(())
}

/// The hand takes a lock at once, pulls it evenly and lets go when it is there.
fn pulled(moving: &mut Moving, time: f64) -> Result<(), strandline::Error> {
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
            let share = ((moving.time + FRAME) / REST).min(1.0) as f32;
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
