//! Relations of an object to others by place, order and size: "the leftmost", "the second from the
//! right", "longer than the red one". [`truths`](crate::Scene::truths) evaluates them.

/// A quantity for comparing objects; an object further that way has more of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// To the left, as the viewer sees it.
    Left,
    /// To the right, as the viewer sees it.
    Right,
    /// Towards the viewer: "in front".
    Front,
    /// Away from the viewer: "behind".
    Back,
    /// Up.
    High,
    /// Down.
    Low,
    /// Close to the robot.
    Near,
    /// Away from the robot.
    Far,
    /// Close to the user.
    NearUser,
    /// Away from the user.
    FarUser,
    /// Volume.
    Big,
    /// The reverse of volume.
    Small,
    /// The longest horizontal extent.
    Long,
    /// The reverse of the longest extent.
    Short,
    /// Height.
    Tall,
    /// The reverse of height.
    Flat,
    /// The shorter horizontal extent.
    Thick,
    /// The reverse of the shorter horizontal extent.
    Thin,
    /// Mass.
    Heavy,
    /// The reverse of mass.
    Light,
}

/// A relation. One to other objects is to those that an utterance describes
/// ([`Reading::further`](crate::Reading::further)), or else to the one spoken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// "the leftmost", "the second from the left", "the biggest": of all that may be meant the
    /// n-th, 1 to [`Relation::NTH_MAX`].
    Nth(Measure, u8),
    /// "bigger", "to the left of it".
    More(Measure),
    /// "the middle one", "the medium sized one".
    Middle(Measure),
    /// "next to it".
    Beside,
    /// "between both".
    Between,
}

impl Measure {
    /// Every measure, in the order of its codes.
    const ALL: [Self; 20] = [
        Self::Left,
        Self::Right,
        Self::Front,
        Self::Back,
        Self::High,
        Self::Low,
        Self::Near,
        Self::Far,
        Self::NearUser,
        Self::FarUser,
        Self::Big,
        Self::Small,
        Self::Long,
        Self::Short,
        Self::Tall,
        Self::Flat,
        Self::Thick,
        Self::Thin,
        Self::Heavy,
        Self::Light,
    ];

    /// Returns whether it is of the object itself and not of its place.
    pub fn is_of_object(self) -> bool {
        self as usize >= Self::Big as usize
    }

    /// Returns whether the relation grows with its measure: true for "big", false for "small".
    pub(crate) fn is_positive(self) -> bool {
        (self as usize).is_multiple_of(2)
    }

    /// Returns the reverse.
    #[must_use]
    pub fn reverse(self) -> Self {
        Self::ALL[self as usize ^ 1]
    }

    fn text(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Front => "in front",
            Self::Back => "behind",
            Self::High => "up",
            Self::Low => "down",
            Self::Near => "near the robot",
            Self::Far => "far from the robot",
            Self::NearUser => "near the user",
            Self::FarUser => "far from the user",
            Self::Big => "big",
            Self::Small => "small",
            Self::Long => "long",
            Self::Short => "short",
            Self::Tall => "tall",
            Self::Flat => "flat",
            Self::Thick => "thick",
            Self::Thin => "thin",
            Self::Heavy => "heavy",
            Self::Light => "light",
        }
    }
}

/// Number of measures that fit one form's codes.
const MEASURES_MAX: u8 = 32;

impl Relation {
    /// Highest place in an order.
    pub const NTH_MAX: u8 = 5;

    /// Returns its code, as it travels between services.
    pub fn code(self) -> u8 {
        let (form, measure) = match self {
            Self::Nth(measure, n) => (n.clamp(1, Self::NTH_MAX) - 1, measure as u8),
            Self::More(measure) => (Self::NTH_MAX, measure as u8),
            Self::Middle(measure) => (Self::NTH_MAX + 1, measure as u8),
            Self::Beside => (Self::NTH_MAX + 2, 0),
            Self::Between => (Self::NTH_MAX + 2, 1),
        };
        form * MEASURES_MAX + measure
    }

    /// Returns the relation of a code.
    pub fn of_code(code: u8) -> Option<Self> {
        let (form, rest) = (code / MEASURES_MAX, code % MEASURES_MAX);
        let measure = || Measure::ALL.get(usize::from(rest)).copied();
        match form {
            form if form < Self::NTH_MAX => Some(Self::Nth(measure()?, form + 1)),
            form if form == Self::NTH_MAX => measure().map(Self::More),
            form if form == Self::NTH_MAX + 1 => measure().map(Self::Middle),
            _ if rest == 0 => Some(Self::Beside),
            _ => (rest == 1).then_some(Self::Between),
        }
    }

    /// Returns the relation in words, for operators.
    pub fn text(self) -> String {
        match self {
            Self::Nth(measure, 1) => format!("most {}", measure.text()),
            Self::Nth(measure, n) => format!("number {n} by most {}", measure.text()),
            Self::More(measure) => format!("more {}", measure.text()),
            Self::Middle(measure) => format!("middle from {}", measure.text()),
            Self::Beside => "next to it".to_owned(),
            Self::Between => "between both".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_of_one_relation() {
        let known: Vec<(u8, Relation)> =
            (0..=u8::MAX).filter_map(|code| Some((code, Relation::of_code(code)?))).collect();
        assert_eq!(known.len(), Measure::ALL.len() * (usize::from(Relation::NTH_MAX) + 2) + 2);
        known.iter().for_each(|(code, relation)| assert_eq!(relation.code(), *code));
    }

    #[test]
    fn a_reverse_is_told_apart_and_taken_back() {
        for (n, measure) in Measure::ALL.into_iter().enumerate() {
            assert_eq!(measure as usize, n);
            assert_ne!(measure.reverse(), measure);
            assert_eq!(measure.reverse().reverse(), measure);
            assert_eq!(measure.is_of_object(), measure.reverse().is_of_object());
        }
        assert_eq!(Measure::Left.reverse(), Measure::Right);
        assert_eq!(Measure::Light.reverse(), Measure::Heavy);
    }
}
