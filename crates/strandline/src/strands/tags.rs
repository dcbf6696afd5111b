//! Attributes of strands beyond their points: for files, not for pictures.

use crate::groom::Groom;

/// Largest group number that is kept unchanged: names lie in a list by their numbers.
const MOST_NUMBER: u32 = 4095;

/// Groups and root coordinates of the strands of a groom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tags {
    /// Coordinates of each root on the scalp, 0 to 1, shape `[strand]`.
    pub root_uvs: Option<Vec<[f32; 2]>>,
    /// The group of each strand, shape `[strand]`.
    pub groups: Option<Vec<u16>>,
    /// Names of groups by their numbers; empty where they have none.
    pub group_names: Vec<String>,
    /// Indices of the simulated strands, ascending; `None` for all.
    pub guides: Option<Vec<usize>>,
}

impl Tags {
    /// Tags of a groom. Groups of large numbers are numbered again, in the order of their numbers.
    pub(crate) fn new(groom: &Groom, guides: Option<&[usize]>) -> Self {
        let mut numbers: Vec<u32> = groom.groups.clone().unwrap_or_default();
        numbers.sort_unstable();
        numbers.dedup();
        // More groups than a file has numbers for share the last of them.
        let renumbered = numbers.last().is_some_and(|last| *last > MOST_NUMBER);
        let number = |group: u32| {
            let number =
                if renumbered { numbers.partition_point(|known| *known < group) } else { group as usize };
            u16::try_from(number).unwrap_or(u16::MAX)
        };
        let mut group_names = Vec::new();
        for group in numbers.iter().filter(|group| groom.group_names.contains_key(group)) {
            let place = usize::from(number(*group));
            group_names.resize(group_names.len().max(place + 1), String::new());
            group_names[place].clone_from(&groom.group_names[group]);
        }
        Self {
            root_uvs: groom.root_uvs.as_ref().map(|uvs| uvs.iter().map(|uv| uv.to_array()).collect()),
            groups: groom.groups.as_ref().map(|groups| groups.iter().map(|group| number(*group)).collect()),
            group_names,
            guides: guides.map(<[usize]>::to_vec),
        }
    }

    /// Tags of the simulated strands, where others are bound to them.
    pub(crate) fn of_guides(&self) -> Self {
        let Some(guides) = &self.guides else { return self.clone() };
        Self {
            root_uvs: self.root_uvs.as_ref().map(|uvs| guides.iter().map(|guide| uvs[*guide]).collect()),
            groups: self.groups.as_ref().map(|groups| guides.iter().map(|guide| groups[*guide]).collect()),
            group_names: self.group_names.clone(),
            guides: None,
        }
    }

    /// The tags with each strand repeated, for strands that stand for several.
    pub(crate) fn repeated(&self, times: usize) -> Self {
        fn each<T: Copy>(values: Option<&Vec<T>>, times: usize) -> Option<Vec<T>> {
            values.map(|all| all.iter().flat_map(|one| std::iter::repeat_n(*one, times)).collect())
        }
        Self {
            root_uvs: each(self.root_uvs.as_ref(), times),
            groups: each(self.groups.as_ref(), times),
            group_names: self.group_names.clone(),
            guides: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_keep_their_numbers_unless_these_are_large() {
        let mut groom = Groom::empty(8e-5);
        for _ in 0..3 {
            groom.push([glam::Vec3::ZERO, glam::Vec3::Y]);
        }
        groom.groups = Some(vec![7, 2, 7]);
        groom.group_names.insert(2, "brow".to_owned());
        let tags = Tags::new(&groom, Some(&[1, 2]));
        assert_eq!(tags.groups.as_deref(), Some(&[7, 2, 7][..]));
        assert_eq!(tags.group_names, ["", "", "brow"]);
        assert_eq!(tags.of_guides().groups.as_deref(), Some(&[2, 7][..]));
        assert_eq!(tags.of_guides().repeated(2).groups.as_deref(), Some(&[2, 2, 7, 7][..]));
        groom.groups = Some(vec![70_000, 2, 70_000]);
        assert_eq!(Tags::new(&groom, None).groups.as_deref(), Some(&[1, 0, 1][..]));
        assert_eq!(Tags::new(&groom, None).group_names, ["brow"]);
    }
}
