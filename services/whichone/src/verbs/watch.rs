//! `watch`: live view of belief, dialogue, arm and services.

use std::io::{self, IsTerminal};
use std::thread;
use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::interrupt::Interrupt;
use command_line::output::Output;
use service::client::Polling;
use service::control::{Reply, Request, call};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use super::conversation::{Conversation, LOOK_EVERY};
use crate::cli::WatchArgs;

mod dashboard;
mod frame;
mod model;

use model::WatchModel;

/// Interval between redraws.
const FRAME_EVERY: Duration = Duration::from_millis(200);
/// Interval between status requests.
const STATUS_EVERY: Duration = Duration::from_secs(1);
/// Timeout of a status request; the latest status is shown meanwhile.
const STATUS_PATIENCE: Duration = Duration::from_millis(500);
/// Timeout of `--once` for the first messages of the services.
const FIRST_PATIENCE: Duration = Duration::from_secs(1);

/// Shows the group, once or until interrupted.
pub(super) fn watch(paths: &GroupPaths, args: &WatchArgs, out: &mut Output<'_>) -> Outcome {
    let mut model = WatchModel::new(Conversation::join(paths)?);
    ask_supervisor(&mut model);
    if args.once {
        gather(&mut model)?;
        draw_once(&model, out)?;
        return Ok(Exit::Ok);
    }
    let interrupt = Interrupt::listen()?;
    let screen = !out.is_json() && out.is_terminal();
    if screen && !args.plain && io::stdin().is_terminal() {
        return dashboard::run(&mut model, &interrupt, out.style());
    }
    if screen {
        out.text(frame::BEGIN)?;
    }
    let ended = follow(&mut model, &interrupt, screen, out);
    if screen {
        out.text(frame::END)?;
    }
    ended.map(|()| Exit::Ok)
}

fn follow(
    model: &mut WatchModel,
    interrupt: &Interrupt,
    screen: bool,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    let (mut drawn, mut asked) = (None::<Instant>, Instant::now());
    let mut prompt = model.latest().prompt();
    while !interrupt.is_requested() {
        model.look()?;
        if asked.elapsed() >= STATUS_EVERY {
            ask_supervisor(model);
            asked = Instant::now();
        }
        // Programs see each decision, however soon another one follows.
        let is_new = !screen && model.latest().prompt() != prompt;
        if is_new || drawn.is_none_or(|drawn| drawn.elapsed() >= FRAME_EVERY) {
            prompt = model.latest().prompt();
            if screen {
                out.text(&frame::redraw(
                    &frame::lines(model, out.style(), columns()),
                    out.style(),
                ))?;
            } else {
                draw_once(model, out)?;
            }
            drawn = Some(Instant::now());
        }
        thread::sleep(LOOK_EVERY * 2);
    }
    Ok(())
}

fn draw_once(model: &WatchModel, out: &mut Output<'_>) -> Result<(), Failure> {
    if out.is_json() {
        return out.json(&model.view());
    }
    let lines = frame::lines(model, out.style(), columns());
    lines.into_iter().try_for_each(|line| out.line(line))
}

/// Waits until every service has published something, up to [`FIRST_PATIENCE`].
fn gather(model: &mut WatchModel) -> Result<(), Failure> {
    let (until, mut polling) = (Instant::now() + FIRST_PATIENCE, Polling::default());
    model.look()?;
    while Instant::now() < until && !model.is_complete() {
        polling.pause();
        model.look()?;
    }
    Ok(())
}

fn ask_supervisor(model: &mut WatchModel) {
    let socket = model.paths().control_socket();
    if let Ok(Reply::Status(status)) = call(&socket, &Request::Status, STATUS_PATIENCE) {
        model.status = Some(*status);
    }
}

/// Returns the width of the terminal, characters; 80 where it is not known.
fn columns() -> usize {
    let given = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    given.filter(|columns| (20..=400).contains(columns)).unwrap_or(80)
}
