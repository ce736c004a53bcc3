//! Conversations about the six bowls: `conversations.txt` holds what is said and done, and below it what comes of it.
//! `UPDATE_EXPECT=1` writes the latter again. Every conversation is also folded again from its journal.
//!
//! | line | meaning |
//! |---|---|
//! | `== TITLE` | begins a conversation |
//! | `with gestures` · `with history` · `with absent` | the same with another setting |
//! | `you READING` | an utterance that answers nothing |
//! | `answer READING` | an utterance that answers the robot's latest line |
//! | `points OBJECT READING` | such an utterance, or none, with a gesture towards an object |
//! | `answers READING` · `truth OBJECT` | the same answer · true answers for an object, as long as the robot asks |
//! | `silence` | the response window passes |
//! | `arm OUTCOME` | the arm ends its order |
//! | `motion STATE` · `stop confirmed` · `stop late` | the motion stop · its report after a spoken order |
//! | `belief` | prints the objects of at least 0.1 %, with their probabilities in percent |
//! | `mark` · `back` | remembers the state · continues from there |
//!
//! A reading has words of the scene, an answer (`no`), an intent (`put_back`), a reference (`other`), words of what is
//! excluded (`-small,white`), of a further object (`+big,metallic`), or that the scene lacks (`?kind:plate`), and a
//! relation: the second from the left (`nth:left,2`), or more to the left than the further objects (`more:left`).
//!
//! What comes of it is the act with the key of its order (interaction/attempt) or else the open interaction, its words
//! and the rule that led to it, and whatever has changed of ended interaction, concessions, deliveries, queue, object that
//! goes back, and spoken stop.

use super::fixture::{Settings, at, settings, settings_with, typed, words};
use crate::manager::{Cause, Manager, MotionStop, Record, State, Utterance, refold};
use crate::rendering;
use expect_test::expect_file;
use scene::{ObjectId, Question, Reading, Reference, Relation, Response, Scene, UnknownWord};
use serde::de::DeserializeOwned;
use serde_json::{from_value, json};
use std::sync::LazyLock;
use vocabulary::ids::{PickId, PromptId};
use vocabulary::{ActKind, PriorObjects};

static SCENE: LazyLock<Scene> = LazyLock::new(|| settings().scene);

/// Most answers to a robot that goes on asking.
const ANSWERS_MAX: usize = 20;

#[test]
fn conversations_are_held_as_recorded() {
    let file = expect_file!["conversations.txt"];
    let (mut held, mut talk) = (String::new(), Talk::new(settings()));
    let given = file.data();
    for line in given.lines().filter(|line| !line.starts_with("  ")) {
        held += line;
        held.push('\n');
        match line.split_once(' ').unwrap_or((line, "")) {
            ("" | "#", _) => {}
            ("==", _) => {
                talk.fold_again(line);
                talk = Talk::new(settings());
            }
            ("with", what) => talk = Talk::new(with(what)),
            ("belief", _) => held += &format!("{}\n", belief(&talk.state)),
            ("mark", _) => talk.mark = (talk.state.clone(), talk.records.len()),
            ("back", _) => {
                talk.fold_again(line);
                talk.back();
            }
            (verb, rest) => held += &talk.happen(verb, rest),
        }
    }
    talk.fold_again("the end");
    file.assert_eq(&held);
}

/// The shipped settings with a change.
fn with(what: &str) -> Settings {
    settings_with(|it| match what {
        "gestures" => it.gestures = true,
        "history" => it.prior.objects = PriorObjects::History,
        "absent" => it.prior.absent = 0.1,
        _ => panic!("unknown setting `{what}`"),
    })
}

struct Talk {
    settings: Settings,
    manager: Manager,
    state: State,
    records: Vec<Record>,
    /// The state to go back to, and the number of records up to it.
    mark: (State, usize),
}

impl Talk {
    fn new(settings: Settings) -> Self {
        let manager = settings.manager();
        let state = manager.first();
        Self { settings, manager, mark: (state.clone(), 0), state, records: Vec::new() }
    }

