//! "The first one", in answer to a choice: the option at that place, in the order in which they were said.

use scene::WordId;

use crate::lexicon::{Lexicon, Sense};
use crate::tagger::{Tag, after};
use crate::token_class::Class;

/// Takes ordinals for the options that they stand for.
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
    let word = if tag.word == "number" { tag.last } else { tag.word };
    match word {
        "first" | "1st" | "former" | "one" => Some(0),
        "second" | "2nd" | "two" => Some(1),
        "third" | "3rd" | "three" => Some(2),
        "fourth" | "4th" | "four" => Some(3),
        "last" | "final" | "latter" => count.checked_sub(1),
        _ => None,
    }
}
