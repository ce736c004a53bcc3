//! Checks of every invariant of [`Scene`], for both syntaxes.

use std::collections::HashMap;

use diagnostics::{Report, Table, suggestion};

use crate::forms::{align_parts, defaults, with_capital};
use crate::role::is_part_of;
use crate::{Attribute, Object, Placement, Role, Scene, Value, ValueId, WordId, wording};

/// A table while its meaning is checked.
pub(crate) struct Checks<'a> {
    pub(crate) table: &'a Table,
    pub(crate) report: &'a mut Report,
}

impl Checks<'_> {
    fn add(&mut self, key: impl Into<String>, what: impl Into<String>, help: impl Into<String>) {
        self.report.add(self.table.diagnostic(key, what, help));
    }
}

/// Most entries that a 16-bit index can name.
const COUNT_MAX: usize = 65_535;

/// A scene as written: typed, not yet checked. An empty name stands for one that was missing or
/// empty, which the reader has reported.
pub(crate) struct Draft {
    pub(crate) name: String,
    pub(crate) noun: String,
    pub(crate) ask_wanted: Vec<String>,
    pub(crate) ask_point: Vec<String>,
    pub(crate) attributes: Vec<DraftAttribute>,
    pub(crate) objects: Vec<DraftObject>,
}

pub(crate) struct DraftAttribute {
    pub(crate) key: String,
    pub(crate) name: String,
    pub(crate) synonyms: Vec<String>,
    pub(crate) role: Option<String>,
    pub(crate) ask_yes_no: Vec<String>,
    pub(crate) ask_which: Vec<String>,
    pub(crate) values: Vec<DraftValue>,
}

pub(crate) struct DraftValue {
    pub(crate) key: String,
    pub(crate) name: String,
    pub(crate) synonyms: Vec<String>,
    pub(crate) spoken: Option<String>,
    pub(crate) role: Option<String>,
}

impl DraftValue {
    pub(crate) fn plain(key: String, name: String) -> Self {
        Self { key, name, synonyms: Vec::new(), spoken: None, role: None }
    }
}

pub(crate) struct DraftObject {
    pub(crate) key: String,
    pub(crate) name: String,
    pub(crate) attributes: Vec<(String, String)>,
    pub(crate) placement: Option<Placement>,
}

impl Draft {
    /// Returns the scene; `None` only after a problem that makes it impossible to build.
    pub(crate) fn check(self, report: &mut Checks<'_>) -> Option<Scene> {
        self.check_counts(report);
        self.check_attribute_names(report);
        for attribute in &self.attributes {
            check_values(attribute, report);
            check_wording(attribute, report);
            check_roles(attribute, report);
        }
        check_texts("ask_wanted", &self.ask_wanted, &["{noun}"], report);
        check_texts("ask_point", &self.ask_point, &["{noun}"], report);
        let places = self.check_objects(report);
        let words = self.words();
        if words.len() > COUNT_MAX {
            report.add("", "too many different values", format!("use at most {COUNT_MAX}"));
        }
        let counted = self.attributes.len() <= COUNT_MAX
            && self.objects.len() <= COUNT_MAX
            && words.len() <= COUNT_MAX
            && self.attributes.iter().all(|attribute| attribute.values.len() <= COUNT_MAX);
        counted.then(|| self.build(words, places))
    }

