//! Elementary functions with the same bits on every system.
//!
//! Functions of the standard library are the system's: glibc chooses among several by the processor, and other
//! systems round otherwise. These are those of the crate `libm`, plain Rust, off by at most about one unit in
//! the last place. The square root is exact everywhere and stays the standard library's, as do sums, products,
//! `floor` and the like. clippy refuses the others in every crate under `crates` (`crates/clippy.toml`), and
//! the rotations of glam that are made of them.

use glam::{Quat, Vec2, Vec3};

/// Numbers that have these functions: [`f32`] and [`f64`].
pub trait Float: sealed::Sealed {}

impl Float for f32 {}
impl Float for f64 {}

macro_rules! functions {
    ($($(#[$document:meta])* $name:ident($($more:ident)?) = $single:ident, $double:ident;)*) => {
        mod sealed {
            /// The functions, in a module so that they are not taken for methods of the standard library.
            pub trait Sealed: Sized {
                $(fn $name(self $(, $more: Self)?) -> Self;)*
            }

            impl Sealed for f32 {
                $(#[inline]
                fn $name(self $(, $more: Self)?) -> Self {
                    libm::$single(self $(, $more)?)
                })*
            }

            impl Sealed for f64 {
                $(#[inline]
                fn $name(self $(, $more: Self)?) -> Self {
                    libm::$double(self $(, $more)?)
                })*
            }
        }

        $($(#[$document])*
        #[inline]
        pub fn $name<R: Float>(x: R $(, $more: R)?) -> R {
            sealed::Sealed::$name(x $(, $more)?)
        })*
    };
}

functions! {
    /// The sine of an angle \[rad\].
    sin() = sinf, sin;
    /// The cosine of an angle \[rad\].
    cos() = cosf, cos;
    /// The tangent of an angle \[rad\].
    tan() = tanf, tan;
    /// The angle \[rad\] of a sine, NaN outside -1..1.
    asin() = asinf, asin;
    /// The angle \[rad\] of a cosine, NaN outside -1..1.
    acos() = acosf, acos;
    /// The angle \[rad\] at which the point (`adjacent`, `x`) lies, -pi..pi.
    atan2(adjacent) = atan2f, atan2;
    /// e to the power of x.
    exp() = expf, exp;
    /// 2 to the power of x.
    exp2() = exp2f, exp2;
    /// e to the power of x, less 1; exact for small x.
    exp_m1() = expm1f, expm1;
    /// The logarithm to base e.
    ln() = logf, log;
    /// The logarithm to base 2.
    log2() = log2f, log2;
    /// The logarithm to base 10.
    log10() = log10f, log10;
    /// The hyperbolic sine.
    sinh() = sinhf, sinh;
    /// The cube root.
    cbrt() = cbrtf, cbrt;
    /// x to a power.
    powf(exponent) = powf, pow;
}

/// Sine and cosine of an angle \[rad\].
#[inline]
pub fn sin_cos<R: Float + Copy>(x: R) -> (R, R) {
    (sin(x), cos(x))
}

/// The unit vector at an angle \[rad\] from the first axis toward the second.
pub fn unit_at(angle: f32) -> Vec2 {
    Vec2::new(cos(angle), sin(angle))
}

/// The rotation by an angle \[rad\] about an axis of length 1.
pub fn rotation(axis: Vec3, angle: f32) -> Quat {
    let (sine, cosine) = sin_cos(0.5 * angle);
    Quat::from_vec4((axis * sine).extend(cosine))
}

/// A rotation from pitch (about x), yaw (about y) and roll (about z) \[degrees\], the roll first.
pub fn pitch_yaw_roll(degrees: Vec3) -> Quat {
    let [pitch, yaw, roll] = degrees.to_array().map(f32::to_radians);
    rotation(Vec3::Y, yaw) * rotation(Vec3::X, pitch) * rotation(Vec3::Z, roll)
}

/// The rotation on the shorter path between two; `share` is 0 at the first and 1 at the second.
pub fn slerp(from: Quat, to: Quat, share: f32) -> Quat {
    let (cosine, to) = match from.dot(to) {
        cosine if cosine < 0.0 => (-cosine, -to),
        cosine => (cosine, to),
    };
    // For small angles the sine is dominated by rounding.
    if cosine > 0.9995 {
        return (from * (1.0 - share) + to * share).normalize();
    }
    let angle = acos(cosine);
    (from * sin((1.0 - share) * angle) + to * sin(share * angle)) * (1.0 / sin(angle))
}

#[cfg(test)]
mod tests {
    use glam::EulerRot;

    use super::*;

    /// Arguments of all sizes, both signs.
    fn arguments() -> impl Iterator<Item = f32> {
        (0..4000).map(|index| {
            let size = 1e-4 * 1.004_f32.powi(index % 2000 * 2);
            if index % 2 == 0 { size.min(80.0) } else { -size.min(80.0) }
        })
    }

    /// Distance of a result from the exact one, in units in the last place.
    fn units(found: f32, exact: f64) -> f64 {
        let unit = f64::from(f32::EPSILON) * 2.0_f64.powi(exact.abs().max(1e-37).log2().floor() as i32);
        if found.is_nan() && exact.is_nan() { 0.0 } else { (f64::from(found) - exact).abs() / unit }
    }

    #[test]
    fn results_are_those_of_double_precision_to_about_one_unit() {
        type Pair = (&'static str, fn(f32) -> f32, fn(f64) -> f64);
        let pairs: [Pair; 14] = [
            ("sin", sin, f64::sin),
            ("cos", cos, f64::cos),
            ("tan", tan, f64::tan),
            ("asin", asin, f64::asin),
            ("acos", acos, f64::acos),
            ("exp", exp, f64::exp),
            ("exp2", exp2, f64::exp2),
            ("exp_m1", exp_m1, f64::exp_m1),
            ("ln", ln, f64::ln),
            ("log2", log2, f64::log2),
            ("log10", log10, f64::log10),
            ("sinh", sinh, f64::sinh),
            ("cbrt", cbrt, f64::cbrt),
            ("powf", |x| powf(x.abs(), 2.4), |x| x.abs().powf(f64::from(2.4_f32))),
        ];
        for (name, single, double) in pairs {
            for x in arguments() {
                let off = units(single(x), double(f64::from(x)));
                // The hyperbolic sine is made of two of the others.
                let most = if name == "sinh" { 1.6 } else { 1.1 };
                assert!(off < most, "{name}({x}): {off} units");
                let (own, other) = (double(f64::from(x)), f64::from(single(x)));
                assert_eq!(own.is_nan(), other.is_nan(), "{name}({x})");
            }
        }
        for (x, y) in arguments().zip(arguments().skip(7)) {
            assert!(units(atan2(x, y), f64::from(x).atan2(f64::from(y))) < 1.1, "atan2({x}, {y})");
        }
    }

    /// The purpose of this module: the bits are the same on every system. A new version of `libm` may change
    /// them, and with them those of every simulation.
    #[test]
    fn the_bits_are_known() {
        let mut sum = 0xcbf2_9ce4_8422_2325_u64;
        for x in arguments() {
            let size = x.abs();
            let one = [sin(x), cos(x), tan(x), exp(x), exp2(x), exp_m1(x), ln(size), log2(size), cbrt(x)];
            let more = [sinh(x), powf(size, 1.3), atan2(x, 0.7), asin(x / 80.0), acos(x / 80.0)];
            let x = f64::from(x);
            let two = [sin(x), cos(x), exp(x), ln(x.abs()), atan2(x, 0.7), powf(x.abs(), 0.7)];
            let single = one.into_iter().chain(more).map(|result| u64::from(result.to_bits()));
            for bits in single.chain(two.map(f64::to_bits)) {
                sum = (sum ^ bits).wrapping_mul(0x0100_0000_01b3);
            }
        }
        assert_eq!(sum, 0x8212_e641_ebe3_0d7d);
    }

    #[test]
    fn rotations_are_those_of_glam() {
        let near = |found: Quat, wanted: Quat| found.dot(wanted).abs() > 1.0 - 1e-6;
        for x in arguments().map(|x| x % 3.0) {
            let axis = Vec3::new(0.36, 0.48, -0.8);
            assert!(near(rotation(axis, x), Quat::from_axis_angle(axis, x)));
            assert!(unit_at(x).distance(Vec2::from_angle(x)) < 1e-6);
            let degrees = Vec3::new(30.0 * x, 50.0 - x, 11.0 * x);
            let [pitch, yaw, roll] = degrees.to_array().map(f32::to_radians);
            assert!(near(pitch_yaw_roll(degrees), Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll)));
            let (from, to) = (rotation(Vec3::Y, 0.3), rotation(axis, x));
            for share in [0.0, 0.3, 1.0] {
                assert!(near(slerp(from, to, share), from.slerp(to, share)));
            }
        }
    }
}
