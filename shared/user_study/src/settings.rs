//! `study.toml`: a user study.

use std::path::PathBuf;
use std::time::Duration;

use config::{Part, Registered, Section};
use diagnostics::Fields;
use serde_json::json;
use vocabulary::PLANNERS;

use crate::{Design, Item, Kind, Objects, Order, Protocol};

/// The section of studies.
pub static PART: Part =
    Part { name: "study", service: None, sections: &[Registered::of::<Study>()] };

/// A user study.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// The console offers the study.
    pub enabled: bool,
    /// The protocol, where no policies are the configured planner: see [`Study::protocol_with`].
    pub protocol: Protocol,
    /// Absence of a service after which an interaction is repeated.
    pub fault: Duration,
    /// Folder of the data; by default the group's own.
    pub data_dir: Option<PathBuf>,
}

/// Most questions of a questionnaire.
const ITEMS_MAX: usize = 100;

impl Section for Study {
    const KEY: &'static [&'static str] = &["study"];
    const FILE: Option<&'static str> = Some(include_str!("../../../config/study.toml"));

    fn read(f: &mut Fields<'_>) -> Self {
        Self {
            protocol: protocol(f),
            enabled: f.flag("enabled"),
            fault: f.seconds("fault_s", 1.0..=600.0),
            data_dir: f.absolute("data_dir"),
        }
    }
}

impl Study {
    /// Returns the protocol, whose policies default to the configured planner.
    pub fn protocol_with(&self, planner: &str) -> Protocol {
        let mut protocol = self.protocol.clone();
        if protocol.policies.is_empty() {
            protocol.policies.push(planner.to_owned());
        }
        protocol
    }
}

fn protocol(f: &mut Fields<'_>) -> Protocol {
    Protocol {
        title: f.text("title"),
        consent: f.optional_text("consent").unwrap_or_default(),
        instructions: f.texts("instructions"),
        interactions: f.whole("interactions", 1..=100),
        warmup: f.whole("warmup", 0..=20),
        objects: f
            .choice("objects", &[("uniform", Objects::Uniform), ("balanced", Objects::Balanced)]),
        design: f.choice("design", &[("within", Design::Within), ("between", Design::Between)]),
        policies: policies(f),
        order: f.choice("order", &[("latin", Order::Latin), ("random", Order::Random)]),
        seconds_max: f.number("seconds_max", 10.0..=3600.0),
        show_belief: f.flag("show_belief"),
        keep_words: f.flag("keep_words"),
        questionnaire: questionnaire(f),
    }
}

fn policies(f: &mut Fields<'_>) -> Vec<String> {
    let policies = f.texts("policies");
    let known = PLANNERS;
    f.note("policies", || json!({ "items": { "enum": known }, "uniqueItems": true }));
    for (n, policy) in policies.iter().enumerate() {
        if !known.contains(&policy.as_str()) {
            f.not_one_of("policies", policy, &known);
        } else if policies[..n].contains(policy) {
            f.problem("policies", format!("names `{policy}` twice"), "name each policy once");
        }
    }
    policies
}

fn questionnaire(f: &mut Fields<'_>) -> Vec<Item> {
    let items = f.list("questionnaire", DEFAULTS, item);
    f.note("questionnaire", || json!({ "maxItems": ITEMS_MAX }));
    if items.len() > ITEMS_MAX {
        let what = format!("has {} questions", items.len());
        f.problem("questionnaire", what, format!("ask at most {ITEMS_MAX}"));
    }
    for (n, item) in items.iter().enumerate() {
        if items[..n].iter().any(|other| other.id == item.id) {
            let what = format!("has two questions with the id `{}`", item.id);
            f.problem("questionnaire", what, "give each an id of its own");
        }
    }
    items
}

/// Defaults of a question.
const DEFAULTS: &str = r#"id = ""
text = ""
kind = ""
required = true
points = 5
options = []
low = ""
high = """#;

fn item(f: &mut Fields<'_>) -> Item {
    let kinds = [
        ("likert", Kind::Likert),
        ("choice", Kind::Choice),
        ("number", Kind::Number),
        ("text", Kind::Text),
    ];
    let mut item = Item {
        id: f.text("id"),
        text: f.text("text"),
        kind: f.choice("kind", &kinds),
        options: f.texts("options"),
        low: f.optional_text("low").unwrap_or_default(),
        high: f.optional_text("high").unwrap_or_default(),
        points: f.whole("points", 2..=11),
        required: f.flag("required"),
    };
    f.note("id", || json!({ "pattern": "^[A-Za-z0-9_]+$" }));
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if !f.is_wrong("id") && !item.id.chars().all(plain) {
        f.problem("id", format!("`{}` is not a column name", item.id), "use letters, digits and _");
    }
    if !f.is_wrong("kind") && item.kind == Kind::Choice && item.options.len() < 2 {
        f.problem(
            "options",
            "expected at least two options",
            "write `options = [\"one\", \"two\"]`",
        );
    }
    if item.kind != Kind::Likert {
        item.points = 0;
    }
    item
}
