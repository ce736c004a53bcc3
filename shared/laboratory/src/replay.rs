//! `replay`: flights through this build's reducers, each by its service's own program.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Stdio;

use command_line::Outcome;
use command_line::output::{Output, note};
use command_line::program::{command, failed};
use messages::Service;
use scene::count;
use serde_json::Value;
use service::exit::{Exit, Failure};
use service::flight::{self, Changed, Decision, Difference, Report};
use service::group::{GroupError, GroupPaths};

use crate::args::ReplayArgs;

/// Longest event or value in text, characters.
const SHOWN_MAX: usize = 200;

/// Replays the flights, up to the first difference.
///
/// # Errors
/// A flight cannot be read, or its service's program cannot be run.
pub fn replay(
    paths: impl FnOnce() -> Result<GroupPaths, GroupError>,
    args: &ReplayArgs,
    out: &mut Output<'_>,
) -> Outcome {
    let folder = match &args.folder {
        Some(folder) => folder.clone(),
        None => paths()?.flights(),
    };
    let (mut replayed, mut is_damaged, mut services) = (0_u64, false, BTreeSet::new());
    for file in flight::list(&folder)? {
        let service = service_of(&file)?;
        services.insert(service.name());
        if args.service.as_deref().is_some_and(|wanted| wanted != service.name()) {
            continue;
        }
        replayed += 1;
        match run(service, &file, &args.what_if)? {
            Ok(report) => {
                show(&report, &args.what_if, out)?;
                is_damaged |= report.damaged_at.is_some();
                if report.difference.is_some() {
                    return Ok(Exit::Invariant);
                }
            }
            Err(exit) => return Ok(exit),
        }
    }
    if replayed == 0 {
        return Err(none_found(&folder, args.service.as_deref(), &services));
    }
    Ok(if is_damaged { Exit::Storage } else { Exit::Ok })
}

/// Returns the failure without a matching flight; `found` are the services that have one.
fn none_found(folder: &Path, wanted: Option<&str>, found: &BTreeSet<&str>) -> Failure {
    let of = wanted.map(|name| format!(" of {name}")).unwrap_or_default();
    let help = match found.is_empty() {
        true => "services record them where group.toml has flight.enabled = true".to_owned(),
        false => {
            let found: Vec<&str> = found.iter().copied().collect();
            format!("there are flights of {}", found.join(", "))
        }
    };
    Failure::new(Exit::NotReached, format!("no flights{of} in {}; help: {help}", folder.display()))
}

/// The service of a flight.
pub(super) fn service_of(file: &Path) -> Result<Service, Failure> {
    let name = flight::head(file)?.service;
    Service::from_name(&name).ok_or_else(|| {
        let what = format!("{}: a flight of {name:?}, whose program is not known", file.display());
        Failure::new(Exit::Config, what)
    })
}

/// Has a service's program replay a flight. It says itself on standard error why it cannot.
fn run(
    service: Service,
    file: &Path,
    changes: &[(String, String)],
) -> Result<Result<Report, Exit>, Failure> {
    let mut program = command(service.name(), "replay");
    program.arg(file).stderr(Stdio::inherit());
    for (key, value) in changes {
        program.arg("--what-if").arg(format!("{key}={value}"));
    }
    let output = program.output().map_err(|error| failed(&program, &error))?;
    let report = serde_json::from_slice::<Report>(&output.stdout).ok();
    Ok(report.ok_or(Exit::of_process(output.status.code())))
}

