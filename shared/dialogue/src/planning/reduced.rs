//! The decision problem at one belief, without everything that cannot matter.
//!
//! Objects of negligible probability are left out; objects that no question can distinguish become
//! one class; questions with the same answers for every class are asked in the cheapest way only;
//! silence, which leaves the belief as it is, is folded into the price of a question.

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

use scene::{AttributeId, ObjectId, Question, ValueId};
use vocabulary::Rng;

use super::announced::Announced;
use super::channel::{Channel, Channels, Query};
use super::equivalence_classes::EquivalenceClasses;
use super::partition::Partition;
use crate::{Belief, DecisionProblem};

/// Equivalence classes of objects and the questions that distinguish them.
#[derive(Debug)]
pub(crate) struct Reduced {
    /// Probability of each class; sums to 1.
    pub(crate) mass: Vec<f64>,
    /// The most probable object of each class.
    pub(crate) best: Vec<ObjectId>,
    /// Constant share of that object in its class: no question can change it.
    pub(crate) share: Vec<f64>,
    /// Attributes that distinguish classes.
    pub(crate) partitions: Vec<Partition>,
    /// Yes/no, open and choice questions about attributes, none the double of another; those about
    /// one attribute together.
    pub(crate) queries: Vec<Query>,
    /// Class of the absent object.
    pub(crate) absent: Option<usize>,
    /// Classes that are worth pointing at.
    pub(crate) pointed: Vec<u32>,
    /// How a pointing question is answered, per class.
    pub(crate) point: Channels,
    /// Reward of announcing a pick; `None` if picks are final.
    pub(crate) announced: Option<Announced>,
    /// Runs of classes that only announcing one distinguishes.
    pub(crate) doubles: Vec<Range<usize>>,
    /// Runs of classes that only pointing, or announcing one, distinguishes, each at the same
    /// price, so that the problem is the same however their probabilities are permuted. Each run is
    /// in order of falling probability.
    pub(crate) interchangeable: Vec<Range<usize>>,
}

impl Reduced {
    /// Reduces the problem at the given belief.
    ///
    /// # Panics
    /// If the belief is not about the problem's scene.
    pub(crate) fn new(problem: &DecisionProblem<'_>, belief: &Belief) -> Self {
        let model = problem.model;
        assert_eq!(belief.len(), model.hypotheses(), "belief and model are of one scene");
        let EquivalenceClasses { mass, best, share, interchangeable } =
            EquivalenceClasses::of(problem, belief);
        let asked = if problem.actions.about_attributes() { model.attributes() } else { 0 };
        let asked = (0..asked).map(AttributeId::from).filter(|k| !problem.concessions.bar(*k));
        let partitions = asked.filter_map(|k| Partition::of(problem, k, &best));
        let partitions = partitions.map(|partition| match problem.actions.choice {
            true => partition.with_offers(problem, &mass),
            false => partition,
        });
        let partitions = partitions.collect();
        let point_at = best.iter().map(|object| Question::Point(*object));
        let point = Channels::yes_no(problem, problem.costs.point_s, point_at);
        let absent = best.iter().position(|object| Some(*object) == model.absent());
        let (queries, pointed) = (Vec::new(), Vec::new());
        let mut reduced = Self {
            mass,
            best,
            share,
            partitions,
            queries,
            absent,
            pointed,
            point,
            announced: Announced::of(problem),
            doubles: Vec::new(),
            interchangeable,
        };
        if reduced.announced.is_some() && !problem.actions.point() {
            reduced.doubles.clone_from(&reduced.interchangeable);
        }
        reduced.find_questions(problem);
        reduced
    }

    /// Number of classes.
    pub(crate) fn classes(&self) -> usize {
        self.mass.len()
    }

    /// Number of groups of classes that questions can distinguish.
    pub(crate) fn groups(&self) -> usize {
        self.classes() - self.doubles.iter().map(|run| run.len() - 1).sum::<usize>()
    }

