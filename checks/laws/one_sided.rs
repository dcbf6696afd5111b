//! A one-sided volume holds hair apart, and leaves all other motion alone.

use glam::Vec3;
use strandline_checks::law;
use strandline_groom::LANES;
use strandline_sim::{State, VolumeMethod};

use crate::volume::wisps;

/// The largest distance \[m\] between the same points.
fn farthest(one: &State, other: &State) -> f32 {
    let pairs = one.positions.iter().zip(&other.positions);
    let each = pairs.flat_map(|(a, b)| (0..LANES).map(move |lane| a.get(lane).distance(b.get(lane))));
    each.fold(0.0, f32::max)
}

law! {
    long fn wisps_that_part_or_slide_past_each_other_do_not_feel_it(on) {
        for way in [Vec3::NEG_X, Vec3::Y] {
            let [with, without] = [Some(VolumeMethod::OneSided), None].map(|method| wisps(on, method, way));
            // An H200 rounds one of them otherwise.
            let far = farthest(&with, &without);
            assert!(far <= on.exact_or(0.0, 1e-7), "{way}: {far} m");
        }
        // The incompressible volume holds both back.
        let [with, without] =
            [Some(VolumeMethod::Incompressible), None].map(|method| wisps(on, method, Vec3::Y));
        let held = farthest(&with, &without);
        assert!(held > 2e-7, "{held} m");
    }
}
