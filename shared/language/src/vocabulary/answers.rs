//! Yes, no, and everything between; repairs of what was said.

use crate::cue::Cue;

pub(super) const LISTS: &[(Cue, &str)] = &[
    (
        Cue::Yes,
        "yes, yeah, yep, yup, sure, yea, yah, yess, ye, yeh, yis, aye, uh huh, uhhuh, mm hmm, \
         mmhmm, mhm, mm hm, m hm, mmhm, affirmative, indeed, of course, that is it, that is right, \
         that is correct, that is true, that is the one, that is the right one, that is the \
         correct one, that is that, that is mine, this is it, this is the one, you got it, you \
         have got it, got it in one, you are right, you are correct, you bet, you guessed it, i \
         think so, i believe so, i guess so, i suppose so, i would say so, i should think so, \
         think so, guess so, i hope so, by all means, sure thing, for sure, sure is, no doubt, \
         without a doubt, no question, why not, bingo, spot on, right on, exactly right, quite \
         right, quite so, that would be it, that would be the one, that will be it, that will be \
         the one, sounds right, looks right, seems right, sounds good, that sounds right, that \
         sounds good, yes please, go ahead, go for it, yessir, hell yes, hell yeah, yes sir, it \
         sure is, it certainly is, it definitely is, it really is, most certainly, most \
         definitely, you are spot on, roger, that goes without saying, it goes without saying, \
         thumbs up, too right, damn right, damn straight, without doubt, that one there, there you \
         go, exactly that one, that very one, that is what i want, that is what i wanted, that is \
         what i mean, that is what i meant, that is the one i want, that is the one i wanted, that \
         is the one i mean, that is the one i meant, 10 4, ten four, nailed it, you nailed it, yes \
         it is, i am afraid so, that is exactly right, that is exactly it, positive, ya, very much \
         so, so very much, that is the ticket, that is the badger, that is the stuff, that is the \
         spirit, that is the fella, that is the fellow, that is the guy, that is the baby, that is \
         the bunny, that is the way, just the ticket, hit the nail on the head, on the nose, on \
         the button, on the money, right on the money, bang on, dead on, dead right, bang to \
         rights, you said it, you can say that again, i will say, could not be more right, could \
         not be righter, could not agree more, could not have said it better, could not put it \
         better, took the words right out of my mouth, took the words out of my mouth, bullseye, \
         jackpot, eureka, ding ding, ding ding ding, right first time, first time right, no two \
         ways about it, no ifs or buts, no ifs no buts, no ifs ands or buts, hits the spot, hit \
         the spot, fits the bill, ticks the box, ticks all the boxes, does the trick, that does \
         the trick, that did it, you have hit it, hit it in one, full marks, correctamundo, okie \
         dokie, okey dokey, okey doke, yes sirree, yessiree, righto, righty, right oh, right you \
         are, aye aye, hear hear, amen, amen to that, i second that, as sure as eggs is eggs, sure \
         as hell, you betcha, betcha, damn skippy, does a bear shit in the woods, is the pope \
         catholic, do bears shit in the woods, yse, ys, yeas, yees, yers, yass, yas, yus, yuh, \
         yeps, yepp, yeppers, yupp, fraid so, afraid so, hundred percent, a hundred percent, one \
         hundred percent, 100 percent, 100, a thousand times yes, that is him, that is her, that \
         is them, that is that one, the very one, the very same, the very thing, that is the very \
         one, the one and only, one and the same, got it right, guessed right, guessed it, guessed \
         correctly, right guess, good guess, correct guess, well guessed, you are on the right \
         track, on the right track, you have nailed it, there you have it, there we go, now you \
         have got it, now you have it, now we are talking, that is my one, same one, exactly the \
         one, just the one, just that one, just right, exactly so, just so, even so, such is the \
         case, that is the case, this is true, this is right, this is correct, this is so, that is \
         so, that is a fact, it is a yes, that is affirmative, that is a definite yes, why \
         certainly, of course it is, but yes, naturally yes, you know it is, sounds about right, \
         about right, looks about right, seems about right, seems about it, that is about right, \
         that is about the size of it, more or less yes, it is a match, we have a match, we have a \
         winner, winner winner chicken dinner, touche, say no more, no argument, no argument \
         there, no argument from me, no arguments, no contest, no objection, no objections, \
         nothing but yes, not wrong, you are not wrong, not incorrect, nothing wrong with that, \
         can not argue with that, no mistake, no mistake about it, make no mistake, no denying it, \
         no denying that, there is no denying it, there is no doubt, there is no doubt about it, \
         there is no question, beyond doubt, beyond question, beyond a doubt, beyond a shadow of a \
         doubt, no brainer, bet, fo sho, fer sure, def, deffo, totes, yip, that is more like it, \
         more like it, i would guess so, i should guess so, my guess is yes, please do ., nail on \
         the head, bob on, smack on, slap bang on, that is my baby, that is my boy, that is my \
         girl, safe bet, a safe bet, it is a safe bet, you can bank on it, bank on it, you can \
         count on it, count on it, you can bet on it, you bet it is, take it ., take that one, \
         take this one, grab it, grab that one, get that one, i will take it, i will take that \
         one, i will have that one, i want that one, i want this one, i want that, i want it ., i \
         would like that one, give me that one, give me that, give it to me, bring it, bring it \
         here, bring that one, bring me that one, get it, get me that one, hand it over, hand it \
         to me",
    ),
    (
        Cue::WeakYes,
        "ok, okay, okey, k, kk, right, good, great, fine, perfect, correct, true, exactly, \
         precisely, absolutely, definitely, certainly, totally, obviously, naturally, excellent, \
         wonderful, lovely, cool, super, alright, all right, completely, yes right, clearly, \
         surely, it is, it is the one, it is the right one, it is that one, it is this one, it \
         does, they are, it is so, it has, it was, they do, awesome, very good, very well, that is \
         good, that is fine, that works, that is great, that is perfect, that one, this one, \
         undoubtedly, entirely, accept, agreed, i agree, confirmed, confirm, that is what i said, \
         i am sure, i am pretty sure, pretty sure, fairly sure, quite sure, i am certain, i am \
         positive, i do, it would be, no kidding, would do, that will do, that would do, as you \
         say, i said so, got it, indubitably, assuredly, unquestionably, decidedly, undeniably, \
         evidently, positively, indisputably, unmistakably, emphatically, literally, certainly so, \
         verily, truly, granted, approved, accepted, it has that, it is there, you could say that, \
         you could say so, one could say that, one might say so, that will do nicely, that would \
         do nicely, true that, true enough, fair play, affirm, roger that, copy that, ten out of \
         ten, super duper, splendid, brilliant, fantastic, marvellous, marvelous, terrific, \
         amazing, superb, grand, ideal, bravo, well done, good job, great job, nice one, good \
         work, smart robot, clever robot, good robot, it has been, i can confirm that, i can \
         confirm, i confirm, i confirm that, we agree, my thoughts exactly, my sentiments exactly",
    ),
    (
        Cue::No,
        "no, nope, nah, naw, noo, nay, nop, uh uh, uhuh, nuh uh, nuh huh, mm mm, no way, no sir, \
         no thanks, no thank you, not a chance, no chance, hardly, i do not think so, do not think \
         so, i do not believe so, i doubt it, i doubt that, not even close, hell no, heck no, \
         thumbs down, wrong one, that is wrong, you are wrong, the wrong one, that is incorrect, \
         that is the wrong one, that is false, no sirree, it is wrong, none of those, none of \
         them, none of these, neither of them, none, not on your life, nothing like it, not by a \
         long shot, not a bit, not one bit, under no circumstances, unlikely, highly unlikely, \
         anything but that, far from it, by no means, on the contrary, keep looking, you are \
         mistaken, not in a million years, in no way, some other one, a different one, not my one, \
         not what i want, not what i asked, not what i asked for, not what i meant, not what i \
         said, not what i am looking for, not what i wanted, not what i need, guess again, wrong \
         again, wrong guess, bad guess, guessed wrong, no dice, no cigar, close but no cigar, nice \
         try, nice try but no, no can do, no siree, no sirree bob, nosiree, nope nope, wide of the \
         mark, way off, way off the mark, off the mark, off base, way off base, barking up the \
         wrong tree, wrong tree, on the wrong track, you are on the wrong track, wrong track, ice \
         cold, getting colder, you are getting colder, you are cold, not warm, not on your nelly, \
         not your cup of tea, not my cup of tea, not by a long chalk, not by a mile, not by any \
         means, not by any stretch, not by any stretch of the imagination, dream on, in your \
         dreams, fat chance, when pigs fly, when hell freezes over, over my dead body, that will \
         be the day, no luck, think again, look again, fraid not, afraid not, hard no, that is a \
         no, it is a no, it is a no from me, negatory, nuhuh, nopes, nopers, nuh, naah, noes, noe, \
         absolutely not, try another, try another one, try a different one, try the other one, \
         keep trying, keep going, keep guessing, next one please, next please, next ., strike one, \
         strike two, swing and a miss, missed, you missed, that is a miss, no match, not a match, \
         mismatch, wrong answer, you have got it wrong, you got it wrong, you got that wrong, got \
         it wrong, got that wrong, you have it wrong, you have got that wrong, you have got the \
         wrong one, you got the wrong one, pointing at the wrong one, the wrong way, wrong thing, \
         the wrong thing, that is not it chief, quite the contrary, quite the opposite, the other \
         way around, the other way round, could not be further from the truth, could not be more \
         wrong, nothing of the sort, nothing of the kind, nothing like that, no such thing, like \
         hell, like hell it is, my foot, pull the other one, far from that, never ever, never in a \
         million years, never in my life, no fear, doubtful, i have my doubts about that, highly \
         doubtful, very doubtful, not that i know of, not that i know, not that i am aware of, not \
         that i can see, not that i can tell, not that i remember, not that i recall, not to my \
         knowledge, not as far as i know, not as far as i can tell, not in my book, not likely, \
         not very likely, not bloody likely, not especially, not particularly, not in the \
         slightest, not remotely, not nearly, not anywhere near, nowhere near, not this time, not \
         today, nix, nada, that is not the case, that is not so, not so, not so much, not true, \
         not as such, not for me, you are off, i would not say that ., i would not say so, could \
         be further from the truth, nothing could be further from the truth, not for the world, \
         not for all the tea in china, not for love nor money, not for love or money, not in a \
         month of sundays, not in this life, not if i can help it, wrong end of the stick, i beg \
         to differ, beg to differ, i disagree with that, leave that one, leave that, leave it \
         there, put that one back, put it back, put that back, not that way, try somewhere else, \
         look somewhere else, wrong place, wrong color, wrong colour, wrong size, wrong kind, \
         wrong shape, not any longer",
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
         could not say, can not tell, could not tell, hard to say, hard to tell, difficult to say, \
         do not remember, can not remember, could not remember, do not recall, can not recall, i \
         forget, wish i knew, beats me, search me, depends, it depends, not necessarily, yes and \
         no, no and yes, yes or no, yes but no, no but yes, yes and also no, both yes and no, \
         neither yes nor no, are you sure, make sure, you sure, sure about that, sort of yes and \
         no, anyone is guess, undecided, can not decide, could go either way, your guess is as \
         good as mine, idk, let me think, let me see, let me check, i wonder, do not have a clue, \
         do not have any idea, have not decided, not decided, yes no maybe, no yes maybe, not \
         positive, hmm not sure, i forgot ., can not be sure, could not be sure, can not be \
         certain, can not really say, can not really tell, on the fence, i am on the fence, fifty \
         fifty, 50 50, fifty, six of one, half and half, in two minds, i am in two minds, of two \
         minds, i have my doubts, have my doubts, mixed feelings, swings and roundabouts, jury is \
         still out, jury is out, touch and go, toss up, it is a toss up, coin flip, flip a coin, \
         hard to be sure, no way to know, no way of knowing, no way to tell, no telling, there is \
         no telling, god knows, heaven knows, lord knows, goodness knows, who can say, who can \
         tell, anybody is guess, anyone knows, not clear to me, lost track, i lost track, slipped \
         my mind, it slipped my mind, drawing a blank, i am drawing a blank, got no idea, got no \
         clue, not the foggiest, have not the foggiest, have not the faintest, not the faintest, \
         not the faintest idea, the foggiest, ask me another, ask me something else, can not see \
         it, can not see it from here, can not see from here, could not see it, not in a position \
         to say, could be either, could be both, might be either, it is complicated, complicated, \
         that depends, depends on, tough to say, tough call, tough one, tricky one, tricky to say, \
         good question ., can not see, could not see, can not make it out, can not make out, can \
         not read it, partly, partially, to some extent, to a degree, up to a point, in a way, \
         jury still out, the jury still out",
    ),
    (
        Cue::Hedge,
        "maybe, perhaps, possibly, might be, may be, could be, i think, i guess, i believe, i \
         suppose, i would say, i reckon, i assume, i presume, it might, it may, it could, might, \
         could well be, presumably, supposedly, conceivably, i think maybe, not yet, i feel like, \
         if i remember, if i recall, if i am not mistaken, as far as i know, as far as i remember, \
         i imagine, apparently, i am thinking, maybe maybe not, maybe not sure, could possibly be, \
         may well be, it may well be, might well be, might just be, if memory serves, if memory \
         serves me, if memory serves me right, if i remember correctly, if i remember right, if i \
         recall correctly, to the best of my knowledge, to the best of my recollection, to my \
         knowledge, from what i remember, from memory, from what i can tell, from what i can see, \
         as far as i can tell, as far as i can see, as far as i recall, i have a feeling, i have a \
         hunch, i am guessing, i would guess, my guess is, my best guess is, best guess, i vaguely \
         remember, i seem to remember, i seem to recall, i want to say, i am tempted to say, quite \
         possibly, very possibly, plausibly, potentially, perchance, feasibly, seemingly, \
         arguably, roughly, i am leaning towards, leaning towards, i am inclined to think, i am \
         inclined to say, i suspect, i expect, i gather, i fancy, hopefully, i am not mistaken, \
         correct me if i am wrong, do not quote me on that, do not quote me, in my opinion, in my \
         view, it could well be, something like that, or something, or something like that, or \
         whatever, or so, or thereabouts, last i checked, last time i checked, last i heard, last \
         i saw, last time i looked, the last time i looked, the last time i checked, the last time \
         i saw it, last time i saw it, when i last looked, when i last checked, when i last saw \
         it, at least i think so, at least i think, i am almost certain, almost certain",
    ),
    (
        Cue::Likely,
        "probably, likely, most likely, very likely, most probably, very probably, i am fairly \
         certain, i am pretty certain, fairly certain, pretty certain, kind of, sort of, more or \
         less, pretty much, basically, mostly, almost certainly, should be, ought to be, seems so, \
         it seems so, looks like it, it looks like it, seems like it, it seems like it, sounds \
         like it, i am fairly sure, must be, appears so, it would seem so, kinda, sorta, more \
         likely than not, more than likely, as likely as not, i am inclined to say yes, inclined \
         to say yes, inclined to think so, i am inclined to think so, feels like it, it feels like \
         it, smells like it, looks that way, it looks that way, seems that way, it seems that way, \
         looks so, it looks so, in all likelihood, in all probability, nine times out of ten, \
         chances are, odds are, i would imagine so, i imagine so, i would assume so, i assume so, \
         i presume so, i reckon so, i expect so, i would expect so, i suspect so, i would bet on \
         it, i would bet, more or less so, ish, it ought to be, it should be, it must be, it has \
         to be, got to be, must be that one, by the looks of it, by the look of it",
    ),
    (
        Cue::Indifferent,
        "do not care, does not matter, do not mind, any of them, any will do, any one will do, \
         either one, either is fine, either way, whatever you like, whatever you want, whichever \
         you like, whichever you want, you choose, you decide, you pick, up to you, it is up to \
         you, no preference, makes no difference, all the same, all the same to me, surprise me, \
         not important, not picky, could not care less, not fussed, not bothered, i am easy, your \
         choice, it is your choice, your call, no matter, irrelevant, does not have to be, do not \
         have to be, does not need to be, do not need to be, need not be, it need not be, does not \
         necessarily have to be, it is all the same to me, it is all one to me, all one to me, no \
         strong feelings, no strong opinion, i am not bothered, not bothered which, whatever \
         works, whatever works for you, whatever is easiest, whatever is closest, whichever is \
         closest, whichever is easiest, whichever is nearest, dealer is choice, take your pick, be \
         my guest, no skin off my nose, not fussy, i am not fussy, i am flexible, i could go \
         either way, it makes no odds, makes no odds, it is immaterial, immaterial, you be the \
         judge, i was about to say, i nearly said, i almost said, i first thought, at first i \
         thought, i first said, i was going to say, i wanted to say",
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
         less, no more no less, no matter what, no fair, no joke, no use, no such luck, no need to \
         rush, long story short, to be honest, to be fair, believe it or not, like it or not, last \
         but not least, better late than never, so so, good question, no end, in no time, no pain \
         no gain, no news is good news, no strings attached, no news, no laughing matter, no mean \
         feat, no time to lose, no way out, no way around it, no way back, no point, no point in \
         that, no time, no time like the present, no place like home, no shame, no love lost, no \
         man is land, no picnic, no walk in the park, no rest for the wicked, no smoke without \
         fire, no good deed goes unpunished, no prize for guessing, no prizes for guessing, no \
         skin off my teeth, no probs, no prob, no trouble, no trouble at all, no bother, no fuss, \
         no drama, no dramas, no frills, no holds barred, no stone unturned, no spring chicken, no \
         room to swing a cat, no great shakes, no better time, not to mention, not half bad, not \
         too shabby, not a moment too soon, not rocket science, easy does it, easy peasy, bob is \
         your uncle, bless you, break a leg, long time no see, better safe than sorry, easier said \
         than done, so far so good, that is life, what can i say, go figure, good luck, fingers \
         crossed, you are getting warmer, getting warmer, warmer, getting there, you are getting \
         there, almost there, nearly there, getting close, you are close, close enough, so close",
    ),
    (
        Cue::Repair,
        "i mean, i meant, i meant to say, sorry, so sorry, i am sorry, my bad, my mistake, my \
         fault, wait, wait a minute, wait a second, wait a sec, hold up, actually, or rather, well \
         actually, correction, oops, whoops, oopsie, excuse me, apologies, pardon me, i misspoke, \
         i said, let me rephrase, rather the, better, or better, make that, make it, or actually, \
         or should i say, i should say, come to think of it, on second thought, on second \
         thoughts, i changed my mind, changed my mind, change that, change it to, change that to, \
         i take that back, instead, that is to say, i mean to say, wrong word, i beg your pardon, \
         hang on no, or wait, oh wait, no hang on, let me correct myself, i stand corrected, my \
         apologies, i misspoke there, slip of the tongue, i got that wrong, i got it wrong, silly \
         me, i am mistaken, i was mistaken, on reflection, thinking about it, now that i think \
         about it, now i think about it, or maybe rather, nay rather, or better yet, better yet, \
         even better, better make that, better make it, make that a, let us say, let us make it, \
         or let us say, what am i saying, what i mean is, what i meant is, what i meant was, what \
         i meant to say, what i am trying to say, i should have said",
    ),
    (
        Cue::Withdraw,
        "scratch that, strike that, scrap that, ignore that, disregard that, forget that, delete \
         that, undo that, take that back, not that sorry, erase that, scratch the last, cross \
         that out, belay that",
    ),
];
