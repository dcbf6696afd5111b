//! The pressure system against closed forms, and the counts of its solver.
//!
//! On the CPU, whose solver takes any right-hand side; parity holds the kernels to the same pressures
//! and counts.

use std::f64::consts::PI;

use strandline_sim::cells::Kind;
use strandline_sim::cpu::pcg::{Pcg, PcgSettings, Solution};
use strandline_sim::cpu::poisson::Poisson;
use strandline_sim::{Preconditioner, PressureReport};

/// A cube of cells inside a ring of air or walls; cell (i, j, k) has its middle at (i + 1/2) / side.
struct Domain {
    side: usize,
    kinds: Vec<Kind>,
    fluid: Vec<u32>,
    system: Poisson,
}

impl Domain {
    fn new(side: usize, ring: Kind, inside: impl Fn([f64; 3]) -> Kind) -> Self {
        let size = side + 2;
        let mut kinds = vec![ring; size * size * size];
        let mut fluid = Vec::new();
        for (cell, kind) in kinds.iter_mut().enumerate() {
            let place = [cell % size, cell / size % size, cell / size / size];
            if place.iter().all(|along| (1..=side).contains(along)) {
                *kind = inside(place.map(|along| (along as f64 - 0.5) / side as f64));
                if *kind == Kind::Fluid {
                    fluid.push(cell as u32);
                }
            }
        }
        let mut system = Poisson::default();
        system.assemble(&fluid, &kinds, [1, size, size * size]);
        Self { side, kinds, fluid, system }
    }

    fn middle(&self, cell: u32) -> [f64; 3] {
        let (cell, size) = (cell as usize, self.side + 2);
        [cell % size, cell / size % size, cell / size / size]
            .map(|along| (along as f64 - 0.5) / self.side as f64)
    }

    fn solve(
        &self,
        right: Vec<f32>,
        preconditioner: Preconditioner,
        tolerance: f32,
    ) -> (Vec<f32>, PressureReport) {
        let settings = PcgSettings { preconditioner, tolerance, max_iterations: 2000 };
        let mut solution = Solution { right, ..Solution::default() };
        let report = Pcg::default().solve(&self.system, &settings, &mut solution);
        (solution.values, report)
    }
}

/// A stream of numbers in -1..1.
fn noise(count: usize, seed: u64) -> Vec<f32> {
    let mut random = strandline_body::Random::new(seed, 0);
    (0..count).map(|_| 2.0 * random.unit() - 1.0).collect()
}

/// Amplitude of the discrete solution over the exact one, and the largest error at cell middles,
/// for p = cos pi x cos pi y cos pi z in a closed box.
fn closed_box(side: usize, wavelengths: f64) -> (f64, f64) {
    let domain = Domain::new(side, Kind::Solid, |_| Kind::Fluid);
    let exact = |at: [f64; 3]| at.iter().map(|along| (wavelengths * PI * along).cos()).product::<f64>();
    let spacing = 1.0 / side as f64;
    let right = domain
        .fluid
        .iter()
        .map(|&cell| (3.0 * PI * PI * spacing * spacing * exact(domain.middle(cell))) as f32);
    let (found, report) = domain.solve(right.collect(), Preconditioner::Mic0, 3e-6);
    assert!(report.relative_residual <= 3e-6, "{report:?}");
    // In a closed box the pressure is known up to a constant.
    let unknowns = domain.fluid.len();
    let mean = found[..unknowns].iter().map(|value| f64::from(*value)).sum::<f64>() / unknowns as f64;
    let (mut product, mut square, mut worst) = (0.0, 0.0, 0.0_f64);
    for (unknown, &cell) in domain.fluid.iter().enumerate() {
        let (wanted, value) = (exact(domain.middle(cell)), f64::from(found[unknown]) - mean);
        product += wanted * value;
        square += wanted * wanted;
        worst = worst.max((value - wanted).abs());
    }
    (product / square, worst)
}

/// Rows of poisson_mms_neumann.csv: cells, amplitude, largest error.
const CLOSED: [(usize, f64, f64); 3] = [
    (8, 1.012_950_746_7, 0.012_218_464),
    (16, 1.003_218_964_4, 0.003_172_687_4),
    (32, 1.000_803_577_7, 0.000_800_677_3),
];

