//! The rules for an utterance, in order: the first one whose stage and condition hold handles it. [`INTENTS`] go by
//! what the user wants of the robot, [`CONTENT`] by what the utterance says of the wanted object.

use scene::{Intent, Role};

use super::Manager;
use super::acts::repeat;
use super::inform::says_nothing;
use super::intents::{excludes, is_about_object, order_stop};
use super::line::{Content, Preface, Remark};
use super::state::{Stage, State};
use super::turn::Turn;

/// A rule for an utterance.
pub(super) struct Rule {
    /// Its name.
    name: &'static str,
    /// Stages of the dialogue at which it may apply.
    stages: &'static [Stage],
    /// Whether it applies to an utterance.
    applies: fn(&Manager, &State, &Turn<'_>) -> bool,
    /// Handles the utterance.
    apply: fn(&mut Manager, &mut State, Turn<'_>),
}

const ALWAYS: &[Stage] = &[Stage::Idle, Stage::Deciding, Stage::HeldBack, Stage::Fetching];
const OPEN: &[Stage] = &[Stage::Deciding, Stage::HeldBack, Stage::Fetching];
const IDLE: &[Stage] = &[Stage::Idle];
const FETCHING: &[Stage] = &[Stage::Fetching];
const HELD_BACK: &[Stage] = &[Stage::HeldBack];
const ANY: fn(&Manager, &State, &Turn<'_>) -> bool = |_, _, _| true;

/// Rules by intent.
pub(super) const INTENTS: &[Rule] = &[
    Rule {
        name: "\"again!\" after a hand-over is a request for another one",
        stages: IDLE,
        applies: |manager, state, turn| manager.asks_for_another(state, turn.utterance),
        apply: |manager, state, turn| {
            let turn = manager.turn_alone(state, turn.utterance, turn.at);
            manager.inform(state, turn);
        },
    },
    Rule {
        name: "words and gestures about the wanted object inform",
        stages: ALWAYS,
        applies: |manager, _, turn| match turn.intent {
            Intent::Inform => true,
            // "That one over there" has no word of the scene, but the gesture counts.
            Intent::None => manager.is_pointing(turn.utterance),
            _ => false,
        },
        apply: Manager::inform,
    },
    Rule {
        name: "talk that is not for the robot gets no answer",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::None && !turn.utterance.typed,
        apply: |_, _, _| {},
    },
    Rule {
        name: "typed words without a meaning are not understood",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::None,
        apply: |manager, state, turn| manager.reply(state, Remark::NotUnderstood, turn.at),
    },
    Rule {
        name: "\"don't get me the red one\" excludes it: another one may be wanted",
        stages: OPEN,
        applies: |_, _, turn| turn.intent == Intent::Cancel && excludes(turn.utterance),
        apply: Manager::inform,
    },
    Rule {
        name: "\"don't get me the red one\" before any request is agreed to",
        stages: IDLE,
        applies: |_, _, turn| turn.intent == Intent::Cancel && excludes(turn.utterance),
        apply: |manager, state, turn| manager.reply(state, Remark::AllRight, turn.at),
    },
    Rule {
        name: "a cancellation withdraws the request",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::Cancel,
        apply: |manager, state, turn| manager.cancel(state, turn.at),
    },
    Rule {
        name: "\"stop, not that one\" stops, and informs",
        stages: OPEN,
        applies: |_, _, turn| turn.intent == Intent::Stop && is_about_object(turn.utterance),
        apply: |manager, state, turn| {
            let utterance = turn.utterance;
            manager.inform(state, turn);
            order_stop(state, utterance);
        },
    },
    Rule {
        name: "\"stop, never mind\" stops, and cancels",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::StopAndCancel,
        apply: |manager, state, turn| {
            manager.cancel(state, turn.at);
            order_stop(state, turn.utterance);
        },
    },
    Rule {
        name: "a stop is noted, and reported once the arm confirms it",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::Stop,
        apply: |_, state, turn| order_stop(state, turn.utterance),
    },
    Rule {
        name: "\"what did you say?\" repeats the line",
        stages: ALWAYS,
        applies: |_, state, turn| {
            turn.intent == Intent::Repeat && state.act.line.content != Content::Silence
        },
        apply: |_, state, turn| repeat(state, turn.at),
    },
    Rule {
        name: "\"start over\" forgets what was said",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::StartOver,
        apply: |manager, state, turn| manager.start_over(state, &turn),
    },
    Rule {
        name: "\"put it back\" returns the object",
        stages: ALWAYS,
        applies: |_, _, turn| turn.intent == Intent::PutBack,
        apply: |manager, state, turn| manager.put_back(state, turn.utterance, turn.at),
    },
    Rule {
        name: "a question to the robot is answered",
        stages: ALWAYS,
        applies: ANY,
        apply: |manager, state, turn| {
            let remark = manager.answer(state, turn.utterance, turn.intent);
            manager.reply(state, remark, turn.at);
        },
    },
];

/// Rules by what is said of the wanted object.
pub(super) const CONTENT: &[Rule] = &[
    Rule {
        name: "an answer about the object that goes back",
        stages: ALWAYS,
        applies: |manager, state, turn| manager.put_back_answer(state, &turn.heard).is_some(),
        apply: |manager, state, turn| manager.answer_put_back(state, &turn),
    },
    Rule {
        name: "a refusal of what was handed over takes its interaction up again",
        stages: IDLE,
        applies: |_, _, turn| turn.refusal.is_some() && turn.spoken_of.is_none(),
        apply: Manager::reopen,
    },
    Rule {
        name: "an answer to nothing is no request",
        stages: IDLE,
        applies: |_, _, turn| turn.spoken_of.is_none() && !turn.is_request,
        apply: |_, _, _| {},
    },
    Rule {
        name: "a thing that the scene does not have is named",
        stages: IDLE,
        applies: |_, _, turn| {
            // Of a quality there may be another way to say it.
            let is_thing = turn.heard.unknown.is_some_and(|word| word.role == Role::Kind);
            is_thing && turn.spoken_of.is_none() && says_nothing(&turn.heard)
        },
        apply: |manager, state, turn| {
            let Some(thing) = turn.heard.unknown else { return };
            manager.reply(state, Remark::Unknown(thing.clone()), turn.at);
        },
    },
    Rule {
        name: "a request opens an interaction",
        stages: IDLE,
        applies: ANY,
        apply: Manager::begin,
    },
    Rule {
        name: "words while the arm fetches may call the object off",
        stages: FETCHING,
        applies: ANY,
        apply: |manager, state, turn| {
            manager.note_said(state, &turn);
            manager.reconsider(state, turn.heard, turn.at);
        },
    },
    Rule {
        name: "a yes confirms the pick that waits",
        stages: HELD_BACK,
        applies: |manager, state, turn| manager.confirmed(state, &turn.heard).is_some(),
        apply: |manager, state, turn| {
            manager.note_said(state, &turn);
            manager.note_concessions(state, &turn.heard);
            manager.confirm(state, &turn);
        },
    },
    Rule {
        name: "what is said counts, and the next decision follows",
        stages: OPEN,
        applies: ANY,
        apply: |manager, state, turn| manager.consider(state, turn, Preface::None),
    },
];

impl Manager {
    /// Handles an utterance by the first of the rules that applies.
    pub(super) fn apply(&mut self, rules: &[Rule], state: &mut State, turn: Turn<'_>) {
        let stage = state.stage();
        let applies = |it: &&Rule| it.stages.contains(&stage) && (it.applies)(self, state, &turn);
        if let Some(rule) = rules.iter().find(applies) {
            self.rule = rule.name;
            (rule.apply)(self, state, turn);
        }
    }
}
