//! The batch tools on the reference data, and on invalid lines.
use std::path::{Path, PathBuf};

use command_line::Outcome;
use command_line::output::Output;
use dialogue::Model;
use laboratory::args::WhichArm;
use laboratory::batch::{self, Decider, Grounder, Problem};
use laboratory::described_arm::DescribedArm;
use laboratory::scene_file;
use manipulation::Limb;
use serde_json::{Value as Json, json};
use service::exit::Exit;
use vocabulary::{Actions, Announce, Costs, Language, Mode, Params};

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// The built-in robot's arm.
fn arm(limb: Limb) -> DescribedArm {
    DescribedArm::load(None, &WhichArm { limb: Some(limb.name().to_owned()), tip: None }).unwrap()
}

fn fixture(path: &str) -> String {
    std::fs::read_to_string(repository("tests/fixtures").join(path)).unwrap()
}

/// The tool's answers and its exit code.
fn answers(tool: impl FnOnce(&mut Output<'_>) -> Outcome) -> (Vec<Json>, Exit) {
    let mut bytes = Vec::new();
    let exit = tool(&mut Output::to(&mut bytes, true)).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    (text.lines().map(|line| serde_json::from_str(line).unwrap()).collect(), exit)
}

fn lines(values: &[Json]) -> String {
    values.iter().map(|value| format!("{value}\n")).collect()
}

fn beliefs(cases: &[Json]) -> (Vec<Json>, Exit) {
    answers(|out| batch::belief(lines(cases).as_bytes(), out))
}

#[track_caller]
fn assert_near(found: &Json, expected: f64, tolerance: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

#[test]
fn every_published_belief_is_found() {
    let file: Json = serde_json::from_str(&fixture("belief/cases_public.json")).unwrap();
    let cases = file["cases"].as_array().unwrap();
    let (found, exit) = beliefs(cases);
    assert_eq!((found.len(), exit), (cases.len(), Exit::Ok));
    for (case, found) in cases.iter().zip(&found) {
        assert_eq!(found["id"], case["id"]);
        for (name, expected) in case["expected"].as_object().unwrap() {
            assert_near(&found["belief"][name], expected.as_f64().unwrap(), 1e-9);
        }
    }
}

/// Two objects, colours alone.
fn two(turns: Json) -> Json {
    let object = |name: &str, color: &str| json!({"name": name, "attributes": {"color": color}});
    let objects = [object("R", "red"), object("B", "blue")];
    json!({"id": 1, "scene": {"objects": objects, "values": {"color": ["red", "blue"]}},
           "turns": turns})
}

#[test]
fn missing_readings_are_read_in_the_mode_of_the_paper() {
    let given = two(json!([{"question": null, "utterance": "ignored", "l_b": ["blue"],
                            "l_r": "none"}]));
    let read = two(json!([{"question": {"type": "none"}, "utterance": "the blue one, please"}]));
    let half = two(json!([{"utterance": "red? yes", "l_b": ["blue", "bluish"]}]));
    let (found, _) = beliefs(&[given, read, half]);
    for one in &found {
        assert_near(&one["belief"]["B"], 6.0 / 7.0, 1e-12);
    }
    let keys: Vec<&String> = found[0]["belief"].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["R", "B"], "objects keep their order");
}

#[test]
fn repeated_words_count_as_often_as_they_are_heard() {
    let (found, _) = beliefs(&[
        two(json!([{"l_b": ["blue", "blue"], "l_r": "none"}])),
        two(json!([{"utterance": "blue blue"}])),
        two(json!([])),
    ]);
    assert_near(&found[0]["belief"]["B"], 36.0 / 37.0, 1e-12);
    assert_eq!(found[0]["belief"], found[1]["belief"]);
    assert_near(&found[2]["belief"]["B"], 0.5, 0.0);
}

#[test]
fn prior_is_normalised_and_may_omit_objects() {
    let with = |prior: Json| {
        let mut case = two(json!([]));
        case["prior"] = prior;
        case
    };
    let (found, exit) = beliefs(&[with(json!({"B": 3.0, "R": 1.0})), with(json!({"B": 1}))]);
    assert_near(&found[0]["belief"]["B"], 0.75, 1e-15);
    assert_eq!((found[1]["belief"]["R"].as_f64(), exit), (Some(0.0), Exit::Ok));
    let wrong = [
        (json!({"G": 1.0}), "no object"),
        (json!({"B": "half"}), "no number"),
        (json!({"B": -1.0}), "not a probability"),
        (json!({}), "zero"),
        (json!("even"), "uniform"),
    ];
    for (prior, part) in wrong {
        let (found, exit) = beliefs(&[with(prior)]);
        let error = found[0]["error"].as_str().unwrap();
        assert!(error.contains(part) && exit == Exit::NotReached, "{error}");
    }
}

#[test]
fn answers_to_open_questions_update_the_belief() {
    let which = json!({"type": "which", "attribute": "color"});
    let (found, exit) = beliefs(&[two(json!([{"question": which, "utterance": "blue"}]))]);
    assert_eq!(exit, Exit::Ok);
    assert_near(&found[0]["belief"]["B"], 0.99, 1e-12);
}

#[test]
fn invalid_case_is_reported_with_its_reason() {
    let question = |question: Json| two(json!([{"question": question, "utterance": "yes"}]));
    let mut params = two(json!([]));
    params["params"] = json!({"p_l": 2.0, "epsilon": 0.0, "alpha": 0.2});
    let mut scene = two(json!([]));
    scene["scene"]["objects"][0]["attributes"]["color"] = json!("green");
    let wrong = [
        (json!({"id": 1}), "missing field `scene`"),
        (json!([1, 2]), "scene"),
        (scene, "green"),
        (params, "params.p_l"),
        (question(json!({"type": "point", "object": "G"})), "turns[0]: the scene has no object"),
        (question(json!("what?")), "turns[0]"),
        (two(json!([{"l_r": "maybe"}])), "unknown variant `maybe`"),
    ];
    for (case, part) in wrong {
        let (found, exit) = beliefs(&[two(json!([])), case, two(json!([]))]);
        assert_eq!((found.len(), exit), (3, Exit::NotReached));
        let error = found[1]["error"].as_str().unwrap();
        assert!(error.contains(part), "{error}");
        assert_eq!(found[1]["line"], 2);
        assert_eq!(found[1].as_object().unwrap().len(), 2);
    }
}

fn grounded(text: &str) -> (Vec<Json>, Exit) {
    let scene = scene_file::load(&repository("config/scenes/bowls.toml")).unwrap();
    let grounder = Grounder::new(scene, Language::Careful);
    answers(|out| batch::ground(&grounder, text.as_bytes(), out))
}

#[test]
fn utterances_are_read_with_the_scenes_words() {
    let (mut found, exit) = grounded(
        "{\"id\":\"a\",\"text\":\"get me the small white bowl\",\"last_question\":null}\n\
         {\"id\":\"b\",\"text\":\"yes\",\"last_question\":{\"type\":\"attr\",\
         \"attribute\":\"size\",\"value\":\"big\"}}\n",
    );
    let reading = json!({"id": "a", "base": ["small", "white"], "response": "none",
                         "excluded": [], "intent": "inform"});
    let mentions = found[0].as_object_mut().unwrap().remove("mentions").unwrap();
    assert_eq!((&found[0], exit), (&reading, Exit::Ok));
    let stated = mentions.as_array().unwrap().iter().map(|it| (&it["value"], &it["wanted"]));
    let stated: Vec<_> =
        stated.map(|(value, wanted)| (value, wanted.as_f64() > Some(0.9))).collect();
    assert_eq!(stated, [(&json!("small"), true), (&json!("white"), true)], "{mentions}");
    assert_eq!(found[1]["response"], "yes");
}

/// A file with lines for two scenes can be read with either.
#[test]
fn lines_of_another_scene_are_read_without_their_question() {
    let utterances = fixture("utterances/public.jsonl");
    let (found, exit) = grounded(&utterances);
    assert_eq!((found.len(), exit), (utterances.lines().count(), Exit::Ok));
    assert!(found.iter().all(|line| line.get("error").is_none()));
    let (found, exit) = grounded(
        "{\"id\":1,\"scene\":\"bowls\",\"text\":\"no\",\"last_question\":{\"type\":\"attr\",\
         \"attribute\":\"kind\",\"value\":\"pen\"}}\n{\"id\":2}\n",
    );
    let error = found[0]["error"].as_str().unwrap();
    assert!(error.contains("no attribute \"kind\""), "{error}");
    assert_eq!(found[1]["error"], "missing field `text` at column 8");
    assert_eq!(exit, Exit::NotReached);
}

#[test]
fn beliefs_become_actions() {
    let scene = scene_file::load(&repository("config/scenes/bowls.toml")).unwrap();
    let model = Model::new(&scene, Params::default());
    let planner = dialogue::registry::planner("lookahead").unwrap();
    let actions = Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };
    let costs = Costs::default();
    let announce = Announce::FINAL;
    let problem =
        Problem { scene, model, costs, durations: None, actions, announce, settings: None };
    let mut decider = Decider { problem, planner };
    let input = "{\"id\":1,\"belief\":[1,0,0,0,0,0]}\n{\"id\":2,\"belief\":[0.2,0.8]}\n\
                 {\"id\":3,\"belief\":[0,0,0,0,0,0]}\n{\"id\":4,\"belief\":[1,2,3,4,5,\"6\"]}\n\
                 {\"id\":5,\"belief\":[1,1,1,1,1,1]}\n";
    let (found, exit) = answers(|out| batch::plan(&mut decider, input.as_bytes(), out));
    assert_eq!((found.len(), exit), (5, Exit::NotReached));
    assert_eq!(found[0]["action"], json!({"type": "pick", "object": "white"}));
    assert_near(&found[0]["value"], 50.0, 1.0);
    assert!(found[0]["micros"].as_f64().unwrap() >= 0.0);
    assert_eq!(found[1]["error"], "belief: 2 probabilities for 6 objects");
    assert_eq!(found[2]["error"], "every entry of the belief is zero");
    assert!(found[3]["error"].as_str().unwrap().contains("expected f64"));
    assert!(found[4]["action"]["type"].is_string());
}

