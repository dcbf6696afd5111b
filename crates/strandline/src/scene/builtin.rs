use std::str::FromStr;
use std::sync::Arc;

use glam::Vec3;
use strandline_base::{SettingError, Value};

use super::groom::{filling, grown};
use super::{FilmSection, GroomSection, MotionName, Scene};
use crate::{
    Error,
    body::Mannequin,
    groom::{Groom, Style, StyleSettings},
    render::{Background, Coat, LevelOfDetail, Preset, ToneMap},
    sim::{
        Settings, StrandMethod,
        rods::{HairKind, Rest},
    },
};

impl Scene {
    /// Strands that the scene's style grows in all.
    pub(crate) fn grown_strands(&self) -> usize {
        grown(self.style.strand_count, self.groom.bound)
    }

    /// Grows so many strands of the scene's style, its guides first, on the build of its mannequin: head space \[m\].
    ///
    /// # Errors
    /// A setting of the style outside its range; more memory than may be taken.
    pub fn grow(&self, strands: usize) -> Result<Groom, Error> {
        let mannequin = Mannequin::of(self.body.build, self.body.eyes);
        Ok(self.style.grow_on(Arc::new(mannequin), strands)?)
    }

    /// The demo: the default style shakes its head for 4 s. An empty scene file is the same scene.
    pub fn demo() -> Self {
        Self::default()
    }

    /// Replaces the strands by a built-in style, with as many points on a guide as its curls need
    /// (`groom.points_per_strand`), a drawn segment about every centimetre
    /// (`level_of_detail.segments_per_span`) and 16 drawn strands for each guide (`look.follow_strands`). A file that
    /// names a style and none of these gets the same.
    pub fn set_style(&mut self, style: Style) {
        let StyleSettings { seed, strand_count, beard, brows, lashes, .. } = self.style;
        self.groom.file = None;
        self.groom.parts.clear();
        self.begin_at_rest();
        self.style = StyleSettings { seed, strand_count, beard, brows, lashes, ..StyleSettings::new(style) };
        self.groom.points_per_strand = style.points_per_strand();
        self.level_of_detail.segments_per_span = segments_per_span(self.groom.points_per_strand);
        // Hairs of a face are fewer than those of a head; other numbers are the user's.
        if Style::ALL.into_iter().any(|style| style.hairs() == self.look.hair_count) {
            self.look.hair_count = style.hairs();
        }
        self.look.follow_strands = filling(strand_count, self.groom.bound);
    }

    /// Sets what settings of the simulation bring along in other sections, before they are taken themselves.
    pub(super) fn follow_simulation(&mut self, given: &<Settings as Value>::Given) {
        let strands = given.strands.as_ref();
        if let Some(method) = strands.and_then(|strands| strands.method) {
            // Hair that is wet droops as rods alone.
            self.simulation.strands.method = method;
            if method == StrandMethod::Constrain {
                self.film.settle = FilmSection::SETTLE;
            }
        }
        let hair = strands.and_then(|strands| strands.rods.as_ref()).and_then(|rods| rods.hair);
        hair.into_iter().for_each(|hair| self.set_hair(hair));
        let has_wet = given.groups.iter().flatten().any(|group| group.hair == Some(HairKind::Wet));
        if has_wet && self.simulation.strands.method == StrandMethod::Rods {
            self.film.settle = self.film.settle.max(FilmSection::DROOP);
        }
    }

    /// Sets a kind of hair: its material as rods, and what is seen of it (`look.coat`). Hair that is wet droops before the film
    /// begins (`film.settle`).
    pub fn set_hair(&mut self, hair: HairKind) {
        let rods = &mut self.simulation.strands.rods;
        let drooped = rods.rest == Rest::Dry;
        rods.set_hair(hair);
        let droops = rods.rest == Rest::Dry && self.simulation.strands.method == StrandMethod::Rods;
        if droops {
            self.film.settle = self.film.settle.max(FilmSection::DROOP);
        } else if drooped && self.film.settle == FilmSection::DROOP {
            self.film.settle = FilmSection::default().settle;
        }
        self.look.coat = match hair {
            HairKind::Fine | HairKind::Medium | HairKind::Coarse => Coat::NONE,
            HairKind::Wet => Coat::WATER,
            HairKind::Sprayed => Coat::LACQUER,
        };
    }

    /// Sets tone map and background that go with the look of the thesis.
    pub(super) fn dress_thesis(&mut self) {
        self.picture.tone_map = ToneMap::Filmic;
        self.picture.background =
            Background { top: Vec3::new(0.30, 0.33, 0.37), bottom: Vec3::new(0.11, 0.12, 0.135) };
    }

    /// The thesis's scene [Chen2011 §6]: 1,750 guides x 6 points, 32^3 cells, 20 iterations, 16
    /// follow strands, 560,000 segments, three lights of which two cast shadows, head shake.
    pub fn thesis() -> Self {
        // Six points bend over the skull only when they are not far apart: a bob.
        let mut scene = Self {
            groom: GroomSection { points_per_strand: 6, bound: Some(0), ..GroomSection::default() },
            style: StyleSettings { strand_count: 1750, ..StyleSettings::new(Style::Bob) },
            simulation: Settings::thesis(),
            film: FilmSection { settle: FilmSection::SETTLE, ..FilmSection::default() },
            ..Self::default()
        };
        scene.motion.name = MotionName::Shake;
        scene.look.dress(Preset::Thesis);
        scene.look.follow_strands = 16;
        scene.dress_thesis();
        scene.level_of_detail = LevelOfDetail::full();
        (scene.picture.width, scene.picture.height) = (800, 600);
        scene
    }
}

/// Segments on each span of a style's strand of some points: about one on every centimetre.
pub(crate) fn segments_per_span(points: u32) -> u32 {
    match points {
        ..12 => 2,
        12..20 => 3,
        20..40 => 2,
        _ => 1,
    }
}

impl FromStr for Scene {
    type Err = Error;

    /// A built-in scene by its name, `demo` or `thesis`, in letters of either case.
    fn from_str(name: &str) -> Result<Self, Error> {
        match name.to_ascii_lowercase().as_str() {
            "demo" => Ok(Self::demo()),
            "thesis" => Ok(Self::thesis()),
            _ => {
                let expected = "demo, thesis or the path of a .toml file";
                Err(SettingError::new("scene", format!("`{name}`"), expected).into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Build, SignedDistance};

    #[test]
    fn hair_grows_on_the_build_of_its_body() {
        let mut scene = Scene::demo();
        scene.set_style(Style::Beard);
        scene.style.strand_count = 200;
        let mut off = Build::ALL.map(|build| {
            scene.body.build = build;
            let groom = scene.grow(200).unwrap();
            let skin = Mannequin::of(build, scene.body.eyes);
            let other = Mannequin::of(Build::Broad, scene.body.eyes);
            let most =
                |skin: &Mannequin| groom.roots().map(|root| skin.distance(root).abs()).fold(0.0, f32::max);
            assert!(most(&skin) < 2e-5, "{build:?}: {} m", most(&skin));
            most(&other)
        });
        off.sort_by(f32::total_cmp);
        assert!(off[2] > 1e-3, "builds differ: {off:?} m");
    }
}
