//! The truthful simulated user of `--answer-as`, a client of the group.

use std::collections::HashSet;

use dialogue::Model;
use evaluation::simulation::SimulatedUser;
use evaluation::simulation::users::Domain;
use scene::Scene;
use service::view::Latest;
use vocabulary::Params;

/// A user who wants one object and answers every question once it has been presented.
#[allow(missing_debug_implementations, reason = "the model has none")]
pub struct TruthfulUser {
    scene: Scene,
    model: Model,
    name: String,
    answered: HashSet<(u64, u32)>,
}

impl TruthfulUser {
    /// A user who wants the object of that name. With `may_be_absent`, where the robot considers
    /// that the wanted object is not here, the scene need not have it.
    ///
    /// # Errors
    /// There is no such object.
    pub fn new(scene: &Scene, name: &str, may_be_absent: bool) -> Result<Self, String> {
        if scene.object_named(name).is_none() && !may_be_absent {
            let names: Vec<&str> = scene.objects().iter().map(|o| o.name.as_str()).collect();
            return Err(format!(
                "expected an object of the scene ({}), found {name}; help: to simulate a user who \
                 wants an absent object, set dialogue.prior.absent above 0",
                names.join(", ")
            ));
        }
        // True answers do not depend on the parameters.
        let model = Model::new(scene, Params::default());
        let (scene, name) = (scene.clone(), name.to_owned());
        Ok(Self { scene, model, name, answered: HashSet::new() })
    }

    /// Adopts the scene in force, which may have changed.
    pub fn look(&mut self, scene: &Scene) {
        if scene.key() != self.scene.key() {
            self.model = Model::new(scene, Params::default());
            self.scene = scene.clone();
        }
    }

    /// Returns the answer to the standing question, once for each of its presentations.
    ///
    /// While earlier words are not yet applied there is none: the question may be answered already,
    /// and an answer after the end would be a new request.
    pub fn answer(&mut self, seen: &Latest) -> Option<String> {
        let question = seen.open_question().filter(|_| seen.is_settled())?;
        let view = seen.view.as_ref()?;
        let is_of_scene = view.scene_key == self.scene.key() && self.scene.contains(view.question);
        if !is_of_scene || !self.answered.insert(question) {
            return None;
        }
        let domain = Domain { scene: &self.scene, model: &self.model };
        let mut user = SimulatedUser::truthful(self.scene.object_named(&self.name));
        user.answer(domain, view.question).reply.text().map(str::to_owned)
    }
}

#[cfg(test)]
mod tests {
    use messages::{ActKind, Activity, PolicyView, PresentationState, Presented};
    use scene::{ObjectId, Question};
    use serde_json::json;

    use super::*;

    fn scene() -> Scene {
        let object =
            |name: &str, color: &str| json!({"name": name, "attributes": {"color": color}});
        let json = json!({"objects": [object("R", "red"), object("B", "blue"),
                                      {"name": "none", "attributes": {}}]});
        Scene::from_json("scene", &json).unwrap()
    }

    /// The robot has asked a question about `scene` and said it to its end.
    fn asked(scene: &Scene, question: Question) -> Latest {
        let (decision, scene_key) = (ActKind::Ask, scene.key());
        let view = PolicyView {
            interaction: 7,
            question,
            prompt: 5,
            decision,
            scene_key,
            ..PolicyView::default()
        };
        let state = PresentationState::Ended.into();
        let presented = Presented { prompt: 5, presentation: 1, state, ..Presented::default() };
        let activity = Some(Activity::default());
        Latest { view: Some(view), presented, activity, ..Latest::default() }
    }

    fn answer(wanted: &str, question: Question) -> Option<String> {
        TruthfulUser::new(&scene(), wanted, true).unwrap().answer(&asked(&scene(), question))
    }

    #[test]
    fn answer_as_user_answers_truthfully() {
        let scene = scene();
        let color = scene.attribute_named("color").unwrap();
        let blue = scene.value_named(color, "blue").unwrap();
        let red = scene.object_named("R").unwrap();
        assert_eq!(answer("B", Question::Attribute(color, blue)).as_deref(), Some("yes"));
        assert_eq!(answer("R", Question::Attribute(color, blue)).as_deref(), Some("no"));
        assert_eq!(answer("R", Question::Point(red)).as_deref(), Some("yes"));
        assert_eq!(answer("B", Question::Which(color)).as_deref(), Some("blue"));
        assert_eq!(answer("none", Question::Which(color)), None, "there is nothing to say");
    }

    #[test]
    fn answer_as_user_answers_each_presentation_once_and_only_while_it_stands() {
        let mut user = TruthfulUser::new(&scene(), "R", false).unwrap();
        let mut seen = asked(&scene(), Question::Point(ObjectId(0)));
        let with = |change: fn(&mut PolicyView)| {
            let mut seen = seen.clone();
            change(seen.view.as_mut().unwrap());
            seen
        };
        let (of_another_scene, ended) =
            (with(|it| it.scene_key = 0), with(|it| it.interaction = 0));
        assert_eq!(user.answer(&of_another_scene), None);
        assert_eq!(user.answer(&Latest { accepted: 1, ..seen.clone() }), None, "not yet applied");
        assert!(user.answer(&seen).is_some());
        assert_eq!(user.answer(&seen), None);
        seen.presented.presentation = 2;
        assert!(user.answer(&seen).is_some());
        assert_eq!(user.answer(&ended), None);
    }

    #[test]
    fn answer_as_user_may_want_an_absent_object_only_where_that_is_considered() {
        let error = TruthfulUser::new(&scene(), "G", false).err().unwrap();
        let expected = "expected an object of the scene (R, B, none), found G; help:";
        assert!(error.starts_with(expected), "{error}");
        let color = scene().attribute_named("color").unwrap();
        let red = scene().value_named(color, "red").unwrap();
        assert_eq!(answer("G", Question::Attribute(color, red)).as_deref(), Some("no"));
        assert_eq!(answer("G", Question::Point(ObjectId(0))).as_deref(), Some("no"));
        assert_eq!(answer("G", Question::Which(color)), None);
    }

    #[test]
    fn answer_as_user_follows_a_changed_scene() {
        let mut user = TruthfulUser::new(&scene(), "B", false).unwrap();
        let object = json!({"name": "B", "attributes": {"color": "red"}});
        let changed = Scene::from_json("scene", &json!({ "objects": [object] })).unwrap();
        user.look(&changed);
        let color = changed.attribute_named("color").unwrap();
        let red = changed.value_named(color, "red").unwrap();
        let seen = asked(&changed, Question::Attribute(color, red));
        assert_eq!(user.answer(&seen).as_deref(), Some("yes"));
    }
}
