//! Attributes of a groom beyond points: kept by a format to the bit, or named as lost.

use std::path::PathBuf;

use glam::{Vec2, Vec3};
use strandline_groom::format::{
    Attribute, FORMATS, LoadOptions, Scale, bin, data, load, load_all, npy, npz, obj, ply,
};
use strandline_groom::{Groom, GroomError, Influences, Widths};

/// Five strands of four points with everything that a groom can have, in numbers that no short text holds.
fn everything() -> Groom {
    let mut groom = Groom::empty(0.0);
    let number = |index: usize| ((index as f32 + 1.0) * 0.618_034).fract();
    for strand in 0..5 {
        let place =
            |point: usize| Vec3::new(0.1 * number(strand), 0.03 * point as f32, 0.1 * number(strand + 7));
        groom.push((0..4).map(place));
    }
    groom.widths = Widths::PerPoint((0..20).map(|point| 1e-4 * number(point)).collect());
    groom.root_uvs = Some((0..5).map(|strand| Vec2::new(number(strand), number(strand + 3))).collect());
    groom.root_normals = Some((0..5).map(|s| Vec3::new(number(s), 1.0, 0.1).normalize()).collect());
    groom.groups = Some(vec![7, 7, 2, 0, 2]);
    groom.group_names = [(7, "left fringe".to_owned()), (2, "tail".to_owned())].into();
    groom.guide_flags = Some(vec![true, false, true, false, true]);
    let guides = (0..15).map(|index| [0, 2, 4][index % 3]).collect();
    let weights = (0..5).flat_map(|strand| [0.5, 0.5 - 0.1 * strand as f32, 0.1 * strand as f32]).collect();
    groom.influences = Some(Influences::new(3, guides, weights, 5).unwrap());
    groom.colors = Some((0..20).map(|point| [number(point), number(point + 1), number(point + 2)]).collect());
    groom.transparencies = Some((0..20).map(|point| number(point + 5)).collect());
    groom.masses = Some((0..20).map(|point| 1e-6 * number(point)).collect());
    groom.velocities = Some((0..20).map(|point| Vec3::new(number(point), -0.5, number(point + 9))).collect());
    groom
}

/// True if two grooms are the same in one attribute.
fn agree(part: Attribute, one: &Groom, two: &Groom) -> bool {
    let along = |groom: &Groom| groom.point_widths().collect::<Vec<_>>();
    match part {
        Attribute::Widths => one.root_widths().eq(two.root_widths()),
        Attribute::WidthsAlong => along(one) == along(two),
        Attribute::Colors => one.colors == two.colors,
        Attribute::Transparencies => one.transparencies == two.transparencies,
        Attribute::RootUvs => one.root_uvs == two.root_uvs,
        Attribute::RootNormals => one.root_normals == two.root_normals,
        Attribute::Groups => one.groups == two.groups,
        Attribute::GroupNames => one.group_names == two.group_names,
        Attribute::GuideFlags => one.guide_flags == two.guide_flags,
        Attribute::Influences => one.influences == two.influences,
        Attribute::Masses => one.masses == two.masses,
        Attribute::Velocities => one.velocities == two.velocities,
    }
}

fn as_it_is() -> LoadOptions {
    LoadOptions { scale: Scale::Factor(1.0), ..LoadOptions::default() }
}

#[test]
fn every_format_keeps_a_part_to_the_bit_or_names_it_as_lost() {
    let folder = tempfile::tempdir().unwrap();
    let whole = everything();
    for format in FORMATS.iter().filter(|format| format.write.is_some()) {
        let path = folder.path().join(format!("all.{}", format.ending));
        let left_out = whole.save(&path).unwrap().left_out;
        let read = load(&path, &as_it_is()).unwrap().groom;
        assert_eq!((&read.points, &read.starts), (&whole.points, &whole.starts), ".{}", format.ending);
        for part in Attribute::ALL {
            let is_named = left_out.contains(&part.name());
            // Widths that are lost are not named twice.
            let is_named =
                is_named || part == Attribute::WidthsAlong && left_out.contains(&Attribute::Widths.name());
            assert_eq!(agree(part, &whole, &read), !is_named, ".{}: {}", format.ending, part.name());
        }
    }
}

