//! Text USD: one prim of linear curves with a sample of points for every frame, and a transform for the head and each
//! further piece of the body beside it.
//!
//! Attributes and conventions: UsdGeomBasisCurves and primvars as OpenUSD's schema has them; for Unreal the
//! groom_* primvars of its groom schema 1.5.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use strandline_base::{FolderLock, GrowingFile};

use super::{
    CacheFrame, Target, What,
    shape::{Attributes, Shape},
    usd_text::{list, put, put_points, put_tuple, quoted},
};
use crate::{Error, Scene, body::Pose, prepare::looks};

/// Characters that the first and the last time code may have.
const DIGITS: usize = 24;
/// A time code is a whole number where it is this near to one: times of frames are rounded.
const WHOLE: f64 = 1e-6;

/// A preview of the look: the colours of the strands under a smooth surface [UsdPreviewSurface]. Renderers for hair
/// take the colours alone.
const MATERIAL: &str = r#"    def Scope "looks"
    {
        def Material "fibre"
        {
            token outputs:surface.connect = </hair/looks/fibre/surface.outputs:surface>

            def Shader "surface"
            {
                uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor.connect = </hair/looks/fibre/color.outputs:result>
                float inputs:roughness = 0.4
                token outputs:surface
            }

            def Shader "color"
            {
                uniform token info:id = "UsdPrimvarReader_float3"
                string inputs:varname = "displayColor"
                float3 outputs:result
            }
        }
    }

"#;

/// A file under way.
pub(super) struct Usd {
    path: PathBuf,
    file: GrowingFile,
    /// Keeps other runs off the name, which the file gets at its end.
    _lock: FolderLock,
    /// Bytes so far, and where the first and the last time code stand.
    length: u64,
    ends_at: [u64; 2],
    space: Space,
    /// Time codes a second.
    rate: f64,
    widest: f32,
    /// One frame, in pieces.
    texts: Vec<String>,
    /// Text behind the points: the box around them and the pieces of the body, for each frame.
    boxes: Vec<(f64, [Vec3; 2])>,
    pieces: Vec<(f64, Vec<Pose>)>,
}

/// Units and axes of a file.
#[derive(Clone, Copy)]
struct Space {
    metres_per_unit: f32,
    z_up: bool,
}

impl Space {
    fn of(target: Target) -> Self {
        match target {
            Target::Any => Self { metres_per_unit: 1.0, z_up: false },
            Target::Blender => Self { metres_per_unit: 1.0, z_up: true },
            Target::Unreal => Self { metres_per_unit: 0.01, z_up: true },
        }
    }

    /// Turns what faces +z under y into what faces -y under z.
    fn turn(self, vector: Vec3) -> Vec3 {
        if self.z_up { Vec3::new(vector.x, -vector.z, vector.y) } else { vector }
    }

    fn length(self, metres: f32) -> f32 {
        // A hundred is exact where its inverse is not.
        metres * (1.0 / self.metres_per_unit).round()
    }

    fn point(self, point: Vec3) -> Vec3 {
        self.turn(point).map(|metres| self.length(metres))
    }

    /// A motion of the file's space: of what was turned with everything else.
    fn pose(self, pose: &Pose) -> Pose {
        let axis = self.turn(Vec3::from_slice(&pose.rotation.to_array()[..3]));
        let rotation = Quat::from_xyzw(axis.x, axis.y, axis.z, pose.rotation.w);
        Pose { rotation, translation: self.point(pose.translation) }
    }
}

