//! Objects on a simulated table under a simulated camera, while people put, move and take them.

use baxter::camera::{Camera, CameraSettings, Standing};
use messages::{PickOutcome, PickPhase, Sighting, TableView, WorldView};
use scene::{Object, ObjectId, Perceived, Question, Scene};
use service::{Span, Time};

use super::noisy::NoisyDetector;

/// Distance from a gripper within which nobody moves an object, metres.
const NEAR_M: f64 = 0.50;
/// Distance from where the arm grasps within which an object is the one that is grasped, metres.
const GRASPED_M: f64 = 0.05;
/// Error of a place that a grasp forgives, metres.
pub(super) const FORGIVEN_M: f64 = 0.010;

/// What happens to the table during a dialogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Happening {
    /// Nothing.
    Nothing,
    /// The object, which was not there, appears.
    Appears(usize),
    /// The object is moved by that much along x and y, metres.
    Moves(usize, [f64; 2]),
    /// The object is taken away.
    Vanishes(usize),
}

/// What looks at the table.
#[derive(Clone, Debug)]
pub enum Eye {
    /// A camera that takes an object for the same thing at every look.
    Camera(Camera),
    /// A detector whose errors are independent from look to look.
    Detector(NoisyDetector),
}

impl Eye {
    /// Returns a simulated camera.
    pub fn camera(settings: CameraSettings) -> Self {
        Self::Camera(Camera::new(settings))
    }
}

/// The simulated table.
#[derive(Debug)]
pub struct TableTop {
    file: Scene,
    eye: Eye,
    /// Where each object of the scene file stands.
    places: Vec<Option<[f64; 3]>>,
    happening: (Happening, Time),
    /// The latest messages.
    table: TableView,
    world: WorldView,
    closing: bool,
    /// What the arm has grasped, and where it stood.
    grasped: Option<(usize, [f64; 3])>,
    /// Each closing of the fingers: the object that was there, and how far from where the arm took it
    /// to be, metres.
    pub grasps: Vec<(Option<usize>, f64)>,
}

impl TableTop {
    /// The objects of the scene file in their places, and what happens at that time.
    pub fn new(file: &Scene, eye: Eye, happening: (Happening, Time)) -> Self {
        let place = |object: &Object| object.placement.map(|placement| placement.xyz);
        let mut places: Vec<_> = file.objects().iter().map(place).collect();
        if let Happening::Appears(object) = happening.0 {
            places[object] = None;
        }
        Self {
            file: file.clone(),
            eye,
            places,
            happening,
            table: TableView::default(),
            world: WorldView::default(),
            closing: false,
            grasped: None,
            grasps: Vec::new(),
        }
    }

    /// Returns the camera's reports. `is_held` objects are in a gripper or with a person.
    pub(super) fn look(&mut self, now: Time) -> Vec<Sighting> {
        self.happen(now);
        let standing: Vec<Standing> = (self.places.iter().enumerate())
            .filter_map(|(object, xyz)| {
                let yaw = self.file.objects()[object].placement.map_or(0.0, |it| it.yaw);
                xyz.map(|xyz| Standing { object, xyz, yaw })
            })
            .collect();
        let grippers = self.grippers();
        match &mut self.eye {
            Eye::Camera(camera) => camera.look(&self.file, &standing, &grippers, now),
            Eye::Detector(detector) => detector.look(&self.file, &standing, &grippers, now),
        }
    }

    /// People move what the arm is not near to; else they wait.
    fn happen(&mut self, now: Time) {
        let (what, at) = self.happening;
        if now < at {
            return;
        }
        let (object, to) = match what {
            Happening::Nothing => return,
            Happening::Appears(object) => {
                (object, self.file.objects()[object].placement.map(|it| it.xyz))
            }
            Happening::Moves(object, [dx, dy]) => {
                (object, self.places[object].map(|[x, y, z]| [x + dx, y + dy, z]))
            }
            Happening::Vanishes(object) => (object, None),
        };
        let here = self.places[object].or(to);
        let near = |gripper: &[f64; 3]| here.is_some_and(|here| off(&here, gripper) < NEAR_M);
        if self.grippers().iter().any(near) {
            self.happening.1 = now + Span::from_ms(500);
            return;
        }
        if self.places[object].is_some() || matches!(what, Happening::Appears(_)) {
            self.places[object] = to;
        }
        self.happening.0 = Happening::Nothing;
    }

    fn grippers(&self) -> Vec<[f64; 3]> {
        let known = self.world.at_ns > 0;
        let all = self.world.grippers.iter().filter(|_| known);
        all.map(|[x, y, z, ..]| [*x, *y, *z]).collect()
    }

