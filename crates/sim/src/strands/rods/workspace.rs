//! Scratch of the solve of a block of strands.

use glam::Vec3;
use strandline_base::vec3x8::lanes;
use strandline_body::Pose;
use strandline_groom::{LANES, Lanes, Vec3Lanes};
use wide::f32x8;

use super::avx::Avx;
use super::lengths::Lengths;
use super::pull::Pull;
use super::real::{Real, Vector};
use super::rod::{Node, Solved, StepSettings, Work};
use super::rounds::{Push, Turned};
use crate::RodReport;

/// A rigid motion in each lane.
pub(crate) struct Carry {
    pub columns: [Vector<f32x8>; 3],
    pub translation: Vector<f32x8>,
}

impl Carry {
    pub fn new(pose: &Pose) -> Self {
        let columns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| Vector::splat(pose.direction(axis)));
        Self { columns, translation: Vector::splat(pose.translation) }
    }

    /// A motion for each lane.
    pub fn of_lanes(poses: &[Pose; LANES]) -> Self {
        let columns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| lanes(poses.map(|pose| pose.direction(axis))));
        Self { columns, translation: lanes(poses.map(|pose| pose.translation)) }
    }

    #[inline(always)]
    pub fn direction(&self, vector: Vector<f32x8>) -> Vector<f32x8> {
        self.columns[0] * vector.x + self.columns[1] * vector.y + self.columns[2] * vector.z
    }

    #[inline(always)]
    pub fn point(&self, point: Vector<f32x8>) -> Vector<f32x8> {
        self.direction(point) + self.translation
    }
}

/// Scratch of a thread.
#[derive(Clone)]
pub(crate) struct Workspace {
    pub points: Vec<Vector<f32x8>>,
    pub velocities: Vec<Vector<f32x8>>,
    pub sections: Vec<Vector<f32x8>>,
    pub spins: Vec<f32x8>,
    /// The shape that the head carried along: where a part begins.
    pub carried: Vec<Vector<f32x8>>,
    /// Motion of the points under forces alone from there.
    pub wanted: Vec<Vector<f32x8>>,
    /// Motion at their velocity from there.
    pub coast: Vec<Vector<f32x8>>,
    pub pulls: Vec<Pull<f32x8>>,
    /// Forces \[N\] that solids which press hard hold of the points; zero for strands without.
    pub loads: Vec<Vector<f32x8>>,
    /// Above 0 for strands that have any.
    pub loaded: f32x8,
    pub margins: Vec<f32x8>,
    /// Parts of the positions that rounding left out \[m\].
    pub remainders: Vec<Vector<f32x8>>,
    /// Displacement of the points from there \[m\], with the remainders.
    pub moved: Vec<Vector<f32x8>>,
    pub inverse_mass: Vec<f32x8>,
    pub length: Vec<f32x8>,
    /// Share of the length before each point.
    pub share: Vec<f32x8>,
    /// Lanes of which a number is not finite.
    pub bad: f32x8,
    pub report: RodReport,
    pub work: Work<f32x8>,
    /// Forces \[N\] of a round where there is no AVX, shape `[point]`.
    forces: Vec<Vector<f32x8>>,
    avx: Option<Avx>,
    pub project: Lengths<f32x8>,
}

impl Workspace {
    pub fn new(points: usize) -> Self {
        let (zero, none) = (Vector::zero(), f32x8::of(0.0));
        Self {
            points: vec![zero; points],
            velocities: vec![zero; points],
            sections: vec![zero; points],
            spins: vec![none; points],
            carried: vec![zero; points],
            wanted: vec![zero; points],
            coast: vec![zero; points],
            pulls: Vec::with_capacity(4 * points),
            loads: vec![zero; points],
            loaded: none,
            margins: vec![none; points],
            remainders: vec![zero; points],
            moved: vec![zero; points],
            inverse_mass: vec![none; points],
            length: vec![none; points],
            share: vec![none; points],
            bad: none,
            report: RodReport::default(),
            work: Work::new(points),
            forces: Vec::new(),
            avx: Avx::new(points),
            project: Lengths::new(points),
        }
    }

