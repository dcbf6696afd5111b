//! Motion in the report of `sim --json`, compared with the hair that the same run wrote.

use std::path::Path;
use std::process::Command;

use glam::Vec3;
use strandline::format::{self, LoadOptions, Scale};

/// Standard output of a run that ends well.
fn works(folder: &Path, arguments: &[&str]) -> String {
    let program = env!("CARGO_BIN_EXE_strandline");
    let output = Command::new(program).args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Positions of guides after each step, shape `[step][strand][point]` \[m\], and the report of the run of these
/// steps.
fn moved(folder: &Path, rest: &str, steps: usize) -> (Vec<Vec<Vec<Vec3>>>, serde_json::Value) {
    let scene = format!(
        "[style]\nstyle = \"wavy\"\nstrand_count = 16\n[motion]\nname = \"still\"\n[simulation.volume]\nenabled = false\n\
         [simulation.strands.rods]\nrest = \"{rest}\"\n[film]\nframes_per_second = 60.0\nsettle = 0.0\n"
    );
    std::fs::write(folder.join("moved.toml"), scene).unwrap();
    // A frame is a step long and shows the state after it.
    let count = steps.to_string();
    let run = ["sim", "--scene", "moved.toml", "--backend", "cpu", "--json", "--frames", &count];
    let report = works(folder, &[&run[..], &["--out", "%04d.hair"]].concat());
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["steps"], steps);
    let options = LoadOptions { scale: Scale::Factor(1.0), ..LoadOptions::default() };
    let frame = |index: usize| {
        let groom = format::load(&folder.join(format!("{index:04}.hair")), &options).unwrap().groom;
        (0..groom.strand_count()).map(|strand| groom.points[groom.range(strand)].to_vec()).collect()
    };
    ((0..steps).map(frame).collect(), report)
}

/// Mean and most of some numbers.
fn mean_and_most(numbers: impl Iterator<Item = f32>) -> [f64; 2] {
    let numbers: Vec<f64> = numbers.map(f64::from).collect();
    [numbers.iter().sum::<f64>() / numbers.len() as f64, numbers.iter().copied().fold(0.0, f64::max)]
}

#[test]
fn sim_tells_how_far_and_how_fast_hair_moved() {
    let folder = tempfile::tempdir().unwrap();
    let reported = |report: &serde_json::Value, key: &str| {
        ["mean", "max"].map(|part| report[key][part].as_f64().unwrap())
    };
    let (rest, still) = moved(folder.path(), "sag_free", 3);
    assert_eq!(reported(&still, "drift"), [0.0; 2]);
    // Length added below the root.
    assert!(reported(&still, "speed").iter().all(|speed| *speed < 1e-12), "{still}");
    assert!(still["stiffened"].as_u64().unwrap() > 0 && still["stiffest"].as_f64().unwrap() > 1.0);
    // Hair without a load in its shape falls; a step is a frame, the last second is looked at.
    let (states, fallen) = moved(folder.path(), "unstressed", 90);
    assert_eq!((fallen["stiffened"].as_u64(), fallen["stiffest"].as_f64()), (Some(0), Some(1.0)));
    let length =
        |strand: &Vec<Vec3>| -> f32 { strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum() };
    let ways = |from: &[Vec<Vec3>], to: &[Vec<Vec3>], over: &dyn Fn(&Vec<Vec3>) -> f32| -> Vec<f32> {
        let strands = from.iter().zip(to);
        let way = |(one, other): (&Vec<Vec3>, &Vec<Vec3>)| -> Vec<f32> {
            let size = over(one);
            one.iter().zip(other).map(|(one, other)| one.distance(*other) / size).collect()
        };
        strands.flat_map(way).collect()
    };
    let drift = mean_and_most(ways(&rest[0], &states[89], &length).into_iter());
    let per_step = |_: &Vec<Vec3>| 1.0 / 60.0;
    let steps = states[29..].windows(2).flat_map(|pair| ways(&pair[0], &pair[1], &per_step));
    let speed = mean_and_most(steps);
    for (found, told) in [(drift, reported(&fallen, "drift")), (speed, reported(&fallen, "speed"))] {
        for (found, told) in found.into_iter().zip(told) {
            assert!(found > 1e-3 && (found - told).abs() < 1e-5, "{found} is told as {told}");
        }
    }
}

#[test]
fn sim_tells_how_many_strands_are_stiffer_than_their_material() {
    let folder = tempfile::tempdir().unwrap();
    let said = |rest: &str| {
        let scene = format!(
            "[style]\nstyle = \"wavy\"\nstrand_count = 16\n[simulation.volume]\nenabled = false\n\
             [simulation.strands.rods]\nrest = \"{rest}\"\n[film]\nsettle = 0.0\n"
        );
        std::fs::write(folder.path().join("stiff.toml"), scene).unwrap();
        let run = ["sim", "--scene", "stiff.toml", "--backend", "cpu", "--frames", "1"];
        let output = Command::new(env!("CARGO_BIN_EXE_strandline"))
            .args(run)
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    };
    let stiff = said("sag_free");
    let note = stiff.lines().find(|line| line.contains(" of 16 strands stiffer than their material, up to "));
    let most: f32 = note.unwrap().split("up to ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(most > 1.0, "{stiff}");
    assert!(!said("unstressed").contains("stiffer than their material"));
}
