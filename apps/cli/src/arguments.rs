//! Arguments of the command line.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand};
use glam::Vec3;
use strandline::{
    Backend, Style, Target, What,
    format::{Scale, Up, endings},
    scene::{MotionName, View},
    settings::rods::HairKind,
};

use crate::reading::{Reading, parse_scale, parse_up, parse_vector};
use crate::values::{
    LookChoice, formats, parse_level, parse_look, parse_rate, parse_size, parse_width, written,
};

/// Real-time hair: load or grow a groom, simulate it, draw it.
///
/// Without a command it opens the window on the demo; without a display a head of hair shakes for 4 s and
/// pictures go to out/demo.
#[derive(Debug, Parser)]
#[command(name = "strandline", version, about, long_about)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Show messages of the libraries, wgpu's above all: error, warn, info, debug or trace. RUST_LOG selects
    /// some of them (`wgpu_hal=warn`).
    #[arg(long, global = true, value_name = "LEVEL", value_parser = parse_level)]
    pub log: Option<log::LevelFilter>,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Open a window in which hair moves and everything can be changed.
    View(ViewOptions),
    /// Simulate and draw a scene: frames, a contact sheet and a video.
    Render(RenderOptions),
    /// Simulate a scene without pictures, and report quality and cost.
    Sim(SimOptions),
    /// Grow a built-in style and write it to a file.
    Groom(GroomOptions),
    /// Read a groom and write it in another format.
    Convert(ConvertOptions),
    /// Print the contents of a groom file, or of a body: its materials and clips.
    Info(InfoOptions),
    /// Print a scene as TOML, every key spelled out: a start for your own.
    Scene(SceneOptions),
    /// Measure speed: the thesis's tables, or how cost grows.
    Bench(BenchOptions),
    /// Draw the measurements of `bench thesis` or `bench view` as the thesis draws its own.
    Plot(PlotOptions),
    /// Print completions of commands and options for a shell.
    Completions(CompletionOptions),
    /// Write a manual page for each command to a folder.
    Man(ManOptions),
    /// List the GPUs of this machine.
    Gpus,
    /// Write the linked shader modules to a folder, to read.
    Shaders(ShaderOptions),
}

impl Command {
    /// True for commands that may open a GPU.
    pub fn opens_gpu(&self) -> bool {
        match self {
            Self::View(_) | Self::Render(_) | Self::Sim(_) | Self::Bench(_) | Self::Gpus => true,
            Self::Groom(_)
            | Self::Convert(_)
            | Self::Info(_)
            | Self::Scene(_)
            | Self::Shaders(_)
            | Self::Completions(_)
            | Self::Man(_)
            | Self::Plot(_) => false,
        }
    }
}

/// Settings of a scene by their keys.
#[derive(Args, Clone, Debug, Default)]
pub struct Set {
    /// Set a value of the scene, after all other options: `simulation.gravity=[0,-1.6,0]`, `motion.name=nod`,
    /// `lights[0].intensity=2`; docs/scene.md lists the keys. `strandline scene` takes it too. Given again: further
    /// values. A key alone is explained.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub values: Vec<String>,
}