impl Usd {
    /// Begins a file.
    pub fn new(path: &Path, scene: &Scene, shape: &Shape, target: Target) -> Result<Self, Error> {
        let lock = crate::film::claim_name(path)?;
        let file = GrowingFile::create(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::ResourceBusy => Error::BusyFile { path: path.to_owned() },
            _ => Error::write("the USD file", path)(error),
        })?;
        let widths = shape.attributes.widths.iter().flatten();
        let mut usd = Self {
            path: path.to_owned(),
            file,
            _lock: lock,
            length: 0,
            ends_at: [0; 2],
            space: Space::of(target),
            rate: f64::from(scene.film.frames_per_second),
            widest: widths.fold(0.0, |widest, width| width.max(widest)),
            texts: Vec::new(),
            boxes: Vec::new(),
            pieces: Vec::new(),
        };
        let (head, ends_at) = usd.head(target);
        usd.ends_at = ends_at.map(|at| at as u64);
        usd.put(&head)?;
        usd.put(&usd.curves(scene, shape, target))?;
        Ok(usd)
    }

    fn put(&mut self, text: &str) -> Result<(), Error> {
        let written = self.file.write_at(self.length, text.as_bytes());
        written.map_err(Error::write("the USD file", &self.path))?;
        self.length += text.len() as u64;
        Ok(())
    }

    /// Text before the curves, and the places in it of the first and the last time code.
    fn head(&self, target: Target) -> (String, [usize; 2]) {
        let mut text = "#usda 1.0\n(\n    defaultPrim = \"hair\"\n".to_owned();
        let about = format!("hair as it moved, written by strandline {}", env!("CARGO_PKG_VERSION"));
        let _ = write!(text, "    doc = {}\n    endTimeCode = ", quoted(&about));
        let end_at = text.len();
        let Self { rate, space, .. } = self;
        let up = if space.z_up { "Z" } else { "Y" };
        let _ = write!(
            text,
            "{:<DIGITS$}\n    framesPerSecond = {rate}\n    metersPerUnit = {}\n    startTimeCode = ",
            0, space.metres_per_unit
        );
        let start_at = text.len();
        let _ = write!(
            text,
            "{:<DIGITS$}\n    timeCodesPerSecond = {rate}\n    upAxis = \"{up}\"\n)\n\ndef Xform \"hair\" (\n",
            0
        );
        if target == Target::Unreal {
            text.push_str("    prepend apiSchemas = [\"GroomAPI\"]\n");
        }
        text.push_str("    kind = \"component\"\n)\n{\n");
        text.push_str(MATERIAL);
        (text, [start_at, end_at])
    }

    /// The prim of the curves up to its points.
    fn curves(&self, scene: &Scene, shape: &Shape, target: Target) -> String {
        let counts = shape.starts.windows(2).map(|pair| pair[1] - pair[0]);
        let counts = list(counts, |text, count| text.push_str(&count.to_string()));
        let mut text = format!(
            "    def BasisCurves \"{}\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {{\n        \
             rel material:binding = </hair/looks/fibre>\n        uniform token type = \"linear\"\n        uniform token wrap = \
             \"nonperiodic\"\n        int[] curveVertexCounts = {counts}\n",
            shape.what.name()
        );
        for Primvar { of, name, values, interpolation } in self.primvars(scene, shape, target) {
            let name = if name == "widths" { name.to_owned() } else { format!("primvars:{name}") };
            let _ = write!(
                text,
                "        {of}[] {name} = {values} (\n            interpolation = \"{interpolation}\"\n        )\n"
            );
        }
        text.push_str("        point3f[] points.timeSamples = {\n");
        text
    }

    /// The attributes that there are.
    fn primvars(&self, scene: &Scene, shape: &Shape, target: Target) -> Vec<Primvar> {
        let Attributes { widths, colors, root_uvs, groups, group_names, .. } = &shape.attributes;
        let unreal = target == Target::Unreal;
        let mut all = Vec::new();
        let mut add = |of, name, values, interpolation| all.push(Primvar { of, name, values, interpolation });
        if let Some(widths) = widths {
            add(
                "float",
                "widths",
                list(widths, |text, width| put(text, self.space.length(*width))),
                "vertex",
            );
        }
        {
            // Strands without colours of their own have those of the look.
            let of_look = || looks::colors_along(&scene.look, &shape.starts);
            let colors =
                &colors.as_ref().map_or_else(|| Cow::Owned(of_look()), |colors| Cow::Borrowed(&colors[..]));
            let values = || list(&**colors, |text, color| put_tuple(text, color));
            add("color3f", "displayColor", values(), "vertex");
            if unreal {
                add("float3", "groom_color", values(), "vertex");
            }
        }
        if let Some(uvs) = root_uvs {
            let name = if unreal { "groom_root_uv" } else { "st" };
            add("texCoord2f", name, list(uvs, |text, uv| put_tuple(text, uv)), "uniform");
        }
        if let Some(groups) = groups {
            let values = list(groups, |text, group| text.push_str(&group.to_string()));
            add("int", if unreal { "groom_group_id" } else { "group_id" }, values, "uniform");
            let named = |group: &u16| group_names.get(usize::from(*group));
            if groups.iter().all(|group| named(group).is_some()) {
                let values = list(groups, |text, group| {
                    text.push_str(&quoted(named(group).map_or("", String::as_str)));
                });
                add("string", if unreal { "groom_group_name" } else { "group_name" }, values, "uniform");
            }
        }
        if unreal {
            all.extend(of_unreal(shape));
        }
        all
    }

    /// Time code of a time \[s\]: over time codes a second it is that time.
    fn code(&self, time: f64) -> f64 {
        let code = time * self.rate;
        if (code - code.round()).abs() < WHOLE { code.round() } else { code }
    }

    /// Adds a frame.
    pub fn add(&mut self, frame: &CacheFrame) -> Result<(), Error> {
        let (code, space) = (self.code(frame.time), self.space);
        let mut texts = std::mem::take(&mut self.texts);
        let [low, high] = put_points(&mut texts, frame.points, |point| space.point(point));
        self.put(&format!("            {code}: ["))?;
        texts.iter().try_for_each(|text| self.put(text))?;
        self.put("],\n")?;
        self.texts = texts;
        let half = Vec3::splat(0.5 * space.length(self.widest));
        self.boxes.push((code, [low - half, high + half]));
        let piece = |piece| space.pose(&frame.body.piece(piece));
        self.pieces.push((code, (0..frame.body.piece_count()).map(piece).collect()));
        Ok(())
    }

    /// Appends the prim of a piece; in frames without it the piece rides the head.
    fn put_piece(&self, text: &mut String, piece: usize) {
        let poses = || {
            let of_frame =
                |(code, pieces): &(f64, Vec<Pose>)| (*code, *pieces.get(piece).unwrap_or(&pieces[0]));
            self.pieces.iter().map(of_frame)
        };
        let _ = write!(text, "\n    def Xform \"{}\"\n    {{\n", piece_name(piece));
        text.push_str("        double3 xformOp:translate.timeSamples = {\n");
        for (code, pose) in poses() {
            let _ = write!(text, "            {code}: ");
            put_tuple(text, &pose.translation.to_array());
            text.push_str(",\n");
        }
        text.push_str("        }\n        quatf xformOp:orient.timeSamples = {\n");
        for (code, pose) in poses() {
            let [x, y, z, w] = pose.rotation.to_array();
            let _ = write!(text, "            {code}: ");
            put_tuple(text, &[w, x, y, z]);
            text.push_str(",\n");
        }
        let order = "[\"xformOp:translate\", \"xformOp:orient\"]";
        let _ = write!(text, "        }}\n        uniform token[] xformOpOrder = {order}\n    }}\n");
    }

    /// Ends the file of a whole film, or of one that was stopped early. Returns its path.
    pub fn finish(mut self, whole: bool) -> Result<PathBuf, Error> {
        let mut text = "        }\n        float3[] extent.timeSamples = {\n".to_owned();
        for (code, corners) in &self.boxes {
            let corners = list(corners, |text, corner| put_tuple(text, &corner.to_array()));
            let _ = writeln!(text, "            {code}: {corners},");
        }
        text.push_str("        }\n    }\n");
        let count = self.pieces.iter().map(|(_, pieces)| pieces.len()).max().unwrap_or(1);
        for piece in 0..count {
            self.put_piece(&mut text, piece);
        }
        text.push_str("}\n");
        self.put(&text)?;
        let ends = [self.boxes.first(), self.boxes.last()].map(|frame| frame.map_or(0.0, |(code, _)| *code));
        let Self { path, mut file, ends_at, .. } = self;
        let mut codes = ends_at.into_iter().zip(ends);
        let ended = codes.try_for_each(|(at, code)| file.write_at(at, format!("{code:<DIGITS$}").as_bytes()));
        let place =
            ended.and_then(|()| if whole { file.finish().map(|()| path.clone()) } else { file.leave() });
        place.map_err(Error::write("the USD file", &path))
    }
}

