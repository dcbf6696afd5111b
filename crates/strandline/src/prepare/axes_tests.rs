//! Grooms and bodies in any axes and units, of which each shows what it is.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3};
use strandline_base::math;

use super::guess::{self, Strands};
use super::head::turns;
use super::placing::{Defined, Placing, Placings, place_mesh};
use super::sample::surface;
use super::shown::{Body, Shown};
use crate::{
    Scene,
    body::{Mannequin, Mesh},
    groom::{Groom, Style, StyleSettings, format::Up},
};

fn scene() -> Scene {
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (Some("a.hair".into()), Some("a.obj".into()));
    scene
}

fn hair(style: Style) -> Groom {
    StyleSettings { strand_count: 300, ..StyleSettings::new(style) }.grow().unwrap()
}

/// A file in which a unit is so many metres, in axes that a rotation brings to head space.
fn filed(groom: &Groom, mesh: &Mesh, groom_in: Placing, body_in: Placing) -> (Groom, Mesh) {
    let (mut groom, mut mesh) = (groom.clone(), mesh.clone());
    groom.transform(1.0 / groom_in.scale, groom_in.turn.inverse(), Vec3::ZERO);
    let placing = Placing { scale: 1.0 / body_in.scale, turn: body_in.turn.inverse() };
    place_mesh(&mut mesh, placing, Vec3::ZERO, Vec3::ZERO);
    (groom, mesh)
}

fn is_near(found: Placing, expected: Placing) -> bool {
    (found.scale / expected.scale - 1.0).abs() < 0.01 && found.turn.angle_between(expected.turn) < 0.01
}

fn found(groom: &Groom, mesh: &Mesh, defined: Defined) -> Placings {
    guess::of_files(&scene(), &[groom], Some(mesh), defined)
}

const HERE: Placing = Placing::IDENTITY;

fn turned(turn: Quat) -> Placing {
    Placing { turn, ..HERE }
}

/// Strands out of the skin where a condition holds, that lead some way.
pub(super) fn patch(mesh: &Mesh, length: f32, way: Vec3, holds: impl Fn(Vec3) -> bool) -> Groom {
    let mut groom = Groom::empty(8e-5);
    let places = mesh.positions.iter().zip(&mesh.normals).filter(|(place, _)| holds(**place));
    for (place, normal) in places.step_by(3) {
        let way = (*normal + way).normalize();
        groom.push((0..6).map(|point| *place + way * (length * point as f32 / 5.0)));
    }
    assert!(groom.strand_count() > 20, "{} strands", groom.strand_count());
    groom
}

#[test]
fn a_groom_of_any_axes_and_units_comes_to_a_head_at_the_origin() {
    let mesh = Mannequin::new().mesh();
    let groom = hair(Style::Long);
    for (index, turn) in turns().enumerate().step_by(5) {
        let placing = Placing { scale: [1.0, 0.01][index % 2], turn };
        let (groom, mesh) = filed(&groom, &mesh, placing, HERE);
        let found = found(&groom, &mesh, [Defined::Nothing, Defined::All][index / 2 % 2]);
        assert!(is_near(found.groom, placing), "{placing:?}: {:?} {:?}", found.groom, found.notes);
        assert!(is_near(found.body, HERE) && !found.is_foreign, "{:?}", found.notes);
        assert!(found.confidence > 0.5, "{}", found.confidence);
    }
}

#[test]
fn a_body_of_any_axes_and_units_shows_them_whatever_the_groom_is() {
    let mesh = Mannequin::new().mesh();
    let grooms = [hair(Style::Bob), hair(Style::Ponytail)];
    for (index, turn) in turns().enumerate().step_by(7) {
        let placing = Placing { scale: [1.0, 0.00254, 0.001][index % 3], turn };
        let of_groom = if index % 2 == 0 { placing } else { HERE };
        let (groom, mesh) = filed(&grooms[index / 2 % 2], &mesh, of_groom, placing);
        let found = found(&groom, &mesh, Defined::Nothing);
        assert!(is_near(found.body, placing), "{placing:?}: {:?} {:?}", found.body, found.notes);
        assert!(is_near(found.groom, of_groom), "{of_groom:?}: {:?} {:?}", found.groom, found.notes);
    }
}