/// A table of numbers with named columns.
fn csv(path: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fixture(path);
    let row = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let mut rows = text.lines().filter(|line| !line.starts_with('#')).map(row);
    (rows.next().unwrap(), rows.collect())
}

fn numbers(cells: &[String]) -> Vec<f64> {
    cells.iter().map(|cell| cell.parse().unwrap()).collect()
}

#[test]
fn links_are_where_the_reference_has_them() {
    for limb in Limb::BOTH {
        let (heads, rows) = csv(&format!("baxter/fk_reference_{limb}.csv"));
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| numbers(row)).collect();
        let input: Vec<Json> =
            rows.iter().enumerate().map(|(n, row)| json!({"id": n, "q": row[..7]})).collect();
        let (found, exit) = answers(|out| batch::fk(&arm(limb), lines(&input).as_bytes(), out));
        assert_eq!((found.len(), exit), (rows.len(), Exit::Ok));
        let links = ["arm_mount", "upper_shoulder", "lower_forearm", "hand", "hand_camera"];
        let links = links.map(|name| (name, name)).into_iter();
        for (link, column) in links.chain([("gripper", "gripper_electric")]) {
            let column = heads.iter().position(|head| *head == format!("{column}_x")).unwrap();
            for (row, found) in rows.iter().zip(&found) {
                let pose = &found["links"][format!("{limb}_{link}")];
                for i in 0..3 {
                    assert_near(&pose["xyz"][i], row[column + i], 1e-9);
                }
                let dot: f64 =
                    (0..4).map(|i| pose["xyzw"][i].as_f64().unwrap() * row[column + 3 + i]).sum();
                assert!((dot.abs() - 1.0).abs() < 1e-9, "{limb}_{link}");
            }
        }
    }
}

