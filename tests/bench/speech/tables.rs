//! The trials of one corpus as tables.

use super::conditions::Condition;
use super::listener::THRESHOLDS;
use super::score::{Gated, Score};
use super::{Trial, corpus::Corpus};
use crate::report::{Report, percentile};
use ::speech_engines::vad::SegmenterOptions;
use evaluation::simulation::{Interval, wilson};

/// A row's name, and what it is about.
type Row<'t> = (&'static str, Vec<&'t Score>);

pub(super) fn add(
    report: &mut Report,
    corpus: &Corpus,
    conditions: &[Condition],
    trials: &[Trial],
) {
    let row = |condition: &Condition| {
        let among = trials.iter().filter(|trial| trial.condition == *condition);
        (condition.name, among.map(|trial| &trial.score).collect())
    };
    let rows: Vec<Row<'_>> = conditions.iter().map(row).collect();
    understood(report, corpus.name, &rows);
    gated(report, corpus.name, &rows);
    timed(report, corpus.name, &rows);
    words_reliable(report, corpus.name, &rows);
    meanings_reliable(report, corpus.name, &rows);
}

/// Scores of what is for the robot, and of what is not.
fn parted<'t>(scores: &[&'t Score]) -> (Vec<&'t Score>, Vec<&'t Score>) {
    scores.iter().partition(|score| score.for_the_robot)
}

fn understood(report: &mut Report, corpus: &str, rows: &[Row<'_>]) {
    let heads = [
        "noise",
        "for the robot",
        "right: best",
        "right: weighed",
        "right: any of them",
        "passed and right",
        "wrong action",
        "about other things",
        "acted on",
    ];
    let row = |(name, scores): &Row<'_>| {
        let (meant, other) = parted(scores);
        vec![
            (*name).to_owned(),
            meant.len().to_string(),
            share(&meant, |s| s.best),
            share(&meant, |s| s.weighed),
            share(&meant, |s| s.oracle),
            interval(&meant, |s| s.gated().passed),
            interval(&meant, |s| s.gated().wrong_action),
            other.len().to_string(),
            interval(&other, |s| s.gated().acted_on),
        ]
    };
    let note = "Right: values asserted, groups ruled out, answer and order all equal those of the true \
                text. Best: of the best hypothesis; weighed: the meaning with the largest sum of \
                weights over the five; any: one of the five is right; these three with the gate open. \
                Passed: the gate lets it in and the weighed meaning is right; wrong action: it lets it \
                in and the robot would act on another meaning. In brackets: 95 % interval (Wilson).";
    report.table(format!("Spoken input: {corpus}"), note, heads, rows.iter().map(row).collect());
}

