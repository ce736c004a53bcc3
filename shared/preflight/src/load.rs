//! Loading of a configuration, with the checks that need the robot.

use std::path::Path;

use config::{CostsFrom, Examined, Settings};
use diagnostics::{Diagnostics, TextFile};
use scene::Scene;
use vocabulary::Durations;

use crate::{ArmSetup, Extent, MotionError, Motions, Pace, Voice, measure, reach};

/// Loads a configuration folder ([`Settings::load`]), checks that the arm can fetch every object
/// that has a place, and measures the durations if they are the costs of questions.
///
/// # Errors
/// Every problem of the files and every object with a place that the arm cannot fetch, at once. The
/// reach is not checked if a problem concerns the arm's settings or the robot's description.
pub fn load(
    dir: &Path,
    profile: Option<&str>,
    overrides: &[(String, String)],
) -> Result<Settings, Diagnostics> {
    examine(dir, profile, overrides, None, &|_| {}).verdict()
}

/// Does the same as [`load`], but skips the check of the arm's reach, which takes most of the time,
/// if `is_known` says that these settings have passed it before.
///
/// # Errors
/// As [`load`].
pub fn load_known(
    dir: &Path,
    profile: Option<&str>,
    overrides: &[(String, String)],
    is_known: impl FnOnce(&Settings) -> bool,
) -> Result<Settings, Diagnostics> {
    checked(Settings::examine(dir, profile, overrides, None), is_known, &|_| {}).verdict()
}

/// Takes what a check is at, as a line for people, from any of its threads.
pub type Watch<'a> = &'a (dyn Fn(String) + Sync);

/// Does the same as [`load`] before a verdict, so that further checks may add to the report.
/// `scene` is read in place of the scene that the configuration names.
pub fn examine(
    dir: &Path,
    profile: Option<&str>,
    overrides: &[(String, String)],
    scene: Option<TextFile>,
    watch: Watch<'_>,
) -> Examined {
    checked(Settings::examine(dir, profile, overrides, scene), |_| false, watch)
}

fn checked(
    examined: Examined,
    is_known: impl FnOnce(&Settings) -> bool,
    watch: Watch<'_>,
) -> Examined {
    let Examined { mut settings, mut report, arm_is_right } = examined;
    let mut measured = None;
    // Durations are measured by the plans that show the reach.
    let is_left = |settings: &&Settings| {
        let has_passed = settings.dialogue.costs_from == CostsFrom::Config && is_known(settings);
        arm_is_right && !(has_passed && report.count() == 0)
    };
    if let Some(settings) = settings.as_ref().filter(is_left) {
        match ArmSetup::new(settings) {
            Ok(setup) => reach::check(settings, &setup, &mut report, watch, || {
                watch("planning the picks of all places".to_owned());
                measured = costs(settings, &setup);
                matches!(measured, Some(Ok(_)))
            }),
            Err(faults) => report.extend(faults),
        }
    }
    // Other problems would be reported again as objects that cannot be measured.
    if let Some(settings) = settings.as_mut().filter(|_| report.count() == 0) {
        match measured.transpose() {
            Ok(durations) => settings.durations = durations,
            Err(error) => {
                let help = "move it, or set costs.from of the dialogue to \"config\"";
                report.add(settings.scene_diagnostic("objects", error.to_string(), help));
            }
        }
    }
    Examined { settings, report, arm_is_right }
}

/// The durations, if they are the costs of questions.
fn costs(settings: &Settings, setup: &ArmSetup) -> Option<Result<Durations, MotionError>> {
    let pointing = settings.dialogue.actions.point();
    let from_robot = settings.dialogue.costs_from == CostsFrom::Robot;
    from_robot.then(|| durations(settings, setup, &settings.scene, pointing))
}

/// Measures the seconds of every question and pick in a scene, at the configured speed of voice and
/// arm. Those of the arm are missing if some object has no place, those of pointing without
/// `pointing`.
///
/// # Errors
/// An object that the arm cannot reach or point at.
pub fn durations(
    settings: &Settings,
    setup: &ArmSetup,
    scene: &Scene,
    pointing: bool,
) -> Result<Durations, MotionError> {
    let extent = if pointing { Extent::FromRest } else { Extent::Picks };
    let placed = scene.objects().iter().all(|object| object.placement.is_some());
    let motions = placed
        .then(|| Motions::plan(&setup.robot, scene, setup.limb, &setup.plan, extent))
        .transpose()?;
    let voice = Voice { words_per_minute: f64::from(settings.speech.voice_words_per_minute) };
    Ok(measure(scene, &voice, &Pace::default(), motions.as_ref()))
}