#[test]
fn poses_become_joint_positions_that_reach_them() {
    let (_, rows) = csv("baxter/ik_targets_left.csv");
    let rows: Vec<(&String, Vec<f64>)> =
        rows.iter().take(60).map(|row| (&row[0], numbers(&row[1..]))).collect();
    let input: Vec<Json> = rows
        .iter()
        .map(|(kind, row)| {
            json!({"id": kind, "xyz": row[..3], "xyzw": row[3..7],
                                  "q_seed": row[8..15]})
        })
        .collect();
    let (found, exit) =
        answers(|out| batch::ik(&arm(Limb::Left).chain().unwrap(), lines(&input).as_bytes(), out));
    assert_eq!((found.len(), exit), (rows.len(), Exit::Ok));
    for ((kind, row), found) in rows.iter().zip(&found) {
        assert!(found["ok"] == true || row[7] < 0.5, "{kind} {row:?}");
        assert_eq!(found["q"].as_array().unwrap().len(), 7);
        if found["ok"] == true {
            assert_near(&found["position_error_m"], 0.0, 1e-6);
            assert_near(&found["rotation_error_rad"], 0.0, 1e-6);
            let q = json!({"q": found["q"]});
            let (again, _) =
                answers(|out| batch::fk(&arm(Limb::Left), lines(&[q]).as_bytes(), out));
            for i in 0..3 {
                assert_near(&again[0]["links"]["left_gripper"]["xyz"][i], row[i], 1e-6);
            }
        }
    }
}

