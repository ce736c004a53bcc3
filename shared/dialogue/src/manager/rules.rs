//! The rules for an utterance, in order: the first one whose conditions hold handles it.
//! [`INTENTS`] go by the user's intent, [`CONTENT`] by the dialogue's stage and the words.

use scene::{Intent, Response, Role};

use super::Manager;
use super::acts::repeat;
use super::inform::says_nothing;
use super::intents::{excludes, is_about_object, order_stop};
use super::line::{Content, Preface, Remark};
use super::state::{Stage, State};
use super::turn::{Statement, Turn};

/// A rule for an utterance.
pub(super) struct Rule<On: 'static, Applies, Apply> {
    /// Name of the rule.
    pub(super) name: &'static str,
    /// Intents or stages for which it is made; empty for all.
    on: &'static [On],
    /// Further condition of the rule.
    applies: Applies,
    /// Handles the utterance.
    pub(super) apply: Apply,
}

type ByIntent =
    Rule<Intent, fn(&Manager, &State, &Turn<'_>) -> bool, fn(&mut Manager, &mut State, Turn<'_>)>;
type ByContent =
    Rule<Stage, fn(&Statement<'_>) -> bool, fn(&mut Manager, &mut State, Statement<'_>)>;

/// Rules by intent.
pub(super) const INTENTS: &[ByIntent] = &[
    Rule {
        name: "\"again!\" after a hand-over is a request for another one",
        on: &[],
        applies: |manager, state, turn| manager.asks_for_another(state, turn.utterance),
        apply: |manager, state, turn| manager.inform(state, Turn::alone(turn.utterance, turn.at)),
    },
    Rule {
        name: "words about the wanted object inform",
        on: &[Intent::Inform],
        applies: |_, _, _| true,
        apply: Manager::inform,
    },
    Rule {
        name: "a gesture without a word of the scene informs: \"that one over there\"",
        on: &[Intent::None],
        applies: |manager, _, turn| manager.is_pointing(turn.utterance),
        apply: Manager::inform,
    },
    Rule {
        name: "talk that is not for the robot gets no answer",
        on: &[Intent::None],
        applies: |_, _, turn| !turn.utterance.typed,
        apply: |_, _, _| {},
    },
    Rule {
        name: "typed words without a meaning are not understood",
        on: &[Intent::None],
        applies: |_, _, _| true,
        apply: |manager, state, turn| manager.reply(state, Remark::NotUnderstood, turn.at),
    },
    Rule {
        name: "\"don't get me the red one\" excludes it: another one may be wanted",
        on: &[Intent::Cancel],
        applies: |_, state, turn| state.open.is_some() && excludes(turn.utterance),
        apply: Manager::inform,
    },
    Rule {
        name: "\"don't get me the red one\" before any request is agreed to",
        on: &[Intent::Cancel],
        applies: |_, _, turn| excludes(turn.utterance),
        apply: |manager, state, turn| manager.reply(state, Remark::AllRight, turn.at),
    },
    Rule {
        name: "a cancellation withdraws the request",
        on: &[Intent::Cancel],
        applies: |_, _, _| true,
        apply: |manager, state, turn| manager.cancel(state, turn.at),
    },
    Rule {
        name: "\"stop, not that one\" stops, and informs",
        on: &[Intent::Stop],
        applies: |_, state, turn| state.open.is_some() && is_about_object(turn.utterance),
        apply: |manager, state, turn| {
            let utterance = turn.utterance;
            manager.inform(state, turn);
            order_stop(state, utterance);
        },
    },
    Rule {
        name: "\"stop, never mind\" stops, and cancels",
        on: &[Intent::StopAndCancel],
        applies: |_, _, _| true,
        apply: |manager, state, turn| {
            manager.cancel(state, turn.at);
            order_stop(state, turn.utterance);
        },
    },
    Rule {
        name: "a stop is noted, and reported once the arm confirms it",
        on: &[Intent::Stop],
        applies: |_, _, _| true,
        apply: |_, state, turn| order_stop(state, turn.utterance),
    },
    Rule {
        name: "\"what did you say?\" repeats the line",
        on: &[Intent::Repeat],
        applies: |_, state, _| state.act.line.content != Content::Silence,
        apply: |_, state, turn| repeat(state, turn.at),
    },
    Rule {
        name: "\"start over\" forgets what was said",
        on: &[Intent::StartOver],
        applies: |_, _, _| true,
        apply: |manager, state, turn| manager.start_over(state, turn.utterance, turn.at),
    },
    Rule {
        name: "\"put it back\" returns the object",
        on: &[Intent::PutBack],
        applies: |_, _, _| true,
        apply: |manager, state, turn| manager.put_back(state, turn.utterance, turn.at),
    },
    Rule {
        name: "a question to the robot is answered",
        on: &[],
        applies: |_, _, _| true,
        apply: |manager, state, turn| {
            let remark = manager.answer(state, turn.utterance, turn.intent);
            manager.reply(state, remark, turn.at);
        },
    },
];

