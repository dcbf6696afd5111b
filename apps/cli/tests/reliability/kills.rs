//! Runs that are ended at random times.

use super::*;

/// Times that each command is ended, unless the environment's `STRANDLINE_KILLS` says another number
/// (`cargo xtask long` does).
const KILLS: usize = 8;
/// Times that a command is ended at most, in multiples of the number above: on a busy machine many are late.
const PATIENCE: usize = 4;
/// Number of runs that are killed before one may finish and clear up.
const BETWEEN: usize = 8;
/// Names and numbers of the signals, in turn.
const SIGNALS: [(&str, i32); 4] = [("INT", 2), ("TERM", 15), ("KILL", 9), ("HUP", 1)];

/// Ends a command at random times of its run. Files are whole after each; after a run that finishes the folder
/// holds what it should and nothing else.
fn end_often(arguments: &[&str], prepare: &[&[&str]], wanted: &[&str], in_folder: &str) {
    let folder = folder();
    prepare.iter().for_each(|arguments| works(folder.path(), arguments));
    let target = folder.path().join(in_folder);
    let begin = Instant::now();
    works(folder.path(), arguments);
    let whole = begin.elapsed();
    // The moving picture is a video or an animated image, as the machine has it.
    let mut wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
    wanted.extend(moving(&target).and_then(|path| Some(path.file_name()?.to_str()?.to_owned())));
    wanted.sort();
    assert_eq!(names(&target), wanted);
    let mut random = strandline::math::Random::new(7, 0);
    let kills = std::env::var("STRANDLINE_KILLS").map_or(KILLS, |text| text.parse().unwrap());
    let mut ended = [0; SIGNALS.len()];
    // A test that ends nothing finds nothing. A signal that may be heeded later may find the run over, so that
    // only those that nobody heeds are counted by themselves.
    let enough = |ended: [usize; SIGNALS.len()]| {
        let [.., killed, _] = ended;
        ended.iter().sum::<usize>() > kills / 5 && killed > kills / SIGNALS.len() / 5
    };
    for kill in 0..PATIENCE * kills {
        if kill >= kills && enough(ended) {
            break;
        }
        let (name, number) = SIGNALS[kill % SIGNALS.len()];
        let mut command = heeding(folder.path(), arguments);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(whole.mul_f32(random.unit()));
        send(name, child.id());
        wait_until("ended", || child.try_wait().unwrap().is_some());
        let output = child.wait_with_output().unwrap();
        assert!(ended_by(output.status, number), "{name}: {:?}: {}", output.status, error(&output));
        assert!(!error(&output).contains("panicked"), "{}", error(&output));
        ended[kill % SIGNALS.len()] += usize::from(!output.status.success());
        check_whole(&target);
        if kill % BETWEEN == BETWEEN - 1 || kill + 1 == kills {
            works(folder.path(), arguments);
            assert_eq!(names(&target), wanted, "after {name}");
            check_whole(&target);
        }
    }
    assert!(enough(ended), "{arguments:?}: {SIGNALS:?} ended {ended:?} runs");
}

#[test]
fn render_leaves_whole_files() {
    let frames = ["frame_0000.png", "frame_0001.png", "frame_0002.png", "frame_0003.png", "sheet.png"];
    end_often(&["render", "--scene", "small.toml", "--out", "out"], &[], &frames, "out");
}

#[test]
fn convert_leaves_whole_files() {
    let grow = ["groom", "--style", "bob", "--strands", "4000", "--out", "a.hair"];
    end_often(
        &["convert", "a.hair", "b.tfx", "--points", "40"],
        &[&grow],
        &["a.hair", "b.tfx", "small.toml"],
        "",
    );
}

#[test]
fn groom_leaves_whole_files() {
    let grow = ["groom", "--style", "bob", "--strands", "4000", "--out", "a.hair"];
    end_often(&grow, &[], &["a.hair", "small.toml"], "");
}

#[test]
fn sim_leaves_nothing() {
    end_often(&["sim", "--scene", "small.toml"], &[], &["small.toml"], "");
}

#[test]
fn sim_leaves_whole_caches() {
    end_often(
        &["sim", "--scene", "small.toml", "--out", "a.npz", "--frames", "12"],
        &[],
        &["a.npz", "small.toml"],
        "",
    );
}

#[test]
fn sim_leaves_whole_usd() {
    end_often(&["sim", "--scene", "small.toml", "--out", "a.usda"], &[], &["a.usda", "small.toml"], "");
}

