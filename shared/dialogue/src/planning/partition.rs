//! An attribute, as a partition of the classes.

use scene::{AttributeId, ObjectId, Question, ValueId};

use super::channel::{Channel, Channels};
use crate::{DecisionProblem, Model};

/// An attribute that tells classes apart: those of one block have the same value.
#[derive(Debug)]
pub(crate) struct Partition {
    pub(crate) attribute: AttributeId,
    /// The block of every class.
    pub(crate) blocks: Vec<u16>,
    /// The value of every block; `None` for the block of classes that lack the attribute, for that of
    /// what is not here, and for classes whose value is in doubt.
    pub(crate) values: Vec<Option<ValueId>>,
    /// The block of what is not here.
    pub(crate) unknown: Option<Unknown>,
    /// For every block of classes whose value is in doubt the probability of each block's value; empty where
    /// there is no such block.
    pub(crate) doubtful: Vec<Option<Vec<f64>>>,
    /// How "is its k v?" is answered, per block.
    pub(crate) yes_no: Channels,
    /// How "what is its k?" is answered.
    pub(crate) open: Channel,
}

/// Answers to "is its k v?" about a wanted object that is not here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unknown {
    pub(crate) block: u16,
    /// Probability of yes, given an answer.
    pub(crate) yes: f64,
}

impl Unknown {
    /// Probability of that answer.
    pub(super) fn probability(&self, yes: bool) -> f64 {
        if yes { self.yes } else { 1.0 - self.yes }
    }
}

impl Partition {
    /// The partition that an attribute makes of classes, of each of which one object is given;
    /// none if it separates nothing.
    pub(super) fn of(
        problem: &DecisionProblem<'_>,
        k: AttributeId,
        classes: &[ObjectId],
    ) -> Option<Self> {
        let model = problem.model;
        let mut block_of = vec![None; model.values(k) + 2];
        let mut values = Vec::new();
        let mut entries = Vec::new();
        let mut blocks = Vec::with_capacity(classes.len());
        for object in classes {
            let entry = model.column(k)[object.index()];
            let place = match entry {
                Model::LACKS => model.values(k),
                Model::UNKNOWN => model.values(k) + 1,
                value if value < Model::DOUBTFUL => usize::from(value),
                doubt => model.values(k) + 2 + usize::from(doubt - Model::DOUBTFUL),
            };
            if place >= block_of.len() {
                block_of.resize(place + 1, None);
            }
            let block = *block_of[place].get_or_insert_with(|| {
                values.push((entry < Model::DOUBTFUL).then_some(ValueId(entry)));
                entries.push(entry);
                (values.len() - 1) as u16
            });
            blocks.push(block);
        }
        let in_doubt = |entry: &u16| model.chances(k, *entry);
        // What only classes in doubt may have can be asked about as well.
        for (v, block) in block_of.iter_mut().enumerate().take(model.values(k)) {
            if block.is_none()
                && entries.iter().filter_map(in_doubt).any(|chances| chances[v] > 0.0)
            {
                *block = Some(values.len() as u16);
                values.push(Some(ValueId::from(v)));
            }
        }
        let mut doubtful: Vec<Option<Vec<f64>>> = (entries.iter())
            .map(|entry| {
                let chances = in_doubt(entry)?;
                let of = |value: &Option<ValueId>| value.map_or(0.0, |v| chances[v.index()]);
                Some(values.iter().map(of).collect())
            })
            .collect();
        if doubtful.iter().all(Option::is_none) {
            doubtful.clear();
        }
        if values.len() < 2 {
            return None;
        }
        let lacking = entries.iter().any(|entry| *entry >= Model::UNKNOWN);
        let named = values.iter().flatten().count();
        let absent = model.values(k) - named;
        let unknown = block_of[model.values(k) + 1];
        let unknown = unknown.map(|block| Unknown { block, yes: model.unknown_yes(k) });
        let open = Channel::open(problem, k, named, absent, lacking);
        let is = |value: &Option<ValueId>| {
            value.map_or(Question::None, |value| Question::Attribute(k, value))
        };
        let yes_no = Channels::yes_no(problem, problem.costs.attribute_s, values.iter().map(is));
        Some(Self { attribute: k, blocks, values, unknown, doubtful, yes_no, open })
    }

    /// Whether classes in that block have no value to be named.
    pub(super) fn lacks(&self, block: u16) -> bool {
        self.values[usize::from(block)].is_none()
    }

