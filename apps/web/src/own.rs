//! Settings of the page over those of the scene.

use glam::Vec3;
use strandline::{Light, math, scene::hex_color};

/// Settings of the page over those of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Own {
    /// Angles of the lights and of the camera about the head \[degrees\].
    pub light: f32,
    pub view: f32,
    /// Colour of the lights, linear RGB.
    pub color: Vec3,
}

impl Own {
    pub const OFF: Self = Self { light: 0.0, view: 0.0, color: Vec3::ONE };

    /// Takes a setting of the page; false for another key.
    pub fn take(&mut self, key: &str, value: &str) -> Result<bool, String> {
        let wrong = |expected: &str| format!("{key}: found `{value}`, expected {expected}");
        let angle = || {
            let angle = value.parse().ok().filter(|angle: &f32| angle.abs() <= 360.0);
            angle.ok_or_else(|| wrong("degrees from -360 to 360"))
        };
        match key {
            "page.light" => self.light = angle()?,
            "page.view" => self.view = angle()?,
            "page.color" => {
                self.color = hex_color(value).ok_or_else(|| wrong("a colour as #rrggbb"))?.into();
            }
            _ if key.starts_with("page.") => {
                return Err(format!("{key}: expected page.light, page.view or page.color"));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Lights, turned about the vertical through their target and coloured.
    pub fn over(self, mut lights: Vec<Light>) -> Vec<Light> {
        let turn = math::rotation(Vec3::Y, self.light.to_radians());
        for light in &mut lights {
            light.position = light.target + turn * (light.position - light.target);
            light.color *= self.color;
        }
        lights
    }
}
