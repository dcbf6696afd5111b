//! Files of other programs: segments, marks, old versions, no headers.

use glam::{Vec2, Vec3};
use strandline_base::npz;
use strandline_groom::format::{
    LoadOptions, Saved, Scale, bin, data, hair, load, npz as groom_npz, obj, ply, tfx, usda,
};
use strandline_groom::{Groom, Widths};

/// Three strands of four points.
fn strands() -> Vec<Vec<Vec3>> {
    let point = |strand: usize, point: usize| Vec3::new(0.25 * strand as f32, 0.125 * point as f32, 0.5);
    (0..3).map(|strand| (0..4).map(|at| point(strand, at)).collect()).collect()
}

fn check(groom: &Groom, of: &str) {
    let found: Vec<_> = (0..groom.strand_count()).map(|strand| groom.strand(strand).to_vec()).collect();
    assert_eq!(found, strands(), "{of}");
}

fn coordinates() -> Vec<u8> {
    strands().concat().iter().flat_map(|point| point.to_array()).flat_map(f32::to_le_bytes).collect()
}

fn vertices() -> String {
    strands().concat().iter().map(|point| format!("v {} {} {}\n", point.x, point.y, point.z)).collect()
}

/// The segments of all strands, strand by strand, from 0.
fn segments() -> Vec<[usize; 2]> {
    (0..3).flat_map(|strand| (0..3).map(move |point| [4 * strand + point, 4 * strand + point + 1])).collect()
}

#[test]
fn segments_of_an_obj_become_strands() {
    let text = |segments: &[[usize; 2]], end: &str| {
        let lines = segments.iter().map(|[one, two]| format!("l {} {}{end}", one + 1, two + 1));
        format!("{}{}", vertices(), lines.collect::<String>())
    };
    let parsed = obj::read(text(&segments(), "\n").as_bytes()).unwrap();
    check(&parsed.groom, "in order");
    assert_eq!(parsed.problems, ["9 lines that share their ends are joined into 3 strands"]);
    let mut shuffled = segments();
    shuffled.swap(0, 7);
    shuffled.swap(3, 8);
    shuffled[4].reverse();
    let groom = obj::read(text(&shuffled, "\n").as_bytes()).unwrap().groom;
    let mut found: Vec<_> = (0..groom.strand_count()).map(|strand| groom.strand(strand).to_vec()).collect();
    found.sort_by(|one, two| one[0].x.total_cmp(&two[0].x));
    assert_eq!(found, strands());
}

#[test]
fn groups_stay_with_the_segments_of_an_obj() {
    let mut text = vertices();
    for (index, [one, two]) in segments().into_iter().enumerate() {
        if index % 3 == 0 {
            text += &format!("g lock{index}\n");
        }
        text += &format!("l {} {}\n", one + 1, two + 1);
    }
    let groom = obj::read(text.as_bytes()).unwrap().groom;
    assert_eq!(groom.groups.as_deref(), Some(&[0, 1, 2][..]));
    assert_eq!(groom.group_names[&1], "lock3");
}

#[test]
fn marks_and_continued_lines_of_an_obj_are_no_obstacle() {
    let lines = "l 1 2 \\\n3 4\nl 5 6 7 8\nl 9 10 \\\r\n 11 12\n";
    let text = format!("\u{FEFF}{}{lines}v 0 0 0\n", vertices());
    check(&obj::read(text.as_bytes()).unwrap().groom, "UTF-8");
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    check(&obj::read(&wide).unwrap().groom, "UTF-16");
}

/// Names of groups are numbered without a look at all before: 100,000 of them take no longer than their lines.
#[test]
fn many_groups_of_an_obj_are_read_in_linear_time() {
    let read = |count: usize| {
        let lines = (0..count).map(|group| format!("g a{group}\nl 1 2\n")).collect::<String>();
        let begin = std::time::Instant::now();
        let parsed = obj::read(format!("v 0 0 0\nv 0 1 0\n{lines}").as_bytes()).unwrap();
        (parsed.groom.strand_count(), begin.elapsed())
    };
    // The quadratic reader needed minutes for so many.
    let (_, seconds) = read(300_000);
    assert!(seconds.as_secs() < 30, "{seconds:?}");
}

