//! `arm plot`.

use std::path::Path;

use serde_json::Value;
use service::exit::Exit;

use super::{Ended, ROOT, run};

fn plot(words: &[&str]) -> Ended {
    run(&[&["arm", "plot"], words].concat())
}

#[test]
fn arm_plot_draws_a_pick() {
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("pick.svg").to_str().unwrap().to_owned();
    let out = plot(&["--object", "metal", "--width", "800", "--out", &svg]).succeeded();
    let output = String::from_utf8(out).unwrap();
    assert!(output.contains("the left limb fetches metal in"), "{output}");
    let text = std::fs::read_to_string(&svg).unwrap();
    for part in ["approach", "return", "metal2", "joint speed", "seconds", "w2", "gripper"] {
        assert!(text.contains(part), "{part}");
    }
    // Seven joints in two panels, six objects and the gripper in two.
    assert!(text.matches("<polyline").count() >= 2 * 7 + 2 * 7);
    let width = text.split("width=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
    assert!((780..=820).contains(&width.parse().unwrap()), "{width}");
}

#[test]
fn arm_plot_draws_a_single_arm_with_six_joints() {
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("pick.svg").to_str().unwrap().to_owned();
    let single = ["--profile", "ur5e", "--object", "green_large", "--limb", "arm"];
    let out = plot(&[&single[..], &["--width", "800", "--out", &svg]].concat()).succeeded();
    let output = String::from_utf8(out).unwrap();
    assert!(output.contains("the arm limb fetches green_large in"), "{output}");
    let text = std::fs::read_to_string(&svg).unwrap();
    // Six joints in two panels, eight objects and the gripper in two.
    assert!(text.matches("<polyline").count() >= 2 * 6 + 2 * 9);
    assert!(text.contains("wrist_3_joint"));
    let what = "--limb: expected one of arm, auto, found `left`";
    plot(&[&single[..5], &["left"]].concat()).failed(Exit::Usage, what);
}

#[test]
fn arm_plot_prints_the_stages_as_json() {
    let run = |words: &[&str]| -> Value {
        let out = plot(&[&["--json"], words].concat()).succeeded();
        serde_json::from_slice(&out).unwrap()
    };
    let output = run(&["--scene", "markers"]);
    let stages = output["stages"].as_array().unwrap();
    let names: Vec<_> = stages.iter().map(|stage| stage["phase"].as_str().unwrap()).collect();
    assert_eq!(names, ["approach", "close", "lift", "hand_over", "release", "raise", "return"]);
    let seconds: f64 = stages.iter().map(|stage| stage["seconds"].as_f64().unwrap()).sum();
    assert!((seconds - output["seconds"].as_f64().unwrap()).abs() < 1e-9);
    assert_eq!(run(&["--object", "white"])["limb"], "right");
    assert_eq!(run(&["--object", "white2", "--limb", "left"])["limb"], "left");
}

#[test]
fn arm_plot_prints_samples_from_which_the_plan_can_be_carried_out() {
    let out = plot(&["--json", "--samples-hz", "50", "--object", "metal2"]).succeeded();
    let output: Value = serde_json::from_slice(&out).unwrap();
    let samples = output["samples"].as_array().unwrap();
    let seconds = output["seconds"].as_f64().unwrap();
    assert_eq!(samples.len(), (50.0 * seconds).ceil() as usize + 1);
    assert_eq!(samples[samples.len() - 1]["t_s"].as_f64(), Some(seconds));
    assert_eq!(output["joints"][6], "right_w2");
    assert_eq!(output["object_in_gripper"].as_array().unwrap().len(), 7);
    let number = |sample: &Value, key: &str, joint: usize| sample[key][joint].as_f64().unwrap();
    for pair in samples.windows(2) {
        let dt = pair[1]["t_s"].as_f64().unwrap() - pair[0]["t_s"].as_f64().unwrap();
        for joint in 0..7 {
            let moved = number(&pair[1], "q", joint) - number(&pair[0], "q", joint);
            let mean = 0.5 * (number(&pair[1], "qd", joint) + number(&pair[0], "qd", joint));
            assert!((moved - mean * dt).abs() < 1e-4, "{joint}: {pair:?}");
        }
    }
    let held = samples.iter().filter(|sample| sample["held"] == "metal2");
    let widths: Vec<f64> = held.map(|sample| sample["width_m"].as_f64().unwrap()).collect();
    assert!(!widths.is_empty() && widths.iter().all(|width| (width - 0.004).abs() < 1e-9));
    assert!(samples[0]["held"].is_null() && samples[samples.len() - 1]["held"].is_null());
}

#[test]
fn arm_plot_rejects_invalid_input_with_help() {
    let cases: [(&[&str], Exit, &str); 8] = [
        (&["--samples-hz", "100"], Exit::Usage, "add --json"),
        (&["--samples-hz", "0"], Exit::Usage, "from 1 to 1000"),
        (&["--object", "cup"], Exit::Config, "white, white2, white3, metal, metal2, clear"),
        (&["--object", "white", "--limb", "left"], Exit::Config, "--limb auto"),
        (&["--out", "pick.png"], Exit::Usage, "end its name with .svg"),
        (&["--scene", "attic"], Exit::Config, "name a scene file"),
        (&["--width", "40"], Exit::Usage, "800 to 4000"),
        (&["--out", "/dev/null/pick.svg"], Exit::Storage, "/dev/null/pick.svg"),
    ];
    for (words, exit, part) in cases {
        plot(words).failed(exit, part);
    }
    assert!(!Path::new(ROOT).join("pick.svg").exists());
}
