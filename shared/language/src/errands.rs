//! Orders to the robot other than to fetch: "put the cup on the table", "wash the clear bowl".

use scene::Role;

use crate::tagger::Tag;
use crate::token_class::{Class, classes};
use crate::topic::ClauseAnalysis;

impl ClauseAnalysis<'_> {
    /// An errand with strange things, or with nothing but places.
    pub(crate) fn is_unrelated_errand(&self) -> bool {
        let places = self.clause.iter().filter(|tag| tag.is_role(Role::Place)).count();
        let is_strange = self.unknown > 0 || self.values == places;
        self.errand().is_some() && is_strange && !self.has(classes![Head])
    }

    /// Place of the verb of an order that is none to fetch: "put it on the table", "empty the dishwasher".
    fn errand(&self) -> Option<usize> {
        const OBJECTS: &[Class] = classes![Determiner Possessive It Pointer];
        let orders = |&at: &usize| {
            let tag = &self.clause[at];
            let before = at.checked_sub(1).map(|before| &self.clause[before]);
            // "I need the screwdriver to fix my bike"
            let is_purpose = before.is_some_and(|before| before.word == "to") && {
                let wanted = &self.clause[..at];
                let is_ours = |tag: &Tag<'_>| tag.is_value() || tag.is(Class::Head);
                wanted.iter().any(|tag| tag.is_any(classes![Fetch Want]))
                    && wanted.iter().any(is_ours)
            };
            let is_noun = before.is_some_and(|before| {
                before.is_value() || before.is_any(classes![Determiner First])
            });
            // "clear the"
            let has_object = matches!(tag.word, "clear" | "break")
                || self.next(at).is_some_and(|next| next.is_any(OBJECTS) || next.is_unknown());
            (tag.is(Class::Put) && !self.brings_at(at) || self.throws_away(at))
                && has_object
                && !is_noun
                && !is_purpose
        };
        (0..self.clause.len()).find(orders)
    }

    /// "put the clear bowl in front of me": putting a thing near the speaker means bringing it.
    fn brings_at(&self, at: usize) -> bool {
        const CARRYING: [&str; 8] =
            ["put", "place", "set", "move", "drop", "lay", "return", "putting"];
        let tag = &self.clause[at];
        tag.is(Class::Put)
            && CARRYING.contains(&tag.word)
            && (at + 1..self.clause.len())
                .take_while(|&place| !self.clause[place].is_any(classes![And But Join]))
                .any(|place| self.is_at_speaker(place))
    }

    /// "to me", "in my hand", "over here", "closer", but not "for me", "away from here", "out of my
    /// way", nor "in my cabinet" of the scene.
    fn is_at_speaker(&self, at: usize) -> bool {
        const LEADS: &[Class] = classes![Preposition Destination Landmark];
        let tag = &self.clause[at];
        let before = self.clause[..at].last();
        let is_elsewhere =
            before.is_some_and(|it| matches!(it.word, "for" | "from" | "out" | "off"));
        let is_led = before.is_some_and(|it| it.is_any(LEADS));
        let is_known = self.next(at).is_some_and(|next| next.is_role(Role::Place));
        let is_here = match tag.word {
            "me" | "us" => is_led,
            "my" | "our" => is_led && !is_known,
            "closer" | "nearer" => true,
            _ => tag.last == "here" && tag.is(Class::Plain),
        };
        is_here && !is_elsewhere
    }

    /// "throw the bowl away", but not "throw me the bowl".
    fn throws_away(&self, at: usize) -> bool {
        matches!(self.clause[at].word, "throw" | "toss")
            && self.clause[at..].iter().any(|tag| tag.word == "away")
    }

    /// "wash the clear bowl", "I want you to fill the mug", "wash it": an errand with our things.
    pub(crate) fn is_chore(&self) -> bool {
        const LEADS: &[Class] = classes![
            Filler Courtesy And But Join Yes WeakYes Repair Plain Auxiliary First Second Want Destination
        ];
        let Some(verb) = self.errand() else { return false };
        let (lead, rest) = self.clause.split_at(verb);
        let says = |class| lead.iter().any(|tag| tag.is(class));
        let is_ours = |(at, tag): (usize, &Tag<'_>)| {
            let is_thing = tag.is_value() && !tag.is_role(Role::Place);
            let is_it = at == 1 && tag.is(Class::It);
            is_it || tag.is(Class::Head) || is_thing
        };
        // "I put it in the cabinet" is a report, "I want you to put it there" an order.
        lead.iter().all(|tag| tag.is_any(LEADS))
            && (says(Class::Second) || !says(Class::First) && !says(Class::Want))
            && rest.iter().enumerate().any(is_ours)
    }
}
