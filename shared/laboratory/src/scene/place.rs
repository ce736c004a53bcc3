//! `scene place`: places for objects that have none or that cannot be fetched.

use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::args::ConfigArgs;
use command_line::output::{Output, note};
use diagnostics::TextFile;
use preflight::{ArmSetup, Arrangement};
use scene_editing::SceneEdit;
use serde::Serialize;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};

use super::arrange::{arrange, why_unplaced};
use super::{diff, examine, load, read};
use crate::args::ScenePlaceArgs;
use crate::check;
use crate::progress::Progress;

/// Longest search for all places: where robot and scene do not fit, each look takes long.
const PATIENCE: Duration = Duration::from_secs(60);

/// An object with a new place.
pub(super) struct Placed {
    object: String,
    /// Its place before, metres; none if it had none.
    from: Option<[f64; 3]>,
    to: [f64; 3],
}

/// An object for which there is no place.
#[derive(Serialize)]
pub(super) struct Unplaced {
    object: String,
    why: String,
}

/// What has come of a search for places.
pub(super) struct Places {
    pub(super) placed: Vec<Placed>,
    unplaced: Vec<Unplaced>,
}

/// Proposes places or writes them.
pub(super) fn place(args: &ScenePlaceArgs, out: &mut Output<'_>) -> Outcome {
    let (path, file) = read(&args.file, &args.config)?;
    let mut edit = SceneEdit::parse(&file.label, &file.text)?;
    let progress = Progress::start(out);
    let Places { placed, unplaced } = places(&mut edit, &file.label, &args.config, &progress)?;
    let text = edit.text();
    let checked = load(&args.config, TextFile::new(&*file.label, &*text), &progress)?.verdict();
    drop(progress);
    if args.write && !placed.is_empty() {
        safe_files::write_output(&path, text.as_bytes())
            .map_err(|error| Failure::file(&path, &error))?;
    }
    if out.is_json() {
        let moved: Vec<Json> = (placed.iter())
            .map(|it| json!({ "object": it.object, "from": it.from, "to": it.to }))
            .collect();
        let problems = checked.as_ref().err().map(check::problems);
        out.json(&json!({
            "ok": checked.is_ok(), "file": path, "written": args.write && !placed.is_empty(),
            "moved": moved, "unplaced": unplaced, "problems": problems.unwrap_or_default(),
        }))?;
    } else {
        if !args.write && !placed.is_empty() {
            let lines = diff::unified(&file.label, &file.text, &text);
            lines.into_iter().try_for_each(|line| out.line(line))?;
        }
        note(summary(&placed, args.write));
        for Unplaced { object, why } in &unplaced {
            note(format_args!("`{object}` {why}"));
        }
    }
    match checked {
        Ok(_) => Ok(Exit::Ok),
        Err(_) if out.is_json() => Ok(Exit::Config),
        Err(refused) => Err(refused.into()),
    }
}

fn summary(placed: &[Placed], is_written: bool) -> String {
    let new = placed.iter().filter(|it| it.from.is_none()).count();
    let (new, moved) = (scene::count(new, "object"), placed.len() - new);
    match (placed.is_empty(), is_written) {
        (true, _) => "no object needs another place".to_owned(),
        (_, true) => format!("{new} placed, {moved} moved"),
        (_, false) => {
            format!("{new} to be placed, {moved} to be moved; help: --write edits the file")
        }
    }
}

/// Finds places for the objects of a scene file that need them, and sets them in `edit`. Objects for
/// which there is none keep theirs, or have none.
pub(super) fn places(
    edit: &mut SceneEdit,
    label: &str,
    config: &ConfigArgs,
    progress: &Progress,
) -> Result<Places, Failure> {
    let mut with_all = SceneEdit::parse(label, &edit.text())?;
    let added = with_all.add_places();
    let settings = examine(config, Some(TextFile::new(label, with_all.text())))?;
    let setup = ArmSetup::new(&settings)?;
    let objects = settings.scene.objects();
    let (numbers, poses): (Vec<usize>, Vec<_>) = objects
        .iter()
        .enumerate()
        .filter_map(|(n, object)| Some((n, preflight::pose(&object.placement?))))
        .unzip();
    let new: Vec<usize> = (0..numbers.len()).filter(|&i| added.contains(&numbers[i])).collect();
    let mut arrangement = Arrangement::new(&setup, poses.clone()).until(Instant::now() + PATIENCE);
    let changed = arrange(&mut arrangement, &new, &|line| progress.at(line));
    let unplaced = new.iter().filter(|i| !changed.contains(i)).map(|&i| {
        let object = objects[numbers[i]].name.clone();
        Unplaced { object, why: why_unplaced(&arrangement, i) }
    });
    let unplaced = unplaced.collect();
    let placed = changed.iter().map(|&i| {
        let n = numbers[i];
        let (to, from) = (arrangement.poses()[i].xyz_m, poses[i].xyz_m);
        edit.set_place(n, to);
        let from = (!added.contains(&n)).then_some(from);
        Placed { object: objects[n].name.clone(), from, to }
    });
    let placed = placed.collect();
    Ok(Places { placed, unplaced })
}