    /// An implicit Euler step of the rods, in the way that is the fastest here: bits are the same.
    pub fn solve(&mut self, rod: &[Node<f32x8>], settings: &StepSettings<f32x8>) -> Solved<f32x8> {
        self.set_loaded();
        let solved = match &mut self.avx {
            Some(avx) => avx.solve(&mut self.work, rod, &mut self.pulls, settings),
            None => self.work.solve(rod, &mut self.pulls, settings),
        };
        if self.take_loads() {
            self.forget_tensions(self.loaded);
        }
        solved
    }

    /// Sets the tensions \[N\] with which a step among other strands begins; none where there are none.
    pub fn set_tensions(&mut self, tensions: &[Lanes]) {
        for point in 0..self.points.len() {
            let tension = tensions.get(point).map_or(f32x8::of(-0.0), |lanes| f32x8::new(lanes.0));
            match &mut self.avx {
                Some(avx) => avx.set_tension(point, tension),
                None => self.work.tensions[point] = tension,
            }
        }
    }

    /// Forgets those of the strands whose `meets` is not above 0.
    pub fn forget_tensions(&mut self, meets: f32x8) {
        let none = f32x8::of(-0.0);
        for point in 0..self.points.len() {
            match &mut self.avx {
                Some(avx) => avx.set_tension(point, meets.choose(avx.tension(point), none)),
                None => self.work.tensions[point] = meets.choose(self.work.tensions[point], none),
            }
        }
    }

    /// Writes them.
    pub fn store_tensions(&self, tensions: &mut [Lanes]) {
        for (point, lanes) in tensions.iter_mut().enumerate() {
            let tension = self.avx.as_ref().map_or(self.work.tensions[point], |avx| avx.tension(point));
            let finite = tension.to_array().map(|tension| if tension.is_finite() { tension } else { 0.0 });
            *lanes = Lanes(finite);
        }
    }

    /// Begins a step among other strands, in the fastest way here.
    pub fn prepare(&mut self, rod: &[Node<f32x8>], viscous: f32x8) {
        match &mut self.avx {
            Some(avx) => avx.prepare(&mut self.work, rod, &self.pulls, viscous),
            None => self.work.prepare(rod, viscous),
        }
        self.set_loaded();
    }

    /// A Newton step of it.
    pub fn push(
        &mut self,
        rod: &[Node<f32x8>],
        pushes: &[Push<f32x8>],
        settings: &StepSettings<f32x8>,
        first: bool,
        [open, meets]: [f32x8; 2],
    ) -> Turned<f32x8> {
        match &mut self.avx {
            Some(avx) => avx.push(&mut self.work, pushes, settings, first, [open, meets]),
            None => self.work.push(rod, (&mut self.pulls, pushes), settings, first, (open, meets)),
        }
    }

    /// Sets the displacements \[m\] that the next round holds; without, those of the Newton step.
    pub fn set_held(&mut self, held: &[Vector<f32x8>]) {
        match &mut self.avx {
            Some(avx) => avx.set_held(held),
            None => self.work.held.copy_from_slice(held),
        }
    }

    /// A round: adds to the ways of points \[m\] how the factors of that step answer forces \[N\].
    pub fn round(
        &mut self,
        rod: &[Node<f32x8>],
        (pushes, forces): (&[Push<f32x8>], &[Vec3Lanes]),
        whole: f32x8,
        ways: &mut [Vec3Lanes],
    ) {
        match &mut self.avx {
            Some(avx) => avx.round(forces, whole, ways),
            None => {
                self.forces.clear();
                self.forces.extend(forces.iter().map(Vector::load));
                self.work.round(rod, pushes, &self.forces, whole);
                for (way, step) in ways.iter_mut().zip(&self.work.held) {
                    (Vector::load(way) + *step).store(way);
                }
            }
        }
    }

    /// Takes the displacements of the rounds.
    pub fn settle(&mut self, open: f32x8) {
        match &mut self.avx {
            Some(avx) => avx.settle(open),
            None => self.work.settle(open),
        }
    }

    /// Gives `work` what steps among other strands have moved.
    pub fn give(&mut self) {
        if let Some(avx) = &self.avx {
            avx.give(&mut self.work, &mut self.pulls);
        }
        self.take_loads();
    }

