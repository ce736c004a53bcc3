//! A client that follows the dialogue of a running group and may take part in it.
//!
//! Invariant: nothing here waits for a service. Topics outlive the services that write them, so a
//! service that is restarted is only silent for a while.

use std::collections::{HashSet, VecDeque};
use std::time::{Duration, Instant};

use config::Settings;
use messages::{Injection, PolicyView, PromptId, Receipt, RequestKey, Sound, topics};
use scene::Scene;
use service::bus::EncodedWriter;
use service::client::{Client, Polling};
use service::clock;
use service::exit::{Exit, Failure};
use service::group::{GroupPaths, ShmName};
use service::submission::Submission;
use service::view::{Latest, LatestTopics, quiet};
use service::{Span, Time};
use vocabulary::PersonId;

#[cfg(test)]
pub(super) mod example;

/// Interval at which a client polls the dialogue.
pub(super) const LOOK_EVERY: Duration = Duration::from_millis(5);
/// Silence of the policy after which it is assumed to be down.
const FIRST_PATIENCE: Duration = Duration::from_secs(1);
/// Interval at which the identity of the group is checked.
const CHECK_EVERY: Duration = Duration::from_secs(1);

/// A client of one group.
pub(super) struct Conversation {
    topics: LatestTopics,
    injections: Option<EncodedWriter<Injection>>,
    /// Who speaks.
    from: PersonId,
    /// Utterances to submit, first to last; only the first has been sent.
    saying: VecDeque<Submission>,
    /// Keys of all utterances of this client.
    own: HashSet<RequestKey>,
    latest: Latest,
    scene: Scene,
    may_be_absent: bool,
    paths: GroupPaths,
    /// Name of the group's shared memory, another one is another run.
    shared_memory: ShmName,
    checked: Instant,
    client: Client,
}

impl Conversation {
    /// Joins a running group.
    pub(super) fn join(paths: &GroupPaths) -> Result<Self, Failure> {
        // Read first: what is joined after it is of this run or of a later one, which is noticed.
        let shared_memory = paths.shm_name();
        let client = Client::join(paths)?;
        let settings = Settings::load_snapshot(&paths.run())?;
        let (topics, scene) = LatestTopics::open(client.bus(), &settings)?;
        Ok(Self {
            topics,
            injections: None,
            from: PersonId::default(),
            saying: VecDeque::new(),
            own: HashSet::new(),
            latest: Latest::default(),
            scene,
            may_be_absent: settings.dialogue.prior.absent > 0.0,
            paths: paths.clone(),
            shared_memory: shared_memory.map_err(|_| ended(paths))?,
            checked: Instant::now(),
            client,
        })
    }

    /// Returns the latest message of every topic.
    pub(super) fn latest(&self) -> &Latest {
        &self.latest
    }

    /// The scene that the dialogue is about.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns false as long as nothing is known to be on the table, where the objects come from perception.
    pub(super) fn knows_objects(&self) -> bool {
        !self.scene.objects().is_empty()
    }

    /// Returns true if the robot considers that the wanted object is not here.
    pub(super) fn may_be_absent(&self) -> bool {
        self.may_be_absent
    }

    /// The group's folders.
    pub(super) fn paths(&self) -> &GroupPaths {
        &self.paths
    }

    /// States who speaks from now on; at first nobody in particular.
    pub(super) fn speak_as(&mut self, from: PersonId) {
        self.from = from;
    }

    /// Submits an utterance of a user who was shown the prompt `seen` last, after those that are pending. It is resent
    /// under one key until it is answered, so that a restart neither loses nor duplicates it.
    pub(super) fn say(&mut self, text: &str, seen: PromptId) -> Result<(), Failure> {
        if self.injections.is_none() {
            self.injections = Some(self.client.bus().encoded_writer(&topics::INJECTION)?);
        }
        let sound = Sound::Text(text.to_owned());
        let now = clock::now();
        let submission = Submission::new(sound, (now, Time(0)), now, Span(u64::MAX / 2))
            .after(seen)
            .by(self.from.as_str());
        self.own.insert(submission.key());
        self.saying.push_back(submission);
        Ok(())
    }

