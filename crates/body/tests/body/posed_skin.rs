//! Distances to a skin that moves, against an exhaustive search and winding numbers of the deformed mesh.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Quat, Vec3, vec3};
use strandline_body::{DistanceGrid, Mannequin, Mesh, Places, PosedSkin, SkinSolid};

/// Winding number of a closed mesh around a point, by solid angles \[Jacobson2013\].
fn winding(mesh: &Mesh, point: Vec3) -> f64 {
    let angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| (mesh.positions[corner as usize] - point).as_dvec3());
        let [x, y, z]: [f64; 3] = [a, b, c].map(DVec3::length);
        let volume = a.dot(b.cross(c));
        2.0 * volume.atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    mesh.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// A tube along y, open at its lower end, 40 cm long and 10 cm wide.
pub fn tube() -> Mesh {
    let (rings, around) = (41_u32, 32_u32);
    let at = |ring: u32, side: u32| {
        let angle = 2.0 * PI * side as f32 / around as f32;
        vec3(0.05 * angle.cos(), 0.01 * ring as f32, 0.05 * angle.sin())
    };
    let mut positions: Vec<Vec3> =
        (0..rings).flat_map(|ring| (0..around).map(move |side| at(ring, side))).collect();
    let top = positions.len() as u32;
    positions.push(vec3(0.0, 0.4, 0.0));
    let mut triangles = Vec::new();
    for side in 0..around {
        let next = (side + 1) % around;
        for ring in 0..rings - 1 {
            let [a, b, c, d] = [(ring, side), (ring, next), (ring + 1, side), (ring + 1, next)]
                .map(|(ring, side)| ring * around + side);
            triangles.extend([[a, c, b], [b, c, d]]);
        }
        triangles.push([top, (rings - 1) * around + next, (rings - 1) * around + side]);
    }
    Mesh::new(positions, triangles).unwrap()
}

/// The tube bent about x by an angle at its upper end.
fn bent(mesh: &Mesh, angle: f32) -> Arc<[Vec3]> {
    let radius = 0.4 / angle;
    let place = |place: &Vec3| {
        let around = Quat::from_rotation_x(place.y / radius) * vec3(place.x, 0.0, place.z - radius);
        around + Vec3::Z * radius
    };
    mesh.positions.iter().map(place).collect()
}

pub fn solid(mesh: &Mesh, spacing: f32) -> Arc<SkinSolid> {
    let grid = DistanceGrid::of_mesh(mesh, spacing, 0.02).unwrap();
    Arc::new(SkinSolid::new(mesh, Arc::new(grid)).unwrap())
}

/// Bound \[m\] that suffices.
const ENOUGH: f32 = 0.1;

/// Compares distances at many places about a skin with those of the deformed mesh.
fn compare(mesh: &Mesh, solid: &Arc<SkinSolid>, skin: &Arc<[Vec3]>, count: usize) {
    // Material moves by half of its place.
    let half: Arc<[Vec3]> = skin.iter().map(|place| 0.5 * *place).collect();
    let posed = PosedSkin::new(solid, [Some(&half), Some(skin)]).unwrap();
    let deformed = Mesh::new(skin.to_vec(), mesh.triangles.clone()).unwrap().closed();
    let bounds = deformed.bounds().unwrap();
    let (middle, size) = (0.5 * (bounds.min + bounds.max), 0.6 * (bounds.max - bounds.min));
    let share = |index: usize, step: f32| 2.0 * (step * index as f32).fract() - 1.0;
    let points: Vec<Vec3> = (0..count)
        .map(|index| {
            middle + size * vec3(share(index, 0.618_034), share(index, 0.754_878), share(index, 0.569_84))
        })
        .collect();
    let mut before = PosedSkin::UNKNOWN;
    let (mut inside, mut wrong, mut quick, mut off) = (0, 0, 0, f32::NEG_INFINITY);
    for (point, place) in points.iter().zip(deformed.nearest_places(&points)) {
        let exact = point.distance(place);
        let about = 2.0 * posed.shift(posed.triangle_about(*point, before), *point);
        off = off.max(point.distance(about) - 1.25 * exact);
        let (known, _) = posed.at_least_about(*point, before, ENOUGH);
        let found = posed.nearest(*point, before);
        before = found.triangle;
        assert!(known <= found.distance.max(0.0) + 1e-6, "{point}: {known} at least, for {exact}");
        assert!(
            found.distance < 1.26 * ENOUGH || known > 0.6 * exact,
            "{point}: {known} at least, for {exact}"
        );
        quick += usize::from(known == 0.0 && found.distance > 1e-5);
        assert!((found.distance.abs() - exact).abs() < 2e-6, "{point}: {} for {exact}", found.distance);
        assert!((found.normal.length() - 1.0).abs() < 1e-5);
        let is_inside = winding(&deformed, *point) > 0.5;
        inside += usize::from(is_inside);
        wrong += usize::from(exact > 1e-5 && is_inside != (found.distance < 0.0));
        let least = posed.at_least(*point);
        assert!(least <= found.distance.max(0.0) + 1e-6, "{point}: {least} at least, for {exact}");
        assert!(found.distance < 0.0 || least > 0.6 * exact, "{point}: {least} at least, for {exact}");
    }
    assert!(inside > count / 50, "{inside} of {count} inside");
    assert!(off < 2e-5, "{off} m farther than a quarter more than the nearest triangle");
    assert!(quick > 0, "none of {count} needed no search");
    assert_eq!(wrong, 0, "{wrong} of {count} on the wrong side");
}

