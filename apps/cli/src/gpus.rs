//! `strandline gpus` and `strandline shaders`: what there is to simulate on, and what runs there.

use strandline::{Error, gpu::Gpu, render, sim};

use crate::arguments::ShaderOptions;

/// Lists the adapters.
pub fn list() -> anyhow::Result<()> {
    let adapters = Gpu::list();
    for adapter in &adapters {
        println!("{adapter}");
    }
    if adapters.is_empty() {
        println!("no GPU: a Vulkan, Metal or Direct3D 12 driver is needed; everything runs on the CPU");
    } else if adapters.iter().all(|adapter| adapter.software) {
        println!("software only: `--backend auto` takes the CPU, which is many times faster");
    }
    Ok(())
}

/// Writes the linked shader modules.
pub fn shaders(options: &ShaderOptions) -> anyhow::Result<()> {
    let folder = &options.folder;
    let failed = |path: &std::path::Path| {
        let path = path.to_owned();
        move |source| Error::Write { what: "the shader modules", path, source }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let modules: Vec<_> = sim::gpu::modules().into_iter().chain(render::gpu::modules()).collect();
    for (name, text) in &modules {
        let path = folder.join(name).with_extension("wgsl");
        std::fs::write(&path, text).map_err(failed(&path))?;
    }
    println!("wrote {} shader modules to {}", modules.len(), folder.display());
    Ok(())
}
