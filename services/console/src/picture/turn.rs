//! Whose turn it is: one truth for every viewer, from what the services say.

use messages::WireCode;
use messages::{
    Activity, ArmStatus, Hearing, MicrophoneState, PickPhase, PolicyView, PresentationState,
    Presented,
};
use serde::Serialize;
use serde_json::{Value as Json, json};
use service::Time;
use service::status::GroupStatus;

use super::services;
use crate::hub::ms;

/// Who is to act.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Actor {
    /// Somebody who talks to the robot.
    Person,
    /// The robot thinks or speaks.
    Robot,
    /// The arm moves.
    Arm,
    /// Nobody.
    Nobody,
}

/// What is going on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnState {
    /// Nothing was asked for.
    Idle,
    /// As idle, with a microphone open.
    Listening,
    /// Somebody speaks.
    Hearing,
    /// What was said is being recognised and understood.
    Understanding,
    /// The robot speaks.
    Speaking,
    /// A question waits for its answer.
    Asked,
    /// The arm fetches something, or points at it.
    Moving,
    /// The motion stop is latched.
    Stopped,
    /// A service is missing.
    Down,
}

/// Whose turn it is, and for what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// Whose.
    pub who: Actor,
    /// For what.
    pub state: TurnState,
    /// When the person began to speak, while somebody speaks.
    pub onset: Option<Time>,
}

/// What it follows from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facts<'a> {
    pub(super) view: Option<&'a PolicyView>,
    pub(super) presented: &'a Presented,
    pub(super) activity: Option<&'a Activity>,
    pub(super) hearing: Option<&'a Hearing>,
    pub(super) arm: Option<&'a ArmStatus>,
    pub(super) group: Option<&'a GroupStatus>,
}

/// Whose turn it is. The gravest first: a stop and a missing service are told whatever else goes on;
/// somebody who speaks is told before what the robot does meanwhile.
pub(super) fn turn(facts: &Facts<'_>) -> Turn {
    use Actor::{Arm, Nobody, Person, Robot};
    use TurnState::*;
    let Facts { view, presented, activity, hearing, arm, group } = *facts;
    let plain = |who, state| Turn { who, state, onset: None };
    if arm.is_some_and(|arm| arm.stopped != 0) {
        return plain(Nobody, Stopped);
    }
    if view.is_none() || arm.is_none() || group.is_some_and(|g| services::missing(g).is_some()) {
        return plain(Nobody, Down);
    }
    if let Some(activity) = activity {
        if activity.onset_ns > 0 {
            return Turn { onset: Some(Time(activity.onset_ns)), ..plain(Person, Hearing) };
        }
        if activity.pending > 0 {
            return plain(Robot, Understanding);
        }
    }
    if presented.state == PresentationState::Speaking.code() {
        return plain(Robot, Speaking);
    }
    if arm.is_some_and(is_fetching) {
        return plain(Arm, Moving);
    }
    let decision = view.map_or("", |view| view.decision.as_str());
    let open = view.is_some_and(|view| view.interaction != 0);
    match decision {
        "ask" if open => {
            let said = view.is_some_and(|view| view.prompt == presented.prompt)
                && presented.state == PresentationState::Ended.code();
            if said { plain(Person, Asked) } else { plain(Robot, Understanding) }
        }
        // A pick that is called off is the arm's affair, too, until it has left the object.
        "pick" | "cancel" if open => plain(Arm, Moving),
        _ if arm.is_some_and(|arm| arm.moving != 0) => plain(Arm, Moving),
        _ => {
            let listens = hearing
                .is_some_and(|hearing| hearing.microphone == MicrophoneState::Listening.code());
            if listens { plain(Person, Listening) } else { plain(Nobody, Idle) }
        }
    }
}

fn is_fetching(arm: &ArmStatus) -> bool {
    use PickPhase::{Accepted, Closing, Holding, Moving};
    [Accepted, Moving, Closing, Holding].iter().any(|phase| phase.code() == arm.phase)
}

