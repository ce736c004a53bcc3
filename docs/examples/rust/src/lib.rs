//! What the programs of this laboratory say to each other.

use serde::{Deserialize, Serialize};
use whichone_sdk::{Topic, messages::Service, payloads};

/// The object that the robot would pick now, by name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Favourite {
    /// Its name in the scene.
    pub name: String,
    /// Its probability.
    pub probability: f64,
}

payloads! { Favourite [] }

/// The service `favourite` to whoever reads it.
pub const FAVOURITE: Topic =
    Topic::new::<Favourite>("favourite/latest", Some(Service::Other("favourite")));
