//! Holes: counting and closing them.

use glam::Vec3;
use strandline_body::Mesh;

use crate::files::{CUBE_OBJ, load_bytes};
use crate::shapes::{ball, part, together};

fn cube_without(faces: &[&str]) -> Mesh {
    let text = faces.iter().fold(CUBE_OBJ.to_owned(), |text, face| {
        assert!(text.contains(face));
        text.replace(face, "")
    });
    load_bytes("cube.obj", text.as_bytes()).unwrap()
}

#[test]
fn open_edges_are_counted() {
    assert_eq!(cube_without(&[]).open_edge_count(), 0);
    assert_eq!(cube_without(&["f 1 4 3 2"]).open_edge_count(), 4);
    assert_eq!(cube_without(&["f 1 4 3 2", "f 5 6 7 8"]).open_edge_count(), 8);
    assert_eq!(cube_without(&["f 1 4 3 2", "f 1 2 6 5"]).open_edge_count(), 6);
}

#[test]
fn a_face_turned_over_is_open() {
    let turned = CUBE_OBJ.replace("f 5 6 7 8", "f 8 7 6 5");
    let mesh = load_bytes("cube.obj", turned.as_bytes()).unwrap();
    // Each of its four edges and of its neighbours' runs the same way as its partner.
    assert_eq!(mesh.open_edge_count(), 8);
}

#[test]
fn seams_are_no_holes() {
    // Each triangle of the ball has corners of its own.
    let mesh = ball(Vec3::Y, 0.5, 2);
    assert_eq!(mesh.positions.len(), 3 * mesh.triangles.len());
    assert!(mesh.is_closed());
    // The normals are those of the sphere across the seams: to a few degrees at this size of facets.
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(normal.dot((*position - Vec3::Y).normalize()) > 0.995);
    }
}

#[test]
fn every_hole_is_closed_flat() {
    let mesh = cube_without(&["f 1 4 3 2", "f 5 6 7 8"]);
    let closed = mesh.closed();
    assert!(closed.is_closed());
    // Two lids of four triangles around a middle.
    assert_eq!(closed.triangles.len(), mesh.triangles.len() + 8);
    assert_eq!(closed.positions.len(), closed.normals.len());
    let added: Vec<_> = closed.positions[8..].iter().zip(&closed.normals[8..]).collect();
    assert!((*added[0].0 - Vec3::new(0.5, 0.5, 0.0)).length() < 1e-6);
    assert!((*added[0].1 - Vec3::NEG_Z).length() < 1e-6);
    assert!((*added[1].0 - Vec3::new(0.5, 0.5, 1.0)).length() < 1e-6);
    assert!((*added[1].1 - Vec3::Z).length() < 1e-6);
}

#[test]
fn holes_that_touch_and_shells_are_closed() {
    let touching = cube_without(&["f 1 4 3 2", "f 1 2 6 5", "f 5 6 7 8", "f 4 1 5 8"]);
    assert!(touching.closed().is_closed());
    let upper = part(&ball(Vec3::ZERO, 0.1, 3), |center| center.y > 0.02);
    let both = together(&upper, &part(&ball(Vec3::X, 0.2, 2), |center| center.x < 1.1));
    assert!(!both.is_closed());
    assert!(both.closed().is_closed());
}
