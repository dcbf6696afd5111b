/// Which settings a scene file gives that a groom would else choose. Scenes are the same whether a file gave what
/// they say or not.
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
