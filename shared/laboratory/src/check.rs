//! `check`: validation of a configuration, and the services that would run.

use std::path::Path;

use arm_driver::Drivers;
use command_line::Outcome;
use command_line::configuration;
use command_line::output::{Ink, Output, note, table};
use config::{Examined, ServiceConfig, Settings};
use diagnostics::{Diagnostic, Diagnostics};
use drivers::Shipped;
use language::word_findings;
use preflight::ArmSetup;
use scene::Scene;
use scene_editing::misunderstood;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};
use service::program::find_program;

use crate::args::CheckArgs;
use crate::progress::Progress;

/// Reports every problem of a configuration at once, or the services that would run.
///
/// # Errors
/// The configuration is not found.
pub fn check(args: &CheckArgs, out: &mut Output<'_>) -> Outcome {
    let folder = configuration::folder(&args.config)?;
    let profile = args.config.profile.as_deref();
    let progress = Progress::start(out);
    let set = &args.config.set;
    let mut examined = preflight::examine(&folder, profile, set, None, &|line| progress.at(line));
    let missing = examined.settings.iter().flat_map(|settings| missing_programs(settings, &folder));
    missing.for_each(|problem| examined.report.add(problem));
    let unmet = examined.settings.as_ref().filter(|_| examined.arm_is_right).map(unmet_by_robot);
    unmet.into_iter().flatten().for_each(|problem| examined.report.add(problem));
    verdict(examined, &folder, args.values, progress, out)
}

/// Reads the scene's words back, and reports on the configuration of `from`: every problem, or the services that would run.
pub(super) fn verdict(
    examined: Examined,
    from: &Path,
    with_values: bool,
    progress: Progress,
    out: &mut Output<'_>,
) -> Outcome {
    progress.at("reading the scene's words back".to_owned());
    let Examined { settings, mut report, .. } = examined;
    // The scene of the settings lacks its wrong parts.
    let words = settings.as_ref().map(Settings::scene_file).and_then(|file| {
        let scene = Scene::from_toml(&file.label, &file.text).ok()?;
        Some(misunderstood(&scene, file, word_findings))
    });
    let (problems, warnings) = words.unwrap_or_default();
    drop(progress);
    problems.into_iter().for_each(|problem| report.add(problem));
    match report.verdict(settings) {
        Err(problems) => refused(&problems, out),
        Ok(settings) if out.is_json() => {
            let stated = settings.warnings().iter().map(ToString::to_string);
            let warnings: Vec<String> = stated.chain(warnings).collect();
            out.json(&as_json(&settings, &warnings, with_values))?;
            Ok(Exit::Ok)
        }
        Ok(settings) => {
            let good = out.style().paint(Ink::Green, "is right");
            out.line(format_args!("{} {good}", from.display()))?;
            for line in summary(&settings) {
                out.line(line)?;
            }
            for warning in settings.warnings() {
                note(format_args!("warning: {warning}"));
            }
            for assumed in assumptions(&settings) {
                note(format_args!("warning: robot: {assumed}"));
            }
            for warning in warnings {
                note(format_args!("warning: scene {}: {warning}", settings.scene.name()));
            }
            if with_values {
                values(&settings, out)?;
            }
            Ok(Exit::Ok)
        }
    }
}

/// What is taken for granted of the robot.
fn assumptions(settings: &Settings) -> Vec<String> {
    ArmSetup::new(settings).map(|setup| setup.robot.assumptions()).unwrap_or_default()
}

/// The programs of services that cannot be started.
fn missing_programs(settings: &Settings, folder: &Path) -> Vec<Diagnostic> {
    let missing = |service: &ServiceConfig| {
        let command = service.command.as_ref()?;
        let error = find_program(command, folder).err()?;
        let key = ["group", "services", &service.name, "command"];
        let help = "install the program, or write its whole path";
        Some(settings.diagnostic(&key, error.to_string(), help))
    };
    settings.group.services.iter().filter_map(missing).collect()
}

/// What the driver of the arm needs, of the robot and of this machine. Programs of others have drivers of their own.
fn unmet_by_robot(settings: &Settings) -> Vec<Diagnostic> {
    let driver = Shipped::LIST.iter().find(|driver| driver.about.name == settings.arm.driver);
    let Some((driver, setup)) = driver.zip(ArmSetup::new(settings).ok()) else { return Vec::new() };
    let wrong = (driver.configure)(settings, &setup.robot).err();
    let wrong = wrong.iter().flat_map(Diagnostics::iter).cloned();
    wrong.chain(driver.examine.iter().flat_map(|examine| examine(settings, &setup.robot))).collect()
}

fn refused(problems: &Diagnostics, out: &mut Output<'_>) -> Outcome {
    if out.is_json() {
        out.json(&json!({ "ok": false, "problems": self::problems(problems) }))?;
    } else {
        note(problems);
        note(scene::count(problems.iter().count(), "problem"));
    }
    Ok(Exit::Config)
}

/// The problems as JSON.
pub(super) fn problems(problems: &Diagnostics) -> Vec<Json> {
    let problem = |p: &Diagnostic| {
        json!({ "file": p.file, "line": p.line, "column": p.column, "key": p.key, "what": p.what,
                "cure": p.help })
    };
    problems.iter().map(problem).collect()
}

