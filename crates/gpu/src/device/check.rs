//! Holds a kernel's declaration to the shader that was linked: names, offsets, sizes, access.

use wgpu::naga::{
    AddressSpace, ArraySize, Handle, ImageClass, Module, ScalarKind, ShaderStage, StorageAccess,
    StorageFormat, StructMember, Type, TypeInner, VectorSize,
    front::wgsl,
    valid::{Capabilities, ValidationFlags, Validator},
};

use crate::{Access, Binding, Declaration, Layout, Tail};

/// Compares a declaration with its linked shader, without a device. Returns the differences; nothing
/// when the two agree.
pub fn check(declaration: &Declaration) -> Vec<String> {
    let named = |message: String| format!("{}::{}: {message}", declaration.module, declaration.entry);
    problems(declaration).into_iter().map(named).collect()
}

fn problems(declaration: &Declaration) -> Vec<String> {
    let module = match wgsl::parse_str(declaration.source) {
        Ok(module) => module,
        Err(error) => return vec![error.emit_to_string(declaration.source)],
    };
    // Packing half floats is part of WebGPU; naga counts it apart for older devices.
    let capabilities = Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    let info = match validator.validate(&module) {
        Ok(info) => info,
        Err(error) => return vec![error.emit_to_string(declaration.source)],
    };
    let wanted = entries(declaration);
    let mut used = Vec::new();
    for (stage, name) in wanted {
        let found = module.entry_points.iter().position(|entry| entry.name == name && entry.stage == stage);
        match found {
            Some(entry) => used.push(info.get_entry_point(entry)),
            None => return vec!["there is no such entry point".to_owned()],
        }
    }
    let mut problems = threads(&module, declaration);
    let mut found = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(binding) = &variable.binding else { continue };
        if used.iter().all(|entry| entry[handle].is_empty()) {
            continue;
        }
        let name = variable.name.as_deref().unwrap_or_default();
        found.push(binding.binding);
        if binding.group != 0 {
            problems.push(format!("{name} is in group {}, expected 0", binding.group));
        }
        match declaration.bindings.iter().find(|declared| declared.index == binding.binding) {
            None => problems.push(format!("{name} at {} is not declared", binding.binding)),
            Some(declared) => {
                compare_variable(&module, declared, name, variable.space, variable.ty, &mut problems);
            }
        }
    }
    for declared in &declaration.bindings {
        if !found.contains(&declared.index) {
            problems.push(format!("{} at {} is not used by the shader", declared.name, declared.index));
        }
    }
    let storage = declaration.bindings.iter().filter(|binding| is_buffer(binding.access)).count();
    let most = wgpu::Limits::default().max_storage_buffers_per_shader_stage as usize;
    if storage > most {
        problems.push(format!("{storage} storage buffers, at most {most} are portable"));
    }
    problems
}

fn is_buffer(access: Access) -> bool {
    matches!(access, Access::Read | Access::ReadWrite)
}

/// The stages of a pipeline and their entry points.
fn entries(declaration: &Declaration) -> Vec<(ShaderStage, &'static str)> {
    if !declaration.draws {
        return vec![(ShaderStage::Compute, declaration.entry)];
    }
    let fragment = declaration.fragment.map(|entry| (ShaderStage::Fragment, entry));
    std::iter::once((ShaderStage::Vertex, declaration.entry)).chain(fragment).collect()
}

/// Differences between the declared workgroups and the shader's.
fn threads(module: &Module, declaration: &Declaration) -> Vec<String> {
    if declaration.draws {
        return Vec::new();
    }
    let of_entry = module.entry_points.iter().find(|entry| entry.name == declaration.entry);
    let Some(entry) = of_entry else { return Vec::new() };
    let is_chosen = entry.workgroup_size_overrides.is_some();
    let [x, y, z] = entry.workgroup_size;
    match declaration.threads {
        None if !is_chosen => vec![format!("workgroups of {x} threads, declared as chosen by a constant")],
        Some(declared) if is_chosen => {
            vec![format!("a constant chooses the threads of workgroups, declared {declared}")]
        }
        Some(declared) if [x as usize, y as usize, z as usize] != [declared, 1, 1] => {
            vec![format!("workgroups of {x} x {y} x {z} threads, declared {declared}")]
        }
        None | Some(_) => Vec::new(),
    }
}

