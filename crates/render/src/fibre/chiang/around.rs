//! Terms around the fibre of one pigment.

use glam::{Vec3, Vec4};

use super::table::{AROUND, EYES, EyeRow, Met, TURNS, Table, channels, paths};

/// Terms around a fibre of one pigment: those of a table, with nothing between its levels left to be found.
#[derive(Clone, Debug)]
pub(crate) struct PigmentTerms {
    /// Two for each `[eye][turn]`.
    entries: Vec<Vec4>,
}

impl Table {
    /// The terms around the fibre of the pigment of a point.
    pub(crate) fn around_of(&self, seen: &EyeRow) -> PigmentTerms {
        let entry = |at: usize| {
            let of_level = |level: usize| self.entries[AROUND + 2 * level * EYES * TURNS + at];
            let found =
                seen.levels.map(|(level, between)| of_level(level).lerp(of_level(level + 1), between));
            let [mixed] = channels(found.map(|found| [found]), [found[0].w]);
            mixed
        };
        PigmentTerms { entries: (0..2 * EYES * TURNS).map(entry).collect() }
    }

    /// [`Table::by_path_along`] for a point of that pigment.
    #[inline]
    pub(crate) fn by_path_around(
        &self,
        (terms, around): (&[Vec4], &PigmentTerms),
        seen: &EyeRow,
        met: &Met,
        turn: f32,
    ) -> [Vec3; 3] {
        let (along, turn) = self.along(terms, seen, met, turn, 0.0);
        paths(along, around.at(seen.row, turn))
    }
}

impl PigmentTerms {
    /// The terms between nodes of the eye's inclination and the turn.
    #[inline]
    fn at(&self, (row, down): (usize, f32), (column, across): (usize, f32)) -> [Vec4; 2] {
        let first = 2 * (row * TURNS + column);
        let rows = [&self.entries[first..first + 4], &self.entries[first + 2 * TURNS..][..4]];
        [0, 1].map(|part| {
            let [near, far] = rows.map(|row| row[part].lerp(row[part + 2], across));
            near.lerp(far, down)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Chiang, Pigments};
    use super::*;

    #[test]
    fn terms_of_one_pigment_are_those_of_the_table() {
        let table = Table::new(&Chiang::default().lobes(), [0.2, 0.5, 1.0]);
        let pigments =
            [Pigments::Even(1.0), Pigments::Even(0.3), Pigments::Channels(Vec3::new(0.1, 1.5, 0.02))];
        for (number, pigments) in pigments.into_iter().enumerate() {
            let around = table.around_of(&EyeRow::new(0.0, pigments));
            for index in 0..200 {
                let mut random = strandline_base::Random::new(4, index);
                let [eye, light, turn] = [(); 3].map(|()| 2.0 * random.unit() - 1.0);
                let (seen, met) = (EyeRow::new(eye, pigments), Met::new(light));
                let found = table.by_path_around((&table.entries, &around), &seen, &met, turn);
                let expected = table.by_path(&seen, &met, turn, 0.0);
                for (found, expected) in found.into_iter().zip(expected) {
                    // Equal to the bit at a level of the table.
                    let most = if number == 0 { 0.0 } else { 1e-5 * expected.max_element() };
                    assert!((found - expected).abs().max_element() <= most, "{found} {expected}");
                }
            }
        }
    }
}