#[test]
fn edges_of_a_ply_become_strands_in_any_order() {
    let mut edges = segments();
    edges.reverse();
    edges.swap(1, 6);
    let points: String =
        strands().concat().iter().map(|point| format!("{} {} {}\n", point.x, point.y, point.z)).collect();
    let edges: String = edges.iter().map(|[one, two]| format!("{one} {two}\n")).collect();
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float z\n\
         element edge 9\nproperty int vertex1\nproperty int vertex2\nend_header\n{points}{edges}"
    );
    let parsed = ply::read(text.as_bytes(), None).unwrap();
    let mut found: Vec<_> = (0..3).map(|strand| parsed.groom.strand(strand).to_vec()).collect();
    found.sort_by(|one, two| one[0].x.total_cmp(&two[0].x));
    assert_eq!(found, strands());
    assert!(parsed.problems.is_empty(), "{:?}", parsed.problems);
}

fn tfx_2() -> String {
    let strand = |(index, points): (usize, Vec<Vec3>)| {
        let lines: String = points
            .iter()
            .map(|point| format!("{}, {}, {}\n", 100.0 * point.x, 100.0 * point.y, 100.0 * point.z))
            .collect();
        format!("strand {index} numVerts 4 texcoord 0.{index} 000000\n{lines}")
    };
    let strands: String = strands().into_iter().enumerate().map(strand).collect();
    format!(
        "version 2.0\nscale 0.01\nrotation 0 0 0\ntranslation 0 0 0\nbothEndsImmovable 0\n\
         maxNumVerticesInStrand 4\nnumFollowHairsPerGuideHair 4\nmaxRadiusAroundGuideHair 0.5\nnumStrands 3\n\
         is sorted 1\n{strands}"
    )
}

#[test]
fn tressfx_2_is_read() {
    for text in [tfx_2(), format!("\u{FEFF}{}", tfx_2().replace('\n', "\r\n"))] {
        let parsed = tfx::read(text.as_bytes()).unwrap();
        assert_eq!(parsed.format, ".tfx 2");
        for (point, expected) in parsed.groom.points.iter().zip(strands().concat()) {
            assert!(point.distance(expected) < 1e-6, "{point} {expected}");
        }
        assert_eq!(parsed.groom.starts, [0, 4, 8, 12]);
        assert_eq!(parsed.groom.root_uvs.unwrap()[2], Vec2::new(0.2, 0.0));
        assert_eq!(parsed.problems, ["4 hairs that TressFX adds to each guide are not added"]);
    }
    let refused =
        |from: &str, to: &str| tfx::read(tfx_2().replace(from, to).as_bytes()).unwrap_err().to_string();
    assert!(refused("numStrands 3", "numStrands 4").contains("3 whole strands, expected 4 strands"));
    assert!(refused("strand 2 numVerts 4", "strand 2 numVerts 5").contains("2 whole strands"));
    assert!(refused("strand 1 numVerts 4", "strand 1 numVerts 3").contains("in line 20"));
    assert!(refused("strand 1 numVerts 4", "strand 1 numVerts 99999999999").contains("in line 16"));
    assert!(refused("version 2.0", "version 7").contains("in line 1"));
    assert!(refused("25, 12.5", "25, twelve").contains("in line 18"));
}

#[test]
fn strands_without_a_header_are_read_where_sizes_agree() {
    type Read =
        fn(&[u8], Option<u32>) -> Result<strandline_groom::format::Parsed, strandline_groom::GroomError>;
    for (of, read) in [("hair", hair::read as Read), ("data", data::read), ("bin", bin::read)] {
        check(&read(&coordinates(), Some(4)).unwrap().groom, of);
        for (bytes, each) in [
            (coordinates(), None),
            (coordinates(), Some(5)),
            (coordinates()[1..].to_vec(), Some(4)),
            ([coordinates(), f32::NAN.to_le_bytes().to_vec(), vec![0; 44]].concat(), Some(4)),
        ] {
            assert!(read(&bytes, each).is_err(), "{of} {each:?}");
        }
    }
    let counts = [3_u32, 12].iter().flat_map(|number| number.to_le_bytes());
    let counted: Vec<u8> = counts.chain([4, 0, 4, 0, 4, 0]).chain(coordinates()).collect();
    check(&hair::read(&counted, None).unwrap().groom, "counted");
    assert!(
        hair::read(&counted[..counted.len() - 4], None).unwrap_err().to_string().contains("expected `HAIR`")
    );
}

