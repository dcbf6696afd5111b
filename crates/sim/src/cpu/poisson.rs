//! The Poisson system of the pressure, compressed to the cells that hold hair.

use crate::cells::Kind;

/// No unknown: points at the zero behind the last one.
const NONE: u32 = u32::MAX;

/// Seven-point Laplacian with free surfaces (air, pressure 0) and walls (solid, no flow)
/// [Chen2011 eq. 21-24, Bridson2008]. Unknowns are the fluid cells in ascending order.
///
/// A row says: (neighbours that are not solid) times the pressure, less the pressures of the fluid
/// neighbours. Vectors hold one more entry than there are unknowns, and it is always 0.
#[derive(Clone, Debug, Default)]
pub struct Poisson {
    /// Neighbours that are not solid, shape `[unknown]`.
    pub diagonal: Vec<f32>,
    /// Unknowns before along x, y and z, or the zero, shape `[unknown][axis]`.
    pub lower: Vec<[u32; 3]>,
    /// Unknowns behind along x, y and z, or the zero, shape `[unknown][axis]`.
    pub upper: Vec<[u32; 3]>,
    /// Cells with no way to a free surface, as groups of unknowns.
    pub enclosed: Vec<Vec<u32>>,
    unknown_of_cell: Vec<u32>,
    cells: Vec<u32>,
}

impl Poisson {
    /// Sets the system up for `fluid` cells, ascending, among cells whose neighbours along the axes
    /// lie `strides` apart. Every fluid cell must have neighbours on all sides in `kinds`.
    pub fn assemble(&mut self, fluid: &[u32], kinds: &[Kind], strides: [usize; 3]) {
        self.unknown_of_cell.resize(kinds.len(), NONE);
        for &cell in &self.cells {
            self.unknown_of_cell[cell as usize] = NONE;
        }
        self.cells.clear();
        self.cells.extend_from_slice(fluid);
        for (unknown, &cell) in fluid.iter().enumerate() {
            self.unknown_of_cell[cell as usize] = unknown as u32;
        }
        let zero = fluid.len() as u32;
        let unknown = |cell: usize| self.unknown_of_cell[cell].min(zero);
        self.diagonal.clear();
        self.lower.clear();
        self.upper.clear();
        for &cell in fluid {
            let cell = cell as usize;
            let around = strides.iter().flat_map(|stride| [cell - stride, cell + stride]);
            self.diagonal.push(around.filter(|cell| kinds[*cell] != Kind::Solid).count() as f32);
            self.lower.push(strides.map(|stride| unknown(cell - stride)));
            self.upper.push(strides.map(|stride| unknown(cell + stride)));
        }
        self.find_enclosed();
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// True without unknowns.
    pub fn is_empty(&self) -> bool {
        self.diagonal.is_empty()
    }

    fn neighbours(&self, unknown: usize) -> impl Iterator<Item = usize> + '_ {
        let count = self.len();
        let all = self.lower[unknown].into_iter().chain(self.upper[unknown]);
        all.map(|other| other as usize).filter(move |other| *other < count)
    }

    /// Groups the unknowns that no chain of fluid cells joins to air: there the pressure is known
    /// up to a constant only.
    fn find_enclosed(&mut self) {
        let count = self.len();
        let around = |unknown: usize| {
            self.lower[unknown].iter().chain(&self.upper[unknown]).map(|other| *other as usize)
        };
        let is_open = |unknown: usize| self.diagonal[unknown] > self.neighbours(unknown).count() as f32;
        // The zero behind the last unknown is never reached.
        let mut reached: Vec<bool> = (0..count).map(is_open).chain([false]).collect();
        // Once there and once back reach nearly all.
        for unknown in (0..count).chain((0..count).rev()) {
            reached[unknown] |= around(unknown).fold(false, |any, other| any | reached[other]);
        }
        let leads_on =
            |unknown: &usize| reached[*unknown] && self.neighbours(*unknown).any(|other| !reached[other]);
        let mut waiting: Vec<usize> = (0..count).filter(leads_on).collect();
        self.spread(&mut waiting, &mut reached);
        self.enclosed.clear();
        for unknown in 0..count {
            if !reached[unknown] {
                reached[unknown] = true;
                let mut waiting = vec![unknown];
                let mut group = self.spread(&mut waiting, &mut reached);
                group.sort_unstable();
                self.enclosed.push(group.into_iter().map(|unknown| unknown as u32).collect());
            }
        }
    }

    /// Reaches everything that is joined to what waits; returns it all.
    fn spread(&self, waiting: &mut Vec<usize>, reached: &mut [bool]) -> Vec<usize> {
        let mut group = Vec::new();
        while let Some(unknown) = waiting.pop() {
            group.push(unknown);
            for other in self.neighbours(unknown) {
                if !std::mem::replace(&mut reached[other], true) {
                    waiting.push(other);
                }
            }
        }
        group
    }

    /// Takes the mean out of a right-hand side where the pressure is known up to a constant only:
    /// what flows into a closed room must flow out of it.
    pub fn make_compatible(&self, right: &mut [f32]) {
        for group in &self.enclosed {
            let sum: f64 = group.iter().map(|&unknown| f64::from(right[unknown as usize])).sum();
            let mean = (sum / group.len() as f64) as f32;
            group.iter().for_each(|&unknown| right[unknown as usize] -= mean);
        }
    }

    /// Multiplies: `out` = A `vector`.
    pub fn multiply(&self, vector: &[f32], out: &mut [f32]) {
        let rows = self.diagonal.iter().zip(&self.lower).zip(&self.upper).zip(vector).zip(out);
        for ((((diagonal, lower), upper), here), slot) in rows {
            let below = vector[lower[0] as usize] + vector[lower[1] as usize] + vector[lower[2] as usize];
            let above = vector[upper[0] as usize] + vector[upper[1] as usize] + vector[upper[2] as usize];
            *slot = diagonal * here - below - above;
        }
    }
}
