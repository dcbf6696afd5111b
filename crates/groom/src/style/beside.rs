//! Hair of the face beside other hair: beard, brows and lashes, each a group of its name.

use std::sync::Arc;

use strandline_base::par::prelude::*;
use strandline_body::Mannequin;

use super::face;
use super::skin::Skin;
use super::strand::WIDTH;
use super::{Style, StyleSettings};
use crate::arcs::equal_arcs;
use crate::{Groom, Widths};

/// Drawn strands of a part for each of its guides: short hair moves little.
const EACH_GUIDE: usize = 16;
/// Guides of a part at least: some on both sides of the face, and on both lids of an eye.
const LEAST_GUIDES: usize = 24;

impl Style {
    /// Hairs of a person in this style. 390 lashes are as thick as 550 hairs.
    pub fn hairs(self) -> u32 {
        match self {
            Self::Beard => 25_000,
            Self::Brows => 1_500,
            Self::Lashes => 550,
            _ => 100_000,
        }
    }

    /// Fewest strands of a part of the face: each lash is one.
    fn least_strands(self) -> usize {
        match self {
            Self::Lashes => 390,
            _ => 200,
        }
    }
}

impl StyleSettings {
    /// Parts of the face that grow beside the hair, in the order of their groups.
    pub fn beside(&self) -> impl Iterator<Item = Style> + use<> {
        let parts = [(self.beard, Style::Beard), (self.brows, Style::Brows), (self.lashes, Style::Lashes)];
        let style = self.style;
        parts.into_iter().filter(move |(grows, part)| *grows && *part != style).map(|(_, part)| part)
    }

    /// Strands of those parts where `drawn` strands are hair.
    pub fn strands_beside(&self, drawn: usize) -> usize {
        self.beside().map(|part| self.strands_of(part, drawn)).sum()
    }

    /// As many strands for each hair as the hair has, but no more strands than it.
    fn strands_of(&self, part: Style, drawn: usize) -> usize {
        let wanted = (self.hairs_over(part) * drawn as f64).ceil() as usize;
        wanted.min(drawn).max(part.least_strands())
    }

    fn hairs_over(&self, part: Style) -> f64 {
        f64::from(part.hairs()) / f64::from(self.style.hairs())
    }

    /// Adds the parts to hair of `drawn` strands with groups, and normals and coordinates of its roots.
    pub(super) fn grow_beside(&self, mannequin: &Arc<Mannequin>, drawn: usize, groom: &mut Groom) {
        for part in self.beside() {
            let count = groom.strand_count();
            groom.guide_flags.get_or_insert_with(|| vec![true; count]);
            let number = groom.groups.iter().flatten().max().map_or(0, |last| last + 1);
            groom.append(self.grown_part(part, number, mannequin, drawn));
        }
    }

    /// A part with as many points on a strand as the hair has.
    fn grown_part(&self, part: Style, number: u32, mannequin: &Arc<Mannequin>, drawn: usize) -> Groom {
        let count = self.strands_of(part, drawn);
        let guides = count.div_ceil(EACH_GUIDE).max(LEAST_GUIDES);
        let own = Self { seed: self.seed, ..Self::new(part) };
        let strands = face::strands(&own, &Skin::new(mannequin.clone()), count);
        let points = self.points();
        let even: Vec<Vec<_>> =
            strands.par_iter().map(|strand| equal_arcs(&strand.points, points).collect()).collect();
        let mut groom = Groom::empty(WIDTH);
        even.into_iter().for_each(|points| groom.push(points));
        // They are drawn as much wider than hairs as the hair is, so that fewer or more strands than their share are
        // thicker or thinner.
        let width = WIDTH * (self.hairs_over(part) * drawn as f64 / count as f64) as f32;
        groom.widths = Widths::Constant(width);
        groom.root_uvs = Some(strands.iter().map(|strand| strand.root.uv).collect());
        groom.root_normals = Some(strands.iter().map(|strand| strand.root.normal).collect());
        groom.groups = Some(vec![number; count]);
        groom.group_names = [(number, part.name().to_owned())].into();
        groom.guide_flags = Some((0..count).map(|strand| strand < guides).collect());
        groom
    }
}
