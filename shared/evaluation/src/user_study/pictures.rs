//! The results as pictures: means as marks, their 95 % intervals as lines.

use crate::charts::{Align, BLACK, Canvas, FAINT, GREY, LETTER_WIDTH, Linear, Size, colour};
use crate::simulation::{Interval, Mean};

use crate::user_study::report::{Group, Report};

/// Above the chart, below it, to its right, and of one row.
const MARGIN: (f64, f64, f64) = (58.0, 66.0, 130.0);
const ROW: f64 = 34.0;
/// Width of the chart itself.
const WIDTH: f64 = 420.0;
/// Longest label that is written whole.
const LABEL_MAX: usize = 44;

/// A row of a chart.
struct Row {
    label: String,
    /// Which series' colour and mark.
    series: usize,
    value: f64,
    interval: Option<Interval>,
    /// At the right end.
    note: String,
}

/// Every picture that there is something to show in, by name.
pub fn pictures(report: &Report) -> Vec<(&'static str, Canvas)> {
    let mut pictures = Vec::new();
    let groups: Vec<&Group> = shown(report);
    if !groups.is_empty() {
        let success = |group: &Group| {
            let interval = group.success_interval();
            let interval = Interval { low: 100.0 * interval.low, high: 100.0 * interval.high };
            let note = format!("{} of {}", group.right(), group.interactions());
            (100.0 * group.success(), Some(interval), note)
        };
        let title = "Desired object handed over, by policy";
        let axis = Linear { end: 100.0, step: 20.0 };
        pictures
            .push(("success", chart(title, "% of interactions", &axis, rows(&groups, success))));
        pictures
            .push(("seconds", means("Time per interaction", "seconds", &groups, |g| &g.seconds)));
        let questions = means("Questions per interaction", "questions", &groups, |g| &g.questions);
        pictures.push(("questions", questions));
    }
    pictures.extend(questionnaire(report).map(|canvas| ("questionnaire", canvas)));
    pictures
}

/// The policies that were met.
fn shown(report: &Report) -> Vec<&Group> {
    report.policies.iter().filter(|group| group.interactions() > 0).collect()
}

fn rows(groups: &[&Group], value: impl Fn(&Group) -> (f64, Option<Interval>, String)) -> Vec<Row> {
    let row = |(series, group): (usize, &&Group)| {
        let (value, interval, note) = value(group);
        Row { label: group.policy.clone(), series, value, interval, note }
    };
    groups.iter().enumerate().map(row).collect()
}

fn means(title: &str, unit: &str, groups: &[&Group], mean: fn(&Group) -> &Mean) -> Canvas {
    let rows = rows(groups, |group| {
        let mean = mean(group);
        (mean.mean(), mean.student_interval(), format!("{:.1}", mean.mean()))
    });
    let end = |row: &Row| row.interval.map_or(row.value, |interval| interval.high);
    let axis = Linear::up_to(rows.iter().map(end).fold(0.0, f64::max));
    chart(title, unit, &axis, rows)
}

/// The items with numbers on a scale.
fn questionnaire(report: &Report) -> Option<Canvas> {
    let scales = report.questionnaire.iter().filter(|a| a.item.points > 0 && a.mean.count() > 0);
    let rows: Vec<Row> = scales
        .map(|answers| Row {
            label: shortened(&answers.item.text),
            series: 0,
            value: answers.mean.mean(),
            interval: answers.mean.student_interval(),
            note: format!("{:.1} of {}", answers.mean.mean(), answers.item.points),
        })
        .collect();
    let points = report.questionnaire.iter().map(|answers| answers.item.points).max()?;
    let axis = Linear { end: f64::from(points), step: 1.0 };
    (!rows.is_empty()).then(|| chart("Questionnaire", "mean answer", &axis, rows))
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= LABEL_MAX {
        return text.to_owned();
    }
    text.chars().take(LABEL_MAX - 1).collect::<String>().trim_end().to_owned() + "…"
}

fn chart(title: &str, unit: &str, axis: &Linear, rows: Vec<Row>) -> Canvas {
    let longest = rows.iter().map(|row| row.label.chars().count()).max().unwrap_or(0);
    let left = 28.0 + LETTER_WIDTH * longest as f64;
    let height = ROW * rows.len() as f64;
    let at = |value: f64| left + axis.place(value) * WIDTH;
    let mut canvas = Canvas::new(left + WIDTH + MARGIN.2, MARGIN.0 + height + MARGIN.1);
    canvas.words((16.0, 26.0), title, Align::Left, Size::Large, BLACK);
    let (top, bottom) = (MARGIN.0 - 6.0, MARGIN.0 + height);
    for mark in axis.marks() {
        canvas.line((at(mark), top), (at(mark), bottom), 1.0, FAINT);
        let text = format!("{}", (1e6 * mark).round() / 1e6);
        canvas.words((at(mark), bottom + 14.0), &text, Align::Middle, Size::Small, GREY);
    }
    canvas.line((left, bottom), (left + WIDTH, bottom), 1.5, BLACK);
    let words = format!("{unit}; lines: 95 % intervals");
    let middle = left + 0.5 * WIDTH;
    canvas.words((middle, bottom + 38.0), &words, Align::Middle, Size::Small, BLACK);
    for (n, row) in rows.iter().enumerate() {
        let line = MARGIN.0 + ROW * (n as f64 + 0.5);
        canvas.words((left - 12.0, line), &row.label, Align::Right, Size::Small, BLACK);
        if let Some(interval) = row.interval {
            let ends = ((at(interval.low), line), (at(interval.high), line));
            canvas.line(ends.0, ends.1, 2.5, colour(row.series));
        }
        canvas.mark((at(row.value), line), row.series);
        let note = (left + WIDTH + 14.0, line);
        canvas.words(note, &row.note, Align::Left, Size::Small, GREY);
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::user_study::report;
    use crate::user_study::testing::{finished, protocol};

    #[test]
    fn pictures_show_what_there_is_and_are_drawn_alike_every_time() {
        assert!(pictures(&report(&[])).is_empty());
        let people = [finished("A", &protocol(), 3), finished("B", &protocol(), 2)];
        let shown = pictures(&report(&people));
        let names: Vec<&str> = shown.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["success", "seconds", "questions", "questionnaire"]);
        for (name, canvas) in &shown {
            let text = crate::charts::svg(canvas);
            assert!(text.contains("95 % intervals") && text.contains("<polygon"), "{name}");
            assert_eq!(text, crate::charts::svg(&canvas.clone()));
        }
        assert!(
            crate::charts::svg(&shown[0].1).contains("5 of 6"),
            "three right, and two of three"
        );
    }
}
