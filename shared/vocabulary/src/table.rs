//! Objects on the table as reported by perception.

use scene::{ObjectId, Perceived};
use serde::{Deserialize, Serialize};

/// Most objects on a table.
pub const TABLE_MAX: usize = 64;
/// Latest changes by hand that are remembered, so that one that is sent again takes effect once.
const EDITS_MAX: usize = 16;

/// The objects on the table, in the order in which they appeared. Each change of it is a step of
/// the dialogue.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Number of changes so far.
    pub version: u64,
    /// Least number that no object has had.
    pub next: ObjectId,
    /// The objects.
    pub objects: Vec<Perceived>,
    /// Keys of the latest changes by hand, with the object of each.
    pub edits: Vec<(u64, ObjectId)>,
}

impl Table {
    /// Returns the object with the given number.
    pub fn object(&self, number: ObjectId) -> Option<&Perceived> {
        self.objects.iter().find(|object| object.number == number)
    }

    /// Returns the object of that name, or with that number.
    pub fn named(&self, name: &str) -> Option<&Perceived> {
        let is_it = |it: &&Perceived| it.name == name || it.number.0.to_string() == name;
        self.objects.iter().find(is_it)
    }

    /// Remembers a change by hand.
    pub fn note(&mut self, key: u64, object: ObjectId) {
        if self.edits.len() == EDITS_MAX {
            self.edits.remove(0);
        }
        self.edits.push((key, object));
    }
}
