//! One step ahead from a belief: the value of every question, from one pass over the belief per
//! attribute.
//!
//! Each attribute's blocks collect the properties of their classes that the bounds need. A
//! question's answers weigh whole blocks, so the beliefs after them never have to be written down.

use std::ops::Range;

use super::announced::Announced;
use super::block::{Block, TwoGreatest};
use super::bound::{Bound, Summary, Value};
use super::channel::{Channel, Price, Query};
use super::partition::Offer;
use super::reduced::Reduced;

/// A belief seen one step ahead.
#[derive(Clone, Debug)]
pub(crate) struct OneStepLookahead {
    /// Value without looking ahead.
    pub(crate) value: Value,
    /// Value of the better of waiting and a pick that is final.
    pub(crate) stop: f64,
    /// Class of the pick in `stop`.
    pub(crate) class: usize,
    /// Entropy over classes, nats.
    pub(crate) entropy: f64,
    /// Probability of the most probable class.
    pub(crate) peak: f64,
    /// Every informative question, except for pointing at improbable classes.
    pub(crate) choices: Vec<Choice>,
    /// Picks that can be denied, except for improbable classes; empty if picks are final.
    pub(crate) picks: Vec<AnnouncedPick>,
    /// Upper bound on the questions and picks that are not among these.
    pub(crate) rest: f64,
}

/// An announced pick as it looks from one step ahead.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnnouncedPick {
    pub(crate) class: u32,
    pub(crate) price: Price,
    pub(crate) value: Value,
}

/// A question as it looks from one step ahead.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) query: Query,
    pub(crate) value: Value,
    /// Expected information of an answer, nats.
    pub(crate) information: f64,
}

/// Most classes examined for pointing or announcing: the most probable ones are most informative.
const LIKELIEST_MAX: usize = 24;

/// Looks one step ahead from beliefs about one reduced problem.
#[derive(Debug)]
pub(crate) struct OneStepEvaluator<'a> {
    reduced: &'a Reduced,
    bound: &'a Bound,
    /// Share and worth of every class, if all classes have the same.
    alike: Option<(f64, f64)>,
    classes: Vec<Block>,
    all: Block,
    /// Block of the absent object; empty if the model takes everything to be here.
    absent: Block,
    entropy: f64,
}

impl<'a> OneStepEvaluator<'a> {
    pub(crate) fn new(reduced: &'a Reduced, bound: &'a Bound) -> Self {
        let first = reduced.share[0];
        let alike = reduced.share.iter().all(|share| *share == first);
        let alike = (alike && reduced.doubles.is_empty()).then(|| (first, bound.worth[0]));
        let (classes, all, absent) = (Vec::new(), Block::default(), Block::default());
        Self { reduced, bound, alike, classes, all, absent, entropy: 0.0 }
    }

    /// Looks one step ahead from a belief over the classes.
    pub(crate) fn look_ahead(&mut self, mass: &[f64]) -> OneStepLookahead {
        let (share, worth) = (&self.reduced.share, &self.bound.worth);
        self.classes.clear();
        self.classes.extend((0..mass.len()).map(|c| Block::class(mass[c], share[c], worth[c])));
        self.group_doubles(mass);
        self.all = self.classes.iter().fold(Block::default(), |sum, block| sum.plus(block));
        self.absent = self.reduced.absent.map_or(Block::default(), |class| self.classes[class]);
        let summary = self.all.summary();
        self.entropy = summary.entropy;
        let value = self.bound.value(&summary);
        let (stop, class) = self.stop(&value);
        let mut choices = Vec::with_capacity(self.reduced.queries.len());
        self.ask_about_attributes(&mut choices);
        let unpointed = self.point(mass, &mut choices);
        let (picks, unannounced) = self.announce(mass);
        OneStepLookahead {
            value,
            stop,
            class,
            entropy: summary.entropy,
            peak: summary.peak,
            choices,
            picks,
            rest: unpointed.max(unannounced),
        }
    }

    /// Counts classes that only announcing distinguishes as one: each has its part of their joint
    /// bound.
    fn group_doubles(&mut self, mass: &[f64]) {
        let Some(announced) = &self.reduced.announced else { return };
        for run in &self.reduced.doubles {
            let together: f64 = mass[run.clone()].iter().sum();
            if together <= 0.0 {
                continue;
            }
            let worth = announced.among(&mass[run.clone()]) / together;
            for class in &mut self.classes[run.clone()] {
                (class.log, class.worth) = (class.mass * together.ln(), class.mass * worth);
            }
        }
    }