    fn check_counts(&self, report: &mut Checks<'_>) {
        let count = |key: &str, n: usize, one: &str, report: &mut Checks<'_>| {
            if n == 0 {
                report.add(key, "expected at least one, found none", format!("add `{one}`"));
            }
            if n > COUNT_MAX {
                report.add(key, format!("{n} are too many"), format!("use at most {COUNT_MAX}"));
            }
        };
        count("attributes", self.attributes.len(), "[[attributes]]", report);
        count("objects", self.objects.len(), "[[objects]]", report);
        for attribute in &self.attributes {
            let key = format!("{}.values", attribute.key);
            let n = attribute.values.len();
            if n == 0 {
                report.add(key, "expected at least one value, found none", "list it");
            } else if n > COUNT_MAX {
                report.add(key, format!("{n} are too many"), format!("use at most {COUNT_MAX}"));
            }
        }
    }

    fn check_attribute_names(&self, report: &mut Checks<'_>) {
        let mut seen = HashMap::new();
        for attribute in self.attributes.iter().filter(|attribute| !attribute.name.is_empty()) {
            if let Some(first) = seen.insert(&attribute.name, &attribute.key) {
                let what = format!("attribute `{}` is already at {first}", attribute.name);
                report.add(format!("{}.name", attribute.key), what, "rename or merge them");
            }
        }
    }

    /// Checks the objects; returns the values of each by attribute.
    fn check_objects(&self, report: &mut Checks<'_>) -> Vec<Vec<Option<ValueId>>> {
        let attributes: HashMap<&str, usize> = (self.attributes.iter().enumerate())
            .map(|(k, attribute)| (attribute.name.as_str(), k))
            .collect();
        let values: Vec<HashMap<&str, usize>> = (self.attributes.iter())
            .map(|a| a.values.iter().enumerate().map(|(v, value)| (&*value.name, v)).collect())
            .collect();
        let mut seen = HashMap::new();
        let mut places = Vec::with_capacity(self.objects.len());
        for object in &self.objects {
            if !object.name.is_empty()
                && let Some(first) = seen.insert(&object.name, &object.key)
            {
                let what = format!("object `{}` is already at {first}", object.name);
                report.add(format!("{}.name", object.key), what, "give each its own name");
            }
            let mut row = vec![None; self.attributes.len()];
            for (name, value) in &object.attributes {
                let key = format!("{}.attributes.{name}", object.key);
                let Some(&k) = attributes.get(name.as_str()) else {
                    let known = self.attributes.iter().map(|attribute| &*attribute.name);
                    let help =
                        suggestion(name, known.clone(), || format!("use one of {}", names(known)));
                    report.add(key, format!("unknown attribute `{name}`"), help);
                    continue;
                };
                match values[k].get(value.as_str()) {
                    Some(&v) if v < COUNT_MAX => row[k] = Some(ValueId::from(v)),
                    Some(_) => {}
                    None => {
                        let what = format!("`{value}` is not a value of `{name}`");
                        let known = self.attributes[k].values.iter().map(|v| &*v.name);
                        let help = suggestion(value, known.clone(), || {
                            format!("use one of {} or list it there", names(known))
                        });
                        report.add(key, what, help);
                    }
                }
            }
            places.push(row);
        }
        places
    }

    /// `V`, in order of first appearance.
    fn words(&self) -> Vec<String> {
        let mut seen = std::collections::HashSet::new();
        let all = self.attributes.iter().flat_map(|a| &a.values).map(|value| &value.name);
        all.filter(|name| seen.insert(name.as_str())).cloned().collect()
    }

    fn build(self, words: Vec<String>, places: Vec<Vec<Option<ValueId>>>) -> Scene {
        let ids: HashMap<String, WordId> =
            words.iter().enumerate().map(|(w, word)| (word.clone(), WordId::from(w))).collect();
        let attributes = self.attributes.into_iter().map(|a| build_attribute(a, &ids)).collect();
        let objects = (self.objects.into_iter().zip(places))
            .map(|(object, values)| Object {
                name: object.name,
                number: None,
                values,
                chances: Vec::new(),
                taken: false,
                placement: object.placement,
            })
            .collect();
        let asks = wording::Asks {
            wanted: wordings(self.ask_wanted, &wording::ASK_WANTED),
            point: wordings(self.ask_point, &wording::ASK_POINT),
        };
        Scene::assemble(self.name, self.noun, asks, objects, attributes, words)
    }
}

fn role(name: Option<&String>) -> Option<Role> {
    Role::NAMES
        .iter()
        .find(|(known, _)| name.is_some_and(|name| name == known))
        .map(|(_, role)| *role)
}

fn check_roles(attribute: &DraftAttribute, report: &mut Checks<'_>) {
    let own = attribute.values.iter().map(|value| (&value.key, &value.role));
    for (key, name) in std::iter::once((&attribute.key, &attribute.role)).chain(own) {
        if let Some(name) = name.as_ref().filter(|name| role(Some(name)).is_none()) {
            let known = Role::NAMES.iter().map(|(name, _)| *name);
            let help = suggestion(name, known.clone(), || format!("use one of {}", names(known)));
            report.add(format!("{key}.role"), format!("unknown role `{name}`"), help);
        }
    }
}

/// The last word of the `spoken` forms of an attribute's values, if shared; or else its name.
fn shared_word(attribute: &DraftAttribute) -> String {
    let mut last = attribute.values.iter().map(|value| {
        let spoken = value.spoken.as_ref().unwrap_or(&value.name);
        spoken.rsplit(' ').next().unwrap_or_default()
    });
    let first = last.next().filter(|_| attribute.values.len() > 1);
    let shared = first.filter(|first| last.all(|word| word == *first));
    shared.unwrap_or(&attribute.name).to_owned()
}

