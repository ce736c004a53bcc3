//! Dialogues as people hold them, written before the code that they judge: 280 cases on nine scenes
//! that no rule was tuned on. Each is held with the real services in one thread and simulated time, by
//! a person who follows a script and answers truthfully whatever else the robot asks.
//!
//! ```text
//! cargo test -p whichone-tests --test talk -- --nocapture                  # table and failures
//! WHICHONE_CASE="white cup" cargo test -p whichone-tests --test talk -- --nocapture  # whole dialogues
//! ```
//!
//! Of every dialogue: the right objects in the right order, a reply to every utterance within a second,
//! and no question twice in the same words. `cases/README.md` describes the cases, `score.toml` holds
//! the score, which may only become better.

mod case;
mod group;
mod page;
mod person;
mod verdict;

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use case::{Case, Check};
use config::Settings;
use group::{Group, Robot};
use page::{Held, Page};
use person::Person;
use scene::Scene;
use service::{Span, Time};
use verdict::Verdict;
use whichone_tests::settings;

/// A dialogue that takes longer is stuck.
const END: Time = Time(600_000_000_000);

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/talk"))
}

/// The shipped configuration with that scene, and an arm at its real speed.
fn configured(scene: &Path) -> Settings {
    settings(&[
        ("group.scene", scene.to_str().expect("a path")),
        ("arm.time_scale", "1.0"),
        ("arm.joint_rate_hz", "20.0"),
    ])
}

fn all_settings(cases: &[Case]) -> HashMap<PathBuf, Settings> {
    let mut all = HashMap::new();
    for case in cases {
        all.entry(case.scene.clone()).or_insert_with(|| configured(&case.scene));
    }
    all
}

/// Objects and attributes that a case names are in its scene.
fn check_names(case: &Case, scene: &Scene) {
    let place = &case.place;
    let is_object = |name: &str| {
        assert!(scene.object_named(name).is_some(), "{place}: no object `{name}`");
    };
    let is_attribute = |name: &str| {
        assert!(scene.attribute_named(name).is_some(), "{place}: no attribute `{name}`");
    };
    case.gets.iter().flatten().for_each(|name| is_object(name));
    case.rules.iter().filter_map(|rule| rule.about.as_deref()).for_each(is_attribute);
    let of_steps = case.steps.iter().flat_map(|step| &step.expected);
    for clause in of_steps.chain(case.rules.iter().flat_map(|rule| &rule.expected)) {
        match &clause.check {
            Check::Fetches(objects) => objects.iter().for_each(|name| is_object(name)),
            Check::AsksAbout(k) | Check::AsksNotAbout(k) | Check::AsksNoMoreAbout(k) => {
                is_attribute(k);
            }
            _ => {}
        }
    }
}

fn hold(case: &Case, settings: &Settings) -> Verdict {
    check_names(case, &settings.scene);
    let mut group = Group::new(settings);
    let person = talk(case, &settings.scene, &mut group);
    verdict::judge(case, &settings.scene, &person, group.seen())
}

/// Has the case's person talk to a robot until both are done.
fn talk<'a>(case: &'a Case, scene: &'a Scene, robot: &mut impl Robot) -> Person<'a> {
    let mut person = Person::new(case, scene);
    while robot.now() < END && !person.is_done {
        robot.advance();
        if let Some(input) = person.look(robot.now(), robot.seen()) {
            robot.put(input);
        }
    }
    person
}

/// Holds all dialogues, two at a time.
fn hold_all(cases: &[Case]) -> Vec<Verdict> {
    let settings = all_settings(cases);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut verdicts = Vec::new();
        while let Some((n, case)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|n| Some((n, cases.get(n)?)))
        {
            verdicts.push((n, hold(case, &settings[&case.scene])));
        }
        verdicts
    };
    let mut verdicts: Vec<(usize, Verdict)> = std::thread::scope(|scope| {
        let workers = [(); 2].map(|()| scope.spawn(work));
        workers.into_iter().flat_map(|it| it.join().expect("dialogues")).collect()
    });
    verdicts.sort_by_key(|(n, _)| *n);
    verdicts.into_iter().map(|(_, verdict)| verdict).collect()
}

/// Counts of a set of dialogues.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    cases: usize,
    right: usize,
    replies: usize,
    expected: usize,
    unique: usize,
    unique_without_question: usize,
    repeated: usize,
    unanswered: usize,
    questions: usize,
}

impl Score {
    fn add(&mut self, case: &Case, verdict: &Verdict) {
        let is_unique = case.questions_max == Some(0);
        self.cases += 1;
        self.right += usize::from(verdict.is_right);
        self.replies += verdict.replies;
        self.expected += verdict.replies.saturating_sub(verdict.unexpected.len());
        self.unique += usize::from(is_unique);
        self.unique_without_question += usize::from(is_unique && !verdict.was_asked_for_nothing);
        self.repeated += verdict.repeated.len();
        self.unanswered += verdict.unanswered.len();
        self.questions += verdict.questions;
    }

    fn row(&self, name: &str) -> String {
        let share = |n: usize, of: usize| format!("{n}/{of}");
        format!(
            "{name:<12} {:>9} {:>9} {:>9} {:>9.1} {:>6} {:>6}\n",
            share(self.right, self.cases),
            share(self.expected, self.replies),
            share(self.unique_without_question, self.unique),
            self.questions as f64 / self.cases.max(1) as f64,
            self.repeated,
            self.unanswered,
        )
    }
}

