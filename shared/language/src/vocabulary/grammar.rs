//! Function words: what holds a sentence together.

use crate::cue::Cue;

pub(super) const LISTS: &[(Cue, &str)] = &[
    (Cue::Determiner, "the, a, an, de, da, th, teh, hte, te"),
    (Cue::Pointer, "this, that, these, those, dat, dis"),
    (
        Cue::Quantifier,
        "any, every, each, all, some, both, several, either, two, three, four, five, six, most, \
         many, half, couple, few, a pair of, pair of, a set of, set of, a bit of, a piece of, one \
         pair of, a kind of, a type of, a sort of, seven, eight, nine, ten",
    ),
    (Cue::One, "one, 1"),
    (
        Cue::Head,
        "ones, thing, things, object, objects, item, items, thingy, piece, option, options, \
         choice, choices, stuff, anything, something, everything, guy, fella",
    ),
    (
        Cue::Ordinal,
        "first, second, third, fourth, fifth, sixth, last, next, previous, left, right one, \
         leftmost, rightmost, middle, top, bottom, upper, lower, front, nearest, closest, \
         farthest, furthest, former, latter, number one, number two, number three, number four, \
         number five, number six, on the right, on the left, to the right, to the left, center, \
         centre, far, final, 1st, 2nd, 3rd, 4th, 5th, 6th, right hand, left hand, right side, \
         left side, from the right, from the left",
    ),
    (
        Cue::Other,
        "other, others, different, another, something else, someone else, anything else, somewhere \
         else, someplace else, some place else, elsewhere, another place, another spot, a \
         different place, a different spot, one of the others, the rest",
    ),
    (
        Cue::Preposition,
        "in, on, from, inside, at, of, with, within, out, off, up, over, for, down, about, by, \
         through, as, onto of, on top of, inside of, in the back of, in the middle of, at the \
         back of, out of, off of, made of, made from, made out of",
    ),
    (Cue::Destination, "to, into, onto, towards, toward"),
    (
        Cue::Landmark,
        "next to, beside, behind, in front of, near, nearby, close to, closest to, nearest to, \
         right of, left of, to the left of, to the right of, above, below, between, under, \
         underneath, beneath, across from, along with, together with, same as, adjacent to, \
         opposite, around the",
    ),
    (Cue::Than, "than, compared to"),
    (Cue::And, "and, plus, n, as well as, and also"),
    (Cue::Or, "or, nor, and or"),
    (Cue::But, "but, however, though, although"),
    (
        Cue::Join,
        "so, because, cause, cuz, since, if, then, when, while, unless, until, whether, and then, \
         so that, anyway, anyways, after that",
    ),
    (Cue::First, "i, we, us, myself, ourselves"),
    (Cue::Second, "you, u, yourself"),
    (
        Cue::Third,
        "he, she, they, him, her, his, their, somebody, someone, nobody, no one, everybody, \
         everyone, who, whose, people",
    ),
    (Cue::Possessive, "my, our, your, mine, yours, ours"),
    (Cue::It, "it, them, itself"),
    (
        Cue::Be,
        "is, are, am, was, were, be, been, being, s, re, looks, look, seems, appears, sounds, \
         became, turned, turns, turning, stayed, remains, becomes, becoming, feels, feel, felt, \
         tastes, smells, smelled",
    ),
    (
        Cue::Auxiliary,
        "do, does, did, done, can, could, would, will, shall, should, may, must, have, has, had, \
         ll, d, ve, having, going, got",
    ),
    (Cue::Question, "what, which, where, how, why, which one"),
    (
        Cue::Plain,
        "just, only, yet, nothing, nothing but, none but, really, very, quite, pretty, too, also, \
         here, there, now, right now, right away, right there, over there, over here, up there, \
         down there, in there, whichever, whatever, actual, simply, at all, in the least, \
         particularly, even close, check, like, know, think, say, said, says, saying, tell, told, \
         mean, meant, asked, ask, asking, see, seen, thought, thinking, guess, believe, suppose, \
         hear, heard, way, kind, sort, type, bit, little bit, more, less, much, still, even, ever, \
         me, always, already, else, back, same, new, old, nice, good one, whole, plain, only one, \
         single, particular, certain, somewhere, anywhere, try, trying, let, go, come, looking, \
         colored, coloured, sized, shaped, kept, stored, sitting, standing, lying, located, \
         available, difference, dirty, wet, dry, broken, fresh, full, usual, favorite, favourite, \
         own, great big, nearly, almost, rather, somehow, exact, used, using, belongs, friend, has \
         to, have to, use, please just, makes, make, made, without delay, asap, quick, quickly, \
         fast, hurry, careful, carefully, slowly, colour of, mention, mentioned, referring, \
         talking about, meaning, called, name, question, answer, first of all, wanted, needs, \
         wants, needed, that would be great, would be great, would be nice, would be good, looking \
         like, called a, afraid, had in mind, have in mind, in mind, remotely, whatsoever, in the \
         slightest, i was after, i was looking at, i asked for, i was referring to, i am referring \
         to, i am talking about, i was talking about, i was describing, i told you about, would be \
         lovely, would be perfect, would be fine, would be ideal, would be wonderful, would be \
         fantastic, that would be lovely, that would be perfect, that would be wonderful, wear, \
         put on, nicely, drawn",
    ),
    (
        Cue::When,
        "today, yesterday, tomorrow, tonight, this morning, this evening, last night, last week, \
         last year, last time, next week, next year, earlier, later, ago, on monday, on tuesday, \
         on wednesday, on thursday, on friday, on saturday, on sunday, weekend, this afternoon, \
         last month, by monday, by tuesday, by wednesday, by thursday, by friday, by saturday, by \
         sunday, next monday, next friday, next month, last summer, last winter, in the morning, \
         in the evening, in the afternoon, at night, at noon, at midnight, every day, every \
         morning, these days, the other day, this week, this year, this month",
    ),
    (
        Cue::Not,
        "not, without, never, neither, forget the, lose the, leave out, none of, forget about the",
    ),
    (
        Cue::Except,
        "anything but, everything but, anything except, everything except, all but, any but, any \
         except, all except, other than, apart from, aside from, except, except for, excluding, \
         besides, instead of, rather than, save for, with the exception of, anything other than, \
         something other than, anything else than, something else than, anything besides, \
         different from, different than, everything else but, anything else but, as opposed to, \
         opposite of, get rid of, rule out, exclude, eliminate, skip, ignore",
    ),
];
