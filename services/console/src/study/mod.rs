//! Studies with people, run from the console.
//!
//! [`Study`] lives on the main thread: it is given the `do` verbs that begin with `study.`
//! ([`Study::verb`]), everything that happens in the picture ([`Study::event`]), and a moment in every
//! pass ([`Study::pass`]). What it shows is the section `study` ([`Study::section`]); what it serves
//! over HTTP are [`routes`] below `/study/`.
//!
//! The rules are in `desk.rs` and `watch.rs`, which are pure. Whatever they decide is written into the
//! participant's journal, synced, and only then taken in and answered; so a console that is killed goes
//! on where it was.

mod desk;
mod files;
mod http;
mod request;
mod section;
mod seen;
mod switcher;
#[cfg(test)]
mod tests;
mod watch;

use std::path::PathBuf;

use config::Settings;
use evaluation::user_study::{Entry, Event, Source};
use messages::{Receipt, Source as Way};
use scene::Question;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::{Span, Time};

use crate::hub::command::{Verb, Words};
use crate::hub::{ViewerId, ms};
use crate::picture::{Now, Picture, PictureEvent};
use desk::Desk;
use files::Files;
use seen::Seen;
use switcher::Switcher;
use watch::{Said, Wish};

pub use http::routes;

/// How often the same wish is made again while it does not come true.
const WISH_EVERY: Span = Span::from_ms(2_000);
/// … and one to the supervisor.
const ORDER_EVERY: Span = Span::from_ms(10_000);
/// Words by which what stands is called off.
const CANCEL: &str = "never mind";

/// The study, where there is one.
#[derive(Debug)]
pub struct Study(Option<Running>);

#[derive(Debug)]
struct Running {
    desk: Desk,
    files: Files,
    switcher: Switcher,
    fault_ms: f64,
    /// The latest wish, and when it was made.
    wished: Option<(Wish, Time)>,
    /// What keeps the study from going on, for the experimenter.
    trouble: Option<String>,
    shown: Option<String>,
}

/// The folder of the study's data.
pub fn folder(settings: &Settings, paths: &GroupPaths) -> PathBuf {
    settings.study.data_dir.clone().unwrap_or_else(|| paths.study())
}

impl Study {
    /// Reads the settings, and goes on with who was there.
    ///
    /// # Errors
    /// The data cannot be read.
    pub fn new(settings: &Settings, paths: &GroupPaths) -> Result<Self, Failure> {
        if !settings.study.enabled {
            return Ok(Self(None));
        }
        let mut files = Files::in_folder(folder(settings, paths));
        let people = files.recover().map_err(|why| Failure::new(Exit::Storage, why))?;
        let policy = std::env::current_exe().map(|own| own.with_file_name("whichone-policy"));
        let switcher = policy.and_then(|policy| Switcher::start(paths.control_socket(), policy));
        let switcher = switcher
            .map_err(|error| Failure::new(Exit::NotReached, format!("study's thread: {error}")))?;
        let protocol = settings.study.protocol.clone();
        Ok(Self(Some(Running {
            desk: Desk::new(protocol, paths.name().to_string(), people),
            files,
            switcher,
            fault_ms: 1e3 * settings.study.fault.as_secs_f64(),
            wished: None,
            trouble: None,
            shown: None,
        })))
    }

    /// Whether pages may begin a study.
    pub fn is_offered(&self) -> bool {
        self.0.is_some()
    }

    /// Does what a page asks for; its answer's fields.
    ///
    /// # Errors
    /// Why not, in a sentence with the cure.
    pub fn verb(
        &mut self,
        _viewer: ViewerId,
        verb: &str,
        arguments: &Json,
        picture: &Picture,
        now: Now,
    ) -> Result<Json, String> {
        let cure = "set study.enabled, and reload the group";
        let study = self.0.as_mut().ok_or_else(|| format!("there is no study: {cure}"))?;
        let seen = study.seen(picture, now);
        study.verb(verb, arguments, &seen)
    }

    /// Something has happened.
    pub fn event(&mut self, event: &PictureEvent, picture: &Picture, now: Now) {
        let Some(study) = &mut self.0 else { return };
        let said = match event {
            PictureEvent::Heard(receipt) => heard(receipt),
            PictureEvent::Said { prompt, presentation, question, text, .. }
                if *question != Question::None =>
            {
                let (prompt, presentation, words) = (*prompt, *presentation, text.clone());
                Some(Said::Asked { prompt, presentation, words })
            }
            _ => None,
        };
        let seen = study.seen(picture, now);
        if let Some((id, event)) = said.and_then(|said| study.desk.said(&said, &seen)) {
            study.note(&id, vec![event], now.unix_ms);
        }
    }

    /// Time has passed: what the study wants the dialogue to do, as a viewer would.
    pub fn pass(&mut self, picture: &Picture, now: Now) -> Vec<Verb> {
        let Some(study) = &mut self.0 else { return Vec::new() };
        let seen = study.seen(picture, now);
        study.take_results(now.unix_ms);
        if let Some((id, event)) = study.desk.look(&seen, study.fault_ms) {
            study.note(&id, vec![event], now.unix_ms);
        }
        study.wish(&seen, now)
    }