    /// Probability that classes in a block have the value of another one: neither 0 nor 1 where it is
    /// in doubt.
    pub(super) fn chance(&self, block: u16, of: u16) -> f64 {
        match self.chances(block) {
            Some(chances) => chances[usize::from(of)],
            None => f64::from(u8::from(block == of)),
        }
    }

    /// Probability of each block's value about classes in a block, if it is in doubt.
    fn chances(&self, block: u16) -> Option<&[f64]> {
        self.doubtful.get(usize::from(block))?.as_deref()
    }

    /// Number of blocks and classes that are weighed to judge every question about the attribute: the classes are
    /// summed into blocks once, and where a value is in doubt every answer weighs every block.
    pub(crate) fn work(&self) -> usize {
        let (values, blocks) = (self.named().count(), self.values.len());
        // Yes and no to each value, each value by its name, and another one.
        let answers = if self.doubtful.is_empty() { 0 } else { 3 * values + 1 };
        self.blocks.len() + answers * blocks
    }

    /// Probability of yes, or no, to "is it in the block `asked`?" about classes in `block`; `is` and `not`
    /// are those of that answer where it is and where it is not.
    pub(super) fn answer(&self, asked: u16, block: u16, (is, not): (f64, f64)) -> f64 {
        if let Some(unknown) = self.unknown.filter(|unknown| unknown.block == block) {
            return unknown.probability(is > not);
        }
        let chance = self.chance(block, asked);
        chance * is + (1.0 - chance) * not
    }

    /// Probability of naming the value of the block `named` about classes in `block`.
    pub(super) fn names(&self, named: u16, block: u16) -> f64 {
        if self.lacks(block) && !self.is_in_doubt(block) {
            return self.open.lacking;
        }
        let chance = self.chance(block, named);
        chance * self.open.own + (1.0 - chance) * self.open.other
    }

    /// Probability of naming a value that no class has about classes in `block`.
    pub(super) fn names_absent(&self, block: u16) -> f64 {
        let lacks = self.lacks(block) && !self.is_in_doubt(block);
        if lacks { self.open.absent_lacking } else { self.open.absent_other }
    }

    /// Whether the value of classes in that block is in doubt.
    pub(super) fn is_in_doubt(&self, block: u16) -> bool {
        self.chances(block).is_some()
    }

    /// Tells apart questions about the same blocks that are answered differently about classes in doubt.
    pub(super) fn doubt_code(&self, asked: u16) -> u64 {
        let code = |(place, chances): (u64, &Vec<f64>)| {
            let place = place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            chances[usize::from(asked)].to_bits().wrapping_mul(place)
        };
        let doubtful = (1..).zip(&self.doubtful).filter_map(|(n, it)| Some((n, it.as_ref()?)));
        doubtful.fold(0, |all, doubtful| all ^ code(doubtful))
    }

    /// The blocks that have a value.
    pub(super) fn named(&self) -> impl Iterator<Item = u16> {
        (0..self.values.len() as u16).filter(|block| !self.lacks(*block))
    }

    /// Every value's block, with the exclusive or of its classes' codes.
    pub(super) fn sets(&self, codes: &[u64]) -> impl Iterator<Item = (u16, u64)> {
        let mut sets = vec![0; self.values.len()];
        for (block, code) in self.blocks.iter().zip(codes) {
            sets[usize::from(*block)] ^= code;
        }
        self.named().map(move |block| (block, sets[usize::from(block)]))
    }

    /// Whether its open question tells anything: not if there is one value to name.
    pub(super) fn tells(&self) -> bool {
        self.open.capacity > 0.0
    }

    /// Whether its open question has the same answers as a yes/no question.
    pub(super) fn is_yes_no(&self) -> bool {
        self.doubtful.is_empty()
            && self.values.len() == 2
            && self.named().count() == 2
            && self.open.own == self.yes_no.of(0).own
    }

    /// Equal for partitions whose open questions have the same answers for every class.
    pub(super) fn identity(&self) -> (Vec<u16>, Vec<u16>, [u64; 3], Vec<u64>) {
        let answers = [self.open.other, self.open.lacking, self.open.absent_other];
        let doubts = self.doubtful.iter().flatten().flatten().map(|chance| chance.to_bits());
        let answers = answers.map(f64::to_bits);
        (self.blocks.clone(), self.named().collect(), answers, doubts.collect())
    }
}
