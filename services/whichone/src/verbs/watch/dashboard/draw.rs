//! Drawing of the dashboard, for a terminal of any size.

use command_line::output::{Ink, Style};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::style::{Color, Modifier, Style as Look};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};
use scene::Scene;
use service::printable::one_line;
use service::status::GroupStatus;
use service::view::{Latest, SaidView, Speaker};

use super::keys::{Keyboard, Mode};
use crate::verbs::status::{group_state, state_ink};
use crate::verbs::watch::frame::{arm_line, bars, reasons, summary};
use crate::verbs::watch::model::WatchModel;
use crate::verbs::{hearing, words};

#[cfg(test)]
mod tests;

/// Width from which the services have a column of their own, characters.
const WIDE: u16 = 90;
/// Width of that column.
const SERVICES_WIDTH: u16 = 34;
/// Height that the dialogue keeps where there is little room.
const SAID_HEIGHT_MIN: u16 = 4;

/// A line for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Notice {
    pub(super) text: String,
    pub(super) is_bad: bool,
}

impl Notice {
    /// Something that went as intended.
    pub(super) fn good(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_bad: false }
    }

    /// Something that did not.
    pub(super) fn bad(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_bad: true }
    }
}

/// All that is drawn, but for what is being typed.
pub(super) struct Picture<'a> {
    scene: &'a Scene,
    latest: &'a Latest,
    said: Vec<SaidView<'a>>,
    status: Option<&'a GroupStatus>,
    notice: Option<&'a Notice>,
    style: Style,
}

impl<'a> Picture<'a> {
    /// The picture of a group at this moment.
    pub(super) fn of(model: &'a WatchModel, notice: Option<&'a Notice>, style: Style) -> Self {
        Self {
            scene: model.scene(),
            latest: model.latest(),
            said: model.lines.said(),
            status: model.status.as_ref(),
            notice,
            style,
        }
    }

    fn look(&self, ink: Ink) -> Look {
        let look = Look::default();
        match ink {
            Ink::Bold => look.add_modifier(Modifier::BOLD),
            Ink::Dim => look.add_modifier(Modifier::DIM),
            _ if !self.style.colour => look,
            Ink::Green => look.fg(Color::Green),
            Ink::Yellow => look.fg(Color::Yellow),
            Ink::Red => look.fg(Color::Red),
            Ink::Cyan => look.fg(Color::Cyan),
        }
    }

    fn span(&self, ink: Ink, text: impl AsRef<str>) -> Span<'static> {
        Span::styled(one_line(text.as_ref()).into_owned(), self.look(ink))
    }
}

pub(super) fn draw(frame: &mut Frame<'_>, picture: &Picture<'_>, keyboard: &Keyboard) {
    let is_wide = frame.area().width >= WIDE;
    let below = if is_wide { Vec::new() } else { vec![services_line(picture)] };
    let rows = [
        Constraint::Length(1 + below.len() as u16),
        Constraint::Min(2),
        Constraint::Length(2),
        Constraint::Length(1),
        Constraint::Length(1),
    ];
    let [head, body, arm, notice, keys] = Layout::vertical(rows).areas(frame.area());
    let mut lines = vec![head_line(picture)];
    lines.extend(below);
    frame.render_widget(Paragraph::new(lines), head);
    let mut dialogue = body;
    if is_wide {
        let columns = [Constraint::Min(0), Constraint::Length(SERVICES_WIDTH)];
        let [left, right] = Layout::horizontal(columns).areas(body);
        let services = Paragraph::new(services(picture)).wrap(Wrap { trim: false });
        frame.render_widget(services.block(Block::bordered().title("services")), right);
        dialogue = left;
    }
    draw_dialogue(frame, dialogue, picture);
    frame.render_widget(Paragraph::new(arm_lines(picture)), arm);
    if let Some(Notice { text, is_bad }) = picture.notice {
        let ink = if *is_bad { Ink::Red } else { Ink::Green };
        frame.render_widget(picture.span(ink, text), notice);
    }
    draw_keys(frame, keys, picture, keyboard);
}

