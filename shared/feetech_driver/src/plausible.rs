//! Judgement of positions: the protocol has no sequence numbers, so an answer that was late may stand in the place of
//! one that was lost.

use service::Time;

use crate::registers::State;

/// Noise of positions and speeds, steps.
const NOISE: f64 = 12.0;
/// Greatest acceleration of a joint, steps/s².
const ACCELERATION: f64 = 25_400.0;
/// Readings in a row that agree with one another and not with those before, after which they count: the joint was
/// moved, or its servo has lost its homing offset.
const AGREED: u32 = 5;

/// Memory of the latest readings.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plausibility {
    accepted: Option<(Time, Vec<(i32, i32)>)>,
    refused: Option<(Time, Vec<(i32, i32)>)>,
    /// Number of refused readings that agree.
    agreeing: u32,
}

impl Plausibility {
    /// Returns whether the joints can have come to these positions since the last ones that were accepted.
    pub(crate) fn accepts(&mut self, states: &[State], at: Time) -> bool {
        let found: Vec<(i32, i32)> =
            states.iter().map(|state| (state.position, state.speed)).collect();
        let follows = |before: &Option<(Time, Vec<(i32, i32)>)>| {
            before
                .as_ref()
                .is_none_or(|(then, before)| follows(before, &found, at.since(*then).s()))
        };
        if follows(&self.accepted) {
            (self.refused, self.agreeing) = (None, 0);
        } else {
            self.agreeing = if self.refused.is_some() && follows(&self.refused) {
                self.agreeing + 1
            } else {
                1
            };
            if self.agreeing < AGREED {
                self.refused = Some((at, found));
                return false;
            }
            (self.refused, self.agreeing) = (None, 0);
        }
        self.accepted = Some((at, found));
        true
    }
}

/// Returns whether each position is at most half an acceleration from where the speed before would have brought it.
fn follows(before: &[(i32, i32)], found: &[(i32, i32)], seconds: f64) -> bool {
    let most = NOISE + 0.5 * ACCELERATION * seconds * seconds;
    before.iter().zip(found).all(|((position, speed), (now, _))| {
        (f64::from(now - position) - f64::from(*speed) * seconds).abs() <= most
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::Errors;
    use service::Span;

    fn state(position: i32, speed: i32) -> State {
        State {
            id: 1,
            errors: Errors(0),
            torque: 1,
            acceleration: 254,
            goal: 0,
            speed_limit: 0,
            torque_limit: 0,
            position,
            speed,
            load: 0,
            decivolts: 74,
            celsius: 30,
        }
    }

    #[test]
    fn positions_that_a_joint_cannot_have_reached_are_refused_until_they_persist() {
        let mut seen = Plausibility::default();
        let at = |n: u64| Time(1_000_000_000) + Span::from_ms(10 * n);
        assert!(seen.accepts(&[state(2000, 500)], at(0)));
        assert!(seen.accepts(&[state(2005, 500)], at(1)));
        assert!(!seen.accepts(&[state(2060, 500)], at(2)));
        assert!(seen.accepts(&[state(2015, 500)], at(3)), "a single one is forgotten");
        for n in 4..8 {
            assert!(!seen.accepts(&[state(3000, 0)], at(n)), "{n}");
        }
        assert!(seen.accepts(&[state(3000, 0)], at(8)), "the joint is there");
        assert!(!seen.accepts(&[state(2040, 0)], at(9)));
    }
}
