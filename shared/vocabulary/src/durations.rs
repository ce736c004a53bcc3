//! Measured durations of single actions, seconds, for this robot and scene.

use scene::{ObjectId, Perceived, Question, Scene};
use serde::{Deserialize, Serialize};

use crate::{Action, Fault};

/// Seconds that single actions take. An empty list was not measured: its questions have the cost
/// that [`Costs`](crate::Costs) gives for their kind, as if all entries were equal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Durations {
    /// Seconds of "is its k v?", per attribute and value: from the decision to the recognised
    /// answer.
    pub attribute: Vec<Vec<f64>>,
    /// Seconds of "what is its k?", per attribute.
    pub which: Vec<f64>,
    /// Seconds of pointing at an object and asking, per object, including the arm's motion.
    pub point: Vec<f64>,
    /// Seconds of fetching, per object: from the decision to its hand-over.
    ///
    /// They are not part of any reward (section 3.5): they are paid for the wanted object in any
    /// case, so they do not affect the choice of questions. Among objects that are equally
    /// probable, and that no question can tell apart, the quickest is picked.
    pub pick: Vec<f64>,
}

impl Durations {
    /// Seconds of a question, if they were measured.
    #[inline]
    pub fn question_s(&self, question: Question) -> Option<f64> {
        match question {
            // A choice lasts as long as its options are many: Costs says so.
            Question::None | Question::Choice(..) => None,
            Question::Attribute(k, v) => self.attribute.get(k.index())?.get(v.index()).copied(),
            Question::Which(k) => self.which.get(k.index()).copied(),
            Question::Point(i) => self.point.get(i.index()).copied(),
        }
    }

    /// Seconds from the decision to fetch an object to its hand-over, if they were measured.
    #[inline]
    pub fn pick_s(&self, object: ObjectId) -> Option<f64> {
        self.pick.get(object.index()).copied()
    }

    /// Cost of an action, if it was measured.
    #[inline]
    pub fn of(&self, action: Action) -> Option<f64> {
        match action {
            Action::Ask(question) => self.question_s(question),
            Action::Wait | Action::Pick(_) => None,
        }
    }

    /// Returns a fault for each entry that does not fit the scene or is not a duration in seconds;
    /// empty if planners can use the durations.
    pub fn check(&self, scene: &Scene) -> Vec<Fault> {
        let fits = |len: usize, of: usize| len == 0 || len == of;
        let values = |k: usize| scene.attributes()[k].values.len();
        let (objects, attributes) = (scene.objects().len(), scene.attributes().len());
        let right = |seconds: &f64| *seconds > 0.0 && seconds.is_finite();
        let each = fits(self.attribute.len(), attributes)
            && self.attribute.iter().enumerate().all(|(k, list)| list.len() == values(k));
        let lists: [(&'static str, bool, bool); 4] = [
            ("attribute", each, self.attribute.iter().flatten().all(right)),
            ("which", fits(self.which.len(), attributes), self.which.iter().all(right)),
            ("point", fits(self.point.len(), objects), self.point.iter().all(right)),
            ("pick", fits(self.pick.len(), objects), self.pick.iter().all(right)),
        ];
        let fault = |(key, fits, right): (&'static str, bool, bool)| {
            let help = "measure the durations of this scene again";
            match (fits, right) {
                (false, _) => Some((key, "is not about this scene".to_owned(), help)),
                (true, false) => Some((key, "holds a duration of no seconds".to_owned(), help)),
                (true, true) => None,
            }
        };
        lists.into_iter().filter_map(fault).collect()
    }

    /// Tells every number, list by list.
    pub fn identify(&self, tell: &mut dyn FnMut(u64)) {
        let lists = self.attribute.iter().chain([&self.which, &self.point, &self.pick]);
        for list in lists {
            tell(list.len() as u64);
            list.iter().for_each(|seconds| tell(seconds.to_bits()));
        }
    }

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