    /// Work of a look one step ahead, in classes looked at times attributes, and in blocks weighed.
    pub(crate) fn work(&self) -> usize {
        let offered = self.queries.iter().map(|query| match *query {
            Query::Choice { partition, offer } => {
                let partition = self.partition(partition);
                partition.offer_work(partition.offer_at(offer))
            }
            _ => 0,
        });
        let attributes = self.partitions.iter().map(Partition::work);
        2 * self.classes() + attributes.sum::<usize>() + offered.sum::<usize>()
    }

    /// The scene's question for a query.
    pub(crate) fn question(&self, query: Query) -> Question {
        match query {
            Query::Point { class } => Question::Point(self.best[class as usize]),
            Query::Which { partition } => Question::Which(self.partition(partition).attribute),
            Query::Choice { partition, offer } => {
                let partition = self.partition(partition);
                Question::Choice(partition.attribute, partition.offer_at(offer).options)
            }
            Query::Is { partition, block } => {
                let partition = self.partition(partition);
                let value = partition.values[usize::from(block)].unwrap_or(ValueId(0));
                Question::Attribute(partition.attribute, value)
            }
        }
    }

    /// How a query is answered.
    pub(crate) fn channel(&self, query: Query) -> &Channel {
        match query {
            Query::Point { class } => self.point.of(class as usize),
            Query::Is { partition, block } => {
                self.partition(partition).yes_no.of(usize::from(block))
            }
            Query::Which { partition } => &self.partition(partition).open,
            Query::Choice { partition, offer } => {
                &self.partition(partition).offer_at(offer).channel
            }
        }
    }

    /// Every informative question, pointing included.
    pub(crate) fn all_queries(&self) -> Vec<Query> {
        let pointed = self.pointed.iter().map(|class| Query::Point { class: *class });
        self.queries.iter().copied().chain(pointed).collect()
    }

    /// The different channels among the questions; of those that differ in price alone the
    /// cheapest, which is as good as any of them at every belief.
    pub(crate) fn channels(&self) -> Vec<Channel> {
        let point = (!self.pointed.is_empty()).then(|| *self.cheapest_pointing());
        let asked = self.queries.iter().map(|query| *self.channel(*query));
        let mut channels: Vec<Channel> = Vec::new();
        for channel in asked.chain(point) {
            match channels.iter_mut().find(|known| known.answers_like(&channel)) {
                None => channels.push(channel),
                Some(known) if channel.cost < known.cost => *known = channel,
                Some(_) => {}
            }
        }
        channels
    }

    /// The channel of the cheapest pointing question.
    pub(crate) fn cheapest_pointing(&self) -> &Channel {
        self.point.cheapest(self.pointed.iter().map(|class| *class as usize))
    }

    /// Whether pointing at one class is, but for names, the same as pointing at the other.
    pub(crate) fn interchange(&self, a: u32, b: u32, mass: &[f64]) -> bool {
        let (a, b) = (a as usize, b as usize);
        (mass[a] - mass[b]).abs() < 1e-12
            && self.interchangeable.iter().any(|run| run.contains(&a) && run.contains(&b))
    }

    pub(super) fn partition(&self, partition: u16) -> &Partition {
        &self.partitions[usize::from(partition)]
    }

