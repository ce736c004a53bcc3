//! A client: talks to the robot, observes the dialogue and the arm, and stops it.

use std::time::{Duration, Instant};

use messages::{
    ArmStatus, Ended, Injection, MotionOrder, PolicyView, Presented, PromptId, Receipt,
    ReceiptStatus, Sound, StopId, topics,
};
use runtime::bus::{Bus, EncodedReader, EncodedWriter, Reader};
use runtime::client::{Polling, submit};
use runtime::clock;
use runtime::exit::{Exit, Failure};
use runtime::group::{ENV_GROUP, GroupName, GroupPaths};
use runtime::stop_socket::{self, RELEASE_PATIENCE, StopError, StopState, default_patience};
use runtime::submission::Submission;
use runtime::{Span, Time};
use scene::{ObjectId, Question, Scene};
use vocabulary::PersonId;

use crate::settings;

/// Time for the speech service to accept an utterance.
const ACCEPT_PATIENCE: Span = Span::from_ms(10_000);

/// What the robot says of itself: the latest state of the dialogue and of the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Belief, question, decision, latest outcome.
    pub dialogue: PolicyView,
    /// Phase of the pick, and the motion stop.
    pub arm: ArmStatus,
    /// What was said aloud or shown last.
    pub presented: Presented,
}

impl State {
    /// Returns the robot's question and its prompt's number and presentation, once it has been put to the user: an
    /// answer counts from then on.
    pub fn open_question(&self) -> Option<((u64, u32), Question)> {
        let prompt = self.dialogue.open_question(&self.presented)?;
        Some((prompt, self.dialogue.question))
    }
}

/// A client of a running group. It polls, so that it costs the services nothing.
#[derive(Debug)]
pub struct Client {
    paths: GroupPaths,
    scene: Scene,
    injections: EncodedWriter<Injection>,
    receipts: Reader<Receipt>,
    views: EncodedReader<PolicyView>,
    arm: Reader<ArmStatus>,
    prompts: Reader<Presented>,
    view: Option<PolicyView>,
    status: Option<ArmStatus>,
    presented: Presented,
    /// Whether a change was taken in that the user has not been handed.
    is_new: bool,
    /// The latest utterance of this client, 0 for none.
    said: u64,
    /// Who speaks through this client.
    from: PersonId,
    client: runtime::client::Client,
}

impl Client {
    /// Joins the group that `WHICHONE_GROUP` names, or the default one.
    ///
    /// # Errors
    /// The group is not running, or this program has messages of another version.
    pub fn join() -> Result<Self, Failure> {
        let name = std::env::var(ENV_GROUP).unwrap_or_else(|_| GroupName::DEFAULT.to_owned());
        Self::join_group(&name)
    }

    /// Joins the group of this name.
    ///
    /// # Errors
    /// As [`Client::join`].
    pub fn join_group(name: &str) -> Result<Self, Failure> {
        let paths = GroupPaths::resolve(&GroupName::new(name)?)?;
        let client = runtime::client::Client::join(&paths)?;
        let (injections, receipts) = client.submissions()?;
        let bus = client.bus();
        Ok(Self {
            scene: settings::scene(&paths)?,
            injections,
            receipts,
            views: bus.encoded_reader(&topics::VIEW)?,
            arm: bus.reader(&topics::STATUS)?,
            prompts: bus.reader(&topics::PRESENTED)?,
            view: None,
            status: None,
            presented: Presented::default(),
            is_new: false,
            said: 0,
            from: PersonId::default(),
            client,
            paths,
        })
    }

    /// The scene of the group.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The group's shared memory, to read other topics.
    pub fn bus(&self) -> &Bus {
        self.client.bus()
    }

    /// States who speaks through this client from now on; at first nobody in particular. What they have had fetched
    /// teaches the robot how they speak, and `whichone people forget` has it forget that.
    ///
    /// # Errors
    /// A name of more than 64 bytes, or one that cannot be printed.
    pub fn speak_as(&mut self, name: &str) -> Result<(), Failure> {
        let wrong = |error: vocabulary::NotAPerson| Failure::new(Exit::Usage, error.to_string());
        self.from = PersonId::new(name).map_err(wrong)?;
        Ok(())
    }

    /// Says something to the robot, as if typed, in answer to its latest line. Returns the utterance's number once it
    /// is durable: it will be applied, whatever is killed meanwhile.
    ///
    /// # Errors
    /// Refused (the reason is in the message), or no answer within 10 s.
    pub fn say(&mut self, text: &str) -> Result<u64, Failure> {
        self.submit(Sound::Text(text.to_owned()), None)
    }