#[test]
fn a_bent_tube_has_exact_distances_and_its_hole_bends_too() {
    let mesh = tube();
    let solid = solid(&mesh, 0.01);
    for angle in [0.3, 1.5, 3.0] {
        compare(&mesh, &solid, &bent(&mesh, angle), 2000);
    }
}

/// A mesh whose triangles share no vertex.
pub fn soup(mesh: &Mesh) -> Mesh {
    let positions: Vec<Vec3> =
        mesh.triangles.iter().flatten().map(|corner| mesh.positions[*corner as usize]).collect();
    let triangles = (0..mesh.triangles.len() as u32).map(|index| [0, 1, 2].map(|corner| 3 * index + corner));
    Mesh::new(positions, triangles.collect()).unwrap()
}

#[test]
fn a_soup_of_triangles_has_the_distances_of_its_surface() {
    let mesh = soup(&tube());
    compare(&mesh, &solid(&mesh, 0.01), &bent(&mesh, 1.5), 1000);
}

#[test]
fn a_bust_that_shrugs_has_exact_distances() {
    let mesh = Mannequin::new().mesh();
    let solid = solid(&mesh, 0.01);
    let smooth = |from: f32, to: f32, value: f32| {
        let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    };
    let raised = |place: &Vec3| {
        *place + Vec3::Y * 0.05 * smooth(0.04, 0.14, place.x.abs()) * smooth(-0.1, -0.18, place.y)
    };
    compare(&mesh, &solid, &mesh.positions.iter().map(raised).collect(), 400);
}

#[test]
fn a_skin_that_rides_the_head_needs_no_tree() {
    let mesh = tube();
    let solid = solid(&mesh, 0.02);
    assert!(PosedSkin::new(&solid, [None, None]).is_none());
    let other: Arc<[Vec3]> = Arc::from([Vec3::ZERO; 3]);
    assert!(PosedSkin::new(&solid, [Some(&other), None]).is_none());
    let still = PosedSkin::new(&solid, [None, Some(&mesh.positions.clone().into())]).unwrap();
    assert_eq!(still.most_shift(), 0.0);
}

#[test]
fn a_skin_with_bands_behind_it_is_that_of_its_body() {
    let mesh = tube();
    let solid = solid(&mesh, 0.02);
    let moved: Vec<Vec3> = mesh.positions.iter().map(|place| *place + Vec3::X).collect();
    let of = |skin: Vec<Vec3>| PosedSkin::new(&solid, [None, Some(&skin.into())]).unwrap();
    let with_band = of([&moved[..], &[Vec3::splat(9.0); 5]].concat());
    let place = vec3(1.06, 0.2, 0.01);
    let [one, two] = [of(moved), with_band].map(|skin| skin.nearest(place, PosedSkin::UNKNOWN));
    assert_eq!((one.triangle, one.distance), (two.triangle, two.distance));
}