    /// Collects the questions. Two yes/no questions are equal if they split the classes alike,
    /// whichever half says yes; and, if the wanted object may be absent, if an unknown value leaves
    /// the same answers open. A set of classes is identified by the exclusive or of random numbers,
    /// one per class. Of equal questions the cheapest is kept, of those the first.
    fn find_questions(&mut self, problem: &DecisionProblem<'_>) {
        let mut rng = Rng::new(0x5eed);
        let codes: Vec<u64> = self.mass.iter().map(|_| rng.next_u64()).collect();
        let everyone = codes.iter().fold(0, |all, code| all ^ code);
        let split = |set: u64| set.min(set ^ everyone);
        let (mut splits, mut open) = (Cheapest::default(), Cheapest::default());
        let mut choices = Cheapest::default();
        let mut found = Vec::new();
        // Before equal questions are reduced: a twin takes the place of one that is not asked again.
        let may = |query| problem.spent.is_empty() || !problem.is_spent(self.question(query));
        for (index, partition) in self.partitions.iter().enumerate() {
            let index = index as u16;
            let plainly = (0..partition.values.len()).map(|block| partition.yes_no.of(block).cost);
            let plain = problem.actions.attribute
                && partition.is_yes_no()
                && plainly.fold(f64::INFINITY, f64::min) <= partition.open.cost;
            let which = Query::Which { partition: index };
            if problem.actions.which && partition.tells() && !plain && may(which) {
                open.offer(partition.identity(), partition.open.cost, found.len());
                found.push(which);
            }
            if problem.actions.attribute {
                for (block, set) in partition.sets(&codes) {
                    let query = Query::Is { partition: index, block };
                    if !may(query) {
                        continue;
                    }
                    let split = match (partition.unknown, partition.doubt_code(block)) {
                        (None, 0) => split(set),
                        (unknown, doubt) => set ^ doubt ^ unknown.map_or(0, |u| u.yes.to_bits()),
                    };
                    splits.offer(split, partition.yes_no.of(usize::from(block)).cost, found.len());
                    found.push(query);
                }
            }
            for (at, offer) in (0..).zip(&partition.offers) {
                let plain = problem.actions.attribute && partition.is_plain(offer);
                let query = Query::Choice { partition: index, offer: at };
                if offer.channel.capacity > 0.0 && !plain && may(query) {
                    let code = partition.choice_code(offer, &codes);
                    let code = code.unwrap_or_else(|| vec![u64::from(index), at.into()]);
                    choices.offer(code, offer.channel.cost, found.len());
                    found.push(query);
                }
            }
        }
        self.find_pointed(problem, &codes, |code| splits.cost(&split(code)));
        let kept = splits.places().chain(open.places()).chain(choices.places());
        let mut kept: Vec<usize> = kept.collect();
        kept.sort_unstable();
        self.queries = kept.into_iter().map(|place| found[place]).collect();
    }

    /// Collects the classes to point at: each but those that a question distinguishes at no higher
    /// cost; `asked` is the cost of the question with that split.
    fn find_pointed(
        &mut self,
        problem: &DecisionProblem<'_>,
        codes: &[u64],
        asked: impl Fn(u64) -> Option<f64>,
    ) {
        if !problem.actions.point() || self.classes() < 2 {
            return;
        }
        let known = |class: usize, code: u64| {
            asked(code).is_some_and(|cost| cost <= self.point.of(class).cost)
        };
        let here = codes.iter().enumerate().filter(|(class, _)| Some(*class) != self.absent);
        let asked_enough = |class: usize| problem.is_spent(Question::Point(self.best[class]));
        let pointed = here.filter(|(class, code)| !known(*class, **code) && !asked_enough(*class));
        self.pointed = pointed.map(|(class, _)| class as u32).collect();
    }
}

/// The cheapest of the questions that are equal, with its place among all of them.
struct Cheapest<K>(HashMap<K, (f64, usize)>);

impl<K> Default for Cheapest<K> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Eq + Hash> Cheapest<K> {
    fn offer(&mut self, key: K, cost: f64, place: usize) {
        let best = self.0.entry(key).or_insert((cost, place));
        if cost < best.0 {
            *best = (cost, place);
        }
    }

    fn cost(&self, key: &K) -> Option<f64> {
        self.0.get(key).map(|(cost, _)| *cost)
    }

    fn places(&self) -> impl Iterator<Item = usize> {
        self.0.values().map(|(_, place)| *place)
    }
}
