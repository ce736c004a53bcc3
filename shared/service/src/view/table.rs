//! The scene as clients show it if objects come from perception: the scene file's words about the
//! objects of the latest table. Messages that name objects by number are translated at this edge.

use messages::{ArmStatus, Observation, PolicyView, TableView, WorldView, topics};
use scene::{ObjectId, Question, Scene};
use vocabulary::Action;

use super::quiet;
use crate::bus::{Bus, BusError, EncodedReader};

/// Follows the objects on the table.
#[derive(Debug)]
pub struct TableScene {
    tables: EncodedReader<TableView>,
    file: Scene,
    scene: Scene,
    /// The latest table.
    table: Option<TableView>,
}

impl TableScene {
    /// Opens the topic; `file` is the scene file, which has the words.
    ///
    /// # Errors
    /// A topic of another schema, or no shared memory.
    pub fn open(bus: &Bus, file: &Scene) -> Result<Self, BusError> {
        let (file, scene) = (file.clone(), file.with_objects(&[]));
        Ok(Self { tables: bus.encoded_reader(&topics::OBJECTS)?, file, scene, table: None })
    }

    /// Takes over another scene file, after a reload.
    pub fn set_file(&mut self, file: &Scene) {
        self.file = file.clone();
        self.lay();
    }

    /// Returns the latest table.
    pub fn table(&self) -> Option<&TableView> {
        self.table.as_ref()
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Processes new messages. Returns the scene if it has changed.
    pub fn take(&mut self) -> Option<&Scene> {
        let view = quiet(self.tables.latest())?;
        let known = |view: &TableView| -> Vec<scene::Perceived> {
            view.objects.iter().map(|object| object.known.clone()).collect()
        };
        let before = self.table.replace(view);
        let is_new = before.as_ref().map(known) != self.table.as_ref().map(known);
        is_new.then(|| {
            self.lay();
            &self.scene
        })
    }

    fn lay(&mut self) {
        let objects = self.table.iter().flat_map(|table| &table.objects);
        let objects: Vec<_> = objects.map(|object| object.known.clone()).collect();
        self.scene = self.file.with_objects(&objects);
    }

    fn place(&self, number: ObjectId) -> ObjectId {
        self.scene.numbered(number).unwrap_or(ObjectId(u16::MAX))
    }

    fn question(&self, question: Question) -> Question {
        match question {
            Question::Point(object) => {
                self.scene.numbered(object).map_or(Question::None, Question::Point)
            }
            other => other,
        }
    }

    /// Translates a view to the objects' places in the scene. `None` if it is about another table;
    /// the view of this one follows. A view of another scene file stays as it is.
    pub fn view(&self, mut view: PolicyView) -> Option<PolicyView> {
        if view.scene_key != self.file.key() {
            return Some(view);
        }
        let own = (0..self.scene.objects().len()).map(|i| self.scene.number(i.into()));
        if !own.eq(view.objects.iter().copied()) {
            return None;
        }
        view.scene_key = self.scene.key();
        view.question = self.question(view.question);
        for (action, _) in &mut view.alternatives {
            *action = match *action {
                Action::Ask(question) => Action::Ask(self.question(question)),
                Action::Pick(object) => Action::Pick(self.place(object)),
                Action::Wait => Action::Wait,
            };
        }
        if let Some(last) = &mut view.last {
            last.object = last.object.map(|object| self.place(object));
        }
        if let Some(delivery) = &mut view.refusable {
            delivery.object = self.place(ObjectId(delivery.object)).0;
        }
        Some(view)
    }

    /// Translates the arm's status.
    pub fn status(&self, status: ArmStatus) -> ArmStatus {
        let number = u16::try_from(status.object).map_or(ObjectId(u16::MAX), ObjectId);
        ArmStatus { object: self.place(number).0.into(), ..status }
    }

    /// Translates an observation: its words are those of the scene file.
    pub fn observation(&self, observation: &Observation) -> Observation {
        let is_ours = observation.scene_key == self.file.key();
        let scene_key = if is_ours { self.scene.key() } else { observation.scene_key };
        Observation { scene_key, ..*observation }
    }

    /// Translates the poses of the objects.
    pub fn world(&self, world: &WorldView) -> WorldView {
        let pose = |i: usize| {
            let number = self.scene.number(i.into());
            let place = world.numbers.iter().position(|known| *known == number)?;
            world.objects.get(place).copied().flatten()
        };
        WorldView {
            objects: (0..self.scene.objects().len()).map(pose).collect(),
            held: world.held.map(|held| self.place(ObjectId(held)).0),
            numbers: Vec::new(),
            ..world.clone()
        }
    }
}