/// Name of the prim of a piece.
fn piece_name(piece: usize) -> String {
    if piece == 0 { "head".to_owned() } else { format!("piece_{piece}") }
}

/// Attributes for Unreal: guides, numbers, and three guides and weights of each strand.
fn of_unreal(shape: &Shape) -> Vec<Primvar> {
    let Attributes { guide_flags, binding, .. } = &shape.attributes;
    let mut all = Vec::new();
    let mut add = |of, name, values, interpolation| all.push(Primvar { of, name, values, interpolation });
    match guide_flags {
        Some(flags) => {
            let values = list(flags, |text, flag| text.push(if *flag { '1' } else { '0' }));
            add("int", "groom_guide", values, "uniform");
        }
        None => {
            let guide = i32::from(shape.what == What::Guides);
            add("int", "groom_guide", format!("[{guide}]"), "constant");
        }
    }
    let values = list(0..shape.strand_count(), |text, strand| text.push_str(&strand.to_string()));
    add("int", "groom_id", values, "uniform");
    // A file of guides has no strands that hang on them; Unreal reads three guides of each.
    if let (What::Strands, Some(binding)) = (shape.what, binding)
        && binding.guides_per_strand >= 3
    {
        let indices = binding.indices.chunks_exact(binding.guides_per_strand);
        let three = |text: &mut String, three: &[u32]| {
            let _ = write!(text, "({}, {}, {})", three[0], three[1], three[2]);
        };
        add("int3", "groom_closest_guides", list(indices, three), "uniform");
        let weights = binding.weights.chunks_exact(binding.guides_per_strand);
        let values = list(weights, |text, weights| put_tuple(text, &weights[..3]));
        add("float3", "groom_guide_weights", values, "uniform");
    }
    all
}

/// An attribute of the curves.
struct Primvar {
    of: &'static str,
    name: &'static str,
    values: String,
    interpolation: &'static str,
}
