//! Arguments of `objects`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use command_line::args::{key_and_value, seconds};

/// Arguments of `objects`.
#[derive(Debug, Args)]
pub struct ObjectsArgs {
    /// What to do; `list` by default.
    #[command(subcommand)]
    pub what: Option<ObjectsVerb>,
    /// Timeout for the answer, seconds.
    #[arg(long, global = true, value_name = "S", default_value = "5", value_parser = seconds)]
    pub timeout: Duration,
}

/// What `objects` does.
#[derive(Debug, Subcommand)]
pub enum ObjectsVerb {
    /// List the objects on the table.
    List,
    /// Put an object on the table.
    Add {
        /// What it is: the name of an object in the scene file, which has its attributes and size.
        #[arg(value_name = "CLASS")]
        class: String,
        /// Where it is.
        #[command(flatten)]
        place: PlaceArgs,
        /// A value that differs from the class's, perhaps with a probability; repeatable.
        #[arg(long = "value", value_name = "ATTRIBUTE=VALUE[:P]", value_parser = value)]
        values: Vec<(String, String, f64)>,
    },
    /// Say that an object is somewhere else.
    Move {
        /// Its name or number.
        #[arg(value_name = "OBJECT")]
        object: String,
        /// Where it is.
        #[command(flatten)]
        place: PlaceArgs,
    },
    /// Take an object off the table.
    Remove {
        /// Its name or number.
        #[arg(value_name = "OBJECT")]
        object: String,
    },
    /// Report looks of a camera: one JSON line each on standard input, docs/perception.md.
    Feed(FeedArgs),
}

/// Arguments of `objects feed`: what the lines of detectors leave out.
#[derive(Clone, Debug, Args)]
pub struct FeedArgs {
    /// The camera that the pixels are of: its camera_info of ROS, YAML.
    #[arg(long, value_name = "FILE", requires = "frame")]
    pub camera: Option<PathBuf>,
    /// Frame of the camera, of group.perception.frames; required with --camera.
    #[arg(long, value_name = "NAME", default_value = "base")]
    pub frame: String,
    /// Height in frame `base` at which objects without a depth are, metres.
    #[arg(long, value_name = "Z", allow_negative_numbers = true)]
    pub height: Option<f64>,
    /// What a class id or a tag stands for; repeatable.
    #[arg(long = "class", value_name = "ID=LABEL", value_parser = key_and_value)]
    pub classes: Vec<(String, String)>,
    /// Name of the detector.
    #[arg(long, value_name = "NAME", default_value = "detector")]
    pub source: String,
    /// Age of a look when its line is read, seconds.
    #[arg(long, value_name = "S", default_value = "0", value_parser = seconds)]
    pub age: Duration,
}

/// A place in frame `base` of the robot.
#[derive(Clone, Debug, Args)]
pub struct PlaceArgs {
    /// Centre: forward, left and up from the robot's base, metres.
    #[arg(
        long = "at",
        value_names = ["X", "Y", "Z"],
        num_args = 3,
        required = true,
        allow_negative_numbers = true
    )]
    at: Vec<f64>,
    /// Rotation about the vertical, radians.
    #[arg(long, value_name = "RAD", default_value = "0", allow_negative_numbers = true)]
    pub yaw: f64,
}

impl PlaceArgs {
    /// Returns the centre, metres.
    pub fn xyz(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.at.get(axis).copied().unwrap_or_default())
    }
}

fn value(text: &str) -> Result<(String, String, f64), String> {
    const HELP: &str = "expected ATTRIBUTE=VALUE or ATTRIBUTE=VALUE:P with P from 0 to 1";
    let (attribute, value) = text.split_once('=').ok_or(HELP)?;
    let (value, chance) = value.rsplit_once(':').map_or((value, "1"), |(value, p)| (value, p));
    let chance = chance.parse().ok().filter(|p| (0.0..=1.0).contains(p)).ok_or(HELP)?;
    Ok((attribute.to_owned(), value.to_owned(), chance))
}
