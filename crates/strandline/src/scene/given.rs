use super::Scene;

/// Settings that a scene file gives, among those that would otherwise be chosen to fit the groom. Comparisons of scenes
/// ignore it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Given {
    pub follow_strands: bool,
    pub hair_count: bool,
    pub width_scale: bool,
    pub root_radius: bool,
    pub tip_radius: bool,
    pub wave_amplitude: bool,
    pub points_per_strand: bool,
    pub segments_per_span: bool,
    pub spacing: bool,
    pub full_distance: bool,
    pub body_color: bool,
    pub body_materials: bool,
}

impl PartialEq for Given {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Given {
    /// Notes that a setting was given.
    pub fn note(&mut self, key: &str) {
        let given = match key {
            "look.follow_strands" => &mut self.follow_strands,
            "look.hair_count" => &mut self.hair_count,
            "look.width_scale" => &mut self.width_scale,
            "look.clump.root_radius" => &mut self.root_radius,
            "look.clump.tip_radius" => &mut self.tip_radius,
            "look.clump.wave_amplitude" => &mut self.wave_amplitude,
            "groom.points_per_strand" => &mut self.points_per_strand,
            "level_of_detail.segments_per_span" => &mut self.segments_per_span,
            "level_of_detail.full_distance" => &mut self.full_distance,
            "body.spacing" => &mut self.spacing,
            "body_look.color" => &mut self.body_color,
            "body_look.materials" => &mut self.body_materials,
            _ => return,
        };
        *given = true;
    }
}

impl Scene {
    /// Draws the body of a file in a colour that is given, instead of in its own ones, unless these are asked for. The
    /// mannequin's skin takes the colour as it is.
    pub(crate) fn choose_body_colors(&mut self) {
        let Given { body_color, body_materials, .. } = self.given;
        self.body_look.materials &= !body_color || body_materials || self.body.file.is_none();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_that_is_given_stands_for_those_of_the_body() {
        let chosen = |text: &str, set: &[[&str; 2]]| {
            let mut scene = Scene::parse(text, "a test").unwrap();
            scene.body.file = Some("body.obj".into());
            set.iter().for_each(|[key, value]| scene.set(key, value).unwrap());
            scene.choose_body_colors();
            scene.body_look.materials
        };
        assert!(chosen("", &[]) && chosen("[body_look]\nwrap = 0.1", &[]));
        assert!(!chosen("[body_look]\ncolor = \"#804020\"", &[]));
        assert!(chosen("[body_look]\ncolor = \"#804020\"\nmaterials = true", &[]));
        assert!(!chosen("[body_look]\nmaterials = false", &[]));
        assert!(!chosen("", &[["body_look.color", "[0.5, 0.4, 0.3]"]]));
        let both = [["body_look.color", "[0.5, 0.4, 0.3]"], ["body_look.materials", "true"]];
        assert!(chosen("", &both));
    }
}
