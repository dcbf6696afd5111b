//! First stage of loading: grooms, meshes and surroundings, each in its own units and axes.

use super::{loading::Loading, unmoved};
use crate::{Error, body::VertexMotion};

/// Reads the grooms, the meshes and the surroundings that a scene names.
pub(super) fn read(loading: &mut Loading) -> Result<(), Error> {
    let Loading { sources, scene, notes, .. } = loading;
    scene.load_surroundings()?;
    let mut groom = |name, per_strand| {
        let (groom, problems) = sources.groom(scene, name, per_strand)?;
        notes.extend(problems);
        Ok::<_, Error>(groom)
    };
    let section = &scene.groom;
    loading.groom = section.file.as_ref().map(|file| groom(file, section.per_strand)).transpose()?;
    let body = &scene.body;
    let mut noted = Vec::new();
    (loading.mesh, loading.motion) = match &body.file {
        Some(file) => {
            let (mesh, motion, notes) = sources.body(scene, file)?;
            noted.extend(notes);
            (Some(mesh), motion)
        }
        None => (None, None),
    };
    let mut mesh = |index| {
        let (mesh, motion, notes) = sources.part(scene, index)?;
        noted.extend(notes);
        Ok::<_, Error>((mesh, motion))
    };
    let parts = section.parts.iter().map(|part| groom(&part.file, part.per_strand));
    loading.further_grooms = parts.collect::<Result<_, _>>()?;
    let parts = (0..body.parts.len()).map(&mut mesh).collect::<Result<Vec<_>, _>>()?;
    (loading.further_meshes, loading.part_motions) = parts.into_iter().unzip();
    noted.extend(unmoved::notes(sources, scene, loading.motion.is_some()));
    if let (true, None, Some(mesh)) =
        (loading.part_motions.iter().any(Option::is_some), &loading.motion, &loading.mesh)
    {
        // A body that rests beside parts that move.
        loading.motion = Some(VertexMotion::sampled(vec![0.0], vec![mesh.positions.clone()])?);
    }
    notes.extend(noted);
    Ok(())
}
