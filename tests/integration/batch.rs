//! The batch verbs: the code of the services on lines of JSON.

use serde_json::{Value, json};
use std::process::Command;
use whichone_tests::{Ended, program, run};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn batch(words: &[&str], lines: &[Value]) -> Ended {
    let input: String = lines.iter().map(|line| format!("{line}\n")).collect();
    run(Command::new(program("whichone")).args(words).current_dir(ROOT), &input, 120.0)
}

fn outputs(ended: &Ended) -> Vec<Value> {
    ended.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn belief_reproduces_the_public_cases() {
    let text = std::fs::read_to_string(format!("{ROOT}/tests/fixtures/belief/cases_public.json"));
    let cases: Value = serde_json::from_str(&text.unwrap()).unwrap();
    let cases = cases["cases"].as_array().unwrap();
    let ended = batch(&["belief"], cases);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    for (case, output) in cases.iter().zip(outputs(&ended)) {
        assert_eq!(case["id"], output["id"]);
        for (object, expected) in case["expected"].as_object().unwrap() {
            let (found, expected) = (output["belief"][object].as_f64(), expected.as_f64());
            let error = (found.unwrap() - expected.unwrap()).abs();
            assert!(error < 1e-9, "{}: {object} is off by {error}", case["id"]);
        }
    }
}

#[test]
fn belief_reports_a_bad_line_and_continues() {
    let scene = json!({"objects": [{"name": "A", "attributes": {"color": "red"}},
                                   {"name": "B", "attributes": {"color": "blue"}}],
                       "values": {"color": ["red", "blue"]}});
    let good = json!({"id": "g", "scene": scene, "prior": "uniform",
                      "params": {"p_l": 0.95, "epsilon": 0.01, "alpha": 0.2},
                      "turns": [{"question": {"type": "none"}, "utterance": "blue"}]});
    let ended = batch(&["belief"], &[json!({"id": "b"}), good.clone(), json!(3), good]);
    assert_eq!(ended.code, Some(1));
    let outputs = outputs(&ended);
    assert_eq!((outputs[0]["line"].as_u64(), outputs[2]["line"].as_u64()), (Some(1), Some(3)));
    assert!(outputs[0]["error"].is_string());
    assert!((outputs[1]["belief"]["B"].as_f64().unwrap() - 6.0 / 7.0).abs() < 1e-12);
    assert_eq!(outputs[1], outputs[3]);
}

#[test]
fn ground_reads_synonyms_of_the_scene() {
    let question = json!({"type": "attr", "attribute": "color", "value": "white"});
    let line = json!({"id": 1, "text": "no, the see-through one", "last_question": question});
    let ended = batch(&["ground", "--scene", "config/scenes/bowls.toml"], &[line]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let output = &outputs(&ended)[0];
    assert_eq!((&output["base"], &output["response"]), (&json!(["clear"]), &json!("no")));
}

#[test]
fn plan_picks_when_certain_and_asks_otherwise() {
    let scene = ["--scene", "config/scenes/bowls.toml"];
    let lines = [
        json!({"id": 1, "belief": [0.995, 0.001, 0.001, 0.001, 0.001, 0.001]}),
        json!({"id": 2, "belief": vec![1.0 / 6.0; 6]}),
    ];
    let ended = batch(&[&["plan"], &scene[..]].concat(), &lines);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let outputs = outputs(&ended);
    assert_eq!(outputs[0]["action"], json!({"type": "pick", "object": "white"}));
    assert_eq!(outputs[1]["action"]["type"], "which");
    let ended = batch(&[&["plan", "--no-which"], &scene[..]].concat(), &lines[1..]);
    assert_eq!(self::outputs(&ended)[0]["action"]["type"], "attr");
}

#[test]
fn ik_inverts_fk() {
    let q = [0.1, -0.5, 0.2, 0.9, -0.1, 1.1, 0.3];
    let ended = batch(&["fk", "--limb", "left"], &[json!({"id": 7, "q": q})]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let gripper = outputs(&ended)[0]["links"]["left_gripper"].clone();
    let line = json!({"id": 7, "xyz": gripper["xyz"], "xyzw": gripper["xyzw"], "q_seed": q});
    let ended = batch(&["ik", "--limb", "left"], &[line]);
    let output = &outputs(&ended)[0];
    assert_eq!(output["ok"], true);
    assert!(output["position_error_m"].as_f64().unwrap() <= 1e-6);
    assert!(output["rotation_error_rad"].as_f64().unwrap() <= 1e-6);
}

#[test]
fn fk_and_ik_read_any_robot_description() {
    let robot = "tests/fixtures/robots/seven_joints.urdf";
    let line = json!({"id": "up", "q": [0, 0, 0, 0, 0, 0, 0]});
    let ended = batch(&["fk", "--robot", robot, "--tip", "flange"], std::slice::from_ref(&line));
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let links = outputs(&ended)[0]["links"].clone();
    let height = links["flange"]["xyz"][2].as_f64().unwrap();
    assert!((height - 1.306).abs() < 1e-12, "{links}");
    assert_eq!(links["flange"]["xyzw"], json!([0.0, 0.0, 0.0, 1.0]));
    assert_eq!(links.as_object().unwrap().keys().next().unwrap(), "world");
    // The built-in robot is the file that users edit.
    let built_in = batch(&["fk", "--limb", "right"], std::slice::from_ref(&line));
    let file = ["fk", "--robot", "config/robots/baxter.urdf", "--limb", "right"];
    assert_eq!(outputs(&built_in), outputs(&batch(&file, std::slice::from_ref(&line))));
    let line = json!({"id": 1, "xyz": [0.3, 0.2, 0.8], "xyzw": [0, 1, 0, 0]});
    let ended = batch(&["ik", "--robot", robot, "--tip", "flange"], std::slice::from_ref(&line));
    let solved = outputs(&ended)[0].clone();
    assert_eq!((ended.code, &solved["ok"]), (Some(0), &json!(true)), "{solved}");
    let back = batch(&["fk", "--robot", robot, "--tip", "flange"], &[json!({"q": solved["q"]})]);
    for i in 0..3 {
        let found = outputs(&back)[0]["links"]["flange"]["xyz"][i].as_f64().unwrap();
        assert!((found - line["xyz"][i].as_f64().unwrap()).abs() <= 1e-6);
    }
    // Any chain has forward kinematics; the inverse is that of five to seven joints.
    let three = json!({"id": "three", "q": [0, 0, 0]});
    let ended = batch(&["fk", "--robot", robot, "--tip", "link_3"], &[three]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let ended = batch(&["ik", "--robot", robot, "--tip", "link_3"], &[line]);
    assert_eq!(ended.code, Some(64), "{}", ended.stderr);
    assert!(ended.stderr.contains("hangs on 3 moving joints"), "{}", ended.stderr);
}
