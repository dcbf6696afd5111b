use super::{MotionName, Scene};

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
    pub motion_name: bool,
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
            "motion.name" => &mut self.motion_name,
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

    /// Chooses the motion of the head, beside that of a body that moves by itself.
    pub fn set_motion(&mut self, name: MotionName) {
        (self.motion.name, self.given.motion_name) = (name, true);
    }

    /// Lets the head rest under a body that moves by itself, where no motion was chosen: the default one would shake the
    /// whole body on top of its own.
    pub(crate) fn rest_under_moving_body(&mut self) {
        if !self.given.motion_name && self.motion.name == MotionName::default() {
            self.motion.name = MotionName::Still;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::with_value;

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

    #[test]
    fn a_motion_that_is_chosen_stands_beside_that_of_the_body() {
        let name = |mut scene: Scene| {
            scene.rest_under_moving_body();
            scene.motion.name
        };
        let parsed = |text: &str| Scene::parse(text, "a test").unwrap();
        let set = |scene: &mut Scene| scene.set("motion.name", "shake").unwrap();
        let with = |act: fn(&mut Scene)| {
            let mut scene = Scene::demo();
            act(&mut scene);
            scene
        };
        for (scene, expected) in [
            (Scene::demo(), MotionName::Still),
            (parsed("[motion]\nneck = true"), MotionName::Still),
            (parsed("[motion]\nname = \"shake\""), MotionName::Shake),
            (with(|scene| scene.set_motion(MotionName::Shake)), MotionName::Shake),
            (with(|scene| scene.motion.name = MotionName::Turn), MotionName::Turn),
            (with(set), MotionName::Shake),
        ] {
            assert_eq!(name(scene), expected);
        }
        let edited = |value: Option<toml::Value>| with_value(&Scene::demo(), "motion.name", value).unwrap();
        assert_eq!(name(edited(Some("shake".into()))), MotionName::Shake);
        assert_eq!(name(edited(None)), MotionName::Still);
    }
}
