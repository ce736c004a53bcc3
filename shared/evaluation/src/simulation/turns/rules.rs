//! The robot's rules of turn-taking, each a part that can be combined with the others.

use std::fmt;

use vocabulary::Attribution;

/// The robot's turn-taking rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Attribution of answers to questions.
    pub attribution: Attribution,
    /// `true` if a question that got no answer is asked again; else the next best one is.
    pub same: bool,
    /// `true` if the robot stays silent while the user speaks or a result is pending.
    pub hold: bool,
    /// `true` if the microphone is open; else people click, wait a second and speak.
    pub open: bool,
    /// Seconds after a question in which the robot listens.
    pub window_s: f64,
    /// Seconds that planning takes.
    pub planner_s: f64,
}

/// A part of a rule set's name that is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "\"{part}\" is not a turn-taking rule; combine naive, onset or mixture with same, hold, open, \
     fast and wSECONDS by +, e.g. open+mixture+hold+same+fast+w2.5"
)]
pub struct UnknownRule {
    /// The part.
    pub part: String,
}

/// The paper's listening window and planning time, seconds, as its interaction times imply.
const PAPER: (f64, f64) = (4.85, 2.0);
/// A planner that answers at once, seconds.
const FAST_S: f64 = 0.01;
/// Longest listening window, seconds.
const WINDOW_MAX_S: f64 = 600.0;

impl Default for Rules {
    /// The rules of the paper's web interface: push-to-talk, naive.
    fn default() -> Self {
        let (window_s, planner_s) = PAPER;
        let attribution = Attribution::Naive;
        Self { attribution, same: false, hold: false, open: false, window_s, planner_s }
    }
}

impl Rules {
    /// Rule sets to compare: the paper's, each fix alone, and all of them together.
    pub const ALL: [&'static str; 11] = [
        "naive",
        "naive+same",
        "naive+fast",
        "naive+hold",
        "onset",
        "onset+hold+same+fast",
        "open+naive+same+fast+w1",
        "open+onset+same+fast+w1",
        "open+mixture+same+fast+w1",
        "open+onset+hold+same+fast+w2.5",
        "open+mixture+hold+same+fast+w2.5",
    ];

    /// Parses the name of rules: parts joined by `+`, in any order. Other rules are as in the
    /// paper.
    ///
    /// # Errors
    /// The first part that is none.
    pub fn parse(name: &str) -> Result<Self, UnknownRule> {
        let mut rules = Self::default();
        for part in name.split('+') {
            match part {
                "naive" => rules.attribution = Attribution::Naive,
                "onset" => rules.attribution = Attribution::Onset,
                "mixture" => rules.attribution = Attribution::Mixture,
                "same" => rules.same = true,
                "hold" => rules.hold = true,
                "open" => rules.open = true,
                "fast" => rules.planner_s = FAST_S,
                _ => rules.window_s = window(part)?,
            }
        }
        Ok(rules)
    }
}

fn window(part: &str) -> Result<f64, UnknownRule> {
    let seconds = part.strip_prefix('w').and_then(|text| text.parse::<f64>().ok());
    let usable = seconds.filter(|s| *s > 0.0 && *s <= WINDOW_MAX_S);
    usable.ok_or_else(|| UnknownRule { part: part.to_owned() })
}

impl fmt::Display for Rules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let attribution = match self.attribution {
            Attribution::Naive => "naive",
            Attribution::Onset => "onset",
            Attribution::Mixture => "mixture",
        };
        f.write_str(if self.open { "open+" } else { "" })?;
        f.write_str(attribution)?;
        f.write_str(if self.hold { "+hold" } else { "" })?;
        f.write_str(if self.same { "+same" } else { "" })?;
        f.write_str(if self.planner_s <= FAST_S { "+fast" } else { "" })?;
        if self.window_s != PAPER.0 { write!(f, "+w{}", self.window_s) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turn_taking_rules_round_trip_through_their_names() {
        for name in Rules::ALL {
            assert_eq!(Rules::parse(name).unwrap().to_string(), name);
        }
        assert_eq!(Rules::parse("same+hold").unwrap().to_string(), "naive+hold+same");
        assert_eq!(Rules::parse("naive").unwrap(), Rules::default());
    }

    #[test]
    fn turn_taking_rules_reject_unknown_names_with_help() {
        for wrong in ["", "naive+", "polite", "w", "w0", "w-1", "wNaN", "winf", "onset+w9999"] {
            let error = Rules::parse(wrong).unwrap_err().to_string();
            assert!(error.contains("open+mixture"), "{wrong}: {error}");
        }
    }
}
