//! Bands about tied hair, drawn as a part of the body.

use crate::{
    Error, Scene,
    body::Mesh,
    groom::{Guides, Tie},
};

/// Thickness \[m\] of a band.
const THICKNESS: f32 = 0.004;
/// Share of the radius of a clump within which most of its follow strands lie.
const FOLLOWING: f32 = 0.85;

/// Adds a ring to the body for each tie with a band, about the strands that are drawn; hair without a body has rings alone.
/// Hair passes through them. A body whose vertices a program gives and may move keeps these alone.
pub(super) fn add(
    scene: &Scene,
    [is_grown, is_moved_by_host]: [bool; 2],
    ties: &[Tie],
    strands: &Guides,
    mesh: &mut Option<Mesh>,
) -> Result<(), Error> {
    if !scene.groom.bands.unwrap_or(is_grown && mesh.is_some()) || is_moved_by_host {
        return Ok(());
    }
    let look = &scene.look;
    let room = if look.follow_strands > 1 { FOLLOWING * look.clump.root_radius } else { 0.0 };
    let spread = strands.spreads().map_or(1.0, |all| all.iter().sum::<f32>() / all.len() as f32);
    for band in ties.iter().filter_map(|tie| strands.band(tie)) {
        let half_axes = band.half_axes.map(|axis| axis + spread * room * axis.normalize_or_zero());
        let ring = Mesh::ring(band.middle, half_axes, THICKNESS, scene.groom.band_color);
        match mesh {
            Some(mesh) => mesh.append(&ring)?,
            None => *mesh = Some(ring),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::{
        Prepared, Scene, Sources, Style,
        body::{Mannequin, Material},
        groom::StyleSettings,
        scene::TieSection,
    };

    /// Middles of the bands of a scene's body, which have the scene's colour.
    fn bands(scene: &Scene) -> Vec<Vec3> {
        let Some(mesh) = Prepared::new(scene).unwrap().mesh else { return Vec::new() };
        let Some(materials) = &mesh.materials else { return Vec::new() };
        let color = Some(scene.groom.band_color.extend(1.0));
        let named = materials.list.iter().enumerate();
        let is_band =
            |material: &Material| material.name.as_deref() == Some("band") && material.color == color;
        let named = named.filter(|(_, material)| is_band(material));
        let middle = |(number, _): (usize, _)| {
            let of = mesh.triangles.iter().zip(&materials.of_triangles);
            let own: Vec<u32> =
                of.filter(|(_, of)| **of == number as u32).flat_map(|(one, _)| *one).collect();
            own.iter().map(|corner| mesh.positions[*corner as usize]).sum::<Vec3>() / own.len() as f32
        };
        named.map(middle).collect()
    }

    #[test]
    fn tied_styles_and_tied_hair_of_files_on_demand_have_a_band() {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = Scene::demo();
        scene.groom.band_color = Vec3::X;
        for style in [Style::Long, Style::Bun, Style::Braid, Style::Ponytail] {
            scene.style = StyleSettings { strand_count: 300, ..StyleSettings::new(style) };
            assert_eq!(bands(&scene).len(), usize::from(style != Style::Long), "{style:?}");
        }
        let [middle] = bands(&scene)[..] else { panic!("one band") };
        let tie = Vec3::new(0.0, 0.038, -0.117);
        assert!(middle.distance(tie) < 0.02 && middle.z < tie.z + 0.002, "{middle}: behind the tie");
        scene.ties = vec![TieSection { position: tie, radius: 0.03 }];
        assert!(bands(&scene)[0].distance(middle) < 0.01, "a tie that the scene names");
        scene.ties.clear();
        scene.groom.bands = Some(false);
        assert_eq!(bands(&scene), []);
        let file = folder.path().join("tail.hair");
        Prepared::groom(&scene).unwrap().save(&file).unwrap();
        scene.groom.file = Some(file);
        scene.groom.bands = None;
        assert_eq!(bands(&scene), [], "a file may have its own");
        scene.groom.bands = Some(true);
        assert_eq!(bands(&scene).len(), 1);
        scene.body.file = Some("own".into());
        let sources = Sources::default().with_mesh("own", Mannequin::new().mesh());
        let found = Prepared::from_sources(&scene, &sources).unwrap();
        assert!(found.notes.iter().any(|note| note.starts_with("groom.bands: no band")), "{:?}", found.notes);
        assert_eq!(found.mesh.unwrap().positions.len(), Mannequin::new().mesh().positions.len());
    }
}