#[test]
fn a_scale_is_found_by_fitting_roots_to_the_skin() {
    let mesh = Mannequin::new().mesh();
    for scale in [0.00254, 0.3048, 0.1, 0.0123, 7.0] {
        let placing = Placing { scale, ..HERE };
        let (groom, mesh) = filed(&hair(Style::Wavy), &mesh, placing, HERE);
        let found = found(&groom, &mesh, Defined::Nothing);
        assert!(is_near(found.groom, placing), "{scale}: {:?} {:?}", found.groom, found.notes);
    }
}

#[test]
fn facial_hair_and_patches_turn_nothing() {
    let mesh = Mannequin::new().mesh();
    let beard = patch(&mesh, 0.08, Vec3::new(0.0, -2.0, 0.2), |place| {
        place.z > 0.05 && place.y < -0.075 && place.y > -0.14
    });
    let brows = patch(&mesh, 0.012, Vec3::Y, |place| {
        place.z > 0.07 && (0.005..0.02).contains(&place.y) && (0.015..0.05).contains(&place.x.abs())
    });
    let fringe = patch(&mesh, 0.1, Vec3::new(0.0, -0.5, 0.6), |place| place.z > 0.03 && place.y > 0.06);
    let mohawk = patch(&mesh, 0.12, Vec3::Y, |place| place.x.abs() < 0.01 && place.y > 0.04);
    let grooms = [("beard", beard), ("brows", brows), ("fringe", fringe), ("mohawk", mohawk)];
    for (name, groom) in &grooms {
        for (defined, scale) in [(Defined::Nothing, 1.0), (Defined::All, 1.0), (Defined::Nothing, 0.01)] {
            let placing = Placing { scale, ..HERE };
            let (groom, mesh) = filed(groom, &mesh, placing, placing);
            let found = found(&groom, &mesh, defined);
            assert!(is_near(found.body, placing), "{name}: {:?} {:?}", found.body, found.notes);
            assert!(is_near(found.groom, placing), "{name}: {:?} {:?}", found.groom, found.notes);
        }
        // A face that shows another way turns both.
        let back = turned(math::rotation(Vec3::Y, PI));
        let (groom, mesh) = filed(groom, &mesh, back, back);
        let found = found(&groom, &mesh, Defined::Nothing);
        assert!(is_near(found.body, back) && is_near(found.groom, back), "{name}: {:?}", found.notes);
    }
}

/// An egg, which shows no axis.
fn egg() -> Mesh {
    balls(&[(Vec3::ZERO, Vec3::new(0.078, 0.105, 0.098))])
}

/// Strands out of places on a surface where a condition holds, that lead some way.
fn grown_on(mesh: &Mesh, way: Vec3, holds: impl Fn(Vec3) -> bool) -> Groom {
    let mut groom = Groom::empty(8e-5);
    for place in surface(mesh, 2000).into_iter().filter(|place| holds(*place)) {
        let way = (place.normalize() + way).normalize();
        groom.push((0..6).map(|point| place + way * (0.03 * point as f32)));
    }
    groom
}

#[test]
fn a_patch_within_the_skin_is_turned_to_no_skin_that_fits_a_little_better() {
    let mut chin = egg();
    let beard = grown_on(&chin, Vec3::new(0.0, -2.0, 0.2), |place| place.z > 0.03 && place.y < -0.045);
    // A chin a millimetre higher than the roots; the back, where none is, lies as the roots do.
    let is_low = |place: &&mut Vec3| place.z > 0.0 && place.y < 0.0;
    chin.positions.iter_mut().filter(is_low).for_each(|place| *place *= 1.008);
    for scale in [0.01, 0.00254] {
        let placing = Placing { scale, ..HERE };
        let (beard, mesh) = filed(&beard, &chin, HERE, placing);
        let found = found(&beard, &mesh, Defined::Nothing);
        assert!(is_near(found.body, placing), "{:?} {:?}", found.body, found.notes);
        assert!(is_near(found.groom, HERE) && found.rival.is_none(), "{:?} {:?}", found.groom, found.notes);
    }
}