/// Table by file, then what was wrong in each dialogue.
fn report(cases: &[Case], verdicts: &[Verdict], is_whole: bool) -> (String, Score) {
    let mut files: BTreeMap<&str, Score> = BTreeMap::new();
    let mut all = Score::default();
    let mut failures = String::new();
    for (case, verdict) in cases.iter().zip(verdicts) {
        let file = case.place.split(':').next().unwrap_or_default();
        files.entry(file).or_default().add(case, verdict);
        all.add(case, verdict);
        let _ = write!(failures, "{}", failure(case, verdict, is_whole));
    }
    let mut text = format!(
        "\n{:<12} {:>9} {:>9} {:>9} {:>9} {:>6} {:>6}\n",
        "cases", "right", "replies", "unique", "questions", "twice", "silent"
    );
    files.iter().for_each(|(file, score)| text += &score.row(file));
    text += &all.row("all");
    (text + "\n" + &failures, all)
}

fn failure(case: &Case, verdict: &Verdict, is_whole: bool) -> String {
    let mut text = String::new();
    let mut note = |kind: &str, what: &str| {
        let _ = writeln!(text, "  {kind:<11} {what}");
    };
    if !verdict.is_right {
        note("object", "not the right one");
    }
    verdict.unexpected.iter().for_each(|it| note("reply", it));
    verdict.unanswered.iter().for_each(|it| note("silent", it));
    verdict.repeated.iter().for_each(|it| note("twice", it));
    if text.is_empty() && !is_whole {
        return text;
    }
    let story = if is_whole || !verdict.is_right { verdict.story.as_str() } else { "" };
    format!("{} {}\n{text}{story}", case.place, case.name)
}

/// Bounds of the score.
#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Bounds {
    wrong_objects_max: usize,
    unexpected_replies_max: usize,
    needless_questions_max: usize,
    repeated_questions_max: usize,
    unanswered_max: usize,
}

impl Bounds {
    fn read() -> Self {
        let path = folder().join("score.toml");
        let text = std::fs::read_to_string(path).expect("the score");
        toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"))
    }

    fn check(&self, score: &Score) {
        let found = [
            ("dialogues with a wrong object", score.cases - score.right, self.wrong_objects_max),
            ("unexpected replies", score.replies - score.expected, self.unexpected_replies_max),
            (
                "unique descriptions with a question",
                score.unique - score.unique_without_question,
                self.needless_questions_max,
            ),
            ("questions twice in the same words", score.repeated, self.repeated_questions_max),
            ("utterances without a reply", score.unanswered, self.unanswered_max),
        ];
        let worse: Vec<String> = found
            .iter()
            .filter(|(_, found, most)| found > most)
            .map(|(what, found, most)| format!("{found} {what}, at most {most}"))
            .collect();
        assert!(worse.is_empty(), "worse than score.toml: {}", worse.join("; "));
    }
}

#[test]
#[allow(clippy::print_stdout, reason = "the table")]
fn dialogues_go_as_people_expect() {
    let wish = std::env::var("WHICHONE_CASE").ok();
    let mut cases = case::read_all(folder());
    if let Some(wish) = &wish {
        cases.retain(|case| format!("{} {}", case.place, case.name).contains(wish.as_str()));
    }
    let verdicts = hold_all(&cases);
    let (text, score) = report(&cases, &verdicts, wish.is_some());
    println!("{text}");
    if wish.is_none() {
        Bounds::read().check(&score);
    }
}

/// Time after a fetch in which the robot says how it has ended.
const AFTERWARDS: Span = Span::from_ms(1_000);

/// Has the cases' persons talk to the services and to the demo, and compares. Both have the shipped configuration.
fn compare_with_demo(is_chosen: impl Fn(&Case) -> bool) {
    let shipped = |case: &Case| case.scene.file_stem().is_some_and(|scene| scene == "bowls");
    let mut cases = case::read_all(folder());
    cases.retain(|case| shipped(case) && is_chosen(case));
    assert!(cases.len() >= 10, "{} cases", cases.len());
    let config = folder().join("../../config");
    let settings = preflight::load(&config, None, &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut differ = Vec::new();
    for case in &cases {
        let (mut group, mut page) = (Group::new(&settings), Page::new(&settings.scene));
        let (services, demo) =
            (held(case, &settings, &mut group), held(case, &settings, &mut page));
        if services != demo {
            let Case { place, name, .. } = case;
            differ.push(format!("{place} {name}: services {services:#?}, demo {demo:#?}"));
        }
    }
    assert!(differ.is_empty(), "{} of {}:\n{}", differ.len(), cases.len(), differ.join("\n"));
}

/// Holds a dialogue, up to the end of what is fetched and what the robot says of it.
fn held(case: &Case, settings: &Settings, robot: &mut impl Robot) -> Held {
    talk(case, &settings.scene, robot);
    let mut until = robot.now() + AFTERWARDS;
    while robot.now() < until.min(END) {
        robot.advance();
        if robot.seen().is_fetching && !robot.seen().is_stopped {
            until = robot.now() + AFTERWARDS;
        }
    }
    Held::of(robot.seen())
}

#[test]
fn demo_holds_the_same_dialogues_as_the_services() {
    compare_with_demo(|case| {
        ["bowls:", "fresh_rest:"].iter().any(|file| case.place.starts_with(file))
    });
}

#[test]
fn demo_holds_every_dialogue_about_the_bowls_as_the_services() {
    compare_with_demo(|_| true);
}
