//! `watch` as lines of text.

use ::dialogue::rendering;
use command_line::output::{Ink, Style};
use messages::{ArmStatus, PickOutcome, PickPhase, PolicyView, Task};
use scene::Scene;
use service::status::{GroupStatus, ServiceStatus};
use service::view::{SaidView, Speaker};

use super::model::{WatchModel, object_name};
use crate::verbs::status::{group_state, state_ink};
use crate::verbs::{await_pick, hearing, words};

/// Starts drawing on an alternate screen without a cursor.
pub(super) const BEGIN: &str = "\x1b[?1049h\x1b[?25l";
/// Ends drawing and restores the previous screen.
pub(super) const END: &str = "\x1b[?25h\x1b[?1049l";

/// Maximum number of objects shown, the most probable ones.
const OBJECTS_MAX: usize = 12;
/// Longest bar, characters.
const BAR_MAX: usize = 40;

/// Draws `lines` over the current screen.
pub(super) fn redraw(lines: &[String], style: Style) -> String {
    let lines: String =
        lines.iter().map(|line| format!("{}\x1b[K\r\n", style.clean(line))).collect();
    format!("\x1b[H{lines}\x1b[J")
}

/// Returns the lines of one frame, none wider than `columns`.
pub(super) fn lines(model: &WatchModel, style: Style, columns: usize) -> Vec<String> {
    let scene = model.scene();
    let latest = model.latest();
    let mut lines = head(scene, model.status.as_ref(), style);
    lines.push(String::new());
    match &latest.view {
        Some(view) => lines.extend(dialogue(scene, view, style, columns)),
        None => lines.push(style.paint(Ink::Yellow, "the policy is silent").to_string()),
    }
    lines.push(String::new());
    lines.extend(said(model, style, columns));
    lines.push(String::new());
    lines.extend(latest.hearing.as_ref().map(|hearing| hearing::line(hearing, style)));
    lines.push(match &latest.arm {
        Some(arm) => arm_line(scene, arm, style),
        None => style.paint(Ink::Yellow, "the arm is silent").to_string(),
    });
    lines
}

fn head(scene: &Scene, status: Option<&GroupStatus>, style: Style) -> Vec<String> {
    let Some(status) = status else {
        return vec![style.paint(Ink::Yellow, "the supervisor does not answer").to_string()];
    };
    let (ink, state) = group_state(status.state);
    let state = style.paint(ink, state);
    let name = style.paint(Ink::Bold, &status.name);
    let services: Vec<String> = status.services.iter().map(|s| service(s, style)).collect();
    vec![
        format!("{name} {state}, scene {}, up {}", scene.name(), words::time(status.uptime_s)),
        services.join("  "),
    ]
}

fn service(service: &ServiceStatus, style: Style) -> String {
    let starts = match service.restarts {
        0 => String::new(),
        restarts => format!(" (restarted {restarts})"),
    };
    let state = style.paint(state_ink(service.state), service.state.word());
    format!("{} {state}{starts}", service.name)
}

fn dialogue(scene: &Scene, view: &PolicyView, style: Style, columns: usize) -> Vec<String> {
    let mut lines = vec![summary(view)];
    lines.extend(belief(scene, &view.belief, style, columns));
    lines.extend(reasons(scene, view, style, columns));
    lines
}

/// The open interaction in a few words.
pub(super) fn summary(view: &PolicyView) -> String {
    match view.interaction {
        0 => "nothing is asked for".to_owned(),
        id => {
            let asked = scene::count(view.questions, "question");
            format!("interaction {id}: {asked} asked, {:.1} to come", view.expected_questions)
        }
    }
}

/// What stands behind the decision, and how the last interaction ended.
pub(super) fn reasons(
    scene: &Scene,
    view: &PolicyView,
    style: Style,
    columns: usize,
) -> Vec<String> {
    let mut lines = Vec::new();
    if view.absent > 0.0 {
        lines.push(format!("  not here {:.1} %", view.absent * 100.0));
    }
    if let Some((p_l, epsilon)) = view.person {
        let (answers, errs) = (p_l * 100.0, epsilon * 100.0);
        lines.push(format!("the person answers {answers:.0} % and errs in {errs:.1} %"));
    }
    if view.interaction != 0 {
        let decision = style.paint(Ink::Bold, view.decision.name());
        let value = words::value(view.value, view.bounds);
        lines.push(format!("decision: {decision} ({value})"));
        let others = view.alternatives.iter().take(3);
        let others: Vec<String> = others
            .map(|(a, value)| format!("{} {value:.1}", rendering::action(scene, *a)))
            .collect();
        if !others.is_empty() {
            let text = cut(&format!("  alternatives: {}", others.join(" · ")), columns);
            lines.push(style.paint(Ink::Dim, text).to_string());
        }
    }
    if let Some(last) = &view.last {
        let text = await_pick::sentence(last);
        let text = cut(&format!("interaction {}: {text}", last.interaction), columns);
        lines.push(style.paint(Ink::Dim, text).to_string());
    }
    lines
}

/// A belief as bars.
pub(super) struct Bars {
    /// One for each object that is shown, in the scene's order.
    pub(super) bars: Vec<Bar>,
    /// A line about the others.
    pub(super) rest: Option<String>,
}