fn build_attribute(attribute: DraftAttribute, ids: &HashMap<String, WordId>) -> Attribute {
    let shared = shared_word(&attribute);
    let name = attribute.name;
    let mut is_guessed = Vec::new();
    let mut values: Vec<Value> = (attribute.values.into_iter())
        .map(|value| {
            let spoken = value.spoken.unwrap_or_else(|| value.name.clone());
            let named = role(value.role.as_ref()).or(role(attribute.role.as_ref()));
            is_guessed.push(named.is_none());
            Value {
                word: ids[&value.name],
                role: named.unwrap_or_else(|| Role::guess(&name, &value.name, &spoken, &shared)),
                is_noun: is_part_of(&name, &spoken),
                spoken: with_capital(spoken),
                synonyms: value.synonyms.iter().map(|synonym| synonym.to_lowercase()).collect(),
                name: value.name,
            }
        })
        .collect();
    // "scissors" and "milk" in contrast to "a wrench".
    if values.iter().any(|value| value.role == Role::Kind) {
        let guessed = values.iter_mut().zip(is_guessed).filter(|(_, is_guessed)| *is_guessed);
        let qualities = guessed.filter(|(value, _)| value.role == Role::Quality);
        qualities.for_each(|(value, _)| value.role = Role::Kind);
    }
    if attribute.ask_yes_no.is_empty() {
        align_parts(&mut values);
    }
    let common = defaults(&values);
    Attribute {
        name,
        synonyms: attribute.synonyms.iter().map(|synonym| synonym.to_lowercase()).collect(),
        ask_yes_no: wordings(attribute.ask_yes_no, &[common.yes_no]),
        ask_which: wordings(attribute.ask_which, &[common.which]),
        values,
        by_place: false,
    }
}

/// The wordings of a file, or else the default ones.
fn wordings(own: Vec<String>, common: &[&str]) -> Vec<String> {
    if own.is_empty() { common.iter().map(|text| (*text).to_owned()).collect() } else { own }
}

/// Within one attribute every name and synonym must lead to one value, upper case aside.
fn check_values(attribute: &DraftAttribute, report: &mut Checks<'_>) {
    let mut owners: HashMap<String, &str> = HashMap::new();
    for value in attribute.values.iter().filter(|value| !value.name.is_empty()) {
        if owners.insert(value.name.to_lowercase(), &value.key).is_some() {
            let what = format!("value `{}` is listed twice", value.name);
            report.add(value.key.clone(), what, "list it once");
        }
    }
    for value in &attribute.values {
        for (n, synonym) in value.synonyms.iter().enumerate() {
            let owner = owners.entry(synonym.to_lowercase()).or_insert(&value.key);
            let key = format!("{}.synonyms[{n}]", value.key);
            if *owner != value.key {
                let what = format!("synonym `{synonym}` already stands for {owner}");
                report.add(key, what, "assign it to one value");
            } else if value.synonyms[..n].iter().any(|other| other == synonym) {
                report.add(key, format!("synonym `{synonym}` is listed twice"), "list it once");
            }
        }
    }
}

/// Longest wording of a question, in characters.
pub(crate) const WORDING_CHARS_MAX: usize = 120;

fn check_wording(attribute: &DraftAttribute, report: &mut Checks<'_>) {
    const SLOTS: [&str; 3] = ["{value}", "{attribute}", "{noun}"];
    let (yes_no, which) =
        (format!("{}.ask_yes_no", attribute.key), format!("{}.ask_which", attribute.key));
    for (key, text) in keyed(&yes_no, &attribute.ask_yes_no) {
        if !text.contains("{value}") {
            report.add(key, "expected the slot {value}", "write {value} for the value");
        }
    }
    check_texts(&yes_no, &attribute.ask_yes_no, &SLOTS, report);
    check_texts(&which, &attribute.ask_which, &SLOTS, report);
    for (key, text) in keyed(&which, &attribute.ask_which) {
        if text.contains("{value}") {
            report.add(key, "an open question cannot contain {value}", "remove it");
        }
    }
}

/// Checks every wording: known slots, length, duplicates.
fn check_texts(key: &str, texts: &[String], slots: &[&str], report: &mut Checks<'_>) {
    for (n, (key, text)) in keyed(key, texts).enumerate() {
        if let Some(slot) = wording::unknown_slot(text, slots) {
            let last = slots.len() - 1;
            let help = match slots.len() {
                1 => format!("the only slot is {}", slots[0]),
                _ => format!("the slots are {} and {}", slots[..last].join(", "), slots[last]),
            };
            report.add(&key, format!("unknown slot {slot}"), help);
        }
        let chars = text.chars().count();
        if chars > WORDING_CHARS_MAX {
            let help = format!("use at most {WORDING_CHARS_MAX}");
            report.add(&key, format!("{chars} characters are too long"), help);
        }
        if texts[..n].contains(text) {
            report.add(&key, "the same wording is listed twice", "list it once");
        }
    }
}

/// Each text with its key: the list's own if there is but one.
fn keyed<'a>(key: &str, texts: &'a [String]) -> impl Iterator<Item = (String, &'a String)> {
    let (key, alone) = (key.to_owned(), texts.len() == 1);
    let keyed = move |(n, text)| (if alone { key.clone() } else { format!("{key}[{n}]") }, text);
    texts.iter().enumerate().map(keyed)
}

/// The first few names, for help that fits on a line.
fn names<'a>(all: impl Iterator<Item = &'a str>) -> String {
    const SHOWN_MAX: usize = 8;
    let names: Vec<&str> = all.filter(|name| !name.is_empty()).take(SHOWN_MAX + 1).collect();
    let shown = names[..names.len().min(SHOWN_MAX)].join(", ");
    if names.len() > SHOWN_MAX { format!("{shown}, …") } else { shown }
}