/// Inputs of a run: a scene, and replacements of parts of it.
#[derive(Args, Clone, Debug)]
pub struct Inputs {
    /// demo, thesis, or a .toml file [default: demo].
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub scene: Option<String>,
    /// Grow this style: bob, long, wavy, curly, pixie, ponytail, buzz, side_swept, afro, coils, bun, braid, beard, brows or lashes.
    #[arg(long, value_name = "NAME", value_parser = Style::from_str, conflicts_with = "groom")]
    pub style: Option<Style>,
    #[arg(long, value_name = "FILE", help = format!(
        "Load strands from this {} file; given again: further strands of the same hair", endings(|_| true)
    ))]
    pub groom: Vec<PathBuf>,
    /// Points of each strand, for groom files that do not give strands.
    #[arg(long, value_name = "N", requires = "groom", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub per_strand: Option<u32>,
    /// Load the body from this .obj, .gltf, .glb, .vrm, .ply or .stl file, or a body in motion from an .npz of vertices and
    /// faces, or from .obj files: `walk%04d.obj` or a folder; given again: further meshes of the same body.
    #[arg(long, value_name = "FILE")]
    pub body: Vec<PathBuf>,
    /// Grow the style on the part of this name in the body's files: a group, an object or a material [default: the
    /// built-in scalp, brought onto the skull].
    #[arg(long, value_name = "NAME", requires = "body", conflicts_with = "groom")]
    pub scalp: Option<String>,
    /// Move the body by this clip of its glTF file, and by nothing else unless --motion says so.
    #[arg(long, value_name = "NAME")]
    pub clip: Option<String>,
    /// The axis of the groom's files that points up: auto, x, y, z, -x, -y or -z [default: the scene's, auto].
    #[arg(long, value_name = "AXIS", value_parser = parse_up, allow_hyphen_values = true)]
    pub up: Option<Up>,
    /// Metres per unit of the groom's files, or auto [default: the scene's, auto].
    #[arg(long, value_name = "F|auto", value_parser = parse_scale)]
    pub scale: Option<Scale>,
    /// Turn the groom: degrees about x, y and z, y first, then x, then z; the body stays.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub turn: Option<Vec3>,
    /// Kind of hair, how it moves and what is seen of it: fine, medium, coarse, wet or sprayed.
    #[arg(long, value_name = "NAME", value_parser = HairKind::from_str)]
    pub hair: Option<HairKind>,
    /// Colour of the hair: brown, black, blonde, red, copper, grey, white, blue, pink, violet, green, thesis, or a colour #rrggbb.
    #[arg(long, value_name = "NAME|#RRGGBB", value_parser = parse_look)]
    pub look: Option<LookChoice>,
    /// Width of drawn strands over that of the file or the style: `look.width_scale`.
    #[arg(long, value_name = "F", value_parser = parse_width)]
    pub width: Option<f32>,
    /// still, shake, nod, turn or keyframes.
    #[arg(long, value_name = "NAME", value_parser = MotionName::from_str)]
    pub motion: Option<MotionName>,
    /// Velocity of the wind [m/s], world space: x to the left of the face, y up, z to the front.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub wind: Option<Vec3>,
    /// Side that the camera looks from: front, three_quarter, side or back; hair and body fill the picture.
    #[arg(long, value_name = "NAME", value_parser = View::from_str)]
    pub view: Option<View>,
    /// Number of frames.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: Option<u32>,
    /// Frames per second of the scene's time.
    #[arg(long, value_name = "N", value_parser = parse_rate)]
    pub fps: Option<f32>,
    /// Device of simulation and pictures: auto, cpu, gpu, or gpu:0 and so on [default: the scene's, auto].
    #[arg(long, value_name = "NAME", value_parser = Backend::from_str)]
    pub backend: Option<Backend>,
    /// Device of the simulation, if it differs from that of the pictures.
    #[arg(long, value_name = "NAME", value_parser = Backend::from_str)]
    pub sim_device: Option<Backend>,
    /// Device of the pictures, if it differs from that of the simulation.
    #[arg(long, value_name = "NAME", value_parser = Backend::from_str)]
    pub render_device: Option<Backend>,
    #[command(flatten)]
    pub set: Set,
    /// Print a single JSON object to standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Debug)]
