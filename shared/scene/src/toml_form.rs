//! Scene files in TOML (`config/scenes/*.toml`); docs/scenes.md explains every key.
//!
//! ```toml
//! name = "markers"
//! noun = "marker"
//! ask_wanted = "Which {noun} would you like?"   # optional, as are all wordings
//! ask_point = ["This one?", "Is it this one?"]  # several are taken in turn
//!
//! [[attributes]]
//! name = "color"
//! synonyms = ["colour"]              # other words for the attribute, optional
//! role = "quality"                   # or "kind" or "place"; guessed from `spoken` by default
//! ask_yes_no = ["Is it {value}?", "Is the {noun} {value}?"]
//! ask_which = "What colour is it?"
//! values = ["red", { name = "blue", synonyms = ["navy"], spoken = "dark blue" }]
//!
//! [[objects]]
//! name = "left_one"
//! attributes = { color = "red" }     # an object may lack an attribute
//! xyz = [0.7, 0.1, -0.15]            # metres, frame `base`; a scene may do without places
//! yaw = 0.5                          # radians, optional
//! size = [0.14, 0.014, 0.014]        # metres
//! grasp_width = 0.014                # metres
//! mass_kg = 0.02                     # optional
//! form = "hollow"                    # has a rim, as a bowl; optional, "solid" by default
//! wall_deg = 8                       # slope of a bowl's wall, optional
//! ```
//!
//! In a wording `{value}` is the value as `spoken` has it (in yes or no questions alone),
//! `{attribute}` the attribute's name and `{noun}` the scene's noun.
//!
//! Attributes, values and objects are lists because their order counts: it breaks ties between
//! questions and names the entries of a belief.

use diagnostics::{Diagnostics, Fields, Report, Source, Table};

use crate::check::{Checks, Draft, DraftAttribute, DraftObject, DraftValue};
use crate::{Form, Placement, Scene};

impl Scene {
    /// Reads the text of a scene file; `file` is its name in diagnostics.
    ///
    /// # Errors
    /// Every problem of the text at once.
    pub fn from_toml(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let mut report = Report::default();
        let scene = Table::parse(text, &Source::new(file, 0), &mut report).and_then(|table| {
            let draft = draft(&table, &mut report);
            draft.check(&mut Checks { table: &table, report: &mut report })
        });
        report.verdict(scene)
    }
}

fn draft(table: &Table, report: &mut Report) -> Draft {
    let mut f = Fields::new(table, Vec::new(), report);
    let draft = Draft {
        name: f.text("name"),
        noun: f.text("noun"),
        ask_wanted: f.one_or_more_texts("ask_wanted"),
        ask_point: f.one_or_more_texts("ask_point"),
        attributes: f.list("attributes", "", attribute),
        objects: f.list("objects", "", object),
    };
    f.finish();
    draft
}

fn attribute(f: &mut Fields<'_>) -> DraftAttribute {
    DraftAttribute {
        key: f.key(),
        name: f.text("name"),
        synonyms: f.texts("synonyms"),
        role: f.optional_text("role"),
        ask_yes_no: f.one_or_more_texts("ask_yes_no"),
        ask_which: f.one_or_more_texts("ask_which"),
        values: f.list("values", "", value),
    }
}

fn value(f: &mut Fields<'_>) -> DraftValue {
    DraftValue {
        key: f.key(),
        name: f.text("name"),
        synonyms: f.texts("synonyms"),
        spoken: f.optional_text("spoken"),
        role: f.optional_text("role"),
    }
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

/// Greatest slope of a wall that the fingers, coming from above, enclose: degrees from the vertical.
const WALL_DEG_MAX: f64 = 30.0;

/// The place and size of an object: all of it or nothing.
fn placement(f: &mut Fields<'_>) -> Option<Placement> {
    const KEYS: [&str; 7] = ["xyz", "yaw", "size", "grasp_width", "mass_kg", "wall_deg", "form"];
    if !KEYS.into_iter().any(|key| f.has(key)) {
        f.allow(&KEYS);
        return None;
    }
    let placement = Placement {
        xyz: f.triple("xyz"),
        yaw: if f.has("yaw") { f.any_number("yaw") } else { 0.0 },
        size: f.triple("size"),
        grasp_width: f.any_number("grasp_width"),
        mass_kg: f.has("mass_kg").then(|| f.any_number("mass_kg")),
        wall_deg: if f.has("wall_deg") { f.any_number("wall_deg") } else { 0.0 },
        form: if f.has("form") { f.choice("form", &Form::NAMES) } else { Form::default() },
    };
    for optional in ["yaw", "mass_kg", "wall_deg", "form"] {
        if !f.has(optional) {
            f.allow(&[optional]);
        }
    }
    let sizes = placement.size.iter().enumerate().map(|(n, extent)| (format!("size[{n}]"), extent));
    let width = ("grasp_width".to_owned(), &placement.grasp_width);
    for (key, length_m) in sizes.chain([width]) {
        if *length_m <= 0.0 && !f.is_wrong(key.split('[').next().unwrap_or(&key)) {
            let what = format!("expected a length above 0 m, found {length_m}");
            f.problem(&key, what, "");
        }
    }
    if let Some(mass_kg) = placement.mass_kg.filter(|mass_kg| *mass_kg <= 0.0) {
        f.problem("mass_kg", format!("expected a mass above 0 kg, found {mass_kg}"), "");
    }
    if !(0.0..=WALL_DEG_MAX).contains(&placement.wall_deg) {
        let what = format!("expected 0 to {WALL_DEG_MAX} degrees, found {}", placement.wall_deg);
        let help = "flatter walls cannot be gripped from above: leave out the object's place";
        f.problem("wall_deg", what, help);
    }
    Some(placement)
}
