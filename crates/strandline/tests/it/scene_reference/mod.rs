//! docs/scene.md is what the settings table says, its example is a scene, and every limit that it names
//! holds.

mod inputs;
mod limits;
mod page;

use std::path::Path;

use strandline::{
    Backend, Scene, Style,
    settings::{StrandMethod, StyleSettings},
};

/// docs/scene.md as it is; recorded again with STRANDLINE_BLESS=1, as `cargo xtask docs` does.
fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene.md");
    if std::env::var_os("STRANDLINE_BLESS").is_some_and(|bless| bless == "1") {
        std::fs::write(&path, page::written()).unwrap();
    }
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn the_page_is_what_the_table_says() {
    let (found, expected) = (page(), page::written());
    let first = found.lines().zip(expected.lines()).find(|(found, expected)| found != expected);
    assert!(found == expected, "docs/scene.md differs: run `cargo xtask docs`; first at {first:?}");
}

#[test]
fn the_example_is_a_scene() {
    let page = page();
    let example = page.split("```toml").nth(1).unwrap().split("```").next().unwrap();
    let scene = Scene::parse(example, "example").unwrap();
    assert_eq!(scene.style, StyleSettings { strand_count: 1500, ..StyleSettings::new(Style::Wavy) });
}

#[test]
fn scenes_survive_the_way_through_toml() {
    for mut scene in [Scene::demo(), Scene::thesis()] {
        assert_eq!(Scene::parse(&scene.to_toml(), "scene").unwrap(), scene);
        scene.groom.file = Some("a.hair".into());
        assert_eq!(Scene::parse(&scene.to_toml(), "scene").unwrap(), scene);
    }
}

#[test]
fn a_style_in_a_file_is_the_style_of_the_command_line() {
    for style in Style::ALL {
        let mut set = Scene::demo();
        set.set_style(style);
        let text = format!("[style]\nstyle = \"{}\"", style.name());
        assert_eq!(Scene::parse(&text, "scene").unwrap(), set);
    }
    assert_eq!(Scene::parse("", "scene").unwrap(), Scene::demo());
    let own = "style.style = \"wavy\"\nsimulation.damping = 3\ngroom.points_per_strand = 20";
    let scene = Scene::parse(own, "scene").unwrap();
    assert_eq!((scene.simulation.damping, scene.groom.points_per_strand), (3.0, 20));
    assert_eq!(scene.level_of_detail.segments_per_span, 2, "what is not said is the style's");
    let file = Scene::parse("groom.file = \"a.hair\"\nstyle.style = \"wavy\"", "scene").unwrap();
    assert_eq!(
        (file.level_of_detail.segments_per_span, file.groom.points_per_strand),
        (4, 16),
        "a file has no style"
    );
}

/// Settings that held a style before there were rods.
#[test]
fn what_rods_replace_is_refused_and_other_keys_of_older_files_are_taken() {
    let old = "[simulation.angles]\nhold = 8.0\n";
    let refused = Scene::parse(old, "old.toml").unwrap_err().to_string();
    assert!(refused.contains("simulation.angles.hold") && refused.contains("line 2"), "{refused}");
    assert!(refused.contains("simulation.strands.rods") && refused.contains("old.toml"), "{refused}");
    let alone = toml::from_str::<strandline::Settings>("angles.hold = 8").unwrap_err().to_string();
    assert!(alone.contains("simulation.strands.rods"), "{alone}");
    let old = "[simulation]\niterations = 7\nmass_per_length = 2e-6\nangles.stiffness = 30.0\n\
               springs.bend.enabled = false\nlength_pass.correction = 0.5\n";
    let scene = Scene::parse(old, "scene").unwrap();
    let constrain = scene.simulation.strands.constrain;
    assert_eq!((constrain.iterations, constrain.mass_per_length), (7, 2e-6));
    assert_eq!((constrain.angles.stiffness, constrain.length_pass.correction), (30.0, 0.5));
    assert!(!constrain.springs.bend.enabled && constrain.springs.stretch.enabled);
    assert_eq!(scene.simulation.strands.method, StrandMethod::Rods);
    assert_eq!(Scene::parse(&scene.to_toml(), "saved").unwrap(), scene, "it is saved under the new keys");
    let old = format!("{old}[look]\npreset = \"thesis\"\nsparkle = 0.1\nfirst_highlight.width = 9\n");
    let fibre = Scene::parse(&old, "scene").unwrap().look.fibre.scheuermann;
    assert_eq!((fibre.sparkle, fibre.first_highlight.width, fibre.first_highlight.shift), (0.1, 9.0, -5.0));
    let both = format!("{old}[simulation.strands.constrain]\niterations = 9\n");
    let scene = Scene::parse(&both, "scene").unwrap();
    assert_eq!(scene.simulation.strands.constrain.iterations, 9, "the new key wins");
}