fn compare_variable(
    module: &Module,
    declared: &Binding,
    name: &str,
    space: AddressSpace,
    ty: Handle<Type>,
    problems: &mut Vec<String>,
) {
    if !is_named(name, declared.name) {
        problems.push(format!("{name} at {} is declared as {}", declared.index, declared.name));
    }
    let inner = &module.types[ty].inner;
    let access = match space {
        AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => Some(Access::ReadWrite),
        AddressSpace::Storage { .. } => Some(Access::Read),
        AddressSpace::Handle => match inner {
            TypeInner::Image { class: ImageClass::Storage { .. }, .. } => Some(Access::Written),
            _ => Some(Access::Texture),
        },
        _ => None,
    };
    if access != Some(declared.access) {
        problems.push(format!("{} is {access:?}, declared {:?}", declared.name, declared.access));
    }
    let element = match inner {
        TypeInner::Array { base, stride, .. } => {
            let size = size_of_layout(&declared.layout);
            if *stride as usize != size {
                problems.push(format!("{}: elements of {stride} bytes, declared {size}", declared.name));
            }
            *base
        }
        TypeInner::Image { class: ImageClass::Sampled { kind, multi: false }, .. } => {
            let Layout::Scalar(scalar) = declared.layout else {
                problems.push(format!("{} is a texture, declared {:?}", declared.name, declared.layout));
                return;
            };
            return compare_scalar(scalar, *kind, declared.name, problems);
        }
        TypeInner::Image { class: ImageClass::Storage { format, access }, .. } => {
            if (*format, *access) != (StorageFormat::Rgba16Float, StorageAccess::STORE) {
                problems.push(format!("{} is {format:?}, {access:?}", declared.name));
            }
            return;
        }
        TypeInner::Struct { .. } => ty,
        other => {
            problems.push(format!("{} is {other:?}, which is neither an array nor a struct", declared.name));
            return;
        }
    };
    compare_type(module, &declared.layout, element, declared.name, problems);
}

/// True if a name is the declared one. The linker puts the names of modules before those of imported items,
/// joined by underscores. A part that has underscores itself starts with their number, as in
/// `package_shadow__1body_depths`.
fn is_named(found: &str, declared: &str) -> bool {
    if found == declared {
        return true;
    }
    let own = match declared.matches('_').count() {
        0 => format!("_{declared}"),
        count => format!("__{count}{declared}"),
    };
    let Some(modules) = found.strip_prefix("package").and_then(|rest| rest.strip_suffix(&own)) else {
        return false;
    };
    // The end of a longer name is not the name: its part would lack some of its underscores.
    let part = modules.rsplit("__").next().unwrap_or_default();
    let (digits, _) = part.split_at(part.find(|c: char| !c.is_ascii_digit()).unwrap_or(part.len()));
    modules.is_empty() || digits.parse().map_or(true, |count: usize| part.matches('_').count() >= count)
}

fn size_of_layout(layout: &Layout) -> usize {
    match layout {
        Layout::Scalar(_) => 4,
        Layout::Vector { count, .. } => 4 * count,
        Layout::Array { element, count } => size_of_layout(element) * count,
        Layout::Struct { size, .. } => *size,
    }
}

