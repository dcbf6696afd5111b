//! Attributes of a groom beside its points, and those that a format holds.

use crate::{Groom, Widths};

use super::HAIR_WIDTH;

/// Something that a groom may have beside its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attribute {
    /// A diameter for each strand, or one for all.
    Widths,
    /// Diameters that change along strands.
    WidthsAlong,
    /// Colours.
    Colors,
    /// Transparency.
    Transparencies,
    /// Positions of roots on the scalp.
    RootUvs,
    /// Normals of the skin at the roots.
    RootNormals,
    /// Numbers of groups.
    Groups,
    /// Their names.
    GroupNames,
    /// Marks of the strands that are guides.
    GuideFlags,
    /// The guides that strands follow.
    Influences,
    /// Masses.
    Masses,
    /// Velocities.
    Velocities,
}

impl Attribute {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Widths,
        Self::WidthsAlong,
        Self::Colors,
        Self::Transparencies,
        Self::RootUvs,
        Self::RootNormals,
        Self::Groups,
        Self::GroupNames,
        Self::GuideFlags,
        Self::Influences,
        Self::Masses,
        Self::Velocities,
    ];

    /// For a person to read.
    pub fn name(self) -> &'static str {
        match self {
            Self::Widths => "widths",
            Self::WidthsAlong => "widths along strands",
            Self::Colors => "colours",
            Self::Transparencies => "transparency",
            Self::RootUvs => "root coordinates",
            Self::RootNormals => "root normals",
            Self::Groups => "groups",
            Self::GroupNames => "names of groups",
            Self::GuideFlags => "marks of guides",
            Self::Influences => "guides of strands and their weights",
            Self::Masses => "masses",
            Self::Velocities => "velocities",
        }
    }

    /// True if a groom has it. A default width of all strands, which a reader gives if a file has no widths,
    /// does not count.
    pub fn is_in(self, groom: &Groom) -> bool {
        match self {
            Self::Widths => groom.widths != Widths::Constant(HAIR_WIDTH),
            Self::WidthsAlong => changes_along(groom),
            Self::Colors => groom.colors.is_some(),
            Self::Transparencies => groom.transparencies.is_some(),
            Self::RootUvs => groom.root_uvs.is_some(),
            Self::RootNormals => groom.root_normals.is_some(),
            Self::Groups => groom.groups.is_some(),
            Self::GroupNames => !groom.group_names.is_empty(),
            Self::GuideFlags => groom.guide_flags.is_some(),
            Self::Influences => groom.influences.is_some(),
            Self::Masses => groom.masses.is_some(),
            Self::Velocities => groom.velocities.is_some(),
        }
    }
}

fn changes_along(groom: &Groom) -> bool {
    let Widths::PerPoint(widths) = &groom.widths else { return false };
    (0..groom.strand_count()).any(|strand| widths[groom.range(strand)].windows(2).any(|two| two[0] != two[1]))
}
