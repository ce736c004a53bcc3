//! State of knowledge about one object after several detections.

use std::f64::consts::{PI, TAU};

use scene::{Scene, likeliest};

use crate::Detection;
use crate::names::{Chances, Names};

/// Least standard deviation of a detection: metres along each axis, then radians. A source that
/// states less, or nothing, is not believed more.
const FLOOR: [f64; 4] = [0.01, 0.01, 0.01, 5.0 * PI / 180.0];
/// Variance that an estimate gains per look: things are pushed a little.
const DRIFT: [f64; 4] = [1e-7, 1e-7, 1e-7, 1e-5];
/// Largest change of a probability that is ignored.
const CHANCE_STEP: f64 = 0.1;
/// Largest change of a logarithm of odds that is ignored.
const LOG_ODDS_STEP: f64 = 1.0;
/// Probability that is as good as none.
const ALMOST: f64 = 0.004;
/// Detections that agree before an object counts as moved.
const MOVED_AFTER: usize = 3;

/// An estimate of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Number of detections.
    pub count: u32,
    /// Probabilities of the object's classes.
    pub classes: Chances,
    /// Probabilities of values by attribute, of those that were seen directly.
    pub attributes: Vec<(String, Chances)>,
    /// Centre, metres, and yaw, radians.
    pub place: [f64; 4],
    /// Variance of each.
    pub variance: [f64; 4],
    /// The latest detections that were all away from the estimate.
    away: Vec<[f64; 4]>,
    named: Names,
    values: Vec<Values>,
}

/// Values of one attribute as they were seen.
#[derive(Clone, Debug, PartialEq)]
struct Values {
    attribute: String,
    names: Names,
    /// Whether looks have shown others than stated: then looks without them show those of the class.
    is_seen: bool,
}

impl Estimate {
    /// The estimate after one detection.
    pub fn new(first: &Detection, file: &Scene) -> Self {
        let none = Detection { classes: Chances::new(), attributes: Vec::new(), ..first.clone() };
        let mut new = Self::stated(&none);
        (new.count, new.named) = (1, Names::default());
        new.note(first, file);
        new
    }

    /// The estimate that a person or a table states.
    pub fn stated(by: &Detection) -> Self {
        let values = |(attribute, chances): &(String, Chances)| {
            let (attribute, names) = (attribute.clone(), Names::stated(chances));
            Values { attribute, names, is_seen: false }
        };
        Self {
            count: 1,
            classes: by.classes.clone(),
            attributes: by.attributes.clone(),
            place: place(by),
            variance: variance(by),
            away: Vec::new(),
            named: Names::stated(&by.classes),
            values: by.attributes.iter().map(values).collect(),
        }
    }

    /// Adds a detection. One more than `moved_m` away counts once enough in a row agree; returns
    /// whether the estimate is at the detected position.
    pub fn see(&mut self, detection: &Detection, file: &Scene, moved_m: f64) -> bool {
        self.count = self.count.saturating_add(1);
        self.note(detection, file);
        let seen = place(detection);
        if distance(&seen, &self.place) <= moved_m {
            self.away.clear();
            self.fuse(seen, variance(detection));
            return true;
        }
        self.away.retain(|earlier| distance(earlier, &seen) <= moved_m);
        self.away.push(seen);
        if self.away.len() < MOVED_AFTER {
            return false;
        }
        let away = std::mem::take(&mut self.away);
        (self.place, self.variance) = (away[0], variance(detection));
        away[1..].iter().for_each(|seen| self.fuse(*seen, variance(detection)));
        true
    }

