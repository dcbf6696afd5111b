//! The neck of the built-in bust: what stays, what follows, and how well its rigid parts stand for the bent skin.

use std::sync::{Arc, LazyLock};

use glam::{Quat, Vec3};
use strandline_base::math;
use strandline_body::{
    BodyFrame, Carrier, Collider, CommonCaps, DistanceGrid, Mannequin, Mesh, MovedSkin, Neck, Pose, Shape,
    SignedDistance,
};

/// The largest angles of the built-in motions, and a chin on the chest \[degrees\]: pitch, yaw, roll.
const BENDS: [[f32; 3]; 4] = [[0.0, 35.0, 0.0], [20.0, 0.0, 0.0], [0.0, 60.0, 0.0], [35.0, 0.0, 0.0]];

static MESH: LazyLock<Mesh> = LazyLock::new(|| Mesh { neck: Some(neck()), ..Mannequin::default().mesh() });
static BUST: LazyLock<DistanceGrid> =
    LazyLock::new(|| DistanceGrid::from_field(&Mannequin::default(), 0.004, 0.02).unwrap());

fn neck() -> Neck {
    Neck::new(Mannequin::default().neck_pivot())
}

/// A head that is turned about the pivot of its neck, on shoulders that rest.
fn frame(bend: [f32; 3]) -> BodyFrame {
    let turn = math::pitch_yaw_roll(Vec3::from(bend));
    let head = Pose::rotation_about(Mannequin::default().neck_pivot(), turn);
    BodyFrame::from(head).with_pieces(neck().pieces(&head, &Pose::IDENTITY))
}

/// Vertices \[m\] and normals of the bent bust, head space.
fn skin(bend: [f32; 3]) -> [Vec<Vec3>; 2] {
    let mut skin = MovedSkin::default();
    assert!(skin.take(&MESH, &frame(bend)) && !skin.take(&MESH, &frame(bend)));
    skin.shape(&MESH).map(<[Vec3]>::to_vec)
}

fn angle(rotation: Quat) -> f32 {
    2.0 * math::asin(rotation.xyz().length().min(1.0)).to_degrees()
}

#[test]
fn shoulders_stay_and_the_head_moves_as_one() {
    for bend in BENDS {
        let ([skin, normals], head) = (skin(bend), frame(bend).world_from_head());
        let (mut still, mut rigid) = (0, 0);
        for (index, rest) in MESH.positions.iter().enumerate() {
            let (in_world, normal) = (head.point(skin[index]), head.direction(normals[index]));
            if rest.y > -0.075 {
                assert_eq!((skin[index], normals[index]), (*rest, MESH.normals[index]));
                rigid += 1;
            } else if rest.y < -0.24 {
                assert!(in_world.distance(*rest) < 1e-6, "{rest}");
                assert!(normal.distance(MESH.normals[index]) < 1e-5, "{rest}");
                still += 1;
            }
        }
        assert!(still > 5_000 && rigid > 20_000, "{still} {rigid}");
    }
    assert!(!MovedSkin::default().take(&MESH, &frame([0.0; 3])), "at rest to the bit");
    assert_eq!(MESH.positions_in(&frame([0.0, 35.0, 0.0])), skin([0.0, 35.0, 0.0])[0]);
    let as_one = BodyFrame::from(frame(BENDS[0]).world_from_head());
    assert!(!MovedSkin::default().take(&MESH, &as_one), "a bust without pieces moves as one");
}

#[test]
fn roots_of_hair_ride_the_head() {
    let [skin, _] = skin([35.0, 60.0, 0.0]);
    let moves: Vec<Vec3> =
        MESH.positions.iter().zip(&skin).filter(|(rest, bent)| rest != bent).map(|(rest, _)| *rest).collect();
    for root in Mannequin::default().scalp().roots(400, 3) {
        // Vertices lie 2.2 mm apart.
        let near = moves.iter().any(|place| place.distance(root.position) < 0.0012);
        assert!(!near, "{}", root.position);
    }
}

