//! The value that is handed from stage to stage while a scene is loaded.

use glam::Vec3;

use super::Sources;
use super::cover::Cover;
use super::memory;
use super::placing::{Defined, Placings};
use super::shown::Shown;
use super::skull::Skull;
use super::start::Start;
use crate::{
    Error, Scene,
    body::{Collider, Mesh, Shape, SkinMotion, VertexMotion},
    groom::{Groom, Guides},
};

/// A scene while it is loaded. Each stage fills in fields that later stages read.
pub(super) struct Loading<'a> {
    pub sources: &'a Sources,
    /// The scene; `grown` and `fit` choose the settings that it leaves open.
    pub scene: Scene,
    /// Mends, guesses and omissions, human-readable, in the order of the stages.
    pub notes: Vec<String>,
    /// Strands: in their own units and axes from `read`, in head space from `place`, grown by `roots` where the scene
    /// names none.
    pub groom: Option<Groom>,
    /// Strands of `groom.parts`, until `place` adds them to the groom.
    pub further_grooms: Vec<Groom>,
    /// The drawn body: in its own units and axes from `read`, in head space and with `body.parts` from `place`, the
    /// mannequin from `solids`.
    pub mesh: Option<Mesh>,
    /// Meshes of `body.parts`, until `place` adds them.
    pub further_meshes: Vec<Mesh>,
    /// The pose that the body shows in its own axes, from `ends` or `place`.
    pub shown: Option<Shown>,
    /// Motion of the drawn body's vertices, in the units and axes of its file, from `read`.
    pub motion: Option<VertexMotion>,
    /// Motions of those of `body.parts` that have a clip, in the units and axes of their files, from `read`: for each part.
    pub part_motions: Vec<Option<VertexMotion>>,
    /// Numbers of the first vertices of the drawn ones of `body.parts` in the drawn body, from `place`: for each part.
    pub part_starts: Vec<Option<usize>>,
    /// Motion of the body in head space, from `guides`.
    pub skin: Option<SkinMotion>,
    /// The mesh that hair hits, where it is not the drawn one.
    pub solid_mesh: Option<Mesh>,
    /// The skull of a body with parts, and the parts, which may cover hair, from `place`.
    pub skull: Option<Skull>,
    pub covers: Vec<Cover>,
    /// Placements of files, from `place`.
    pub placings: Placings,
    /// True where the groom was made for another head, from `place`.
    pub is_foreign: bool,
    /// True where the file of the groom holds hair as a style grows it, from `grown`.
    pub is_grown: bool,
    /// Signed distance of the body, from `solids`.
    pub shape: Option<Shape>,
    /// Everything that hair hits, from `solids`.
    pub colliders: Vec<Collider>,
    /// Pivot of the head's motion \[m\], head space, where the body has one, from `solids`.
    pub pivot: Option<Vec3>,
    /// All strands at rest, resampled, from `guides`.
    pub strands: Option<Guides>,
    /// Indices of the simulated strands, from `guides`; none where all are simulated.
    pub chosen: Option<Vec<usize>>,
    /// The simulated strands at rest, from `guides`.
    pub guides: Option<Guides>,
    /// The head when the hair begins to move, from `guides`.
    pub start: Start,
}

impl<'a> Loading<'a> {
    /// Checks a scene before anything of it is loaded.
    ///
    /// # Errors
    /// A setting outside its range, a source that the scene does not name, more memory than may be taken.
    pub fn new(scene: &Scene, sources: &'a Sources) -> Result<Self, Error> {
        scene.check()?;
        sources.check(scene)?;
        if scene.groom.file.is_none() {
            let drawn = scene.grown_strands();
            let drawn = drawn + scene.style.strands_beside(drawn);
            memory::check(scene, scene.style.strand_count, drawn, None)?;
        }
        Ok(Self {
            sources,
            scene: scene.clone(),
            notes: Vec::new(),
            groom: None,
            further_grooms: Vec::new(),
            mesh: None,
            further_meshes: Vec::new(),
            shown: None,
            motion: None,
            part_motions: Vec::new(),
            part_starts: Vec::new(),
            skin: None,
            solid_mesh: None,
            skull: None,
            covers: Vec::new(),
            placings: Placings::new(1.0),
            is_foreign: false,
            is_grown: false,
            shape: None,
            colliders: Vec::new(),
            pivot: None,
            strands: None,
            chosen: None,
            guides: None,
            start: Start::default(),
        })
    }

    /// The drawn body, where it comes from a source.
    pub fn own_mesh(&self) -> Option<&Mesh> {
        self.mesh.as_ref().filter(|_| self.scene.body.file.is_some())
    }

    /// Looks at the pose that the body shows in its own axes, if nobody did.
    pub fn look_at_body(&mut self) {
        if let (Some(mesh), None) = (&self.mesh, &self.shown) {
            self.shown = Some(Shown::new(&self.scene, mesh, self.defined()));
        }
    }

    /// Definitions that the format of the body makes.
    fn defined(&self) -> Defined {
        let file = self.scene.body.file.as_ref();
        file.map_or(Defined::Nothing, |file| self.sources.defined(file))
    }
}