fn seed(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/usda").join(name);
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn our_own_text_usd_is_read() {
    let parsed = usda::read(seed("own").as_bytes()).unwrap();
    let groom = &parsed.groom;
    assert_eq!(groom.starts, [0, 2, 5]);
    assert_eq!(groom.points[4], Vec3::new(0.5, 0.25, 0.0), "the first time");
    assert_eq!(parsed.problems, ["the first of 2 times of `strands` is read"]);
    assert!((groom.widths.at(1, 3) - 6e-5).abs() < 1e-9);
    assert_eq!(groom.colors.as_ref().unwrap()[2], [1.0, 0.0, 0.0]);
    assert_eq!(groom.root_uvs.as_ref().unwrap()[1], Vec2::new(0.75, 0.5));
    assert_eq!(groom.groups, None);
}

#[test]
fn splines_units_axes_and_transforms_of_usd_are_applied() {
    let groom = usda::read(seed("blender").as_bytes()).unwrap().groom;
    assert_eq!(groom.starts, [0, 4, 9]);
    // Up is z there; the prim is moved by 1 along x and twice as large.
    let expected = [
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(1.0, 0.2, 0.0),
        Vec3::new(1.0, 0.4, 0.0),
        Vec3::new(1.0, 0.6, 0.0),
    ];
    for (point, expected) in groom.points.iter().zip(expected) {
        assert!(point.distance(expected) < 1e-6, "{point} {expected}");
    }
    assert!((groom.widths.at(0, 0) - 2e-4).abs() < 1e-9, "widths grow with the prim");
    let centimetres = seed("blender").replace("metersPerUnit = 1", "metersPerUnit = 0.01");
    let small = usda::read(centimetres.as_bytes()).unwrap().groom;
    assert!(small.points[3].distance(0.01 * groom.points[3]) < 1e-7);
    let bezier = seed("blender")
        .replace("\"bspline\"", "\"bezier\"")
        .replace("[4, 5]", "[4, 4]")
        .replace(", (1, 0, 0.4)", "");
    let bezier = usda::read(bezier.as_bytes()).unwrap().groom;
    assert!(bezier.points[1].distance(Vec3::new(1.0, 0.2, 0.0)) < 1e-6, "an even Bezier curve is even");
    let catmull =
        seed("blender").replace("\"bspline\"", "\"catmullRom\"").replace("\"pinned\"", "\"nonperiodic\"");
    assert_eq!(usda::read(catmull.as_bytes()).unwrap().groom.starts, [0, 2, 5], "ends are no points");
}

#[test]
fn several_prims_of_usd_are_groups_and_mistakes_are_named() {
    let two = format!(
        "{}\n{}",
        seed("own"),
        seed("own").split_once("\n)\n").unwrap().1.replace("\"strands\"", "\"back\"")
    );
    let parsed = usda::read(two.as_bytes()).unwrap();
    assert_eq!(parsed.groom.groups.as_deref(), Some(&[0, 0, 1, 1][..]));
    assert_eq!(parsed.groom.group_names[&1], "back");
    let refused = |from: &str, to: &str| {
        assert!(seed("own").contains(from), "{from}");
        usda::read(seed("own").replace(from, to).as_bytes()).unwrap_err().to_string()
    };
    assert!(refused("[2, 3]", "[2, 4]").contains("2 curves of 6 points in all, and 5 points"));
    assert!(refused("[2, 3]", "[2, -3]").contains("a curve of -3 points"));
    assert!(refused("[2, 3]", "[2, 1e300]").contains("a curve of"));
    assert!(refused("BasisCurves", "Mesh").contains("no BasisCurves"));
    assert!(refused("#usda", "usda").contains("starts with `usda"));
    assert!(refused("#usda 1.0", "PXR-USDC").contains("pip install 'strandline[usd]'"));
    assert!(refused("    }\n}\n", "").contains("at byte"));
    let deep =
        format!("#usda 1.0\ndef Xform \"a\" {{ int[] x = {}1{} }}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(usda::read(deep.as_bytes()).unwrap_err().to_string().contains("fewer levels"));
    let prims = format!("#usda 1.0\n{}", "def Xform \"a\" {".repeat(100_000));
    assert!(usda::read(prims.as_bytes()).unwrap_err().to_string().contains("fewer levels"));
}

#[test]
fn files_of_other_programs_are_told_the_way_in() {
    let folder = tempfile::tempdir().unwrap();
    let told = |name: &str| Groom::load(folder.path().join(name)).unwrap_err().to_string();
    for (name, way) in [
        ("a.abc", "pip install 'strandline[abc]'"),
        ("a.abc", "import it in Blender"),
        ("a.usdc", "pip install 'strandline[usd]'"),
        ("a.usdc", "usdcat -o hair.usda"),
        ("a.usdz", "pip install 'strandline[usd]'"),
        ("a.fbx", "open it in its program"),
        ("a.blend", "export them as USD"),
        ("a.vrm", "a mesh is a body"),
    ] {
        assert!(told(name).contains(way), "{}", told(name));
    }
    std::fs::write(folder.path().join("a.usd"), seed("own")).unwrap();
    assert_eq!(Groom::load(folder.path().join("a.usd")).unwrap().strand_count(), 2);
}

#[test]
fn values_of_curves_are_read_by_their_number_and_others_are_named() {
    let curves = |more: &str| {
        let text = format!(
            "#usda 1.0\n(\nmetersPerUnit = 1\n)\ndef BasisCurves \"fur\" {{\nuniform token type = \"linear\"\n\
             int[] curveVertexCounts = [2, 3]\npoint3f[] points = [(0,0,0), (0,1,0), (1,0,0), (1,1,0), (1,2,0)]\n{more}\n}}\n"
        );
        usda::read(text.as_bytes()).unwrap()
    };
    for (name, more) in [
        ("widths", "float[] widths = [1, 2, 3]"),
        ("colours", "color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]"),
        ("root coordinates", "texCoord2f[] primvars:st = [(0, 0), (0, 1), (1, 1)]"),
        ("groups", "int[] primvars:group_id = [1, 2, 3]"),
    ] {
        let parsed = curves(more);
        let values = if name == "colours" { 4 } else { 3 };
        let expected = format!("{name} of `fur` are not read: {values} values for 2 curves of 5 points");
        assert_eq!(parsed.problems, [expected]);
        let groom = parsed.groom;
        let has = (groom.widths.clone(), groom.colors.is_some(), groom.root_uvs, groom.groups);
        assert_eq!(has, (Widths::Constant(0.0), false, None, None), "{name}");
    }
    let of_points = curves("texCoord2f[] primvars:st = [(0.1, 0), (0, 0), (0.2, 1), (0, 0), (0, 0)]");
    let uvs = of_points.groom.root_uvs.unwrap();
    assert_eq!((uvs[0].x, uvs[1].x, of_points.problems), (0.1, 0.2, Vec::new()), "those of the roots");
    let one = curves("int[] primvars:group_id = [7]\nfloat[] widths = [0.5]").groom;
    assert_eq!((one.groups, one.widths), (Some(vec![7; 2]), Widths::PerPoint(vec![0.5; 5])));
}

#[test]
fn tfx_files_have_numbers_of_points_that_tressfx_takes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tfx");
    let of = |strands: usize, points: &[usize]| {
        let mut groom = Groom::empty(9e-5);
        for strand in 0..strands {
            let count = points[strand % points.len()];
            groom.push((0..count).map(|point| Vec3::new(strand as f32, point as f32, 0.0) * 0.01));
        }
        groom
    };
    for (counts, written) in [(&[24][..], 32), (&[2], 4), (&[5, 9], 16), (&[100], 64), (&[3, 16], 16)] {
        let Saved { notes, points, .. } = of(64, counts).save(&path).unwrap();
        assert_eq!(points, 64 * written as usize, "{counts:?}");
        assert!(notes.len() == 1 && notes[0].ends_with(&format!("resampled to {written}")), "{notes:?}");
        let read = Groom::load(&path).unwrap();
        assert!(read.starts.windows(2).all(|pair| pair[1] - pair[0] == written), "{counts:?}");
        let (length, own) = (read.lengths()[1], of(64, counts).lengths()[1]);
        assert!((length - own).abs() < 1e-5, "{counts:?}: {length} {own}");
    }
    let kept = of(64, &[16]);
    assert!(kept.save(&path).unwrap().notes.is_empty());
    assert_eq!(Groom::load(&path).unwrap().points, kept.points);
    let notes = of(20, &[16]).save(&path).unwrap().notes;
    assert_eq!(notes, ["TressFX takes 64 strands or more: the file has 20"]);
}

#[test]
fn a_frame_of_moving_hair_is_chosen() {
    let text = "#usda 1.0\n(\nmetersPerUnit = 1\n)\ndef BasisCurves \"fur\" {\nuniform token type = \"linear\"\n\
                int[] curveVertexCounts = [2]\npoint3f[] points.timeSamples = {\n\
                1: [(0,0,0), (0,1,0)],\n2.5: [(0,0,0), (0,2,0)],\n7: [(0,0,0), (0,3,0)],\n}\n}\n";
    let length = |frame: Option<u32>| {
        let parsed = usda::read_at(text.as_bytes(), frame).unwrap();
        assert_eq!(parsed.problems.len(), 1, "{:?}", parsed.problems);
        parsed.groom.points[1].y
    };
    let found = [None, Some(0), Some(1), Some(2), Some(3), Some(6), Some(7), Some(90)].map(length);
    assert_eq!(found, [1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("moving.npz");
    let places = (0..3).flat_map(|frame| [[0.0_f32; 3], [0.0, 1.0 + frame as f32, 0.0]]).flatten();
    let arrays = [
        npz::Array::f32s("points", &[3, 2, 3], places),
        npz::Array::u32s("starts", &[2], [0, 2]),
        npz::Array::f32s("velocities", &[3, 2, 3], (0..18).map(|number| number as f32)),
    ];
    std::fs::write(&path, npz::pack(&arrays)).unwrap();
    let read = |frame: Option<u32>| {
        let options = LoadOptions { scale: Scale::Factor(1.0), frame, ..LoadOptions::default() };
        load(&path, &options).map(|loaded| (loaded.groom.points[1].y, loaded.groom.velocities.unwrap()[0].x))
    };
    assert_eq!(
        [None, Some(1), Some(2)].map(|frame| read(frame).unwrap()),
        [(1.0, 0.0), (2.0, 6.0), (3.0, 12.0)]
    );
    let refused = read(Some(3)).unwrap_err().to_string();
    assert!(refused.contains("3 frames, expected a frame 3"), "{refused}");
}

#[test]
fn arrays_of_research_code_are_read_by_their_counts_and_shapes() {
    let points =
        || npz::Array::f32s("points", &[12, 3], strands().concat().iter().flat_map(|point| point.to_array()));
    let whole = |name, all: &[u32]| npz::Array::u32s(name, &[all.len()], all.iter().copied());
    for starts in [whole("offsets", &[0, 4, 8, 12]), whole("counts", &[4; 3])] {
        let radii = npz::Array::f32s("radii", &[12], [4e-5; 12]);
        let colors = npz::Array::f32s("colors", &[3, 3], (0..9).map(|part| 0.1 * part as f32));
        let groom = groom_npz::read(&npz::pack(&[points(), starts, radii, colors]), None).unwrap().groom;
        check(&groom, "counts");
        assert_eq!(groom.widths, Widths::PerPoint(vec![8e-5; 12]));
        let colors = groom.colors.unwrap();
        assert_eq!((colors.len(), colors[3], colors[4]), (12, [0.0, 0.1, 0.2], [0.3, 0.4, 0.5]));
    }
    let widths = npz::Array::f32s("widths", &[3], [1e-5, 2e-5, 3e-5]);
    let groom =
        groom_npz::read(&npz::pack(&[points(), whole("counts", &[4; 3]), widths]), None).unwrap().groom;
    assert_eq!(groom.widths, Widths::PerStrand(vec![1e-5, 2e-5, 3e-5]));
    let refused =
        groom_npz::read(&npz::pack(&[points(), whole("counts", &[4, 4, u32::MAX])]), None).unwrap_err();
    assert!(refused.to_string().contains("4 numbers for 12 points"), "{refused}");
}

#[test]
fn bytes_of_colours_of_a_ply_are_those_of_a_picture() {
    let text = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
                property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n0 0 0 96 64 40\n0 1 0 96 64 255\n";
    let colors = ply::read(text.as_bytes(), Some(2)).unwrap().groom.colors.unwrap();
    let expected = [0.1170, 0.0513, 0.0212];
    assert!(
        colors[0].iter().zip(expected).all(|(part, expected)| (part - expected).abs() < 1e-4),
        "{:?}",
        colors[0]
    );
    assert_eq!(colors[1][2], 1.0);
}