pub struct RenderOptions {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Size of a picture in pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<(u32, u32)>,
    /// Folder of the pictures [default: out/ and the scene's name], or a .png file, or an .exr file for linear light,
    /// depth, coverage, directions, motion and strands. Several frames become numbered files.
    #[arg(long, value_name = "DIR|FILE")]
    pub out: Option<PathBuf>,
    /// Turn the camera once around the hair in this number of frames, evenly; the head rests, unless --motion moves it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub turntable: Option<u32>,
    /// Draw the hair of this moving cache in place of a simulation, with its own scene unless --scene names one.
    #[arg(long, value_name = "FILE.npz")]
    pub cache: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub struct ViewOptions {
    /// A .toml scene, a groom, or an .obj, .gltf, .glb, .vrm or .stl body in place of the scene's.
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// Load files of the scene again when they change on disk.
    #[arg(long)]
    pub watch: bool,
    #[command(flatten)]
    pub inputs: Inputs,
}

#[derive(Args, Debug)]
#[command(group = clap::ArgGroup::new("written").args(["out", "resume"]).multiple(true))]
pub struct SimOptions {
    #[command(flatten)]
    pub inputs: Inputs,
    /// Write the hair as it moves: .npz (a moving cache), .usda (text USD for Blender, Houdini and Unreal), or a
    /// groom file per frame, such as out/%04d.hair.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Strands to write: guides, the simulated ones, or strands, all that pictures draw
    /// [default: guides].
    #[arg(long, value_name = "NAME", requires = "written", value_parser = What::from_str)]
    pub what: Option<What>,
    /// Write every N-th frame, from the first [default: 1].
    #[arg(long, value_name = "N", requires = "written", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub every: Option<u32>,
    /// Write frames from this number on, counted from 0; the film is simulated from its beginning [default: 0].
    #[arg(long, value_name = "N", requires = "written", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    pub from: Option<u32>,
    /// Units and axes of a .usda: any (metres, y up), unreal (centimetres, z up, groom_* attributes) or blender
    /// (metres, z up); all else stays in metres with y up [default: any].
    #[arg(long = "for", value_name = "NAME", requires = "out", value_parser = Target::from_str)]
    pub target: Option<Target>,
    /// Resume the run of this moving cache, with its own scene unless --scene names one; --frames is the
    /// length of the whole film. The result is written to it, unless --out names another file.
    #[arg(long, value_name = "FILE.npz")]
    pub resume: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub struct GroomOptions {
    /// bob, long, wavy, curly, pixie, ponytail, buzz, side_swept, afro, coils, bun, braid, beard, brows or lashes.
    #[arg(long, value_name = "NAME", value_parser = Style::from_str)]
    pub style: Style,
    /// Number of strands of hair.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(1..=8_000_000))]
    pub strands: u32,
    /// Mark so many of the strands as guides, where the format can, and grow the others between them, each with a curve
    /// of its own, as a scene draws them. Without it all strands are combed alike.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8_000_000))]
    pub guides: Option<u32>,
    /// Seed of every random choice.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    #[arg(long, value_name = "FILE", help = format!("The {} file to write", written()))]
    pub out: PathBuf,
    /// Set a value of the style or of the head that it grows on: `style.length=0.3`, `body.build=broad`,
    /// `body.eyes=closed`; docs/scene.md lists the keys. Given again: further values. A key alone is explained.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub values: Vec<String>,
}

#[derive(Args, Debug)]
#[command(after_help = formats(), override_usage = "strandline convert [OPTIONS] IN... OUT")]
pub struct ConvertOptions {
    /// The files to read, each a group of one groom, and the file to write.
    #[arg(value_name = "IN... OUT", num_args = 1.., required = true)]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: Reading,
    /// Leave out stray, dummy and tiny strands, and mend widths and colours that no hair has.
    #[arg(long)]
    pub clean: bool,
    /// Keep this number of strands, spread over the scalp and alike in shape to those left out.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8_000_000))]
    pub thin: Option<u32>,
    /// Resample every strand to this number of points.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=4096))]
    pub points: Option<u32>,
    /// Move the strands, in metres, after they are turned.
    #[arg(long = "move", value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub translation: Option<Vec3>,
    /// Push strands out of this .obj, .gltf, .glb, .vrm, .ply or .stl mesh, after they are moved; their lengths stay.
    #[arg(long, value_name = "MESH")]
    pub outside: Option<PathBuf>,
    /// Metres per unit of that mesh, or auto: the unit that brings it to the roots.
    #[arg(long, value_name = "F|auto", default_value = "auto", value_parser = parse_scale)]
    pub mesh_scale: Scale,
}

#[derive(Args, Debug)]
#[command(after_help = formats())]
pub struct InfoOptions {
    /// The groom to read, or a body: .gltf, .glb, .vrm or .stl, .obj or .ply with faces and without strands.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub reading: Reading,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Debug)]
pub struct SceneOptions {
    /// demo, thesis, or a .toml file.
    #[arg(value_name = "NAME|FILE.toml", default_value = "demo")]
    pub scene: String,
    #[command(flatten)]
    pub set: Set,
}

#[derive(Args, Debug)]
pub struct CompletionOptions {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}

#[derive(Args, Debug)]
pub struct ManOptions {
    /// The folder to write to.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[derive(Args, Debug)]
pub struct ShaderOptions {
    /// The folder to write to.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[derive(Args, Debug)]
pub struct BenchOptions {
    /// The measurement.
    #[arg(value_enum, default_value = "thesis")]
    pub what: Bench,
    /// GPU that is measured beside the CPU: auto (a hardware one if there is one), cpu (none), gpu,
    /// or gpu:0 and so on.
    #[arg(long, value_name = "NAME", default_value = "auto", value_parser = Backend::from_str)]
    pub backend: Backend,
    /// A short run that shows that everything works; its figures mean little.
    #[arg(long)]
    pub quick: bool,
    /// A groom whose first picture `groom` waits for too.
    #[arg(long, value_name = "FILE")]
    pub groom: Option<PathBuf>,
    /// The body that goes with it.
    #[arg(long, value_name = "FILE", requires = "groom")]
    pub body: Option<PathBuf>,
    /// Seconds of play of `window` [default: 600; 6 of a quick run].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=86_400))]
    pub seconds: Option<u64>,
    /// Write the measurements to this file.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub struct PlotOptions {
    /// File written by `bench thesis --json FILE` or `bench view --json FILE`.
    #[arg(value_name = "FILE.json")]
    pub file: PathBuf,
    /// The picture to write [default: beside the measurements, ending in .svg].
    #[arg(long, value_name = "FILE.svg")]
    pub out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Bench {
    /// The thesis's tables 1 to 4.
    Thesis,
    /// Cost against strands and cells.
    Scaling,
    /// Frames per second against viewing distance and picture size, beside the thesis's table 5.
    View,
    /// Gain of simulating a frame while the one before is drawn, for pairs of devices.
    Workers,
    /// Ten minutes of use as in the window: time to the first picture, pictures per second, delay until a move
    /// shows, growth of memory.
    Window,
    /// Grooms of artists: time to the first picture, cost of bound strands, and speed at which
    /// moving hair is written.
    Groom,
}

/// A wrong use of the command line that clap does not see; ends with code 2.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Usage(pub String);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_sound() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
