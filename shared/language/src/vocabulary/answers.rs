//! Yes, no, and everything between; repairs of what was said.

use crate::cue::Cue;

pub(super) const LISTS: &[(Cue, &str)] = &[
    (
        Cue::Yes,
        "yes, yeah, yep, yup, sure, yea, yah, yess, ye, yeh, yis, aye, uh huh, uhhuh, mm hmm, \
         mmhmm, mhm, mm hm, m hm, mmhm, affirmative, indeed, of course, that is it, that is \
         right, that is correct, that is true, that is the one, that is the right one, that is \
         the correct one, that is that, that is mine, this is it, this is the one, you got it, \
         you have got it, got it in one, you are right, you are correct, you bet, you guessed it, \
         i think so, i believe so, i guess so, i suppose so, i would say so, i should think so, \
         think so, guess so, i hope so, by all means, sure thing, for sure, sure is, no doubt, \
         without a doubt, no question, why not, bingo, spot on, right on, exactly right, quite \
         right, quite so, that would be it, that would be the one, that will be it, that will be \
         the one, sounds right, looks right, seems right, sounds good, that sounds right, that \
         sounds good, yes please, please do, go ahead, go for it, yessir, hell yes, hell yeah, \
         yes sir, it sure is, it certainly is, it definitely is, it really is, that it is, so it \
         is, most certainly, most definitely, you are spot on, roger, that goes without saying, \
         it goes without saying, thumbs up, too right, damn right, damn straight, without doubt, \
         that one there, there you go, exactly that one, that very one, that is what i want, that \
         is what i wanted, that is what i mean, that is what i meant, that is the one i want, \
         that is the one i wanted, that is the one i mean, that is the one i meant, 10 4, ten \
         four, nailed it, you nailed it, yes it is, i am afraid so, that is exactly right, that \
         is exactly it, positive, ya, very much so, so very much",
    ),
    (
        Cue::WeakYes,
        "ok, okay, okey, k, kk, right, good, great, fine, perfect, correct, true, exactly, \
         precisely, absolutely, definitely, certainly, totally, obviously, naturally, excellent, \
         wonderful, lovely, cool, super, alright, all right, completely, yes right, clearly, \
         surely, it is, it is the one, it is the right one, it is that one, it is this one, it \
         does, they are, it is so, it has, it was, they do, awesome, very good, very well, that \
         is good, that is fine, that works, that is great, that is perfect, that one, this one, \
         undoubtedly, entirely, accept, agreed, i agree, confirmed, confirm, that is what i said, \
         i am sure, i am pretty sure, pretty sure, fairly sure, quite sure, i am certain, i am \
         positive, i do, it would be, no kidding, would do, that will do, that would do, as you \
         say, i said so, got it",
    ),
    (
        Cue::No,
        "no, nope, nah, naw, noo, nay, nop, uh uh, uhuh, nuh uh, nuh huh, mm mm, no way, no sir, \
         no thanks, no thank you, not a chance, no chance, hardly, i do not think so, do not \
         think so, i do not believe so, i doubt it, i doubt that, not even close, hell no, heck \
         no, thumbs down, wrong one, that is wrong, you are wrong, the wrong one, that is \
         incorrect, that is the wrong one, that is false, no sirree, it is wrong, none of those, \
         none of them, none of these, neither of them, none, not on your life, nothing like it, \
         not by a long shot, not a bit, not one bit, under no circumstances, unlikely, highly \
         unlikely, anything but that, far from it, by no means, on the contrary, keep looking, \
         you are mistaken, not in a million years, in no way, i would not say so, i would not say \
         that, some other one, a different one, not my one, not what i want, not what i asked, \
         not what i asked for, not what i meant, not what i said, not what i am looking for, not \
         what i wanted, not what i need",
    ),
    (
        Cue::WeakNo,
        "negative, incorrect, wrong, false, mistaken, untrue, it is not, it does not, they are \
         not, i do not, it is false, it was not, it could not be, it can not be, i did not, it \
         has not, denied, refused, disagree, i disagree",
    ),
    (
        Cue::Unsure,
        "not sure, not so sure, not too sure, not really sure, not entirely sure, not totally \
         sure, not completely sure, not certain, not quite sure, not very sure, not exactly sure, \
         not a hundred percent sure, unsure, uncertain, do not know, did not know, do not really \
         know, no idea, no clue, not a clue, have no idea, have no clue, who knows, can not say, \
         could not say, can not tell, could not tell, hard to say, hard to tell, difficult to \
         say, do not remember, can not remember, could not remember, do not recall, can not \
         recall, i forget, wish i knew, beats me, search me, depends, it depends, not \
         necessarily, yes and no, no and yes, yes or no, yes but no, no but yes, yes and also no, \
         both yes and no, neither yes nor no, are you sure, make sure, you sure, sure about that, \
         sort of yes and no, anyone is guess, undecided, can not decide, could go either way, \
         your guess is as good as mine, idk, let me think, let me see, let me check, i wonder, do \
         not have a clue, do not have any idea, have not decided, not decided, yes no maybe, no \
         yes maybe, not positive, hmm not sure, i forgot .",
    ),
    (
        Cue::Hedge,
        "maybe, perhaps, possibly, might be, may be, could be, i think, i guess, i believe, i \
         suppose, i would say, i reckon, i assume, i presume, it might, it may, it could, might, \
         could well be, presumably, supposedly, conceivably, i think maybe, not yet, i feel like, \
         if i remember, if i recall, if i am not mistaken, as far as i know, as far as i \
         remember, i imagine, apparently, i am thinking, maybe maybe not",
    ),
    (
        Cue::Likely,
        "probably, likely, most likely, very likely, most probably, very probably, i am fairly \
         certain, i am pretty certain, fairly certain, pretty certain, kind of, sort of, more or \
         less, pretty much, basically, mostly, almost certainly, should be, ought to be, seems \
         so, it seems so, looks like it, it looks like it, seems like it, it seems like it, \
         sounds like it, i am fairly sure, must be, appears so, it would seem so, kinda, sorta",
    ),
    (
        Cue::Indifferent,
        "do not care, does not matter, do not mind, any of them, any will do, any one will do, \
         either one, either is fine, either way, whatever you like, whatever you want, whichever \
         you like, whichever you want, you choose, you decide, you pick, up to you, it is up to \
         you, no preference, makes no difference, all the same, all the same to me, surprise me, \
         not important, not picky, could not care less, not fussed, not bothered, i am easy, your \
         choice, it is your choice, your call, no matter, irrelevant",
    ),
    (
        Cue::Reply,
        "no problem, no problems, no worries, no big deal, not a problem, not a big deal, do not \
         worry, do not worry about it, no rush, no hurry, not to worry, not bad, not too bad, no \
         offense, no offence, no harm done, no pressure, no wonder, no comment, no pun intended, \
         no hard feelings, no biggie, no stress, no sweat, no need to worry, no need to hurry, \
         take your time, yeah right, oh really, as if, you do not say, is that so, i see, fair \
         enough, got you, gotcha, understood, you know, you know what i mean, you know what, so \
         what, not only, whether or not, or not, more often than not, if not, why not both, no \
         less, no more no less, no matter what, no fair, no joke, no use, no such luck, no need \
         to rush, long story short, to be honest, to be fair, believe it or not, like it or not, \
         last but not least, better late than never, so so, good question, no end, in no time, no \
         pain no gain, no news is good news",
    ),
    (
        Cue::Repair,
        "i mean, i meant, i meant to say, sorry, so sorry, i am sorry, my bad, my mistake, my \
         fault, wait, wait a minute, wait a second, wait a sec, hold up, actually, or rather, \
         well actually, correction, oops, whoops, oopsie, excuse me, apologies, pardon me, i \
         misspoke, i said, let me rephrase, rather the, better, or better, make that, make it, or \
         actually, or should i say, i should say, come to think of it, on second thought, on \
         second thoughts, i changed my mind, changed my mind, change that, change it to, change \
         that to, i take that back, instead, that is to say, i mean to say, wrong word, i beg \
         your pardon",
    ),
    (
        Cue::Withdraw,
        "scratch that, strike that, scrap that, ignore that, disregard that, forget that, delete \
         that, undo that, take that back, not that sorry, erase that, scratch the last, cross \
         that out, belay that",
    ),
];
