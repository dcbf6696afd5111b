//! The README's code is that of examples/hello.rs, which is compiled and run with the other examples.

#[test]
fn the_readme_shows_the_example() {
    let readme = include_str!("../../../README.md");
    let shown = readme.split("```rust\n").nth(1).unwrap().split("```").next().unwrap().trim();
    let example = include_str!("../../../examples/hello.rs");
    let begin = example.find("use strandline").unwrap();
    let end = example.find("\nfn main").unwrap();
    assert_eq!(shown, example[begin..end].replace("fn hello", "fn main").trim());
}