#[test]
fn unreachable_pose_is_answered_and_invalid_input_rejected() {
    let far = json!({"id": "far", "xyz": [9.0, 0.0, 0.0], "xyzw": [0, 0, 0, 2]});
    let huge = json!({"id": "huge", "xyz": [1e308, -1e308, 1e308], "xyzw": [0, 0, 1e-9, 0]});
    let wrong = json!({"id": "wrong", "xyz": [0, 0, 0], "xyzw": [0, 0, 0, 0]});
    let short = json!({"id": "short", "xyz": [0, 0], "xyzw": [0, 0, 0, 1]});
    let input = lines(&[far, huge, wrong, short]);
    let (found, exit) =
        answers(|out| batch::ik(&arm(Limb::Right).chain().unwrap(), input.as_bytes(), out));
    assert_eq!((&found[0]["ok"], &found[1]["ok"]), (&json!(false), &json!(false)));
    assert!(found[0]["position_error_m"].as_f64().unwrap() > 7.0);
    assert_eq!(found[2]["error"], "xyzw: is not a rotation");
    assert!(found[3]["error"].as_str().unwrap().contains("length 2"));
    assert_eq!(exit, Exit::NotReached);
    let postures = "{\"q\":[1,2,3]}\n{\"q\":[0,0,0,0,0,0,1e300]}\n{\"q\":[0,0,0,0,0,0,1e999]}\n";
    let (found, _) = answers(|out| batch::fk(&arm(Limb::Right), postures.as_bytes(), out));
    assert!(found[0]["error"].as_str().unwrap().contains("expected 7 joint positions, found 3"));
    assert!(found[1]["error"].as_str().unwrap().contains("no position of a joint"));
    assert!(found[2]["error"].as_str().unwrap().contains("out of range"));
}

#[test]
fn arms_of_six_joints_are_answered_with_six_positions() {
    let robot =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/robots/ur5e.urdf");
    let which = WhichArm { limb: Some("arm".to_owned()), tip: None };
    let arm = DescribedArm::load(Some(&robot), &which).unwrap();
    let q = [0.4, -1.5, 1.2, -1.0, -1.4, 0.3];
    let input = vec![json!({ "id": 1, "q": q }), json!({ "id": 2, "q": vec![0.0; 7] })];
    let (found, exit) = answers(|out| batch::fk(&arm, lines(&input).as_bytes(), out));
    assert_eq!(exit, Exit::NotReached);
    let pose = &found[0]["links"]["arm_gripper"];
    let error = found[1]["error"].as_str().unwrap();
    assert_eq!(error, "q: expected 6 joint positions, found 7");
    let input = vec![json!({ "id": 3, "xyz": pose["xyz"], "xyzw": pose["xyzw"], "q_seed": q })];
    let chain = arm.chain().unwrap();
    let (found, _) = answers(|out| batch::ik(&chain, lines(&input).as_bytes(), out));
    let solved: Vec<f64> = serde_json::from_value(found[0]["q"].clone()).unwrap();
    assert!(found[0]["ok"] == true && solved.len() == 6, "{}", found[0]);
    assert!(solved.iter().zip(q).all(|(a, b)| (a - b).abs() < 1e-6), "{solved:?}");
}
