//! "The first one", in answer to a choice: the option at that place, in the spoken order.

use scene::WordId;

use crate::lexicon::{Lexicon, Sense};
use crate::relation_words::ordinal;
use crate::tagger::{Tag, after};
use crate::token_class::Class;

/// Replaces ordinals by the options that they denote.
pub(crate) fn name_options<'a>(tags: &mut [Tag<'a>], options: &[WordId], lexicon: &'a Lexicon) {
    for at in 0..tags.len() {
        // "the top shelf" is a place of its own.
        let is_part = after(tags, at).is_some_and(Tag::is_value);
        let tag = &mut tags[at];
        if tag.is(Class::Ordinal)
            && !is_part
            && let Some(option) = place(tag, options.len()).and_then(|place| options.get(place))
            && let Some(value) = lexicon.value_of(*option)
        {
            tag.sense = Sense::Value(value);
        }
    }
}

fn place(tag: &Tag<'_>, count: usize) -> Option<usize> {
    let from_0 = |n: Option<u8>| n.map(|n| usize::from(n) - 1);
    match (tag.word, tag.last) {
        ("former", _) => Some(0),
        ("last" | "final" | "latter", _) => count.checked_sub(1),
        ("number", last) => from_0(ordinal(&format!("number {last}"))),
        (word, _) => from_0(ordinal(word)),
    }
}
