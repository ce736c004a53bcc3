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
    /// The value of every block; `None` for the block of classes that lack the attribute, and for
    /// that of what is not here.
    pub(crate) values: Vec<Option<ValueId>>,
    /// The block of what is not here.
    pub(crate) unknown: Option<Unknown>,
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
        let mut blocks = Vec::with_capacity(classes.len());
        for object in classes {
            let entry = model.column(k)[object.index()];
            let place = match entry {
                Model::LACKS => model.values(k),
                Model::UNKNOWN => model.values(k) + 1,
                value => usize::from(value),
            };
            let block = *block_of[place].get_or_insert_with(|| {
                values.push((entry < Model::UNKNOWN).then_some(ValueId(entry)));
                (values.len() - 1) as u16
            });
            blocks.push(block);
        }
        if values.len() < 2 {
            return None;
        }
        let lacking = values.contains(&None);
        let named = values.iter().flatten().count();
        let absent = model.values(k) - named;
        let unknown = block_of[model.values(k) + 1];
        let unknown = unknown.map(|block| Unknown { block, yes: model.unknown_yes(k) });
        let open = Channel::open(problem, k, named, absent, lacking);
        let is = |value: &Option<ValueId>| {
            value.map_or(Question::None, |value| Question::Attribute(k, value))
        };
        let yes_no = Channels::yes_no(problem, problem.costs.attribute_s, values.iter().map(is));
        Some(Self { attribute: k, blocks, values, unknown, yes_no, open })
    }

    /// Whether classes in that block have no value to be named.
    pub(super) fn lacks(&self, block: u16) -> bool {
        self.values[usize::from(block)].is_none()
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
        self.values.len() == 2
            && self.named().count() == 2
            && self.open.own == self.yes_no.of(0).own
    }

    /// Equal for partitions whose open questions have the same answers for every class.
    pub(super) fn identity(&self) -> (Vec<u16>, Vec<u16>, [u64; 3]) {
        let answers = [self.open.other, self.open.lacking, self.open.absent_other];
        (self.blocks.clone(), self.named().collect(), answers.map(f64::to_bits))
    }
}
