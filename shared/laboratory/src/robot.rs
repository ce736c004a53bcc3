//! `robot import`: a published description becomes a robot, a scene and a profile.

use std::path::{Path, PathBuf};

use command_line::Outcome;
use command_line::args::ConfigArgs;
use command_line::output::Output;
use command_line::shipped;
use diagnostics::Diagnostics;
use robot_import::{Findings, Gripper, Imported, Kind, Options};
use safe_files::OutputFolder;
use serde_json::json;
use service::exit::{Exit, Failure};

use crate::args::ImportArgs;
use crate::scene::own_folder;

/// Imports a description.
pub(super) fn import(args: &ImportArgs, out: &mut Output<'_>) -> Outcome {
    let options = options(args)?;
    let folder = folder(args)?;
    let files = Files::new(&options.name, &folder);
    files.refuse_existing(args.replace)?;
    let imported = match robot_import::import(&args.file, &options) {
        Ok(imported) => imported,
        Err(refused) => {
            if !out.is_json() {
                print(&refused.findings, out)?;
            }
            return Err(refused.faults.into());
        }
    };
    if !folder.join("group.toml").exists() {
        shipped::write_into(&folder)?;
    }
    files.write(&imported)?;
    let examined = preflight::examine(&folder, Some(&options.name), &[], None, &|_| {});
    report(&files, &imported, &options.name, &folder, examined.verdict().err(), out)
}

/// Prints the files written, and their problems.
fn report(
    files: &Files,
    imported: &Imported,
    name: &str,
    folder: &Path,
    problems: Option<Diagnostics>,
    out: &mut Output<'_>,
) -> Outcome {
    if out.is_json() {
        let paths: Vec<PathBuf> = files.0.iter().map(|(path, _)| path.clone()).collect();
        let problems: Vec<String> =
            problems.iter().flat_map(|all| all.iter()).map(ToString::to_string).collect();
        out.json(&json!({
            "robot": name, "profile": name, "files": paths, "findings": imported.findings.findings,
            "fits": imported.findings.fits, "pairs": imported.findings.pairs, "problems": problems,
        }))?;
        return Ok(if problems.is_empty() { Exit::Ok } else { Exit::Config });
    }
    print(&imported.findings, out)?;
    for (path, _) in &files.0 {
        out.line(format_args!("written: {}", path.display()))?;
    }
    if let Some(problems) = problems {
        return Err(problems.into());
    }
    out.line(format_args!(
        "checked: it is right; start it: whichone up --config {} --profile {}",
        folder.display(),
        name
    ))?;
    Ok(Exit::Ok)
}

fn options(args: &ImportArgs) -> Result<Options, Failure> {
    let stem = args.file.file_stem().unwrap_or_default().to_string_lossy();
    let stem = stem.trim_end_matches(".urdf").to_lowercase();
    let name = args.name.clone().unwrap_or(stem);
    let is_plain = |letter: char| {
        letter.is_ascii_lowercase() || letter.is_ascii_digit() || "_-".contains(letter)
    };
    if name.is_empty() || !name.chars().all(is_plain) {
        let help = "name it with --name NAME";
        let what = format!(
            "expected a name of small letters, digits, _ and -, found {name:?}; help: {help}"
        );
        return Err(Failure::new(Exit::Usage, what));
    }
    let gripper = match args.gripper.as_deref() {
        None => Gripper::Found,
        Some("none") => Gripper::None,
        Some(link) => Gripper::Link(link.to_owned()),
    };
    let (base, tip, srdf) = (args.base.clone(), args.tip.clone(), args.srdf.clone());
    Ok(Options { name, base, tip, gripper, open_m: args.opening_mm.map(|mm| mm / 1e3), srdf })
}

/// Returns the folder of the configuration.
fn folder(args: &ImportArgs) -> Result<PathBuf, Failure> {
    own_folder(&ConfigArgs { config: args.config.clone(), ..ConfigArgs::default() })
}

/// Text of a file.
type Text = fn(&Imported) -> &str;

/// The files that are written, and which text each holds.
struct Files([(PathBuf, Text); 4]);

impl Files {
    fn new(name: &str, folder: &Path) -> Self {
        let file = |part: &str, name: String| folder.join(part).join(name);
        Self([
            (file("robots", format!("{name}.urdf")), |it| &it.urdf),
            (file("robots", format!("{name}.srdf")), |it| &it.srdf),
            (file("scenes", format!("{name}-blocks.toml")), |it| &it.scene),
            (file("profiles", format!("{name}.toml")), |it| &it.profile),
        ])
    }

    fn refuse_existing(&self, replace: bool) -> Result<(), Failure> {
        let there = self.0.iter().find(|(path, _)| !replace && path.exists());
        let Some((path, _)) = there else { return Ok(()) };
        let what = format!(
            "{}: there is a file already; help: --name another, or --replace",
            path.display()
        );
        Err(Failure::new(Exit::Usage, what))
    }

    fn write(&self, imported: &Imported) -> Result<(), Failure> {
        for (path, text) in &self.0 {
            let (Some(parent), Some(name)) = (path.parent(), path.file_name()) else { continue };
            OutputFolder::open(parent)
                .and_then(|folder| folder.write(name, text(imported).as_bytes()))
                .map_err(|error| Failure::file(path, &error))?;
        }
        Ok(())
    }
}

/// Prints the findings, choices and assumptions.
fn print(findings: &Findings, out: &mut Output<'_>) -> Result<(), Failure> {
    for (kind, word) in
        [(Kind::Chosen, "chosen"), (Kind::Assumed, "assumed"), (Kind::Ignored, "ignored")]
    {
        for text in findings.of(kind) {
            out.line(format_args!("{word}: {text}"))?;
        }
    }
    for fit in &findings.fits {
        let guess = if fit.is_guessed { ", guessed" } else { "" };
        out.line(format_args!(
            "shape: {}: {} of them, stand out {} mm, left out {} mm{guess}",
            fit.link, fit.shapes, fit.stands_out_mm, fit.left_out_mm
        ))?;
    }
    let pairs = &findings.pairs;
    if pairs.all > 0 {
        out.line(format_args!(
            "pairs: of {} with a link of the arm, in {} postures: {} adjacent, {} in contact at zero, {} always, {} never are not \
             checked; {} that come nearer than 20 mm are",
            pairs.all, pairs.postures, pairs.adjacent, pairs.default, pairs.always, pairs.never, pairs.near
        ))?;
        for (a, b) in &pairs.fat {
            out.line(format_args!(
                "pairs: {a} and {b} are not checked: their shapes overlap where they do not"
            ))?;
        }
    }
    if let Some((precision, recall)) = pairs.precision.zip(pairs.recall) {
        out.line(format_args!(
            "pairs: the published SRDF has {:.0} % of these, and {:.0} % of its own are found",
            precision * 1e2,
            recall * 1e2
        ))?;
    }
    for text in findings.of(Kind::Missing) {
        out.line(format_args!("missing: {text}"))?;
    }
    Ok(())
}