#[test]
fn triangles_carry_what_lies_near_them() {
    let mesh = tube();
    let solid = solid(&mesh, 0.02);
    let turn = Quat::from_rotation_z(0.4);
    let turned: Arc<[Vec3]> = mesh.positions.iter().map(|place| turn * *place + Vec3::X).collect();
    let posed = PosedSkin::new(&solid, [None, Some(&turned)]).unwrap();
    let start = PosedSkin::new(&solid, [None, Some(&mesh.positions.clone().into())]).unwrap();
    let point = vec3(0.06, 0.2, 0.01);
    let triangle = start.nearest(point, PosedSkin::UNKNOWN).triangle;
    let motion = posed.motion(triangle, point).unwrap();
    let end = turn * point + Vec3::X;
    assert!(motion.point(point).distance(end) < 1e-5 && motion.error < 1e-5);
    assert!(motion.direction(Vec3::X).distance(turn * Vec3::X) < 1e-5);
    let shift = posed.shift(triangle, end);
    let place = point + vec3(-0.01, 0.0, 0.0);
    assert!(shift.distance(turn * place + Vec3::X - place) < 2e-3, "{shift}");
    assert!(posed.motion(PosedSkin::UNKNOWN, point).is_none());
    let drift = posed.drift(triangle);
    assert!(drift.distance(turn * place + Vec3::X - place) < 0.02, "{drift}");
    assert_eq!([posed.drift(PosedSkin::UNKNOWN), start.drift(triangle)], [Vec3::ZERO; 2]);
}

/// Triangles of the outer ear of the sample bust cross: the angle-weighted normal of a vertex of a crease leads into the body.
/// Few points are left that lie outside behind all faces about a vertex, where nothing counts crossings.
#[test]
fn a_crease_that_crosses_itself_has_its_outside_outside() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb");
    let (mesh, motion, _) = Mesh::load_moving(&path, "shrug").unwrap();
    let solid = solid(&mesh, 0.01);
    let (mut at_vertex, mut wrong) = (0, Vec::new());
    for time in [0.0, 0.45] {
        let skin: Arc<[Vec3]> = motion.positions(time).into();
        let posed = PosedSkin::new(&solid, [None, Some(&skin)]).unwrap();
        let deformed = Mesh::new(skin.to_vec(), mesh.triangles.clone()).unwrap().closed();
        let ears = (0..skin.len()).filter(|index| mesh.positions[*index].x.abs() > 0.078);
        let ears = ears.filter(|index| mesh.positions[*index].y > -0.1);
        for (vertex, way) in
            ears.map(|index| skin[index]).flat_map(|vertex| (0..78).map(move |way| (vertex, way)))
        {
            let step = vec3((way % 3) as f32, (way / 3 % 3) as f32, (way / 9 % 3) as f32) - 1.0;
            let away = [0.025, 0.018, 0.012][way / 27];
            let point = vertex + step.normalize_or(Vec3::ONE.normalize()) * away;
            let found = posed.nearest(point, PosedSkin::UNKNOWN);
            if (found.distance.abs() - away).abs() < 1e-6 {
                at_vertex += 1;
                if (found.distance < 0.0) != (winding(&deformed, point) > 0.5) {
                    wrong.push((time, vertex, way, found.distance));
                }
            }
        }
    }
    assert!(at_vertex > 100, "{at_vertex} points");
    assert!(wrong.len() <= 6, "{} of {at_vertex}: {:?}", wrong.len(), &wrong[..wrong.len().min(4)]);
}

