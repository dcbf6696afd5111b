//! A cache of drawn strands, made ready to be drawn again: each is a strand for itself.

use strandline_base::{
    counted,
    memory::{self, Need},
};

use super::{Cache, What};
use crate::{
    Error, Prepared, Scene,
    groom::{Groom, Guides, Widths},
    sim::StrandMethod,
    strands::tags::Tags,
};

/// Most points of a simulated strand; longer strands of a cache are drawn by this number of points, evenly along them.
const POINTS: usize = 64;

/// Loads a scene for pictures, with the strands of a cache in the place of its own.
///
/// # Errors
/// Whatever the scene's parts refuse; strands of different numbers of points; more memory than may be taken.
pub(crate) fn prepared(scene: &Scene, cache: &mut Cache) -> Result<Prepared, Error> {
    if cache.what() != What::Strands {
        return Prepared::new(scene);
    }
    let points = cache.points_per_strand()?;
    // The groom of the scene says where the body is.
    let mut prepared = Prepared::new(scene)?;
    let need = Need::new(format!("{} drawn strands", cache.starts().len() - 1), points as u64, 4 * 28);
    memory::check(&[need])?;
    let groom = rest(cache)?;
    let mut scene = prepared.scene;
    scene.groom.points_per_strand = points.min(POINTS) as u32;
    scene.simulation.strands.method = StrandMethod::Constrain;
    scene.simulation.volume.enabled = false;
    scene.level_of_detail.segments_per_span = 1;
    scene.level_of_detail.full_distance = FAR;
    scene.level_of_detail.most_segments = 1.0;
    let look = &mut scene.look;
    (look.follow_strands, look.hair_count, look.width_scale) = (1, groom.strand_count() as u32, 1.0);
    look.group.clear();
    (look.color_map, look.width_map) = (None, None);
    scene.groom.length = 1.0;
    let count = groom.strand_count();
    crate::prepare::memory::check(&scene, count, count, groom.colors.as_deref())?;
    prepared.guides = Guides::resample(&groom, points.min(POINTS))?;
    (prepared.bound, prepared.pose, prepared.tags) = (None, None, Tags::default());
    prepared
        .notes
        .push(format!("the cache's {} drawn", counted(groom.strand_count(), "strand is", "strands are")));
    prepared.scene = scene;
    Ok(prepared)
}

/// Farther away than any camera \[m\].
const FAR: f32 = 1e4;

/// The strands of the first frame, head space, with the attributes of look that the cache has.
fn rest(cache: &mut Cache) -> Result<Groom, Error> {
    let mut places = Vec::new();
    let head = cache.read(0, &mut places)?.world_from_head().inverse();
    let mut groom = Groom::empty(0.0);
    for range in cache.starts().windows(2) {
        let strand = &places[range[0] as usize..range[1] as usize];
        groom.push(strand.iter().map(|point| head.point(*point)));
    }
    if let Some(widths) = cache.per_point("widths", 1)? {
        groom.widths = Widths::PerPoint(widths);
    }
    groom.colors = cache.per_point("colors", 3)?.map(|colors| colors.as_chunks().0.to_vec());
    Ok(groom)
}
