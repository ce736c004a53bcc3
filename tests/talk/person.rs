//! A person who follows a script, and answers truthfully whatever else the robot asks.

use messages::MotionOrder;
use scene::{AttributeId, ObjectId, Question, Scene, ValueId};
use service::{Span, Time};

use crate::case::{Action, Case, Check, Clause, Step};
use crate::group::{Input, Line, Seen};

/// Time from the end of the robot's line to the person's next words.
const REACTION: Span = Span::from_ms(1_000);
/// Time from the announcement of a pick to a protest against it.
const PROTEST: Span = Span::from_ms(1_200);
/// Seconds before an object is let go of from which the gripper is about to open, and opens.
const ARRIVING_S: f64 = 1.3;
const OPENING_S: f64 = 0.5;
/// Time after which a person without a reply goes on.
const PATIENCE: Span = Span::from_ms(12_000);
/// Longest silence of a person who is waited for.
const SILENCE: Span = Span::from_ms(40_000);
/// Time after which a person repeats the request because the robot has nothing more to say.
const WAIT: Span = Span::from_ms(4_000);
/// Time for which the person stays after the last delivery.
const STAY: Span = Span::from_ms(4_000);
/// Times that a person speaks before giving up.
const TURNS_MAX: usize = 25;
/// Words before which a place is put after the noun.
const PREPOSITIONS: [&str; 9] =
    ["in", "on", "at", "under", "inside", "behind", "near", "by", "next"];

/// What the person has done, with the robot's lines and picks from then on.
#[derive(Clone, Debug)]
pub(crate) struct Said {
    pub(crate) at: Time,
    /// What was said; `None` for silence and for the stop button.
    pub(crate) text: Option<String>,
    pub(crate) line: usize,
    pub(crate) pick: usize,
    pub(crate) expected: Vec<Clause>,
    pub(crate) is_afresh: bool,
    is_silence: bool,
    is_scripted: bool,
}

/// A person, and how far they are.
pub(crate) struct Person<'a> {
    case: &'a Case,
    scene: &'a Scene,
    next: usize,
    /// Deliveries when the present step became the next.
    delivered: usize,
    /// The object wanted instead of the next delivery, and the number of deliveries then.
    wants: Option<(usize, String)>,
    used: Vec<bool>,
    pub(crate) said: Vec<Said>,
    pub(crate) is_done: bool,
    pub(crate) gave_up: bool,
}

impl<'a> Person<'a> {
    pub(crate) fn new(case: &'a Case, scene: &'a Scene) -> Self {
        Self {
            case,
            scene,
            next: 0,
            delivered: 0,
            wants: None,
            used: vec![false; case.rules.len()],
            said: Vec::new(),
            is_done: false,
            gave_up: false,
        }
    }