    fn back(&mut self) {
        self.state = self.mark.0.clone();
        self.records.truncate(self.mark.1);
    }

    fn fold_again(&self, line: &str) {
        let folded = refold(&mut self.settings.manager(), &self.records);
        folded.unwrap_or_else(|mismatch| panic!("before `{line}`: {mismatch}"));
    }

    /// Carries out a line, and returns what comes of it.
    fn happen(&mut self, verb: &str, rest: &str) -> String {
        let cause = match verb {
            "you" => self.said(PromptId(0), rest),
            "answer" => self.said(self.state.act.prompt, rest),
            "points" => {
                let (object, reading) = rest.split_once(' ').unwrap_or((rest, ""));
                let object = self.manager.scene().object_named(object).expect("an object");
                let gesture = self.manager.scene().object(object).placement.map(|it| it.xyz);
                let Cause::Utterance(said) = self.said(self.state.act.prompt, reading) else {
                    unreachable!("an utterance")
                };
                Cause::Utterance(Utterance { gesture, ..said })
            }
            "answers" => return self.answers(|_| rest.to_owned()),
            "truth" => {
                let object = self.manager.scene().object_named(rest).expect("an object");
                return self.answers(|talk| talk.true_of(object).to_owned());
            }
            "silence" => Cause::Silence,
            "arm" => {
                let (pick, _) = self.state.ordered().expect("an order");
                Cause::PickEnded { pick, outcome: named(rest).expect("an outcome") }
            }
            "motion" => Cause::MotionStop(match rest {
                "stopping" => MotionStop::Stopping,
                "stopped" => MotionStop::Stopped,
                _ => MotionStop::Released,
            }),
            "stop" => Cause::StopReport { confirmed: rest == "confirmed" },
            _ => panic!("unknown line `{verb} {rest}`"),
        };
        self.step(cause)
    }

    fn answers(&mut self, mut answer: impl FnMut(&Self) -> String) -> String {
        let mut held = String::new();
        for _ in 0..ANSWERS_MAX {
            if self.state.act.kind != ActKind::Ask {
                return held;
            }
            let said = answer(self);
            let cause = self.said(self.state.act.prompt, &said);
            held += &self.step(cause);
        }
        panic!("it goes on asking: {held}");
    }

    /// The true answer for an object.
    fn true_of(&self, object: ObjectId) -> &'static str {
        let is_true = match self.state.act.question {
            Question::Attribute(k, v) => self.manager.scene().has(object, k, v),
            Question::Point(offered) => offered == object,
            other => panic!("{other:?}"),
        };
        if is_true { "yes" } else { "no" }
    }

    fn said(&self, prompt: PromptId, text: &str) -> Cause {
        let (reading, unknown) = read(text);
        let said = typed(self.state.applied.0 + 1, prompt, reading);
        Cause::Utterance(Utterance { unknown, ..said })
    }

    fn step(&mut self, cause: Cause) -> String {
        let (before, at) = (self.state.clone(), at(self.records.len() as u64 + 1));
        self.manager.step(&mut self.state, &cause, at);
        let rule = match cause {
            Cause::Utterance(_) => format!(" [{}]", self.manager.rule()),
            _ => String::new(),
        };
        self.records.push(Record { cause, at, state: self.state.clone() });
        let act = (self.state.act != before.act).then(|| act(&self.state));
        let act = act.unwrap_or_else(|| "as before".to_owned());
        match changes(&before, &self.state) {
            none if none.is_empty() => format!("  {act}{rule}\n"),
            changes => format!("  {act}{rule}\n  {changes}\n"),
        }
    }
}

