//! Truth of relations in a scene: computed from the places, sizes and masses of its objects, graded
//! by how plain it is.

use crate::{Measure, ObjectId, Placement, Relation, Scene, WordId};

/// Difference of places at which people take one side to be meant with odds of `e`, metres.
const PLACE_M: f64 = 0.02;
/// The same for sizes and masses, as the logarithm of their ratio.
const RATIO: f64 = 0.03;
/// The same for a loose comparison: "a bigger one".
const RATIO_LOOSE: f64 = 0.1;
/// Distance beyond the nearest at which "next to" is said `e` times less often, metres.
const BESIDE_M: f64 = 0.04;
/// Distance from the line between two objects that makes "between" `e` times rarer, metres.
const ASIDE_M: f64 = 0.1;

/// Truth below which a relation to another object is true of none.
const TRUE_MIN: f64 = 0.1;

/// Names of sizes, from small to large: values that have these names are ordered by them if no
/// measured size tells the objects apart.
const SIZES: [&[&str]; 5] = [
    &["tiny", "mini"],
    &["small", "little", "short", "thin", "narrow", "low"],
    &["medium", "middle", "mid-size"],
    &["big", "large", "long", "tall", "thick", "wide", "high"],
    &["huge", "giant", "gigantic", "enormous"],
];

/// Returns the rank of a value that names a size, from 0 for the smallest.
pub fn size_rank(name: &str) -> Option<usize> {
    SIZES.iter().position(|names| names.contains(&name))
}

/// Place from which left, right, in front and behind are seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum View {
    /// The robot's: along x, with y to the left.
    #[default]
    Robot,
    /// A user's at this place, metres, frame `base`, who faces the objects.
    User([f64; 3]),
}

/// Arguments of a relation: objects, reference and view.
#[derive(Clone, Copy, Debug)]
pub struct Related<'a> {
    /// Candidate objects of the relation.
    pub among: &'a [ObjectId],
    /// The objects that it relates to; of each the objects that it may be.
    pub to: &'a [Vec<ObjectId>],
    /// Viewpoint for left and right.
    pub view: View,
}

impl Scene {
    /// Returns for each object the degree to which a relation holds, from 0 to 1 for the best
    /// candidate; `None` for an object for which it is unknown. Returns `None` as a whole if the
    /// scene cannot tell: fewer than two objects have the measure, or the reference is missing.
    pub fn truths(&self, relation: Relation, about: &Related<'_>) -> Option<Vec<Option<f64>>> {
        let truths = match relation {
            Relation::Nth(measure, n) => self.ordered(measure, RATIO, about, |_| vec![n.into()]),
            Relation::Middle(measure) => self.ordered(measure, RATIO, about, middles),
            Relation::More(measure) if about.to.is_empty() => {
                self.ordered(measure, RATIO_LOOSE, about, |_| vec![1])
            }
            Relation::More(measure) => self.compared(measure, about),
            Relation::Beside => self.beside(about),
            Relation::Between => self.between(about),
        }?;
        let of = |i: &ObjectId| truths[i.index()];
        let most = about.among.iter().filter_map(of).fold(0.0, f64::max);
        let known = about.among.iter().filter_map(of).count();
        let scaled = |truth: Option<f64>| truth.map(|truth| (truth / most).min(1.0));
        let least = if about.to.is_empty() { 0.0 } else { TRUE_MIN };
        (known > 1 && most > least).then(|| truths.into_iter().map(scaled).collect())
    }

    /// Returns whether a word is a value for more of a measure: "long" for [`Measure::Long`].
    pub fn is_value_of(&self, word: WordId, measure: Measure) -> bool {
        let values = self.attributes().iter().flat_map(|attribute| &attribute.values);
        let names = values
            .filter(|value| value.word == word)
            .flat_map(|value| std::iter::once(&value.name).chain(&value.synonyms));
        let middle = SIZES.len() / 2;
        let mut ranks = names.filter_map(|name| size_rank(name));
        measure.is_of_object()
            && ranks.any(|rank| if measure.is_positive() { rank > middle } else { rank < middle })
    }

    /// The probability of each object to be at one of these places among the candidates.
    fn ordered(
        &self,
        measure: Measure,
        loosely: f64,
        about: &Related<'_>,
        places: impl Fn(usize) -> Vec<usize>,
    ) -> Option<Vec<Option<f64>>> {
        let (values, scale) = self.measured(measure, loosely, about)?;
        let truth = |i: ObjectId| {
            let value = values[i.index()]?;
            let others = about.among.iter().filter(|other| **other != i);
            let others: Vec<f64> = others.filter_map(|other| values[other.index()]).collect();
            let beats = others.iter().map(|other| logistic((other - value) / scale));
            let counts = counts(beats);
            let places = places(others.len() + 1).into_iter();
            Some(places.filter_map(|place| counts.get(place.checked_sub(1)?)).sum())
        };
        Some(self.ids().map(truth).collect())
    }

