//! The judge's model, a linear and a recurrent one, and the file of its weights.

use language::recurrent::{PARTS, Recurrent};
use language::{Judge, ROWS};

use crate::linear::{Linear, softmax};
use crate::recurrent;
use crate::sources::{Sources, Taught};

/// Passes over the lessons of the linear part.
const EPOCHS: usize = 4;
/// Rate of the first step of a weight.
const RATE: f64 = 0.0125;
/// Factors of the sums of both parts, as they were fitted to authors who were not seen.
const SHARES: [f64; 2] = [0.35, 0.35];
/// Further factor of both where the parts and the rules' proposal agree, fitted likewise.
const AGREED: f64 = 1.0;

/// Both parts.
#[derive(Clone, Debug)]
pub struct Model {
    linear: Linear,
    recurrent: Recurrent,
}

/// What was found for a value word.
#[derive(Clone, Copy, Debug)]
pub struct Sums {
    /// Sums of both parts.
    pub parts: [[f64; 3]; 2],
    /// Number of what the rules propose.
    pub proposal: usize,
    /// Number of the label.
    pub label: usize,
}

impl Model {
    /// Trains on the lines that are chosen by the name of their source and their number.
    pub fn train(sources: &Sources, is_chosen: impl Fn(&str, usize) -> bool) -> Self {
        let lessons = sources.lessons(&is_chosen);
        let linear = Linear::train(&lessons, EPOCHS, RATE, 1);
        Self { linear, recurrent: recurrent::train(&sources.utterances(&is_chosen), 1) }
    }

    /// Returns the sums for each value word with a label.
    pub fn sums(&self, taught: &Taught) -> Vec<Sums> {
        let recurrent = self.recurrent.sums(&taught.utterance.sequence);
        let labels = &taught.utterance.labels;
        let labelled = recurrent.iter().zip(labels).filter_map(|(sums, it)| Some((sums, (*it)?)));
        let both = |(lesson, (recurrent, label)): (&crate::Lesson, (&[f32; 3], usize))| {
            let parts = [self.linear.sums(&lesson.rows), recurrent.map(f64::from)];
            Sums { parts, proposal: lesson.proposal, label }
        };
        taught.lessons.iter().zip(labelled).map(both).collect()
    }

    /// Returns the judge that has these weights.
    ///
    /// # Errors
    /// Never: what is written can be read.
    pub fn judge(&self) -> Result<Judge, String> {
        Judge::from_bytes(&self.bytes(0)).ok_or_else(|| "expected all weights".to_owned())
    }

    /// Returns the file of the weights, with the hash of what they were trained on.
    pub fn bytes(&self, hash: u64) -> Vec<u8> {
        let linear = || (0..ROWS).flat_map(|row| self.linear.row(row));
        let step = linear().fold(1e-9, |most: f64, it| most.max(it.abs())) / f64::from(i16::MAX);
        let mut bytes = hash.to_le_bytes().to_vec();
        bytes.extend([step * SHARES[0], AGREED].map(|it| (it as f32).to_le_bytes()).concat());
        for weight in linear() {
            bytes.extend(((weight / step).round() as i16).to_le_bytes());
        }
        for (part, size) in PARTS.into_iter().enumerate() {
            let from = Recurrent::offset(part);
            let weights = &self.recurrent.weights[from..from + size];
            let most = weights.iter().fold(1e-9, |most: f32, it| most.max(it.abs()));
            let step = most / f32::from(i8::MAX);
            // The last two parts make the sums.
            let share = if part + 2 < PARTS.len() { 1.0 } else { SHARES[1] as f32 };
            bytes.extend((step * share).to_le_bytes());
            bytes.extend(weights.iter().map(|it| (it / step).round() as i8 as u8));
        }
        bytes
    }
}

/// Returns the factors of both parts' sums under which the labels are most probable, and the further one where they agree
/// with each other and with the rules.
pub fn fitted(sums: &[Sums]) -> [f64; 3] {
    let loss = |[linear, recurrent, agreed]: [f64; 3], all: &[&Sums]| -> f64 {
        let loss = |it: &&Sums| {
            let [a, b] = it.parts;
            let stated = softmax([0, 1, 2].map(|n| agreed * (linear * a[n] + recurrent * b[n])));
            -stated[it.label].max(1e-9).ln()
        };
        all.iter().map(loss).sum()
    };
    let best = |candidates: Vec<[f64; 3]>, all: &[&Sums]| {
        let best = candidates.into_iter().min_by(|a, b| loss(*a, all).total_cmp(&loss(*b, all)));
        best.unwrap_or([1.0; 3])
    };
    let (agreed, others): (Vec<&Sums>, Vec<&Sums>) = sums.iter().partition(|it| it.agree());
    let grid = || (0..=16).map(|n| 0.05 * f64::from(n));
    let shares = grid().flat_map(|linear| grid().map(move |other| [linear, other, 1.0]));
    let [linear, recurrent, _] = best(shares.collect(), &others);
    let further = (2..=60).map(|n| [linear, recurrent, 0.1 * f64::from(n)]).collect();
    best(further, &agreed)
}

impl Sums {
    /// Returns whether both parts find most what the rules propose.
    pub fn agree(&self) -> bool {
        let best = |sums: &[f64; 3]| (0..3).max_by(|a, b| sums[*a].total_cmp(&sums[*b]));
        self.parts.iter().all(|sums| best(sums) == Some(self.proposal))
    }
}
