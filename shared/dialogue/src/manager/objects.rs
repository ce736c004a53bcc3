//! Objects from perception: the setup follows the table in the state.

use scene::Scene;
use vocabulary::{Durations, Table};

use super::pointing::Pointing;
use super::state::{Cause, Interaction, State};
use super::{Manager, Setup};
use crate::Model;

/// Source of a setup: words, and possible objects.
pub(super) struct SceneFile {
    scene: Scene,
    model: Model,
    durations: Option<Durations>,
}

impl SceneFile {
    pub(super) fn of(setup: &Setup) -> Self {
        let (scene, model) = (setup.scene.clone(), setup.model.clone());
        Self { scene, model, durations: setup.durations.clone() }
    }
}

impl Manager {
    /// Returns the scene of the scene file, which has the words of the present one.
    pub fn scene_file(&self) -> &Scene {
        self.file.as_ref().map_or(&self.setup.scene, |file| &file.scene)
    }

    /// Takes over the objects of a state that was not made by this manager's last step.
    pub fn follow(&mut self, state: &State) {
        let Some(file) = &self.file else { return };
        if self.table == state.table {
            return;
        }
        self.table.clone_from(&state.table);
        let objects = self.table.as_ref().map_or(&[][..], |table| &table.objects);
        let setup = &mut self.setup;
        setup.scene = file.scene.with_objects(objects);
        setup.model = file.model.with_objects(&setup.scene);
        let durations = file.durations.as_ref();
        setup.durations = durations.map(|it| it.with_objects(&file.scene, objects));
        if setup.prior.absent > 0.0 || setup.nothing_stands() {
            setup.model = setup.model.clone().with_absent();
        }
        let gestures = setup.gestures;
        self.pointing = gestures.map(|(model, user_m)| Pointing::new(model, user_m, &setup.scene));
        self.descriptions = vec![None; setup.scene.objects().len()];
    }

    /// Lays the table that the state is about from now on.
    pub(super) fn lay(&mut self, state: &mut State, cause: &Cause) {
        match cause {
            Cause::Objects(table) => state.table = Some(table.clone()),
            // The settings may have changed whether objects are perceived.
            Cause::Reconfigured if self.file.is_some() => {
                state.table.get_or_insert_with(Table::default);
            }
            Cause::Reconfigured => state.table = None,
            _ => {}
        }
        self.follow(state);
    }

    /// Notes that an object of the table was handed to the user, or is back in its place. Its
    /// number in the scene stays, so that it can still be refused.
    pub(super) fn hand_over_from_table(&mut self, state: &mut State, name: &str, taken: bool) {
        let Some(table) = &mut state.table else { return };
        let object = table.objects.iter_mut().find(|object| object.name == name);
        if let Some(object) = object.filter(|object| object.taken != taken) {
            object.taken = taken;
            table.version += 1;
            self.follow(state);
        }
    }

    /// Translates a remembered delivery to the objects of the present scene; false if the object is
    /// not among them.
    pub(super) fn keep_delivery(&self, before: &mut Interaction) -> bool {
        let picked = self.setup.scene.object_named(&before.picked);
        before.pick = before.pick.zip(picked).map(|((id, _), object)| (id, object));
        for prompt in &mut before.prompts {
            prompt.question = prompt.named.question(&self.setup.scene);
        }
        before.pick.is_some()
    }
}

impl Setup {
    /// Returns whether the scene has no object to fetch.
    pub(super) fn nothing_stands(&self) -> bool {
        self.scene.objects().iter().all(|object| object.taken)
    }
}
