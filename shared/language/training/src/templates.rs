//! Lines made of templates: the ordinary requests, which authors of hard lines do not write.

use language::{Polarity, words_of_group};
use scene::{Role, Scene, Value};
use vocabulary::Rng;

use crate::line::{Line, Marked};

/// Attempts to fill the slots of a template with values that do not contradict each other.
const ATTEMPTS: usize = 8;
/// Slots, without the sign of their polarity: those of any question, then of one about an
/// attribute, then of one about a value.
const SLOTS: [&str; 8] = ["", "q", "k", "p", "b", "other", "rival", "asked"];

/// Returns lines from the templates of a file about one scene, `times` each; reproducible.
///
/// # Errors
/// The first template that is not of this form, in a sentence.
pub fn templates(text: &str, times: usize, name: &str, scene: &Scene) -> Result<Vec<Line>, String> {
    let mut random = Rng::new(scene.key());
    let mut lines = Vec::new();
    let is_template = |line: &&str| !line.is_empty() && !line.starts_with('#');
    for line in text.lines().filter(is_template) {
        let (question, template) =
            line.split_once(" | ").ok_or_else(|| format!("expected 2 fields, found {line}"))?;
        check(question, template).map_err(|why| format!("{why} in {line}"))?;
        for _ in 0..times {
            let made = (0..ATTEMPTS).find_map(|_| {
                let chosen = choose(template, &mut random);
                Filling::new(scene, &mut random, question).fill(name, &chosen)
            });
            lines.extend(made);
        }
    }
    Ok(lines)
}

/// Checks the question and the slots of a template.
fn check(question: &str, template: &str) -> Result<(), String> {
    let slots = match question {
        "-" => &SLOTS[..6],
        "which" => &SLOTS[..7],
        "is" => &SLOTS,
        _ => return Err(format!("expected `-`, `is` or `which`, found `{question}`")),
    };
    for slot in template.split('<').skip(1) {
        let (slot, _) = slot.split_once('>').ok_or("expected \">\", found none")?;
        let kind = slot.strip_suffix(['+', '-', '0']);
        if !kind.is_some_and(|kind| slots.contains(&kind)) {
            return Err(format!("expected a slot of {slots:?} with a sign, found <{slot}>"));
        }
    }
    for group in template.split('{').skip(1) {
        let (group, _) = group.split_once('}').ok_or("expected \"}\", found none")?;
        if words_of_group(group).is_empty() {
            return Err(format!("expected a group of words, found {{{group}}}"));
        }
    }
    Ok(())
}

/// Replaces each `(a|b)` by one part, the innermost first, and each `{group}` by one of its words.
fn choose(template: &str, random: &mut Rng) -> String {
    let mut chosen = template.to_owned();
    while let Some(end) = chosen.find(')')
        && let Some(start) = chosen[..end].rfind('(')
    {
        let parts: Vec<&str> = chosen[start + 1..end].split('|').collect();
        let part = parts[random.below(parts.len())].to_owned();
        chosen.replace_range(start..=end, &part);
    }
    while let (Some(start), Some(end)) = (chosen.find('{'), chosen.find('}')) {
        let words = words_of_group(&chosen[start + 1..end]);
        chosen.replace_range(start..=end, words[random.below(words.len())]);
    }
    chosen
}

/// A template on the way to a line.
struct Filling<'a> {
    scene: &'a Scene,
    random: &'a mut Rng,
    question: String,
    /// The value or the attribute that the question names.
    asked: Option<(usize, Option<usize>)>,
    /// Values said already, as attribute and value.
    said: Vec<(usize, usize)>,
    marked: Vec<Marked>,
}

impl<'a> Filling<'a> {
    fn new(scene: &'a Scene, random: &'a mut Rng, question: &str) -> Self {
        let k = random.below(scene.attributes().len());
        let attribute = &scene.attributes()[k];
        let v = random.below(attribute.values.len());
        let (question, asked) = match question {
            "is" => (format!("Is it {}?", attribute.values[v].name), Some((k, Some(v)))),
            "which" => (format!("Which {} is it?", attribute.name), Some((k, None))),
            _ => (String::new(), None),
        };
        Self { scene, random, question, asked, said: Vec::new(), marked: Vec::new() }
    }

    fn fill(mut self, name: &str, template: &str) -> Option<Line> {
        let mut text = String::new();
        let mut rest = template;
        while let Some((before, slot)) = rest.split_once('<') {
            let (slot, after) = slot.split_once('>')?;
            text += before;
            text += &self.slot(slot)?;
            rest = after;
        }
        text += rest;
        // A description may end in "one" itself.
        let text = text.replace(" one one", " one");
        let scene = name.to_owned();
        Some(Line { scene, question: self.question, act: "want".into(), text, marked: self.marked })
    }

