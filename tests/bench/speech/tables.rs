//! The trials of one corpus as tables.

use super::Trial;
use super::corpus::Corpus;
use super::score::Score;
use crate::report::{Report, percentile};

/// Title of a row and filter of its trials.
type Of<'a> = (String, Box<dyn Fn(&Trial) -> bool + 'a>);

pub(super) fn add(report: &mut Report, corpus: &Corpus, levels: &[f64], trials: &[Trial]) {
    let mut rows: Vec<Of<'_>> = Vec::new();
    for &level in levels {
        rows.push((format!("{level} dB"), Box::new(move |t| t.snr_db == level)));
    }
    let ends = [levels.first(), levels.last()].into_iter().flatten();
    for &level in ends {
        for (half, name) in [(0, "even"), (1, "odd")] {
            let of = move |t: &Trial| t.snr_db == level && t.sentence % 2 == half;
            rows.push((format!("{level} dB, {name} sentences"), Box::new(of)));
        }
    }
    let of = |rows: &[Of<'_>]| -> Vec<Row> {
        let scores = |is: &dyn Fn(&Trial) -> bool| {
            trials.iter().filter(|t| is(t)).map(|t| t.score.clone()).collect()
        };
        rows.iter().map(|(name, is)| (name.clone(), scores(is))).collect()
    };
    understood(report, corpus.name, &of(&rows));
    rows.truncate(levels.len());
    timed(report, corpus.name, &of(&rows));
    reliable(report, corpus.name, &of(&rows));
}

/// A row's name, and what it is about.
type Row = (String, Vec<Score>);

fn understood(report: &mut Report, corpus: &str, rows: &[Row]) {
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
    let row = |(name, scores): &Row| {
        let (meant, other): (Vec<Score>, Vec<Score>) =
            scores.iter().cloned().partition(|score| score.for_the_robot);
        vec![
            name.clone(),
            meant.len().to_string(),
            share(&meant, |s| s.best),
            share(&meant, |s| s.weighed),
            share(&meant, |s| s.oracle),
            share(&meant, |s| s.passed),
            share(&meant, |s| s.wrong_action),
            other.len().to_string(),
            share(&other, |s| s.acted_on),
        ]
    };
    let note = "Right: values asserted, groups ruled out, answer and order all equal those of the true \
                text. Best: of the best hypothesis; weighed: the meaning with the largest sum of \
                weights over the five; any: one of the five is right; these three with the gate open. \
                Passed: the gate lets it in and the weighed meaning is right; wrong action: it lets it \
                in and the robot would act on another meaning.";
    report.table(format!("Spoken input: {corpus}"), note, heads, rows.iter().map(row).collect());
}

fn timed(report: &mut Report, corpus: &str, rows: &[Row]) {
    let heads = [
        "noise",
        "onset late by, ms, p50",
        "p95",
        "release late by, ms, p50",
        "p95",
        "voice's end to result less the closing pause, ms, p50",
        "p95",
        "decoding, CPU over sound",
    ];
    let row = |(name, scores): &Row| {
        let of = |value: fn(&Score) -> f64| -> Vec<f64> {
            scores.iter().map(value).filter(|x| x.is_finite()).map(|x| x * 1e3).collect()
        };
        let at = |samples: &[f64], share| format!("{:.0}", percentile(samples, share));
        let [onset, release, delay] = [of(|s| s.onset_s), of(|s| s.release_s), of(|s| s.delay_s)];
        let sum = |value: fn(&Score) -> f64| scores.iter().map(value).sum::<f64>();
        vec![
            name.clone(),
            at(&onset, 0.5),
            at(&onset, 0.95),
            at(&release, 0.5),
            at(&release, 0.95),
            at(&delay, 0.5),
            at(&delay, 0.95),
            format!("{:.3}", sum(|s| s.cpu_s) / sum(|s| s.sound_s)),
        ]
    };
    let title = format!("Spoken input, times: {corpus}");
    let note = "Onset and release: the detector's edges against the voice's.";
    report.table(title, note, heads, rows.iter().map(row).collect());
}

/// Share of right words by the recogniser's confidence.
fn reliable(report: &mut Report, corpus: &str, rows: &[Row]) {
    const BOUNDS: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.001];
    let cell = |words: &[(f32, bool)], from: f32, to: f32| {
        let within: Vec<&(f32, bool)> = words.iter().filter(|w| from <= w.0 && w.0 < to).collect();
        let right = within.iter().filter(|(_, right)| *right).count();
        let mean = within.iter().map(|w| w.0).sum::<f32>() / within.len().max(1) as f32;
        match within.len() {
            0 => "–".to_owned(),
            n => format!("{mean:.2}: {:.2} ({n})", right as f64 / n as f64),
        }
    };
    let row = |(name, scores): &Row| {
        let meant = scores.iter().filter(|score| score.for_the_robot);
        let words: Vec<(f32, bool)> = meant.flat_map(|score| score.sure.clone()).collect();
        let cells = BOUNDS.windows(2).map(|bounds| cell(&words, bounds[0], bounds[1]));
        std::iter::once(name.clone()).chain(cells).collect()
    };
    let heads = ["noise", "below 0.2", "0.2 to 0.4", "0.4 to 0.6", "0.6 to 0.8", "from 0.8"];
    let title = format!("Spoken input, confidence of words: {corpus}");
    let note = "Words of the best hypotheses of what is for the robot, by their confidence: its mean, the \
                share of words that were said (number of words).";
    report.table(title, note, heads, rows.iter().map(row).collect());
}

fn share(scores: &[Score], is: fn(&Score) -> bool) -> String {
    percent(scores.iter().filter(|score| is(score)).count(), scores.len())
}

fn percent(part: usize, whole: usize) -> String {
    match whole {
        0 => "–".to_owned(),
        _ => format!("{:.1} %", 100.0 * part as f64 / whole as f64),
    }
}