    /// "bigger than X", "to the left of X": of places, those near X are rather meant than others.
    fn compared(&self, measure: Measure, about: &Related<'_>) -> Option<Vec<Option<f64>>> {
        let (values, scale) = self.measured(measure, RATIO, about)?;
        let [to] = about.to else { return None };
        let known = |x: &&ObjectId| values[x.index()].is_some();
        let to: Vec<ObjectId> = to.iter().filter(known).copied().collect();
        let exceeds = |i: ObjectId, x: ObjectId| {
            if i == x {
                return Some(0.0);
            }
            let by = values[i.index()]? - values[x.index()]?;
            let aside = if measure.is_of_object() { 0.0 } else { self.aside(i, x, by)? };
            Some(logistic((by - aside) / scale))
        };
        let is_directed =
            matches!(measure, Measure::Left | Measure::Right | Measure::Front | Measure::Back);
        let truth_to = |i: ObjectId, x: ObjectId| {
            let truth = exceeds(i, x)?;
            if !is_directed {
                return Some(truth);
            }
            let those = about.among.iter().filter(|c| exceeds(**c, x).is_some_and(|p| p > 0.5));
            let nearest = those.filter_map(|c| self.distance(*c, x)).fold(f64::INFINITY, f64::min);
            let beyond = (self.distance(i, x)? - nearest).max(0.0);
            Some(truth * (-beyond / BESIDE_M).exp())
        };
        let truth = |i: ObjectId| mean(to.iter().map(|x| truth_to(i, *x)));
        (!to.is_empty()).then(|| self.ids().map(truth).collect())
    }

    /// Distance across a direction in which `i` lies `by` from `x`, metres.
    fn aside(&self, i: ObjectId, x: ObjectId, by: f64) -> Option<f64> {
        Some((self.distance(i, x)?.powi(2) - by * by).max(0.0).sqrt())
    }

    fn beside(&self, about: &Related<'_>) -> Option<Vec<Option<f64>>> {
        let [to] = about.to else { return None };
        let truth_to = |i: ObjectId, x: ObjectId| {
            let others = about.among.iter().filter(|other| **other != x);
            let nearest = others.filter_map(|c| self.distance(*c, x)).fold(f64::INFINITY, f64::min);
            let distance = self.distance(i, x)?;
            let beyond = (distance - nearest).max(0.0);
            Some(if i == x { 0.0 } else { (-beyond / BESIDE_M).exp() })
        };
        let to: Vec<ObjectId> = to.iter().filter(|x| self.place(**x).is_some()).copied().collect();
        let truth = |i: ObjectId| mean(to.iter().map(|x| truth_to(i, *x)));
        (!to.is_empty()).then(|| self.ids().map(truth).collect())
    }

    /// Between one of the first and one of the second objects, or between those of one group.
    fn between(&self, about: &Related<'_>) -> Option<Vec<Option<f64>>> {
        let pairs: Vec<(ObjectId, ObjectId)> = match about.to {
            [both] => both.windows(2).map(|pair| (pair[0], pair[1])).collect(),
            [one, other] => one
                .iter()
                .flat_map(|x| other.iter().map(|y| (*x, *y)))
                .filter(|(x, y)| x != y)
                .collect(),
            _ => return None,
        };
        let is_placed = |(x, y): &(ObjectId, ObjectId)| {
            self.place(*x).is_some() && self.distance(*x, *y).is_some_and(|it| it > 0.0)
        };
        let pairs: Vec<(ObjectId, ObjectId)> = pairs.into_iter().filter(is_placed).collect();
        let truth_of = |i: ObjectId, (x, y): (ObjectId, ObjectId)| {
            let (from, to, at) = (self.place(x)?, self.place(y)?, self.place(i)?);
            let (line, way) = (minus(to, from), minus(at, from));
            let length = dot(line, line).sqrt();
            let along = dot(way, line) / length;
            let aside = (dot(way, way) - along * along).max(0.0).sqrt();
            let inside = logistic(along.min(length - along) / PLACE_M);
            Some(if i == x || i == y { 0.0 } else { inside * (-aside / ASIDE_M).exp() })
        };
        let truth = |i: ObjectId| mean(pairs.iter().map(|pair| truth_of(i, *pair)));
        (!pairs.is_empty()).then(|| self.ids().map(truth).collect())
    }