/// Rules by the words about the wanted object.
pub(super) const CONTENT: &[ByContent] = &[
    Rule {
        name: "a yes confirms that an object goes back",
        on: &[],
        applies: |said| said.of_put_back == Some(Response::Yes),
        apply: |manager, state, said| manager.confirm_put_back(state, said.at),
    },
    Rule {
        name: "a no keeps the object that goes back",
        on: &[],
        applies: |said| said.of_put_back.is_some(),
        apply: |manager, state, said| manager.withdraw_put_back(state, said.at),
    },
    Rule {
        name: "a refusal of what was handed over takes its interaction up again",
        on: &[Stage::Idle],
        applies: |said| said.refusal.is_some() && said.spoken_of.is_none(),
        apply: Manager::reopen,
    },
    Rule {
        name: "an answer to nothing is no request",
        on: &[Stage::Idle],
        applies: |said| said.spoken_of.is_none() && !said.is_request,
        apply: |_, _, _| {},
    },
    Rule {
        name: "a thing that the scene does not have is named",
        on: &[Stage::Idle],
        applies: |said| {
            // Of a quality there may be another way to say it.
            let is_thing = said.heard.unknown.is_some_and(|word| word.role == Role::Kind);
            is_thing && said.spoken_of.is_none() && says_nothing(&said.heard)
        },
        apply: |manager, state, said| {
            let Some(thing) = said.heard.unknown else { return };
            manager.reply(state, Remark::Unknown(thing.clone()), said.at);
        },
    },
    Rule {
        name: "a request opens an interaction",
        on: &[Stage::Idle],
        applies: |_| true,
        apply: Manager::begin,
    },
    Rule {
        name: "words while the arm fetches may call the object off",
        on: &[Stage::Fetching],
        applies: |_| true,
        apply: |manager, state, said| {
            manager.note_said(state, said.utterance);
            manager.reconsider(state, said.heard, said.at);
        },
    },
    Rule {
        name: "a yes confirms the pick that waits",
        on: &[Stage::HeldBack],
        applies: |said| said.confirmed.is_some(),
        apply: |manager, state, said| {
            manager.note_said(state, said.utterance);
            manager.note_concessions(state, &said.heard);
            said.confirmed.into_iter().for_each(|object| manager.confirm(state, object, said.at));
        },
    },
    Rule {
        name: "what is said counts, and the next decision follows",
        on: &[],
        applies: |_| true,
        apply: |manager, state, said| manager.consider(state, said, Preface::None),
    },
];

/// Returns the first of the rules that is made for an intent or a stage and whose condition holds.
pub(super) fn first<On: PartialEq, Applies, Apply>(
    rules: &'static [Rule<On, Applies, Apply>],
    on: On,
    holds: impl Fn(&Applies) -> bool,
) -> Option<&'static Rule<On, Applies, Apply>> {
    let is_for = |it: &&Rule<On, Applies, Apply>| it.on.is_empty() || it.on.contains(&on);
    rules.iter().filter(is_for).find(|it| holds(&it.applies))
}
