//! The belief update tests of the paper's section 4, and their like for the six bowls.

use serde_json::Value as Json;
use vocabulary::Params;

use super::*;
use crate::testing::{heard, scene_of};

/// Every case of the fixture to 1e-9, and every figure that the paper prints to its three digits.
#[test]
fn the_cases_of_section_4_and_the_bowls() {
    let text = include_str!("../../../../tests/fixtures/belief/cases_public.json");
    let file: Json = serde_json::from_str(text).unwrap();
    let cases = file["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 24);
    let mut published = 0;
    for case in cases {
        let id = case["id"].as_str().unwrap();
        let (scene, belief) = run(case);
        for (name, expected) in case["expected"].as_object().unwrap() {
            let got = belief.probability(scene.object_named(name).unwrap());
            let expected = expected.as_f64().unwrap();
            assert!((got - expected).abs() < 1e-9, "{id}: {name} {got} not {expected}");
        }
        for (name, printed) in case["published"].as_object().into_iter().flatten() {
            let got = belief.probability(scene.object_named(name).unwrap());
            // If the paper prints two digits, the third is an omitted zero.
            let rounded = (got * 1000.0).round() / 1000.0;
            assert!((rounded - printed.as_f64().unwrap()).abs() < 1e-12, "{id}: {name} {got}");
            published += 1;
        }
    }
    assert_eq!(published, 35, "every printed figure of section 4 is checked");
}

fn run(case: &Json) -> (scene::Scene, Belief) {
    let scene = scene_of(&case["scene"]);
    let params: Params = serde_json::from_value(case["params"].clone()).unwrap();
    let model = Model::new(&scene, params);
    assert_eq!(case["prior"], "uniform");
    let mut belief = Belief::uniform(model.objects());
    for turn in case["turns"].as_array().unwrap() {
        let question = scene::question_from_json(&scene, &turn["question"]).unwrap();
        let words: Vec<_> =
            turn["l_b"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
        let response = serde_json::from_value(turn["l_r"].clone()).unwrap();
        belief.update(&model, question, &heard(&scene, &words, response));
    }
    (scene, belief)
}

/// The printed figures of section 4, independent of the fixture.
#[test]
fn belief_reproduces_the_printed_figures_of_section_4() {
    let params = r#""params":{"p_l":0.95,"epsilon":0.01,"alpha":0.2},"prior":"uniform""#;
    let one_turn = |objects: &str, question: &str, words: &str, response: &str| {
        let case: Json = serde_json::from_str(&format!(
            r#"{{"scene":{{"objects":[{objects}]}},{params},
                "turns":[{{"question":{question},"l_b":[{words}],"l_r":"{response}"}}]}}"#
        ))
        .unwrap();
        run(&case).1.probabilities()
    };
    let red_blue = r#"{"name":"R","attributes":{"color":"red"}},
        {"name":"B","attributes":{"color":"blue"}}"#;
    let reds_blue = r#"{"name":"R1","attributes":{"color":"red"}},
        {"name":"R2","attributes":{"color":"red"}},{"name":"B","attributes":{"color":"blue"}}"#;
    let no_overlap = r#"{"name":"B","attributes":{"color":"blue","orientation":"x-aligned"}},
        {"name":"R","attributes":{"color":"red","orientation":"y-aligned"}}"#;
    let point = r#"{"type":"point","object":"B"}"#;
    let attr = r#"{"type":"attr","attribute":"color","value":"blue"}"#;
    let none = r#"{"type":"none"}"#;
    let blue = r#""blue""#;
    let red = r#""red""#;
    let table: [(&str, &str, &str, &str, &[f64]); 13] = [
        (red_blue, none, blue, "none", &[0.143, 0.857]),
        (no_overlap, none, blue, "none", &[0.857, 0.143]),
        (no_overlap, none, r#""blue","x-aligned""#, "none", &[0.973, 0.027]),
        (red_blue, point, "", "yes", &[0.01, 0.99]),
        (red_blue, point, blue, "yes", &[0.002, 0.998]),
        (red_blue, point, "", "no", &[0.99, 0.01]),
        (red_blue, point, blue, "no", &[0.943, 0.057]),
        (red_blue, point, red, "no", &[0.998, 0.002]),
        (reds_blue, attr, "", "yes", &[0.010, 0.010, 0.980]),
        (reds_blue, attr, blue, "yes", &[0.002, 0.002, 0.997]),
        (reds_blue, attr, "", "no", &[0.497, 0.497, 0.005]),
        (reds_blue, attr, blue, "no", &[0.485, 0.485, 0.029]),
        (reds_blue, attr, red, "no", &[0.500, 0.500, 0.001]),
    ];
    for (objects, question, words, response, printed) in table {
        let got = one_turn(objects, question, words, response);
        for (got, printed) in got.iter().zip(printed) {
            assert!((got - printed).abs() < 5.0e-4 + 1e-12, "{question} {words}: {got} {printed}");
        }
    }
}
