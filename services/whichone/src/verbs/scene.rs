//! `scene`: writing, showing, checking and completing scene files.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use config::Settings;
use diagnostics::{Diagnostics, TextFile};
use serde_json::json;
use service::exit::{Exit, Failure};

use super::{check, paths, planning};
use crate::Outcome;
use crate::cli::{ConfigArgs, SceneCheckArgs, SceneNewArgs, SceneVerb};
use crate::output::Output;
use crate::scene_file;

mod diff;
mod edit;
mod place;
mod show;

use edit::SceneEdit;

/// The scene that `scene new` writes; `@NAME@` and `@SCHEMA@` are filled in, and places are added.
const TEMPLATE: &str = include_str!("scene/template.toml");

/// Executes an action.
pub(super) fn scene(what: SceneVerb, out: &mut Output<'_>) -> Outcome {
    match what {
        SceneVerb::New(args) => new(&args, out),
        SceneVerb::Show(args) => show::show(&args, out),
        SceneVerb::Check(args) => check_scene(&args, out),
        SceneVerb::Place(args) => place::place(&args, out),
    }
}

fn check_scene(args: &SceneCheckArgs, out: &mut Output<'_>) -> Outcome {
    let (path, file) = read(&args.file, &args.config)?;
    check::verdict(load(&args.config, file)?, &path, false, out)
}

fn new(args: &SceneNewArgs, out: &mut Output<'_>) -> Outcome {
    let path = if planning::is_word(&args.file) {
        let scenes = paths::config_folder(&args.config)?.join("scenes");
        scenes.join(&args.file).with_extension("toml")
    } else {
        args.file.clone()
    };
    if path.extension().is_none_or(|ending| ending != "toml") {
        let what = format!("{}: expected a file that ends with .toml", path.display());
        return Err(Failure::new(Exit::Usage, what));
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let text = TEMPLATE
        .replace("@NAME@", &toml_edit::Value::from(&*name).to_string())
        .replace("@SCHEMA@", &schema_line(&path, &args.config)?);
    let label = path.display().to_string();
    let mut edit = SceneEdit::parse(&label, &text)?;
    let placed = place::places(&mut edit, &label, &args.config)?;
    load(&args.config, TextFile::new(&*label, edit.text()))??;
    let file = fs::File::create_new(&path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            let what = format!("{label}: there is a file already; help: choose another name");
            Failure::new(Exit::Usage, what)
        }
        _ => Failure::file(&path, &error),
    })?;
    std::io::Write::write_all(&mut &file, edit.text().as_bytes())
        .map_err(|error| Failure::file(&path, &error))?;
    if out.is_json() {
        out.json(&json!({ "file": path, "objects": placed.len() }))?;
    } else {
        out.line(format_args!("{label}: {}", scene::count(placed.len(), "object")))?;
        out.line("  edit it, then: whichone scene place FILE --write; whichone scene check FILE")?;
    }
    Ok(Exit::Ok)
}

/// The line by which editors find the schema of a file, if the configuration has it.
fn schema_line(path: &Path, config: &ConfigArgs) -> Result<String, Failure> {
    const FILE: &str = "schemas/scene.json";
    let folder = path.parent().unwrap_or(Path::new(""));
    if folder.join("..").join(FILE).is_file() {
        return Ok(format!("#:schema ../{FILE}\n"));
    }
    let schema = paths::config_folder(config)?.join(FILE);
    let line = || format!("#:schema file://{}\n", schema.display());
    Ok(if schema.is_file() { line() } else { String::new() })
}

/// Reads the scene that is named, with its path.
fn read(named: &Path, config: &ConfigArgs) -> Result<(PathBuf, TextFile), Failure> {
    let path = planning::scene_path(named, config)?;
    let text = scene_file::read_file(&path)?;
    if scene_file::is_json(&text) {
        let what = format!("{}: expected a scene in TOML, found JSON", path.display());
        return Err(Failure::new(Exit::Config, what));
    }
    let file = TextFile::new(path.display().to_string(), text);
    Ok((path, file))
}

/// Loads the configuration with another scene, with all checks.
fn load(args: &ConfigArgs, scene: TextFile) -> Result<Result<Settings, Diagnostics>, Failure> {
    let folder = paths::config_folder(args)?;
    let profile = args.profile.as_deref();
    Ok(preflight::load_with_scene(&folder, profile, &args.set, Some(scene)))
}

/// Reads the configuration with another scene, without checks of the arm's reach.
fn examine(args: &ConfigArgs, scene: Option<TextFile>) -> Result<Settings, Failure> {
    let folder = paths::config_folder(args)?;
    let profile = args.profile.as_deref();
    let examined = Settings::examine(&folder, profile, &args.set, scene);
    Ok(examined.report.verdict(examined.settings)?)
}
