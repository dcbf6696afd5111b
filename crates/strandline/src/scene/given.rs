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
            _ => return,
        };
        *given = true;
    }
}