    /// The best move that ends the dialogue, and the class to pick. If picks are announced, only
    /// the conclusion that the object is absent is final.
    fn stop(&self, value: &Value) -> (f64, usize) {
        if self.reduced.announced.is_none() {
            let likeliest = self.classes.iter().position(|class| class.top >= self.all.top);
            return (value.lower, likeliest.unwrap_or(0));
        }
        let costs = &self.bound.costs;
        let concluded = self.reduced.absent.map(|class| costs.pick_value(self.classes[class].top));
        let stop = concluded.unwrap_or(f64::NEG_INFINITY).max(costs.wait_value());
        (stop, self.reduced.absent.unwrap_or(0))
    }

    fn ask_about_attributes(&self, choices: &mut Vec<Choice>) {
        let mut collected = None;
        let mut blocks = Vec::new();
        let mut greatest = TwoGreatest::default();
        let mut here = Block::default();
        for &query in &self.reduced.queries {
            let (Query::Is { partition, .. }
            | Query::Which { partition }
            | Query::Choice { partition, .. }) = query
            else {
                continue;
            };
            let unknown = self.reduced.partition(partition).unknown;
            if collected != Some(partition) {
                collected = Some(partition);
                self.collect(partition, &mut blocks);
                let unknown = unknown.map(|unknown| usize::from(unknown.block));
                let others = blocks.iter().enumerate().filter(|(block, _)| Some(*block) != unknown);
                greatest = TwoGreatest::of(others.map(|(_, sum)| sum));
                here = self.all.without(&self.absent, greatest.but(&Block::default()));
            }
            let in_doubt = !self.reduced.partition(partition).doubtful.is_empty();
            choices.push(match query {
                query if in_doubt => self.doubtful(query, partition, &blocks),
                Query::Is { block, .. } => {
                    let yes = &blocks[usize::from(block)];
                    let no = here.without(yes, greatest.but(yes));
                    let unknown = unknown.map_or(0.0, |unknown| unknown.yes);
                    self.yes_no(query, yes, &no, unknown)
                }
                Query::Choice { offer, .. } => {
                    let offer = self.reduced.partition(partition).offer_at(offer);
                    self.choose(query, offer, &blocks, unknown.map(|unknown| unknown.block))
                }
                _ => self.open(query, partition, &blocks),
            });
        }
    }

    /// Sums the classes of every block of a partition: the inner loop of all planning.
    fn collect(&self, partition: u16, blocks: &mut Vec<Block>) {
        let partition = self.reduced.partition(partition);
        blocks.clear();
        blocks.resize(partition.values.len(), Block::default());
        let classes = partition.blocks.iter().zip(&self.classes);
        let Some((share, worth)) = self.alike else {
            return classes.for_each(|(block, class)| {
                let sum = &mut blocks[usize::from(*block)];
                *sum = sum.plus(class);
            });
        };
        for (block, class) in classes {
            let sum = &mut blocks[usize::from(*block)];
            sum.mass += class.mass;
            sum.log += class.log;
            sum.peak = if class.mass > sum.peak { class.mass } else { sum.peak };
        }
        for sum in blocks {
            sum.worth = sum.mass * worth;
            sum.top = sum.peak * share;
        }
    }

    /// A question to which some classes say yes and some no, and the absent object yes with
    /// probability `unknown`.
    fn yes_no(&self, query: Query, yes: &Block, no: &Block, unknown: f64) -> Choice {
        let channel = self.reduced.channel(query);
        let mut outlook = Outlook::new(self.bound);
        for (is, not, unsure) in
            [(channel.own, channel.other, unknown), (channel.other, channel.own, 1.0 - unknown)]
        {
            let heard = yes.weigh(is).plus(&no.weigh(not));
            outlook.add(&heard.plus(&self.absent.weigh(unsure)));
        }
        outlook.choice(query, channel, self.entropy)
    }

