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
         the robot, stop the arm, stop motion, stop what you are doing, stay where you are, pause, \
         do not do that, do not do anything, do not touch that, do not touch it, hold your horses, \
         stahp, cease, knock it off, stop stop, do not grab it, do not take it, do not pick it up, \
         do not pick it, do not pick that up, do not pick that, do not grab that, do not take \
         that, do not move an inch, that is enough, stop at once, stop immediately, stop there \
         now, stop please stop, hold your fire, do not go any further, no further, hands off, back \
         off, back away, break off, shut down, shut it down, shut off, power off, kill the motor, \
         kill the arm, cut the power, cut the motor, watch out, look out, careful stop, easy stop, \
         freeze now, not another inch, stop the motion, stop the movement, stop your arm, stop the \
         gripper, stop grabbing, stop reaching, stop going, stand down, stand by .",
    ),
    (
        Cue::Cancel,
        "never mind, nevermind, nvm, cancel, cancel that, cancel it, cancelled, forget it, forget \
         about it, forget about that, forget the whole thing, forget i asked, forget i said \
         anything, do not bother, leave it be, call it off, scrap it, i do not need it anymore, i \
         do not want it anymore, do not need it anymore, do not want it anymore, no longer need \
         it, no longer want it, i do not need it, i do not need that anymore, no need, not \
         necessary, not needed, no longer needed, not needed anymore, not anymore, not any more, \
         quit, exit, cancel my request, cancel the request, cancel my order, cancel the order, \
         cancel everything, i will get it myself, i will do it myself, i got it myself, i will \
         grab it myself, i found it, i have found it, never you mind, i am all set, we are done, i \
         am done, it is okay i do not need it, undo, disregard, withdraw, i do not need one \
         anymore, i give up, forget this, do not worry about getting it, it does not matter \
         anymore, does not matter anymore, does not matter any more, leave it ., drop it ., let it \
         be ., let it go ., i am good ., i am fine ., we are good ., i do not want one anymore, i \
         do not want one any more, i do not need it any more, i do not want it any more, i do not \
         need one any more, no longer interested, not interested, not interested anymore, i am not \
         interested, changed my mind about it, i have changed my mind about it, forget i said it, \
         forget i said that, forget my request, forget my order, forget the order, forget the \
         request, drop the request, drop the order, drop the whole thing, scrap the whole thing, \
         cancel the task, cancel this, cancel all, cancel all that, abandon it, abandon the task, \
         abandon that, i no longer need it, i no longer want it, i no longer need one, let us \
         forget it, let us forget about it, let us drop it, let us leave it, let us not, do not \
         get it, do not fetch it, do not bring it, do not worry about that ., i have got one \
         already, i already have one, already got one, already have one, i have one already, i got \
         one already, got one already, i will find it myself, i will fetch it myself, i will take \
         care of it myself, i can get it myself, i can do it myself, i will manage, i can manage, \
         no thanks i am good, we do not need it, we do not need it anymore, we are all set, that \
         will be all, that is it for now, not right now ., maybe later ., some other time ., \
         another time ., revoke, retract, call off, call off the search, quit looking, give it up, \
         leave me alone, go away, i do not need anything ., i do not want anything ., do not need \
         anything ., do not want anything ., do not get me anything ., do not get anything ., do \
         not bring me anything ., do not bring anything ., do not fetch anything ., i want nothing \
         ., i need nothing ., i want nothing from you .",
    ),
    (
        Cue::Repeat,
        "repeat, repeat that, repeat it, repeat please, repeat the question, repeat yourself, say \
         that again, say it again, say again, come again, what did you say, what did you just say, \
         what did you ask, what was that, what was that again, what was the question, what is the \
         question, what are you asking, what are you saying, one more time, once more, once again, \
         again please, did not hear you, did not hear that, did not hear, could not hear you, \
         could not hear that, could not hear, can not hear you, can not hear, did not catch that, \
         did not catch it, did not quite catch that, did not get that, did not quite get that, did \
         not understand, do not understand, did not understand that, did not understand you, do \
         not understand you, missed that, i missed it, i missed what you said, what do you say, \
         ask again, ask me again, ask that again, speak up, louder, tell me again, sorry what, i \
         am sorry what, sorry what was that, sorry what did you say, say what, what you say, what \
         again, wait what, pardon what, can you say that again, what did you mean, could you speak \
         up, i did not hear the question, did not hear the question, did not follow, you what, how \
         was that, read that again, rephrase, please repeat, what were you saying, what were you \
         asking, replay, reiterate, restate, what did you just ask, what did you want, what was it \
         you said, what was it you asked, what was it again, what would you say, run that by me \
         again, run that past me again, run it by me again, come again please, what did you say to \
         me, what was that you said, what was that you asked, what was it, what were you saying \
         again, you said what, you asked what, did not make that out, could not make that out, \
         could not make it out, did not quite hear, did not quite hear you, did not quite hear \
         that, did not quite catch you, did not catch you, did not catch what you said, did not \
         hear what you said, did not hear the last part, did not get the question, what did you \
         want to know, what do you want to know, what is it you want to know, what is it you said, \
         what is that again, ask me once more, ask once more, ask me one more time, tell me once \
         more, tell me one more time, say that one more time, say it once more, speak louder, \
         speak slower, speak more slowly, speak clearly, slower please, slow down please, too \
         fast, too quiet, you are too quiet, you are mumbling, you mumbled, stop mumbling, i was \
         not listening, was not listening, was not paying attention, i was distracted, got \
         distracted, hear the question again, the question again, the question once more, question \
         again, question please, another time please, can not understand you, could not understand \
         you, could not understand, could not understand that, can not understand that, can not \
         understand, lost you there, i lost you, you lost me, i zoned out, zoned out, what was \
         your question, what is your question, your question, what is the question again, what was \
         the question again",
    ),
    (
        Cue::Huh,
        "huh, pardon, eh, hm what, what what, excuse me what, what huh, hunh, wha, again, beg \
         pardon, beg your pardon, i beg you pardon, sorry again, hmm what, what now, wot",
    ),
    (
        Cue::StartOver,
        "start over, start again, start anew, start afresh, start fresh, start from scratch, start \
         from the beginning, start from the top, restart, reset, begin again, begin anew, begin \
         from the beginning, begin over, from the beginning, from scratch, back to the beginning, \
         back to the start, back to square one, go back to the start, go back to the beginning, \
         try again, try that again, try this again, do over, do it over, new request, new order, \
         all over again, take it from the top, forget everything, forget everything i said, forget \
         all that, forget all of that, forget what i said, forget what i just said, forget \
         everything i just said, clear everything, wipe the slate clean, clean slate, redo, \
         reboot, let us start over, start the whole thing over, start all over, start it over, \
         rewind, different request, i want something else entirely, start the whole thing again, \
         start this over, start that over, start everything over, go back to start, back to start, \
         start new, start again from the top, start all over again, begin all over, begin all over \
         again, go back to the top, back to the top, from the start, go back to square one, take \
         it from the beginning, from zero, start from zero, start at zero, start at the beginning, \
         start from the start, start at the top, begin from scratch, begin from the start, begin \
         at the beginning, begin from the top, wipe everything, erase everything, delete \
         everything, forget all i said, forget all i told you, forget everything i told you, \
         forget everything so far, forget it all, scrap all that, scrap it all, scratch all that, \
         scratch all of that, ignore everything i said, ignore all i said, disregard everything i \
         said, disregard all i said, disregard what i said, ignore what i said, new start, fresh \
         start, a fresh start, make a fresh start, make a new start, clear the slate, clear it \
         all, clear all, clear all that, one more time from the top, one more time from the \
         beginning, again from the beginning, again from the start, again from the top, back to \
         zero, do it again from the start, do everything again, do that again from the start, \
         repeat from the beginning, repeat from the start, let us try again, let us try that \
         again, let us try this again, let us go again, let us do this again, let us do it again, \
         let us do that again, restart the whole thing, reset the conversation, reset everything, \
         reset all, reset yourself, restart the conversation",
    ),
    (
        Cue::AskBack,
        "do you have, have you got, is there, are there, do you see, can you see, what do you \
         have, what have you got, what do you see, what can you see, what are the, what are my, \
         what are your, what can i, what could i, how many, how much, what else, which one do you \
         mean, which do you mean, what do you mean, what kind of, what kinds of, what sort of, \
         what sorts of, what types of, where is, where are, what is in, what is on, what is there, \
         what is inside, what is left, what is available, what are they, what is it, which are, \
         which ones, tell me the, tell me what, tell me which, tell me about, show me what, show \
         me the options, list the, list all, list your, name the, what can you do, what can you \
         get, what can you bring, what can you fetch, what can you pick, what are you doing, what \
         are you looking for, why do you ask, why are you asking, does it matter, which is, which \
         of, what do they look like, what does it look like, how big, how small, how long is, how \
         do they differ, what options, what choices, do you know, do you mean, did you mean, are \
         you asking, which would you, what would you, what are we, what you got, what you have, \
         any other, can you tell me, could you tell me, would you tell me, what is the difference, \
         i do not know what you have, what does that mean, are any, is one of, are all, are they \
         all, what objects, what things, what items, read me the, describe the, describe them, \
         what am i choosing from, what all, do we have, have we got, can i see, what can you, what \
         could you, which can you, which could you, what may i, is there any, is there anything, \
         are there more, are there other, any more, any others, what others, what colour is, what \
         color is, what size is, what shape is, what is it made of, what are they made of, what is \
         that, what is this, tell me again what, tell me how many, tell me where, let me know \
         what, let me know which, remind me what, remind me which, show me all, give me a list, \
         give me the list, give me the options, give me the choices, give me options, go through \
         the, go over the, run through the, describe it, describe that, describe what, describe \
         your, list them, list me, list everything, list what, name them, name all, enumerate, do \
         you happen to have, do you happen to see, would you have, might you have, did you find, \
         did you look, did you check, have you seen, have you looked, have you checked, have you \
         found, you have any, you got any, got any, you have what, are you pointing, are you \
         talking, are you referring, are you looking, are you thinking, are you saying, which one \
         are you, what one, what ones, what about them, how come, how do i, how can i, how should \
         i, what happens if, what if, who are you, what are you",
    ),
];
