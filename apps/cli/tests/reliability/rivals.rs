//! Two runs on one target.

use super::*;

/// Pairs of runs that begin at once.
const PAIRS: usize = 30;

fn both(folder: &Path, commands: [&[&str]; 2]) -> [Output; 2] {
    let begin = |arguments: &[&str]| {
        strandline(folder, arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let children = commands.map(begin);
    children.map(|child| child.wait_with_output().unwrap())
}

#[test]
fn grooms_that_share_a_stem_or_a_name_are_not_mixed() {
    let folder = folder();
    let at = folder.path();
    works(at, &["groom", "--style", "bob", "--strands", "300", "--out", "bob.hair"]);
    works(at, &["groom", "--style", "pixie", "--strands", "200", "--out", "pixie.hair"]);
    let strands = |name: &str| strandline::Groom::load(at.join(name)).unwrap().strand_count();
    std::fs::write(at.join("q.part"), b"notes").unwrap();
    for _ in 0..PAIRS {
        for output in both(at, [&["convert", "bob.hair", "q.hair"], &["convert", "pixie.hair", "q.tfx"]]) {
            assert!(output.status.success(), "{}", error(&output));
        }
        assert_eq!((strands("q.hair"), strands("q.tfx")), (300, 200));
    }
    for _ in 0..PAIRS {
        for output in both(at, [&["convert", "bob.hair", "r.hair"], &["convert", "pixie.hair", "r.hair"]]) {
            assert!(output.status.success(), "{}", error(&output));
        }
        assert!([300, 200].contains(&strands("r.hair")), "one of both, whole");
    }
    assert_eq!(std::fs::read(at.join("q.part")).unwrap(), b"notes");
    assert_eq!(names(at), ["bob.hair", "pixie.hair", "q.hair", "q.part", "q.tfx", "r.hair", "small.toml"]);
}

#[test]
fn of_two_films_in_one_folder_the_second_is_refused() {
    let folder = folder();
    let out = folder.path().join("out");
    let render = ["render", "--scene", "small.toml", "--out", "out", "--frames", "400"];
    let mut first = strandline(folder.path(), &render).stdout(Stdio::null()).spawn().unwrap();
    wait_until("a frame", || out.join("frame_0000.png").exists());
    let second = run(folder.path(), &["render", "--scene", "small.toml", "--out", "out"]);
    let error = error(&second);
    assert_eq!(second.status.code(), Some(1), "{error}");
    assert!(error.contains("another run is writing a film there") && error.contains("out"), "{error}");
    // One that was killed leaves the folder free.
    first.kill().unwrap();
    first.wait().unwrap();
    works(folder.path(), &["render", "--scene", "small.toml", "--out", "out"]);
    assert!(names(&out).iter().all(|name| name.ends_with(".png") || moving(&out).unwrap().ends_with(name)));
    check_whole(&out);
    let mut refused = 0;
    for _ in 0..4 {
        let render = ["render", "--scene", "small.toml", "--out", "pair"];
        let codes = both(folder.path(), [&render, &render]).map(|output| output.status.code().unwrap());
        assert!(codes.contains(&0) && codes.iter().all(|code| [0, 1].contains(code)), "{codes:?}");
        refused += usize::from(codes.contains(&1));
        assert_eq!(names(&folder.path().join("pair")).len(), 4 + 2);
        check_whole(&folder.path().join("pair"));
    }
    // On a busy machine one may be over before the other begins, but not each time.
    assert!(refused > 0, "no run met the other");
}

#[test]
fn a_shorter_film_says_which_frames_are_of_the_longer_one_before() {
    let folder = folder();
    works(folder.path(), &["render", "--scene", "small.toml", "--out", "out"]);
    let output = run(folder.path(), &["render", "--scene", "small.toml", "--out", "out", "--frames", "2"]);
    assert!(error(&output).contains("of an earlier film there are still frame_0002.png and frame_0003.png"));
}

#[test]
fn of_two_runs_that_write_one_cache_the_second_is_refused() {
    let folder = folder();
    let sim = ["sim", "--scene", "small.toml", "--frames", "4000", "--out", "a.npz"];
    let mut first =
        strandline(folder.path(), &sim).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_until("a cache", || folder.path().join("a.npz").exists());
    let second = run(folder.path(), &["sim", "--scene", "small.toml", "--out", "a.npz"]);
    let error = error(&second);
    assert_eq!(second.status.code(), Some(1), "{error}");
    assert!(
        error.contains("another run is writing that file") && error.trim_end().ends_with("a.npz"),
        "{error}"
    );
    first.kill().unwrap();
    first.wait().unwrap();
    // Of the one that was killed everything stays until another is finished.
    let before = strandline::Cache::open(&folder.path().join("a.npz")).unwrap().len();
    assert!(before > 0);
    works(folder.path(), &["sim", "--scene", "small.toml", "--out", "a.npz"]);
    assert_eq!(names(folder.path()), ["a.npz", "small.toml"]);
}