    /// Says something in answer to the line `seen`, the latest one that the person was shown
    /// ([`PolicyView::prompt`]). Words that answer a line which was not said yet wait for it for a second.
    ///
    /// # Errors
    /// As [`Client::say`].
    pub fn answer(&mut self, text: &str, seen: PromptId) -> Result<u64, Failure> {
        self.submit(Sound::Text(text.to_owned()), Some(seen))
    }

    /// Points at a place, metres in frame `base`, with words or without.
    ///
    /// # Errors
    /// As [`Client::say`].
    pub fn point(&mut self, target_m: [f64; 3], words: &str) -> Result<u64, Failure> {
        self.submit(Sound::Point { target_m, words: words.to_owned() }, None)
    }

    fn submit(&mut self, sound: Sound, seen: Option<PromptId>) -> Result<u64, Failure> {
        self.take()?;
        let said = (clock::now(), Time(0));
        let shown = self.view.as_ref().map_or(0, |view| view.prompt);
        let seen = seen.unwrap_or(PromptId(shown.max(self.presented.prompt)));
        let Self { injections, receipts, from, .. } = self;
        let mut submission = Submission::new(sound, said, clock::now(), ACCEPT_PATIENCE)
            .after(seen)
            .by(from.as_str());
        let receipts = submit(injections, receipts, &mut submission, || None)?;
        let receipt = receipts.first();
        let accepted = receipt.filter(|receipt| receipt.status == ReceiptStatus::Accepted);
        if let Some(receipt) = accepted {
            self.said = receipt.seq;
            return Ok(receipt.seq);
        }
        let why = receipt.and_then(|receipt| receipt.note.as_str().ok()).unwrap_or("no receipt");
        Err(Failure::new(Exit::NotReached, format!("not accepted: {why}")))
    }

    /// Returns the state now; none until the robot has stated it after this client has joined.
    ///
    /// # Errors
    /// The group's shared memory is lost.
    pub fn look(&mut self) -> Result<Option<State>, Failure> {
        self.take()?;
        self.is_new = false;
        Ok(self.state())
    }

    /// Takes in what is new.
    fn take(&mut self) -> Result<(), Failure> {
        let mut view = None;
        self.views.drain_in_turn(|payload| view = Some(payload))?;
        let status = self.arm.latest()?;
        let presented = self.prompts.latest()?.unwrap_or(self.presented);
        self.is_new |= view.as_ref().is_some_and(|view| self.view.as_ref() != Some(view))
            || status.is_some_and(|status| self.status != Some(status))
            || presented != self.presented;
        self.presented = presented;
        self.view = view.or(self.view.take());
        self.status = status.or(self.status);
        Ok(())
    }

    fn state(&self) -> Option<State> {
        let presented = self.presented;
        Some(State { dialogue: self.view.clone()?, arm: self.status?, presented })
    }

    /// Waits for the next change of the state.
    ///
    /// # Errors
    /// The group's shared memory is lost.
    pub fn next_change(&mut self) -> Result<State, Failure> {
        let mut polling = Polling::default();
        loop {
            self.take()?;
            if let Some(state) = self.state().filter(|_| self.is_new) {
                self.is_new = false;
                return Ok(state);
            }
            polling.pause();
        }
    }