    /// Polls until the policy has published or a timeout has passed: the first utterance needs
    /// the state before it.
    pub(super) fn first_look(&mut self) -> Result<(), Failure> {
        let (until, mut polling) = (Instant::now() + FIRST_PATIENCE, Polling::default());
        self.look()?;
        while Instant::now() < until && self.latest.view.is_none() {
            polling.pause();
            self.look()?;
        }
        Ok(())
    }

    /// Returns true if the receipt is for an utterance of this client.
    pub(super) fn is_own(&self, receipt: &Receipt) -> bool {
        self.own.contains(&receipt.request())
    }

    /// Returns true if every utterance of this client has a receipt.
    pub(super) fn is_heard(&self) -> bool {
        self.saying.is_empty()
    }

    /// Processes all messages since the last poll. Returns the receipts among them,
    /// of any user's utterance.
    pub(super) fn look(&mut self) -> Result<Vec<Receipt>, Failure> {
        if self.checked.elapsed() >= CHECK_EVERY {
            self.check()?;
        }
        let mut arrived = self.topics.take();
        if let Some(scene) = arrived.scene.take() {
            self.scene = scene;
        }
        if let Some(view) = &arrived.view {
            self.follow_scene(view);
        }
        self.latest.update(&arrived);
        for receipt in &arrived.receipts {
            self.answered(receipt.request());
        }
        self.send();
        Ok(arrived.receipts)
    }

    fn answered(&mut self, key: RequestKey) {
        if self.saying.front().is_some_and(|submission| submission.key() == key) {
            self.saying.pop_front();
        }
    }

    fn send(&mut self) {
        let (Some(writer), Some(submission)) = (&self.injections, self.saying.front_mut()) else {
            return;
        };
        if let Some(request) = submission.due(clock::now()) {
            quiet(writer.send(request).map(Some));
        }
    }

    /// Detects the end of the group.
    fn check(&mut self) -> Result<(), Failure> {
        self.checked = Instant::now();
        if self.paths.shm_name().ok().as_ref() != Some(&self.shared_memory) {
            return Err(ended(&self.paths));
        }
        Ok(())
    }

    /// Detects a change of the scene. The snapshot is of the new scene before the
    /// policy is, so it is read once for each new key.
    fn follow_scene(&mut self, view: &PolicyView) {
        let before = self.latest.view.as_ref().map_or(self.scene.key(), |view| view.scene_key);
        let is_news = view.scene_key != before && view.scene_key != self.scene.key();
        if is_news && let Ok(settings) = Settings::load_snapshot(&self.paths.run()) {
            self.scene = self.topics.set_scene(settings.scene);
        }
    }
}

/// Returns what policy and speech of a running group state, once `is_known` or a second has passed. Its
/// scene, which takes longer to read, is left out.
pub(super) fn glance(paths: &GroupPaths, is_known: impl Fn(&Latest) -> bool) -> Option<Latest> {
    let client = Client::join(paths).ok()?;
    let views = client.bus().encoded_reader(&topics::VIEW).ok()?;
    let presented = client.bus().reader(&topics::PRESENTED).ok()?;
    let hearing = client.bus().reader(&topics::HEARING).ok()?;
    let (until, mut polling) = (Instant::now() + FIRST_PATIENCE, Polling::default());
    let mut latest = Latest::default();
    while !is_known(&latest) && Instant::now() < until {
        polling.pause();
        latest.presented = quiet(presented.latest()).unwrap_or(latest.presented);
        latest.hearing = quiet(hearing.latest()).or(latest.hearing);
        latest.view = quiet(views.latest()).or(latest.view);
    }
    Some(latest)
}

fn ended(paths: &GroupPaths) -> Failure {
    Failure::new(Exit::NotReached, format!("group {} has ended", paths.name()))
}