#[test]
fn thinning_and_resampling_keep_what_strands_have() {
    let whole = everything();
    let thin = whole.kept(|strand| strand != 1);
    assert_eq!(thin.groups.as_deref(), Some(&[7, 2, 0, 2][..]));
    assert_eq!(thin.guide_flags.as_deref(), Some(&[true, true, false, true][..]));
    assert_eq!(thin.group_names, whole.group_names);
    // Strands 0, 2 and 4 are 0, 1 and 3 now.
    assert_eq!(thin.influences.as_ref().unwrap().guides()[..3], [0, 1, 3]);
    let fine = whole.resampled(7).unwrap();
    // Every second point is an old one.
    let (widths, colors) = (whole.point_widths().collect::<Vec<_>>(), whole.colors.as_ref().unwrap());
    for point in 0..4 {
        assert!((fine.widths.at(0, 2 * point) - widths[point]).abs() < 1e-10);
        let (found, own) = (fine.colors.as_ref().unwrap()[2 * point], colors[point]);
        // Rounding of arc lengths.
        assert!((Vec3::from(found) - Vec3::from(own)).length() < 1e-5, "{point}: {found:?} {own:?}");
    }
    assert_eq!((fine.influences, fine.groups), (whole.influences, whole.groups));
}

#[test]
fn files_of_parts_become_groups_of_one_groom() {
    let folder = tempfile::tempdir().unwrap();
    let mut one = Groom::empty(1e-4);
    one.push([Vec3::ZERO, Vec3::Y * 0.1]);
    let mut two = Groom::empty(2e-4);
    two.push([Vec3::X * 0.1, Vec3::ONE * 0.1]);
    let paths = ["back", "fringe"].map(|name| folder.path().join(format!("{name}.tfx")));
    one.save(&paths[0]).unwrap();
    two.save(&paths[1]).unwrap();
    let project = folder.path().join("head.tfxproj");
    let text =
        "version 3.0\nback.tfx 4 0.4 5.0 back.tfxsim the-back # a part\nfringe.tfx\nhairColor 1 0.5 0\n";
    std::fs::write(&project, text).unwrap();
    let whole = load(&project, &as_it_is()).unwrap().groom;
    assert_eq!(whole.starts, [0, 4, 8], "strands of two points are written with four");
    assert_eq!(whole.groups, Some(vec![0, 1]));
    assert_eq!(whole.group_names[&0], "the-back");
    assert_eq!(whole.group_names[&1], "fringe");
    assert!(whole.root_widths().eq([1e-4, 2e-4]));
    let color = whole.colors.as_ref().unwrap()[3];
    // The light of half a step of the screen [IEC 61966-2-1].
    assert!(color[0] == 1.0 && (color[1] - 0.214_04).abs() < 1e-4 && color[2] == 0.0, "{color:?}");
    let both = load_all(&paths, &as_it_is()).unwrap().groom;
    assert_eq!(both.points, whole.points);
    // Files with groups and guides of their own keep them.
    let parts = ["all", "more"].map(|name| folder.path().join(format!("{name}.npz")));
    parts.iter().for_each(|path| drop(everything().save(path).unwrap()));
    let both = load_all(&[&parts[..], &paths[..1]].concat(), &as_it_is()).unwrap().groom;
    assert_eq!(both.groups.as_deref(), Some(&[2, 2, 1, 0, 1, 5, 5, 4, 3, 4, 6][..]));
    let names: Vec<_> = both.group_names.values().map(String::as_str).collect();
    assert_eq!(names, ["all 0", "tail", "left fringe", "more 0", "tail", "left fringe", "back"]);
    let both = load_all(&parts, &as_it_is()).unwrap().groom;
    let of = |strand| both.influences.as_ref().unwrap().of(strand).collect::<Vec<_>>();
    assert!((0..5).all(|strand| {
        of(strand + 5).iter().zip(of(strand)).all(|(two, one)| *two == (one.0 + 5, one.1))
    }));
    std::fs::write(&project, "../back.tfx\n").unwrap();
    refused(load(&project, &as_it_is()), &["`../back.tfx` in line 1", "folder of the project"]);
    std::fs::write(&project, "version 3.0\n").unwrap();
    refused(load(&project, &as_it_is()), &["no line that names a .tfx file"]);
    refused(everything().save(&project), &[".tfxproj files are read, not written", ".ply"]);
}

