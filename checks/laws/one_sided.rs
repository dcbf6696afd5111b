//! A one-sided volume holds hair apart, and leaves all other motion alone.

use glam::Vec3;
use strandline_checks::law;
use strandline_groom::{LANES, Vec3Lanes};
use strandline_sim::{State, VolumeMethod};

use crate::volume::wisps;

/// Positions of all points, to the bit.
fn bits(state: &State) -> Vec<[u32; 3]> {
    let lanes =
        |at: &Vec3Lanes| (0..LANES).map(|lane| at.get(lane).to_array().map(f32::to_bits)).collect::<Vec<_>>();
    state.positions.iter().flat_map(lanes).collect()
}

law! {
    long fn wisps_that_part_or_slide_past_each_other_do_not_feel_it(on) {
        for way in [Vec3::NEG_X, Vec3::Y] {
            let [with, without] =
                [Some(VolumeMethod::OneSided), None].map(|method| bits(&wisps(on, method, way)));
            assert!(with == without, "{way}");
        }
        // The incompressible volume holds both back.
        let [with, without] =
            [Some(VolumeMethod::Incompressible), None].map(|method| bits(&wisps(on, method, Vec3::Y)));
        assert!(with != without);
    }
}
