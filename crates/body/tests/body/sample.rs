//! The sample bust that ships.

#[path = "../../examples/bust.rs"]
#[allow(dead_code)] // its program is not run
mod bust;

#[test]
fn the_sample_is_what_its_example_writes() {
    let kept = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/bust.glb")).unwrap();
    assert!(kept.len() < 300_000, "{} bytes", kept.len());
    assert!(
        bust::bust() == kept,
        "write it anew: cargo run -p strandline-body --example bust -- examples/bust.glb"
    );
}
