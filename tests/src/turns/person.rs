//! When a person answers what: seldom as it was expected.

use dialogue::{Answer, Model, Rng};
use preflight::log_normal;
use scene::{ObjectId, Question, Scene};
use service::{Span, Time};

/// How a person's words reach the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// A microphone that the robot hears live, so that it knows at once that somebody speaks.
    Live,
    /// A recording or transcript that arrives with its times when it is over; before people can
    /// speak they click and wait a second.
    Afterwards,
}

/// Whether people answer when they are expected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// After the question, soon.
    Good,
    /// Also late, early, into the next question, and twice.
    Bad,
}

/// What people do with a question, by probability: late, early, once more into the next question,
/// and twice in a row. Else they answer it when it was asked.
const MANNERS: [(Manner, f64); 4] =
    [(Manner::Late, 0.15), (Manner::Early, 0.12), (Manner::Over, 0.12), (Manner::Twice, 0.12)];
/// A reaction: median, seconds, and standard deviation of the logarithm.
const REACTION: (f64, f64) = (0.9, 0.55);
/// Reactions of people with good timing, seconds: least and most.
const PROMPT_S: (f64, f64) = (0.35, 2.2);
/// An answer's length.
const ANSWER_S: (f64, f64) = (0.55, 0.35);
/// A request's length, seconds.
const REQUEST_S: f64 = 1.6;
/// From the wish to speak to speech with a click, seconds.
const CLICK_S: f64 = 1.0;
/// Share of the answers that name the value in place of yes or no.
const BY_VALUE: f64 = 0.1;
/// Pause between two things that one person says, seconds.
const BREATH_S: f64 = 0.25;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Manner {
    Plain,
    Late,
    Early,
    Over,
    Twice,
}

/// Something that is going to be said.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Utterance {
    /// The prompt that it answers; 0 for the request.
    pub(super) prompt: u64,
    /// The question that it answers.
    pub(super) question: Question,
    pub(super) text: String,
    /// Whether it is a second thought.
    pub(super) again: bool,
    pub(super) onset: Time,
    pub(super) end: Time,
}

/// A question that the robot asks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heard {
    pub(super) prompt: u64,
    pub(super) question: Question,
    pub(super) began: Time,
    /// When it ends if nothing happens.
    pub(super) ends: Time,
}

/// An answer whose time is still to be found.
struct Planned {
    prompt: u64,
    question: Question,
    text: String,
    again: bool,
}

impl Planned {
    fn to(heard: Heard, text: String) -> Self {
        Self { prompt: heard.prompt, question: heard.question, text, again: false }
    }
}

/// Somebody who wants an object and tells the truth.
pub(super) struct Person {
    pub(super) wanted: ObjectId,
    channel: Channel,
    timing: Timing,
    window_s: f64,
    scene: Scene,
    model: Model,
    rng: Rng,
    /// What is going to be said, in order.
    plans: Vec<Utterance>,
    /// How each prompt is dealt with.
    manners: Vec<(u64, Manner)>,
    /// An answer that is going to be said once more, into the next question.
    over: Option<(u64, Question, String)>,
    /// Prompts that were answered.
    answered: Vec<u64>,
    /// When the person falls silent after all that was said so far.
    silent: Time,
}

impl Person {
    /// Somebody who begins with a request. `window_s` is the robot's response window.
    pub(super) fn new(
        scene: &Scene,
        model: Model,
        channel: Channel,
        timing: Timing,
        window_s: f64,
        seed: u64,
    ) -> Self {
        let mut rng = Rng::new(seed);
        let wanted = ObjectId::from(rng.below(scene.objects().len()));
        let onset = Time(100_000_000);
        let text = format!("get me the {}", scene.noun());
        let end = onset + Span::from_s(REQUEST_S);
        let request =
            Utterance { prompt: 0, question: Question::None, text, again: false, onset, end };
        Self {
            wanted,
            channel,
            timing,
            window_s,
            scene: scene.clone(),
            model,
            rng,
            plans: vec![request],
            manners: Vec::new(),
            over: None,
            answered: Vec::new(),
            silent: end,
        }
    }

    /// What begins to be said by now.
    pub(super) fn begins(&mut self, now: Time) -> Option<Utterance> {
        let first = self.plans.iter().position(|plan| plan.onset <= now)?;
        let said = self.plans.remove(first);
        self.answered.push(said.prompt);
        Some(said)
    }

