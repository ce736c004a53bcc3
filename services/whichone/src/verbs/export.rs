//! `export`: a decision problem for other programs.

use std::path::Path;

use serde_json::json;
use service::exit::Exit;

use super::planning;
use crate::cli::{ExportArgs, Exported};
use crate::error::{CliError, Outcome};
use crate::output::Output;

/// Prints the problem, or writes it to the file that is named.
pub(super) fn export(args: &ExportArgs, out: &mut Output<'_>) -> Outcome {
    let Exported::Pomdp = args.what;
    let found = planning::of_scene(&args.scene, &args.problem)?;
    let exported = pomdp::of_dialogue(&found.scene, &found.decision()).map_err(|error| {
        CliError::new(Exit::Config, format!("{}: {error}", args.scene.display()))
    })?;
    let text = exported.write(&comment(found.scene.name()));
    let sizes = [&exported.states, &exported.actions, &exported.observations].map(Vec::len);
    let [states, actions, observations] = sizes;
    let mut told = json!({ "states": states, "actions": actions, "observations": observations });
    match &args.output {
        Some(path) => {
            write(path, &text)?;
            if out.is_json() {
                told["file"] = json!(path);
                out.json(&told)?;
            } else {
                let sizes = format!("{states} states, {actions} actions, {observations}");
                out.line(format_args!("{}: {sizes} observations", path.display()))?;
            }
        }
        None if out.is_json() => {
            told["pomdp"] = json!(text);
            out.json(&told)?;
        }
        None => out.text(&text)?,
    }
    Ok(Exit::Ok)
}

fn write(path: &Path, text: &str) -> Result<(), CliError> {
    std::fs::write(path, text).map_err(|error| CliError::file(path, &error))
}

fn comment(scene: &str) -> String {
    format!(
        "Which object of the scene {scene} is wanted? Written by whichone export pomdp.\n\
         \n\
         States: wanted__OBJECT, and end, where a pick leads.\n\
         Actions: wait, is__ATTRIBUTE__VALUE, which__ATTRIBUTE, point__OBJECT, pick__OBJECT.\n\
         Observations: silence, yes, no, says__ATTRIBUTE__VALUE.\n\
         In a name, _ and two hexadecimal digits stand for a byte that is no letter, digit or -."
    )
}
