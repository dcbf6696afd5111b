//! The README's code is that of examples/hello.rs, which is compiled and run with the other examples.

use strandline::{Hair, Scene};

#[test]
fn the_readme_shows_the_example() {
    let readme = include_str!("../../../../README.md");
    let shown = readme.split("```rust\n").nth(1).unwrap().split("```").next().unwrap().trim();
    let example = include_str!("../../../../examples/hello.rs");
    let begin = example.find("use strandline").unwrap();
    let end = example.find("\nfn main").unwrap();
    assert_eq!(shown, example[begin..end].replace("fn hello", "fn main").trim());
}

#[test]
fn hair_is_opened_on_the_devices_that_a_file_names() {
    let open = |text: &str| {
        let scene = Scene::parse(&format!("style.strand_count = 8\n{text}"), "scene.toml").unwrap();
        Hair::open(&scene).map(drop)
    };
    open("devices = { simulation = \"cpu\", pictures = \"cpu\" }").unwrap();
    // No machine has so many.
    for key in ["simulation", "pictures"] {
        assert!(open(&format!("devices = {{ {key} = \"gpu:999\" }}")).is_err(), "{key}");
    }
}