    /// The robot begins to ask.
    pub(super) fn hear_begin(&mut self, heard: Heard) {
        let is_new = self.manners.iter().all(|(prompt, _)| *prompt != heard.prompt);
        if is_new {
            self.go_on_to_the_next();
        }
        let length_s = heard.ends.since(heard.began).s();
        if is_new && let Some((prompt, question, text)) = self.over.take() {
            let at = heard.began + Span::from_s(length_s * self.uniform(0.05, 0.95));
            self.plan(Planned { prompt, question, text, again: true }, at);
        }
        if is_new {
            let manner = self.manner();
            self.manners.push((heard.prompt, manner));
            if manner == Manner::Early {
                let at = heard.began + Span::from_s(length_s * self.uniform(0.5, 0.95));
                let text = self.answer(heard.question);
                self.plan(Planned::to(heard, text), at);
            }
        }
    }

    /// The robot has understood something and asks on: what it has been told need not be told to a
    /// repetition of the question as well. A second thought is had all the same.
    fn go_on_to_the_next(&mut self) {
        let Self { plans, answered, .. } = self;
        plans.retain(|plan| plan.again || !answered.contains(&plan.prompt));
    }

    /// The robot has asked to the end.
    pub(super) fn hear_end(&mut self, heard: Heard, ended: Time) {
        // Nobody answers an earlier question who has heard the next one whole.
        self.plans.retain(|plan| plan.prompt == heard.prompt || plan.prompt == 0);
        // Whoever is about to answer it does so, and no more often.
        if self.plans.iter().any(|plan| plan.prompt == heard.prompt) {
            return;
        }
        let known = self.manners.iter_mut().find(|(prompt, _)| *prompt == heard.prompt);
        let manner =
            known.map_or(Manner::Plain, |(_, manner)| std::mem::replace(manner, Manner::Plain));
        // An early answer was given already.
        if manner == Manner::Early {
            return;
        }
        let mut reaction_s = self.reaction_s();
        if manner == Manner::Late {
            reaction_s = self.window_s + self.uniform(-0.3, 2.5);
        }
        let text = self.answer(heard.question);
        let at = ended + Span::from_s(reaction_s);
        self.plan(Planned::to(heard, text.clone()), at);
        match manner {
            Manner::Twice => {
                let again = self.silent + Span::from_s(self.uniform(0.5, 2.5));
                self.plan(Planned { again: true, ..Planned::to(heard, text) }, again);
            }
            Manner::Over => self.over = Some((heard.prompt, heard.question, text)),
            _ => {}
        }
    }

    fn plan(&mut self, answer: Planned, at: Time) {
        let Planned { prompt, question, text, again } = answer;
        let click = match self.channel {
            Channel::Live => 0.0,
            Channel::Afterwards => CLICK_S,
        };
        let free = self.silent + Span::from_s(BREATH_S);
        let onset = (at + Span::from_s(click)).max(free);
        let end = onset + Span::from_s(log_normal(&mut self.rng, ANSWER_S.0, ANSWER_S.1));
        self.silent = end;
        self.plans.push(Utterance { prompt, question, text, again, onset, end });
    }

    fn manner(&mut self) -> Manner {
        let mut left = self.rng.uniform();
        if self.timing == Timing::Good {
            return Manner::Plain;
        }
        for (manner, probability) in MANNERS {
            left -= probability;
            if left < 0.0 {
                return manner;
            }
        }
        Manner::Plain
    }

    fn reaction_s(&mut self) -> f64 {
        let drawn = log_normal(&mut self.rng, REACTION.0, REACTION.1);
        match self.timing {
            Timing::Good => drawn.clamp(PROMPT_S.0, PROMPT_S.1),
            Timing::Bad => drawn,
        }
    }

    fn answer(&mut self, question: Question) -> String {
        let answer = Answer::truthful(&self.model, question, self.wanted);
        let by_value = self.rng.uniform() < BY_VALUE;
        if let (Question::Attribute(k, _), true) = (question, by_value)
            && let Some(value) = self.model.value(self.wanted, k)
        {
            let value = &self.scene.attributes()[k.index()].values[value.index()];
            return format!("it is {}", value.spoken);
        }
        answer.text(&self.scene).to_owned()
    }

    fn uniform(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.rng.uniform()
    }
}
