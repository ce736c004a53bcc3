//! A service of a new kind: says which object the robot would pick now. In `config/group.toml`:
//!
//! [services.favourite]
//! command = ["/opt/lab/favourite"]
//! reads = ["policy/view"]
//! writes = ["favourite/latest"]

use std::process::ExitCode;

use lab::{FAVOURITE, Favourite};
use whichone_sdk::messages::PolicyView;
use whichone_sdk::service::{self, Context, Service};
use whichone_sdk::{EncodedReader, EncodedWriter, Failure, Scene, Span, Time, topics};

struct Favourites {
    views: EncodedReader<PolicyView>,
    favourite: EncodedWriter<Favourite>,
    scene: Scene,
    latest: Favourite,
}

impl Service for Favourites {
    fn open(context: &Context) -> Result<Self, Failure> {
        Ok(Self {
            views: context.bus().encoded_reader(&topics::VIEW)?,
            favourite: context.bus().encoded_writer(&FAVOURITE)?,
            scene: context.scene().clone(),
            latest: Favourite::default(),
        })
    }

    fn pass(&mut self, now: Time) -> Result<Time, Failure> {
        let mut view = None;
        self.views.drain_in_turn(|one| view = Some(one))?;
        let belief = view.map(|view: PolicyView| view.belief).unwrap_or_default();
        let objects = self.scene.objects().iter().zip(belief);
        if let Some((object, probability)) = objects.max_by(|a, b| a.1.total_cmp(&b.1)) {
            let favourite = Favourite { name: object.name.clone(), probability };
            if favourite != self.latest {
                self.favourite.send(&favourite)?;
                self.latest = favourite;
            }
        }
        Ok(now + Span::from_ms(1_000))
    }
}

fn main() -> ExitCode {
    service::run::<Favourites>()
}
