//! Constants of the Chebyshev preconditioner, for both backends.

/// Steps of the polynomial, each but the first a product with the matrix. On hair of the thesis two halve the
/// iterations of the diagonal for an eighth more products; more steps save nothing further.
pub const CHEBYSHEV_STEPS: usize = 2;
/// Least and greatest eigenvalue of the scaled matrix that the polynomial is made for. None is above 2 (Gershgorin);
/// below the least one it stays positive, only less helpful.
pub const CHEBYSHEV_LEAST: f32 = 0.1;
pub const CHEBYSHEV_MOST: f32 = 2.0;