    /// Returns the measure of each object, and the smallest difference that counts; `None` if the
    /// measure does not tell the candidates apart.
    fn measured(
        &self,
        measure: Measure,
        loosely: f64,
        about: &Related<'_>,
    ) -> Option<(Vec<Option<f64>>, f64)> {
        let compared = || about.among.iter().chain(about.to.iter().flatten());
        let differ = |values: &Vec<Option<f64>>, by: f64| {
            let known = || compared().filter_map(|i| values[i.index()]);
            known().fold(f64::NEG_INFINITY, f64::max) - known().fold(f64::INFINITY, f64::min) > by
        };
        let scale = if measure.is_of_object() { loosely } else { PLACE_M };
        let axes = self.axes(about.view);
        let value = |i: ObjectId| self.value_of(measure, axes, about.view, i);
        let values: Vec<Option<f64>> = self.ids().map(value).collect();
        if differ(&values, 0.3 * scale) {
            return Some((values, scale));
        }
        if !measure.is_of_object() || matches!(measure, Measure::Heavy | Measure::Light) {
            return None;
        }
        let sign = if measure.is_positive() { 1.0 } else { -1.0 };
        let rank = |k: usize, i: ObjectId| {
            let value = &self.attributes()[k].values[self.object(i).values[k]?.index()];
            size_rank(&value.name).map(|rank| sign * rank as f64)
        };
        let ranked = |k: usize| self.ids().map(|i| rank(k, i)).collect::<Vec<_>>();
        let mut ranks = (0..self.attributes().len()).map(ranked);
        ranks.find(|values| differ(values, 0.5)).map(|values| (values, RATIO))
    }

    fn value_of(
        &self,
        measure: Measure,
        [left, back]: [[f64; 2]; 2],
        view: View,
        i: ObjectId,
    ) -> Option<f64> {
        let placement = self.object(i).placement?;
        let Placement { xyz: [x, y, z], size: [length, width, height], .. } = placement;
        let of_user = || match view {
            View::User(at) => Some((x - at[0]).hypot(y - at[1])),
            View::Robot => None,
        };
        let (longer, shorter) = (length.max(width), length.min(width));
        Some(match measure {
            Measure::Left => dot([x, y], left),
            Measure::Right => -dot([x, y], left),
            Measure::Back => dot([x, y], back),
            Measure::Front => -dot([x, y], back),
            Measure::High => z,
            Measure::Low => -z,
            Measure::Near => -x.hypot(y),
            Measure::Far => x.hypot(y),
            Measure::NearUser => -of_user()?,
            Measure::FarUser => of_user()?,
            Measure::Big => (length * width * height).ln(),
            Measure::Small => -(length * width * height).ln(),
            Measure::Long => longer.ln(),
            Measure::Short => -longer.max(height).ln(),
            Measure::Tall => height.ln(),
            Measure::Flat => -height.ln(),
            Measure::Thick => shorter.ln(),
            Measure::Thin => -shorter.ln(),
            Measure::Heavy => placement.mass_kg?.ln(),
            Measure::Light => -placement.mass_kg?.ln(),
        })
        .filter(|value| value.is_finite())
    }

    /// Directions to the left and away from the viewer, horizontal.
    pub(crate) fn axes(&self, view: View) -> [[f64; 2]; 2] {
        let back = match view {
            View::Robot => [1.0, 0.0],
            View::User(at) => {
                let placed: Vec<[f64; 2]> = self.ids().filter_map(|i| self.place(i)).collect();
                let [x, y] = [0, 1].map(|n| placed.iter().map(|place| place[n]).sum::<f64>());
                let count = placed.len().max(1) as f64;
                let way = minus([x / count, y / count], [at[0], at[1]]);
                let length = dot(way, way).sqrt();
                if length > 0.0 { way.map(|part| part / length) } else { [1.0, 0.0] }
            }
        };
        [[-back[1], back[0]], back]
    }

    fn place(&self, i: ObjectId) -> Option<[f64; 2]> {
        self.object(i).placement.map(|placement| [placement.xyz[0], placement.xyz[1]])
    }

    fn distance(&self, i: ObjectId, x: ObjectId) -> Option<f64> {
        let way = minus(self.place(i)?, self.place(x)?);
        Some(dot(way, way).sqrt())
    }
}

/// Places in the middle of that many.
fn middles(count: usize) -> Vec<usize> {
    if count % 2 == 1 { vec![count / 2 + 1] } else { vec![count / 2, count / 2 + 1] }
}

/// Probabilities that none, one, two … of independent events happen.
fn counts(events: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut counts = vec![1.0];
    for p in events {
        counts.push(0.0);
        for n in (0..counts.len()).rev() {
            let below = if n > 0 { counts[n - 1] } else { 0.0 };
            counts[n] = (1.0 - p) * counts[n] + p * below;
        }
    }
    counts
}

fn mean(truths: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let known: Vec<f64> = truths.flatten().collect();
    (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests;
