//! The topics that are mirrored.

use messages::schema::Schema;
use messages::topics::{self, Topic};
use messages::{
    Activity, ArmStatus, Hearing, JointStates, Observation, Partial, PolicyView, Presented,
    Receipt, RobotAct, TableView, TrajectoryView, WorldView,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use service::Span;

/// A mirrored message, with the properties that its topic's reader needs.
pub trait Mirrored: Schema + Serialize + DeserializeOwned + Clone + PartialEq + 'static {
    /// Topic of the message.
    const TOPIC: Topic;
    /// Messages of which each counts, so that as many are sent again; 1 for a state.
    const KEPT: usize = 1;
    /// Shortest time between two frames.
    const PAUSE: Span = Span::from_ms(50);

    /// Visits every time of the monotonic clock in it; 0 means none.
    fn times(&mut self, visit: &mut dyn FnMut(&mut u64));
}

macro_rules! mirrored {
    ($($message:ty: $topic:expr, [$($time:ident),*] $(, $key:ident = $value:expr)*;)+) => {
        $(impl Mirrored for $message {
            const TOPIC: Topic = $topic;
            $(mirrored!(@ $key $value);)*

            fn times(&mut self, visit: &mut dyn FnMut(&mut u64)) {
                let _ = &visit;
                $(visit(&mut self.$time);)*
            }
        })+
    };
    (@ kept $value:expr) => { const KEPT: usize = $value; };
    (@ pause_ms $value:expr) => { const PAUSE: Span = Span::from_ms($value); };
}

mirrored! {
    Receipt: topics::RECEIPT, [onset_ns, end_ns], kept = topics::WINDOW;
    Presented: topics::PRESENTED, [started_ns, ended_ns];
    Activity: topics::ACTIVITY, [onset_ns];
    Hearing: topics::HEARING, [onset_ns], pause_ms = 500;
    Partial: topics::PARTIAL, [onset_ns], pause_ms = 200;
    RobotAct: topics::ACT, [decided_ns];
    ArmStatus: topics::STATUS, [];
    JointStates: topics::JOINTS, [at_ns], pause_ms = 33;
    WorldView: topics::WORLD, [at_ns], pause_ms = 100;
    TrajectoryView: topics::TRAJECTORY, [began_ns];
}

impl Mirrored for PolicyView {
    const TOPIC: Topic = topics::VIEW;

    fn times(&mut self, visit: &mut dyn FnMut(&mut u64)) {
        self.refusable.iter_mut().for_each(|delivery| visit(&mut delivery.until_ns));
    }
}

impl Mirrored for TableView {
    const TOPIC: Topic = topics::OBJECTS;
    const PAUSE: Span = Span::from_ms(200);

    fn times(&mut self, visit: &mut dyn FnMut(&mut u64)) {
        self.objects.iter_mut().for_each(|object| visit(&mut object.seen_ns));
    }
}

/// Encoded, an observation takes a few hundred bytes.
impl Mirrored for Observation {
    const TOPIC: Topic = topics::OBSERVATION;
    const KEPT: usize = 2;

    fn times(&mut self, visit: &mut dyn FnMut(&mut u64)) {
        for asked in &mut self.asked {
            visit(&mut asked.began_ns);
            visit(&mut asked.ended_ns);
        }
        let Self { onset_ns, end_ns, accepted_ns, grounded_ns, .. } = self;
        [onset_ns, end_ns, accepted_ns, grounded_ns].into_iter().for_each(visit);
    }
}

/// Names of the mirrored topics.
pub const TOPICS: [&str; 13] = [
    topics::RECEIPT.name,
    topics::PRESENTED.name,
    topics::ACTIVITY.name,
    topics::HEARING.name,
    topics::PARTIAL.name,
    topics::OBSERVATION.name,
    topics::ACT.name,
    topics::OBJECTS.name,
    topics::VIEW.name,
    topics::STATUS.name,
    topics::JOINTS.name,
    topics::WORLD.name,
    topics::TRAJECTORY.name,
];

#[cfg(test)]
mod tests {
    use super::*;

    fn times_of<T: Mirrored>(mut message: T) -> usize {
        let mut count = 0;
        message.times(&mut |_| count += 1);
        count
    }

    #[track_caller]
    fn check<T: Mirrored + Default>() {
        let all = T::fields().iter().filter(|field| field.name.ends_with("_ns")).count();
        assert_eq!(times_of(T::default()), all, "{}", T::NAME);
    }

    #[test]
    fn every_time_of_a_fixed_layout_is_translated() {
        check::<Receipt>();
        check::<Presented>();
        check::<Activity>();
        check::<Hearing>();
        check::<Partial>();
        check::<RobotAct>();
        check::<ArmStatus>();
        check::<JointStates>();
        let is_time = |field: &&messages::schema::Field| field.name.ends_with("_ns");
        let (own, asked) = (Observation::fields(), messages::AskedQuestion::fields());
        let own = own.iter().filter(is_time).count();
        let asked = asked.iter().filter(is_time).count() * messages::ASKED_MAX;
        assert_eq!(times_of(Observation::default()), own + asked);
    }

    #[test]
    fn what_is_mirrored_has_one_writer() {
        for topic in topics::ALL {
            let left_out = ["speech/utterance", "policy/mark"].contains(&topic.name);
            assert_eq!(topic.writer.is_none() || left_out, !TOPICS.contains(&topic.name));
        }
    }
}