fn refused(result: Result<impl std::fmt::Debug, GroomError>, words: &[&str]) {
    let text = result.expect_err("must be refused").to_string();
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

#[test]
fn sizes_that_no_file_has_are_refused_before_memory_is_taken() {
    refused(data::read(&words(&[u32::MAX]), None), &["4294967295 strands at byte 0"]);
    refused(data::read(&words(&[8_000_000, 2]), None), &["8 bytes", "8000000 x 4 bytes of counts"]);
    refused(data::read(&words(&[1, u32::MAX]), None), &["4294967295 points of a strand at byte 4"]);
    refused(data::read(&words(&[1, 4096]), None), &["4096 x 12 bytes of points"]);
    refused(data::read(&words(&[1, 1, 0, 0, 0, 9]), None), &["24 bytes", "20 bytes for 1 strands"]);
    refused(bin::read(&words(&[1, 2]), None), &["2 x 28 bytes of points"]);
    let header = |text: &str| {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.bytes());
        bytes
    };
    let array =
        |shape: &str| header(&format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}"));
    refused(npy::read(&array("(4000000000, 4000000000, 3)"), None), &["0 bytes behind the header"]);
    refused(npy::read(&array("(8000000, 4096, 3)"), None), &["0 bytes behind"]);
    refused(npy::read(&array("(0, 4, 3)"), None), &["0 strands of 4 points"]);
    refused(npy::read(&header("{'descr': '<c8', 'shape': (1, 2, 3)}"), None), &["type `<c8`", "big-endian"]);
    refused(npy::read(b"\x93NUMPY\x02\x00\xff\xff\xff\xff", None), &["a header of 4294967295 bytes"]);
    let vertices = |count: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\nend_header\n"
        )
    };
    refused(ply::read(vertices("4000000000").as_bytes(), Some(2)), &["4000000000 rows of 4 bytes"]);
    refused(ply::read(vertices("18446744073709551615").as_bytes(), Some(2)), &["rows of 4 bytes"]);
    refused(ply::read(vertices("-1").as_bytes(), None), &["`element vertex -1` in the header"]);
    refused(obj::read(b"v 0 0 0\nl 1 2\n"), &["`l 1 2` in line 2", "vertices 1 to 1"]);
    refused(obj::read(b"v 0 0\n"), &["three coordinates"]);
    refused(obj::read(b"v 0 0 0\nf 1 1 1\n"), &["no line (`l`)", "--body"]);
}

/// An archive of one deflated file: `packed` bytes that claim to be `size` when unpacked.
fn archive(size: u32, packed: usize) -> Vec<u8> {
    let name = b"points.npy";
    let head = [&words(&[20, 0x21_0000 << 8 >> 8, 0])[..2], &[0, 0, 8, 0, 0, 0, 33, 0]].concat();
    let sizes = words(&[0, packed as u32, size, name.len() as u32]);
    let mut stored = vec![0; packed];
    // The last block of the data, and nothing in it.
    stored[0] = 3;
    let mut bytes = [&words(&[0x0403_4b50])[..], &head, &sizes, name, &stored].concat();
    let list = bytes.len() as u32;
    bytes.extend(words(&[0x0201_4b50]));
    bytes.extend([20, 0]);
    bytes.extend([&head[..], &sizes, &[0; 14], name].concat());
    let length = bytes.len() as u32 - list;
    bytes.extend(words(&[0x0605_4b50, 0, 0x1_0001, length, list]));
    bytes.extend([0, 0]);
    bytes
}