/// Reads the tokens of a reading.
fn read(text: &str) -> (Reading, Option<UnknownWord>) {
    let (mut reading, mut unknown) = (Reading::default(), None);
    let group = |list: &str| words(&list.split(',').collect::<Vec<_>>()).base;
    for token in text.split(' ').filter(|token| !token.is_empty()) {
        if let Some(list) = token.strip_prefix('-') {
            reading.excluded.push(group(list));
        } else if let Some(list) = token.strip_prefix('+') {
            reading.further.push(group(list));
        } else if let Some((role, word)) = token.strip_prefix('?').and_then(|it| it.split_once(':'))
        {
            let role = named(role).expect("a role");
            unknown = Some(UnknownWord { text: word.to_owned(), role });
        } else if let Some((kind, of)) = token.split_once(':') {
            let (measure, n) = of.split_once(',').unwrap_or((of, ""));
            let measure = named(measure).expect("a measure");
            reading.refers = Reference::Relation(match kind {
                "nth" => Relation::Nth(measure, n.parse().expect("a number")),
                _ => Relation::More(measure),
            });
        } else if let Some(intent) = named(token) {
            reading.intent = intent;
        } else if let Some(response) = named::<Response>(token) {
            reading.response = response;
        } else if let Some(refers) = named(token) {
            reading.refers = refers;
        } else {
            reading.base.extend(group(token));
        }
    }
    (reading, unknown)
}

/// The variant of an enum with that name.
fn named<T: DeserializeOwned>(name: &str) -> Option<T> {
    from_value(json!(name)).ok()
}

fn name(object: ObjectId) -> String {
    SCENE.objects().get(object.index()).map_or("absent", |it| &it.name).to_owned()
}

fn key(PickId { interaction, attempt }: PickId) -> String {
    format!("{}/{attempt}", interaction.0)
}

fn act(state: &State) -> String {
    let order = state.act.pick.map(|(id, object)| format!(" {} {}", name(object), key(id)));
    let open = state.open.as_ref().map(|open| format!(" in {}", open.id.0));
    let text = rendering::text(&SCENE, &state.act);
    let line = format!("{}{}: {text}", state.act.kind.name(), order.or(open).unwrap_or_default());
    line.trim_end().to_owned()
}

/// A part of the state: its name, and how it is printed.
type Part = (&'static str, fn(&State) -> String);

/// What has changed of the state besides the act.
fn changes(before: &State, after: &State) -> String {
    let parts: [Part; 6] = [
        ("ended", |it| {
            let ended =
                it.ended.as_ref().map(|ended| (ended.interaction.0, ended.outcome, &ended.name));
            ended.map_or_else(String::new, |(id, outcome, name)| {
                format!("{id} {outcome:?} {}", name.as_deref().unwrap_or_default())
            })
        }),
        ("conceded", conceded),
        ("delivered", |it| it.history.iter().map(|(name, n)| format!("{name} {n} ")).collect()),
        ("queue", |it| it.queue.iter().map(|words| format!("{words:?} ")).collect()),
        ("goes back", |it| it.putting_back.as_ref().map(|it| name(it.object)).unwrap_or_default()),
        ("stop", |it| match it.stop.order {
            None => String::new(),
            Some(order) => if order.is_late { "late" } else { "ordered" }.to_owned(),
        }),
    ];
    let changed = parts.into_iter().filter(|(_, of)| of(before) != of(after));
    let line = |(what, of): Part| format!("{what}: {}", of(after));
    let changed: Vec<String> = changed.map(line).collect();
    changed.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("; ")
}

/// Attributes of which the user has said that they cannot tell, or that they do not matter.
fn conceded(state: &State) -> String {
    let conceded = state.open.iter().map(|open| &open.conceded);
    conceded
        .flat_map(|it| it.unknown.iter().chain(&it.indifferent))
        .map(|k| format!("{k} "))
        .collect()
}

fn belief(state: &State) -> String {
    let Some(open) = &state.open else { return "  none".to_owned() };
    let all = open.belief().probabilities().into_iter().enumerate();
    let likely = all.filter(|(_, p)| *p >= 1e-3);
    likely.map(|(i, p)| format!("  {} {:.1}", name(i.into()), 100.0 * p)).collect()
}
