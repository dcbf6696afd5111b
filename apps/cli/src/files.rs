//! `strandline groom`, `info` and `scene`: files without motion.

use strandline::file::counted;
use strandline::mesh::{Material, MeshFormat, VertexMotion};
use strandline::{Groom, Mesh, Scene, format};

use crate::arguments::{GroomOptions, InfoOptions, SceneOptions, Set, Usage};
use crate::inputs;
use crate::output::{self, print_line};
use crate::progress::Waiting;

/// Grows a style and writes it.
pub fn groom(options: &GroomOptions) -> anyhow::Result<()> {
    let mut scene = Scene::demo();
    scene.set_style(options.style);
    scene.style.strand_count =
        options.guides.map_or(options.strands, |guides| guides.min(options.strands)) as usize;
    scene.style.seed = options.seed;
    if let Some(other) = options.values.iter().find(|value| !of_style(value)) {
        let mend =
            "strandline groom takes keys of `style`, `body.build`, `body.eyes` and `groom.points_per_strand`";
        return Err(Usage(format!("--set {other}: {mend}")).into());
    }
    if options.guides.is_none() && options.values.iter().any(|value| key(value) == "groom.points_per_strand")
    {
        let mend =
            "--guides writes hair as a scene draws it; without it strands have the points of their style";
        return Err(Usage(format!("--set groom.points_per_strand needs --guides: {mend}")).into());
    }
    Set { values: options.values.clone() }.apply(&mut scene)?;
    let waiting = Waiting::begin("growing strands");
    let mut groom = scene.grow(options.strands as usize)?;
    if options.guides.is_some() {
        // As a scene draws them.
        groom = groom.resampled(scene.groom.points_per_strand as usize)?;
    }
    drop(waiting);
    write(&groom, &options.out)
}

/// The key of a setting, `KEY=VALUE`.
fn key(setting: &str) -> &str {
    setting.split('=').next().unwrap_or_default().trim()
}

/// True for a setting of the style or of the head that it grows on, `KEY=VALUE`; not for those that have options.
fn of_style(setting: &str) -> bool {
    let key = key(setting);
    let has_option = ["style.style", "style.strand_count", "style.seed"].contains(&key);
    let of_head = ["body.build", "body.eyes", "groom.points_per_strand"].contains(&key);
    key.starts_with("style.") && !has_option || of_head
}

pub(crate) fn write(groom: &Groom, path: &std::path::Path) -> anyhow::Result<()> {
    let saved = groom.save(path)?;
    for part in saved.left_out {
        output::note(&format!("the format cannot hold {part}: left out"));
    }
    saved.notes.iter().for_each(|note| output::note(note));
    print_line!(
        "wrote {}, {} to {}",
        counted(groom.strand_count(), "strand", "strands"),
        counted(saved.points, "point", "points"),
        path.display()
    );
    Ok(())
}

/// Groups that are listed: a grown style has one for each lock.
const MOST_GROUPS: usize = 20;

/// Prints the contents of a file.
pub fn info(options: &InfoOptions) -> anyhow::Result<()> {
    let mesh_format = MeshFormat::of(&options.file).ok();
    if let Some(format @ (MeshFormat::Gltf | MeshFormat::Stl)) = mesh_format {
        return body_info(options, of_mesh(format), Mesh::load_noted(&options.file, 1.0)?, None);
    }
    let is_npz = options.file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("npz"));
    let is_mesh = mesh_format.is_some() || options.file.is_dir();
    if is_mesh && Mesh::is_sequence(&options.file) {
        return moving_info(options, Mesh::load_sequence_noted(&options.file, FRAMES_PER_SECOND)?);
    }
    let report = match (format::load(&options.file, &options.reading.options()), mesh_format) {
        (Ok(groom), _) => groom.report,
        // The formats of meshes that hold strands too.
        (Err(error), Some(format)) => match Mesh::load_noted(&options.file, 1.0) {
            Ok(body) => return body_info(options, of_mesh(format), body, None),
            Err(_) => return Err(error.into()),
        },
        // Arrays of strands, or of a body in motion.
        (Err(error), None) => {
            match is_npz.then(|| Mesh::load_sequence_noted(&options.file, FRAMES_PER_SECOND)) {
                Some(Ok(body)) => return moving_info(options, body),
                _ => return Err(error.into()),
            }
        }
    };
    if options.json {
        output::program(&format!("{}\n", serde_json::to_string(&report)?));
        return Ok(());
    }
    print_line!("{}: {}", options.file.display(), report.format);
    print_line!("strands   {}", report.strands);
    print_line!(
        "points    {} ({} to {} a strand)",
        report.points,
        report.points_per_strand.min,
        report.points_per_strand.max
    );
    let length = &report.length_m;
    print_line!("lengths   {:.4} to {:.4} m, mean {:.4} m", length.min, length.max, length.mean);
    print_line!("bounds    {:?} m", report.bounds_m);
    if !report.attributes.is_empty() {
        print_line!("has       {}", report.attributes.join(", "));
    }
    let of_kind = |named: bool| report.groups.iter().filter(move |(_, group)| group.name.is_some() == named);
    for (number, group) in of_kind(true).chain(of_kind(false)).take(MOST_GROUPS) {
        let name = group.name.as_deref().unwrap_or("without a name");
        print_line!("group     {number}: {name}, {}", counted(group.strands, "strand", "strands"));
    }
    if report.groups.len() > MOST_GROUPS {
        let more = counted(report.groups.len() - MOST_GROUPS, "group", "groups");
        print_line!("          and {more} more (--json has all)");
    }
    for problem in &report.problems {
        print_line!("problem   {problem}");
    }
    Ok(())
}

