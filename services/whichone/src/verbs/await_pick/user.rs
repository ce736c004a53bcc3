//! A simulated user who never errs.

use std::collections::HashSet;

use dialogue::{Answer, Model, Params};
use scene::{Question, Scene};

use service::view::Latest;

/// Somebody who wants one object and answers every question once it was asked to its end.
pub(super) struct TruthfulUser {
    scene: Scene,
    model: Model,
    name: String,
    answered: HashSet<(u64, u32)>,
}

impl TruthfulUser {
    /// Somebody who wants the object of that name. Where the robot considers that the wanted object
    /// is not here (`may_be_absent`), the scene need not have it.
    ///
    /// # Errors
    /// The scene has no such object, and it is not considered.
    pub(super) fn new(scene: &Scene, name: &str, may_be_absent: bool) -> Result<Self, String> {
        if scene.object_named(name).is_none() && !may_be_absent {
            let names: Vec<&str> = scene.objects().iter().map(|o| o.name.as_str()).collect();
            let names = names.join(", ");
            return Err(format!(
                "the scene has no object {name}; there are {names}. Somebody who wants what is not \
                 here can be played where dialogue.prior.absent is above 0"
            ));
        }
        // The truth does not depend on the parameters.
        let model = Model::new(scene, Params::default());
        let (scene, name) = (scene.clone(), name.to_owned());
        Ok(Self { scene, model, name, answered: HashSet::new() })
    }

    /// Looks at the scene, which may have changed.
    pub(super) fn look(&mut self, scene: &Scene) {
        if scene.key() != self.scene.key() {
            self.model = Model::new(scene, Params::default());
            self.scene = scene.clone();
        }
    }

    /// What this person says now, if anything: each presentation of a question gets one answer.
    ///
    /// Nothing is said while earlier words are not yet applied, because the question may be
    /// answered already, and an answer that comes after the end would be a new request.
    pub(super) fn answer(&mut self, seen: &Latest) -> Option<String> {
        let question = seen.open_question().filter(|_| seen.is_settled())?;
        let view = seen.view.as_ref()?;
        let is_of_scene = view.scene_key == self.scene.key() && self.scene.contains(view.question);
        if !is_of_scene || !self.answered.insert(question) {
            return None;
        }
        let wanted = self.scene.object_named(&self.name);
        let answer = match (wanted, view.question) {
            (Some(wanted), question) => Answer::truthful(&self.model, question, wanted),
            // Nothing that the robot can name is true of what is not here.
            (None, Question::Which(_) | Question::None) => Answer::Silence,
            (None, Question::Point(_) | Question::Attribute(..)) => Answer::No,
        };
        let text = answer.text(&self.scene);
        (!text.is_empty()).then(|| text.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use scene::ObjectId;
    use serde_json::json;

    use super::super::super::conversation::example::{asked, ended, unapplied};
    use super::*;

    fn scene() -> Scene {
        let object =
            |name: &str, color: &str| json!({"name": name, "attributes": {"color": color}});
        let json = json!({"objects": [object("R", "red"), object("B", "blue"),
                                      {"name": "none", "attributes": {}}]});
        Scene::from_json("scene", &json).unwrap()
    }

    fn answer(wanted: &str, question: Question) -> Option<String> {
        let mut seen = asked(question);
        seen.view.as_mut().unwrap().scene_key = scene().key();
        TruthfulUser::new(&scene(), wanted, true).unwrap().answer(&seen)
    }

    #[test]
    fn answers_are_true() {
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
    fn each_presentation_is_answered_once_and_only_while_it_stands() {
        let mut user = TruthfulUser::new(&scene(), "R", false).unwrap();
        let mut seen = asked(Question::Point(ObjectId(0)));
        assert_eq!(user.answer(&seen), None, "another scene's question");
        seen.view.as_mut().unwrap().scene_key = scene().key();
        assert_eq!(user.answer(&unapplied(seen.clone())), None);
        assert!(user.answer(&seen).is_some());
        assert_eq!(user.answer(&seen), None);
        seen.presented.presentation = 2;
        assert!(user.answer(&seen).is_some());
        assert_eq!(user.answer(&ended(7)), None);
    }

    #[test]
    fn what_is_not_here_is_wanted_only_where_that_is_considered() {
        let told = TruthfulUser::new(&scene(), "G", false).err().unwrap();
        assert!(told.starts_with("the scene has no object G; there are R, B, none."), "{told}");
        let color = scene().attribute_named("color").unwrap();
        let red = scene().value_named(color, "red").unwrap();
        assert_eq!(answer("G", Question::Attribute(color, red)).as_deref(), Some("no"));
        assert_eq!(answer("G", Question::Point(ObjectId(0))).as_deref(), Some("no"));
        assert_eq!(answer("G", Question::Which(color)), None);
    }

    #[test]
    fn a_changed_scene_changes_the_truth() {
        let mut user = TruthfulUser::new(&scene(), "B", false).unwrap();
        let object = json!({"name": "B", "attributes": {"color": "red"}});
        let changed = Scene::from_json("scene", &json!({ "objects": [object] })).unwrap();
        user.look(&changed);
        let color = changed.attribute_named("color").unwrap();
        let red = changed.value_named(color, "red").unwrap();
        let mut seen = asked(Question::Attribute(color, red));
        seen.view.as_mut().unwrap().scene_key = changed.key();
        assert_eq!(user.answer(&seen).as_deref(), Some("yes"));
    }
}