#[test]
fn hair_shows_the_axis_of_a_body_that_shows_none() {
    let mesh = balls(&[(Vec3::ZERO, Vec3::splat(0.08))]);
    let groom = grown_on(&mesh, Vec3::new(0.0, -3.0, -0.3), |place| place.y > 0.02);
    for up in [Up::Y, Up::Z, Up::MinusY] {
        let placing = turned(up.rotation());
        let (groom, mesh) = filed(&groom, &mesh, placing, placing);
        let found = found(&groom, &mesh, Defined::Nothing);
        for place in [found.body, found.groom] {
            assert!(place.turn.angle_between(up.rotation()) < 0.01, "{up:?}: {place:?} {:?}", found.notes);
        }
    }
}

#[test]
fn glb_is_believed() {
    let (mesh, groom) = (Mannequin::new().mesh(), hair(Style::Bob));
    // A giant that looks back, as its file says.
    let placing = Placing { scale: 10.0, turn: math::rotation(Vec3::Y, PI) };
    let inverse = Placing { scale: 1.0 / placing.scale, turn: placing.turn };
    let (groom, mesh) = filed(&groom, &mesh, inverse, inverse);
    let found = found(&groom, &mesh, Defined::All);
    assert!(is_near(found.body, HERE), "{:?} {:?}", found.body, found.notes);
    // An avatar of the older kind shows where it looks.
    let avatar = guess::of_files(&scene(), &[], Some(&mesh), Defined::Up);
    assert!(is_near(avatar.body, turned(math::rotation(Vec3::Y, PI))), "{:?}", avatar.body);
}

#[test]
fn hair_of_another_head_in_any_axes_hangs_from_this_one() {
    let mesh = Mannequin::new().mesh();
    for up in [Up::Y, Up::Z, Up::MinusY] {
        for back in [false, true] {
            let yaw = if back { math::rotation(Vec3::Y, PI) } else { Quat::IDENTITY };
            let turn = yaw * up.rotation();
            let mut groom = hair(Style::Long);
            // Of a head that is larger and stands elsewhere.
            groom.transform(1.15, Quat::IDENTITY, Vec3::new(0.1, 1.6, 0.2));
            let (groom, mesh) = filed(&groom, &mesh, turned(turn), HERE);
            let found = found(&groom, &mesh, Defined::Nothing);
            assert!(
                found.is_foreign && found.groom.turn.angle_between(turn) < 0.01,
                "{up:?} {back}: {:?}",
                found.notes
            );
            assert!(is_near(found.body, HERE) && found.confidence < 0.9, "{up:?} {back}");
        }
    }
}

/// Balls of some radii at some places, as one mesh.
pub(super) fn balls(parts: &[(Vec3, Vec3)]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let (rings, steps) = (16, 24);
    for (middle, radii) in parts {
        let first = positions.len() as u32;
        for ring in 0..=rings {
            for step in 0..steps {
                let (polar, around) =
                    (PI * ring as f32 / rings as f32, 2.0 * PI * step as f32 / steps as f32);
                let way = Vec3::new(polar.sin() * around.sin(), polar.cos(), polar.sin() * around.cos());
                positions.push(*middle + way * *radii);
                if ring < rings {
                    let corner = |ring: u32, step: u32| first + steps * ring + step % steps;
                    triangles.push([corner(ring, step), corner(ring + 1, step), corner(ring, step + 1)]);
                    triangles.push([
                        corner(ring, step + 1),
                        corner(ring + 1, step),
                        corner(ring + 1, step + 1),
                    ]);
                }
            }
        }
    }
    Mesh::new(positions, triangles).unwrap()
}

