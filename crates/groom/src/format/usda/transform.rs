//! Transforms of prims, and the units and axes of a stage.

use glam::{Mat4, Quat, Vec3};
use strandline_base::math;

use super::text::{Prim, Value};

/// From the units and axes of a stage to metres, y up; a file that names none is in centimetres, as USD says.
pub(super) fn stage(stage: &Prim) -> Mat4 {
    let number = |name: &str| match stage.properties.get(name) {
        Some(Value::Numbers(numbers)) => numbers.first().copied(),
        _ => None,
    };
    let unit = number("metersPerUnit").filter(|unit| unit.is_finite() && *unit > 0.0).unwrap_or(0.01) as f32;
    let is_z = stage.properties.get("upAxis") == Some(&Value::Texts(vec!["Z".to_owned()]));
    let turn = if is_z {
        Quat::from_xyzw(-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2)
    } else {
        Quat::IDENTITY
    };
    Mat4::from_scale_rotation_translation(Vec3::splat(unit), turn, Vec3::ZERO)
}

/// The transform of a prim below its parent.
pub(super) fn local(prim: &Prim, problems: &mut Vec<String>) -> Mat4 {
    let Some(Value::Texts(order)) = prim.properties.get("xformOpOrder") else { return Mat4::IDENTITY };
    let (mut whole, known) = (Mat4::IDENTITY, problems.len());
    for name in order {
        let (name, is_inverse) = match name.strip_prefix("!invert!") {
            Some(name) => (name, true),
            None => (name.as_str(), false),
        };
        let own = prim.properties.get(name).and_then(|value| operation(name, value));
        match own {
            Some(own) if own.is_finite() => whole *= if is_inverse { own.inverse() } else { own },
            // The first of a prim stands for all.
            _ if problems.len() > known => {}
            _ => problems.push(format!("the transform `{name}` of `{}` is not applied", prim.name)),
        }
    }
    whole
}

/// A step of a transform by its name `xformOp:KIND` or `xformOp:KIND:SUFFIX`.
fn operation(name: &str, value: &Value) -> Option<Mat4> {
    let Value::Numbers(numbers) = value else { return None };
    if numbers.len() > 16 {
        return None;
    }
    let numbers: Vec<f32> = numbers.iter().map(|number| *number as f32).collect();
    let three = || <[f32; 3]>::try_from(&numbers[..]).ok().map(Vec3::from_array);
    let about = |axis: Vec3, degrees: f32| math::rotation(axis, degrees.to_radians());
    Some(match name.split(':').nth(1)? {
        "translate" => Mat4::from_translation(three()?),
        "scale" => Mat4::from_scale(three()?),
        "orient" => {
            let [w, x, y, z] = <[f32; 4]>::try_from(&numbers[..]).ok()?;
            Mat4::from_quat(Quat::from_xyzw(x, y, z, w).normalize())
        }
        // Vectors are rows in USD: their transform is the transpose.
        "transform" => Mat4::from_cols_array(&<[f32; 16]>::try_from(&numbers[..]).ok()?),
        kind => {
            let axes = kind.strip_prefix("rotate")?;
            let axis = |axis: char| [Vec3::X, Vec3::Y, Vec3::Z].get("XYZ".find(axis)?).copied();
            let turns: Option<Vec<Quat>> = match axes.len() {
                1 => Some(vec![about(axis(axes.chars().next()?)?, *numbers.first()?)]),
                3 => {
                    let degrees = three()?;
                    let turn = |letter: char| Some(about(axis(letter)?, degrees["XYZ".find(letter)?]));
                    axes.chars().map(turn).collect()
                }
                _ => None,
            };
            // The first axis turns first.
            Mat4::from_quat(turns?.into_iter().fold(Quat::IDENTITY, |whole, turn| turn * whole))
        }
    })
}

#[cfg(test)]
mod tests {
    use glam::EulerRot;

    use super::*;

    #[test]
    fn rotations_turn_about_the_first_axis_first() {
        let value = Value::Numbers(vec![30.0, 50.0, 70.0]);
        let [x, y, z] = [30.0_f32, 50.0, 70.0].map(f32::to_radians);
        for (name, order) in
            [("xformOp:rotateXYZ", EulerRot::ZYX), ("xformOp:rotateZYX:suffix", EulerRot::XYZ)]
        {
            let found = operation(name, &value).unwrap();
            let angles = if order == EulerRot::ZYX { [z, y, x] } else { [x, y, z] };
            let expected = Mat4::from_euler(order, angles[0], angles[1], angles[2]);
            assert!(found.abs_diff_eq(expected, 1e-6), "{name}");
        }
        let found = operation("xformOp:rotateY", &Value::Numbers(vec![90.0])).unwrap();
        assert!(found.transform_point3(Vec3::Z).distance(Vec3::X) < 1e-6);
        assert_eq!(operation("xformOp:rotateXQZ", &value), None);
        assert_eq!(operation("xformOp:rotateY", &Value::Numbers(vec![90.0; 17])), None);
    }
}
