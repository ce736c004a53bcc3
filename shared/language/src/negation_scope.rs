//! Scope of a "not": the noun phrases that it rules out, as groups of values.

use scene::Role;

use crate::content::Excluded;
use crate::lexicon::ValueSense;

/// A negation whose scope is still open.
#[derive(Debug)]
pub(crate) struct NegationScope<'a> {
    groups: Vec<Group<'a>>,
    /// A preposition or conjunction has just been heard: the next noun phrase belongs to it.
    joined: bool,
    /// An "and" has been heard inside the current group.
    coordinated: bool,
    /// Probability that the negation was not said.
    doubt: f64,
}

/// One noun phrase: an object with all of the values is ruled out.
#[derive(Clone, Debug, Default)]
struct Group<'a> {
    values: Vec<&'a ValueSense>,
    headed: bool,
    /// Probability that one of the values was not said.
    doubt: f64,
}

impl<'a> Group<'a> {
    fn is_open(&self) -> bool {
        self.values.is_empty() && !self.headed
    }

    fn add(&mut self, value: &'a ValueSense, doubt: f64) {
        self.values.push(value);
        self.doubt = 1.0 - (1.0 - self.doubt) * (1.0 - doubt);
    }
}

impl<'a> NegationScope<'a> {
    /// A negation that was said but for this doubt.
    pub(crate) fn new(doubt: f64) -> Self {
        let groups = vec![Group::default()];
        Self { groups, joined: false, coordinated: false, doubt }
    }

    /// Returns whether the current noun phrase is complete, so that another follows.
    fn is_closed(&self) -> bool {
        self.last().headed && !self.joined
    }

    fn last(&self) -> &Group<'a> {
        self.groups.last().expect("a scope has a group")
    }

    fn last_mut(&mut self) -> &mut Group<'a> {
        self.groups.last_mut().expect("a scope has a group")
    }

    /// Takes a value in; `false` if it lies beyond the scope. `adjacent`: it follows another value;
    /// `doubt`: the probability that it was not said.
    pub(crate) fn value(&mut self, value: &'a ValueSense, adjacent: bool, doubt: f64) -> bool {
        if self.is_closed() && !adjacent {
            return false;
        }
        if let Some(at) = self.last().values.iter().position(|other| other.rivals(value)) {
            // "not white clear": nothing is both, so the second is wanted instead.
            if !self.coordinated && !self.joined {
                return false;
            }
            let mut values = self.last().values.clone();
            values.remove(at);
            let doubt = self.last().doubt;
            self.groups.push(Group { values, doubt, ..Group::default() });
        }
        if value.role == Role::Kind {
            // "not the red or blue marker": the noun is every member's.
            for group in self.groups.iter_mut().filter(|group| !group.headed) {
                group.add(value, doubt);
                group.headed = true;
            }
        } else {
            self.last_mut().add(value, doubt);
        }
        self.joined = false;
        true
    }

    /// Notes that the noun phrase has its noun.
    pub(crate) fn head(&mut self) {
        for group in &mut self.groups {
            group.headed = true;
        }
        self.joined = false;
    }

    /// A determiner: `false` if it starts a noun phrase beyond the scope.
    pub(crate) fn determiner(&mut self) -> bool {
        self.joined || self.last().is_open()
    }

    /// "in", "that is": the following words describe the same thing.
    pub(crate) fn join(&mut self) {
        self.joined = true;
    }

    /// "or": another noun phrase.
    pub(crate) fn or(&mut self) {
        if !self.last().is_open() {
            self.groups.push(Group::default());
        }
        self.joined = true;
    }

    /// "and" before a noun phrase or value: another group after a noun, more of the same before.
    pub(crate) fn and(&mut self) {
        if self.last().headed {
            self.groups.push(Group::default());
        }
        self.joined = true;
        self.coordinated = true;
    }

    /// The groups that were ruled out.
    pub(crate) fn into_groups(self) -> impl Iterator<Item = Excluded> + use<'a> {
        let doubt = self.doubt;
        let denied = move |group: Group<'a>| Excluded {
            words: group.values.iter().map(|value| value.word).collect(),
            doubt: 1.0 - (1.0 - group.doubt) * (1.0 - doubt),
        };
        self.groups.into_iter().filter(|group| !group.values.is_empty()).map(denied)
    }
}
