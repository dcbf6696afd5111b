//! The body of a scene: loaded, or built in.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::cache;

use crate::{
    Error, Scene,
    body::{DistanceGrid, Mannequin, Mesh, Shape},
    scene::Model,
};

use super::parts::Meshes;
use super::placing::{self, Placing};

/// Air around a loaded body that its signed distance covers \[m\].
const DISTANCE_PADDING: f32 = 0.02;

/// The body of a scene before strands are known.
pub(super) struct Body {
    pub mesh: Option<Mesh>,
    pub shape: Option<Shape>,
    pub pivot: Option<Vec3>,
}

/// The mesh that a scene names, as its file has it.
pub(super) fn mesh(scene: &Scene) -> Result<Option<Mesh>, Error> {
    Ok(scene.body.file.as_ref().map(|file| Mesh::load(&scene.path(file), 1.0)).transpose()?)
}

/// The body of a scene; `meshes` are those of its files, in head space.
pub(super) fn body(
    scene: &Scene,
    meshes: Option<Meshes>,
    placing: Placing,
    notes: &mut Vec<String>,
) -> Result<Body, Error> {
    if let Some(Meshes { drawn, solid: hit }) = meshes {
        let hit = hit.as_ref().unwrap_or(&drawn);
        let shape = if scene.body.solid { Some(solid(scene, hit, placing, notes)?) } else { None };
        return Ok(Body { mesh: Some(drawn), shape, pivot: None });
    }
    let grown = scene.groom.file.is_none();
    Ok(match scene.body.model {
        Model::Mannequin => mannequin(scene, notes)?,
        Model::Auto if grown => mannequin(scene, notes)?,
        Model::Auto | Model::None => Body { mesh: None, shape: None, pivot: None },
    })
}

/// The mannequin; hair hits its signed distance sampled at `spacing`, or the exact one, which is
/// looked up four times as slowly.
fn mannequin(scene: &Scene, notes: &mut Vec<String>) -> Result<Body, Error> {
    let mannequin = Mannequin::new();
    let shape = if scene.body.exact {
        Shape::Mannequin(mannequin.clone())
    } else {
        let grid = DistanceGrid::from_field(&*mannequin, scene.body.spacing, DISTANCE_PADDING)?;
        grid_shape(scene, grid, notes)
    };
    Ok(Body { mesh: Some(mannequin.mesh()), pivot: Some(mannequin.neck_pivot()), shape: Some(shape) })
}

/// The grid of a mesh, from the folder of what is kept where it is there.
fn kept_grid(mesh: &Mesh, spacing: f32) -> Result<DistanceGrid, Error> {
    Ok(match cache::folder() {
        Some(folder) => DistanceGrid::kept(mesh, spacing, DISTANCE_PADDING, &folder.join("grids"))?,
        None => DistanceGrid::of_mesh(mesh, spacing, DISTANCE_PADDING)?,
    })
}

/// The signed distance of a loaded body; a closed mesh as it is, an open one with its holes closed.
fn solid(scene: &Scene, drawn: &Mesh, placing: Placing, notes: &mut Vec<String>) -> Result<Shape, Error> {
    let spacing = scene.body.spacing;
    let grid = match &scene.body.collider_file {
        Some(file) => {
            let mut mesh = Mesh::load(&scene.path(file), 1.0)?;
            placing::place_mesh(&mut mesh, placing, scene.body.rotation, scene.body.translation);
            if scene.body.parts.iter().any(|part| part.solid == Some(true)) {
                notes.push(
                    "body.collider_file is all that hair hits: solid body.parts are only drawn".to_owned(),
                );
            }
            kept_grid(&mesh, spacing)?
        }
        None => kept_grid(drawn, spacing)?,
    };
    Ok(grid_shape(scene, grid, notes))
}

/// A grid as a solid; says when it is coarser than the scene asks.
fn grid_shape(scene: &Scene, grid: DistanceGrid, notes: &mut Vec<String>) -> Shape {
    let (asked, spacing) = (scene.body.spacing, grid.spacing());
    if spacing > asked {
        let [x, y, z] = grid.cells().to_array();
        notes.push(format!(
            "body.spacing is {asked} m, which is too fine for a body of this size: {spacing:.4} m is taken, \
             {x} x {y} x {z} cells"
        ));
    }
    Shape::Grid(Arc::new(grid))
}
