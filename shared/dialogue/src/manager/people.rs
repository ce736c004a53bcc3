//! Knowledge about speakers: error rates and past deliveries.

use scene::Scene;
use serde::{Deserialize, Serialize};
use vocabulary::PersonId;
use vocabulary::ids::InteractionId;

use super::history::History;
use crate::Model;
use crate::lesson::{Count, Lesson};
use crate::speaker::{Channel, Speaker, channel_steps, steps};
use crate::user_model::Person;

/// Most people who are known; beyond it the one who was seen longest ago is forgotten.
pub const PEOPLE_MAX: usize = 32;
/// Most objects and attributes, by name, that are counted for one person.
const NAMES_MAX: usize = 64;
/// Observations that a configured rate is worth.
const STRENGTH: f64 = 10.0;

/// Knowledge about speakers. Earlier journals have `person: Option<Person>`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Stored", into = "Stored")]
pub struct Users {
    /// All users as one, as learned in earlier interactions, if the planner uses it.
    pub person: Option<Person>,
    /// Users who gave their name.
    pub people: People,
}

#[derive(Serialize, Deserialize)]
enum Stored {
    Nothing,
    Person(Person),
    People(Option<Person>, People),
}

impl From<Stored> for Users {
    fn from(stored: Stored) -> Self {
        match stored {
            Stored::Nothing => Self::default(),
            Stored::Person(person) => Self { person: Some(person), people: People::default() },
            Stored::People(person, people) => Self { person, people },
        }
    }
}

impl From<Users> for Stored {
    fn from(Users { person, people }: Users) -> Self {
        match person {
            person if people != People::default() => Self::People(person, people),
            Some(person) => Self::Person(person),
            None => Self::Nothing,
        }
    }
}

/// The people who are known, each by a name that they gave.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct People {
    /// The one seen last comes last.
    known: Vec<KnownPerson>,
    /// The latest delivery that taught something, and its person before: it may yet be refused.
    latest: Option<(InteractionId, KnownPerson)>,
}

/// Knowledge about a person, from deliveries that were not refused.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KnownPerson {
    /// The name.
    pub id: PersonId,
    /// Deliveries.
    pub deliveries: u64,
    /// Errors, by [`Channel`].
    pub channels: [Count; Channel::ALL.len()],
    /// Values taken for another one, by the attribute's name.
    pub attributes: Vec<(String, Count)>,
    /// Deliveries by object.
    pub fetched: History,
}

impl People {
    /// The people, the one seen last at the end.
    pub fn iter(&self) -> impl Iterator<Item = &KnownPerson> {
        self.known.iter()
    }

    /// Returns the knowledge about a person.
    pub fn get(&self, id: &PersonId) -> Option<&KnownPerson> {
        self.known.iter().find(|known| known.id == *id).filter(|_| !id.is_nobody())
    }

    /// Learns from the delivery with which an interaction has ended.
    pub(super) fn learn(
        &mut self,
        id: &PersonId,
        interaction: InteractionId,
        teach: impl FnOnce(&mut KnownPerson),
    ) {
        if id.is_nobody() {
            return;
        }
        let before = self.remove(id);
        let mut person =
            before.unwrap_or_else(|| KnownPerson { id: id.clone(), ..KnownPerson::default() });
        self.latest = Some((interaction, person.clone()));
        teach(&mut person);
        if self.known.len() >= PEOPLE_MAX {
            self.known.remove(0);
        }
        self.known.push(person);
    }

    /// Takes back the lesson of a delivery that was refused.
    pub(super) fn take_back(&mut self, interaction: InteractionId) {
        let Some((_, before)) = self.latest.take_if(|(of, _)| *of == interaction) else { return };
        if let Some(person) = self.known.iter_mut().find(|known| known.id == before.id) {
            *person = before;
        }
    }

    /// Forgets a person; returns whether they were known.
    pub(super) fn forget(&mut self, id: &PersonId) -> bool {
        self.latest.take_if(|(_, before)| before.id == *id);
        self.remove(id).is_some()
    }

    fn remove(&mut self, id: &PersonId) -> Option<KnownPerson> {
        let at = self.known.iter().position(|known| known.id == *id)?;
        Some(self.known.remove(at))
    }
}

/// The rate that is expected of a person. At least as configured: a person without errors in a few
/// dialogues may still err, and would be asked too little.
fn expected(known: &Count, configured: f64) -> f64 {
    known.mean(configured, STRENGTH).max(configured)
}

impl KnownPerson {
    /// Learns from an interaction, in a scene.
    pub(super) fn take_in(&mut self, scene: &Scene, lesson: &Lesson, object: &str) {
        self.deliveries += 1;
        self.fetched.count_within(object, NAMES_MAX);
        for (sum, more) in self.channels.iter_mut().zip(&lesson.channels) {
            sum.add(more);
        }
        for (attribute, more) in scene.attributes().iter().zip(&lesson.attributes) {
            if more.all() == 0.0 {
                continue;
            }
            let at = self.attributes.iter().position(|(name, _)| *name == attribute.name);
            match at {
                Some(at) => self.attributes[at].1.add(more),
                None if self.attributes.len() < NAMES_MAX => {
                    self.attributes.push((attribute.name.clone(), *more));
                }
                None => {}
            }
        }
    }

    /// The person as one who speaks, under a configured model of that scene.
    pub(super) fn speaker(&self, scene: &Scene, configured: &Model) -> Speaker {
        let channels = Channel::ALL.map(|channel| {
            let known = &self.channels[channel as usize];
            channel_steps(configured, channel, |rate| expected(known, rate))
        });
        let of = |(k, attribute): (usize, &scene::Attribute)| {
            let known = self.attributes.iter().find(|(name, _)| *name == attribute.name);
            let rate = configured.misperceived(k.into());
            known.map_or(0, |(_, count)| steps(rate, expected(count, rate)))
        };
        let attributes = scene.attributes().iter().enumerate().map(of).collect();
        Speaker { from: self.id.clone(), channels, attributes }
    }
}