    /// The section `study`; none while it is as it was.
    pub fn section(&mut self, picture: &Picture, now: Now) -> Option<Json> {
        let study = self.0.as_mut()?;
        let seen = study.seen(picture, now);
        let section = section::section(&study.desk, &seen, study.trouble.as_deref());
        let text = section.to_string();
        (study.shown.as_ref() != Some(&text)).then(|| {
            study.shown = Some(text);
            section
        })
    }
}

impl Running {
    fn seen<'a>(&self, picture: &'a Picture, now: Now) -> Seen<'a> {
        Seen {
            at: now.unix_ms,
            ms: ms(now.at),
            scene: picture.scene(),
            view: picture.view(),
            missing: seen::missing(picture.group()),
            arm_is_busy: seen::arm_is_busy(picture.arm()),
            is_switching: self.switcher.is_busy() || self.desk.owing().is_some(),
        }
    }

    fn verb(&mut self, verb: &str, arguments: &Json, seen: &Seen<'_>) -> Result<Json, String> {
        let page = request::page(arguments)?;
        if verb == "find" {
            let found = self.desk.of_page(&page);
            return Ok(json!({
                "participant": found.map(evaluation::user_study::Participant::id),
                "stage": found.map(|person| person.stage.name()),
            }));
        }
        let ask = request::read(verb, arguments)?;
        let (id, events) = self.desk.ask(&page, &ask, seen, request::seed())?;
        self.write(&id, events, seen.at).map_err(|error| {
            tracing::error!(participant = id, %error, "the study's data is not written");
            format!("The data cannot be written: {error}. Please tell the experimenter.")
        })?;
        Ok(json!({ "participant": id }))
    }

    /// Writes events down, and takes them in once they are on the disk.
    fn write(&mut self, id: &str, events: Vec<Event>, at: u64) -> std::io::Result<()> {
        if events.is_empty() {
            return Ok(());
        }
        let entries: Vec<Entry> = events.into_iter().map(|event| Entry { at, event }).collect();
        match (&entries[..], self.desk.people().iter().find(|person| person.id() == id)) {
            ([deleted @ Entry { event: Event::Deleted, .. }], Some(person)) => {
                self.files.replace(id, &desk::kept(person, deleted))?;
            }
            _ => self.files.append(id, &entries)?,
        }
        self.trouble = None;
        entries.iter().for_each(|entry| self.desk.apply(id, entry));
        Ok(())
    }

    /// As [`Running::write`], where nobody waits for it: it comes again with the next look.
    fn note(&mut self, id: &str, events: Vec<Event>, at: u64) {
        if let Err(error) = self.write(id, events, at) {
            tracing::error!(participant = id, %error, "the study's data is not written");
            self.trouble = Some(format!("the data cannot be written: {error}"));
        }
    }

    fn take_results(&mut self, at: u64) {
        match self.switcher.result() {
            Some((Wish::Restore(id), Ok(()))) => self.note(&id, vec![Event::Restored], at),
            Some((wish, Err(why))) => {
                tracing::warn!(?wish, why, "the policy is not switched");
                self.trouble = Some(format!("the policy cannot be switched: {why}"));
            }
            Some((_, Ok(()))) | None => {}
        }
    }

    fn wish(&mut self, seen: &Seen<'_>, now: Now) -> Vec<Verb> {
        let Some(wish) = self.desk.wish(seen) else {
            self.wished = None;
            return Vec::new();
        };
        let every = if wish == Wish::Cancel { WISH_EVERY } else { ORDER_EVERY };
        let is_due = match &self.wished {
            Some((before, at)) => *before != wish || now.at >= *at + every,
            None => true,
        };
        if !is_due || self.switcher.is_busy() {
            return Vec::new();
        }
        self.wished = Some((wish.clone(), now.at));
        match &wish {
            Wish::Cancel => return vec![Verb::Say(cancel())],
            Wish::Switch(planner) => {
                // Before it is done, so that it is given back whatever happens in between.
                let event = Event::Switched { planner: planner.clone() };
                let active = self.desk.active().map(|person| person.id().to_owned());
                active.into_iter().for_each(|id| self.note(&id, vec![event.clone()], now.unix_ms));
            }
            Wish::Restore(_) => {}
        }
        self.switcher.order(wish);
        Vec::new()
    }
}

fn heard(receipt: &Receipt) -> Option<Said> {
    let is_typed = receipt.source == Way::Text.code();
    (receipt.seq > 0).then(|| Said::Heard {
        seq: receipt.seq,
        source: if is_typed { Source::Typed } else { Source::Voice },
        onset_ms: ms(Time(receipt.onset_ns)),
        words: receipt.note.as_str().unwrap_or_default().to_owned(),
    })
}

fn cancel() -> Words {
    Words {
        text: CANCEL.to_owned(),
        alternatives: Vec::new(),
        spoken: false,
        began: None,
        ended: None,
    }
}
