//! The judge's model, a linear and recurrent ones, and the file of its weights.

use language::recurrent::{PARTS, Recurrent};
use language::{Judge, NETWORKS, ROWS, recurrent_sums, softmax};

use crate::linear::Linear;
use crate::recurrent;
use crate::sources::{Sources, Taught};

/// Passes over the lessons of the linear part.
const EPOCHS: usize = 4;
/// Rate of the first step of a weight.
const RATE: f64 = 0.0125;
/// Factors of the sums of both parts, as they were fitted to authors who were not seen.
const SHARES: [f64; 2] = [0.35, 0.23];

/// Both parts.
#[derive(Clone, Debug)]
pub struct Model {
    linear: Linear<3>,
    recurrent: Vec<Recurrent>,
}

/// Sums of both parts for a value word, and its label.
pub type Sums = ([[f64; 3]; 2], usize);

impl Model {
    /// Trains on the lines that are chosen by the name of their source and their number.
    pub fn train(sources: &Sources, is_chosen: impl Fn(&str, usize) -> bool) -> Self {
        let lessons = sources.lessons(&is_chosen);
        let linear = Linear::train(&lessons, ROWS, EPOCHS, RATE, 1);
        let utterances = sources.utterances(&is_chosen);
        let networks = (1..=NETWORKS as u64).map(|seed| recurrent::train(&utterances, seed));
        Self { linear, recurrent: networks.collect() }
    }

    /// Returns the sums for each value word with a label.
    pub fn sums(&self, taught: &Taught) -> Vec<Sums> {
        let recurrent = recurrent_sums(&self.recurrent, &taught.utterance.sequence);
        let labels = &taught.utterance.labels;
        let labelled = recurrent.iter().zip(labels).filter_map(|(sums, it)| Some((sums, (*it)?)));
        let both = |(lesson, (recurrent, label)): (&crate::Lesson, (&[f32; 3], usize))| {
            ([self.linear.sums(&lesson.rows), recurrent.map(f64::from)], label)
        };
        taught.lessons.iter().zip(labelled).map(both).collect()
    }

    /// Returns the judge that has these weights.
    ///
    /// # Errors
    /// Never: a written file can be read.
    pub fn judge(&self) -> Result<Judge, String> {
        Judge::from_bytes(&self.bytes(0)).ok_or_else(|| "expected all weights".to_owned())
    }

    /// Returns the file of the weights, with the hash of their training inputs.
    pub fn bytes(&self, hash: u64) -> Vec<u8> {
        let linear = || (0..ROWS).flat_map(|row| self.linear.row(row));
        let step = linear().fold(1e-9, |most: f64, it| most.max(it.abs())) / f64::from(i16::MAX);
        let mut bytes = hash.to_le_bytes().to_vec();
        bytes.extend(((step * SHARES[0]) as f32).to_le_bytes());
        for weight in linear() {
            bytes.extend(((weight / step).round() as i16).to_le_bytes());
        }
        for network in &self.recurrent {
            for (part, size) in PARTS.into_iter().enumerate() {
                let from = Recurrent::offset(part);
                let weights = &network.weights[from..from + size];
                let most = weights.iter().fold(1e-9, |most: f32, it| most.max(it.abs()));
                let step = most / f32::from(i8::MAX);
                // The last two parts make the sums.
                let share = if part + 2 < PARTS.len() { 1.0 } else { SHARES[1] as f32 };
                bytes.extend((step * share).to_le_bytes());
                bytes.extend(weights.iter().map(|it| (it / step).round() as i8 as u8));
            }
        }
        bytes
    }
}

/// Returns the factors of both parts' sums under which the labels are most probable.
pub fn fitted(sums: &[Sums]) -> [f64; 2] {
    let loss = |[linear, recurrent]: &[f64; 2]| -> f64 {
        let loss = |([a, b], label): &Sums| {
            let stated = softmax([0, 1, 2].map(|n| linear * a[n] + recurrent * b[n]));
            -stated[*label].max(1e-9).ln()
        };
        sums.iter().map(loss).sum()
    };
    let grid = || (0..=16).map(|n| 0.05 * f64::from(n));
    let all = grid().flat_map(|linear| grid().map(move |recurrent| [linear, 0.5 * recurrent]));
    all.min_by(|a, b| loss(a).total_cmp(&loss(b))).unwrap_or(SHARES)
}