    /// A question about an attribute whose value is in doubt of some classes: every answer weighs
    /// every block.
    fn doubtful(&self, query: Query, partition: u16, blocks: &[Block]) -> Choice {
        let channel = self.reduced.channel(query);
        let partition = self.reduced.partition(partition);
        let mut outlook = Outlook::new(self.bound);
        let mut add = |probability: &dyn Fn(u16) -> f64| {
            let weighed = (0..).zip(blocks).map(|(block, sum)| sum.weigh(probability(block)));
            outlook.add(&weighed.fold(Block::default(), |sum, block| sum.plus(&block)));
        };
        match query {
            Query::Is { block: asked, .. } => {
                for heard in [(channel.own, channel.other), (channel.other, channel.own)] {
                    add(&|block| partition.answer(asked, block, heard));
                }
            }
            Query::Choice { offer, .. } => {
                let offer = partition.offer_at(offer);
                offer.answers().for_each(|of| add(&|block| partition.chooses(offer, of, block)));
                if channel.absent_other > 0.0 {
                    add(&|block| partition.chooses_absent(offer, block));
                }
            }
            _ => {
                partition.named().for_each(|named| add(&|block| partition.names(named, block)));
                if channel.absent_other > 0.0 {
                    add(&|block| partition.names_absent(block));
                }
            }
        }
        outlook.choice(query, channel, self.entropy)
    }

    /// A choice among some blocks; the absent object is in the block `unknown`.
    fn choose(
        &self,
        query: Query,
        offer: &Offer,
        blocks: &[Block],
        unknown: Option<u16>,
    ) -> Choice {
        let channel = &offer.channel;
        let mut groups: Vec<Block> =
            offer.blocks.iter().map(|of| blocks[usize::from(*of)]).collect();
        if offer.neither {
            let left = (0..)
                .zip(blocks)
                .filter(|(block, _)| !offer.blocks.contains(block) && Some(*block) != unknown);
            groups.push(left.fold(Block::default(), |sum, (_, block)| sum.plus(block)));
        }
        let greatest = TwoGreatest::of(groups.iter());
        let all = groups.iter().fold(Block::default(), |sum, group| sum.plus(group));
        let mut outlook = Outlook::new(self.bound);
        for own in &groups {
            let others = all.without(own, greatest.but(own));
            let heard = own.weigh(channel.own).plus(&others.weigh(channel.other));
            outlook.add(&heard.plus(&self.absent.weigh(channel.lacking)));
        }
        if channel.absent_other > 0.0 {
            let heard = all.weigh(channel.absent_other);
            outlook.add(&heard.plus(&self.absent.weigh(channel.absent_lacking)));
        }
        outlook.choice(query, channel, self.entropy)
    }

    fn open(&self, query: Query, partition: u16, blocks: &[Block]) -> Choice {
        let partition = self.reduced.partition(partition);
        let channel = &partition.open;
        let named = || partition.named().map(|block| &blocks[usize::from(block)]);
        let lacking = (0..blocks.len()).filter(|block| partition.values[*block].is_none());
        let lack = lacking.fold(Block::default(), |sum, block| sum.plus(&blocks[block]));
        let greatest = TwoGreatest::of(named());
        // No block is greater than all of them, so nothing is left out of the maxima here.
        let having = self.all.without(&lack, greatest.but(&Block::default()));
        let mut outlook = Outlook::new(self.bound);
        for own in named() {
            let others = having.without(own, greatest.but(own));
            let heard = own.weigh(channel.own).plus(&others.weigh(channel.other));
            outlook.add(&heard.plus(&lack.weigh(channel.lacking)));
        }
        if channel.absent_other > 0.0 {
            let heard = having.weigh(channel.absent_other);
            outlook.add(&heard.plus(&lack.weigh(channel.absent_lacking)));
        }
        outlook.choice(query, channel, self.entropy)
    }

    /// Pointing questions at the most probable classes, and an upper bound on the others: a user
    /// who points at a less probable class learns less than by pointing at the last of these.
    fn point(&self, mass: &[f64], choices: &mut Vec<Choice>) -> f64 {
        let (pointed, more) = self.likeliest(self.reduced.pointed.clone(), mass);
        let (here, greatest) = self.here();
        for class in pointed {
            let yes = &self.classes[class as usize];
            let no = here.without(yes, greatest.but(yes));
            choices.push(self.yes_no(
                Query::Point { class },
                yes,
                &no,
                self.reduced.point.of(class as usize).other,
            ));
        }
        let last = choices.last().filter(|_| more);
        last.map_or(f64::NEG_INFINITY, |last| {
            let informed = self.bound.informed(&self.all.summary(), last.information);
            self.reduced.cheapest_pointing().price.pay(informed)
        })
    }