    fn set_loaded(&mut self) {
        match &mut self.avx {
            Some(avx) => avx.set_loaded(self.loaded),
            None => self.work.loaded = self.loaded,
        }
    }

    /// Takes over the forces of solids on strands that they press hard; one without any is not loaded any more. True if there was
    /// a loaded one.
    fn take_loads(&mut self) -> bool {
        let loaded = self.avx.as_ref().map_or(self.work.loaded, Avx::loaded);
        if !self.loaded.or_more(loaded).any_positive() {
            return false;
        }
        self.loads.fill(Vector::zero());
        let mut held = f32x8::ZERO;
        for pull in self.pulls.iter().filter(|pull| pull.one_sided) {
            let force = pull.load * pull.stiffness;
            self.loads[pull.node] = force;
            held = held.fast_max(force.x.abs().fast_max(force.y.abs()).fast_max(force.z.abs()));
        }
        self.loaded = held.choose(loaded, f32x8::ZERO);
        true
    }

    /// Sets the forces \[N\] with which a step begins of the strands with a bit in `lanes`.
    pub fn set_loads(&mut self, lanes: u8, tensions: &[Lanes], forces: &[Vec3Lanes]) {
        if lanes == 0 && !self.loaded.any_positive() {
            return;
        }
        self.loaded = f32x8::from(std::array::from_fn::<f32, LANES, _>(|lane| f32::from(lanes >> lane & 1)));
        for (load, force) in self.loads.iter_mut().zip(forces) {
            *load = Vector::choose(self.loaded, Vector::load(force), Vector::zero());
        }
        self.set_tensions(if lanes == 0 { &[] } else { tensions });
        self.forget_tensions(self.loaded);
    }

    /// Writes them, and returns the strands that have any.
    pub fn store_loads(&self, lanes: u8, tensions: &mut [Lanes], forces: &mut [Vec3Lanes]) -> u8 {
        let loaded = self.loaded.simd_gt(f32x8::ZERO).to_bitmask() as u8;
        if lanes | loaded != 0 {
            for (load, force) in self.loads.iter().zip(forces) {
                load.store(force);
            }
            self.store_tensions(tensions);
        }
        loaded
    }

    pub fn load(
        &mut self,
        start: &[Vec3Lanes],
        velocities: &[Vec3Lanes],
        sections: &[Vec3Lanes],
        spins: &[Lanes],
    ) {
        for point in 0..start.len() {
            self.points[point] = Vector::load(&start[point]);
            self.velocities[point] = Vector::load(&velocities[point]);
            self.sections[point] = Vector::load(&sections[point]);
            self.spins[point] = f32x8::new(spins[point].0);
        }
    }

    /// Reads the remainders from the additions of the next prediction to the velocities \[m/s\].
    pub fn load_remainders(&mut self, corrections: &[Vec3Lanes], time_step: f32) {
        for (remainder, correction) in self.remainders.iter_mut().zip(corrections) {
            *remainder = Vector::load(correction) * f32x8::splat(time_step);
        }
    }

    /// Writes the remainders likewise.
    pub fn store_remainders(&self, corrections: &mut [Vec3Lanes], time_step: f32) {
        for (remainder, correction) in self.remainders.iter().zip(corrections) {
            (*remainder * f32x8::splat(1.0 / time_step)).store(correction);
        }
    }

    /// Motion of a point since the part began \[m\].
    #[inline(always)]
    pub fn way(&self, point: usize) -> Vector<f32x8> {
        self.moved[point] - self.remainders[point] + (self.carried[point] - self.points[point])
    }

    pub fn store(
        &self,
        predicted: &mut [Vec3Lanes],
        velocities: &mut [Vec3Lanes],
        sections: &mut [Vec3Lanes],
        spins: &mut [Lanes],
    ) {
        for point in 0..predicted.len() {
            self.points[point].store(&mut predicted[point]);
            self.velocities[point].store(&mut velocities[point]);
            self.sections[point].store(&mut sections[point]);
            spins[point] = Lanes(self.spins[point].to_array());
        }
    }
}