fn head_line(picture: &Picture<'_>) -> Line<'static> {
    let Some(status) = picture.status else {
        return picture.span(Ink::Yellow, "the supervisor does not answer").into();
    };
    let (ink, state) = group_state(status.state);
    let up = words::time(status.uptime_s);
    let rest = format!(", scene {}, up {up}", one_line(picture.scene.name()));
    let name = picture.span(Ink::Bold, &status.name);
    Line::from(vec![name, Span::raw(" "), picture.span(ink, state), Span::raw(rest)])
}

/// The services in one line, for a narrow terminal.
fn services_line(picture: &Picture<'_>) -> Line<'static> {
    let services = picture.status.iter().flat_map(|status| &status.services);
    let spans = services.flat_map(|service| {
        let state = picture.span(state_ink(service.state), service.state.word());
        [Span::raw(format!("{} ", one_line(&service.name))), state, Span::raw("  ")]
    });
    Line::from_iter(spans)
}

/// The services, a line each, with what to do about those that do nothing.
fn services(picture: &Picture<'_>) -> Vec<Line<'static>> {
    let mut lines = Vec::new();
    for service in picture.status.iter().flat_map(|status| &status.services) {
        let starts = match service.restarts {
            0 => String::new(),
            restarts => format!(" restarted {restarts}"),
        };
        let name = Span::raw(format!("{:<10} ", one_line(&service.name)));
        let state = picture.span(state_ink(service.state), service.state.word());
        lines.push(Line::from(vec![name, state, picture.span(Ink::Dim, starts)]));
        let why = service.unavailable();
        lines.extend(why.map(|why| Line::from(picture.span(Ink::Red, format!("  {why}")))));
    }
    lines
}

/// Belief and reasons above what was said.
fn draw_dialogue(frame: &mut Frame<'_>, area: Rect, picture: &Picture<'_>) {
    let columns = usize::from(area.width.saturating_sub(2));
    let (title, lines) = match &picture.latest.view {
        None => (String::new(), vec![picture.span(Ink::Yellow, "the policy is silent").into()]),
        Some(view) => {
            let bars = bars(picture.scene, &view.belief, columns);
            let mut lines: Vec<Line<'_>> = bars
                .bars
                .into_iter()
                .map(|bar| {
                    let ink = if bar.is_best { Ink::Green } else { Ink::Cyan };
                    let label = Span::raw(one_line(&bar.label).into_owned());
                    Line::from(vec![label, picture.span(ink, bar.bar)])
                })
                .collect();
            lines.extend(bars.rest.map(Line::from));
            let reasons = reasons(picture.scene, view, Style::default(), columns);
            lines.extend(reasons.iter().map(|text| Line::from(one_line(text).into_owned())));
            (summary(view), lines)
        }
    };
    let wanted = u16::try_from(lines.len() + 2).unwrap_or(u16::MAX);
    let most = area.height.saturating_sub(SAID_HEIGHT_MIN);
    let rows = [Constraint::Length(wanted.min(most)), Constraint::Min(0)];
    let [belief, said] = Layout::vertical(rows).areas(area);
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(title)), belief);
    let lines: Vec<Line<'_>> = picture.said.iter().map(|line| said_line(picture, line)).collect();
    // The newest lines count most.
    let hidden = lines.len().saturating_sub(usize::from(said.height.saturating_sub(2)));
    let lines = lines.into_iter().skip(hidden).collect::<Vec<_>>();
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title("dialogue")), said);
}

fn said_line(picture: &Picture<'_>, SaidView { who, text }: &SaidView<'_>) -> Line<'static> {
    let words = Span::raw(one_line(text).into_owned());
    match who {
        Speaker::Person => Line::from(vec![Span::raw("  you  "), words]),
        Speaker::Robot => Line::from(vec![picture.span(Ink::Cyan, "robot  "), words]),
        Speaker::Unmeant | Speaker::System => {
            picture.span(Ink::Dim, format!("       {text}")).into()
        }
    }
}

fn arm_lines(picture: &Picture<'_>) -> Vec<Line<'static>> {
    let arm = match &picture.latest.arm {
        None => picture.span(Ink::Yellow, "the arm is silent"),
        Some(arm) => {
            let is_held = arm.stopped != 0 || words::hindrance(arm.hindrance.get()).is_some();
            let text = arm_line(picture.scene, arm, Style::default());
            if is_held {
                picture.span(Ink::Red, text)
            } else {
                Span::raw(one_line(&text).into_owned())
            }
        }
    };
    let hearing = picture.latest.hearing.as_ref();
    let hearing = hearing.map(|hearing| hearing::line(hearing, Style::default()));
    let hearing = hearing.map(|text| Line::from(picture.span(Ink::Dim, text)));
    [Some(Line::from(arm)), hearing].into_iter().flatten().collect()
}

fn draw_keys(frame: &mut Frame<'_>, area: Rect, picture: &Picture<'_>, keyboard: &Keyboard) {
    let text = match keyboard.mode() {
        Mode::Watching => "s, space, Esc stop   r resume   t type to the robot   q quit",
        Mode::Releasing(word) => {
            &format!("to let the arm move, type resume and Enter: {word}_   space stops motion")
        }
        Mode::Typing(text) => return draw_typed(frame, area, picture, text),
    };
    frame.render_widget(picture.span(Ink::Dim, text), area);
}

/// The end of the text that is typed, with the cursor behind it.
fn draw_typed(frame: &mut Frame<'_>, area: Rect, picture: &Picture<'_>, text: &str) {
    const PROMPT: &str = "say> ";
    let help = "   Enter says it, Esc cancels, Ctrl-S stops motion";
    let room = usize::from(area.width).saturating_sub(PROMPT.len() + 1);
    let mut shown = Span::raw(one_line(text).into_owned());
    while shown.width() > room && !shown.content.is_empty() {
        shown = Span::raw(shown.content.chars().skip(1).collect::<String>());
    }
    let x = area.x.saturating_add((PROMPT.len() + shown.width()) as u16);
    let line = vec![picture.span(Ink::Cyan, PROMPT), shown, picture.span(Ink::Dim, help)];
    frame.render_widget(Line::from(line), area);
    frame.set_cursor_position(Position::new(x, area.y));
}
