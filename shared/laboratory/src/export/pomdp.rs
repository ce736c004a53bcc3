//! `export pomdp`: a decision problem for other programs.

use std::path::Path;

use command_line::Outcome;
use command_line::output::Output;
use evaluation::export::{self, Pomdp};
use serde_json::json;
use service::exit::{Exit, Failure};

use crate::args::PomdpArgs;
use crate::planning;

/// Prints the problem or writes it to the given file.
pub(super) fn export(args: &PomdpArgs, out: &mut Output<'_>) -> Outcome {
    let found = planning::of_scene(&args.scene, &args.problem, args.problem.config.is_given())?;
    let comment = comment(found.scene.name());
    let exported = export::pomdp(&found.scene, &found.decision(), &comment).map_err(|error| {
        Failure::new(Exit::Config, format!("{}: {error}", args.scene.display()))
    })?;
    let Pomdp { text, states, actions, observations } = exported;
    let mut written = json!({ "states": states, "actions": actions, "observations": observations });
    match &args.output {
        Some(path) => {
            write(path, &text)?;
            if out.is_json() {
                written["file"] = json!(path);
                out.json(&written)?;
            } else {
                let sizes = format!("{states} states, {actions} actions, {observations}");
                out.line(format_args!("{}: {sizes} observations", path.display()))?;
            }
        }
        None if out.is_json() => {
            written["pomdp"] = json!(text);
            out.json(&written)?;
        }
        None => out.text(&text)?,
    }
    Ok(Exit::Ok)
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    safe_files::write_output(path, text.as_bytes()).map_err(|error| Failure::file(path, &error))
}

fn comment(scene: &str) -> String {
    format!(
        "Which object of the scene {scene} is wanted? Written by whichone export pomdp.\n\
         \n\
         States: wanted__OBJECT, and end, where a pick leads.\n\
         Actions: wait, is__ATTRIBUTE__VALUE, which__ATTRIBUTE, point__OBJECT, pick__OBJECT.\n\
         Observations: silence, yes, no, says__ATTRIBUTE__VALUE.\n\
         In a name, _ and two hexadecimal digits stand for a byte that is not a letter, digit or -."
    )
}
