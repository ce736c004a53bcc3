//! The objects on the table, where they come from perception.

use scene::{ObjectId, Perceived, Scene};
use serde::{Deserialize, Serialize};

use crate::Durations;

/// Most objects on a table.
pub const TABLE_MAX: usize = 64;
/// Latest changes by hand that are remembered, so that one that is sent again takes effect once.
const EDITS_MAX: usize = 16;

/// The objects on the table, in the order in which they appeared. Each change of it is a step of the
/// dialogue.
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
    /// Returns the object with that number.
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

impl Durations {
    /// Returns the durations for other objects of the same words: those of the objects' classes, or
    /// else the mean of the scene file's.
    #[must_use]
    pub fn with_objects(&self, file: &Scene, perceived: &[Perceived]) -> Self {
        let of = |known: &[f64]| -> Vec<f64> {
            let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
            let class = |it: &Perceived| it.class().and_then(|class| file.object_named(class));
            let seconds = |it| class(it).and_then(|class| known.get(class.index()).copied());
            let all = perceived.iter().map(|it| seconds(it).unwrap_or(mean));
            if known.is_empty() { Vec::new() } else { all.collect() }
        };
        Self { point: of(&self.point), pick: of(&self.pick), ..self.clone() }
    }
}