    /// Decides what to do now.
    pub(crate) fn look(&mut self, now: Time, seen: &Seen) -> Option<Input> {
        while let Some(Step { action: Action::Want(object), .. }) = self.case.steps.get(self.next) {
            self.wants = Some((seen.delivered.len(), object.clone()));
            self.go_on(seen);
        }
        let step = self.case.steps.get(self.next);
        if seen.is_fetching {
            let announced = || seen.picks.last().is_some_and(|(at, ..)| now >= *at + PROTEST);
            let is_within = |max_s: f64| seen.lets_go_s.is_some_and(|left_s| left_s <= max_s);
            let due = match step.map(|step| &step.action) {
                Some(Action::SayDuringFetch(text)) => Some((text, announced())),
                Some(Action::SayBeforeOpening(text)) => Some((text, is_within(ARRIVING_S))),
                Some(Action::SayWhileOpening(text)) => Some((text, is_within(OPENING_S))),
                _ => None,
            };
            if let Some((text, is_due)) = due {
                return is_due.then(|| self.perform(now, seen, Some(text.clone())));
            }
        }
        if !self.is_at_rest(now, seen) {
            return None;
        }
        let Some(step) = step else { return self.after_script(now, seen) };
        if self.awaits_a_pick(seen) && step.action != Action::Silence {
            return self.answer(now, seen);
        }
        match &step.action {
            Action::AnswerUntilFetching if seen.picks.len() > self.picks_before() => {
                self.go_on(seen);
                None
            }
            Action::AnswerUntilDelivered if seen.delivered.len() > self.delivered => {
                self.go_on(seen);
                None
            }
            Action::AnswerUntilFetching
            | Action::AnswerUntilDelivered
            | Action::SayDuringFetch(_)
            | Action::SayBeforeOpening(_)
            | Action::SayWhileOpening(_)
            | Action::Want(_) => self.answer(now, seen),
            Action::Say(text) | Action::SayAfresh(text) => {
                Some(self.perform(now, seen, Some(text.clone())))
            }
            Action::Silence => {
                self.perform(now, seen, None);
                None
            }
            Action::StopMotion => {
                self.perform(now, seen, None);
                Some(Input::Motion(MotionOrder::Stop))
            }
            Action::ResumeMotion => {
                self.perform(now, seen, None);
                Some(Input::Motion(MotionOrder::Resume))
            }
        }
    }

    /// Returns whether the person expects a pick that has not been announced since: then the script
    /// waits, and the person answers.
    fn awaits_a_pick(&self, seen: &Seen) -> bool {
        let scripted = self.said.iter().rev().find(|said| said.is_scripted);
        scripted.is_some_and(|said| {
            let picks = |clause: &Clause| matches!(clause.check, Check::Fetches(_));
            said.expected.iter().any(picks) && seen.picks.len() == said.pick
        })
    }

    /// Picks that were announced before the person last said something.
    fn picks_before(&self) -> usize {
        self.said.last().map_or(0, |said| said.pick)
    }

    fn go_on(&mut self, seen: &Seen) {
        self.next += 1;
        self.delivered = seen.delivered.len();
    }

    /// Performs the present step.
    fn perform(&mut self, now: Time, seen: &Seen, text: Option<String>) -> Input {
        let step = &self.case.steps[self.next];
        let is_silence = step.action == Action::Silence;
        let is_afresh = matches!(step.action, Action::SayAfresh(_));
        self.note(now, seen, text.clone(), step.expected.clone());
        if let Some(said) = self.said.last_mut() {
            (said.is_silence, said.is_afresh, said.is_scripted) = (is_silence, is_afresh, true);
        }
        self.go_on(seen);
        Input::Text(text.unwrap_or_default())
    }

    fn note(&mut self, at: Time, seen: &Seen, text: Option<String>, expected: Vec<Clause>) {
        let (line, pick) = (seen.lines.len(), seen.picks.len());
        self.said.push(Said {
            at,
            text,
            line,
            pick,
            expected,
            is_afresh: false,
            is_silence: false,
            is_scripted: false,
        });
    }

    /// Returns whether it is the person's turn.
    fn is_at_rest(&self, now: Time, seen: &Seen) -> bool {
        if seen.is_talking || now < seen.quiet_since + REACTION {
            return false;
        }
        let has_just_got = seen.delivered.last().is_some_and(|(at, _)| now < *at + REACTION);
        if has_just_got || seen.is_fetching && !seen.is_stopped {
            return false;
        }
        let Some(said) = self.said.last() else { return true };
        let patience = if said.is_silence { SILENCE } else { PATIENCE };
        let has_reply = seen.lines.len() > said.line;
        has_reply && now >= said.at + REACTION || now >= said.at + patience
    }

    fn after_script(&mut self, now: Time, seen: &Seen) -> Option<Input> {
        let latest = seen.delivered.last().map_or(Time(0), |(at, _)| *at);
        let since = latest.max(seen.quiet_since).max(self.said.last()?.at);
        if seen.delivered.len() >= self.case.gets.len() {
            self.is_done = now >= since + STAY;
            return None;
        }
        self.answer(now, seen)
    }