fn summary(settings: &Settings) -> Vec<String> {
    let Settings { group, dialogue, speech, arm, scene, .. } = settings;
    let objects = scene::count(scene.objects().len(), "object");
    let attributes: Vec<&str> = scene.attributes().iter().map(|a| a.name.as_str()).collect();
    let params = dialogue.params;
    let asks = [
        (dialogue.actions.attribute, "yes/no"),
        (dialogue.actions.which, "open"),
        (dialogue.actions.choice, "choice"),
        (dialogue.actions.point(), "pointing"),
    ];
    let asks: Vec<&str> = asks.into_iter().filter(|(on, _)| *on).map(|(_, what)| what).collect();
    let asks = if asks.is_empty() { "no".to_owned() } else { asks.join(", ") };
    let limb = arm.limb.as_ref();
    let limb = limb.map_or("the nearer limb".to_owned(), |limb| format!("the {limb} limb"));
    let mut lines = vec![
        format!("  scene     {} ({objects}; {})", scene.name(), attributes.join(", ")),
        format!("  fetching  {}", fetched(scene)),
        format!(
            "  dialogue  planner {}, {:?} language, {asks} questions; p_l {}, epsilon {}, alpha {}",
            dialogue.planner, dialogue.language, params.p_l, params.epsilon, params.alpha
        )
        .to_lowercase(),
        format!("  speech    voice {:?}, recogniser {:?}", speech.voice, speech.recogniser)
            .to_lowercase(),
        format!(
            "  arm       {limb}, {:.0} % of its speed, time × {}",
            arm.motion.speed_ratio * 100.0,
            arm.time_scale
        ),
        "  services".to_owned(),
    ];
    let rows: Vec<Vec<String>> = group.services.iter().map(service).collect();
    let heads = ["NAME", "RUNS", "AFTER", "WATCHDOG", "RESTART"];
    lines.extend(table(&heads, &rows).into_iter().map(|line| format!("    {line}")));
    lines
}

/// The objects that the arm was planned for, and those that were not.
fn fetched(scene: &Scene) -> String {
    let placed = scene.placed().count();
    match scene.objects().len() - placed {
        0 => "every object is within reach".to_owned(),
        others => {
            format!("{placed} within reach; {others} without a place can only be talked about")
        }
    }
}

fn service(service: &config::ServiceConfig) -> Vec<String> {
    let program = |command: &Vec<String>| command.join(" ");
    let command = service.command.as_ref();
    let seconds = |time: std::time::Duration| format!("{} s", time.as_secs_f64());
    vec![
        service.name.clone(),
        command.map_or_else(|| format!("whichone-{}", service.name), program),
        if service.after.is_empty() { "-".to_owned() } else { service.after.join(", ") },
        service.watchdog.map_or_else(|| "-".to_owned(), seconds),
        format!("{:?}", service.restart).to_lowercase(),
    ]
}

fn values(settings: &Settings, out: &mut Output<'_>) -> Result<(), Failure> {
    let rows: Vec<Vec<String>> =
        settings.origins().into_iter().map(|o| vec![o.key, o.value, o.from]).collect();
    table(&["KEY", "VALUE", "FROM"], &rows).into_iter().try_for_each(|line| out.line(line))
}

fn as_json(settings: &Settings, warnings: &[String], values: bool) -> Json {
    let services: Vec<Json> = (settings.group.services.iter())
        .map(|service| {
            json!({ "name": service.name, "command": service.command, "after": service.after,
                    "critical": service.critical, "nice": service.nice })
        })
        .collect();
    let mut json = json!({
        "ok": true,
        "scene": { "name": settings.scene.name(), "objects": settings.scene.objects().len(),
                   "placed": settings.scene.placed().count() },
        "warnings": warnings,
        "assumed": assumptions(settings),
        "planner": settings.dialogue.planner,
        "params": settings.dialogue.params,
        "costs": settings.dialogue.costs,
        "actions": settings.dialogue.actions,
        "services": services,
    });
    if values {
        let values: Vec<Json> = (settings.origins().into_iter())
            .map(|o| json!({ "key": o.key, "value": o.value, "from": o.from }))
            .collect();
        json["values"] = Json::from(values);
    }
    json
}

#[cfg(test)]
mod tests {
    use command_line::args::ConfigArgs;

    use super::*;

    fn checked(set: &[(&str, &str)]) -> (Exit, Json) {
        let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        let set = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let config = ConfigArgs { config: Some(config), set, ..ConfigArgs::default() };
        let mut bytes = Vec::new();
        let args = CheckArgs { config, values: false };
        let exit = check(&args, &mut Output::to(&mut bytes, true)).unwrap();
        (exit, serde_json::from_slice(&bytes).unwrap())
    }

    #[test]
    fn program_that_does_not_exist_is_a_problem() {
        let (exit, found) = checked(&[("group.services.policy.command", "[\"/nope/x\", \"1\"]")]);
        assert_eq!(exit, Exit::Config, "{found}");
        let problem = &found["problems"][0];
        assert_eq!(problem["key"], "group.services.policy.command", "{found}");
        assert_eq!(problem["what"], "/nope/x: no such program", "{found}");
        let (exit, found) = checked(&[("group.services.policy.command", "[\"sh\"]")]);
        assert_eq!((exit, &found["assumed"]), (Exit::Ok, &json!([])), "{found}");
    }
}
