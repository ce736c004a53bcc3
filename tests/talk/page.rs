//! The demo in a page held against the services: the same person holds the same dialogue with both, and hears the
//! same lines and gets the same objects. What surrounds the manager differs (a simulated arm and voice of its own).

use std::collections::BTreeMap;

use demo::Desk;
use messages::{MotionOrder, PickId};
use scene::{ObjectId, Options, Question, Scene};
use serde_json::{Value, json};
use service::Time;
use vocabulary::ids::InteractionId;

use crate::group::{Input, Line, Robot, Seen};

/// Time between two looks, milliseconds.
const STEP_MS: f64 = 50.0;

/// The demo's page without a browser.
pub(crate) struct Page {
    desk: Desk,
    scene: Scene,
    sections: Value,
    at_ms: f64,
    seen: Seen,
    /// The question of each prompt.
    questions: BTreeMap<u64, Question>,
    last_line: u64,
    pick: Option<PickId>,
    /// Whether the latest order is over, and the latest interaction that ended.
    is_over: bool,
    ended: u64,
}

impl Page {
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut page = Self {
            desk: Desk::default(),
            scene: scene.clone(),
            sections: json!({}),
            at_ms: 0.0,
            seen: Seen::default(),
            questions: BTreeMap::new(),
            last_line: 0,
            pick: None,
            is_over: false,
            ended: 0,
        };
        page.command(&json!({ "do": "open", "scene": scene.name() }));
        page
    }

    fn command(&mut self, command: &Value) {
        let answer: Value =
            serde_json::from_str(&self.desk.command(&command.to_string())).expect("JSON");
        // A release that comes too soon is refused, as by the arm's service.
        let is_refused = answer["error"].is_string() && command["do"] != "resume";
        assert!(!is_refused, "{command}: {}", answer["error"]);
        for (name, section) in answer["sections"].as_object().into_iter().flatten() {
            self.sections[name] = section.clone();
        }
        self.see_dialogue();
        self.see_arm();
    }

    fn see_dialogue(&mut self) {
        let dialogue = &self.sections["dialogue"];
        if dialogue["decision"] == "ask"
            && let Some(prompt) = dialogue["prompt"].as_u64()
        {
            let question = question(&self.scene, &dialogue["question"]);
            self.questions.insert(prompt, question.unwrap_or_default());
        }
        let speaking = &self.sections["speaking"];
        self.seen.is_talking = speaking.is_object() && speaking["ended_ms"].is_null();
        if let Some(ended_ms) = speaking["ended_ms"].as_f64() {
            self.seen.quiet_since = time(ended_ms);
        }
        for line in self.sections["lines"].as_array().into_iter().flatten() {
            let id = line["id"].as_u64().expect("a number");
            let prompt = line["said"][0].as_u64();
            if id <= self.last_line {
                continue;
            }
            self.last_line = id;
            let Some(prompt) = prompt else { continue };
            self.seen.lines.push(Line {
                at: time(line["at_ms"].as_f64().expect("a time")),
                text: line["text"].as_str().expect("a text").to_owned(),
                question: self.questions.get(&prompt).copied().unwrap_or_default(),
                is_whole: true,
            });
        }
    }

    fn see_arm(&mut self) {
        let (arm, now) = (&self.sections["arm"], time(self.at_ms));
        // The next order may follow a hand-over at once.
        let last = &self.sections["dialogue"]["last"];
        let ended = last["interaction"].as_u64().unwrap_or_default();
        let is_delivered = ["delivered", "refused"].iter().any(|it| last["outcome"] == *it);
        if std::mem::replace(&mut self.ended, ended) < ended && is_delivered {
            let object = last["object"].as_str().and_then(|name| self.scene.object_named(name));
            self.seen.delivered.extend(object.map(|object| (now, object)));
        }
        self.seen.is_stopped = arm["stopped"] == true;
        let is_held = arm["phase"] == "holding";
        self.seen.lets_go_s = arm["remaining_s"].as_f64().filter(|_| is_held);
        let Some(object) = arm["object"].as_str().and_then(|name| self.scene.object_named(name))
        else {
            return;
        };
        let id = PickId {
            interaction: InteractionId(arm["interaction"].as_u64().expect("a number")),
            attempt: arm["attempt"].as_u64().and_then(|n| n.try_into().ok()).expect("a number"),
        };
        if self.pick != Some(id) {
            (self.pick, self.is_over) = (Some(id), false);
            if arm["task"] == "fetch" {
                self.seen.picks.push((now, id, object));
            }
        }
        let is_cancelled = self.sections["dialogue"]["decision"] == "cancel";
        self.seen.is_fetching = arm["phase"] != "done" && !is_cancelled;
        let is_done = arm["phase"] == "done";
        let is_news = is_done && !std::mem::replace(&mut self.is_over, true);
        if is_news && arm["outcome"] == "put_back" {
            self.seen.put_back.push((now, object));
        }
    }
}

impl Robot for Page {
    fn now(&self) -> Time {
        time(self.at_ms)
    }

    fn seen(&self) -> &Seen {
        &self.seen
    }

    fn put(&mut self, input: Input) {
        let at_ms = self.at_ms;
        let command = match input {
            Input::Text(text) => json!({ "do": "say", "text": text, "at_ms": at_ms }),
            Input::Motion(MotionOrder::Stop) => json!({ "do": "stop", "at_ms": at_ms }),
            Input::Motion(MotionOrder::Resume) => json!({ "do": "resume", "at_ms": at_ms }),
        };
        self.command(&command);
    }

    fn advance(&mut self) {
        self.at_ms += STEP_MS;
        self.command(&json!({ "do": "look", "at_ms": self.at_ms }));
    }
}

fn time(ms: f64) -> Time {
    Time((ms * 1e6) as u64 + 1)
}

/// The question that a section names.
fn question(scene: &Scene, named: &Value) -> Option<Question> {
    let text = |key: &str| named[key].as_str();
    let attribute = text("attribute").and_then(|k| scene.attribute_named(k));
    Some(match text("type")? {
        "point" => Question::Point(scene.object_named(text("object")?)?),
        "attr" => Question::Attribute(attribute?, scene.value_named(attribute?, text("value")?)?),
        "which" => Question::Which(attribute?),
        "choice" => {
            let values = named["values"].as_array()?.iter();
            let values = values.map(|v| scene.value_named(attribute?, v.as_str()?));
            Question::Choice(attribute?, Options::new(&values.collect::<Option<Vec<_>>>()?)?)
        }
        _ => Question::None,
    })
}

/// What both must agree about.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Held {
    lines: Vec<String>,
    picks: Vec<ObjectId>,
    delivered: Vec<ObjectId>,
    put_back: Vec<ObjectId>,
}

impl Held {
    pub(crate) fn of(seen: &Seen) -> Self {
        let objects = |all: &[(Time, ObjectId)]| all.iter().map(|(_, object)| *object).collect();
        Self {
            lines: seen.lines.iter().map(|line| line.text.clone()).collect(),
            picks: seen.picks.iter().map(|(.., object)| *object).collect(),
            delivered: objects(&seen.delivered),
            put_back: objects(&seen.put_back),
        }
    }
}
