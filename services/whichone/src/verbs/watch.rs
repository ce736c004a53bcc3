//! `watch`: the robot's belief, the dialogue, the arm and the services, live.

use std::thread;
use std::time::{Duration, Instant};

use service::control::{Reply, Request, call};
use service::exit::Exit;
use service::group::GroupPaths;

use super::conversation::{Conversation, LOOK_EVERY};
use super::interrupt::Interrupt;
use crate::cli::WatchArgs;
use crate::error::{CliError, Outcome};
use crate::output::Output;

use picture::Picture;

mod frame;
mod picture;

/// How often a picture is drawn.
const FRAME_EVERY: Duration = Duration::from_millis(200);
/// How often the supervisor is asked.
const STATUS_EVERY: Duration = Duration::from_secs(1);
/// How long the supervisor may take; the last answer stands until there is another.
const STATUS_PATIENCE: Duration = Duration::from_millis(500);
/// How long one picture may wait for the services' first messages.
const FIRST_PATIENCE: Duration = Duration::from_secs(1);

/// Shows a picture of the group, again and again until interrupted.
pub(super) fn watch(paths: &GroupPaths, args: &WatchArgs, out: &mut Output<'_>) -> Outcome {
    let mut picture = Picture::new(Conversation::join(paths)?);
    look_up(&mut picture);
    if args.once {
        gather(&mut picture)?;
        draw_once(&picture, out)?;
        return Ok(Exit::Ok);
    }
    let interrupt = Interrupt::listen()?;
    let screen = !out.is_json() && out.is_terminal();
    if screen {
        out.text(frame::BEGIN)?;
    }
    let ended = follow(&mut picture, &interrupt, screen, out);
    if screen {
        out.text(frame::END)?;
    }
    ended.map(|()| Exit::Ok)
}

fn follow(
    picture: &mut Picture,
    interrupt: &Interrupt,
    screen: bool,
    out: &mut Output<'_>,
) -> Result<(), CliError> {
    let (mut drawn, mut asked) = (None::<Instant>, Instant::now());
    while !interrupt.is_told() {
        picture.look()?;
        if asked.elapsed() >= STATUS_EVERY {
            look_up(picture);
            asked = Instant::now();
        }
        if drawn.is_none_or(|drawn| drawn.elapsed() >= FRAME_EVERY) {
            if screen {
                out.text(&frame::redraw(&frame::lines(picture, out.style(), columns())))?;
            } else {
                draw_once(picture, out)?;
            }
            drawn = Some(Instant::now());
        }
        thread::sleep(LOOK_EVERY * 2);
    }
    Ok(())
}

fn draw_once(picture: &Picture, out: &mut Output<'_>) -> Result<(), CliError> {
    if out.is_json() {
        return out.json(&picture.to_json());
    }
    let lines = frame::lines(picture, out.style(), columns());
    lines.into_iter().try_for_each(|line| out.line(line))
}

/// Looks until every service has been heard of, but not for ever.
fn gather(picture: &mut Picture) -> Result<(), CliError> {
    let until = Instant::now() + FIRST_PATIENCE;
    while Instant::now() < until && !picture.is_complete() {
        picture.look()?;
        thread::sleep(LOOK_EVERY);
    }
    Ok(())
}

fn look_up(picture: &mut Picture) {
    let socket = picture.paths().control_socket();
    if let Ok(Reply::Status(status)) = call(&socket, &Request::Status, STATUS_PATIENCE) {
        picture.status = Some(*status);
    }
}

/// Width of the terminal, characters; what most have where it does not say.
fn columns() -> usize {
    let told = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    told.filter(|columns| (20..=400).contains(columns)).unwrap_or(80)
}
