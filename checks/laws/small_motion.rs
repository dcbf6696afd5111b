//! Small swings of rods: a lone strand rests where it hangs.

use glam::{Vec3, vec3};
use strandline_checks::{On, Rig, law};
use strandline_sim::{Drive, Model, State};

use crate::rod_waves::{LENGTH, TIP, hanging};
use crate::strands::{first, line, one_strand};

law! {
    fn a_small_swing_ends_where_the_hair_hangs(on) {
        for volume in [false, true] {
            for rate in [60.0, 240.0].into_iter().take(on.either(2, 1)) {
                small_swing(on, rate, volume);
            }
        }
    }
}

/// Lets a strand go 2 % of its length aside and looks after five seconds.
fn small_swing(on: &On, rate: f32, volume: bool) {
    let mut settings = hanging(1.0 / rate).settings().clone();
    settings.volume.enabled = volume;
    let strand = one_strand(&line(Vec3::ZERO, Vec3::NEG_Y * LENGTH, TIP));
    let mut rig = Rig::new(on, Model::new(&strand, &settings, Vec::new()).unwrap());
    let tip = first(rig.state())[TIP];
    assert_eq!(rig.grab(tip, 1e-3), 1);
    let aside = tip + vec3(0.02 * LENGTH, 1e-4, 0.0);
    let pull = |step: usize| {
        let hand = tip.lerp(aside, (step as f32 / (0.5 * rate)).min(1.0));
        Drive { hand: Some(hand), ..Drive::default() }
    };
    rig.steps(&(1..=rate as usize).map(pull).collect::<Vec<_>>());
    rig.change(State::release);
    let start = first(rig.state())[TIP].x;
    let (mut rests, mut passages, mut before) = (false, 0, start);
    for _ in 0..(5.0 * rate) as usize {
        rests = rig.step(&Drive::default()).rods.unwrap().resting == 1;
        let now = first(rig.state())[TIP].x;
        passages += usize::from(now * before < 0.0);
        before = now;
    }
    let case = format!("1/{rate} s, volume {volume}");
    assert!(start > 0.019 * LENGTH, "{case}: let go {start} m aside");
    assert!(passages > 0, "{case}: it creeps back");
    assert!(before.abs() < 2e-3 * LENGTH, "{case}: {before} m beside its rest");
    assert!(rests, "{case}: not still after 5 s");
}