    /// Answers the robot's question; without one, describes what is wanted after a while.
    fn answer(&mut self, now: Time, seen: &Seen) -> Option<Input> {
        if self.said.len() >= TURNS_MAX {
            (self.is_done, self.gave_up) = (true, true);
            return None;
        }
        let asks = seen.lines.last().filter(|line| line.asks());
        let is_new = self.said.last().is_none_or(|said| seen.lines.len() > said.line);
        if !(asks.is_some() && is_new || now >= seen.quiet_since + WAIT) {
            return None;
        }
        let (text, expected) = self.reply(asks.filter(|_| is_new), seen);
        self.note(now, seen, Some(text.clone()), expected);
        Some(Input::Text(text))
    }

    fn reply(&mut self, asked: Option<&Line>, seen: &Seen) -> (String, Vec<Clause>) {
        let question = asked.map_or(Question::None, |line| line.question);
        let about = question.attribute().map(|k| &self.scene.attributes()[usize::from(k.0)].name);
        if asked.is_some() {
            for (rule, used) in self.case.rules.iter().zip(&mut self.used) {
                let fits = rule.about.is_none() || rule.about.as_ref() == about;
                if fits && (rule.always || !*used) {
                    // What is expected of the first answer is not counted again for the next.
                    let is_first = !std::mem::replace(used, true);
                    let expected = if is_first { rule.expected.clone() } else { Vec::new() };
                    return (rule.text.clone(), expected);
                }
            }
        }
        (self.truth(question, seen), Vec::new())
    }

    fn wanted(&self, seen: &Seen) -> Option<ObjectId> {
        let count = seen.delivered.len();
        let now = self.wants.as_ref().filter(|(at, _)| *at == count).map(|(_, name)| name);
        let next = || self.case.gets.get(count).or(self.case.gets.last())?.first();
        self.scene.object_named(now.or_else(next)?)
    }

    fn truth(&self, question: Question, seen: &Seen) -> String {
        let Some(wanted) = self.wanted(seen) else { return "never mind".to_owned() };
        let yes_or_no = |is: bool| if is { "yes" } else { "no" }.to_owned();
        match question {
            Question::None => describe(self.scene, wanted),
            Question::Point(object) => yes_or_no(object == wanted),
            Question::Attribute(k, v) => yes_or_no(self.scene.has(wanted, k, v)),
            Question::Which(k) => match self.scene.object(wanted).values[usize::from(k.0)] {
                Some(v) => spoken(self.scene, k, v).to_owned(),
                None => "I don't know".to_owned(),
            },
            Question::Choice(k, options) => match self.scene.object(wanted).values[k.index()] {
                Some(v) if options.contains(v) => spoken(self.scene, k, v).to_owned(),
                _ => "none of them".to_owned(),
            },
        }
    }
}

fn spoken(scene: &Scene, k: AttributeId, v: ValueId) -> &str {
    &scene.attributes()[usize::from(k.0)].values[usize::from(v.0)].spoken
}

/// Describes an object as a person does: "the small white cup next to the sink".
fn describe(scene: &Scene, object: ObjectId) -> String {
    let (mut qualities, mut noun, mut places) = (String::new(), scene.noun(), String::new());
    for (k, v) in scene.object(object).values.iter().enumerate() {
        let Some(v) = v else { continue };
        let value = spoken(scene, AttributeId::from(k), *v);
        let first = value.split(' ').next().unwrap_or_default();
        if PREPOSITIONS.contains(&first) {
            places += &format!(" {value}");
        } else if matches!(first, "a" | "an") {
            noun = value.split_once(' ').map_or(value, |(_, noun)| noun);
        } else {
            qualities += &format!("{value} ");
        }
    }
    format!("the {qualities}{noun}{places}")
}
