//! Fourth stage of loading: everything that hair hits.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use strandline_base::cache;

use super::cover::Cover;
use super::grown::has_form_of_style;
use super::loading::Loading;
use super::moving::STIFF_NECK;
use super::placing::place_mesh;
use crate::{
    Error,
    body::{Carrier, Collider, DistanceGrid, Mannequin, Mesh, Neck, Shape, SignedDistance, SkinSolid},
    scene::{Model, solid_motion},
};

/// Air around a loaded body that its signed distance covers \[m\].
const DISTANCE_PADDING: f32 = 0.02;
/// Roots that are looked at, and their distance \[m\] from the skin that they grow on.
const LOOKED_AT: usize = 400;
const ON_SKIN: f32 = 1e-3;

/// Makes the signed distance of the body and the solids beside it; brings in the mannequin where the scene has it.
pub(super) fn solids(loading: &mut Loading) -> Result<(), Error> {
    let body = &loading.scene.body;
    let (is_grown, is_solid) = (loading.scene.groom.file.is_none(), body.solid);
    match (body.file.is_some(), body.model) {
        (true, _) if is_solid => loading.shape = Some(own_shape(loading)?),
        (true, _) => {}
        (false, Model::Mannequin) => mannequin(loading)?,
        (false, Model::Auto) if is_grown => mannequin(loading)?,
        (false, Model::Auto) if grows_on_mannequin(loading) => {
            let note = "the roots lie on the skin of the built-in bust: it is the body (body.model = \"none\" leaves it out)";
            loading.notes.push(note.to_owned());
            mannequin(loading)?;
        }
        (false, Model::Auto | Model::None) => {}
    }
    let scene = &loading.scene;
    let neck = loading.mesh.as_ref().and_then(|mesh| mesh.neck);
    if scene.motion.neck && neck.is_none() {
        loading.notes.push(STIFF_NECK.to_owned());
    }
    if let Some(shape) = loading.shape.clone().filter(|_| is_solid) {
        let parts = match neck {
            Some(neck) => {
                let mannequin = Mannequin::of(scene.body.build, scene.body.eyes);
                neck.solids_of(&mannequin, scene.body.spacing, DISTANCE_PADDING)?.to_vec()
            }
            None => vec![(shape, Carrier::HEAD)],
        };
        for (shape, carrier) in parts {
            loading.colliders.push(Collider::new(shape, carrier, scene.body.friction)?);
        }
    }
    let beside = solid_motion::colliders(&scene.colliders, neck.map_or(0, |_| Neck::PIECES))?;
    loading.colliders.extend(beside);
    Ok(())
}

/// True if the groom's file has the form of a style, with its roots on the skin of the mannequin.
fn grows_on_mannequin(loading: &Loading) -> bool {
    let Loading { scene, groom: Some(groom), .. } = loading else { return false };
    if !has_form_of_style(groom) {
        return false;
    }
    let skin = Mannequin::of(scene.body.build, scene.body.eyes);
    let every = (groom.strand_count() / LOOKED_AT).max(1);
    let roots: Vec<Vec3> = groom.roots().step_by(every).collect();
    let off = roots.iter().filter(|root| !(skin.distance(**root).abs() < ON_SKIN)).count();
    off * 100 <= roots.len()
}

/// Adds the mannequin. Hair hits its signed distance sampled at `spacing`, or the exact one, whose lookups take four
/// times as long.
fn mannequin(loading: &mut Loading) -> Result<(), Error> {
    let body = &loading.scene.body;
    let mannequin = Arc::new(Mannequin::of(body.build, body.eyes));
    let shape = if body.exact {
        Shape::Mannequin(mannequin.clone())
    } else {
        let grid = mannequin.grid(body.spacing, DISTANCE_PADDING)?;
        grid_shape(loading, grid)
    };
    let (scene, pivot) = (&loading.scene, mannequin.neck_pivot());
    let bends = scene.motion.neck && !scene.body.exact;
    let neck = bends.then(|| Neck::new(scene.motion.pivot.unwrap_or(pivot)));
    (loading.mesh, loading.pivot) = (Some(Mesh { neck, ..mannequin.figure() }), Some(pivot));
    loading.shape = Some(shape);
    Ok(())
}