impl Turn {
    /// As pages get it; `since` is when its state began.
    pub(super) fn to_json(self, since: Time) -> Json {
        json!({
            "who": self.who,
            "state": self.state,
            "since_ms": ms(since),
            "onset_ms": self.onset.map(ms),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(interaction: u64, decision: &str, prompt: u64) -> PolicyView {
        PolicyView { interaction, decision: decision.to_owned(), prompt, ..PolicyView::default() }
    }

    fn said(prompt: u64, state: PresentationState) -> Presented {
        Presented { prompt, state: state.code(), ..Presented::default() }
    }

    fn of(
        view: &PolicyView,
        presented: &Presented,
        activity: Activity,
        arm: ArmStatus,
    ) -> (Actor, TurnState) {
        let turn = turn(&Facts {
            view: Some(view),
            presented,
            activity: Some(&activity),
            hearing: None,
            arm: Some(&arm),
            group: None,
        });
        (turn.who, turn.state)
    }

    #[test]
    fn a_dialogue_goes_back_and_forth() {
        use Actor::{Arm, Nobody, Person, Robot};
        let (quiet, still) = (Activity::default(), ArmStatus::default());
        let nothing = Presented::default();
        assert_eq!(of(&view(0, "wait", 0), &nothing, quiet, still), (Nobody, TurnState::Idle));
        let speaks = Activity { onset_ns: 9, pending: 1, ..quiet };
        assert_eq!(of(&view(0, "wait", 0), &nothing, speaks, still), (Person, TurnState::Hearing));
        let pends = Activity { pending: 1, ..quiet };
        assert_eq!(
            of(&view(0, "wait", 0), &nothing, pends, still),
            (Robot, TurnState::Understanding)
        );
        let asks = view(1, "ask", 4);
        assert_eq!(of(&asks, &nothing, quiet, still), (Robot, TurnState::Understanding));
        let speaking = said(4, PresentationState::Speaking);
        assert_eq!(of(&asks, &speaking, quiet, still), (Robot, TurnState::Speaking));
        let ended = said(4, PresentationState::Ended);
        assert_eq!(of(&asks, &ended, quiet, still), (Person, TurnState::Asked));
        let picks = view(1, "pick", 5);
        assert_eq!(of(&picks, &ended, quiet, still), (Arm, TurnState::Moving));
        let leaves = view(1, "cancel", 6);
        assert_eq!(of(&leaves, &ended, quiet, still), (Arm, TurnState::Moving));
        let moves = ArmStatus { phase: PickPhase::Holding.code(), moving: 1, ..still };
        assert_eq!(
            of(&picks, &said(5, PresentationState::Ended), quiet, moves),
            (Arm, TurnState::Moving)
        );
        let done = ArmStatus { phase: PickPhase::Done.code(), ..still };
        let over = view(0, "say", 6);
        assert_eq!(
            of(&over, &said(6, PresentationState::Ended), quiet, done),
            (Nobody, TurnState::Idle)
        );
    }

    #[test]
    fn a_stop_and_a_missing_service_come_first() {
        let stopped = ArmStatus { stopped: 1, ..ArmStatus::default() };
        let speaks = Activity { onset_ns: 9, ..Activity::default() };
        let (_, state) = of(&view(1, "ask", 4), &Presented::default(), speaks, stopped);
        assert_eq!(state, TurnState::Stopped);
        let unseen = Facts {
            view: None,
            presented: &Presented::default(),
            activity: None,
            hearing: None,
            arm: None,
            group: None,
        };
        assert_eq!(turn(&unseen).state, TurnState::Down);
    }

    #[test]
    fn an_open_microphone_listens() {
        let hearing =
            Hearing { microphone: MicrophoneState::Listening.code(), ..Hearing::default() };
        let (view, arm) = (view(0, "wait", 0), ArmStatus::default());
        let facts = Facts {
            view: Some(&view),
            presented: &Presented::default(),
            activity: None,
            hearing: Some(&hearing),
            arm: Some(&arm),
            group: None,
        };
        assert_eq!(turn(&facts).state, TurnState::Listening);
    }
}
