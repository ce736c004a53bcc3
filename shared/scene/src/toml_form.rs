//! Scene files in TOML (`config/scenes/*.toml`); docs/scenes.md explains every key.

use diagnostics::{Diagnostics, Fields, Report, Source, Table};
use serde_json::{Value as Json, json};

use crate::check::{Checks, Draft, DraftAttribute, DraftObject, DraftValue, WORDING_CHARS_MAX};
use crate::{Form, Placement, Role, Scene};

impl Scene {
    /// Reads the text of a scene file; `file` is its name in diagnostics.
    ///
    /// # Errors
    /// Every problem of the text at once.
    pub fn from_toml(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let mut report = Report::default();
        let scene = Self::examine(file, text, &mut report);
        report.verdict(scene)
    }

    /// Reads the text of a scene file, reports every problem of it, and returns the scene without
    /// its wrong parts, so that the places of the other objects can be checked in the same round;
    /// `None` if they leave no scene.
    pub fn examine(file: &str, text: &str, report: &mut Report) -> Option<Self> {
        let table = Table::parse(text, &Source::new(file, 0), report)?;
        let mut f = Fields::new(&table, Vec::new(), report);
        let draft = draft(&mut f);
        f.finish();
        draft.check(&mut Checks { table: &table, report })
    }

    /// Returns the JSON Schema of scene files.
    pub fn schema() -> Json {
        diagnostics::schema_of(&Table::empty(Source::built_in()), draft)
    }
}

fn draft(f: &mut Fields<'_>) -> Draft {
    let draft = Draft {
        name: f.text("name"),
        noun: f.text("noun"),
        ask_wanted: wordings(f, "ask_wanted"),
        ask_point: wordings(f, "ask_point"),
        attributes: f.list("attributes", "", attribute),
        objects: f.list("objects", "", object),
    };
    f.at_least_one("attributes");
    f.at_least_one("objects");
    draft
}

fn attribute(f: &mut Fields<'_>) -> DraftAttribute {
    let attribute = DraftAttribute {
        key: f.key(),
        name: f.text("name"),
        synonyms: f.texts("synonyms"),
        role: role(f),
        ask_yes_no: wordings(f, "ask_yes_no"),
        ask_which: wordings(f, "ask_which"),
        values: f.list("values", "", value),
    };
    f.at_least_one("values");
    attribute
}

fn value(f: &mut Fields<'_>) -> DraftValue {
    DraftValue {
        key: f.key(),
        name: f.text("name"),
        synonyms: f.texts("synonyms"),
        spoken: f.optional_text("spoken"),
        role: role(f),
    }
}

fn role(f: &mut Fields<'_>) -> Option<String> {
    let role = f.optional_text("role");
    f.note_choices("role", Role::NAMES.iter().map(|(name, _)| *name).chain([""]));
    role
}

/// Reads wordings of a question; the [checks](crate::check) limit them.
fn wordings(f: &mut Fields<'_>, key: &'static str) -> Vec<String> {
    let texts = f.one_or_more_texts(key);
    f.note(key, || {
        let text = match key {
            "ask_yes_no" => r"\{value\}",
            "ask_which" => r"^((?!\{value\})[\s\S])*\S((?!\{value\})[\s\S])*$",
            _ => r"\S",
        };
        let text = json!({ "type": "string", "pattern": text, "maxLength": WORDING_CHARS_MAX });
        let list = json!({ "type": "array", "items": text, "minItems": 1, "uniqueItems": true });
        json!({ "anyOf": [text, list] })
    });
    texts
}

pub(crate) fn object(f: &mut Fields<'_>) -> DraftObject {
    DraftObject {
        key: f.key(),
        name: f.text("name"),
        attributes: (f.optional_table("attributes", |f| {
            f.names().into_iter().map(|name| (name.to_owned(), f.text(name))).collect()
        }))
        .unwrap_or_default(),
        placement: placement(f),
    }
}

/// Greatest slope of a wall that fingers from above can enclose: degrees from the vertical.
const WALL_DEG_MAX: f64 = 30.0;

