//! What people ask a robot to do, the dialogue itself included.

use crate::cue::Cue;

pub(super) const LISTS: &[(Cue, &str)] = &[
    (
        Cue::Fetch,
        "get, bring, fetch, hand, pass, give, grab, take, pick, pick up, find, deliver, reach, \
         retrieve, select, choose, go for, look for, search for, show, getting, bringing, \
         fetching, handing, carry, pull out, go with, send, pick out, collect, hand over, lift, \
         toss, throw, provide, serve, bring over, bring out, reach for",
    ),
    (
        Cue::Want,
        "want, need, would like, would love, would prefer, prefer, looking for, searching for, am \
         after, can i have, could i have, may i have, can i get, could i get, may i get, can we \
         have, let me have, i will have, i will take, desire, require, i was thinking of, i was \
         hoping, i was looking for, i was wondering, i was thinking, wish for, i like, i would \
         take, i would have, how about, what about, can we get, might i have, go for the, would \
         rather have, would want, i will go with, i would go with, i choose, i pick, i would \
         choose",
    ),
    (
        Cue::Put,
        "put, place, puts, putting, set, leave, return, store, load, unload, book us, book a, \
         book the, reserve, empty, clean, lay, clear the, clear my, clear your, clear our, clear \
         up, clear out, clean up, wipe, wash, open, close, turn on, turn off, switch on, switch \
         off, move, fill, sweep, dust, unpack, drop",
    ),
    (
        Cue::Stop,
        "stop, stop it, stop that, stop now, stop moving, stop right there, stop there, stop \
         everything, halt, freeze, do not move, hold it, hold still, stand still, stay still, \
         emergency stop, e stop, estop, whoa, woah, quit it, quit moving, cut it out, abort, stop \
         the robot, stop the arm, stop motion, stop what you are doing, stay where you are, \
         pause, do not do that, do not do anything, do not touch that, do not touch it, hold your \
         horses, stahp, cease, knock it off, stop stop",
    ),
    (
        Cue::Cancel,
        "never mind, nevermind, nvm, cancel, cancel that, cancel it, cancelled, forget it, forget \
         about it, forget about that, forget the whole thing, forget i asked, forget i said \
         anything, do not bother, leave it be, call it off, scrap it, i do not need it anymore, i \
         do not want it anymore, do not need it anymore, do not want it anymore, no longer need \
         it, no longer want it, i do not need it, i do not need anything, i do not want anything, \
         do not need anything, do not want anything, i do not need that anymore, no need, not \
         necessary, not needed, no longer needed, not needed anymore, not anymore, not any more, \
         quit, exit, cancel my request, cancel the request, cancel my order, cancel the order, \
         cancel everything, i will get it myself, i will do it myself, i got it myself, i will \
         grab it myself, i found it, i have found it, do not get me anything, do not get \
         anything, do not bring me anything, do not bring anything, do not fetch anything, i want \
         nothing, never you mind, i am all set, we are done, i am done, it is okay i do not need \
         it, undo, disregard, withdraw, i do not need one anymore, i give up, forget this, do not \
         worry about getting it, it does not matter anymore, does not matter anymore, does not \
         matter any more, leave it ., drop it ., let it be ., let it go ., i am good ., i am fine \
         ., we are good .",
    ),
    (
        Cue::Repeat,
        "repeat, repeat that, repeat it, repeat please, repeat the question, repeat yourself, say \
         that again, say it again, say again, come again, what did you say, what did you just \
         say, what did you ask, what was that, what was that again, what was the question, what \
         is the question, what are you asking, what are you saying, one more time, once more, \
         once again, again please, did not hear you, did not hear that, did not hear, could not \
         hear you, could not hear that, could not hear, can not hear you, can not hear, did not \
         catch that, did not catch it, did not quite catch that, did not get that, did not quite \
         get that, did not understand, do not understand, did not understand that, did not \
         understand you, do not understand you, missed that, i missed it, i missed what you said, \
         what do you say, ask again, ask me again, ask that again, speak up, louder, tell me \
         again, sorry what, i am sorry what, sorry what was that, sorry what did you say, say \
         what, what you say, what again, wait what, pardon what, can you say that again, what did \
         you mean, could you speak up, i did not hear the question, did not hear the question, \
         did not follow, you what, how was that, read that again, rephrase, please repeat, what \
         were you saying, what were you asking, replay, reiterate, restate, what did you just \
         ask, what did you want, what was it you said, what was it you asked, what was it again, \
         what would you say",
    ),
    (Cue::Huh, "huh, pardon, eh, hm what, what what, excuse me what, what huh, hunh, wha, again"),
    (
        Cue::StartOver,
        "start over, start again, start anew, start afresh, start fresh, start from scratch, \
         start from the beginning, start from the top, restart, reset, begin again, begin anew, \
         begin from the beginning, begin over, from the beginning, from scratch, back to the \
         beginning, back to the start, back to square one, go back to the start, go back to the \
         beginning, try again, try that again, try this again, do over, do it over, new request, \
         new order, all over again, take it from the top, forget everything, forget everything i \
         said, forget all that, forget all of that, forget what i said, forget what i just said, \
         forget everything i just said, clear everything, wipe the slate clean, clean slate, \
         redo, reboot, let us start over, start the whole thing over, start all over, start it \
         over, rewind, different request, i want something else entirely, from the top ., start \
         the whole thing again, start this over, start that over, start everything over, go back \
         to start, back to start, start new",
    ),
    (
        Cue::AskBack,
        "do you have, have you got, is there, are there, do you see, can you see, what do you \
         have, what have you got, what do you see, what can you see, what are the, what are my, \
         what are your, what can i, what could i, how many, how much, what else, which one do you \
         mean, which do you mean, what do you mean, what kind of, what kinds of, what sort of, \
         what sorts of, what types of, where is, where are, what is in, what is on, what is \
         there, what is inside, what is left, what is available, what are they, what is it, which \
         are, which ones, tell me the, tell me what, tell me which, tell me about, show me what, \
         show me the options, list the, list all, list your, name the, what can you do, what can \
         you get, what can you bring, what can you fetch, what can you pick, what are you doing, \
         what are you looking for, why do you ask, why are you asking, does it matter, which is, \
         which of, what do they look like, what does it look like, how big, how small, how long \
         is, how do they differ, what options, what choices, do you know, do you mean, did you \
         mean, are you asking, which would you, what would you, what are we, what you got, what \
         you have, any other, can you tell me, could you tell me, would you tell me, what is the \
         difference, i do not know what you have, what does that mean, are any, is one of, are \
         all, are they all, what objects, what things, what items, read me the, describe the, \
         describe them, what am i choosing from, what all, do we have, have we got, can i see",
    ),
];
