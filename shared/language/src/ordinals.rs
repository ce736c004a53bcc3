//! "The first one", in answer to a choice: the option at that place, in the spoken order.

use scene::WordId;

use crate::lexicon::{Lexicon, Sense};
use crate::relation_words::ORDINALS;
use crate::tagger::Tag;
use crate::token_class::Class;

/// Replaces ordinals by the options that they denote.
pub(crate) fn name_options<'a>(tags: &mut [Tag<'a>], options: &[WordId], lexicon: &'a Lexicon) {
    for tag in tags {
        if tag.is(Class::Ordinal)
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
        ("number", last) => from_0(ORDINALS.of(&format!("number {last}"))),
        (word, _) => from_0(ORDINALS.of(word)),
    }
}
