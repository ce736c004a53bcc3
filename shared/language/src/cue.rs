//! What a word or phrase that is not a value does in a sentence.

/// The part that a word or phrase plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cue {
    // Noun phrases.
    /// "the", "a", "my".
    Determiner,
    /// "this", "that".
    Pointer,
    /// "any", "every".
    Quantifier,
    /// "one": a head after a determiner or a quality, else a number.
    One,
    /// A noun for the objects: the scene's own, "thing", "ones".
    Head,
    /// A name of one of the scene's attributes.
    Attribute,
    /// A noun or quality that people ask for, but not in this scene: "mug", "purple".
    Unlisted,
    /// "first", "left", "top".
    Ordinal,
    /// "other", "different", "else".
    Other,
    /// "in", "on", "from": what follows describes.
    Preposition,
    /// "to", "into": what follows is where something goes.
    Destination,
    /// "next to", "behind": what follows is another object.
    Landmark,
    /// "than".
    Than,

    // Clauses.
    And,
    Or,
    But,
    /// "so", "because", "if", "then".
    Join,
    /// "i", "we".
    First,
    /// "you".
    Second,
    /// "he", "my mother": somebody or something else.
    Third,
    /// "my", "his".
    Possessive,
    /// "it".
    It,
    /// "is", "are", "was".
    Be,
    /// "do", "can", "would".
    Auxiliary,
    /// "what", "which", "where".
    Question,
    /// "get", "bring", "hand".
    Fetch,
    /// "want", "need".
    Want,
    /// "put", "place": what follows is an order about something else.
    Put,
    /// "ate", "bought": somebody tells a story.
    Story,
    /// "yesterday", "tonight".
    When,
    /// A word that says nothing about topic or meaning.
    Plain,
    /// "um", "hmm", "damn".
    Filler,
    /// "please", "thanks", "robot".
    Courtesy,
    /// Fixed phrases whose words do not mean what they say ("loud and clear").
    Figure,
    /// Short replies without content for the belief ("no problem").
    Reply,

    // Negation and repair.
    /// "not", "without".
    Not,
    /// "anything but", "except".
    Except,
    /// "i mean", "sorry", "wait".
    Repair,
    /// "scratch that": what was said is withdrawn.
    Withdraw,

    // Answers.
    Yes,
    /// An affirmative only if nothing else is said ("right", "good").
    WeakYes,
    No,
    /// A negative only if nothing else is said ("wrong", "negative").
    WeakNo,
    /// "i do not know", "not sure".
    Unsure,
    /// "maybe", "i think".
    Hedge,
    /// "probably": a yes if nothing else is said.
    Likely,
    /// "i do not care", "any of them".
    Indifferent,

    // Intents.
    Stop,
    Cancel,
    Repeat,
    /// "pardon", "what": a request to repeat if nothing else is said.
    Huh,
    StartOver,
    AskBack,

    // Not for the robot.
    /// "on the phone", "talking to".
    Aside,
    /// "ignore your instructions".
    Injection,
    /// A function word of another language.
    OtherLanguage,
}

/// A set of cues, by name.
macro_rules! cues {
    ($($cue:ident)*) => { &[$($crate::cue::Cue::$cue),*] };
}

pub(crate) use cues;