    /// Announced picks of the most probable classes, and an upper bound on the others: the value of
    /// announcing a less probable one is linear in its probability, whatever follows a denial.
    fn announce(&self, mass: &[f64]) -> (Vec<AnnouncedPick>, f64) {
        let Some(announced) = &self.reduced.announced else {
            return (Vec::new(), f64::NEG_INFINITY);
        };
        let objects = (0..mass.len()).filter(|class| Some(*class) != self.reduced.absent);
        let (classes, more) = self.likeliest(objects.map(|class| class as u32).collect(), mass);
        let pick = |class: &u32| {
            let (price, _) = announced.price(mass[*class as usize]);
            let mut denied = Outlook::new(self.bound);
            denied.add(&self.after_denial(announced, *class as usize, mass));
            AnnouncedPick { class: *class, price, value: denied.value.pay(&price) }
        };
        let picks = classes.iter().map(pick).collect();
        let last = classes.last().filter(|_| more).map(|class| mass[*class as usize]);
        let rest = last.map_or(f64::NEG_INFINITY, |last| {
            let value = |right: f64| announced.value(right, self.bound.ceiling());
            value(0.0).max(value(last))
        });
        (picks, rest)
    }

    /// Sums over the classes after the denial of one of them.
    fn after_denial(&self, announced: &Announced, class: usize, mass: &[f64]) -> Block {
        let is_of = |run: &&Range<usize>| run.contains(&class);
        let run = self.reduced.doubles.iter().find(is_of).cloned().unwrap_or(class..class + 1);
        let others = self.classes.iter().enumerate().filter(|(c, _)| !run.contains(c));
        let others = others.fold(Block::default(), |sum, (_, block)| sum.plus(block));
        let weigh = |c: usize| if c == class { announced.own } else { announced.other };
        if run.len() == 1 {
            return self.classes[class].weigh(announced.own).plus(&others.weigh(announced.other));
        }
        let group: Vec<f64> = run.map(|c| weigh(c) * mass[c]).collect();
        let peak = group.iter().copied().fold(0.0, f64::max);
        let together: f64 = group.iter().sum();
        let group = Block {
            worth: announced.among(&group),
            peak,
            top: peak,
            ..Block::class(together, 1.0, 0.0)
        };
        group.plus(&others.weigh(announced.other))
    }

    /// The most probable of some classes, those that cost less to point at first among equals, and
    /// whether there are more.
    fn likeliest(&self, mut classes: Vec<u32>, mass: &[f64]) -> (Vec<u32>, bool) {
        let more = classes.len() > LIKELIEST_MAX;
        let cost = |class: &u32| self.reduced.point.of(*class as usize).cost;
        let rank = |a: &u32, b: &u32| {
            let likelier = mass[*b as usize].total_cmp(&mass[*a as usize]);
            likelier.then_with(|| cost(a).total_cmp(&cost(b))).then(a.cmp(b))
        };
        if more {
            classes.select_nth_unstable_by(LIKELIEST_MAX, rank);
            classes.truncate(LIKELIEST_MAX);
        }
        classes.sort_unstable_by(rank);
        classes.dedup_by(|next, kept| self.reduced.interchange(*next, *kept, mass));
        (classes, more)
    }

    /// Sums over present objects, and the greatest probabilities among them.
    fn here(&self) -> (Block, TwoGreatest) {
        let here = self.classes.iter().enumerate().filter(|(c, _)| Some(*c) != self.reduced.absent);
        let greatest = TwoGreatest::of(here.map(|(_, class)| class));
        (self.all.without(&self.absent, greatest.but(&Block::default())), greatest)
    }
}

/// Expected belief after an answer.
struct Outlook<'a> {
    bound: &'a Bound,
    value: Value,
    entropy: f64,
}

impl<'a> Outlook<'a> {
    fn new(bound: &'a Bound) -> Self {
        Self { bound, value: Value::default(), entropy: 0.0 }
    }

    fn add(&mut self, heard: &Block) {
        let belief: Summary = heard.summary();
        self.value.add(heard.mass, &self.bound.value(&belief));
        self.entropy += heard.mass * belief.entropy;
    }

    fn choice(self, query: Query, channel: &Channel, entropy: f64) -> Choice {
        let value = self.value.pay(&channel.price);
        Choice { query, value, information: (entropy - self.entropy).max(0.0) }
    }
}