/// Rate of frames without times, that of `body.frames_per_second`.
const FRAMES_PER_SECOND: f64 = 24.0;

/// The name of a format.
fn of_mesh(format: MeshFormat) -> &'static str {
    match format {
        MeshFormat::Gltf => "glTF",
        MeshFormat::Obj => ".obj mesh",
        MeshFormat::Ply => ".ply mesh",
        MeshFormat::Stl => ".stl mesh",
    }
}

/// Prints the contents of a body in motion.
fn moving_info(
    options: &InfoOptions,
    (mesh, motion, notes): (Mesh, VertexMotion, Vec<String>),
) -> anyhow::Result<()> {
    body_info(options, "mesh in motion", (mesh, notes), Some([motion.begin(), motion.end()]))
}

/// Prints the contents of a body: its size, its materials, its clips, and the times \[s\] of its first and last frame where it has
/// frames.
fn body_info(
    options: &InfoOptions,
    name: &str,
    (mesh, notes): (Mesh, Vec<String>),
    motion: Option<[f64; 2]>,
) -> anyhow::Result<()> {
    let has_clips = MeshFormat::of(&options.file).is_ok_and(|format| format == MeshFormat::Gltf);
    let clips = if has_clips { Mesh::clip_names(&options.file)? } else { Vec::new() };
    let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
    let materials = mesh.materials.as_deref().cloned().unwrap_or_default();
    let size = |material: &Material| {
        let texture = material.texture.and_then(|texture| materials.textures.get(texture));
        texture.map(|texture| [texture.width, texture.height])
    };
    if options.json {
        let material = |material: &Material| {
            serde_json::json!({
                "name": material.name,
                "color": material.color.map(|color| color.to_array()),
                "texture": size(material),
                "cutoff": material.cutoff,
                "roughness": material.roughness,
                "metallic": material.metallic,
            })
        };
        let object = serde_json::json!({
            "file": options.file.display().to_string(),
            "vertices": vertices,
            "triangles": triangles,
            "materials": materials.list.iter().map(material).collect::<Vec<_>>(),
            "clips": clips,
            "motion_s": motion,
            "notes": notes,
        });
        output::program(&format!("{object}\n"));
        return Ok(());
    }
    print_line!("{}: {name}", options.file.display());
    print_line!("vertices  {vertices}");
    print_line!("triangles {triangles}");
    for material in &materials.list {
        print_line!("material  {}", described(material, size(material)));
    }
    if let Some([begin, end]) = motion {
        print_line!("motion    {begin:.3} to {end:.3} s");
    }
    for clip in clips {
        print_line!("clip      {clip}");
    }
    for note in notes {
        print_line!("note      {note}");
    }
    Ok(())
}

/// A material with the size of its texture, human-readable.
fn described(material: &Material, texture: Option<[u32; 2]>) -> String {
    let name = material.name.as_deref().unwrap_or("without a name");
    let color = match (material.color, texture) {
        (_, Some([width, height])) => format!("texture of {width} x {height}"),
        (Some(color), None) => format!("color {:.2} {:.2} {:.2}", color.x, color.y, color.z),
        (None, None) => "no color of its own".to_owned(),
    };
    let roughness = material.roughness.map(|roughness| format!(", roughness {roughness:.2}"));
    let metallic = (material.metallic > 0.0).then(|| format!(", metallic {:.2}", material.metallic));
    let cutoff = material.cutoff.map(|cutoff| format!(", cut below alpha {cutoff:.2}"));
    let more = [roughness, metallic, cutoff].into_iter().flatten();
    format!("{name}: {color}{}", more.collect::<String>())
}

/// Prints a scene with every key.
pub fn scene(options: &SceneOptions) -> anyhow::Result<()> {
    let mut scene = inputs::scene(&options.scene)?;
    options.set.apply(&mut scene)?;
    output::program(&scene.to_toml());
    Ok(())
}