/// Strands of constraints sag at first, rods begin at rest.
#[test]
fn only_hair_that_sags_settles_before_a_film() {
    let constrained = "simulation.strands.method = \"constrain\"\n";
    let settle = |text: &str| Scene::parse(text, "scene").unwrap().film.settle;
    assert_eq!((settle(""), settle(constrained)), (0.0, 1.0));
    assert_eq!(settle(&format!("{constrained}film.settle = 0.25")), 0.25);
    assert_eq!(Scene::thesis().film.settle, 1.0);
}

#[test]
fn a_part_of_a_section_leaves_the_rest_as_it_is() {
    let plain = Scene::demo();
    let text = "[simulation.strands.constrain.springs.stretch]\ndamping = 1e-7\n\
                [look.fibre.scheuermann.second_highlight]\nwidth = 12\n";
    let scene = Scene::parse(text, "scene").unwrap();
    let (springs, default) =
        (scene.simulation.strands.constrain.springs, plain.simulation.strands.constrain.springs);
    assert_eq!(springs.stretch.stiffness, default.stretch.stiffness);
    assert_eq!(springs.stretch.damping, 1e-7);
    assert_eq!((springs.bend, springs.torsion), (default.bend, default.torsion));
    assert_eq!(
        scene.look.fibre.scheuermann.second_highlight.strength,
        plain.look.fibre.scheuermann.second_highlight.strength
    );
    assert_eq!(scene.look.fibre.scheuermann.second_highlight.width, 12.0);
}

/// Scenes saved before `[devices]` have these keys.
#[test]
fn devices_of_older_files_are_taken_and_newer_ones_win() {
    let old = "simulation.backend = \"gpu:2\"\npicture.backend = \"cpu\"\n";
    let scene = Scene::parse(old, "scene").unwrap();
    assert_eq!((scene.devices.simulation, scene.devices.pictures), (Backend::Gpu(Some(2)), Backend::Cpu));
    let both = format!("{old}devices.simulation = \"cpu\"\n");
    assert_eq!(Scene::parse(&both, "scene").unwrap().devices.simulation, Backend::Cpu);
    let alone = toml::from_str::<strandline::Settings>("backend = \"cpu\"").unwrap_err().to_string();
    assert!(alone.contains("`backend` is now `devices.simulation`"), "{alone}");
    assert!(!scene.to_toml().contains("backend"));
    // A whole scene as it was saved then.
    let mut saved: toml::Table = Scene::thesis().to_toml().parse().unwrap();
    saved.remove("devices");
    for section in ["simulation", "picture"] {
        saved[section].as_table_mut().unwrap().insert("backend".into(), "auto".into());
    }
    assert_eq!(Scene::parse(&saved.to_string(), "scene").unwrap(), Scene::thesis());
}

#[test]
fn colours_and_looks_that_a_file_gives_are_meant() {
    use strandline::{
        Look,
        look::{
            ToneMap,
            fibre::{FibreModel, Pigment},
        },
    };
    let read = |text: &str| Scene::parse(text, "scene").unwrap();
    // A grown style has strands of its own between guides, and few follow strands.
    assert_eq!(read("[look]\npreset = 'red'").look, Look { follow_strands: 2, ..Look::red() });
    assert_eq!(read("").look.fibre.chiang.pigment, Pigment::Melanin);
    assert_eq!(read("[look]\ntip_color = [0.1, 0.2, 0.3]").look.fibre.chiang.pigment, Pigment::Color);
    let both = "[look]\nroot_color = [0.1, 0.2, 0.3]\n[look.fibre.chiang]\npigment = 'melanin'";
    assert_eq!(read(both).look.fibre.chiang.pigment, Pigment::Melanin);
    let thesis = read("[look]\npreset = 'thesis'\nhighlight_noise = 2.0");
    assert_eq!((thesis.look.fibre.model, thesis.look.highlight_noise), (FibreModel::Scheuermann, 2.0));
    assert_eq!((thesis.picture.tone_map, read("").picture.tone_map), (ToneMap::Filmic, ToneMap::Filmic));
    let vivid = read("[look]\npreset = 'thesis'\n[picture]\ntone_map = 'aces'");
    assert_eq!(vivid.picture.tone_map, ToneMap::Aces);
    let own = read("[look]\npreset = 'thesis'\n[picture]\ntone_map = 'off'");
    assert_eq!(own.picture.tone_map, ToneMap::Off);
}