#[test]
fn archives_that_would_unpack_to_more_than_they_can_are_refused() {
    refused(
        npz::read(&archive(u32::MAX - 1, 4), None),
        &["points.npy: 4294967294 bytes in 4 deflated ones", "no more than the format packs"],
    );
    refused(
        npz::read(&archive(64 << 20, 100_000), None),
        &["arrays of 67108864 bytes in an archive of 1001", "at most"],
    );
    // Not too large, and absent.
    refused(npz::read(&archive(1 << 20, 2000), None), &["points holds fewer bytes than its size"]);
    refused(npz::read(b"PK\x03\x04 and no directory", None), &["no directory at the end"]);
    let mut good = npz::write(&everything()).unwrap();
    assert!(npz::read(&good, None).is_ok());
    // A coordinate: the header of the first array ends before byte 200.
    good[200] ^= 1;
    refused(npz::read(&good, None), &["is damaged", "checksum"]);
}

#[test]
fn bare_points_need_the_points_of_a_strand() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                end_header\n0 0 0\n0 1 0\n1 0 0\n1 1.5 0\n";
    refused(ply::read(text.as_bytes(), None), &["4 vertices and nothing that joins them", "--per-strand N"]);
    refused(ply::read(text.as_bytes(), Some(3)), &["4 points", "a multiple of 3"]);
    let groom = ply::read(text.as_bytes(), Some(2)).unwrap().groom;
    assert_eq!((groom.starts, groom.points[3]), (vec![0, 2, 4], Vec3::new(1.0, 1.5, 0.0)));
    // Two strands along edges, the second listed before the first; bytes of colours.
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                property uchar red\nproperty uchar green\nproperty uchar blue\nelement strand 2\n\
                property ushort nsegs\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n\
                0 0 0 255 0 0\n0 1 0 0 255 0\n1 0 0 0 0 255\n1 1 0 0 0 0\n1 1\n2 3\n0 1\n";
    let groom = ply::read(text.as_bytes(), None).unwrap().groom;
    assert_eq!(groom.points[..2], [Vec3::X, Vec3::new(1.0, 1.0, 0.0)]);
    assert_eq!(groom.colors.unwrap()[2], [1.0, 0.0, 0.0]);
}

#[test]
fn lines_of_an_obj_file_are_strands_and_names_are_groups() {
    let text = "# made by hand\nv 0 0 0\nv 0 1 0\nl 1 2\ng side hair\nv 1 0 0\nv 1 1 0\nl -2 -1\n";
    let groom = obj::read(text.as_bytes()).unwrap().groom;
    assert_eq!((groom.starts, groom.groups), (vec![0, 2, 4], Some(vec![0, 1])));
    assert_eq!(groom.group_names[&1], "side hair");
    let plain = obj::read(b"v 0 0 0\nv 0 1 0\nl 1 2\n").unwrap().groom;
    assert_eq!((plain.groups, plain.colors), (None, None));
}

/// Files that NumPy wrote: seeds of the fuzz targets.
#[test]
fn arrays_of_numpy_are_read() {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/seeds"));
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let deflated = npz::read(&read("npz/deflated"), None).unwrap().groom;
    assert_eq!((deflated.strand_count(), deflated.points.len()), (3, 15));
    assert_eq!(deflated.points[7], Vec3::new(2.1, 2.2, 2.3));
    assert_eq!(deflated.root_uvs.unwrap()[2], Vec2::new(0.5, 0.25));
    assert_eq!(deflated.groups, Some(vec![1, 1, 4]));
    assert_eq!(deflated.group_names[&4], "tail");
    let cache = npz::read(&read("npz/cache"), None).unwrap();
    assert_eq!(cache.problems, ["it holds 2 frames: the strands of the first are taken"]);
    assert_eq!(cache.groom.starts, [0, 2, 5]);
    let double = npy::read(&read("npy/double"), None).unwrap().groom;
    assert_eq!((double.strand_count(), double.points[1]), (2, Vec3::new(0.3, 0.4, 0.5)));
}
