//! Cases as text: what a person says, what a kind and quick robot would do, and what is delivered.
//! `cases/README.md` describes the format.

use std::fs;
use std::path::{Path, PathBuf};

/// A dialogue with its expectations.
#[derive(Clone, Debug, Default)]
pub(crate) struct Case {
    /// File and line, for failures.
    pub(crate) place: String,
    pub(crate) name: String,
    pub(crate) scene: PathBuf,
    /// Deliveries in order; each is one of several objects.
    pub(crate) gets: Vec<Vec<String>>,
    pub(crate) questions_max: Option<usize>,
    pub(crate) steps: Vec<Step>,
    pub(crate) rules: Vec<Rule>,
}

/// A part of the script, and what is expected of the robot's reply to it.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    pub(crate) action: Action,
    pub(crate) expected: Vec<Clause>,
}

/// What the person does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Action {
    Say(String),
    /// Says it; from here on anything may be asked again.
    SayAfresh(String),
    /// Says it as soon as the robot has announced what it fetches.
    SayDuringFetch(String),
    /// Says it when the gripper is about to open for the user.
    SayBeforeOpening(String),
    /// Says it when the gripper opens.
    SayWhileOpening(String),
    Silence,
    StopMotion,
    ResumeMotion,
    /// Wants another object from here on.
    Want(String),
    AnswerUntilFetching,
    AnswerUntilDelivered,
}

/// An answer of this person to a question of the robot, other than the truth.
#[derive(Clone, Debug)]
pub(crate) struct Rule {
    /// The attribute asked about; `None` for any question.
    pub(crate) about: Option<String>,
    pub(crate) text: String,
    /// Whether it holds for every such question, or for the first one.
    pub(crate) always: bool,
    pub(crate) expected: Vec<Clause>,
}

/// An expectation of a reply, with its source text.
#[derive(Clone, Debug)]
pub(crate) struct Clause {
    pub(crate) text: String,
    pub(crate) check: Check,
}

/// A class of replies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Check {
    Replies,
    Quiet,
    Asks,
    AsksNothing,
    AsksAbout(String),
    /// Not in this reply.
    AsksNotAbout(String),
    /// Not in the rest of the interaction.
    AsksNoMoreAbout(String),
    /// The same question is asked again, as the person wished.
    Repeats,
    /// One of these objects.
    Fetches(Vec<String>),
    FetchesNothing,
    /// Nothing is handed over before the person's next words.
    DeliversNothing,
    /// This object is back in its place before the person's next words.
    PutsBack(String),
    PutsNothingBack,
    /// One of these phrases.
    Says(Vec<String>),
    /// None of these phrases.
    SaysNot(Vec<String>),
}

/// Reads all cases of a folder, in the order of file names and lines.
pub(crate) fn read_all(folder: &Path) -> Vec<Case> {
    let entries = fs::read_dir(folder.join("cases")).expect("the folder of cases");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    files.retain(|path| path.extension().is_some_and(|it| it == "txt"));
    files.sort();
    files.iter().flat_map(|file| read(folder, file)).collect()
}

fn read(folder: &Path, file: &Path) -> Vec<Case> {
    let text = fs::read_to_string(file).expect("a file of cases");
    let title = file.file_stem().expect("a name").to_string_lossy().into_owned();
    let mut cases: Vec<Case> = Vec::new();
    let mut scene = PathBuf::new();
    let mut to_rule = false;
    for (number, line) in text.lines().enumerate() {
        let place = format!("{title}:{}", number + 1);
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        if word == "scene" {
            scene = scene_file(folder, rest);
            continue;
        }
        if word == "case" {
            let (name, scene) = (rest.to_owned(), scene.clone());
            cases.push(Case { place, name, scene, ..Case::default() });
            continue;
        }
        let case = cases.last_mut().unwrap_or_else(|| panic!("{place}: expected `case`"));
        if word == "robot" {
            let expected = match to_rule {
                true => case.rules.last_mut().map(|rule| &mut rule.expected),
                false => case.steps.last_mut().map(|step| &mut step.expected),
            };
            let expected = expected.unwrap_or_else(|| panic!("{place}: nothing was said yet"));
            expected.extend(rest.split(';').map(|text| clause(text.trim(), &place)));
            continue;
        }
        to_rule = matches!(word, "asked" | "always");
        read_line(case, word, rest, &place);
    }
    cases
}

