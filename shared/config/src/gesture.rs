//! `[gesture]` of `dialogue.toml`: pointing gestures.

use dialogue::gesture::{Direction, Gestures};
use scene::Scene;

use diagnostics::Fields;
use diagnostics::Report;
use diagnostics::Table;

/// Pointing gestures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gesture {
    /// Accept gestures.
    pub enabled: bool,
    /// Parameters of the observation model.
    pub model: Gestures,
    /// Origin of the pointing ray, metres, frame `base`.
    pub person_xyz_m: [f64; 3],
}

/// Maximum coordinate of the user, metres.
const PERSON_MAX_M: f64 = 20.0;

pub(crate) fn read(f: &mut Fields<'_>) -> Gesture {
    let enabled = f.flag("enabled");
    let model = Gestures {
        p_g: f.any_number("p_g"),
        std_theta_rad: f.any_number("std_theta_rad"),
        stray: f.any_number("stray"),
    };
    for (key, what, help) in model.check() {
        if !f.is_wrong(key) {
            f.problem(key, what, help);
        }
    }
    let person_xyz_m = f.triple("person_xyz");
    if !f.is_wrong("person_xyz") && person_xyz_m.iter().any(|x| x.abs() > PERSON_MAX_M) {
        let what = format!("expected -{PERSON_MAX_M} to {PERSON_MAX_M} m, found {person_xyz_m:?}");
        f.problem("person_xyz", what, "");
    }
    Gesture { enabled, model, person_xyz_m }
}

/// Reports an object at the position of the user, at which a ray cannot point.
pub(crate) fn check(scene: &Scene, gesture: &Gesture, tree: &Table, report: &mut Report) {
    if !gesture.enabled {
        return;
    }
    let directions = Direction::to_objects(gesture.person_xyz_m, scene);
    let objects = scene.objects().iter().zip(directions);
    let inside = |(object, direction): &(&scene::Object, Option<Direction>)| {
        object.placement.is_some() && direction.is_none()
    };
    for (object, _) in objects.filter(inside) {
        let path = ["dialogue", "gesture", "person_xyz"];
        let what = format!("the person stands where `{}` does", object.name);
        let help = "use a place from which people see the objects, e.g. [1.6, 0.0, 0.45]";
        report.add(tree.source_of(&path).diagnostic(&path.map(str::to_owned), what, help));
    }
}
