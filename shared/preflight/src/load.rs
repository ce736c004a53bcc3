//! Loading of a configuration, with the checks that need the robot.

use std::path::Path;

use config::{CostsFrom, Settings};
use diagnostics::{Diagnostics, Report};
use dialogue::Durations;
use scene::Scene;

use crate::{ArmSetup, Extent, MotionError, Motions, Pace, Voice, measure, reach};

/// Loads a configuration folder ([`Settings::load`]), checks that the arm can fetch every object that
/// has a place, and measures the durations if they are the costs of questions.
///
/// # Errors
/// Every problem of the files at once; if there is none, every fault of the robot's description; if
/// there is none either, every object with a place that the arm cannot fetch.
pub fn load(
    dir: &Path,
    profile: Option<&str>,
    overrides: &[(String, String)],
) -> Result<Settings, Diagnostics> {
    let mut settings = Settings::load(dir, profile, overrides)?;
    let setup = ArmSetup::new(&settings)?;
    let mut report = Report::default();
    reach::check(&settings, &setup, &mut report);
    report.verdict(Some(()))?;
    if settings.dialogue.costs_from == CostsFrom::Robot {
        let pointing = settings.dialogue.actions.point();
        let measured = durations(&settings, &setup, &settings.scene, pointing);
        settings.durations = Some(measured.map_err(|error| {
            let help = "move it, or set costs.from of the dialogue to \"config\"";
            Diagnostics::from(settings.scene_diagnostic("objects", error.to_string(), help))
        })?);
    }
    Ok(settings)
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
