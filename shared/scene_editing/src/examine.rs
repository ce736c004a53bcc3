//! Problems of a scene in a configuration, and the reach of its arm.

use std::path::PathBuf;
use std::time::Instant;

use config::Settings;
use diagnostics::{Diagnostic, Diagnostics, Report, Source, Table, TextFile};
use manipulation::{ObjectPose, PlanError, fetching_limb};
use preflight::ArmSetup;
use scene::{Scene, WordFindings, WordProblem};
use serde::Serialize;

use crate::ObjectEntry;
use crate::ambiguity::ambiguities;

/// The configuration in which a scene is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// Folder of the configuration.
    pub folder: PathBuf,
    /// Profile of the configuration.
    pub profile: Option<String>,
    /// Overrides of its values: dotted key and value.
    pub set: Vec<(String, String)>,
}

/// Result of a check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Findings {
    /// Every problem; empty for a usable scene.
    pub problems: Vec<Problem>,
    /// Ambiguities for a person.
    pub warnings: Vec<String>,
    /// The robot's words for each object; empty if the file has problems.
    pub words: Vec<String>,
}

/// A problem, with the keys of `whichone scene check --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Problem {
    /// Path of the file.
    pub file: String,
    /// Line, from 1.
    pub line: Option<u32>,
    /// Column, from 1.
    pub column: Option<u32>,
    /// Dotted key, e.g. `objects[2].xyz`.
    pub key: String,
    /// The problem: expected and found.
    pub what: String,
    /// The fix; may be empty.
    pub cure: String,
}

impl From<&Diagnostic> for Problem {
    fn from(found: &Diagnostic) -> Self {
        Self {
            file: found.file.clone(),
            line: found.line,
            column: found.column,
            key: found.key.clone(),
            what: found.what.clone(),
            cure: found.help.clone(),
        }
    }
}

/// The reader's findings in a scene's words (`language::word_findings`); an argument, so that
/// editors of scenes do not depend on the reading of English.
pub type ReadBack = fn(&Scene) -> WordFindings;

/// Checks the text of a scene as `whichone scene check` does, with reach and clearance.
pub fn check(configuration: &Configuration, file: TextFile, read_back: ReadBack) -> Findings {
    let Configuration { folder, profile, set } = configuration;
    let words = Scene::from_toml(&file.label, &file.text).map(|scene| {
        let objects = scene.objects().len();
        let words = (0..objects).map(|n| scene.describe(n.into())).collect();
        (words, misunderstood(&scene, &file, read_back))
    });
    let (words, (misread, warnings)) = words.unwrap_or_default();
    let loaded = preflight::examine(folder, profile.as_deref(), set, Some(file), &|_| {}).verdict();
    let faults = loaded.as_ref().err().into_iter().flat_map(Diagnostics::iter);
    let problems = faults.chain(&misread).map(Problem::from).collect();
    Findings { problems, warnings, words }
}

/// Returns the ambiguities of a scene for a person: problems of its file, and warnings.
pub fn misunderstood(
    scene: &Scene,
    file: &TextFile,
    read_back: ReadBack,
) -> (Vec<Diagnostic>, Vec<String>) {
    let WordFindings { problems, warnings } = read_back(scene);
    let source = Source::new(file.label.as_str(), 0);
    let table = Table::parse(&file.text, &source, &mut Report::default());
    let table = table.unwrap_or_else(|| Table::empty(source));
    let diagnostic = |WordProblem { key, what, help }| table.diagnostic(key, what, help);
    let mut all = ambiguities(scene);
    all.extend(warnings);
    (problems.into_iter().map(diagnostic).collect(), all)
}

/// A robot, as an editor draws it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RobotSummary {
    /// Name of the robot.
    pub name: String,
    /// The limbs that may fetch.
    pub limbs: Vec<LimbSummary>,
    /// Height of the table, metres.
    pub table_z_m: f64,
    /// Place for handing over objects, metres.
    pub hand_over_xyz_m: [f64; 3],
}

/// Summary of a limb.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LimbSummary {
    /// Name of the limb.
    pub name: String,
    /// Shoulder of the limb, metres, frame `base`.
    pub shoulder_xyz_m: [f64; 3],
    /// Widths that the fingers can grip, metres: from the thinnest to the widest.
    pub grip_m: [f64; 2],
}

/// Reach of a configuration's arm for objects.
#[derive(Debug)]
pub struct Reach {
    configuration: Configuration,
    setup: ArmSetup,
}

/// Ranges of an object in requests about the reach, metres and kg: as those of scene files.
const DISTANCE_MAX_M: f64 = 5.0;
const EXTENT_MAX_M: f64 = 2.0;

/// A scene without mistakes.
const ANY_SCENE: &str = "name = 'any'\nnoun = 'thing'\n[[attributes]]\nname = 'kind'\nvalues = ['any']\n\
                         [[objects]]\nname = 'any'\nattributes = { kind = 'any' }\n";

impl Reach {
    /// Reads the arm's settings and the robot's description.
    ///
    /// # Errors
    /// Every problem of the configuration.
    pub fn new(configuration: &Configuration) -> Result<Self, Diagnostics> {
        // The scene has no part in it: any one will do.
        let scene = TextFile::new("scene", ANY_SCENE);
        let Configuration { folder, profile, set } = configuration;
        let settings = Settings::examine(folder, profile.as_deref(), set, Some(scene)).verdict()?;
        Ok(Self { configuration: configuration.clone(), setup: ArmSetup::new(&settings)? })
    }

    /// Returns whether it is of this configuration. Only [`Reach::new`] notices a changed file.
    pub fn is_of(&self, configuration: &Configuration) -> bool {
        self.configuration == *configuration
    }