/// Whatever ends it, a run that writes a cache leaves what was done, and resumes from there to the same bytes.
#[test]
fn a_cache_is_gone_on_from_whatever_ended_its_run() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let sim = |out| ["sim", "--scene", "small.toml", "--frames", "360", "--out", out];
    let begin = Instant::now();
    works(folder.path(), &sim("whole.npz"));
    let whole_time = begin.elapsed();
    let whole = std::fs::read(at("whole.npz")).unwrap();
    let mut random = strandline::math::Random::new(3, 0);
    let (mut short, mut frames) = (0, Vec::new());
    for turn in 0..13 {
        let (name, number) = SIGNALS[turn % SIGNALS.len()];
        let mut child = heeding(folder.path(), &sim("part.npz"))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until("a cache", || at("part.npz").exists());
        // The first requests come before the first frame, the last about the end, the others at some time: a
        // faster machine is no reason to be late.
        let share = match turn {
            0..4 if name != "KILL" => 0.0,
            0..9 => 0.6 * random.unit(),
            _ => 0.9 + 0.15 * random.unit(),
        };
        std::thread::sleep(whole_time.mul_f32(share));
        send(name, child.id());
        wait_until("ended", || child.try_wait().unwrap().is_some());
        let output = child.wait_with_output().unwrap();
        assert!(ended_by(output.status, number), "{name}: {:?}: {}", output.status, error(&output));
        let was_ended = !output.status.success();
        let cache = strandline::Cache::open(&at("part.npz")).unwrap();
        assert!(!cache.is_empty() && is_whole(&at("part.npz")), "{name}");
        frames.push(cache.len());
        if was_ended && name != "KILL" {
            let words = format!("the {} frames so far are whole", cache.len());
            assert!(error(&output).contains(&words), "{name}: {}", error(&output));
        }
        // A run that ends between its last frame and its exit has nothing left to resume.
        let is_short = was_ended && cache.len() < 360;
        drop(cache);
        if is_short {
            short += 1;
            works(folder.path(), &["sim", "--resume", "part.npz", "--out", "rest.npz"]);
            assert!(std::fs::read(at("rest.npz")).unwrap() == whole, "after {name}, {frames:?}");
            // Into the file itself, too.
            works(folder.path(), &["sim", "--resume", "part.npz"]);
            assert!(std::fs::read(at("part.npz")).unwrap() == whole, "after {name}, {frames:?}");
        }
        std::fs::remove_file(at("part.npz")).unwrap();
    }
    assert!(short > 3, "only {short} runs were ended: {frames:?}");
    let left = names(folder.path());
    assert!(left.iter().all(|name| !name.contains("unfinished")), "{left:?}");
}

/// Stops a film after some frames; returns what it says.
fn stop(folder: &Path, signal: &str, code: i32) -> String {
    let child = heeding(folder, &["render", "--scene", "small.toml", "--out", "out", "--frames", "400"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until("three frames", || {
        let frames = names(&folder.join("out"));
        frames.contains(&"frame_0002.png".to_owned()) && frames.contains(&".strandline-lock".to_owned())
    });
    send(signal, child.id());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(code), "{}", error(&output));
    error(&output)
}

/// Signals that let a film be closed, and the codes that it then ends with.
const STOPS: [(&str, i32); if cfg!(target_os = "linux") { 3 } else { 2 }] = [
    ("INT", 130),
    ("TERM", 143),
    #[cfg(target_os = "linux")]
    ("HUP", 129),
];

#[test]
fn a_film_that_is_stopped_is_closed_and_says_how_far_it_came() {
    let folder = folder();
    let out = folder.path().join("out");
    for (signal, code) in STOPS {
        let error = stop(folder.path(), signal, code);
        for words in ["stopping after this frame", "of 400 frames", "frames already written are whole"] {
            assert!(error.contains(words), "`{words}` is missing: {error}");
        }
        check_whole(&out);
        let left: Vec<_> = names(&out).into_iter().filter(|name| !name.starts_with("frame_")).collect();
        assert_eq!(left, [moving(&out).unwrap().file_name().unwrap().to_str().unwrap()]);
        std::fs::remove_dir_all(&out).unwrap();
    }
    // A whole film of an earlier run is not replaced by a short one.
    works(folder.path(), &["render", "--scene", "small.toml", "--out", "out", "--frames", "2"]);
    let former = std::fs::read(moving(&out).unwrap()).unwrap();
    stop(folder.path(), "INT", 130);
    assert_eq!(std::fs::read(moving(&out).unwrap()).unwrap(), former);
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_that_ignores_a_closed_terminal_from_its_beginning_goes_on() {
    let folder = folder();
    let out = folder.path().join("out");
    let child = Command::new("sh")
        .args(["-c", "trap '' HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_strandline")])
        .args(["render", "--scene", "small.toml", "--out", "out", "--frames", "6"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until("a frame", || out.join("frame_0000.png").exists());
    send("HUP", child.id());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{:?}: {}", output.status, error(&output));
    assert!(!error(&output).contains("stopping"), "{}", error(&output));
    assert!(out.join("frame_0005.png").exists());
    check_whole(&out);
}