    /// Notes what a look named the object and its values.
    fn note(&mut self, detection: &Detection, file: &Scene) {
        let is_full = self.named.is_full();
        self.named.fade(is_full);
        self.named.see(&detection.classes, 1.0);
        for it in &mut self.values {
            it.names.fade(if it.is_seen { is_full } else { it.names.is_full() });
        }
        for (attribute, seen) in &detection.attributes {
            let Some(k) = file.attribute_named(attribute) else { continue };
            let mut seen = seen.clone();
            seen.retain(|(value, _)| file.value_named(k, value).is_some());
            let Some(shown) = likeliest(&seen) else { continue };
            let at = self.values.iter().position(|it| it.attribute == *attribute);
            let at = at.unwrap_or_else(|| {
                let (attribute, names) = (attribute.clone(), Names::default());
                self.values.push(Values { attribute, names, is_seen: true });
                self.values.len() - 1
            });
            let stated = self.attributes.get(at).and_then(|(_, chances)| likeliest(chances));
            let values = &mut self.values[at];
            // Looks without the value say nothing against a person with whom a look agrees.
            if !values.is_seen && stated != Some(shown) {
                (values.is_seen, values.names.looks) = (true, self.named.looks - 1.0);
            }
            values.names.see(&seen, 1.0);
        }
        self.classes = self.named.chances(file.objects().len());
        let of = |it: &Values| (it.attribute.clone(), self.chances_of(it, file));
        self.attributes = self.values.iter().map(of).collect();
    }

    /// Probabilities of an attribute's values. A look without them showed those of the class.
    fn chances_of(&self, values: &Values, file: &Scene) -> Chances {
        let Some(k) = file.attribute_named(&values.attribute) else { return Chances::new() };
        let mut names = values.names.clone();
        let without = if values.is_seen { self.named.looks - names.looks } else { 0.0 };
        if without > 0.5 {
            let known = &file.attributes()[k.index()].values;
            let (chances, _) = file.values_of_classes(&self.classes, k);
            let named = known.iter().map(|value| value.name.clone()).zip(chances);
            names.see(&named.filter(|(_, p)| *p > 0.0).collect(), without);
        }
        names.chances(file.attributes()[k.index()].values.len())
    }

    /// Moves it to the place of another estimate of the same object.
    pub fn move_to(&mut self, other: &Self) {
        self.away.clear();
        (self.place, self.variance) = (other.place, other.variance);
    }

    fn fuse(&mut self, seen: [f64; 4], noise: [f64; 4]) {
        for axis in 0..4 {
            let own = self.variance[axis] + DRIFT[axis];
            let gain = own / (own + noise[axis]);
            let off = seen[axis] - self.place[axis];
            let off = if axis == 3 { wrapped(off) } else { off };
            self.place[axis] += gain * off;
            self.variance[axis] = (1.0 - gain) * own;
        }
        self.place[3] = wrapped(self.place[3]);
    }

    /// Puts it at the place that a person states.
    pub fn put(&mut self, xyz: [f64; 3], yaw: f64) {
        self.away.clear();
        self.place = [xyz[0], xyz[1], xyz[2], wrapped(yaw)];
        self.variance = FLOOR.map(|sd| sd * sd);
    }
}

/// Centre and yaw of a detection.
pub(crate) fn place(detection: &Detection) -> [f64; 4] {
    let [x, y, z] = detection.xyz;
    [x, y, z, wrapped(detection.yaw)]
}

/// Distance of two places, metres.
pub(crate) fn distance(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// Whether two lists of probabilities differ by more than a step: in probability, or in the odds of
/// what is almost certain. A name that is missing has none.
pub(crate) fn differ(a: &Chances, b: &Chances) -> bool {
    let of = |list: &Chances, name: &str| {
        list.iter().find(|(known, _)| known == name).map_or(0.0, |(_, p)| *p)
    };
    let log_odds = |p: f64| {
        let p = p.clamp(ALMOST, 1.0 - ALMOST);
        (p / (1.0 - p)).ln()
    };
    let mut names = a.iter().chain(b).map(|(name, _)| (of(a, name), of(b, name)));
    names.any(|(p, q)| {
        (p - q).abs() > CHANCE_STEP || (log_odds(p) - log_odds(q)).abs() > LOG_ODDS_STEP
    })
}

/// The angle between −π and π.
pub(crate) fn wrapped(angle: f64) -> f64 {
    let turned = (angle + PI).rem_euclid(TAU) - PI;
    if turned.is_finite() { turned } else { 0.0 }
}

fn variance(detection: &Detection) -> [f64; 4] {
    std::array::from_fn(|axis| detection.variances[axis].max(FLOOR[axis] * FLOOR[axis]))
}