fn compare_type(module: &Module, layout: &Layout, ty: Handle<Type>, path: &str, problems: &mut Vec<String>) {
    let found = &module.types[ty];
    match (layout, &found.inner) {
        (Layout::Scalar(scalar), TypeInner::Scalar(kind) | TypeInner::Atomic(kind)) => {
            compare_scalar(scalar, kind.kind, path, problems);
        }
        (Layout::Vector { scalar, count }, TypeInner::Vector { size, scalar: kind }) => {
            compare_scalar(scalar, kind.kind, path, problems);
            let lanes = match size {
                VectorSize::Bi => 2,
                VectorSize::Tri => 3,
                VectorSize::Quad => 4,
            };
            if lanes != *count {
                problems.push(format!("{path} has {lanes} components, declared {count}"));
            }
        }
        (Layout::Array { element, count }, TypeInner::Array { base, size, stride }) => {
            let found = if let ArraySize::Constant(found) = size { found.get() as usize } else { 0 };
            if found != *count {
                problems.push(format!("{path} has {found} elements, declared {count}"));
            }
            let bytes = size_of_layout(element);
            if *stride as usize != bytes {
                problems.push(format!("{path}: elements of {stride} bytes, declared {bytes}"));
            }
            compare_type(module, element, *base, path, problems);
        }
        (Layout::Struct { name, size, fields, tail }, TypeInner::Struct { members, span }) => {
            let called = found.name.as_deref().unwrap_or_default();
            if !is_named(called, name) {
                problems.push(format!("{path} is a {called}, declared {name}"));
            }
            let last = members.last().filter(|last| is_unsized(module, last.ty));
            let bytes = last.map_or(*span, |last| last.offset);
            if bytes as usize != *size {
                problems.push(format!("{path} has {bytes} bytes, declared {size}"));
            }
            let members = &members[..members.len() - usize::from(last.is_some())];
            if members.len() != fields.len() {
                problems.push(format!("{path} has {} fields, declared {}", members.len(), fields.len()));
            }
            compare_tail(module, tail.as_deref(), last, path, problems);
            for (member, field) in members.iter().zip(fields) {
                let path = format!("{path}.{}", field.name);
                if member.name.as_deref() != Some(field.name) {
                    let found = member.name.as_deref().unwrap_or_default();
                    problems.push(format!("{path} is called {found} in the shader"));
                }
                if member.offset as usize != field.offset {
                    problems.push(format!("{path} is at {}, declared {}", member.offset, field.offset));
                }
                compare_type(module, &field.layout, member.ty, &path, problems);
            }
        }
        (declared, found) => problems.push(format!("{path} is {found:?}, declared {declared:?}")),
    }
}

fn is_unsized(module: &Module, ty: Handle<Type>) -> bool {
    matches!(module.types[ty].inner, TypeInner::Array { size: ArraySize::Dynamic, .. })
}

/// Compares the tail of a struct with the shader's array without a length.
fn compare_tail(
    module: &Module,
    declared: Option<&Tail>,
    found: Option<&StructMember>,
    path: &str,
    problems: &mut Vec<String>,
) {
    let (declared, found) = match (declared, found) {
        (None, None) => return,
        (Some(declared), Some(found)) => (declared, found),
        (declared, found) => {
            let name = |of: Option<&str>| of.unwrap_or("nothing").to_owned();
            let found = name(found.and_then(|found| found.name.as_deref()));
            problems
                .push(format!("{path} ends in {found}, declared {}", name(declared.map(|tail| tail.name))));
            return;
        }
    };
    let path = format!("{path}.{}", declared.name);
    if found.name.as_deref() != Some(declared.name) {
        problems
            .push(format!("{path} is called {} in the shader", found.name.as_deref().unwrap_or_default()));
    }
    let TypeInner::Array { base, stride, .. } = module.types[found.ty].inner else { return };
    let size = size_of_layout(&declared.layout);
    if stride as usize != size {
        problems.push(format!("{path}: elements of {stride} bytes, declared {size}"));
    }
    compare_type(module, &declared.layout, base, &path, problems);
}

fn compare_scalar(declared: &str, found: ScalarKind, path: &str, problems: &mut Vec<String>) {
    let expected = match found {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        _ => "another",
    };
    if declared != expected {
        problems.push(format!("{path} is {expected}, declared {declared}"));
    }
}

#[cfg(test)]
mod tests {
    use super::is_named;

    #[test]
    fn names_of_modules_stand_before_names() {
        for found in ["body_depths", "package_shadow__1body_depths", "package__1opacity_depth__1body_depths"]
        {
            assert!(is_named(found, "body_depths"), "{found}");
            assert!(!is_named(found, "depths"), "{found}");
        }
        assert!(is_named("package_strands_points", "points"));
        assert!(is_named("package__1opacity_depth_maps", "maps"));
        assert!(!is_named("endpoints", "points") && !is_named("package_strands_endpoints", "points"));
    }
}
