//! From a scene to what runs: strands, body, solids and motion.

use std::sync::Arc;

use glam::{Quat, Vec3};
use strandline_base::cache;

use crate::{
    Error, HeadMotion, Scene, attributes,
    body::{Aabb, Carrier, Collider, DistanceGrid, Mannequin, Mesh, Shape},
    groom::{
        Groom, Guides, Outside,
        format::{self, LoadOptions},
    },
    hair_pose::HairPose,
    memory,
    scene::Model,
};

/// Air around a loaded body that its signed distance covers \[m\].
const DISTANCE_PADDING: f32 = 0.02;

/// Depth \[m\] up to which nobody is told: less than what samples of a body err by.
const WORTH_A_NOTE: f32 = 1e-4;

/// What a scene names, loaded or grown.
pub struct Prepared {
    /// The simulated strands.
    pub guides: Guides,
    /// The drawn body.
    pub mesh: Option<Mesh>,
    /// Everything that hair hits.
    pub colliders: Vec<Collider>,
    /// How the head moves.
    pub head: HeadMotion,
    /// Where the strands are to begin with; none at rest.
    pub(crate) pose: Option<HairPose>,
    /// The box around hair and drawn body at rest \[m\], head space.
    pub bounds: Aabb,
    /// What was mended or left out while loading, for a person to read.
    pub notes: Vec<String>,
}

/// The body of a scene before strands are known.
struct Body {
    mesh: Option<Mesh>,
    shape: Option<Shape>,
    pivot: Option<Vec3>,
}

impl Prepared {
    /// Loads and grows all that a scene names.
    ///
    /// # Errors
    /// Whatever a reader or a validation found; more memory than may be taken.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        scene.check()?;
        let mut notes = Vec::new();
        if scene.groom.file.is_none() {
            memory::check(scene, scene.style.strand_count)?;
        }
        let groom = groom(scene, &mut notes)?;
        memory::check(scene, groom.strand_count())?;
        let body = body(scene, &mut notes)?;
        let mut guides = Guides::resample(&groom, scene.groom.points_per_strand as usize)?;
        if groom.root_normals.is_none()
            && let Some(shape) = &body.shape
        {
            let normals = (0..guides.strand_count())
                .map(|strand| shape.distance_and_gradient(guides.position(strand, 0)).1)
                .collect();
            guides.set_root_normals(normals);
        }
        if let Some(file) = &scene.groom.attributes {
            attributes::load(&scene.path(file), &mut guides)?;
        }
        let shape = [guides.strand_count(), guides.points_per_strand()];
        let pose = scene.groom.pose.as_ref().map(|file| HairPose::load(&scene.path(file), shape));
        let pose = pose.transpose()?;
        let mut colliders = Vec::new();
        if scene.body.solid
            && let Some(shape) = body.shape
        {
            colliders.push(Collider::new(shape, Carrier::Head, scene.body.friction)?);
        }
        for section in &scene.colliders {
            colliders.push(section.collider()?);
        }
        notes.extend(move_outside(&mut guides, &colliders));
        let mesh = body.mesh.filter(|_| scene.body.visible);
        let bounds = bounds(&guides, mesh.as_ref());
        let pivot = scene.motion.pivot.or(body.pivot).unwrap_or_else(|| low_center(bounds));
        let head = HeadMotion::new(&scene.motion, pivot)?;
        Ok(Self { guides, mesh, colliders, head, pose, bounds, notes })
    }
}

/// The strands of a scene: from its file, or grown.
fn groom(scene: &Scene, notes: &mut Vec<String>) -> Result<Groom, Error> {
    let Some(file) = &scene.groom.file else { return Ok(scene.style.grow()?) };
    let options = LoadOptions {
        strict: false,
        scale: scene.groom.scale,
        up: scene.groom.up,
        per_strand: scene.groom.per_strand,
    };
    let loaded = format::load(&scene.path(file), &options)?;
    notes.extend(loaded.report.problems.iter().map(|problem| format!("{}: {problem}", file.display())));
    let mut groom = loaded.groom;
    groom.transform(1.0, Quat::IDENTITY, scene.groom.translation);
    let every = scene.groom.guide_every as usize;
    Ok(if every > 1 { groom.kept(|strand| strand % every == 0) } else { groom })
}

/// Puts what rests inside the solids that the head carries onto their surface; a note when there was such.
fn move_outside(guides: &mut Guides, colliders: &[Collider]) -> Option<String> {
    let solids: Vec<&Shape> =
        colliders.iter().filter(|solid| solid.carrier == Carrier::Head).map(|solid| &solid.shape).collect();
    let nearest = |point: Vec3| {
        let looks = solids.iter().map(|shape| shape.distance_and_gradient(point));
        looks.fold((f32::INFINITY, Vec3::Y), |best, look| if look.0 < best.0 { look } else { best })
    };
    let Outside { point_count, strand_count, depth, depth_left } = guides.move_outside(nearest);
    let mut note = format!(
        "{point_count} points of {strand_count} strands rested inside solids, by up to {:.2} mm: moved to the \
         surface, lengths kept",
        1e3 * depth
    );
    if depth_left > 1e-4 {
        note +=
            &format!("; up to {:.2} mm of that is left where segments do not reach out", 1e3 * depth_left);
    }
    (depth > WORTH_A_NOTE).then_some(note)
}

fn body(scene: &Scene, notes: &mut Vec<String>) -> Result<Body, Error> {
    let section = &scene.body;
    if let Some(file) = &section.file {
        let mesh = Mesh::load(&scene.path(file), section.scale)?;
        let shape = if section.solid { Some(solid(scene, &mesh, notes)?) } else { None };
        return Ok(Body { mesh: Some(mesh), shape, pivot: None });
    }
    let grown = scene.groom.file.is_none();
    Ok(match section.model {
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

/// The signed distance of a loaded body; a closed mesh as it is, an open one with its holes closed.
fn solid(scene: &Scene, drawn: &Mesh, notes: &mut Vec<String>) -> Result<Shape, Error> {
    let spacing = scene.body.spacing;
    let grid = match &scene.body.collider_file {
        Some(file) => kept_grid(&Mesh::load(&scene.path(file), scene.body.scale)?, spacing)?,
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

/// The grid of a mesh, from the folder of what is kept where it is there.
fn kept_grid(mesh: &Mesh, spacing: f32) -> Result<DistanceGrid, Error> {
    Ok(match cache::folder() {
        Some(folder) => DistanceGrid::kept(mesh, spacing, DISTANCE_PADDING, &folder.join("grids"))?,
        None => DistanceGrid::of_mesh(mesh, spacing, DISTANCE_PADDING)?,
    })
}

/// The box around strands and body \[m\].
pub(crate) fn bounds(guides: &Guides, mesh: Option<&Mesh>) -> Aabb {
    let (min, max) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    let mut bounds = mesh.and_then(Mesh::bounds).unwrap_or(Aabb { min, max });
    for strand in 0..guides.strand_count() {
        for point in 0..guides.points_per_strand() {
            let point = guides.position(strand, point);
            bounds = Aabb { min: bounds.min.min(point), max: bounds.max.max(point) };
        }
    }
    bounds
}

/// The middle of a box \[m\].
pub(crate) fn center(bounds: Aabb) -> Vec3 {
    0.5 * (bounds.min + bounds.max)
}

/// Where the neck of an unknown head may be: in the middle, a third of the way up.
fn low_center(bounds: Aabb) -> Vec3 {
    let mut center = center(bounds);
    center.y = bounds.min.y + (bounds.max.y - bounds.min.y) / 3.0;
    center
}