/// Lengths above these are taken for other units than metres.
const EXTENT_MAX_M: f64 = 2.0;
const GRASP_MAX_M: f64 = 0.5;
const DISTANCE_MAX_M: f64 = 5.0;

/// The place and size of an object: all of it or nothing; nothing if a part is wrong.
fn placement(f: &mut Fields<'_>) -> Option<Placement> {
    const KEYS: [&str; 7] = ["xyz", "yaw", "size", "grasp_width", "mass_kg", "wall_deg", "form"];
    let placement = f.together(&KEYS, |f| Placement {
        xyz: f.triple("xyz"),
        yaw: f.optionally("yaw", Fields::any_number).unwrap_or(0.0),
        size: f.triple("size"),
        grasp_width: f.any_number("grasp_width"),
        mass_kg: f.optionally("mass_kg", Fields::any_number),
        wall_deg: f.optionally("wall_deg", Fields::any_number).unwrap_or(0.0),
        form: f.optionally("form", |f, key| f.choice(key, &Form::NAMES)).unwrap_or_default(),
    })?;
    check_lengths(f, "xyz", &placement.xyz, DISTANCE_MAX_M);
    check_lengths(f, "size", &placement.size, EXTENT_MAX_M);
    check_lengths(f, "grasp_width", &[placement.grasp_width], GRASP_MAX_M);
    if let Some(mass_kg) = placement.mass_kg.filter(|mass_kg| *mass_kg <= 0.0)
        && !f.is_wrong("mass_kg")
    {
        f.problem("mass_kg", format!("expected a mass above 0 kg, found {mass_kg}"), "");
    }
    if !(0.0..=WALL_DEG_MAX).contains(&placement.wall_deg) {
        let what = format!("expected 0 to {WALL_DEG_MAX} degrees, found {}", placement.wall_deg);
        let help = "flatter walls cannot be gripped from above: leave out the object's place";
        f.problem("wall_deg", what, help);
    }
    f.note("mass_kg", || json!({ "exclusiveMinimum": 0 }));
    f.note("wall_deg", || json!({ "minimum": 0, "maximum": WALL_DEG_MAX }));
    let is_right = !KEYS.iter().any(|key| f.is_wrong(key));
    is_right.then_some(placement)
}

/// Reports lengths that no object on a table has: in metres they are at most `max_m`, and above 0
/// unless they are coordinates.
fn check_lengths(f: &mut Fields<'_>, key: &'static str, lengths_m: &[f64], max_m: f64) {
    let is_place = key == "xyz";
    f.note(key, || {
        let rule = match is_place {
            true => json!({ "type": "number", "minimum": -max_m, "maximum": max_m }),
            false => json!({ "type": "number", "exclusiveMinimum": 0, "maximum": max_m }),
        };
        if lengths_m.len() == 1 { rule } else { json!({ "items": rule }) }
    });
    if f.is_wrong(key) {
        return;
    }
    for (n, &length_m) in lengths_m.iter().enumerate() {
        let item = if lengths_m.len() == 1 { key.to_owned() } else { format!("{key}[{n}]") };
        if length_m <= 0.0 && !is_place {
            f.problem(&item, format!("expected a length above 0 m, found {length_m}"), "");
        } else if length_m.abs() > max_m {
            // Centimetres, millimetres, or either, if an object on a table may have that length.
            let guesses = [100.0, 1000.0].map(|parts| length_m / parts).into_iter();
            let guesses = guesses.filter(|guess_m| guess_m.abs() <= max_m / 4.0);
            let guesses =
                guesses.map(|guess_m| guess_m.to_string()).collect::<Vec<_>>().join(" or ");
            let guess = match guesses.is_empty() {
                true => guesses,
                false => format!("; did you mean {guesses}?"),
            };
            let what = format!("expected at most {max_m} m, found {length_m}");
            f.problem(&item, what, format!("lengths are in metres{guess}"));
        }
    }
}
