//! State of knowledge about one object after several detections.

use std::f64::consts::{PI, TAU};

use crate::Detection;

/// Least standard deviation of a detection: metres along each axis, then radians. A source that
/// states less, or nothing, is not believed more.
const FLOOR: [f64; 4] = [0.01, 0.01, 0.01, 5.0 * PI / 180.0];
/// Variance that an estimate gains per look: things are pushed a little.
const DRIFT: [f64; 4] = [1e-7, 1e-7, 1e-7, 1e-5];
/// Weight of a detection among classes and values that were seen often.
const GAIN_MIN: f64 = 0.05;
/// Detections that agree before an object counts as moved.
const MOVED_AFTER: usize = 3;

/// A list of names with probabilities.
type Chances = Vec<(String, f64)>;

/// An estimate of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Number of detections.
    pub count: u32,
    /// Probabilities of the object's classes.
    pub classes: Chances,
    /// Probabilities of values by attribute.
    pub attributes: Vec<(String, Chances)>,
    /// Centre, metres, and yaw, radians.
    pub place: [f64; 4],
    /// Variance of each.
    pub variance: [f64; 4],
    /// The latest detections that were all away from the estimate.
    away: Vec<[f64; 4]>,
}

impl Estimate {
    /// The estimate after one detection.
    pub fn new(first: &Detection) -> Self {
        Self {
            count: 1,
            classes: first.classes.clone(),
            attributes: first.attributes.clone(),
            place: place(first),
            variance: variance(first),
            away: Vec::new(),
        }
    }

    /// Adds a detection. One more than `moved_m` away counts once enough in a row agree; returns
    /// whether the estimate is at the detected position.
    pub fn see(&mut self, detection: &Detection, moved_m: f64) -> bool {
        self.count = self.count.saturating_add(1);
        let gain = (1.0 / f64::from(self.count)).max(GAIN_MIN);
        blend(&mut self.classes, &detection.classes, gain);
        for (name, seen) in &detection.attributes {
            match self.attributes.iter_mut().find(|(known, _)| known == name) {
                Some((_, known)) => blend(known, seen, gain),
                None => self.attributes.push((name.clone(), seen.clone())),
            }
        }
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

/// Greatest difference of two lists of probabilities; a name that is missing has none.
pub(crate) fn difference(a: &Chances, b: &Chances) -> f64 {
    let of = |list: &Chances, name: &str| {
        list.iter().find(|(known, _)| known == name).map_or(0.0, |(_, p)| *p)
    };
    let names = a.iter().chain(b).map(|(name, _)| name);
    names.map(|name| (of(a, name) - of(b, name)).abs()).fold(0.0, f64::max)
}

/// The angle between −π and π.
pub(crate) fn wrapped(angle: f64) -> f64 {
    let turned = (angle + PI).rem_euclid(TAU) - PI;
    if turned.is_finite() { turned } else { 0.0 }
}

fn variance(detection: &Detection) -> [f64; 4] {
    std::array::from_fn(|axis| detection.variances[axis].max(FLOOR[axis] * FLOOR[axis]))
}

/// Moves `known` by the share `gain` towards `seen`. Reports of one source err alike again and
/// again, so that they are averaged and not multiplied.
fn blend(known: &mut Chances, seen: &Chances, gain: f64) {
    known.iter_mut().for_each(|(_, p)| *p *= 1.0 - gain);
    for (name, p) in seen {
        match known.iter_mut().find(|(own, _)| own == name) {
            Some((_, own)) => *own += gain * p,
            None => known.push((name.clone(), gain * p)),
        }
    }
}
