//! Work of the load of a character and of a step on its moving skin, in counts, which are those of any machine.

use std::path::Path;
use std::sync::Arc;

use glam::{Quat, Vec3};
use strandline_body::{
    BodyFrame, Carrier, Collider, DistanceGrid, Mesh, Playback, Shape, SkinMotion, SkinRoots, SkinSolid,
};
use strandline_checks::{On, Rig};
use strandline_sim::{Drive, Model, Settings};

#[path = "../../crates/sim/examples/skin_step/character.rs"]
mod character;

use character::{PADDING, SPACING, frame, guides, mesh};

const STRANDS: usize = 1000;
const STEPS: u32 = 20;

/// A count may be this many times what it was when it was written down.
const SLACK: f64 = 1.25;

/// Counts beside those that were written down.
#[derive(Default)]
struct Held {
    rows: Vec<String>,
    is_more: bool,
}

impl Held {
    fn hold(&mut self, what: &str, found: f64, written: f64) {
        self.rows.push(format!("{what}: {found:.2}, {written} written down"));
        self.is_more |= !(found > 0.0 && found < SLACK * written);
    }

    fn check(self) {
        assert!(!self.is_more, "{}", self.rows.join("\n"));
    }
}

/// Times of the clock are no test here; `cargo run --release -p strandline-sim --example skin_step` measures them.
#[test]
fn a_character_is_loaded_and_stepped_with_few_searches() {
    let bust = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bust.glb");
    let (mesh, guides) = (mesh(&bust), guides(STRANDS));
    let grid = Arc::new(DistanceGrid::of_mesh(&mesh, SPACING, PADDING).unwrap());
    let [looks, exact] = grid.looks().map(|looks| looks as f64 / grid.nodes().len() as f64);
    let mut held = Held::default();
    held.hold("triangles that a node looks at", looks, 16.2);
    held.hold("triangles whose exact distance a node needs", exact, 3.3);
    let skin = Arc::new(SkinSolid::new(&mesh, grid).unwrap());
    let roots: Vec<Vec3> = (0..STRANDS).map(|strand| guides.position(strand, 0)).collect();
    let roots = SkinRoots::new(&mesh, &roots);
    for (rate, written) in [(120.0, [2157.0, 10.5, 665.0]), (60.0, [2468.0, 10.5, 678.0])] {
        let settings = Settings { time_step: 1.0 / rate, ..Settings::default() };
        let solid = Collider::new(Shape::Skin(Arc::clone(&skin)), Carrier::HEAD, 0.3).unwrap();
        let mut rig = Rig::new(&On::Cpu, Model::new(&guides, &settings, vec![solid]).unwrap());
        let (mut body, before) = (BodyFrame::REST, skin.work());
        for step in 1..=STEPS {
            body = roots.placed(frame(&mesh, step as f32 / rate), &body);
            rig.step(&Drive::of(body.clone()));
        }
        let work = skin.work();
        let [searches, looks, lines] = [0, 1, 2].map(|index| (work[index] - before[index]) as f64);
        let steps = f64::from(STEPS);
        held.hold(&format!("searches of a step, {rate} a second"), searches / steps, written[0]);
        held.hold(&format!("triangles of a search, {rate} a second"), looks / searches, written[1]);
        held.hold(&format!("lines of a step, {rate} a second"), lines / steps, written[2]);
    }
    held.check();
}

/// Of a clip the load needs all vertices at rest, and few of them at other times.
#[test]
fn the_load_of_a_clip_places_the_mesh_once() {
    let bust = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bust.glb");
    let (mesh, motion, _) = Mesh::load_moving(&bust, "nod").unwrap();
    let count = mesh.positions.len() as f64;
    let body =
        SkinMotion::new(motion.clone(), Playback::default(), &mesh.positions, (1.0, Quat::IDENTITY), &[]);
    let of_load = motion.placed_count() as f64;
    let mut held = Held::default();
    held.hold("meshes placed by the load", of_load / count, 1.0);
    body.unwrap().frame(0.7);
    held.hold("meshes placed by a frame", (motion.placed_count() as f64 - of_load) / count, 1.0);
    held.check();
}
