//! `strandline gpus` and `strandline shaders`: the adapters, and the programs that run on them.

use strandline::{
    Error,
    device::{Gpu, shader_modules},
    file::WholeFile,
};

use crate::arguments::ShaderOptions;
use crate::output::print_line;

/// Lists the adapters.
pub fn list() -> anyhow::Result<()> {
    let adapters = Gpu::list();
    for adapter in &adapters {
        print_line!("{adapter}");
    }
    if cfg!(not(feature = "gpu")) {
        print_line!("this build is without GPUs: everything runs on the CPU");
    } else if adapters.is_empty() {
        print_line!("no GPU: a Vulkan, Metal or Direct3D 12 driver is needed; everything runs on the CPU");
    } else if adapters.iter().all(|adapter| adapter.software) {
        print_line!("software only: `--backend auto` takes the CPU, which is many times faster");
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
    let modules = shader_modules();
    for (name, text) in &modules {
        let path = folder.join(name).with_extension("wgsl");
        WholeFile::save(&path, text.as_bytes()).map_err(failed(&path))?;
    }
    print_line!("wrote {} shader modules to {}", modules.len(), folder.display());
    Ok(())
}
