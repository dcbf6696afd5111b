//! Colours as they are written in other programs: `#rrggbb`, sRGB.

use std::borrow::Cow;

use strandline_base::{Kind, Row, Table, math};

/// Length of a colour with its mark.
const LENGTH: usize = 7;

/// Linear RGB of `#rrggbb`, sRGB; none for another text.
pub fn hex_color(text: &str) -> Option<[f32; 3]> {
    let digits = text.strip_prefix('#').filter(|_| text.len() == LENGTH)?;
    let mut color = [0.0; 3];
    for (place, value) in color.iter_mut().enumerate() {
        let byte = digits.get(2 * place..2 * place + 2).filter(|pair| !pair.starts_with('+'))?;
        *value = linear(f64::from(u8::from_str_radix(byte, 16).ok()?) / 255.0) as f32;
    }
    Some(color)
}

/// Light of a value of sRGB. // IEC 61966-2-1
fn linear(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { math::powf((value + 0.055) / 1.055, 2.4) }
}

/// True for a setting that is a colour: three numbers without a unit.
pub(super) fn is_color(row: &Row) -> bool {
    row.kind == Kind::Number(3) && row.unit.is_empty()
}

/// The text of a file with three numbers in the place of each `#rrggbb` that a colour of the table is set to.
pub(super) fn spelled_out<'a>(text: &'a str, table: &'static Table) -> Cow<'a, str> {
    if !text.contains('#') {
        return Cow::Borrowed(text);
    }
    let mut names = Vec::new();
    collect(table, &mut names);
    let mut written = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("\"#").into_iter().chain(rest.find("'#")).min() {
        let (before, behind) = rest.split_at(at);
        let quote = &behind[..1];
        let color = behind.get(1..1 + LENGTH).and_then(hex_color);
        let is_closed = behind.get(1 + LENGTH..).is_some_and(|end| end.starts_with(quote));
        written.push_str(before);
        match color.filter(|_| is_closed && is_set(before, &names)) {
            Some([red, green, blue]) => {
                written.push_str(&format!("[{red}, {green}, {blue}]"));
                rest = &behind[LENGTH + 2..];
            }
            None => {
                written.push_str(&behind[..2]);
                rest = &behind[2..];
            }
        }
    }
    written.push_str(rest);
    Cow::Owned(written)
}

/// Names of all colours of a table.
fn collect(table: &'static Table, names: &mut Vec<&'static str>) {
    for row in table.rows {
        match row.kind {
            Kind::Group(table) => collect(table, names),
            Kind::List(items) => collect(items.table(), names),
            _ if is_color(row) => names.push(row.name),
            _ => {}
        }
    }
}

/// True where a text ends in `name =` for one of these names.
fn is_set(before: &str, names: &[&str]) -> bool {
    let Some(key) = before.trim_end().strip_suffix('=') else { return false };
    let key = key.trim_end();
    let is_of_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    names.iter().any(|name| key.strip_suffix(name).is_some_and(|front| !front.ends_with(is_of_name)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    #[test]
    fn a_hex_colour_is_srgb() {
        assert_eq!(hex_color("#000000"), Some([0.0; 3]));
        assert_eq!(hex_color("#FFffff"), Some([1.0; 3]));
        let [red, green, blue] = hex_color("#bc8001").unwrap();
        // 188 of 255 is half the light.
        assert!((red - 0.5029).abs() < 1e-4 && (green - 0.2159).abs() < 1e-4, "{red} {green}");
        assert!((blue - 1.0 / 255.0 / 12.92).abs() < 1e-7, "{blue}");
        for wrong in ["", "#", "#12345", "#1234567", "123456", "#12345g", "#+1+1+1", "#1234\u{e9}"] {
            assert_eq!(hex_color(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_scene_takes_them_where_a_colour_stands() {
        let text = "look.root_color = \"#bc8001\" # \"#ffffff\"\n[look]\ntip_color='#FFFFFF'\n\
                    [[lights]]\nposition = [0, 1, 2]\ncolor = \"#ff0000\"\n[body]\nfile = \"#123456\"\n";
        let text =
            text.replace("look.root_color", "[look]\nroot_color").replacen("\n[look]\ntip", "\ntip", 1);
        let scene = Scene::parse(&text, "scene").unwrap();
        assert_eq!(scene.look.root_color.to_array(), hex_color("#bc8001").unwrap());
        assert_eq!(scene.look.tip_color, glam::Vec3::ONE);
        assert_eq!(scene.lights[0].color, glam::Vec3::X);
        assert_eq!(scene.body.file.unwrap().to_str(), Some("#123456"));
        for wrong in ["[simulation]\ngravity = \"#ffffff\"", "[look]\nroot_color = \"#fffff\""] {
            assert!(Scene::parse(wrong, "scene").is_err(), "{wrong}");
        }
    }
}
