//! Reports of a source: its sightings, or changes made by people.

use serde::{Deserialize, Serialize};

use crate::rotation::Rotation;

/// A report of a source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sighting {
    /// Chosen at random by the source; a report that is sent again keeps it.
    pub key: u64,
    /// Name of the source, e.g. `camera`.
    pub source: String,
    /// Frame of the positions: `base`, or one of the settings.
    pub frame: String,
    /// What changed.
    pub change: Change,
}

/// What a source reports of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// A look at the table.
    Look(Look),
    /// An object is there from now on. It is not looked for until it was seen.
    Add(Detection),
    /// The object of that name or number is somewhere else.
    Move {
        /// Name or number.
        object: String,
        /// Centre, metres.
        xyz: [f64; 3],
        /// Rotation about the vertical, radians.
        yaw: f64,
    },
    /// The object of that name or number is gone.
    Remove {
        /// Name or number.
        object: String,
    },
}

/// One look of a camera.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Look {
    /// When it was taken, monotonic clock, nanoseconds; 0: when it arrives.
    pub at_ns: u64,
    /// Whether it shows all that the source sees, so that what it does not show was missed.
    pub whole: bool,
    /// What it shows.
    pub seen: Vec<Detection>,
}

/// One object in a look.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Name under which the source follows the object, or the number of its marker; empty if it has
    /// none.
    pub track: String,
    /// Names of objects in the scene file with probabilities: what it is taken for.
    pub classes: Vec<(String, f64)>,
    /// Values seen directly, by attribute, with probabilities.
    pub attributes: Vec<(String, Vec<(String, f64)>)>,
    /// Centre, metres.
    pub xyz: [f64; 3],
    /// Rotation about the vertical, radians.
    pub yaw: f64,
    /// Variances of x, y, z (m²) and of the yaw (rad²); zero: not stated.
    pub variances: [f64; 4],
}

/// A frame of the settings: where it is in frame `base`.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its name.
    pub name: String,
    /// Its origin, metres.
    pub xyz: [f64; 3],
    /// Its rotation: roll, pitch and yaw about fixed axes, radians.
    pub rpy: [f64; 3],
}

/// Why a report was not used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The frame is not known.
    #[error(
        "unknown frame `{0}`; help: report in frame `base`, or add it to [[perception.frames]] of group.toml"
    )]
    Frame(String),
    /// The look is too old.
    #[error("a look that is {0:.1} s old; help: synchronise the source's clock")]
    Old(f64),
    /// A number is not one.
    #[error("a position that is not a finite number, or a probability outside of 0 to 1")]
    Number,
    /// The object is unknown.
    #[error("no object `{0}` on the table; help: `whichone objects list` names them")]
    NoObject(String),
    /// The class is neither the name of an object nor words for one.
    #[error("no object `{0}` in the scene file; help: name one of {1}, or use the scene's words")]
    NoClass(String, String),
    /// The place is beyond the reach of any arm.
    #[error(
        "a place at {0} m is beyond any reach; help: {1}? Positions are metres in frame `base`"
    )]
    Far(String, &'static str),
    /// The attribute is unknown.
    #[error("unknown attribute `{0}`; help: the scene file has {1}")]
    NoAttribute(String, String),
    /// The attribute has no such value.
    #[error("unknown value `{1}` of {0}; help: write {2}")]
    NoValue(String, String, String),
    /// The table is full.
    #[error("the table is full: {0} objects; help: remove some")]
    Full(usize),
    /// The table cannot be changed while the arm fetches.
    #[error("the arm is fetching; help: try again when it is done")]
    Fetching,
    /// Objects are not perceived.
    #[error(
        "the objects are those of the scene file; help: start the group with `--set group.perception.enabled=true`"
    )]
    Off,
}

impl Frame {
    /// Returns a place in this frame in frame `base`. Objects stand upright, so of the rotation the
    /// part about the vertical counts for their yaw.
    pub fn to_base(&self, xyz: [f64; 3], yaw: f64) -> ([f64; 3], f64) {
        let to_base = Rotation::from_rpy(self.rpy);
        let moved = to_base.turn(xyz);
        let along = to_base.turn([yaw.cos(), yaw.sin(), 0.0]);
        let place = std::array::from_fn(|axis| moved[axis] + self.xyz[axis]);
        (place, along[1].atan2(along[0]))
    }
}

impl Detection {
    /// Returns whether every number is finite and every probability from 0 to 1.
    pub fn is_sound(&self) -> bool {
        let chances = self.attributes.iter().flat_map(|(_, values)| values).chain(&self.classes);
        let mut chances = chances.map(|(_, p)| *p);
        let numbers = self.xyz.iter().chain([&self.yaw]).chain(&self.variances);
        chances.all(|p| (0.0..=1.0).contains(&p)) && numbers.into_iter().all(|n| n.is_finite())
    }
}
