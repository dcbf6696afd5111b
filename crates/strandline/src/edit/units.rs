//! Numbers that a person types, with units.

/// Units of a setting, each with those that may be typed for it and how much of it each is.
const UNITS: [(&str, &[(&str, f64)]); 12] = [
    (
        "m",
        &[("km", 1e3), ("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("in", 0.0254), ("ft", 0.3048)],
    ),
    ("um", &[("um", 1.0), ("mm", 1e3), ("m", 1e6)]),
    ("degrees", &[("deg", 1.0), ("degrees", 1.0), ("rad", 180.0 / std::f64::consts::PI), ("turns", 360.0)]),
    (
        "rad",
        &[("rad", 1.0), ("deg", std::f64::consts::PI / 180.0), ("degrees", std::f64::consts::PI / 180.0)],
    ),
    ("s", &[("s", 1.0), ("ms", 1e-3), ("min", 60.0)]),
    ("1/s", &[("1/s", 1.0), ("hz", 1.0)]),
    ("m/s", &[("m/s", 1.0), ("cm/s", 1e-2), ("km/h", 1.0 / 3.6)]),
    ("m/s^2", &[("m/s^2", 1.0), ("m/s2", 1.0), ("g", 9.80665)]),
    ("kg/m^3", &[("kg/m^3", 1.0), ("kg/m3", 1.0), ("g/cm3", 1e3)]),
    ("GPa", &[("gpa", 1.0), ("mpa", 1e-3), ("kpa", 1e-6), ("pa", 1e-9)]),
    ("MB", &[("mb", 1.0), ("gb", 1e3)]),
    ("", &[("%", 1e-2)]),
];

/// A number in the unit of a setting, from a text such as `3cm`, `15 deg` or `0.03`; `None` where it is none or its unit
/// is of another kind.
pub fn quantity(text: &str, unit: &str) -> Option<f64> {
    let text = text.trim().to_lowercase().replace(['\u{b5}', '\u{3bc}'], "u").replace('\u{b0}', "deg");
    // A decimal comma, where nothing else is meant.
    let text = if text.contains('.') { text } else { text.replacen(',', ".", 1) };
    // The longest beginning that is a number: `1e3m` is a thousand metres, `1 em` none.
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]).rev();
    let (number, typed) =
        ends.filter_map(|end| Some((text[..end].trim().parse::<f64>().ok()?, text[end..].trim()))).next()?;
    if !number.is_finite() {
        return None;
    }
    if typed.is_empty() || typed == unit.to_lowercase() {
        return Some(number);
    }
    let (_, known) = UNITS.iter().find(|(own, _)| *own == unit)?;
    let (_, factor) = known.iter().find(|(name, _)| *name == typed)?;
    Some(number * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_with_units_of_their_kind() {
        let near = |text: &str, unit: &str, wanted: f64| {
            let found = quantity(text, unit).unwrap_or_else(|| panic!("{text} in {unit}"));
            assert!((found - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{text} in {unit}: {found}");
        };
        for (text, unit, wanted) in [
            ("3cm", "m", 0.03),
            ("15deg", "degrees", 15.0),
            ("15\u{b0}", "rad", 15.0_f64.to_radians()),
            ("0.5 turns", "degrees", 180.0),
            (" 2,5 mm ", "m", 0.0025),
            ("80 \u{b5}m", "m", 8e-5),
            ("1e3mm", "m", 1.0),
            ("36 km/h", "m/s", 10.0),
            ("250ms", "s", 0.25),
            ("30%", "", 0.3),
            ("-1.5", "m", -1.5),
            ("7", "stops", 7.0),
            ("7 stops", "stops", 7.0),
            ("1 g", "m/s^2", 9.80665),
        ] {
            near(text, unit, wanted);
        }
        for (text, unit) in
            [("3cm", "s"), ("cm", "m"), ("", "m"), ("3 cmm", "m"), ("nan", "m"), ("inf", "m"), ("1 m", "")]
        {
            assert_eq!(quantity(text, unit), None, "{text} in {unit}");
        }
    }
}
