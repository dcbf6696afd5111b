//! Checks of a chosen placement: properties that no hair of a head has, and refusals with the settings that decide.

use glam::Vec3;

use super::evidence::Hair;
use super::noted::flags;
use super::placing::{Defined, Placing, Placings};
use super::relation::Head;
use super::shown::Shown;
use crate::{
    Scene,
    groom::format::{RootEnd, Scale, Up},
};

/// Share of the way from root to tip that leads down below which strands stand, height of roots over half of the width of
/// the skull below which they are low, and share of them on the face that no hair has.
const STANDS: f32 = -0.3;
const LOW: f32 = 0.1;
const ON_FACE: f32 = 0.25;
/// Mean length of strands over the width of the skull that no hair has: two metres.
const LONGEST: f32 = 13.0;
/// Confidence in hair fitted to another head below which it lies there in no axes as hair does.
const LOST: f32 = 0.2;
/// Size over that of its file's metres between which fitted hair is believed to be of metres.
const NEAR_SIZE: std::ops::Range<f32> = 0.4..2.5;

/// A part of the place of a groom, which settings decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unsure {
    Axes,
    Unit,
}

impl Unsure {
    /// True where a scene leaves it open.
    fn is_open(self, scene: &Scene) -> bool {
        let groom = &scene.groom;
        match self {
            Self::Axes => groom.up == Up::Auto && groom.rotation == Vec3::ZERO,
            Self::Unit => groom.scale == Scale::Auto,
        }
    }

    /// The flag that keeps a placement, and its keys.
    fn kept(self, placing: &Placing) -> String {
        match self {
            Self::Axes => format!(
                "`--up` or `--turn` decides (`groom.up`, `groom.rotation`): `{}` keeps it so",
                flags(placing, placing)
            ),
            Self::Unit => {
                format!("`--scale` decides (`groom.scale`): `--scale {}` keeps it so", placing.scale)
            }
        }
    }
}

/// A property that no hair of a head has.
pub(super) struct Doubt {
    /// The property, human-readable.
    words: String,
    /// The part of the place that it speaks against.
    part: Unsure,
}

impl Doubt {
    /// Its note.
    pub fn note(&self) -> String {
        let mend = "`scale`, `up`, `rotation` and `translation` of [groom], or --scale, --up and --turn, place it otherwise";
        format!("{}, unlike hair of a head: {mend}", self.words)
    }
}

/// Properties of placed strands that no hair of a head has.
pub(super) fn doubts(hair: &Hair, head: &Head) -> Vec<Doubt> {
    let Some(skull) = head.skull.as_ref().filter(|_| head.pose.is_person) else { return Vec::new() };
    let mut doubts = Vec::new();
    let mut doubt = |words: String, part| doubts.push(Doubt { words, part });
    let length = hair.length();
    if length > LONGEST * skull.size.x {
        doubt(format!("the strands are {length:.1} m long in the mean"), Unsure::Unit);
    }
    if !hair.is_full(Some(skull.center())) {
        return doubts;
    }
    if hair.hangs() < STANDS && hair.high(skull) < LOW {
        doubt("the strands lead up from roots below the middle of the head".to_owned(), Unsure::Axes);
    }
    let on_face = hair.on_face(skull);
    if head.pose.shows_front && on_face > ON_FACE {
        doubt(format!("{:.0} % of the roots lie on the face", 100.0 * on_face), Unsure::Axes);
    }
    doubts
}

/// The reason to refuse a placement: two that are nearly alike, or one that speaks against itself, where a setting that
/// decides is left out.
pub(super) fn refusal(scene: &Scene, placings: &Placings, doubts: &[Doubt]) -> Option<String> {
    let placing = &placings.groom;
    if let Some(rival) = placings.rival {
        let part = if placing.is_turned_from(&rival) { Unsure::Axes } else { Unsure::Unit };
        if part.is_open(scene) {
            let [one, other] = [flags(placing, &rival), flags(&rival, placing)];
            return Some(format!(
                "it fits in two ways nearly alike: `{one}` and `{other}`; one of them decides (`groom.up`, \
                 `groom.rotation` and `groom.scale` of a scene)"
            ));
        }
    }
    let is_open = |part: Unsure| part.is_open(scene) && !(placings.is_foreign && part == Unsure::Unit);
    if let Some(doubt) = doubts.iter().find(|doubt| is_open(doubt.part)) {
        return Some(format!("{}, unlike hair of a head; {}", doubt.words, doubt.part.kept(placing)));
    }
    let is_open = Unsure::Axes.is_open(scene) && has_open_ends(scene);
    let is_lost = placings.is_foreign && placings.confidence < LOST && is_open;
    is_lost.then(|| {
        format!(
            "it lies on this head in no axes as hair does; {}, and `--root-end` gives the end of the roots",
            Unsure::Axes.kept(placing)
        )
    })
}

/// The reason to refuse a groom that lies away from its body, given how: none where a setting of its place is given.
pub(super) fn refusal_away(scene: &Scene, placing: &Placing, apart: &str) -> Option<String> {
    let is_open = Unsure::Axes.is_open(scene) && Unsure::Unit.is_open(scene) && has_open_ends(scene);
    (is_open && scene.groom.translation == Vec3::ZERO).then(|| {
        format!(
            "no axes and no unit bring it to the skin: {apart}. `--scale {}` alone (`groom.scale`) keeps it there",
            placing.scale
        )
    })
}

/// True where a scene leaves the end of the roots open.
fn has_open_ends(scene: &Scene) -> bool {
    scene.groom.root_end == RootEnd::Auto
}

/// Describes hair of a file whose format defines metres, fitted to a head with a size over that of those.
pub(super) fn note_of_size(is_defined: bool, size: f32) -> Option<String> {
    (is_defined && !NEAR_SIZE.contains(&size)).then(|| {
        format!(
            "the format of the groom's file defines metres: fitted to this head it is {size:.2} times as large; \
             `--scale 1` (`groom.scale`) keeps its size and place"
        )
    })
}

/// The reason to refuse the size of a person's head in the metres that the format of the body's file defines.
pub(super) fn refusal_of_body(shown: &Shown) -> Option<String> {
    let width = shown.odd_width.filter(|_| shown.defined != Defined::Nothing)?;
    let usual = super::units::unit_of_width(width).0;
    Some(format!(
        "its head is {width:.3} m wide in the metres that its format defines; `body.scale` decides: `--set \
         body.scale={usual}` makes it that of a person, `--set body.scale=1` keeps it"
    ))
}

#[cfg(test)]
#[path = "doubts_tests.rs"]
mod tests;
