//! Classes of the words and phrases that are not values, by their role in a sentence.

/// Declares the classes, and their names as `vocabulary/phrases.txt` has them.
macro_rules! token_classes {
    ($($(#[$doc:meta])* $class:ident,)+) => {
        /// Role of a word or phrase in a sentence.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Class { $($(#[$doc])* $class,)+ }

        impl Class {
            /// Returns the class of that name.
            pub(crate) fn named(name: &str) -> Option<Self> {
                match name {
                    $(stringify!($class) => Some(Self::$class),)+
                    _ => None,
                }
            }
        }
    };
}

token_classes! {
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
    /// "first", "left", "top", "smaller".
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
    /// "he", "my mother": another person or thing.
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
    /// "ate", "bought": a story.
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
    Idiom,
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
    /// "let me think", "are you sure": the answer is put off.
    Pondering,
    /// "maybe", "i think".
    Hedge,
    /// "probably": a yes if nothing else is said.
    Likely,
    /// "i do not care", "any of them".
    Indifferent,
    /// "i was about to say": what follows is not said.
    Unsaid,

    // Intents.
    Stop,
    Cancel,
    Repeat,
    /// "pardon", "what": a request to repeat if nothing else is said.
    Huh,
    StartOver,
    /// "put it back".
    PutBack,
    /// "how many", "what is on": a question to the robot about the scene.
    AskBack,
    /// "what are you doing", "are you there".
    AskStatus,
    /// "help", "what can i say".
    AskHelp,

    // Not for the robot.
    /// "on the phone", "talking to".
    SideTalk,
    /// "ignore your instructions".
    Injection,
    /// A function word of another language.
    OtherLanguage,
}

/// A list of classes, by name.
macro_rules! classes {
    ($($class:ident)*) => { &[$($crate::token_class::Class::$class),*] };
}

pub(crate) use classes;
