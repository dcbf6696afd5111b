//! Several files as one groom.

use glam::Vec3;
use strandline_groom::Groom;
use strandline_groom::format::{LoadOptions, load_all};

#[test]
fn strands_of_several_files_are_named_with_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut lawn = Groom::empty(1e-4);
    for strand in 0..40 {
        let root = Vec3::new(0.01 * (strand % 8) as f32, 0.0, 0.01 * (strand / 8) as f32);
        lawn.push([root, root + 0.1 * Vec3::Y, root + 0.2 * Vec3::Y]);
    }
    let paths = ["one", "two", "three"].map(|name| folder.path().join(format!("{name}.npz")));
    paths.iter().for_each(|path| drop(lawn.save(path).unwrap()));
    let whole = load_all(&paths, &LoadOptions::default()).unwrap();
    assert_eq!(whole.report.problems, Vec::<String>::new());
    assert_eq!([39, 40, 119].map(|strand| whole.groom.number(strand)), [39, 0, 39]);
    assert_eq!(whole.groom.select(&[100, 3]).number(0), 20, "a strand that is chosen keeps its number");
    // A strand without length and one far from all others.
    let mut two = lawn.clone();
    let empty = two.range(7);
    two.points[empty].fill(Vec3::ZERO);
    two.save(&paths[1]).unwrap();
    let mut three = lawn;
    three.points[3 * 9..][..3].iter_mut().for_each(|point| *point += 99.0 * Vec3::X);
    three.save(&paths[2]).unwrap();
    let error = load_all(&paths, &LoadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("strand 7 has no length") && error.ends_with("two.npz"), "{error}");
    let lenient = LoadOptions { strict: false, ..LoadOptions::default() };
    let whole = load_all(&paths, &lenient).unwrap();
    let [empty, far] = &whole.report.problems[..] else { panic!("{:?}", whole.report.problems) };
    assert!(empty.ends_with(&format!("it is [7 of {}]", paths[1].display())), "{empty}");
    assert!(far.contains(&format!("the first is 9 of {}: ", paths[2].display())), "{far}");
    let mut whole = whole.groom;
    assert_eq!([46, 47, 79].map(|strand| whole.number(strand)), [6, 8, 0], "one is left out");
    whole.append(whole.clone());
    assert_eq!([47, 79, 119 + 79].map(|strand| whole.number(strand)), [8, 0, 0], "numbers stay");
}