    /// Returns each change of the state, without end. A step waits for the next change.
    pub fn watch(&mut self) -> impl Iterator<Item = Result<State, Failure>> + '_ {
        std::iter::repeat_with(|| self.next_change())
    }

    /// Waits for the outcome of what this client has said last: the end of the interaction that it is part of. None
    /// where the words have opened none: they asked for nothing that is here.
    ///
    /// # Errors
    /// No outcome within `patience`, or the group's shared memory is lost.
    pub fn await_pick(&mut self, patience: Duration) -> Result<Option<Ended>, Failure> {
        let until = Instant::now() + patience;
        let mut polling = Polling::default();
        loop {
            self.take()?;
            match self.view.as_ref().map(|view| outcome(view, self.said)) {
                Some(Awaited::Ended(ended)) => return Ok(Some(*ended)),
                Some(Awaited::Nothing) => return Ok(None),
                Some(Awaited::Open) | None => {}
            }
            if Instant::now() >= until {
                let what = format!("no outcome within {} s", patience.as_secs_f64());
                let help = "help: see `whichone watch` for what the robot waits for";
                return Err(Failure::new(Exit::NotReached, format!("{what}; {help}")));
            }
            polling.pause();
        }
    }

    /// Stops the arm at once and latches the stop. Returns once the arm has confirmed it: latched, at rest. The order
    /// is repeated for as long as the group runs, however long the arm's service is away; warnings in the log say
    /// meanwhile that it is not confirmed. Use the robot's own emergency stop then.
    ///
    /// # Errors
    /// A later order overrules it, the robot is not heard, or the group is down: the robot may still move.
    pub fn stop(&self) -> Result<StopState, Failure> {
        self.order(MotionOrder::Stop, default_patience(MotionOrder::Stop))
    }

    /// As [`Client::stop`], for at most `patience`. The order is not repeated after that.
    ///
    /// # Errors
    /// As [`Client::stop`], or not confirmed in time.
    pub fn stop_within(&self, patience: Duration) -> Result<StopState, Failure> {
        self.order(MotionOrder::Stop, Some(Span::from_s(patience.as_secs_f64())))
    }

    /// Releases the motion stop, whichever is in force.
    ///
    /// # Errors
    /// Not confirmed within 5 s.
    pub fn resume(&self) -> Result<StopState, Failure> {
        self.release(StopId(0))
    }

    /// Releases this stop, the one that the person saw ([`ArmStatus::stop`]).
    ///
    /// # Errors
    /// Another stop has been given since, and holds; or not confirmed within 5 s.
    pub fn release(&self, stop: StopId) -> Result<StopState, Failure> {
        let mut warn = warning(MotionOrder::Resume);
        Ok(stop_socket::release(&self.paths, stop, RELEASE_PATIENCE, &mut warn)?)
    }

    fn order(&self, order: MotionOrder, patience: Option<Span>) -> Result<StopState, Failure> {
        Ok(stop_socket::give(&self.paths, order, patience, &mut warning(order))?)
    }

    /// Returns the name of an object of the scene.
    pub fn name_of(&self, object: ObjectId) -> Option<&str> {
        let named = self.scene.objects().get(self.scene.numbered(object)?.index());
        named.map(|object| object.name.as_str())
    }
}

/// Logs why an order is not confirmed yet.
fn warning(order: MotionOrder) -> impl FnMut(Option<StopError>) -> bool {
    move |why| {
        why.iter().for_each(|why| tracing::warn!(%why, ?order, "not confirmed; it is repeated"));
        true
    }
}

/// The outcome of an utterance, as far as the dialogue has come.
#[derive(Clone, Debug, PartialEq)]
enum Awaited {
    Open,
    Nothing,
    Ended(Box<Ended>),
}

/// The outcome of utterance `said`; of 0, the latest.
fn outcome(view: &PolicyView, said: u64) -> Awaited {
    if view.applied < said || view.interaction != 0 {
        return Awaited::Open;
    }
    match &view.last {
        Some(ended) if ended.utterances.1.0 >= said => Awaited::Ended(Box::new(ended.clone())),
        _ if said > 0 => Awaited::Nothing,
        _ => Awaited::Open,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::{InteractionId, Outcome, UtteranceSeq};

    fn view(applied: u64, interaction: u64, last: Option<(u64, u64)>) -> PolicyView {
        let last = last.map(|(first, last)| Ended {
            interaction: InteractionId(3),
            object: None,
            name: None,
            outcome: Outcome::Delivered,
            questions: 1,
            seconds: 2.0,
            utterances: (UtteranceSeq(first), UtteranceSeq(last)),
        });
        PolicyView { applied, interaction, last, ..PolicyView::default() }
    }

    #[test]
    fn outcome_is_that_of_the_interaction_with_the_utterance() {
        assert_eq!(outcome(&view(4, 0, Some((3, 4))), 5), Awaited::Open, "not applied yet");
        assert_eq!(outcome(&view(5, 4, Some((3, 4))), 5), Awaited::Open, "under way");
        assert_eq!(outcome(&view(5, 0, Some((3, 4))), 5), Awaited::Nothing, "it asked for nothing");
        assert!(matches!(outcome(&view(5, 0, Some((3, 5))), 5), Awaited::Ended(_)));
        assert!(matches!(outcome(&view(5, 0, Some((3, 5))), 0), Awaited::Ended(_)));
        assert_eq!(outcome(&view(0, 0, None), 0), Awaited::Open);
    }
}