#[test]
fn depths_have_exact_sides_about_a_fold() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb");
    let (mesh, motion, _) = Mesh::load_moving(&path, "shrug").unwrap();
    let solid = solid(&mesh, 0.01);
    let skin: Arc<[Vec3]> = motion.positions(0.45).into();
    let posed = PosedSkin::new(&solid, [None, Some(&skin)]).unwrap();
    let deformed = Mesh::new(skin.to_vec(), mesh.triangles.clone()).unwrap().closed();
    let (mut by_faces, mut inside, mut wrong) = (0, 0, Vec::new());
    let ears = (0..skin.len()).filter(|index| mesh.positions[*index].x.abs() > 0.07);
    let ears = ears.filter(|index| mesh.positions[*index].y > -0.1).step_by(3);
    for (vertex, way) in
        ears.map(|index| skin[index]).flat_map(|vertex| (0..26).map(move |way| (vertex, way)))
    {
        let step = vec3((way % 3) as f32, (way / 3 % 3) as f32, (way / 9) as f32) - 1.0;
        let point = vertex + step.normalize_or(Vec3::ONE.normalize()) * (0.001 * (1 + way) as f32);
        let (found, depth) =
            (posed.nearest(point, PosedSkin::UNKNOWN), posed.depth(point, PosedSkin::UNKNOWN));
        if found.distance > -1e-5 {
            assert_eq!(depth, found.distance.min(0.0).abs() * f32::from(depth > 0.0), "{point}");
            continue;
        }
        let is_inside = winding(&deformed, point) > 0.5;
        by_faces += usize::from(!is_inside);
        inside += usize::from(is_inside);
        if is_inside != (depth > 0.0) || (is_inside && depth != -found.distance) {
            wrong.push((vertex, way, found.distance, depth));
        }
    }
    assert!(by_faces > 0 && inside > 500, "{by_faces} outside count as inside by their faces, {inside} are");
    assert!(wrong.is_empty(), "{} wrong: {:?}", wrong.len(), &wrong[..wrong.len().min(4)]);
}

/// Bounds carried through a step against the exact distances after it: near the end that swings they fall by its way, and at
/// the foot that rests they stay.
#[test]
fn a_bound_carried_through_a_step_is_no_more_than_the_distance_after_it() {
    let mesh = tube();
    let solid = solid(&mesh, 0.01);
    let [start, end] = [1.0, 1.1].map(|angle| bent(&mesh, angle));
    let [before, after] =
        [&start, &end].map(|skin| PosedSkin::new(&solid, [Some(skin), Some(skin)]).unwrap());
    let step = PosedSkin::new(&solid, [Some(&start), Some(&end)]).unwrap();
    assert!(step.most_shift() > 0.01);
    let (mut tight, mut held) = (0.0_f32, 0);
    for index in 0..3000 {
        let share = index as f32;
        let around = vec3((1.3 * share).sin(), 0.6 + (2.1 * share).cos(), (0.7 * share).sin());
        let point = 0.25 * around + vec3(0.0, 0.05, 0.08);
        let [was, is] = [&before, &after].map(|skin| skin.nearest(point, PosedSkin::UNKNOWN).distance);
        if was < 0.0 {
            continue;
        }
        let least = step.at_least_after(was, step.shift_about(point));
        assert!(least <= is + 1e-6, "{point}: {least} m at least, from {was} m to {is} m");
        tight = tight.max(was - is - (was - least));
        held += usize::from(was - least < 0.25 * step.most_shift());
    }
    assert!(held > 20, "{held} bounds fall by little: they are local");
    assert!(tight > -1e-3, "the most that the skin comes nearer is nearly the bound: {tight}");
}

/// The nearest place stands still of a point about which the skin is told to, and none is told so where the tube bends. Far points
/// have bounds of their distance.
#[test]
fn skin_that_stands_still_about_a_point_needs_no_search() {
    let mesh = tube();
    let solid = solid(&mesh, 0.01);
    let rest: Arc<[Vec3]> = mesh.positions.clone().into();
    let bend = |place: &Vec3| *place + Vec3::X * 0.4 * (place.y - 0.2).max(0.0);
    let bent: Arc<[Vec3]> = mesh.positions.iter().map(bend).collect();
    let step = PosedSkin::new(&solid, [Some(&rest), Some(&bent)]).unwrap();
    let (mut still, mut moving, mut bounds) = (0, 0, 0);
    for index in 0..2000 {
        let share = index as f32;
        let around = vec3((1.3 * share).sin(), (2.1 * share).cos(), (0.7 * share).sin());
        let point = 0.1 * around + vec3(0.0, 0.2 + 0.1 * (0.3 * share).sin(), 0.0);
        let found = step.nearest(point, PosedSkin::UNKNOWN);
        let way = step.shift(found.triangle, point).length();
        assert!(!step.is_still_about(point, PosedSkin::UNKNOWN), "no triangle shows that the skin is near");
        if step.is_still_about(point, found.triangle) {
            assert!(way < 1e-6, "{point}: {way} m");
            still += 1;
        } else {
            moving += usize::from(way < 1e-6 && found.distance < 0.01);
        }
        let near = step.near(point, found.triangle, 0.02);
        let is_exact = near.distance == found.distance;
        assert!(is_exact || (found.distance > 0.02 && near.distance < found.distance), "{point}");
        assert!(near.distance >= 0.79 * found.distance || is_exact, "{point}: {}", near.distance);
        bounds += usize::from(!is_exact);
    }
    assert!(still > 200 && bounds > 200, "{still} still, {bounds} bounds");
    assert!(moving < 300, "{moving} are told to move");
}

