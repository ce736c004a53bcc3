//! The current turn, derived from the latest messages, the same for every viewer.

use messages::{ActKind, ArmStatus, MicrophoneState, PickPhase, PresentationState};
use serde::Serialize;
use service::Time;
use service::status::GroupStatus;
use service::view::Latest;

use super::services;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Actor {
    Person,
    /// The robot thinks or speaks.
    Robot,
    Arm,
    #[serde(rename = "nobody")]
    NoOne,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnState {
    /// No request is open.
    Idle,
    /// Idle, with a microphone open.
    Listening,
    Hearing,
    /// An utterance is being recognised and understood.
    Understanding,
    Speaking,
    /// A question waits for an answer.
    Asked,
    /// The arm fetches something, or points at it.
    Moving,
    /// The motion stop is latched.
    Stopped,
    /// A service is missing.
    Down,
}

/// The current turn: who acts, and in which state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    pub who: Actor,
    pub state: TurnState,
    /// When the user began to speak, in state [`TurnState::Hearing`].
    pub onset: Option<Time>,
}

/// Returns whose turn it is, the gravest state first: a stop and a missing service come before
/// everything else, a user who is speaking before the robot's activity.
pub(super) fn turn(latest: &Latest, group: Option<&GroupStatus>) -> Turn {
    use Actor::{Arm, NoOne, Person, Robot};
    use TurnState::*;
    let Latest { view, presented, activity, hearing, arm, .. } = latest;
    let (view, arm) = (view.as_ref(), arm.as_ref());
    let plain = |who, state| Turn { who, state, onset: None };
    if arm.is_some_and(|arm| arm.stopped != 0) {
        return plain(NoOne, Stopped);
    }
    if view.is_none() || arm.is_none() || group.is_some_and(|g| services::missing(g).is_some()) {
        return plain(NoOne, Down);
    }
    if let Some(activity) = activity {
        if activity.onset_ns > 0 {
            return Turn { onset: Some(Time(activity.onset_ns)), ..plain(Person, Hearing) };
        }
        if activity.pending > 0 {
            return plain(Robot, Understanding);
        }
    }
    if presented.state == PresentationState::Speaking {
        return plain(Robot, Speaking);
    }
    if arm.is_some_and(is_fetching) {
        return plain(Arm, Moving);
    }
    let open = view.filter(|view| view.interaction != 0).map(|view| view.decision);
    match open {
        Some(ActKind::Ask) => {
            let said = view.is_some_and(|view| view.prompt == presented.prompt)
                && presented.state == PresentationState::Ended;
            if said { plain(Person, Asked) } else { plain(Robot, Understanding) }
        }
        // An order that is called off is the arm's turn, too, until it has left the object.
        Some(ActKind::Pick | ActKind::Cancel | ActKind::PutBack) => plain(Arm, Moving),
        _ if arm.is_some_and(|arm| arm.moving != 0) => plain(Arm, Moving),
        _ => {
            let listens =
                hearing.is_some_and(|hearing| hearing.microphone == MicrophoneState::Listening);
            if listens { plain(Person, Listening) } else { plain(NoOne, Idle) }
        }
    }
}

fn is_fetching(arm: &ArmStatus) -> bool {
    use PickPhase::{Accepted, Closing, Holding, Moving, Returning};
    [Accepted, Moving, Closing, Holding, Returning].iter().any(|phase| arm.phase == *phase)
}

#[cfg(test)]
mod tests {
    use messages::{Activity, Hearing, PolicyView, Presented};

    use super::*;

    fn view(interaction: u64, decision: ActKind, prompt: u64) -> PolicyView {
        PolicyView { interaction, decision, prompt, ..PolicyView::default() }
    }

    fn said(prompt: u64, state: PresentationState) -> Presented {
        Presented { prompt, state: state.into(), ..Presented::default() }
    }

    fn latest(
        view: PolicyView,
        presented: Presented,
        activity: Activity,
        arm: ArmStatus,
    ) -> Latest {
        let (view, activity, arm) = (Some(view), Some(activity), Some(arm));
        Latest { view, presented, activity, arm, ..Latest::default() }
    }

    #[test]
    fn turn_follows_the_dialogue() {
        use Actor::{Arm, NoOne, Person, Robot};
        use TurnState::{Asked, Hearing, Idle, Moving, Speaking, Understanding};
        let (quiet, still) = (Activity::default(), ArmStatus::default());
        let speaks = Activity { onset_ns: 9, pending: 1, ..quiet };
        let pends = Activity { pending: 1, ..quiet };
        let nothing = Presented::default();
        let ended = |prompt| said(prompt, PresentationState::Ended);
        let speaking = said(4, PresentationState::Speaking);
        let holds = ArmStatus { phase: PickPhase::Holding.into(), moving: 1, ..still };
        let done = ArmStatus { phase: PickPhase::Done.into(), ..still };
        for (view, presented, activity, arm, expected) in [
            (view(0, ActKind::Wait, 0), nothing, quiet, still, (NoOne, Idle)),
            (view(0, ActKind::Wait, 0), nothing, speaks, still, (Person, Hearing)),
            (view(0, ActKind::Wait, 0), nothing, pends, still, (Robot, Understanding)),
            (view(1, ActKind::Ask, 4), nothing, quiet, still, (Robot, Understanding)),
            (view(1, ActKind::Ask, 4), speaking, quiet, still, (Robot, Speaking)),
            (view(1, ActKind::Ask, 4), ended(4), quiet, still, (Person, Asked)),
            (view(1, ActKind::Pick, 5), ended(4), quiet, still, (Arm, Moving)),
            (view(1, ActKind::Cancel, 6), ended(4), quiet, still, (Arm, Moving)),
            (view(1, ActKind::Pick, 5), ended(5), quiet, holds, (Arm, Moving)),
            (view(0, ActKind::Say, 6), ended(6), quiet, done, (NoOne, Idle)),
        ] {
            let turn = turn(&latest(view.clone(), presented, activity, arm), None);
            assert_eq!((turn.who, turn.state), expected, "{view:?}");
        }
    }

    #[test]
    fn turn_shows_a_stop_and_a_missing_service_first() {
        let stopped = ArmStatus { stopped: 1, ..ArmStatus::default() };
        let speaks = Activity { onset_ns: 9, ..Activity::default() };
        let latest = latest(view(1, ActKind::Ask, 4), Presented::default(), speaks, stopped);
        assert_eq!(turn(&latest, None).state, TurnState::Stopped);
        assert_eq!(turn(&Latest::default(), None).state, TurnState::Down);
    }

    #[test]
    fn turn_shows_an_open_microphone() {
        let microphone = MicrophoneState::Listening.into();
        let hearing = Some(Hearing { microphone, ..Hearing::default() });
        let (quiet, still) = (Activity::default(), ArmStatus::default());
        let latest = latest(view(0, ActKind::Wait, 0), Presented::default(), quiet, still);
        assert_eq!(turn(&Latest { hearing, ..latest }, None).state, TurnState::Listening);
    }
}
