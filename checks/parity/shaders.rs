//! Kernels against their shaders, without an adapter.

use strandline_gpu::{Access, Declaration, Field, Layout, Scan, Tail, check};
use strandline_render::gpu as render;
use strandline_sim::gpu as sim;

fn declarations() -> Vec<Declaration> {
    let all = [sim::declarations(), render::declarations(), Scan::declarations().to_vec()];
    all.into_iter().flatten().collect()
}

fn declaration(entry: &str) -> Declaration {
    declarations().into_iter().find(|declaration| declaration.entry == entry).unwrap()
}

fn complaints(declaration: &Declaration) -> String {
    check(declaration).join("\n")
}

#[test]
fn every_kernel_agrees_with_its_shader() {
    for declaration in declarations() {
        assert_eq!(complaints(&declaration), "", "{}", declaration.entry);
    }
}

#[test]
fn every_entry_point_has_a_kernel() {
    let all = declarations();
    let known: Vec<&str> = all.iter().flat_map(|one| [Some(one.entry), one.fragment]).flatten().collect();
    for (module, text) in sim::modules().into_iter().chain(render::modules()) {
        let entries: Vec<&str> = ["@compute", "@vertex", "@fragment"]
            .into_iter()
            .flat_map(|stage| text.split(stage).skip(1))
            .map(|rest| rest.split("fn ").nth(1).unwrap().split('(').next().unwrap())
            .collect();
        assert!(!entries.is_empty(), "{module} has no entry point");
        for entry in entries {
            assert!(known.contains(&entry), "{module}::{entry} has no kernel");
        }
    }
}

#[test]
fn a_renamed_field_is_found() {
    let mut wrong = declaration("integrate");
    let Layout::Struct { fields, .. } = &mut wrong.bindings[0].layout else { panic!("the step is a struct") };
    fields[5] = Field { name: "timestep", ..fields[5].clone() };
    let found = complaints(&wrong);
    assert!(found.contains("integrate::integrate: step.timestep is called"), "{found}");
}

#[test]
fn a_moved_field_and_a_wrong_size_are_found() {
    let mut wrong = declaration("integrate");
    let Layout::Struct { fields, size, .. } = &mut wrong.bindings[0].layout else { panic!("a struct") };
    fields[6].offset += 4;
    *size += 16;
    let found = complaints(&wrong);
    assert!(found.contains("step.time_step is at"), "{found}");
    assert!(found.contains("bytes, declared"), "{found}");
}

#[test]
fn a_wrong_access_name_number_or_type_is_found() {
    let mut wrong = declaration("gather");
    wrong.bindings[2].access = Access::ReadWrite;
    assert!(complaints(&wrong).contains("predicted is Some(Read), declared ReadWrite"));

    let mut wrong = declaration("gather");
    wrong.bindings[3].name = "speeds";
    assert!(complaints(&wrong).contains("velocities at 3 is declared as speeds"));

    // The end of a name is not the name.
    let mut wrong = declaration("pose_roots");
    wrong.bindings[1].name = "positions";
    assert!(complaints(&wrong).contains("rest_positions at 2 is declared as positions"));

    let mut wrong = declaration("gather");
    wrong.bindings[4].index = 9;
    let found = complaints(&wrong);
    assert!(found.contains("faces at 4 is not declared") && found.contains("at 9 is not used"), "{found}");

    let mut wrong = declaration("gather");
    wrong.bindings[4].layout = Layout::Scalar("u32");
    let found = complaints(&wrong);
    assert!(found.contains("elements of 8 bytes, declared 4"), "{found}");
}

#[test]
fn other_workgroups_are_found() {
    let wrong = Declaration { threads: Some(128), ..declaration("gather") };
    assert!(complaints(&wrong).contains("workgroups of 64 x 1 x 1 threads, declared 128"));
    let wrong = Declaration { threads: None, ..declaration("gather") };
    assert!(complaints(&wrong).contains("workgroups of 64 threads, declared as chosen by a constant"));
    let wrong = Declaration { threads: Some(64), ..declaration("constrain") };
    assert!(complaints(&wrong).contains("a constant chooses the threads of workgroups, declared 64"));
}

#[test]
fn another_tail_is_found() {
    let with_tail = |entry, change: fn(&mut Option<Box<Tail>>)| {
        let mut wrong = declaration(entry);
        let Layout::Struct { tail, .. } = &mut wrong.bindings[0].layout else { panic!("a struct") };
        change(tail);
        complaints(&wrong)
    };
    let found = with_tail("mark", |tail| *tail = None);
    assert!(found.contains("step ends in solids, declared nothing"), "{found}");
    let found = with_tail("mark", |tail| tail.iter_mut().for_each(|tail| tail.name = "walls"));
    assert!(found.contains("step.walls is called solids"), "{found}");
    let found =
        with_tail("mark", |tail| tail.iter_mut().for_each(|tail| tail.layout = Layout::Scalar("u32")));
    assert!(found.contains("step.solids: elements of 16 bytes, declared 4"), "{found}");
}

#[test]
fn an_array_of_another_length_is_found() {
    let mut wrong = declaration("fit");
    let Layout::Struct { fields, .. } = &mut wrong.bindings[0].layout else { panic!("a struct") };
    let fitted = fields.iter_mut().find(|field| field.name == "fitted").unwrap();
    let Layout::Struct { fields, .. } = &mut fitted.layout else { panic!("a struct") };
    let windows = fields.iter_mut().find(|field| field.name == "windows").unwrap();
    let Layout::Array { count, .. } = &mut windows.layout else { panic!("an array") };
    *count += 1;
    let found = complaints(&wrong);
    assert!(found.contains("frame.fitted.windows has 16 elements, declared 17"), "{found}");
}

#[test]
fn a_missing_entry_point_and_a_broken_text_are_found() {
    let wrong = Declaration { entry: "gathers", ..declaration("gather") };
    assert!(complaints(&wrong).contains("there is no such entry point"));
    let wrong = Declaration { fragment: Some("hairs"), ..declaration("hair_vertex") };
    assert!(complaints(&wrong).contains("there is no such entry point"));
    let mut wrong = declaration("resolve_vertex");
    let samples = wrong.bindings.iter().position(|binding| binding.name == "samples").unwrap();
    wrong.bindings[samples].layout = Layout::Scalar("u32");
    assert!(complaints(&wrong).contains("samples is f32, declared u32"));
    wrong.bindings[samples].access = Access::Read;
    assert!(complaints(&wrong).contains("samples is Some(Texture), declared Read"));
    let wrong = Declaration { source: "fn broken( {", ..declaration("gather") };
    // The module and the place in it are named.
    let found = complaints(&wrong);
    assert!(found.contains("gather::gather") && found.contains("wgsl:1"), "{found}");
}
