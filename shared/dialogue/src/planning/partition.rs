//! An attribute, as a partition of the classes.

use scene::{AttributeId, ObjectId, Options, Question, ValueId};

use super::channel::{Channel, Channels};
use crate::decision::choices;
use crate::{DecisionProblem, Model, Naming};

/// An attribute that distinguishes classes: those of one block have the same value.
#[derive(Debug)]
pub(crate) struct Partition {
    pub(crate) attribute: AttributeId,
    /// The block of every class.
    pub(crate) blocks: Vec<u16>,
    /// The value of every block; `None` for the block of classes that lack the attribute, for that
    /// of the absent object, and for classes whose value is in doubt.
    pub(crate) values: Vec<Option<ValueId>>,
    /// Block of the absent object.
    pub(crate) unknown: Option<Unknown>,
    /// For every block of classes whose value is in doubt the probability of each block's value;
    /// empty without such blocks.
    pub(crate) doubtful: Vec<Option<Vec<f64>>>,
    /// How "is its k v?" is answered, per block.
    pub(crate) yes_no: Channels,
    /// How "what is its k?" is answered.
    pub(crate) open: Channel,
    /// The choices that may be asked.
    pub(crate) offers: Vec<Offer>,
}

/// A choice among the values of some blocks.
#[derive(Debug)]
pub(crate) struct Offer {
    pub(crate) options: Options,
    pub(crate) blocks: Vec<u16>,
    /// Whether "none of these" may be true of a class.
    pub(crate) neither: bool,
    pub(crate) channel: Channel,
}

impl Offer {
    /// The answers that may be true of a class: each option's block, and "none of them".
    pub(super) fn answers(&self) -> impl Iterator<Item = Option<u16>> {
        self.blocks.iter().copied().map(Some).chain(self.neither.then_some(None))
    }
}

/// Answers to "is its k v?" about a wanted object that is not here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unknown {
    pub(crate) block: u16,
    /// Probability of yes, given an answer.
    pub(crate) yes: f64,
}

impl Unknown {
    /// Probability of the given answer.
    pub(super) fn probability(&self, yes: bool) -> f64 {
        if yes { self.yes } else { 1.0 - self.yes }
    }
}

