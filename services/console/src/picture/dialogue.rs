//! What the robot thinks.

use messages::PolicyView;
use scene::{Question, Scene, question_to_json};
use serde_json::{Value as Json, json};

/// The section. The view must be of this scene.
pub(super) fn section(scene: &Scene, view: &PolicyView) -> Json {
    let asks = view.question != Question::None && scene.contains(view.question);
    let round = |p: &f64| (p * 1e6).round() / 1e6;
    json!({
        "interaction": view.interaction,
        "applied": view.applied,
        "belief": view.belief.iter().map(round).collect::<Vec<_>>(),
        "absent": round(&view.absent),
        "decision": view.decision,
        "planner": view.planner,
        "question": asks.then(|| question_to_json(scene, view.question)),
        "question_about": asks.then(|| about(scene, view.question)),
        "text": view.text,
        "prompt": view.prompt,
        "value": view.value,
        "bounds": view.bounds.map(|(low, high)| [low, high]),
        "alternatives": view.alternatives.iter()
            .map(|(action, value)| json!({ "action": action, "value": value }))
            .collect::<Vec<_>>(),
        "questions": view.questions,
        "expected_questions": view.expected_questions,
        "last": view.last.as_ref().map(|last| json!({
            "interaction": last.interaction,
            "object": last.name,
            "outcome": last.outcome,
            "questions": last.questions,
            "seconds": last.seconds,
        })),
        "person": view.person.map(|(p_l, epsilon)| json!({ "p_l": p_l, "epsilon": epsilon })),
    })
}

/// What a question is about, in the scene's names, with its usual words.
pub(super) fn about(scene: &Scene, question: Question) -> Json {
    let mut about = json!({ "text": scene.phrase(question) });
    match question {
        Question::None => {}
        Question::Point(i) => about["object"] = scene.object(i).name.clone().into(),
        Question::Which(k) => {
            about["attribute"] = scene.attributes()[k.index()].name.clone().into();
        }
        Question::Attribute(k, v) => {
            let attribute = &scene.attributes()[k.index()];
            about["attribute"] = attribute.name.clone().into();
            about["value"] = attribute.values[v.index()].name.clone().into();
        }
    }
    about
}
