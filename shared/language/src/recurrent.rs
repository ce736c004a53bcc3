//! The recurrent part of the judge: it reads an utterance from both ends, and states what is said of each value word.
//!
//! Numbers of 32 bits, sums in a fixed order, and functions of basic operations alone: the same result on every machine.

/// Rows of the embeddings of features.
pub const EMBEDDINGS: usize = 6144;
/// Numbers of an embedding.
pub const WIDTH: usize = 24;
/// Units of each direction.
pub const UNITS: usize = 32;
/// Units between the states and the three polarities.
pub const HIDDEN: usize = 32;
/// Inputs of the hidden units: both states at the value word, both last states, and the value word's own features.
pub const JOINED: usize = 4 * UNITS + WIDTH;
/// Numbers of units of a step: update, reset, candidate.
const GATES: usize = 3 * UNITS;
/// Sizes of the parts of the weights, in their order: embeddings; for each direction the weights of inputs, of states, and
/// biases; weights and biases of the hidden units; those of the polarities.
pub const PARTS: [usize; 11] = [
    EMBEDDINGS * WIDTH,
    WIDTH * GATES,
    UNITS * GATES,
    GATES,
    WIDTH * GATES,
    UNITS * GATES,
    GATES,
    JOINED * HIDDEN,
    HIDDEN,
    HIDDEN * 3,
    3,
];

/// What the recurrent judge reads: rows of embeddings for each element, and for each value word its element and rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sequence {
    /// Rows of each element.
    pub elements: Vec<Vec<u32>>,
    /// Element of each value word, and its own rows.
    pub values: Vec<(usize, Vec<u32>)>,
}

/// Weights, part after part as [`PARTS`] has them.
#[derive(Clone, Debug, PartialEq)]
pub struct Recurrent {
    /// The weights.
    pub weights: Vec<f32>,
}

/// One step of one direction.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Share of the state that is kept.
    pub keep: [f32; UNITS],
    /// Share of the state that the candidate sees.
    pub reset: [f32; UNITS],
    /// What the state adds to the candidate, before it is reset.
    pub recalled: [f32; UNITS],
    /// The candidate.
    pub candidate: [f32; UNITS],
    /// The state after the step.
    pub state: [f32; UNITS],
}

/// What the hidden units make of a value word.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Their inputs.
    pub joined: Vec<f32>,
    /// Their activities.
    pub hidden: [f32; HIDDEN],
    /// Sums of wanted, denied, neither.
    pub sums: [f32; 3],
}

impl Recurrent {
    /// Returns where a part begins.
    pub fn offset(part: usize) -> usize {
        PARTS[..part].iter().sum()
    }

    fn part(&self, part: usize) -> &[f32] {
        let from = Self::offset(part);
        &self.weights[from..from + PARTS[part]]
    }

    /// Returns the sum of the embeddings of these rows.
    pub fn embedded(&self, rows: &[u32]) -> [f32; WIDTH] {
        let mut sum = [0.0; WIDTH];
        for row in rows {
            let from = *row as usize * WIDTH;
            add(&mut sum, 1.0, &self.weights[from..from + WIDTH]);
        }
        sum
    }

    /// Returns the steps of a direction, 0 forwards or 1 backwards, in the order of the elements.
    pub fn steps(&self, inputs: &[[f32; WIDTH]], direction: usize) -> Vec<Step> {
        let [of_input, of_state, bias] = [1, 2, 3].map(|part| self.part(part + 3 * direction));
        let mut steps = Vec::with_capacity(inputs.len());
        let mut state = [0.0; UNITS];
        let mut step = |input: &[f32; WIDTH]| {
            let mut sums: [f32; GATES] = bias.try_into().unwrap_or([0.0; GATES]);
            apply(&mut sums, input, of_input);
            let mut recalled = [0.0; GATES];
            apply(&mut recalled, &state, of_state);
            let mut step = Step {
                keep: [0.0; UNITS],
                reset: [0.0; UNITS],
                recalled: [0.0; UNITS],
                candidate: [0.0; UNITS],
                state: [0.0; UNITS],
            };
            for n in 0..UNITS {
                let (reset, candidate) = (UNITS + n, 2 * UNITS + n);
                step.keep[n] = sigmoid(sums[n] + recalled[n]);
                step.reset[n] = sigmoid(sums[reset] + recalled[reset]);
                step.recalled[n] = recalled[candidate];
                step.candidate[n] = tanh(sums[candidate] + step.reset[n] * step.recalled[n]);
                step.state[n] = step.candidate[n] + step.keep[n] * (state[n] - step.candidate[n]);
            }
            state = step.state;
            step
        };
        if direction == 0 {
            steps.extend(inputs.iter().map(&mut step));
        } else {
            steps.extend(inputs.iter().rev().map(&mut step));
            steps.reverse();
        }
        steps
    }

    /// Returns what is stated of a value word, from the states at its element, the last states and its own features.
    pub fn stated(&self, forwards: &[Step], backwards: &[Step], at: usize, own: &[f32]) -> Stated {
        let none = [0.0; UNITS];
        let last = forwards.last().map_or(none, |step| step.state);
        let first = backwards.first().map_or(none, |step| step.state);
        let joined = [&forwards[at].state[..], &backwards[at].state, &last, &first, own].concat();
        let mut hidden: [f32; HIDDEN] = self.part(8).try_into().unwrap_or([0.0; HIDDEN]);
        apply(&mut hidden, &joined, self.part(7));
        hidden.iter_mut().for_each(|it| *it = it.max(0.0));
        let mut sums: [f32; 3] = self.part(10).try_into().unwrap_or([0.0; 3]);
        apply(&mut sums, &hidden, self.part(9));
        Stated { joined, hidden, sums }
    }

    /// Returns the sums of wanted, denied and neither of each value word.
    pub fn sums(&self, sequence: &Sequence) -> Vec<[f32; 3]> {
        let inputs: Vec<_> = sequence.elements.iter().map(|rows| self.embedded(rows)).collect();
        let (forwards, backwards) = (self.steps(&inputs, 0), self.steps(&inputs, 1));
        let sums = |(at, rows): &(usize, Vec<u32>)| {
            self.stated(&forwards, &backwards, *at, &self.embedded(rows)).sums
        };
        sequence.values.iter().map(sums).collect()
    }
}

/// Adds a vector, times a factor.
pub fn add(to: &mut [f32], factor: f32, vector: &[f32]) {
    to.iter_mut().zip(vector).for_each(|(to, it)| *to += factor * it);
}

/// Adds the product of inputs and weights, whose rows are by input.
fn apply(to: &mut [f32], inputs: &[f32], weights: &[f32]) {
    for (input, weights) in inputs.iter().zip(weights.chunks_exact(to.len())) {
        add(to, *input, weights);
    }
}

/// Hyperbolic tangent, to within 0.03: a fraction that reaches 1 at 3.
fn tanh(x: f32) -> f32 {
    let x = x.clamp(-3.0, 3.0);
    x * (27.0 + x * x) / (27.0 + 9.0 * x * x)
}

fn sigmoid(x: f32) -> f32 {
    0.5 + 0.5 * tanh(0.5 * x)
}
