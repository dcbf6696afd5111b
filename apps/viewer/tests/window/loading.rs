//! Files that are loaded in the window, and files that it writes.

use std::fmt::Write;

use eframe::egui::accesskit::Role;
use glam::Vec3;
use strandline::low_level::body::{Mannequin, Mesh};

use crate::person::{Window, hair};

/// The built-in head at another place, as text of a format: its ending, and its content.
pub fn head(ending: &str, place: Vec3) -> String {
    let Mesh { positions, triangles, .. } = Mannequin::new().mesh();
    let corner = |at: u32| positions[at as usize] + place;
    let mut text = String::new();
    let written = match ending {
        "ply" => ply(&mut text, positions.iter().map(|position| *position + place), &triangles),
        "stl" => stl(&mut text, triangles.iter().map(|corners| corners.map(corner))),
        _ => obj(&mut text, positions.iter().map(|position| *position + place), &triangles),
    };
    written.unwrap();
    text
}

fn ply(
    text: &mut String,
    places: impl ExactSizeIterator<Item = Vec3>,
    faces: &[[u32; 3]],
) -> std::fmt::Result {
    writeln!(text, "ply\nformat ascii 1.0\nelement vertex {}", places.len())?;
    writeln!(text, "property float x\nproperty float y\nproperty float z")?;
    writeln!(text, "element face {}\nproperty list uchar int vertex_indices\nend_header", faces.len())?;
    for place in places {
        writeln!(text, "{} {} {}", place.x, place.y, place.z)?;
    }
    faces.iter().try_for_each(|[a, b, c]| writeln!(text, "3 {a} {b} {c}"))
}

fn stl(text: &mut String, faces: impl Iterator<Item = [Vec3; 3]>) -> std::fmt::Result {
    writeln!(text, "solid head")?;
    for face in faces {
        writeln!(text, "facet normal 0 0 0\nouter loop")?;
        face.iter().try_for_each(|corner| writeln!(text, "vertex {} {} {}", corner.x, corner.y, corner.z))?;
        writeln!(text, "endloop\nendfacet")?;
    }
    writeln!(text, "endsolid head")
}

fn obj(text: &mut String, places: impl Iterator<Item = Vec3>, faces: &[[u32; 3]]) -> std::fmt::Result {
    for place in places {
        writeln!(text, "v {} {} {}", place.x, place.y, place.z)?;
    }
    faces.iter().try_for_each(|[a, b, c]| writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1))
}

#[test]
fn bodies_of_scans_are_loaded_and_the_lights_follow_the_head() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ["obj", "ply", "stl"] {
        let mut window = Window::still();
        let before = hair(&window.picture());
        let path = folder.path().join(format!("head.{ending}"));
        std::fs::write(&path, head(ending, Vec3::new(0.5, 1.6, -0.3))).unwrap();
        let frame = window.frame();
        window.pass(Vec::new(), Some(&path));
        window.until(ending, |app| {
            app.error().is_some()
                || app.seen().body.file.is_some() && app.shown().is_some_and(|shown| shown.frame > frame)
        });
        window.settle();
        assert_eq!(window.app().error(), None, "{ending}");
        // Lights of the look stand about the head, wherever that is: a scene that is saved has none of its own.
        assert!(window.app().seen().lights.is_empty(), "{ending}");
        let after = hair(&window.picture());
        assert!(2 * after > before && after < 2 * before, "{ending}: {before} pixels of hair became {after}");
    }
}

#[test]
fn moving_hair_is_written_for_the_program_that_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::still();
    window.app_mut().folder = folder.path().to_owned();
    window.toggle("Save");
    for (target, name, words) in [
        ("any", "hair_000.npz", None),
        ("blender", "hair_000.usda", Some(["metersPerUnit = 1\n", "upAxis = \"Z\""])),
        ("unreal", "hair_001.usda", Some(["metersPerUnit = 0.01", "upAxis = \"Z\""])),
    ] {
        window.control(Role::RadioButton, target).click_accesskit();
        window.pass(Vec::new(), None);
        window.click("Moving hair");
        window.until(name, |app| !app.is_exporting());
        assert_eq!(window.app().error(), None, "{name}");
        let bytes = std::fs::read(folder.path().join(name)).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(
            words.iter().flatten().all(|word| text.contains(word)),
            "{name}: {}",
            &text[..400.min(text.len())]
        );
    }
}
