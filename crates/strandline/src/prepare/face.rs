//! Hair of the face among strands as a style grows them: beard, brows and lashes, each a group of its name.

use crate::groom::{Groom, Style};

/// Share of the spread of drawn strands about those of brows and lashes: brows are narrow, and strands that follow one of
/// a lash lie in it.
const BROWS: f32 = 0.4;
const LASHES: f32 = 0.03;

/// The strands of a groom that are hair of the face.
pub(super) struct Face {
    /// Part of the face that each strand is of, shape `[strand]`.
    parts: Vec<Option<Style>>,
}

impl Face {
    /// Hair of the face of a groom as a style grows it; `None` where it has none.
    pub fn of(groom: &Groom) -> Option<Self> {
        let named = |number: &u32| {
            let part = groom.group_names.get(number)?.parse::<Style>().ok();
            part.filter(|part| part.is_of_face())
        };
        let parts: Vec<Option<Style>> = groom.groups.as_ref()?.iter().map(named).collect();
        parts.iter().any(Option::is_some).then_some(Self { parts })
    }

    /// True where all strands are lashes.
    pub fn is_lashes(&self) -> bool {
        self.parts.iter().all(|part| *part == Some(Style::Lashes))
    }

    /// Number of strands, of some, that grow beside other hair: all but those of the part that the first strand is of.
    pub fn beside(&self, strands: impl Iterator<Item = usize>) -> usize {
        let own = self.parts.first().copied().flatten();
        strands.filter(|strand| self.parts[*strand] != own).count()
    }

    /// Factors of the spread of drawn strands, shape `[strand]`, on top of those that are given.
    pub fn spreads(&self, given: Option<Vec<f32>>) -> Vec<f32> {
        let mut spreads = given.unwrap_or_else(|| vec![1.0; self.parts.len()]);
        for (spread, part) in spreads.iter_mut().zip(&self.parts) {
            *spread *= match part {
                Some(Style::Brows) => BROWS,
                Some(Style::Lashes) => LASHES,
                _ => 1.0,
            };
        }
        spreads
    }
}
