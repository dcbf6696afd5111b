//! Points that are not finite or have no direction do no harm.

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_sim::constrain::{Spring, Springs};
use strandline_sim::{Drive, Model, Settings, VolumeSettings};

use crate::strands::{bare, chain, first, line, one_strand};

/// A strand with springs and bends, no volume.
fn strand(on: &On) -> Rig {
    let spring = Spring { enabled: true, ..Spring::default() };
    let settings = Settings {
        volume: VolumeSettings { enabled: false, ..VolumeSettings::default() },
        ..Settings::constrained()
    }
    .with_constrain(|constrain| {
        constrain.springs = Springs { stretch: spring, bend: spring, torsion: spring }
    });
    let guides = one_strand(&line(Vec3::ZERO, Vec3::X * 0.3, 11));
    Rig::new(on, Model::new(&guides, &settings, Vec::new()).unwrap())
}

law! {
    fn points_in_one_place_come_apart(on) {
        // The two ends of a stretch, a bend and a torsion spring; and all free points.
        for places in [vec![5, 6], vec![5, 7], vec![5, 8], (2..12).collect()] {
            let mut rig = strand(on);
            rig.change(|state| {
                let place = state.positions[places[0]].get(0);
                for point in &places {
                    (0..8).for_each(|lane| state.positions[*point].set(lane, place));
                }
            });
            for step in 0..60 {
                let report = rig.step(&Drive::default());
                assert_eq!(report.non_finite, 0, "{places:?}, step {step}");
            }
            for pair in first(rig.state()).windows(2) {
                let length = pair[0].distance(pair[1]) / (0.3 / 11.0);
                // Lengths are exact but for rounding.
                assert!((length - 1.0).abs() < 1e-4, "{places:?}: a segment of {length} lengths");
            }
        }
    }
}

law! {
    fn a_hand_at_a_joint_holds_like_any_other(on) {
        let settings = bare(1.0 / 60.0, 20).with_constrain(|constrain| constrain.length_pass = Default::default());
        let mut rig = Rig::new(on, chain(&line(Vec3::ZERO, Vec3::NEG_Y, 16), 1.0, |point| point == 0, &settings));
        assert_eq!(rig.grab(Vec3::NEG_Y, 0.01), 1);
        for step in 1..=120 {
            // Each joint in turn is elsewhere for some steps, the head's among them.
            let joint = first(rig.state())[15 - step / 8];
            let report = rig.step(&Drive { hand: Some(joint), ..Drive::default() });
            assert_eq!(report.non_finite, 0, "step {step}");
            assert!(report.stretch_max < 1e-3, "step {step}: {}", report.stretch_max);
        }
        let missed = first(rig.state())[16].length();
        assert!(missed < 1e-2, "the hand at the root missed by {missed} m");
    }
}

law! {
    fn a_strand_that_recovers_leaves_no_streak(on) {
        let mut rig = strand(on);
        rig.steps(&vec![Drive::default(); 20]);
        rig.change(|state| state.velocities[7].set(0, Vec3::NAN));
        let report = rig.step(&Drive::default());
        assert!(report.non_finite > 0);
        let state = rig.state();
        for (point, (now, before)) in state.positions.iter().zip(&state.previous_positions).enumerate() {
            let rest = Vec3::X * 0.3 * point as f32 / 11.0;
            assert!(now.get(0).distance(rest) < 1e-6, "point {point} is at {}", now.get(0));
            assert_eq!(before.get(0), now.get(0), "point {point} has been elsewhere");
            assert_eq!((state.velocities[point].get(0), state.corrections[point].get(0)), (Vec3::ZERO, Vec3::ZERO));
        }
    }
}