#[test]
fn a_bend_is_shared_as_a_person_shares_it() {
    // The two middle parts have the shares below the fourth vertebra of all bend and of all axial rotation [White1990].
    for (bend, expected) in [([40.0, 0.0, 0.0], 66.0 / 136.0), ([0.0, 60.0, 0.0], 22.0 / 77.0)] {
        let [low, high, head] = [4, 5, 0].map(|piece| angle(frame(bend).piece(piece).rotation));
        assert!((0.5 * (low + high) / head - expected).abs() < 0.04, "{low} and {high} of {head}");
    }
    for bend in BENDS {
        let angles: Vec<f32> =
            (1..=Neck::PIECES).map(|piece| angle(frame(bend).piece(piece).rotation)).collect();
        assert!(angles[0] == 0.0 && angles.is_sorted(), "{angles:?}");
    }
}

#[test]
fn shoulders_follow_a_great_rotation_without_a_jump() {
    let left = |degrees: f32| {
        let rotation = math::rotation(Vec3::Y, degrees.to_radians());
        angle(Neck::of_shoulders(rotation).conjugate() * rotation)
    };
    assert_eq!(Neck::of_shoulders(math::rotation(Vec3::Y, 1.3)), Quat::IDENTITY);
    let mut last = 0.0;
    for degrees in 0..=720 {
        let angle = left(degrees as f32);
        assert!(angle < 95.0 && (angle - last).abs() < 4.0, "{degrees}: {angle} after {last}");
        last = angle;
    }
    assert!(left(180.0) < 0.1);
}

#[test]
fn the_skin_does_not_fold() {
    for bend in BENDS {
        let [skin, normals] = skin(bend);
        let mut least = f32::INFINITY;
        for corners in &MESH.triangles {
            let face = |positions: &[Vec3]| {
                let [a, b, c] = corners.map(|corner| positions[corner as usize]);
                (b - a).cross(c - a)
            };
            let mean = |normals: &[Vec3]| corners.map(|corner| normals[corner as usize]).iter().sum::<Vec3>();
            let (rest, bent) = (face(&MESH.positions), face(&skin));
            // Creases aside, faces lie square to the normals of their corners.
            if rest.normalize_or_zero().dot(mean(&MESH.normals)) > 2.9 {
                assert!(bent.normalize_or_zero().dot(mean(&normals)) > 2.5, "{bend:?} {corners:?}");
                least = least.min(bent.length() / rest.length());
            }
        }
        assert!(least > 0.25, "{bend:?}: {least} of an area is left");
    }
}

/// Signed distance \[m\] and gradient of the nearest part to a point of the world.
fn nearest(parts: &[(DistanceGrid, Carrier)], frame: &BodyFrame, point: Vec3) -> (f32, Vec3) {
    let of_part = |(part, carrier): &(DistanceGrid, Carrier)| {
        let Carrier::Piece(piece) = carrier else { return (f32::INFINITY, Vec3::Y) };
        let piece = frame.piece(usize::from(*piece));
        let (distance, gradient) = part.distance_and_gradient(piece.inverse().point(point));
        (distance, piece.direction(gradient))
    };
    parts.iter().map(of_part).min_by(|one, other| one.0.total_cmp(&other.0)).expect("parts")
}

#[test]
fn parts_at_rest_are_the_bust() {
    let parts = neck().solids(&BUST);
    assert_eq!(parts.len(), 1 + Neck::PIECES);
    let (mut same, mut worst) = (0, 0.0_f32);
    for (index, (position, normal)) in MESH.positions.iter().zip(&MESH.normals).enumerate() {
        let point = *position + *normal * (0.003 * (index % 5) as f32 - 0.004);
        let (whole, gradient) = BUST.distance_and_gradient(point);
        let (distance, slope) = nearest(&parts, &BodyFrame::REST, point);
        // Cells at the ends of the parts mix what is cut with what is not: 1.6 mm were seen, on broad collar bones.
        worst = worst.max((distance - whole).abs());
        if point.y > -0.07 {
            assert_eq!((distance, slope), (whole, gradient), "the head keeps its bits");
            same += 1;
        }
    }
    assert!(worst < 2e-3, "{worst} m");
    assert!(same > 20_000);
}