fn scene_file(folder: &Path, name: &str) -> PathBuf {
    let shipped = folder.join("../../config/scenes").join(format!("{name}.toml"));
    let own = folder.join("scenes").join(format!("{name}.toml"));
    if own.exists() { own } else { shipped }
}

fn read_line(case: &mut Case, word: &str, rest: &str, place: &str) {
    let text = rest.to_owned();
    let action = match (word, rest) {
        ("gets", "nothing") => return,
        ("gets", _) => {
            case.gets.extend(rest.split(',').map(|one| alternatives(one, " or ")));
            return;
        }
        ("most", _) => {
            case.questions_max = Some(rest.parse().unwrap_or_else(|_| panic!("{place}: a number")));
            return;
        }
        ("asked" | "always", _) => {
            let (about, text) = rest.split_once(" say ").unwrap_or_else(|| panic!("{place}: say"));
            let about = about.trim_start_matches("asked ").trim();
            case.rules.push(Rule {
                about: (about != "anything").then(|| about.to_owned()),
                text: text.to_owned(),
                always: word == "always",
                expected: Vec::new(),
            });
            return;
        }
        ("you", _) => Action::Say(text),
        ("afresh", _) => Action::SayAfresh(text),
        ("meanwhile", _) => Action::SayDuringFetch(text),
        ("arriving", _) => Action::SayBeforeOpening(text),
        ("late", _) => Action::SayWhileOpening(text),
        ("wants", _) => Action::Want(text),
        ("silence", "") => Action::Silence,
        ("stop", "") => Action::StopMotion,
        ("resume", "") => Action::ResumeMotion,
        ("answer", "until fetching") => Action::AnswerUntilFetching,
        ("answer", "until delivered") => Action::AnswerUntilDelivered,
        _ => panic!("{place}: unknown line `{word} {rest}`"),
    };
    case.steps.push(Step { action, expected: Vec::new() });
}

fn clause(text: &str, place: &str) -> Clause {
    let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
    let check = match (word, rest) {
        ("replies", "") => Check::Replies,
        ("quiet", "") => Check::Quiet,
        ("repeats", "") => Check::Repeats,
        ("asks", "") => Check::Asks,
        ("asks", "nothing") => Check::AsksNothing,
        ("fetches", "nothing") => Check::FetchesNothing,
        ("delivers", "nothing") => Check::DeliversNothing,
        ("puts", "nothing back") => Check::PutsNothingBack,
        ("puts", _) if rest.starts_with("back ") => Check::PutsBack(rest[5..].to_owned()),
        ("fetches", _) => Check::Fetches(alternatives(rest, " or ")),
        ("says", _) if rest.starts_with("not ") => Check::SaysNot(alternatives(&rest[4..], "|")),
        ("says", _) => Check::Says(alternatives(rest, "|")),
        ("asks", _) if rest.starts_with("about ") => Check::AsksAbout(rest[6..].to_owned()),
        ("asks", _) if rest.starts_with("not about ") => Check::AsksNotAbout(rest[10..].to_owned()),
        ("asks", _) if rest.starts_with("no more about ") => {
            Check::AsksNoMoreAbout(rest[14..].to_owned())
        }
        _ => panic!("{place}: unknown expectation `{text}`"),
    };
    Clause { text: text.to_owned(), check }
}

fn alternatives(text: &str, between: &str) -> Vec<String> {
    text.split(between).map(|one| one.trim().to_owned()).collect()
}