    /// The robot, as an editor draws it.
    pub fn robot(&self) -> RobotSummary {
        let ArmSetup { robot, limb, plan } = &self.setup;
        let limbs = robot.limbs().iter().filter(|own| limb.is_none_or(|only| only == **own));
        let limbs = limbs.map(|limb| {
            let arm = robot.arm(*limb);
            let shoulder = arm.chain.frames(&arm.neutral)[0].origin;
            let grip_m = [arm.gripper.least_m(), arm.gripper.width_m(plan.open_percent)];
            LimbSummary { name: arm.name.clone(), shoulder_xyz_m: shoulder.into(), grip_m }
        });
        RobotSummary {
            name: robot.description().name().to_owned(),
            limbs: limbs.collect(),
            table_z_m: plan.table_z_m,
            hand_over_xyz_m: plan.hand_over_xyz_m,
        }
    }

    /// Returns the name of the limb that can fetch a lone object with its centre at each of these
    /// places (x and y, metres, at the height of the object), or why none can. Stops at `until`,
    /// after the first at least; `None` without a place, or with an impossible size.
    pub fn limbs(
        &self,
        object: &ObjectEntry,
        at: &[[f64; 2]],
        until: Instant,
    ) -> Option<Vec<Result<String, String>>> {
        let mut pose = pose(object)?;
        let ArmSetup { robot, limb, plan } = &self.setup;
        let mut found = Vec::new();
        for &[x, y] in at {
            if !found.is_empty() && Instant::now() >= until {
                break;
            }
            if x.abs() > DISTANCE_MAX_M || y.abs() > DISTANCE_MAX_M {
                return None;
            }
            (pose.xyz_m[0], pose.xyz_m[1]) = (x, y);
            let limb = fetching_limb(robot, &pose, *limb, &[], plan);
            let limb = limb.map(|limb| robot.arm(limb).name.clone());
            let is_grasp = matches!(limb, Err(PlanError::Grasp(_)));
            found.push(limb.map_err(|error| error.to_string()));
            if is_grasp {
                // No other place helps.
                found.resize(at.len(), found[found.len() - 1].clone());
                break;
            }
        }
        Some(found)
    }
}

/// The pose of an object that has all keys of a place.
fn pose(object: &ObjectEntry) -> Option<ObjectPose> {
    let (xyz_m, size_m) = (object.xyz?, object.size?);
    let grasp_width_m = object.grasp_width?;
    let mut lengths = size_m.iter().chain([&grasp_width_m]);
    let are_lengths = lengths.all(|m| *m > 0.0 && *m <= EXTENT_MAX_M);
    let is_near = xyz_m.iter().all(|m| m.abs() <= DISTANCE_MAX_M);
    let mass_is_right = object.mass_kg.is_none_or(|kg| kg > 0.0);
    (are_lengths && is_near && mass_is_right).then_some(ObjectPose {
        xyz_m,
        yaw_rad: object.yaw.unwrap_or(0.0),
        size_m,
        grasp_width_m,
        mass_kg: object.mass_kg,
        wall_rad: object.wall_deg.unwrap_or(0.0).clamp(0.0, 30.0).to_radians(),
        hollow: object.form.as_deref() == Some("hollow"),
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::Duration;

    use super::*;
    use crate::SceneEdit;

    fn shipped() -> Configuration {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        Configuration { folder, profile: None, set: Vec::new() }
    }

    fn bowls() -> SceneEdit {
        let text = include_str!("../../../config/scenes/bowls.toml");
        SceneEdit::parse("bowls.toml", text).unwrap()
    }

    #[test]
    fn problems_are_those_of_the_check_with_their_keys() {
        let mut edit = bowls();
        let found = check(&shipped(), TextFile::new("bowls.toml", edit.text()), |_| {
            WordFindings::default()
        });
        assert_eq!((found.problems.len(), found.words.len()), (0, 6), "{found:?}");
        let mut document = edit.document().unwrap();
        document.objects[2].xyz = Some([1.9, 0.57, 0.135]);
        document.objects[4].attributes.insert("color".into(), "gren".into());
        edit.apply(&document).unwrap();
        let found = check(&shipped(), TextFile::new("bowls.toml", edit.text()), |_| {
            WordFindings::default()
        });
        let keys: Vec<&str> = found.problems.iter().map(|it| it.key.as_str()).collect();
        assert_eq!(keys, ["objects[4].attributes.color", "objects[2].xyz"], "{found:?}");
        assert!(found.problems[1].cure.contains("move it"), "{found:?}");
    }

    #[test]
    fn reach_names_the_limb_of_each_place_and_keeps_to_its_time() {
        let reach = Reach::new(&shipped()).unwrap();
        let robot = reach.robot();
        assert_eq!(robot.limbs.len(), 2);
        assert!(robot.limbs[0].shoulder_xyz_m[1] > 0.0 && robot.limbs[0].grip_m[1] > 0.02);
        let mut object = bowls().document().unwrap().objects.remove(1);
        let places = [[0.65, 0.3], [0.65, -0.3], [1.9, 0.0]];
        let late = Instant::now() + Duration::from_secs(60);
        let found = reach.limbs(&object, &places, late).unwrap();
        assert_eq!(found[0].as_deref(), Ok("left"));
        assert_eq!(found[1].as_deref(), Ok("right"));
        assert!(found[2].as_ref().unwrap_err().contains("reach"), "{found:?}");
        let first = reach.limbs(&object, &places, Instant::now()).unwrap();
        assert_eq!(first.len(), 1);
        object.form = None;
        let none = reach.limbs(&object, &places, Instant::now()).unwrap();
        assert!(none.len() == 3 && none.iter().all(Result::is_err), "{none:?}");
        object.size = Some([0.1, -0.1, 0.1]);
        assert_eq!(reach.limbs(&object, &places, late), None);
    }
}