/// The planes that cut a part out are never farther than the part, and tell of most of the bust that it is far.
#[test]
fn planes_of_parts_tell_no_more_than_their_distance() {
    let (mut told, mut all) = (0, 0);
    for (part, _) in neck().solids(&BUST) {
        let caps = part.caps().unwrap();
        for (index, place) in MESH.positions.iter().enumerate().step_by(3) {
            let point = *place + MESH.normals[index] * (0.01 * (index % 7) as f32 - 0.02);
            let (beyond, distance) = (caps.beyond(point), part.distance(point));
            // Rounding of samples.
            assert!(distance >= 0.0 || beyond <= 1e-5, "{point}: {beyond} beyond, {distance} deep");
            // Beside the box of samples a distance is a lower bound.
            let is_sampled = (point - point.clamp(part.bounds().min, part.bounds().max)) == Vec3::ZERO;
            assert!(
                !is_sampled || beyond <= distance.max(0.0) + 1e-5,
                "{point}: {beyond} beyond, {distance}"
            );
            told += usize::from(beyond > 0.02);
            all += 1;
        }
    }
    assert!(2 * told > all, "{told} of {all}");
}

/// The planes about all parts of the neck are never farther than the skin of a part, and tell of most of the head that all
/// are far.
#[test]
fn planes_about_all_parts_hold_each() {
    let solid = |(part, carrier)| Collider::new(Shape::Grid(Arc::new(part)), carrier, 0.3).unwrap();
    let colliders: Vec<Collider> = neck().solids(&BUST).into_iter().map(solid).collect();
    for bend in BENDS {
        let ([skin, normals], frame) = (skin(bend), frame(bend));
        let pose = |collider: &Collider| match collider.carrier {
            Carrier::Piece(piece) => frame.piece(usize::from(piece)),
            Carrier::World | Carrier::Moved(_) => Pose::IDENTITY,
        };
        let common = CommonCaps::of(&colliders, |collider| [Pose::IDENTITY, pose(collider)]).unwrap();
        assert_eq!(common.parts, 2..8);
        let parts = &colliders[common.parts.clone()];
        let on_parts: Vec<Vec3> = parts
            .iter()
            .flat_map(|part| {
                let is_own = |place: &&Vec3| part.shape.caps().unwrap().beyond(**place) <= 0.0;
                MESH.positions.iter().filter(is_own).step_by(5).map(|place| pose(part).point(*place))
            })
            .collect();
        let head = frame.world_from_head();
        let (mut told, mut all) = (0, 0);
        for (index, place) in skin.iter().enumerate().step_by(97) {
            let point = head.point(*place + normals[index] * (0.004 * (index % 5) as f32));
            let nearest = on_parts.iter().map(|place| place.distance(point)).fold(f32::INFINITY, f32::min);
            let beyond = common.beyond(point);
            assert!(beyond <= nearest + 1e-5, "{bend:?} {point}: {beyond} beyond, {nearest}");
            (told, all) = (told + usize::from(beyond > 0.01), all + 1);
        }
        assert!(2 * told > all, "{bend:?}: {told} of {all}");
        // A point that rests on a part moves no farther than the bounds say.
        for (part, start) in
            parts.iter().zip([Vec3::new(0.05, -0.1, 0.08), Vec3::new(-0.3, 0.1, -0.2)].iter().cycle())
        {
            let way = pose(part).point(*start).distance(*start);
            assert!(way <= common.way + common.turn * start.distance(common.middle), "{bend:?} {start}");
        }
    }
}

#[test]
fn parts_are_near_the_bent_skin() {
    let parts = neck().solids(&BUST);
    for (bend, most) in BENDS.into_iter().zip([0.0015, 0.006, 0.0035, 0.009]) {
        let ([skin, _], frame) = (skin(bend), frame(bend));
        let head = frame.world_from_head();
        let (mut low, mut high) = ((0.0_f32, Vec3::ZERO), (0.0_f32, Vec3::ZERO));
        for (place, rest) in skin.iter().zip(&MESH.positions) {
            // Less what samples every 4 mm err by in nostrils and ears.
            let distance = nearest(&parts, &frame, head.point(*place)).0 - BUST.distance(*rest);
            // The chin presses into the throat.
            low = if distance < low.0 && rest.z < 0.0 { (distance, *rest) } else { low };
            high = if distance > high.0 { (distance, *rest) } else { high };
        }
        assert!(-low.0 < most && high.0 < 0.002, "{bend:?}: skin {low:?} under the parts, {high:?} above");
    }
}