    pub(super) fn on_table(&mut self, table: &TableView) {
        self.table = table.clone();
    }

    pub(super) fn on_world(&mut self, world: &WorldView) {
        self.world = world.clone();
    }

    /// Notes what stands where the fingers close.
    pub(super) fn on_arm(&mut self, status: &messages::ArmStatus) {
        let phase = status.phase.get();
        let number = u16::try_from(status.object).map(ObjectId).ok();
        let begins = phase == PickPhase::Closing && !std::mem::replace(&mut self.closing, true);
        if begins && let Some(believed) = number.and_then(|number| self.believed(number)) {
            let there = self.nearest(&believed);
            self.grasps.push(there.map_or((None, f64::INFINITY), |(i, m)| (Some(i), m)));
            if let Some((object, _)) = there {
                self.grasped = self.places[object].take().map(|xyz| (object, xyz));
            }
        }
        self.closing &=
            matches!(phase, PickPhase::Closing | PickPhase::Holding | PickPhase::Returning);
        // What was called off while it was held is back in its place.
        if phase == PickPhase::Done
            && let Some((object, xyz)) = self.grasped.take()
            && status.outcome.get() == PickOutcome::Cancelled
        {
            self.places[object] = Some(xyz);
        }
    }

    /// Where the arm takes the object to be.
    fn believed(&self, number: ObjectId) -> Option<[f64; 3]> {
        let place = self.world.numbers.iter().position(|known| *known == number)?;
        let [x, y, z, ..] = self.world.objects.get(place).copied().flatten()?;
        Some([x, y, z])
    }

    /// Returns whether the wanted object fits best once all values of it are known.
    pub(super) fn fits_best(&self, wanted: ObjectId) -> bool {
        fits_best(&self.file, &self.known(), wanted)
    }

    /// Returns the scene that a question about places is about, which the scene file does not have, and in it the
    /// wanted object, if it was perceived where it stands.
    pub(super) fn by_place(
        &self,
        question: Question,
        wanted: Option<ObjectId>,
    ) -> Option<(Scene, Option<ObjectId>)> {
        let k = question.attribute()?;
        let scene = self.file.with_objects(&self.known());
        if !scene.attributes().get(k.index())?.by_place {
            return None;
        }
        let here = wanted.and_then(|wanted| self.places[wanted.index()]);
        let stands = |here: [f64; 3]| {
            let perceived = self.table.objects.iter().map(|it| off(&it.place, &here)).enumerate();
            let nearest = perceived.min_by(|a, b| a.1.total_cmp(&b.1));
            nearest.filter(|(_, far)| *far < GRASPED_M).map(|(i, _)| ObjectId::from(i))
        };
        Some((scene, here.and_then(stands)))
    }

    fn known(&self) -> Vec<Perceived> {
        self.table.objects.iter().map(|object| object.known.clone()).collect()
    }

    fn nearest(&self, xyz: &[f64]) -> Option<(usize, f64)> {
        let standing = self.places.iter().enumerate();
        let far = standing.filter_map(|(i, place)| Some((i, off(&(*place)?, xyz))));
        far.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, far)| *far < GRASPED_M)
    }

    /// Translates a question to the objects of the scene file: people see which one the robot means.
    pub(super) fn question(&self, question: Question) -> Question {
        let Question::Point(number) = question else { return question };
        let object = self.table.objects.iter().find(|object| object.known.number == number);
        let there = object.and_then(|object| self.nearest(&object.place));
        there.map_or(Question::None, |(object, _)| Question::Point(object.into()))
    }
}

/// Returns whether, of the objects as they were perceived, the wanted one is the likeliest to have all its values.
pub(super) fn fits_best(file: &Scene, known: &[Perceived], wanted: ObjectId) -> bool {
    let scene = file.with_objects(known);
    let Object { name, values, .. } = file.object(wanted);
    let fit = |object: &Object| -> f64 {
        let each = values.iter().zip(&object.values).zip(&object.chances);
        each.map(|((value, own), chances)| match (value, chances) {
            (Some(value), Some(chances)) => chances[value.index()],
            _ => f64::from(u8::from(value == own)),
        })
        .product()
    };
    let fits = scene.objects().iter().map(fit).zip(known);
    let best = fits.max_by(|a, b| a.0.total_cmp(&b.0));
    best.is_some_and(|(_, best)| best.class() == Some(name.as_str()))
}

/// Horizontal distance, metres.
fn off(a: &[f64], b: &[f64]) -> f64 {
    (0..2).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