fn show(
    report: &Report,
    changes: &[(String, String)],
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let name = report.file.file_name().unwrap_or_default().display();
    if let Some(unread) = flight::unread(report.torn, report.damaged_at) {
        note(format_args!("{name}: {unread}"));
    }
    if out.is_json() {
        return out.json(report);
    }
    let (passes, events) = (count(report.passes, "pass"), count(report.events, "event"));
    let verdict = match &report.difference {
        _ if !changes.is_empty() => "open loop",
        None => "as recorded",
        Some(_) => "differs",
    };
    out.line(format_args!("{name}: {passes}, {events}, {:.1} s: {verdict}", report.seconds))?;
    if let Some(difference) = &report.difference {
        show_difference(report, difference, out)?;
    }
    report.decisions.iter().try_for_each(|changed| show_changed(changed, out))?;
    if !changes.is_empty() {
        let decisions = count(report.decisions.len() as u64, "decision");
        let others = count(report.other_passes, "other pass");
        let [verb, others_verb] = [report.decisions.len() as u64, report.other_passes]
            .map(|n| if n == 1 { "differs" } else { "differ" });
        out.line(format_args!("  {decisions} {verb}; {others} {others_verb}"))?;
    }
    if let Some(first) = &report.other_difference {
        out.line("  first other difference:")?;
        show_values(first, out)?;
    }
    Ok(())
}

/// Prints the place of a difference, and both values.
fn show_values(difference: &Difference, out: &mut Output<'_>) -> Result<(), Failure> {
    let Difference { pass, after_s, path, recorded, recomputed, .. } = difference;
    let unit = unit(path);
    out.line(format_args!("  pass {pass}, {after_s:.3} s after the start: {path}"))?;
    out.line(format_args!("    recorded    {}{unit}", shown(recorded)))?;
    out.line(format_args!("    recomputed  {}{unit}", shown(recomputed)))
}

/// The unit that the name of a field ends with, after a space.
fn unit(path: &str) -> &'static str {
    let name = path.rsplit('.').next().unwrap_or_default();
    let name = name.split('[').next().unwrap_or_default();
    match name.rsplit_once('_').map(|(_, end)| end) {
        Some("ns") => " ns",
        Some("ms") => " ms",
        Some("s") => " s",
        Some("m") => " m",
        Some("rad") => " rad",
        Some("db") => " dB",
        _ => "",
    }
}

fn show_difference(
    report: &Report,
    difference: &Difference,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    show_values(difference, out)?;
    if report.recorded_by != report.replayed_by {
        let Report { recorded_by, replayed_by, .. } = report;
        out.line(format_args!("    recorded by version {recorded_by}, replayed by {replayed_by}"))?;
    }
    out.line("  events up to there:")?;
    for event in &difference.before {
        let at_s = (event["at_ns"].as_u64().unwrap_or(0) as f64 - difference.at_ns as f64) / 1e9;
        let after_s = difference.after_s + at_s;
        out.line(format_args!("    {after_s:>9.3} s  {}", shown(&event["event"])))?;
    }
    Ok(())
}

fn show_changed(changed: &Changed, out: &mut Output<'_>) -> Result<(), Failure> {
    let Changed { pass, after_s, recorded, recomputed, .. } = changed;
    let interaction = recorded.as_ref().or(recomputed.as_ref()).map_or(0, |it| it.interaction);
    out.line(format_args!("  pass {pass}, {after_s:.3} s, interaction {interaction}"))?;
    out.line(format_args!("    recorded  {}", decision(recorded.as_ref())))?;
    out.line(format_args!("    what if   {}", decision(recomputed.as_ref())))
}

fn decision(decision: Option<&Decision>) -> String {
    match decision {
        None => "no decision".to_owned(),
        Some(Decision { what, value: None, .. }) => what.clone(),
        Some(Decision { what, value: Some(value), .. }) => format!("{what}  (value {value:.2})"),
    }
}

/// A value in a line.
fn shown(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(SHOWN_MAX) {
        None => text,
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replay_shows_the_unit_of_a_field() {
        for (path, expected) in [
            ("outputs[0].Act.decided_ns", " ns"),
            ("records[1].held.position_m[2]", " m"),
            ("outputs[0].Hearing.snr_db", " dB"),
            ("outputs[0].Act.prompt", ""),
            ("exit", ""),
            ("", ""),
        ] {
            assert_eq!(unit(path), expected, "{path}");
        }
    }
}
