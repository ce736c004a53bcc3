//! Judges a dialogue: the expectations of its case, and what holds of every dialogue.

use std::collections::HashSet;
use std::fmt::Write as _;

use scene::{ObjectId, Scene};
use service::{Span, Time};

use crate::case::{Case, Check};
use crate::group::{Line, Seen};
use crate::person::{Person, Said};

/// Longest time from an utterance to the robot's first sound.
const REPLY: Span = Span::from_ms(1_000);

/// What became of a dialogue.
#[derive(Debug, Default)]
pub(crate) struct Verdict {
    pub(crate) is_right: bool,
    pub(crate) replies: usize,
    /// Replies that were not as expected, and too many questions.
    pub(crate) unexpected: Vec<String>,
    /// Utterances without a reply within a second.
    pub(crate) unanswered: Vec<String>,
    /// Questions asked twice in the same words.
    pub(crate) repeated: Vec<String>,
    pub(crate) questions: usize,
    /// Whether a question was asked although the description was unique.
    pub(crate) was_asked_for_nothing: bool,
    pub(crate) story: String,
}

pub(crate) fn judge(case: &Case, scene: &Scene, person: &Person<'_>, seen: &Seen) -> Verdict {
    let mut verdict = Verdict { story: story(scene, person, seen), ..Verdict::default() };
    verdict.is_right = is_right(case, scene, seen);
    for (n, said) in person.said.iter().enumerate() {
        judge_reply(&mut verdict, scene, seen, said, person.said.get(n + 1));
    }
    verdict.questions = questions_before_last_pick(seen);
    if let Some(most) = case.questions_max {
        verdict.replies += 1;
        if verdict.questions > most {
            verdict.unexpected.push(format!("{} questions, at most {most}", verdict.questions));
        }
        verdict.was_asked_for_nothing = most == 0 && verdict.questions > 0;
    }
    verdict.repeated = repeated(person, seen);
    if person.gave_up {
        verdict.unexpected.push("the person gave up".to_owned());
    }
    verdict
}

fn name(scene: &Scene, object: ObjectId) -> &str {
    &scene.object(object).name
}

/// Returns whether exactly these objects were delivered, and nothing else is on its way.
fn is_right(case: &Case, scene: &Scene, seen: &Seen) -> bool {
    let fits = |(expected, (_, object)): (&Vec<String>, &(Time, ObjectId))| {
        expected.iter().any(|one| one == name(scene, *object))
    };
    let is_over = !seen.is_fetching || seen.is_stopped;
    seen.delivered.len() == case.gets.len()
        && is_over
        && case.gets.iter().zip(&seen.delivered).all(fits)
}

fn judge_reply(
    verdict: &mut Verdict,
    scene: &Scene,
    seen: &Seen,
    said: &Said,
    next: Option<&Said>,
) {
    let reply = Reply {
        scene,
        lines: &seen.lines[said.line..next.map_or(seen.lines.len(), |next| next.line)],
        picks: seen.picks[said.pick..next.map_or(seen.picks.len(), |next| next.pick)]
            .iter()
            .map(|(_, _, object)| name(scene, *object))
            .collect(),
        deliveries: (seen.delivered.iter())
            .filter(|(at, _)| *at >= said.at && next.is_none_or(|next| *at < next.at))
            .count(),
        put_back: (seen.put_back.iter())
            .filter(|(at, _)| *at >= said.at && next.is_none_or(|next| *at < next.at))
            .map(|(_, object)| name(scene, *object))
            .collect(),
        rest: &seen.lines[said.line..],
        before: &seen.lines[..said.line],
    };
    let is_quick = reply.lines.first().is_some_and(|line| line.at <= said.at + REPLY);
    let text = said.text.as_deref();
    if let Some(text) = text.filter(|_| !is_quick) {
        verdict.unanswered.push(format!("“{text}”"));
    }
    if said.expected.is_empty() {
        return;
    }
    verdict.replies += 1;
    let failed: Vec<&str> = said
        .expected
        .iter()
        .filter(|clause| !reply.is(&clause.check))
        .map(|clause| clause.text.as_str())
        .collect();
    if !failed.is_empty() {
        let to = text.unwrap_or("(no words)");
        let found = reply.text();
        verdict.unexpected.push(format!("“{to}” → “{found}”; expected: {}", failed.join("; ")));
    }
}

/// What the robot said and did before the person's next words.
struct Reply<'a> {
    scene: &'a Scene,
    lines: &'a [Line],
    picks: Vec<&'a str>,
    deliveries: usize,
    put_back: Vec<&'a str>,
    /// Its lines from then to the end of the dialogue.
    rest: &'a [Line],
    before: &'a [Line],
}