    fn slot(&mut self, slot: &str) -> Option<String> {
        let (kind, polarity) = slot.split_at(slot.len().checked_sub(1)?);
        let polarity = crate::line::polarity(polarity.chars().next()?)?;
        match kind {
            "" => self.description(polarity),
            "q" => self.one(Role::Quality, polarity),
            "k" => self.one(Role::Kind, polarity),
            "p" => self.one(Role::Place, polarity),
            "b" => {
                let (k, v) = self.of_role(Role::Place)?;
                self.say_as(k, v, polarity, &self.value(k, v).name)
            }
            "other" => {
                let (k, _) = *self.said.last()?;
                let v = self.random.below(self.scene.attributes()[k].values.len());
                self.say(k, v, polarity)
            }
            "asked" => {
                let (k, v) = self.asked?;
                self.say(k, v?, polarity)
            }
            "rival" => {
                let (k, asked) = self.asked?;
                let v = self.random.below(self.scene.attributes()[k].values.len());
                (asked != Some(v)).then(|| self.say(k, v, polarity))?
            }
            _ => None,
        }
    }

    fn value(&self, k: usize, v: usize) -> &'a Value {
        &self.scene.attributes()[k].values[v]
    }

    /// Says a value, if nothing was said of it.
    fn say(&mut self, k: usize, v: usize, polarity: Polarity) -> Option<String> {
        let value = self.value(k, v);
        let surface = match value.role() {
            Role::Place | Role::Part => &value.spoken,
            Role::Quality | Role::Kind => &value.name,
        };
        self.say_as(k, v, polarity, surface)
    }

    fn say_as(&mut self, k: usize, v: usize, polarity: Polarity, surface: &str) -> Option<String> {
        if self.said.contains(&(k, v)) {
            return None;
        }
        self.said.push((k, v));
        self.marked.push(Marked { surface: surface.to_owned(), polarity });
        Some(surface.to_owned())
    }

    /// Says one value of the given role.
    fn one(&mut self, role: Role, polarity: Polarity) -> Option<String> {
        let (k, v) = self.of_role(role)?;
        self.say(k, v, polarity)
    }

    fn of_role(&mut self, role: Role) -> Option<(usize, usize)> {
        let all = self.scene.attributes().iter().enumerate().flat_map(|(k, attribute)| {
            let of_role = attribute.values.iter().enumerate().filter(|it| it.1.role() == role);
            of_role.map(move |(v, _)| (k, v))
        });
        let all: Vec<(usize, usize)> = all.collect();
        all.get(self.random.below(all.len().max(1))).copied()
    }

    /// Describes an object: "small red mug in the cabinet", "red one".
    fn description(&mut self, polarity: Polarity) -> Option<String> {
        let objects = self.scene.objects();
        let object = &objects[self.random.below(objects.len())];
        let values = object.values.iter().enumerate();
        let values = values.filter_map(|(k, v)| Some((k, (*v)?.index()))).collect::<Vec<_>>();
        let of = |role: Role| {
            let is_its =
                |it: &&(usize, usize)| self.scene.attributes()[it.0].values[it.1].role() == role;
            values.iter().filter(is_its).copied().collect::<Vec<_>>()
        };
        let (mut qualities, kinds, places) = (of(Role::Quality), of(Role::Kind), of(Role::Place));
        let has_kinds = self
            .scene
            .attributes()
            .iter()
            .flat_map(|it| &it.values)
            .any(|it| it.role() == Role::Kind);
        let mut words = Vec::new();
        let count = [1, 1, 1, 2, 0][self.random.below(5)];
        for _ in 0..count.min(qualities.len()) {
            let (k, v) = qualities.remove(self.random.below(qualities.len()));
            words.push(self.say(k, v, polarity)?);
        }
        match kinds.first().filter(|_| words.is_empty() || self.random.below(3) > 0) {
            Some((k, v)) => words.push(self.say(*k, *v, polarity)?),
            None if words.is_empty() => return None,
            None if has_kinds || self.random.below(2) > 0 => words.push("one".to_owned()),
            None => words.push(self.scene.noun().to_owned()),
        }
        if let Some((k, v)) = places.first().filter(|_| self.random.below(5) == 0) {
            words.push(self.say(*k, *v, polarity)?);
        }
        Some(words.join(" "))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    #[test]
    fn wrong_template_is_an_error() {
        let text = include_str!("../../../../config/scenes/bowls.toml");
        let scene = Scene::from_toml("bowls.toml", text).unwrap();
        let made = |text: &str| templates(text, 1, "bowls", &scene);
        for file in [include_str!("../templates.txt"), include_str!("../hard_templates.txt")] {
            assert!(!made(file).unwrap().is_empty());
        }
        for (wrong, why) in [
            ("the <+>", "expected 2 fields"),
            ("why | the <+>", "found `why`"),
            ("- | the <+> or (|the <x+>)", "found <x+>"),
            ("- | the <q*>", "found <q*>"),
            ("- | the <>", "found <>"),
            ("- | the <q+", "expected \">\""),
            ("which | the <asked+>", "found <asked+>"),
            ("- | the <rival->", "found <rival->"),
        ] {
            let error = made(wrong).unwrap_err();
            assert!(error.contains(why), "{wrong}: {error}");
        }
    }
}
