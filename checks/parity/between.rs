//! Points between two states, carried by the roots of their strands.

use glam::{Quat, Vec3};
use strandline_body::{BodyFrame, Pose};
use strandline_checks::gpu;
use strandline_gpu::Buffer;
use strandline_groom::Vec3Lanes;
use strandline_sim::gpu::{PointCarrier, read_between};

use crate::heads::{apart, drive, heads};

/// Rounding \[m\] of places within half a metre of the origin: a device composes two motions before it applies them.
const ROUNDING: f32 = 1e-6;
const SHARE: f32 = 0.3;

/// Root frames of strands that turn about their own axes, a step after another.
fn roots(step: f32, strands: usize) -> BodyFrame {
    let root = |strand: usize| {
        let axis = Vec3::new(1.0, 0.1 * strand as f32, -0.5).normalize();
        Pose::rotation_about(Vec3::new(0.0, -0.1, 0.0), Quat::from_axis_angle(axis, 0.3 * step))
    };
    BodyFrame::REST.with_roots((0..strands).map(root).collect::<Vec<_>>())
}

#[test]
fn points_between_two_states_follow_the_body_as_on_the_host() {
    let Some(gpu) = gpu() else { return };
    let mut carrier = PointCarrier::new(&gpu).unwrap();
    for head in [&heads()[0], &heads()[1]] {
        let model = head.model();
        let state = head.moving(&model).state;
        let upload = |name, lanes: &[Vec3Lanes]| {
            let numbers: Vec<f32> =
                lanes.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten().collect();
            Buffer::from_slice(&gpu, name, &numbers).unwrap()
        };
        let before = upload("before", &state.previous_positions);
        let after = upload("after", &state.positions);
        let carried = Buffer::new(&gpu, "carried", after.len()).unwrap();
        let shape = [model.strand_count(), model.points_per_strand()];
        let rigid = [4, 9, 6].map(|step| drive(step).body);
        let own = [4.0, 5.0, 4.4].map(|step| roots(step, shape[0]));
        // One motion for all, then more rows than before, then one again.
        for bodies in [&rigid, &own, &rigid] {
            let [first, last, moment] = bodies;
            let mut expected = Vec::new();
            state.carried([first, last], moment, SHARE, &mut expected);
            carrier.carry([&before, &after], bodies.each_ref(), SHARE, shape, &carried).unwrap();
            let mut found = Vec::new();
            read_between([&carried, &carried], SHARE, &mut found).unwrap();
            let off = apart(&expected, &found, &head.guides);
            assert!(off < ROUNDING, "{}: {off} m", head.name);
            read_between([&before, &after], SHARE, &mut found).unwrap();
            let straight = apart(&expected, &found, &head.guides);
            assert!(straight > 1e-3, "{}: straight lines are {straight} m away", head.name);
        }
    }
}