#[test]
fn a_whole_person_shows_its_axes_whatever_its_arms_do() {
    let limbs = |arms: [Vec3; 2]| {
        let sides = [-1.0, 1.0].map(|side| {
            let at = |x: f32, y: f32, z: f32| Vec3::new(side * x, y, z);
            let legs = [
                (at(0.09, -1.05, -0.02), Vec3::new(0.08, 0.47, 0.08)),
                (at(0.09, -1.5, 0.05), Vec3::new(0.05, 0.03, 0.12)),
            ];
            [legs[0], legs[1], (arms[0] * Vec3::new(side, 1.0, 1.0), arms[1])]
        });
        let trunk = (Vec3::new(0.0, -0.5, -0.02), Vec3::new(0.18, 0.33, 0.11));
        balls(&[&[trunk], sides.as_flattened()].concat())
    };
    let spread = [Vec3::new(0.42, -0.25, -0.02), Vec3::new(0.3, 0.05, 0.05)];
    let hanging = [Vec3::new(0.24, -0.5, -0.02), Vec3::new(0.05, 0.33, 0.05)];
    for arms in [spread, hanging] {
        let (mut person, limbs) = (Mannequin::new().mesh(), limbs(arms));
        let first = person.positions.len() as u32;
        person.positions.extend(&limbs.positions);
        person.normals.extend(&limbs.normals);
        person.triangles.extend(limbs.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        for placing in [HERE, Placing { scale: 0.01, turn: Up::Z.rotation() }] {
            let (_, mesh) = filed(&hair(Style::Pixie), &person, placing, placing);
            let shown = Shown::new(&scene(), &mesh, Defined::Nothing);
            assert!(is_near(shown.placing, placing), "{placing:?}: {:?} {:?}", shown.placing, shown.pose);
            assert!(shown.pose.is_person && shown.pose.shows_front, "{:?}", shown.pose);
        }
    }
}

/// An animal on four legs that looks along z.
fn animal() -> Mesh {
    let mut parts = vec![
        (Vec3::new(0.0, 0.5, 0.0), Vec3::new(0.13, 0.14, 0.35)),
        (Vec3::new(0.0, 0.68, 0.42), Vec3::new(0.07, 0.08, 0.12)),
        (Vec3::new(0.0, 0.6, 0.33), Vec3::new(0.06, 0.12, 0.1)),
        (Vec3::new(0.0, 0.55, -0.45), Vec3::new(0.02, 0.02, 0.18)),
    ];
    for (x, z) in [(-0.08, -0.25), (0.08, -0.25), (-0.08, 0.25), (0.08, 0.25)] {
        parts.push((Vec3::new(x, 0.2, z), Vec3::new(0.035, 0.22, 0.035)));
    }
    balls(&parts)
}

#[test]
fn animals_stand_on_their_feet_and_look_as_in_their_files() {
    let mesh = animal();
    let fur = patch(&mesh, 0.03, Vec3::new(0.0, -0.3, -0.8), |place| place.y > 0.35 && place.z.abs() < 0.4);
    let mane = patch(&mesh, 0.15, Vec3::new(0.5, -2.0, -0.2), |place| place.y > 0.6 && place.x.abs() < 0.02);
    for groom in [&fur, &mane] {
        for placing in [HERE, Placing { scale: 0.01, turn: Up::Z.rotation() }] {
            let (groom, mesh) = filed(groom, &mesh, placing, placing);
            let found = found(&groom, &mesh, Defined::Nothing);
            assert!(is_near(found.body, placing), "{placing:?}: {:?} {:?}", found.body, found.notes);
            assert!(is_near(found.groom, placing), "{placing:?}: {:?} {:?}", found.groom, found.notes);
        }
        assert!(is_near(found(groom, &mesh, Defined::All).body, HERE));
    }
}

#[test]
fn large_ears_change_neither_the_unit_nor_the_axes() {
    let beside = |side: f32| (Vec3::new(side * 0.15, 0.03, -0.01), Vec3::new(0.08, 0.1, 0.012));
    let above = |side: f32| (Vec3::new(side * 0.05, 0.18, -0.01), Vec3::new(0.025, 0.14, 0.01));
    for ears in [[beside(-1.0), beside(1.0)], [above(-1.0), above(1.0)]] {
        let mut mesh = Mannequin::new().mesh();
        mesh.append(&balls(&ears)).unwrap();
        let alone = guess::of_files(&scene(), &[], Some(&mesh), Defined::Nothing);
        assert!(is_near(alone.body, HERE), "{:?} {:?}", alone.body, alone.notes);
        let (groom, body) = filed(&hair(Style::Bob), &mesh, Placing { scale: 0.01, ..HERE }, HERE);
        let found = found(&groom, &body, Defined::Nothing);
        assert!(is_near(found.body, HERE) && found.groom.scale == 0.01, "{:?}", found.notes);
    }
}

#[test]
fn hair_without_a_body_hangs() {
    for (up, style) in [(Up::Y, Style::Bob), (Up::Z, Style::Long), (Up::MinusY, Style::Wavy)] {
        let (groom, _) = filed(&hair(style), &Mannequin::new().mesh(), turned(up.rotation()), HERE);
        let found = guess::of_files(&scene(), &[&groom], None, Defined::Nothing);
        assert!(is_near(found.groom, turned(up.rotation())), "{up:?}: {:?}", found.notes);
    }
}

#[test]
fn an_axis_that_a_scene_gives_is_kept_and_doubted() {
    let mesh = Mannequin::new().mesh();
    let (groom, mesh) = filed(&hair(Style::Long), &mesh, turned(Up::MinusY.rotation()), HERE);
    let mut given = scene();
    given.groom.up = Up::Y;
    let found = guess::of_files(&given, &[&groom], Some(&mesh), Defined::Nothing);
    assert_eq!(found.groom.turn, Quat::IDENTITY);
    assert!(found.confidence < 0.5, "{}", found.confidence);
    given.groom.rotation = Vec3::X * (2.0 * FRAC_PI_2).to_degrees();
    let turned = guess::of_files(&given, &[&groom], Some(&mesh), Defined::Nothing);
    assert!(turned.groom.turn == Quat::IDENTITY && turned.confidence > 0.9, "{:?}", turned.notes);
}

/// A ball, and strands that stand on the half of it whose middle lies along a way.
pub(super) fn dandelion(way: Vec3) -> (Groom, Mesh) {
    let mesh = balls(&[(Vec3::ZERO, Vec3::splat(0.1))]);
    let mut groom = Groom::empty(8e-5);
    for index in 0..800 {
        let height = 1.0 - (index as f32 + 0.5) / 400.0;
        let (flat, around) = ((1.0 - height * height).sqrt(), 2.399_963 * index as f32);
        let normal = Vec3::new(flat * around.cos(), height, flat * around.sin());
        if normal.dot(way) > -0.2 {
            groom.push((0..5).map(|point| normal * (0.1 + 0.01 * point as f32)));
        }
    }
    (groom, mesh)
}

#[test]
fn a_place_that_is_not_sure_is_told_with_the_flag_of_the_other_one() {
    // In the body's axes the half of the ball that hair covers lies between two sides.
    let (groom, mesh) = dandelion(Vec3::new(0.0, 1.0, 1.0).normalize());
    let open = found(&groom, &mesh, Defined::Nothing);
    assert!(open.confidence < 0.6, "{} {:?}", open.confidence, open.notes);
    let note = &open.notes[0];
    assert!(note.contains("which is not sure") && note.contains("--up z fits nearly as well"), "{note}");
}

#[test]
fn a_groom_whose_format_defines_its_space_is_believed_where_it_fits() {
    let mesh = Mannequin::new().mesh();
    let groom = hair(Style::Bob);
    let placed = |groom: &Groom, mesh: &Mesh| {
        let shown = Shown::new(&scene(), mesh, Defined::Nothing);
        let strands = Strands { grooms: &[groom], is_defined: true };
        guess::placings(&scene(), strands, Some(Body { mesh, shown: &shown }))
    };
    let (_, body) = filed(&groom, &mesh, HERE, Placing { scale: 0.01, turn: Up::Z.rotation() });
    let believed = placed(&groom, &body);
    assert!(is_near(believed.groom, HERE) && !believed.is_against, "{:?}", believed.notes);
    let (wrong, _) = filed(&groom, &mesh, Placing { scale: 0.01, ..HERE }, HERE);
    let mended = placed(&wrong, &mesh);
    assert!(is_near(mended.groom, Placing { scale: 0.01, ..HERE }), "{:?}", mended.groom);
    assert!(mended.notes[0].contains("otherwise than the format of its file defines"), "{:?}", mended.notes);
}

#[test]
fn hair_of_metres_is_doubted() {
    let mesh = Mannequin::new().mesh();
    let mut groom = hair(Style::Long);
    for strand in 0..groom.strand_count() {
        let range = groom.range(strand);
        let root = groom.points[range.start];
        groom.points[range].iter_mut().for_each(|point| *point = root + (*point - root) * 10.0);
    }
    let found = found(&groom, &mesh, Defined::Nothing);
    assert!(found.confidence < 0.5, "{} {:?}", found.confidence, found.notes);
    assert!(found.notes.iter().any(|note| note.contains("m long in the mean")), "{:?}", found.notes);
}
