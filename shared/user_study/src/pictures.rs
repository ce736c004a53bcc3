//! Results as charts: means as marks, their 95 % intervals as lines.

use crate::charts::{Axis, Chart, Panel, Shape};
use crate::{Interval, Mean};

use crate::report::{Group, Report};

/// Longest label in full, characters.
const LABEL_MAX: usize = 44;
/// Width of a chart without its labels and notes, and height of a row, pixels.
const WIDTH: u32 = 1000;
const ROW: u32 = 68;

/// A row of a chart.
struct Row {
    label: String,
    /// Number of the series' colour and mark.
    series: usize,
    value: f64,
    interval: Option<Interval>,
    /// Text at the right end.
    note: String,
}

/// Returns every chart with data to show, by name.
pub fn pictures(report: &Report) -> Vec<(&'static str, Chart)> {
    let mut pictures = Vec::new();
    let groups: Vec<&Group> =
        report.policies.iter().filter(|group| group.interactions() > 0).collect();
    if !groups.is_empty() {
        let success = |group: &Group| {
            let interval = group.success_interval();
            let interval = Interval { low: 100.0 * interval.low, high: 100.0 * interval.high };
            let note = format!("{} of {}", group.right(), group.interactions());
            (100.0 * group.success(), Some(interval), note)
        };
        let title = "Desired object handed over, by policy";
        let rows = rows(&groups, success);
        pictures.push(("success", chart(title, "% of interactions", 100.0, rows)));
        pictures
            .push(("seconds", means("Time per interaction", "seconds", &groups, |g| &g.seconds)));
        let questions = means("Questions per interaction", "questions", &groups, |g| &g.questions);
        pictures.push(("questions", questions));
    }
    pictures.extend(questionnaire(report).map(|chart| ("questionnaire", chart)));
    pictures
}

fn rows(groups: &[&Group], value: impl Fn(&Group) -> (f64, Option<Interval>, String)) -> Vec<Row> {
    let row = |(series, group): (usize, &&Group)| {
        let (value, interval, note) = value(group);
        Row { label: group.policy.clone(), series, value, interval, note }
    };
    groups.iter().enumerate().map(row).collect()
}

fn means(title: &str, unit: &str, groups: &[&Group], mean: fn(&Group) -> &Mean) -> Chart {
    let rows = rows(groups, |group| {
        let mean = mean(group);
        (mean.mean(), mean.student_interval(), format!("{:.1}", mean.mean()))
    });
    let end = |row: &Row| row.interval.map_or(row.value, |interval| interval.high);
    chart(title, unit, rows.iter().map(end).fold(0.0, f64::max), rows)
}

/// Items with numbers on a scale.
fn questionnaire(report: &Report) -> Option<Chart> {
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
    (!rows.is_empty()).then(|| chart("Questionnaire", "mean answer", f64::from(points), rows))
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= LABEL_MAX {
        return text.to_owned();
    }
    text.chars().take(LABEL_MAX - 1).collect::<String>().trim_end().to_owned() + "…"
}

/// Returns a chart with the first row on top.
fn chart(title: &str, unit: &str, largest: f64, rows: Vec<Row>) -> Chart {
    let longest = rows.iter().map(|row| row.label.chars().count()).max().unwrap_or(0);
    let mut shapes = Vec::new();
    let axis = Axis::up_to(&format!("{unit}; lines: 95 % intervals"), largest);
    for (n, row) in rows.iter().rev().enumerate() {
        let y = n as f64 + 0.5;
        if let Some(interval) = row.interval {
            shapes.push((row.series, Shape::Line(vec![(interval.low, y), (interval.high, y)])));
        }
        shapes.push((row.series, Shape::Marks(vec![(row.value, y)])));
        shapes.push((row.series, Shape::Text((axis.ends().1, y + 0.3), row.note.clone())));
    }
    let labels = rows.iter().rev().map(|row| row.label.clone()).collect();
    let y = Axis::named("", labels);
    Chart {
        title: title.to_owned(),
        note: String::new(),
        panels: vec![Panel { heading: String::new(), x: axis, y, shapes }],
        columns: 1,
        panel_size: (WIDTH + 14 * longest as u32, ROW * rows.len() as u32 + 90),
        legend: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::svg;
    use crate::report;
    use crate::testing::{finished, protocol};

    #[test]
    fn pictures_show_every_measure_with_data() {
        assert!(pictures(&report(&[])).is_empty());
        let people = [finished("A", &protocol(), 3), finished("B", &protocol(), 2)];
        let shown = pictures(&report(&people));
        let names: Vec<&str> = shown.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["success", "seconds", "questions", "questionnaire"]);
        let texts = shown.iter().map(|(_, chart)| svg(chart).unwrap()).collect::<Vec<_>>();
        assert!(texts.iter().all(|text| text.contains("95 % intervals")));
        // A rim and a mark for each policy, its interval, and its note.
        assert_eq!(texts[0].matches("<polygon").count(), 2 * report(&people).policies.len());
        assert!(texts[0].contains("5 of 6"), "three right, and two of three: {}", texts[0]);
    }
}