/// The grid of a mesh, from the folder of kept grids where it is there.
fn kept_grid(mesh: &Mesh, spacing: f32) -> Result<DistanceGrid, Error> {
    Ok(match cache::folder() {
        Some(folder) => DistanceGrid::kept(mesh, spacing, DISTANCE_PADDING, &folder.join("grids"))?,
        None => DistanceGrid::of_mesh(mesh, spacing, DISTANCE_PADDING)?,
    })
}

/// The signed distance of a body from a source: of a closed mesh as it is, of an open one with its holes closed.
fn own_shape(loading: &mut Loading) -> Result<Shape, Error> {
    let (scene, placing) = (&loading.scene, loading.placings.body);
    let (body, drawn) = (&scene.body, loading.mesh.as_ref());
    let grid = match (&body.collider_file, loading.solid_mesh.as_ref().or(drawn)) {
        (Some(file), _) => {
            let mut mesh = loading.sources.mesh(scene, file)?;
            place_mesh(&mut mesh, placing, body.rotation, body.translation);
            if body.parts.iter().any(|part| part.solid == Some(true)) {
                loading.notes.push(
                    "body.collider_file is all that hair hits: solid body.parts are only drawn".to_owned(),
                );
            }
            if loading.motion.is_some() {
                loading.notes.push(
                    "body.collider_file rides the head and keeps its shape while the body moves: without it hair hits the \
                     moving skin"
                        .to_owned(),
                );
            }
            kept_grid(&mesh, body.spacing)?
        }
        (None, mesh) => kept_grid(mesh.unwrap_or(&Mesh::default()), body.spacing)?,
    };
    let follows = loading.motion.is_some() && body.collider_file.is_none();
    let shape = grid_shape(loading, Arc::new(grid));
    match (loading.mesh.as_ref().filter(|_| follows), shape) {
        (Some(mesh), Shape::Grid(grid)) => {
            let note = hidden_solids(loading);
            let skin = solid_skin(mesh, &loading.part_starts, &loading.covers);
            let solid = SkinSolid::new(&skin, grid)?;
            loading.notes.extend(note);
            Ok(Shape::Skin(Arc::new(solid)))
        }
        (_, shape) => Ok(shape),
    }
}

/// The drawn mesh with the triangles that hair hits alone: not those of parts that are not solid.
fn solid_skin<'a>(mesh: &'a Mesh, starts: &[Option<usize>], parts: &[Cover]) -> Cow<'a, Mesh> {
    let range = |(start, part): (&Option<usize>, &Cover)| {
        start.filter(|_| !part.is_solid).map(|start| start..start + part.mesh.positions.len())
    };
    let open: Vec<Range<usize>> = starts.iter().zip(parts).filter_map(range).collect();
    if open.is_empty() {
        return Cow::Borrowed(mesh);
    }
    let is_solid = |corners: &&[u32; 3]| {
        !open.iter().any(|range| corners.iter().any(|&index| range.contains(&(index as usize))))
    };
    let triangles = mesh.triangles.iter().filter(is_solid).copied().collect();
    // Materials have one entry for each triangle.
    Cow::Owned(Mesh { triangles, materials: None, ..mesh.clone() })
}

/// A note on solid parts that are not drawn: a moving skin is the drawn one.
fn hidden_solids(loading: &Loading) -> Option<String> {
    let hidden = |(start, part): (&Option<usize>, &Cover)| {
        (start.is_none() && part.is_solid).then(|| part.name.clone())
    };
    let names: Vec<String> = loading.part_starts.iter().zip(&loading.covers).filter_map(hidden).collect();
    let list = names.join(", ");
    (!names.is_empty()).then(|| format!("{list}: hair does not hit what is not drawn of a body that moves"))
}

/// A grid as a solid. Adds a note where it is coarser than the scene asks for.
fn grid_shape(loading: &mut Loading, grid: Arc<DistanceGrid>) -> Shape {
    let (asked, spacing) = (loading.scene.body.spacing, grid.spacing());
    if spacing > asked {
        let [x, y, z] = grid.cells().to_array();
        loading.notes.push(format!(
            "body.spacing is {asked} m, which is too fine for a body of this size: {spacing:.4} m is taken, \
             {x} x {y} x {z} cells"
        ));
    }
    Shape::Grid(grid)
}
