//! `study report`: results of a study with people.

use std::path::{Path, PathBuf};

use command_line::Outcome;
use command_line::configuration;
use command_line::output::{Output, note, table};
use config::Settings;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use user_study::{Group, Paired, Participant, Report};
use user_study::{Interval, Mean};

use super::Files;
use crate::args::ReportArgs;

/// Reads the data and prints the results.
pub(crate) fn report(paths: &GroupPaths, args: &ReportArgs, out: &mut Output<'_>) -> Outcome {
    let folder = folder(paths, args)?;
    let people = read(&folder)?;
    let report = user_study::report(&people);
    if let Some(folder) = &args.out {
        export(folder, &people, &report)?;
        note(format_args!("written to {}", folder.display()));
    }
    if out.is_json() {
        out.json(&report.to_json())?;
    } else {
        lines(&report).into_iter().try_for_each(|line| out.line(line))?;
    }
    Ok(Exit::Ok)
}

fn folder(paths: &GroupPaths, args: &ReportArgs) -> Result<PathBuf, Failure> {
    if let Some(folder) = &args.folder {
        return Ok(folder.clone());
    }
    // Those of a running group, else those that the command line names.
    let is_running = paths.run().join(config::SNAPSHOT_FILE).is_file();
    let settings = match is_running && !args.config.is_given() {
        true => Settings::load_snapshot(&paths.run())?,
        false => configuration::settings(&args.config)?,
    };
    let study = settings.part::<user_study::Study>()?;
    Ok(study.data_dir.unwrap_or_else(|| paths.study()))
}

fn read(folder: &Path) -> Result<Vec<Participant>, Failure> {
    let files = safe_files::read_folder(folder, user_study::FILE_ENDING)
        .map_err(|(path, error)| Failure::file(&path, &error))?;
    let people = user_study::people(files).map_err(|(path, error)| {
        Failure::new(Exit::Storage, format!("{}: {error}", path.display()))
    })?;
    if people.is_empty() {
        let what = format!("{} holds no data of a study", folder.display());
        let help = "name the folder, or conduct one: set study.enabled, and open /study";
        return Err(Failure::new(Exit::NotReached, format!("{what}; help: {help}")));
    }
    Ok(people)
}

fn export(folder: &Path, people: &[Participant], report: &Report) -> Result<(), Failure> {
    let files = Files::open(folder)?;
    let tables = user_study::tables(people);
    files.write("interactions.csv", tables.interactions.as_bytes())?;
    files.write("participants.csv", tables.participants.as_bytes())?;
    files.write("dictionary.csv", tables.dictionary.as_bytes())?;
    files.write("study.json", format!("{:#}\n", user_study::to_json(people)).as_bytes())?;
    files.write("report.json", format!("{:#}\n", report.to_json()).as_bytes())?;
    for (name, chart) in user_study::pictures(report) {
        let svg = user_study::charts::svg(&chart)
            .map_err(|error| Failure::new(Exit::Storage, format!("{name}: {error}")))?;
        files.write(&format!("{name}.svg"), svg.as_bytes())?;
    }
    Ok(())
}

fn lines(report: &Report) -> Vec<String> {
    let people = report.participants.iter().filter(|(_, count)| *count > 0);
    let people: Vec<String> = people.map(|(name, count)| format!("{count} {name}")).collect();
    let mut lines = vec![
        report.title.clone(),
        format!("participants: {}", people.join(", ")),
        format!("interactions that count: {}", report.all.interactions()),
    ];
    if report.faults > 0 {
        let faults = scene::count(report.faults, "interaction");
        lines.push(format!("{faults} spoilt and repeated"));
    }
    if report.scenes.len() > 1 {
        let scenes: Vec<String> =
            report.scenes.iter().map(|(name, key)| format!("{name} ({key})")).collect();
        lines.push(format!("the scene was changed meanwhile: {}", scenes.join(", ")));
    }
    lines.push(String::new());
    lines.extend(policies(report));
    if !report.paired.is_empty() {
        lines.push(String::new());
        lines.extend(paired(&report.paired));
    }
    if report.questionnaire.iter().any(|answers| answers.mean.count() > 0) {
        lines.push(String::new());
        lines.extend(questionnaire(report));
    }
    lines
}

fn policies(report: &Report) -> Vec<String> {
    let heads = [
        "POLICY",
        "PEOPLE",
        "INTERACTIONS",
        "SUCCESS %",
        "95 %",
        "SECONDS",
        "95 %",
        "QUESTIONS",
        "95 %",
    ];
    let row = |group: &Group| {
        vec![
            group.policy.clone(),
            group.participants.to_string(),
            group.interactions().to_string(),
            format!("{:.1}", 100.0 * group.success()),
            interval(Some(group.success_interval()), 100.0, 1),
            number(&group.seconds, 1),
            interval(group.seconds.student_interval(), 1.0, 1),
            number(&group.questions, 2),
            interval(group.questions.student_interval(), 1.0, 2),
        ]
    };
    let mut rows: Vec<_> = report.policies.iter().map(row).collect();
    if rows.len() > 1 {
        rows.push(row(&report.all));
    }
    table(&heads, &rows)
}

fn paired(all: &[Paired]) -> Vec<String> {
    let heads =
        ["DIFFERENCE", "PEOPLE", "SUCCESS %", "95 %", "SECONDS", "95 %", "QUESTIONS", "95 %"];
    let row = |paired: &Paired| {
        vec![
            format!("{} less {}", paired.policy, paired.with),
            paired.success.count().to_string(),
            format!("{:+.1}", 100.0 * paired.success.mean()),
            interval(paired.success.student_interval(), 100.0, 1),
            format!("{:+.1}", paired.seconds.mean()),
            interval(paired.seconds.student_interval(), 1.0, 1),
            format!("{:+.2}", paired.questions.mean()),
            interval(paired.questions.student_interval(), 1.0, 2),
        ]
    };
    table(&heads, &all.iter().map(row).collect::<Vec<_>>())
}

fn questionnaire(report: &Report) -> Vec<String> {
    let asked = report.questionnaire.iter().filter(|answers| answers.mean.count() > 0);
    let rows = asked.map(|answers| {
        vec![
            answers.item.text.clone(),
            answers.answered.to_string(),
            number(&answers.mean, 2),
            interval(answers.mean.student_interval(), 1.0, 2),
        ]
    });
    table(&["QUESTION", "ANSWERS", "MEAN", "95 %"], &rows.collect::<Vec<_>>())
}

fn number(mean: &Mean, digits: usize) -> String {
    if mean.count() == 0 { "-".to_owned() } else { format!("{:.digits$}", mean.mean()) }
}

fn interval(interval: Option<Interval>, unit: f64, digits: usize) -> String {
    interval.map_or_else(
        || "-".to_owned(),
        |found| format!("{:.digits$} … {:.digits$}", unit * found.low, unit * found.high),
    )
}