/// Two tubes of one skin, one partly in the other: the triangles of each within the other are left out, so that both have
/// holes.
#[test]
fn a_line_through_holes_of_shells_that_overlap_tells_no_sides() {
    let tube = tube();
    let own = tube.positions.len() as u32;
    let (mut positions, mut triangles) = (tube.positions.clone(), tube.triangles.clone());
    positions.extend(tube.positions.iter().map(|place| *place + vec3(0.043, 0.021, 0.017)));
    triangles.extend(tube.triangles.iter().map(|corners| corners.map(|corner| corner + own)));
    let mesh = Mesh::new(positions, triangles).unwrap();
    let skin: Arc<[Vec3]> = mesh.positions.clone().into();
    let posed = PosedSkin::new(&solid(&mesh, 0.01), [None, Some(&skin)]).unwrap();
    let (mut told, mut untold) = (0, 0);
    for line in 0..200 {
        let share = |step: f32| (step * (line + 1) as f32).fract() - 0.5;
        let step = vec3(share(0.618_034), share(0.754_878), share(0.569_84)).normalize() * 0.02;
        let first = mesh.positions[13 * line] - 30.0 * step;
        let Some(sides) = posed.sides_along(&Places { first, step, count: 60 }) else {
            untold += 1;
            continue;
        };
        told += 1;
        for place in [0, 1, 2, 57, 58, 59] {
            assert_eq!(sides.inside >> place & 1, 0, "place {place} of line {line} is far from both");
        }
    }
    assert!(told > 100 && untold > 3, "{told} lines told, {untold} not");
}

/// The tube goes around more than once: its ends lie in each other.
#[test]
fn a_line_tells_the_sides_of_its_places_in_a_skin_that_passes_through_itself() {
    let mesh = tube();
    let solid = solid(&mesh, 0.01);
    let skin = bent(&mesh, 6.9);
    let posed = PosedSkin::new(&solid, [None, Some(&skin)]).unwrap();
    let deformed = Mesh::new(skin.to_vec(), mesh.triangles.clone()).unwrap().closed();
    let (mut inside, mut twice, mut behind) = (0, 0, 0);
    for line in 0..60 {
        let share = |step: f32| (step * (line + 1) as f32).fract() - 0.5;
        let around = vec3(share(0.618_034), share(0.754_878), share(0.569_84));
        let step = if line % 6 < 3 { Vec3::AXES[line % 3] } else { around.normalize() } * 0.007;
        let first = deformed.positions[17 * line] + 0.08 * around - 10.0 * step;
        let sides = posed.sides_along(&Places { first, step, count: 40 }).unwrap();
        for place in 0..40 {
            let point = first + step * place as f32;
            let around = winding(&deformed, point);
            twice += usize::from(around > 1.5);
            inside += usize::from(around > 0.5);
            assert_eq!(
                sides.inside >> place & 1 == 1,
                around > 0.5,
                "place {place} of line {line}: {around}"
            );
        }
        assert_eq!(sides.inside >> 40, 0);
        if sides.behind < 1.0 {
            behind += 1;
            let place = first - step.normalize() * sides.behind;
            assert!(posed.nearest(place, PosedSkin::UNKNOWN).distance.abs() < 1e-5, "line {line}");
            let half = winding(&deformed, first - step.normalize() * (0.5 * sides.behind));
            assert!((half - winding(&deformed, first)).abs() < 0.1, "line {line}: skin between");
        }
    }
    assert!(inside > 300 && twice > 20 && behind > 10, "{inside} inside, {twice} twice, {behind}");
    assert_eq!(posed.sides_along(&Places { first: Vec3::NAN, step: Vec3::X, count: 9 }).unwrap().inside, 0);
}