/// The bar of one object.
pub(super) struct Bar {
    /// Name and probability, as wide as the others'.
    pub(super) label: String,
    pub(super) bar: String,
    /// No other object is more probable.
    pub(super) is_best: bool,
}

/// A bar for each object, in the scene's order; of many only the most probable.
pub(super) fn bars(scene: &Scene, belief: &[f64], columns: usize) -> Bars {
    let mut shown: Vec<(usize, f64)> = belief.iter().copied().enumerate().collect();
    shown.sort_by(|a, b| b.1.total_cmp(&a.1));
    shown.truncate(OBJECTS_MAX);
    shown.sort_unstable_by_key(|(i, _)| *i);
    let name = |i: usize| object_name(scene, i as u32).unwrap_or("?");
    let widest = shown.iter().map(|(i, _)| name(*i).chars().count()).max().unwrap_or(0).min(24);
    let length = columns.saturating_sub(widest + 12).clamp(5, BAR_MAX);
    let best = belief.iter().copied().fold(0.0, f64::max);
    let hidden = belief.len() - shown.len();
    let bar = |(i, p): (usize, f64)| Bar {
        label: format!("  {:widest$} {:5.1} % ", cut(name(i), widest), p * 100.0),
        bar: bar(p, length),
        is_best: p >= best,
    };
    let rest = (hidden > 0).then(|| format!("  and {hidden} less probable ones"));
    Bars { bars: shown.into_iter().map(bar).collect(), rest }
}

fn belief(scene: &Scene, belief: &[f64], style: Style, columns: usize) -> Vec<String> {
    let Bars { bars, rest } = bars(scene, belief, columns);
    let line = |Bar { label, bar, is_best }| {
        let ink = if is_best { Ink::Green } else { Ink::Cyan };
        format!("{label}{}", style.paint(ink, bar))
    };
    bars.into_iter().map(line).chain(rest).collect()
}

/// A bar of `p` times `length` characters, to an eighth of one.
fn bar(p: f64, length: usize) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let eighths = (p.clamp(0.0, 1.0) * length as f64 * 8.0).round() as usize;
    format!("{}{}", "█".repeat(eighths / 8), EIGHTHS[eighths % 8])
}

fn said(model: &WatchModel, style: Style, columns: usize) -> Vec<String> {
    let line = |SaidView { who, text }| {
        let text = cut(text, columns.saturating_sub(8));
        match who {
            Speaker::Person => format!("   you  {text}"),
            Speaker::Unmeant | Speaker::System => {
                style.paint(Ink::Dim, format!("        {text}")).to_string()
            }
            Speaker::Robot => format!(" {}  {text}", style.paint(Ink::Cyan, "robot")),
        }
    };
    model.lines.said().into_iter().map(line).collect()
}

/// What the arm does.
pub(super) fn arm_line(scene: &Scene, arm: &ArmStatus, style: Style) -> String {
    let object = object_name(scene, arm.object).unwrap_or("?");
    let left = words::time(arm.remaining_s);
    let puts_back = arm.task == Task::PutBack;
    let does = match arm.phase.get() {
        PickPhase::Idle => "rests".to_owned(),
        PickPhase::Accepted if puts_back => format!("is to put {object} back"),
        PickPhase::Moving if puts_back => format!("comes for {object}, {left} to go"),
        PickPhase::Closing if puts_back => format!("takes {object}, {left} to go"),
        PickPhase::Holding | PickPhase::Returning if puts_back => {
            format!("puts {object} back, {left} to go")
        }
        PickPhase::Accepted => format!("sets out for {object}"),
        PickPhase::Moving => format!("moves to {object}, {left} to go"),
        PickPhase::Closing => format!("grasps {object}, {left} to go"),
        PickPhase::Holding => format!("brings {object}, {left} to go"),
        PickPhase::Returning => format!("returns {object} to its place, {left} to go"),
        PickPhase::Done => match arm.outcome.get() {
            PickOutcome::Delivered => format!("has delivered {object}"),
            PickOutcome::PutBack => format!("has put {object} back"),
            PickOutcome::Unreachable if puts_back => format!("cannot put {object} back"),
            PickOutcome::Unreachable => format!("cannot reach {object}"),
            PickOutcome::Interrupted => format!("was interrupted at {object}"),
            PickOutcome::Cancelled if puts_back => format!("has left {object} with the user"),
            PickOutcome::Cancelled => format!("has left {object} where it was"),
            PickOutcome::Missed => format!("could not get hold of {object}"),
            PickOutcome::Vanished => format!("found {object} gone"),
            PickOutcome::Kept => format!("holds {object} and has no way back to its place"),
            PickOutcome::Blocked => format!("was kept from moving to {object}"),
            PickOutcome::Pending => "is done".to_owned(),
        },
    };
    if arm.stopped != 0 {
        let stop = style.paint(Ink::Red, "STOPPED (whichone resume-motion)");
        return format!("arm {does} {stop}");
    }
    if let Some(why) = words::hindrance(arm.hindrance.get()) {
        return format!("arm {does} {}", style.paint(Ink::Red, why));
    }
    let moves = if arm.moving != 0 { ", moving" } else { "" };
    format!("arm {does}{moves}")
}

/// The text, or as much of it as `width` characters hold.
fn cut(text: &str, width: usize) -> String {
    let clean = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    if text.chars().count() <= width {
        return clean.collect();
    }
    clean.take(width.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests;