fn gated(report: &mut Report, corpus: &str, rows: &[Row<'_>]) {
    let heads = ["noise", "threshold", "passed and right", "wrong action", "other talk acted on"];
    let row = |name: &str, scores: &[&Score], n: usize| {
        let (meant, other) = parted(scores);
        let of = |scores: &[&Score], is: fn(&Gated) -> bool| share(scores, |s| is(&s.gated[n]));
        vec![
            name.to_owned(),
            format!("{:.2}", THRESHOLDS[n]),
            of(&meant, |gated| gated.passed),
            of(&meant, |gated| gated.wrong_action),
            of(&other, |gated| gated.acted_on),
        ]
    };
    let rows = rows
        .iter()
        .flat_map(|(name, scores)| (1..THRESHOLDS.len()).map(move |n| row(name, scores, n)));
    let note = "The same trials at other thresholds (`accept_score_min`).";
    report.table(format!("Spoken input, gate: {corpus}"), note, heads, rows.collect());
}

fn timed(report: &mut Report, corpus: &str, rows: &[Row<'_>]) {
    let heads = [
        "noise",
        "onset late by, ms, p50",
        "p95",
        "release late by, ms, p50",
        "p95",
        "voice's end to result less the closing pause, ms, p50",
        "p95",
        "decoding, CPU ms, p50",
        "p95",
        "decoding, CPU over sound",
        "second recogniser asked",
        "then to result, ms, p50",
        "p95",
        "too late",
        "never came",
    ];
    let row = |(name, scores): &Row<'_>| {
        let of = |value: fn(&Score) -> f64| -> Vec<f64> {
            scores.iter().map(|s| value(s)).filter(|x| x.is_finite()).map(|x| x * 1e3).collect()
        };
        let columns = [of(|s| s.onset_s), of(|s| s.release_s), of(|s| s.delay_s), of(|s| s.cpu_s)];
        let times = columns.iter().flat_map(|column| {
            [0.5, 0.95].map(|share| format!("{:.0}", percentile(column, share)))
        });
        let sum = |value: fn(&Score) -> f64| scores.iter().map(|s| value(s)).sum::<f64>();
        let load = format!("{:.3}", sum(|s| s.cpu_s) / sum(|s| s.sound_s));
        let asked = share(scores, |s| s.asked);
        let doubtful = scores.iter().filter(|s| s.asked && s.wall_s.is_finite());
        let doubtful: Vec<f64> = doubtful.map(|s| s.wall_s * 1e3).collect();
        let second = [0.5, 0.95].map(|share| match doubtful.is_empty() {
            true => String::new(),
            false => format!("{:.0}", percentile(&doubtful, share)),
        });
        let options = SegmenterOptions::default();
        let limit_ms = (options.closing_pause_s - options.early_roll_s) * 1e3;
        let late = doubtful.iter().filter(|&&ms| ms > limit_ms).count();
        let late = percent(late, doubtful.len());
        let row = std::iter::once((*name).to_owned()).chain(times).chain([load, asked]);
        let never = without_opinion(scores);
        row.chain(second).chain([late, never]).collect()
    };
    let title = format!("Spoken input, times: {corpus}");
    let note = "Onset and release: the detector's edges against the voice's. Decoding and its load are \
                those of the first recogniser; the last columns are the time from the beginning of \
                decoding to the result where the second one was asked (with WHICHONE_WHISPER_MODEL); too late: \
                after the closing pause; never came: there was no opinion, as where the model cannot be loaded.";
    report.table(title, note, heads, rows.iter().map(row).collect());
}

/// Number of clips about which the second recogniser was asked and had no opinion.
fn without_opinion(scores: &[&Score]) -> String {
    scores.iter().filter(|score| score.without_opinion).count().to_string()
}

/// Share of right words by the recogniser's confidence.
fn words_reliable(report: &mut Report, corpus: &str, rows: &[Row<'_>]) {
    let row = |(name, scores): &Row<'_>| {
        let (meant, _) = parted(scores);
        curve(name, &meant.iter().flat_map(|score| score.sure.clone()).collect::<Vec<_>>())
    };
    let title = format!("Spoken input, confidence of words: {corpus}");
    let note = "Words of the best hypotheses of what is for the robot, by their confidence: its mean, the \
                share of words that were said (number of words).";
    report.table(title, note, CURVE_HEADS, rows.iter().map(row).collect());
}

/// Share of right meanings by their share of the weight.
fn meanings_reliable(report: &mut Report, corpus: &str, rows: &[Row<'_>]) {
    let row = |(name, scores): &Row<'_>| {
        let (meant, _) = parted(scores);
        let heard = meant.iter().filter(|score| score.meaning_share > 0.0);
        curve(name, &heard.map(|score| (score.meaning_share, score.weighed)).collect::<Vec<_>>())
    };
    let title = format!("Spoken input, confidence of meanings: {corpus}");
    let note = "Weighed meanings of what is for the robot, by their share of the weight: its mean, the share \
                of meanings that are right (number of utterances).";
    report.table(title, note, CURVE_HEADS, rows.iter().map(row).collect());
}

const CURVE_HEADS: [&str; 8] = [
    "noise",
    "below 0.2",
    "0.2 to 0.4",
    "0.4 to 0.6",
    "0.6 to 0.8",
    "from 0.8",
    "all",
    "calibration error",
];

/// A reliability curve: in each bin the mean confidence, the share that is right and the number; and the
/// mean distance of the two.
fn curve(name: &str, sure: &[(f32, bool)]) -> Vec<String> {
    const BOUNDS: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.001];
    let bin = |from: f32, to: f32| -> (usize, f64, f64) {
        let within: Vec<&(f32, bool)> = sure.iter().filter(|w| from <= w.0 && w.0 < to).collect();
        let n = within.len().max(1) as f64;
        let right = within.iter().filter(|(_, right)| *right).count() as f64;
        (within.len(), within.iter().map(|w| f64::from(w.0)).sum::<f64>() / n, right / n)
    };
    let cell = |(len, mean, right): (usize, f64, f64)| match len {
        0 => "–".to_owned(),
        n => format!("{mean:.2}: {right:.2} ({n})"),
    };
    let bins: Vec<_> = BOUNDS.windows(2).map(|bounds| bin(bounds[0], bounds[1])).collect();
    let off = bins.iter().map(|(n, mean, right)| *n as f64 * (mean - right).abs()).sum::<f64>();
    let cells = bins.iter().map(|bin| cell(*bin)).chain([cell(bin(0.0, 1.001))]);
    let off = format!("{:.3}", off / sure.len().max(1) as f64);
    std::iter::once(name.to_owned()).chain(cells).chain([off]).collect()
}

fn share(scores: &[&Score], is: impl Fn(&Score) -> bool) -> String {
    percent(scores.iter().filter(|score| is(score)).count(), scores.len())
}

fn percent(part: usize, whole: usize) -> String {
    match whole {
        0 => "–".to_owned(),
        _ => format!("{:.1} %", 100.0 * part as f64 / whole as f64),
    }
}

/// A share with its 95 % interval.
fn interval(scores: &[&Score], is: impl Fn(&Score) -> bool) -> String {
    let (part, whole) = (scores.iter().filter(|score| is(score)).count(), scores.len());
    let Interval { low, high } = wilson(part as u64, whole as u64);
    format!("{} ({:.1}–{:.1})", percent(part, whole), 100.0 * low, 100.0 * high)
}