#[test]
fn the_closed_box_has_its_discrete_solution_and_order_two() {
    let mut errors = Vec::new();
    for (side, amplitude, error) in CLOSED {
        let (found, worst) = closed_box(side, 1.0);
        // Single precision: the solver stops at 3e-6 of the first residual.
        assert!((found - amplitude).abs() < 1e-4, "{side}: amplitude {found}, expected {amplitude}");
        assert!((worst - error).abs() < 2e-4, "{side}: error {worst}, expected {error}");
        errors.push(worst);
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.9..=2.1).contains(&order), "order {order}");
    }
}

#[test]
fn a_wrong_wave_is_noticed() {
    let (found, _) = closed_box(16, 2.0);
    assert!((found - CLOSED[1].1).abs() > 1e-2, "twice the wave number has another amplitude: {found}");
}

/// Iterations on a box with air around, random right-hand side, to 1e-5 in the maximum norm.
fn box_iterations(side: usize, preconditioner: Preconditioner) -> usize {
    let domain = Domain::new(side, Kind::Air, |_| Kind::Fluid);
    domain.solve(noise(domain.fluid.len(), 3), preconditioner, 1e-5).1.iterations
}

#[test]
fn a_box_takes_the_known_number_of_iterations() {
    // pcg_iterations.csv, box_dirichlet, white, linf; 15 % for another random right-hand side.
    for (side, preconditioner, expected) in [
        (16, Preconditioner::None, 45.0),
        (16, Preconditioner::Jacobi, 45.0),
        (16, Preconditioner::Mic0, 11.0),
        (32, Preconditioner::Jacobi, 84.0),
        (32, Preconditioner::Mic0, 15.0),
    ] {
        let found = box_iterations(side, preconditioner) as f64;
        // A count of 11 cannot be held to less than one.
        assert!((found - expected).abs() <= (0.15 * expected).max(1.0), "{side} {preconditioner:?}: {found}");
    }
    assert!(box_iterations(32, Preconditioner::None) > 20, "no preconditioner is not MIC(0)");
}

/// Air around a shell of hair around a solid ball, in a unit box.
fn hair_shell(side: usize) -> Domain {
    Domain::new(side, Kind::Air, |at| {
        let radius = at.iter().map(|along| (along - 0.5).powi(2)).sum::<f64>().sqrt();
        match radius {
            0.0..0.22 => Kind::Solid,
            0.22..0.38 => Kind::Fluid,
            _ => Kind::Air,
        }
    })
}

#[test]
fn on_a_shell_of_hair_mic0_needs_a_third_of_jacobis_iterations() {
    // pcg_iterations.csv: 27 against 9 and 46 against 12 iterations on shells of 804 and 5,592 cells.
    // That shell is given by radius and thickness alone; ours holds 808 and 6,096 cells, so only
    // the ratio is compared, as a mean of several right-hand sides: counts are whole numbers.
    const SOLVES: u64 = 8;
    for side in [16, 32] {
        let shell = hair_shell(side);
        assert!(shell.kinds.contains(&Kind::Solid) && shell.system.enclosed.is_empty());
        let count = |preconditioner| {
            let right = |seed| noise(shell.fluid.len(), seed);
            let solves = (0..SOLVES).map(|seed| shell.solve(right(seed), preconditioner, 1e-5).1.iterations);
            solves.sum::<usize>() as f64 / SOLVES as f64
        };
        let (jacobi, mic0) = (count(Preconditioner::Jacobi), count(Preconditioner::Mic0));
        let ratio = jacobi / mic0;
        assert!((2.7..=3.9).contains(&ratio), "{side}: {jacobi} / {mic0} = {ratio}");
        let same = jacobi / count(Preconditioner::None);
        assert!(same < 1.5, "Jacobi against none is no such ratio: {same}");
    }
}

#[test]
fn enclosed_rooms_and_walled_in_cells_do_no_harm() {
    // A closed box whose right-hand side does not sum to zero has no solution until its mean is taken out.
    let room = Domain::new(8, Kind::Solid, |_| Kind::Fluid);
    assert_eq!(room.system.enclosed.len(), 1);
    let lone = Domain::new(3, Kind::Air, |at| if at == [0.5; 3] { Kind::Fluid } else { Kind::Solid });
    for domain in [room, lone] {
        for preconditioner in [Preconditioner::Mic0, Preconditioner::Jacobi, Preconditioner::None] {
            let (found, report) = domain.solve(vec![1.0; domain.fluid.len()], preconditioner, 1e-5);
            assert!(found.iter().all(|value| value.is_finite() && value.abs() < 1e-3), "{report:?}");
        }
    }
    let nothing = Domain::new(2, Kind::Air, |_| Kind::Air);
    assert_eq!(nothing.solve(Vec::new(), Preconditioner::Mic0, 1e-5).1.iterations, 0);
}