impl Partition {
    /// The partition that an attribute makes of classes, each represented by one object; `None` if
    /// it separates nothing.
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
        // Values that only classes in doubt may have can be asked about as well.
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
        let which = Question::Which(k);
        let law = Naming::of(model, which)?;
        let open = Channel::naming(problem, which, &law, (named, absent), lacking);
        let is = |value: &Option<ValueId>| {
            value.map_or(Question::None, |value| Question::Attribute(k, value))
        };
        let yes_no = Channels::yes_no(problem, problem.costs.attribute_s, values.iter().map(is));
        let offers = Vec::new();
        Some(Self { attribute: k, blocks, values, unknown, doubtful, yes_no, open, offers })
    }

    /// The partition with the choices among its values of greatest probability.
    pub(super) fn with_offers(mut self, problem: &DecisionProblem<'_>, mass: &[f64]) -> Self {
        let mut sums = vec![0.0; self.values.len()];
        for (&block, mass) in self.blocks.iter().zip(mass) {
            match self.chances(block) {
                Some(chances) => sums.iter_mut().zip(chances).for_each(|(sum, p)| *sum += p * mass),
                None => sums[usize::from(block)] += mass,
            }
        }
        let mut named: Vec<usize> = self.named().map(usize::from).collect();
        named.sort_by(|a, b| sums[*b].total_cmp(&sums[*a]));
        let values: Vec<ValueId> = named.into_iter().filter_map(|at| self.values[at]).collect();
        let offers = choices(&values).filter_map(|options| self.offer(problem, options));
        self.offers = offers.collect();
        self
    }

    pub(super) fn offer_at(&self, offer: u16) -> &Offer {
        &self.offers[usize::from(offer)]
    }

    fn offer(&self, problem: &DecisionProblem<'_>, options: Options) -> Option<Offer> {
        let question = Question::Choice(self.attribute, options);
        let law = Naming::of(problem.model, question)?;
        let of = |v: &ValueId| self.values.iter().position(|value| *value == Some(*v));
        let blocks = options.values().iter().map(|v| of(v).map(|at| at as u16));
        let blocks: Vec<u16> = blocks.collect::<Option<_>>()?;
        let unknown = self.unknown.map(|unknown| unknown.block);
        let is_neither = |block: u16| {
            let chance: f64 = blocks.iter().map(|of| self.chance(block, *of)).sum();
            Some(block) != unknown && chance < 1.0
        };
        let neither = law.neither && self.blocks.iter().any(|block| is_neither(*block));
        let named = blocks.len() + usize::from(neither);
        let counts = (named, law.answers - named);
        let channel = Channel::naming(problem, question, &law, counts, unknown.is_some());
        Some(Offer { options, blocks, neither, channel })
    }

    /// Probability of choosing that block's value, or no option, about classes in `block`.
    pub(super) fn chooses(&self, offer: &Offer, chosen: Option<u16>, block: u16) -> f64 {
        if self.unknown.is_some_and(|unknown| unknown.block == block) {
            return offer.channel.lacking;
        }
        let chance = |of: &u16| self.chance(block, *of);
        let chance = match chosen {
            Some(of) => chance(&of),
            None => 1.0 - offer.blocks.iter().map(chance).sum::<f64>(),
        };
        chance * offer.channel.own + (1.0 - chance) * offer.channel.other
    }

    /// Probability of an answer to a choice that is true of no class, about classes in `block`.
    pub(super) fn chooses_absent(&self, offer: &Offer, block: u16) -> f64 {
        let is_unknown = self.unknown.is_some_and(|unknown| unknown.block == block);
        if is_unknown { offer.channel.absent_lacking } else { offer.channel.absent_other }
    }

    /// Code that distinguishes choices with different answers about a class, given the classes'
    /// codes; `None` if a value is in doubt.
    pub(super) fn choice_code(&self, offer: &Offer, codes: &[u64]) -> Option<Vec<u64>> {
        if !self.doubtful.is_empty() {
            return None;
        }
        let mut sets = vec![0; offer.answers().count()];
        for (block, code) in self.blocks.iter().zip(codes) {
            if self.unknown.is_none_or(|unknown| unknown.block != *block) {
                let at = offer.answers().position(|of| of.is_none_or(|of| of == *block))?;
                sets[at] ^= code;
            }
        }
        sets.sort_unstable();
        let Channel { price, own, other, lacking, .. } = offer.channel;
        sets.extend([price.times, own, other, lacking].map(f64::to_bits));
        Some(sets)
    }

    /// Whether a choice is no more informative than a yes/no question that costs no more.
    pub(super) fn is_plain(&self, offer: &Offer) -> bool {
        let two = self.doubtful.is_empty() && self.unknown.is_none();
        let mut plainly = offer.blocks.iter().map(|block| self.yes_no.of(usize::from(*block)));
        two && offer.answers().count() == 2
            && plainly.any(|yes_no| {
                yes_no.cost <= offer.channel.cost
                    && yes_no.other <= offer.channel.other
                    && yes_no.price.times <= offer.channel.price.times
            })
    }

    /// Whether classes in that block have no value to be named.
    pub(super) fn lacks(&self, block: u16) -> bool {
        self.values[usize::from(block)].is_none()
    }

    /// Probability that classes in a block have the value of another one: neither 0 nor 1 if it is
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

    /// Number of blocks and classes weighed for every question about the attribute: the classes are
    /// summed into blocks once, and if a value is in doubt, every answer weighs every block.
    pub(super) fn work(&self) -> usize {
        let (values, blocks) = (self.named().count(), self.values.len());
        // Yes and no to each value, each value by its name, and another one.
        let answers = if self.doubtful.is_empty() { 0 } else { 3 * values + 1 };
        self.blocks.len() + answers * blocks
    }

    /// Work to judge a choice: weighing a block takes as long as looking at four classes.
    pub(super) fn offer_work(&self, offer: &Offer) -> usize {
        let answers = if self.doubtful.is_empty() { 1 } else { offer.answers().count() };
        4 * (answers * self.values.len() + offer.blocks.len())
    }

    /// Probability of yes, or no, to "is it in the block `asked`?" about classes in `block`; `is`
    /// and `not` are the probabilities of that answer if it is and if it is not.
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

    /// Distinguishes questions about the same blocks with different answers about classes in doubt.
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

    /// Whether its open question is informative: not if there is one value to name.
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
