//! Settings that a page refuses, and those that only a new load takes in.

use strandline::Scene;

/// Most strands that a page simulates, and that it grows in all: more would keep a visitor waiting for minutes.
const MOST_SIMULATED: usize = 20_000;
const MOST_GROWN: usize = 200_000;

/// Refuses more strands than a page moves or grows in time.
pub(crate) fn check_strands(scene: &Scene) -> Result<(), String> {
    let counts = [
        ("style.strand_count", Some(scene.style.strand_count), MOST_SIMULATED),
        ("groom.guides", scene.groom.guides.map(|count| count as usize), MOST_SIMULATED),
        ("groom.bound", scene.groom.bound.map(|count| count as usize), MOST_GROWN),
    ];
    for (key, count, most) in counts {
        if let Some(found) = count.filter(|count| *count > most) {
            return Err(format!("{key}: found {found}, expected {most} at most in a page"));
        }
    }
    Ok(())
}

/// True for a setting that only a new load takes in.
pub(crate) fn is_loaded(key: &str) -> bool {
    let section = key.split(['.', '[']).next().unwrap_or_default();
    let is_live =
        ["look", "body_look", "level_of_detail", "picture", "wind", "motion", "simulation", "lights"];
    let of_load = [
        "motion.neck",
        "motion.file",
        "look.color_map",
        "look.width_map",
        "look.group",
        "simulation.strands",
    ];
    let is_of_springs = key.starts_with("simulation.strands.constrain");
    let is_loaded = of_load.iter().any(|start| key.starts_with(start)) && !is_of_springs;
    !is_live.contains(&section) && key != "groom.length" || is_loaded
}