impl Reply<'_> {
    fn text(&self) -> String {
        self.lines.iter().map(|line| line.text.as_str()).collect::<Vec<_>>().join(" / ")
    }

    fn is(&self, check: &Check) -> bool {
        let says = |phrases: &[String]| {
            let text = plain(&self.text());
            phrases.iter().any(|phrase| text.contains(&plain(phrase)))
        };
        match check {
            Check::Replies => !self.lines.is_empty(),
            Check::Quiet => self.lines.is_empty(),
            Check::Asks => self.lines.iter().any(Line::asks),
            Check::AsksNothing => !self.lines.iter().any(Line::asks),
            Check::AsksAbout(name) => self.lines.iter().any(|line| self.mentions(line, name)),
            Check::AsksNotAbout(name) => !self.lines.iter().any(|line| self.is_about(line, name)),
            Check::AsksNoMoreAbout(name) => !self.rest.iter().any(|line| self.is_about(line, name)),
            Check::Repeats => {
                let asked = self.before.iter().rev().find(|line| line.asks());
                let again = self.lines.iter().find(|line| line.asks());
                asked.zip(again).is_some_and(|(asked, again)| {
                    asked.question == again.question || plain(&asked.text) == plain(&again.text)
                })
            }
            Check::Fetches(objects) => {
                self.picks.iter().any(|pick| objects.iter().any(|object| object == pick))
            }
            Check::FetchesNothing => self.picks.is_empty(),
            Check::DeliversNothing => self.deliveries == 0,
            Check::PutsBack(object) => self.put_back == [object],
            Check::PutsNothingBack => self.put_back.is_empty(),
            Check::Says(phrases) => says(phrases),
            Check::SaysNot(phrases) => !says(phrases),
        }
    }

    /// Returns whether the robot asks about this attribute.
    fn is_about(&self, line: &Line, attribute_name: &str) -> bool {
        let about = line.question.attribute();
        line.asks() && about.is_some() && about == self.scene.attribute_named(attribute_name)
    }

    /// The same, or a choice between some of its values.
    fn mentions(&self, line: &Line, attribute_name: &str) -> bool {
        let k = self.scene.attribute_named(attribute_name).expect("an attribute of the scene");
        let attribute = &self.scene.attributes()[usize::from(k.0)];
        let text = plain(&line.text);
        let names = attribute.values.iter().filter(|value| text.contains(&plain(&value.name)));
        self.is_about(line, attribute_name) || line.asks() && names.count() > 0
    }
}

/// The words of a text in lower case, each between blanks.
fn plain(text: &str) -> String {
    let lower = text.to_lowercase().replace('’', "'");
    let words = lower.split(|c: char| !c.is_alphanumeric() && c != '\'').filter(|w| !w.is_empty());
    words.fold(" ".to_owned(), |all, word| all + word + " ")
}

fn questions_before_last_pick(seen: &Seen) -> usize {
    let until = seen.picks.last().map_or(Time(u64::MAX), |(at, ..)| *at);
    seen.lines.iter().filter(|line| line.asks() && line.at < until).count()
}

/// Questions in the words of an earlier one: since the latest delivery or new beginning, unless it
/// was broken off or the person asked for a repetition.
fn repeated(person: &Person<'_>, seen: &Seen) -> Vec<String> {
    let wishes = |said: &&Said| {
        said.is_afresh || said.expected.iter().any(|clause| clause.check == Check::Repeats)
    };
    let wished: Vec<Time> = person.said.iter().filter(wishes).map(|said| said.at).collect();
    let begins: Vec<Time> = seen.delivered.iter().map(|(at, _)| *at).chain(wished).collect();
    let mut asked: HashSet<String> = HashSet::new();
    let mut since = Time(0);
    let mut repeated = Vec::new();
    for line in seen.lines.iter().filter(|line| line.asks() && line.is_whole) {
        if begins.iter().any(|begin| since < *begin && *begin <= line.at) {
            asked.clear();
        }
        since = line.at;
        if !asked.insert(plain(&line.text)) {
            repeated.push(format!("“{}”", line.text));
        }
    }
    repeated
}

/// The dialogue as text.
fn story(scene: &Scene, person: &Person<'_>, seen: &Seen) -> String {
    let mut events: Vec<(Time, String)> = Vec::new();
    for said in &person.said {
        let text = said.text.as_deref().unwrap_or("(no words)");
        events.push((said.at, format!("you    {text}")));
    }
    for line in &seen.lines {
        let note = if line.is_whole { "" } else { " …" };
        events.push((line.at, format!("robot  {}{note}", line.text)));
    }
    for (at, _, object) in &seen.picks {
        events.push((*at, format!("       [picks {}]", name(scene, *object))));
    }
    for (at, object) in &seen.delivered {
        events.push((*at, format!("       [delivered {}]", name(scene, *object))));
    }
    events.sort_by_key(|(at, _)| *at);
    let mut story = String::new();
    for (at, what) in events {
        let _ = writeln!(story, "    {:7.2} s  {what}", at.ns() as f64 / 1e9);
    }
    for note in &seen.refused {
        let _ = writeln!(story, "    refused: {note}");
    }
    story
}
