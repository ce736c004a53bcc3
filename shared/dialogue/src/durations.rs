//! Seconds of single actions, where they were measured: what a question costs on this robot, in
//! this scene.

use scene::{ObjectId, Question};
use serde::{Deserialize, Serialize};

use crate::params::Fault;
use crate::{Action, Model};

/// Seconds that single actions take. A list that is empty was not measured: these questions cost
/// what [`Costs`](crate::Costs) says of all of their kind, which is the special case in which all
/// entries of a list are the same.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Durations {
    /// Of "is its k v?", per attribute and value: from the decision to the answer recognised.
    pub attribute: Vec<Vec<f64>>,
    /// Of "what is its k?", per attribute.
    pub which: Vec<f64>,
    /// Of pointing at an object and asking, per object, the way of the arm there included.
    pub point: Vec<f64>,
    /// Of fetching an object, per object: from the decision to its hand-over.
    ///
    /// No reward holds them (section 3.5): they are paid for the wanted object whatever is asked
    /// before, so they cannot tell one question from another. Among objects that are equally
    /// probable, and that no question can tell apart, the quickest is picked.
    pub pick: Vec<f64>,
}

impl Durations {
    /// Seconds of a question, if they were measured.
    pub fn question_s(&self, question: Question) -> Option<f64> {
        match question {
            Question::None => None,
            Question::Attribute(k, v) => self.attribute.get(k.index())?.get(v.index()).copied(),
            Question::Which(k) => self.which.get(k.index()).copied(),
            Question::Point(i) => self.point.get(i.index()).copied(),
        }
    }

    /// Seconds from the decision to fetch an object to its hand-over, if they were measured.
    pub fn pick_s(&self, object: ObjectId) -> Option<f64> {
        self.pick.get(object.index()).copied()
    }

    /// Cost of an action, if it was measured.
    pub(crate) fn of(&self, action: Action) -> Option<f64> {
        match action {
            Action::Ask(question) => self.question_s(question),
            Action::Wait | Action::Pick(_) => None,
        }
    }

    /// Everything that does not fit the model, or is no amount of seconds; empty if planners can
    /// use it.
    pub fn check(&self, model: &Model) -> Vec<Fault> {
        let fits = |len: usize, of: usize| len == 0 || len == of;
        let values = |k: usize| model.values(k.into());
        let (objects, attributes) = (model.objects(), model.attributes());
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
    pub(crate) fn identify(&self, tell: &mut dyn FnMut(u64)) {
        let lists = self.attribute.iter().chain([&self.which, &self.point, &self.pick]);
        for list in lists {
            tell(list.len() as u64);
            list.iter().for_each(|seconds| tell(seconds.to_bits()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{bowls, uniform};
    use crate::{Actions, Costs, DecisionProblem, Mode, Params};
    use scene::{AttributeId, ValueId};

    const ALL: Actions = Actions { mode: Mode::Present, attribute: true, which: true };

    #[test]
    fn what_was_measured_counts_and_the_rest_is_uniform() {
        let model = Model::new(&bowls(), Params::default());
        let none = Durations::default();
        let mut own = uniform(&model, Costs::SECONDS);
        own.attribute[1][0] = 7.5;
        own.point.clear();
        assert_eq!((none.check(&model), own.check(&model)), (vec![], vec![]));
        let plain = DecisionProblem::new(&model, Costs::SECONDS, ALL);
        let problem = DecisionProblem { durations: Some(&own), ..plain };
        let dear = Question::Attribute(AttributeId(1), ValueId(0));
        for question in ALL.questions(&model) {
            let cost = problem.cost(Action::Ask(question));
            let expected = if question == dear { 7.5 } else { plain.cost(Action::Ask(question)) };
            assert_eq!(cost, expected, "{question:?}");
        }
        assert_eq!(problem.cost(Action::Wait), 1.0);
        assert_eq!(problem.cost(Action::Pick(ObjectId(2))), 0.0);
    }

    #[test]
    fn durations_of_another_scene_are_told() {
        let model = Model::new(&bowls(), Params::default());
        let mut own = uniform(&model, Costs::SECONDS);
        own.point.pop();
        own.attribute[0].push(1.0);
        own.which[2] = 0.0;
        own.pick = vec![f64::NAN; 6];
        let keys: Vec<_> = own.check(&model).into_iter().map(|fault| fault.0).collect();
        assert_eq!(keys, ["attribute", "which", "point", "pick"]);
    }

    #[test]
    fn every_number_is_part_of_the_problems_key() {
        let model = Model::new(&bowls(), Params::default());
        let own = uniform(&model, Costs::SECONDS);
        let key = |own: Option<&Durations>| {
            let plain = DecisionProblem::new(&model, Costs::SECONDS, ALL);
            DecisionProblem { durations: own, ..plain }.key()
        };
        let mut other = own.clone();
        other.point[3] += 1e-9;
        assert_ne!(key(Some(&own)), key(Some(&other)));
        assert_ne!(key(Some(&own)), key(None));
    }
}
