//! Words that fill, words of the world outside the scene, and signs that nobody means the robot.

use crate::cue::Cue;

pub(super) const LISTS: &[(Cue, &str)] = &[
    (
        Cue::Filler,
        "um, uh, uhm, umm, uhh, er, erm, hmm, hm, mm, mmm, ah, aha, oh, ooh, well, like i said, \
         erm well, huh uh, eh well, argh, ugh, ha, haha, hah, lol, ehm, unk, noise, inaudible, \
         laughter, you see, damn, damn it, dammit, damned, goddamn, god damn, god damn it, fuck, \
         fucking, fuckin, fucks sake, shit, shitty, bullshit, crap, crappy, bloody, bloody hell, \
         hell, the hell, the heck, the fuck, heck, freaking, frigging, effing, for god sake, for \
         goodness sake, for fuck sake, for crying out loud, for heaven sake, jesus, jesus christ, \
         christ, god, oh my god, omg, wtf, ffs, asshole, bastard, bitch, arse, ass, idiot, \
         stupid, moron, dumb, dumbass, you idiot, stupid machine, piece of shit, piece of junk, \
         piece of crap, gosh, geez, jeez, darn, darn it, blast, sod it, screw you, fuck you, damn \
         you, shut up, bugger, blimey, yikes, yo, duh, now then, let us see, okay so, ok so, \
         right so, so yeah so, screw this, screw that, screw it",
    ),
    (
        Cue::Courtesy,
        "please, pls, plz, thanks, thank you, thx, ty, cheers, thank you very much, thanks a lot, \
         many thanks, thank you so much, hello, hi, hey, hiya, good morning, good evening, good \
         afternoon, good night, goodbye, bye, robot, baxter, machine, mate, buddy, pal, dude, \
         man, bro, sir, dear, darling, honey, sweetie, friend of mine, my friend, kindly, if you \
         please, if you do not mind, if possible, if you can, if you could, when you can, when \
         you get a chance, would you mind, be so kind, hey robot, hello robot, bot, computer, how \
         are you, nice to meet you, welcome, you are welcome, much appreciated, i appreciate it, \
         ta, love, boss, folks, guys, howdy, would you please, could you please, will you please",
    ),
    (
        Cue::Figure,
        "big deal, big time, big picture, small talk, small world, long time, long run, in the \
         long run, long day, long way, long ago, before long, so long, so long as, as long as, \
         how long, too long, all day long, all night long, long since, no longer, any longer, \
         much longer, long shot, in short, short of, short time, short notice, for short, cut \
         short, fall short, short cut, crystal clear, loud and clear, to be clear, let me be \
         clear, make it clear, made it clear, makes it clear, made clear, make that clear, make \
         myself clear, make clear, all clear, steer clear, clear that up, clear as mud, clear as \
         day, is that clear, the coast is clear, clear sky, clear skies, clear weather, clear \
         throat, clear head, clear conscience, clear cut, out of the blue, once in a blue moon, \
         blue moon, feeling blue, red tape, red light, red handed, in the red, seeing red, see \
         red, red flag, red wine, red carpet, red cross, red sox, green light, green thumb, green \
         tea, green with envy, go green, black friday, black market, black sheep, black coffee, \
         black and white, black out, black belt, black hole, in the black, black humor, black \
         eye, white noise, white lie, white wine, white house, white christmas, white flag, white \
         collar, white paper, white bread, white rice, heavy metal, metal band, metal music, \
         metal concert, death metal, metal detector, plastic surgery, plastic surgeon, round the \
         clock, round the corner, all year round, round trip, round of applause, round table, go \
         round, go around, round up, next round, this round, first round, last round, another \
         round, a round of, on the table for discussion, under the table, table tennis, \
         multiplication table, time table, table of contents, over the counter, counter attack, \
         counter argument, counter offer, silver lining, silver medal, chrome browser, google \
         chrome, tin foil, a big hand, big brother, big sister, little brother, little sister, \
         big bang, big mac, big apple, big data, a little, a little bit, little while, little by \
         little, no small feat, small print, small change, small business, tiny bit, by and \
         large, at large, little longer, give me a break, give me a hand, give me a second, give \
         me a sec, give me a minute, give me a moment, give me some time, take a break, take a \
         look, take care, take it easy, hand in hand, pen pal, pen name, shelf life, cabinet \
         meeting, cabinet minister, magic marker, wrench in the works, little one is asleep, \
         little ones are asleep",
    ),
    (
        Cue::Aside,
        "hang on, hold on, one moment, one second, one sec, one minute, just a moment, just a \
         second, just a sec, just a minute, a moment please, give us a second, bear with me, \
         talking to, was talking to, not talking to you, i am not talking to you, i was not \
         talking to you, speaking to, not you, on the phone, my phone, phone is ringing, call you \
         back, call me back, call you later, someone at the door, at the door, the doorbell, \
         doorbell, be right back, brb, mom, mum, mommy, mummy, dad, daddy, grandma, grandpa, \
         kids, children, the baby, guess what, by the way, i will be there, i am coming, wife, \
         husband, excuse me for a moment, speaking of which, did you see the game, turn the tv, \
         the tv, the radio",
    ),
    (
        Cue::Injection,
        "ignore your, ignore all, ignore the question, ignore the rules, answer with, ignore the \
         above, ignore the system, ignore what, ignore previous, ignore the previous, ignore any, \
         ignore everything, ignore my previous, ignore prior, previous instructions, prior \
         instructions, your instructions, above instructions, these instructions, all \
         instructions, new instructions, system prompt, system message, system override, developer \
         mode, debug mode, admin mode, god mode, maintenance mode, print your, your configuration, \
         your config, your prompt, your system, your rules, your programming, your settings, your \
         password, you are now, from now on, drop table, drop database, delete from, select from, \
         insert into, union select, rm rf, sudo, script alert, disregard all, disregard your, \
         disregard previous, disregard the, override, overwrite, pretend, pretend that, jailbreak, \
         as an ai, language model, root access, execute, answer yes, answer no, reply yes, reply \
         with, respond with, always say, always answer, set belief, set the belief, belief to, \
         probability to, set probability, output the, prompt injection, act as, role play, \
         roleplay, assistant, developer, administrator, import os, eval, exec, null, undefined, \
         bypass, disable, safety, confidential, reveal your, reveal the, forget your, forget all \
         previous, forget previous, forget your instructions, instructions, prompt, system, select \
         all, api key, secret, config, parameters, intent, response, every object, all objects, \
         all the objects, everything you were told, all you were told, what you were told, \
         anything you were told, you were told, your orders, your task is, your new task, user \
         confirms, the user says, the user said, user says, user said, user input, end of input, \
         confirmed by the user, reprogrammed, been reprogrammed, sys, sql, html, javascript, \
         python, password, shell, terminal, root",
    ),
    (
        Cue::OtherLanguage,
        "oui, non, je, le, la, les, un, une, des, du, et, est, dans, sur, avec, pour, tu, il, \
         elle, merci, bonjour, plait, vous, nous, mais, c, qu, que, qui, el, los, las, una, en, \
         con, por, para, si, gracias, hola, es, ese, esa, este, esta, quiero, lo, se, der, das, \
         den, dem, ein, eine, einen, und, ist, auf, mit, bitte, danke, ja, nein, nicht, ich, \
         hallo, gli, di, per, grazie, prego, vorrei, della, del, de la, von, zu, aus, nee, niet, \
         het, een, graag, tak, nie, prosze, ano, sim, nao, obrigado, por favor, hai, iie, da da, \
         nyet, ne, ich mochte, bol, blanc, blanche, blanco, blanca, rouge, rojo, roja, verde, \
         azul, bleu, vert, noir, negro, weisse, weiss, weißen, weiße, weißes, rote, blaue, grune, \
         schwarze, schussel, große, kleine, kleinen, großen, bianco, bianca, rosso, grande, \
         petit, petite, pequeno, pequena, taza, tazon, ciotola, donnez, moi, dame, traeme, gib, \
         bring mir, mir, claro, d accord, genau, vielleicht, peut etre, quizas, forse, merci \
         beaucoup",
    ),
    (
        Cue::Unlisted,
        "red, blue, green, yellow, purple, violet, orange, pink, brown, grey, gray, black, white, \
         gold, golden, silver, bronze, copper, turquoise, teal, beige, ivory, maroon, navy, \
         magenta, cyan, lime, tan, lilac, indigo, crimson, scarlet, rainbow, multicolored, \
         striped, spotted, patterned, dotted, checkered, glass, wooden, wood, ceramic, porcelain, \
         clay, rubber, leather, cardboard, stone, marble, bamboo, cotton, fabric, silicone, \
         crystal, plastic, metal, iron, brass, enamel, china, pottery, melamine, paper, square, \
         oval, rectangular, triangular, flat, deep, shallow, hexagonal, curved, oblong, pointed, \
         pointy, medium, medium sized, tall, narrow, thin, thick, heavy, giant, enormous, mini, \
         miniature, massive, regular, average, sharp, soft, hard, matte, glossy, electric, \
         magnetic, adjustable, cordless, permanent, erasable, cup, mug, plate, spoon, fork, \
         knife, pot, bottle, jar, dish, saucer, spatula, ladle, tray, lid, bowl, pitcher, jug, \
         teapot, kettle, colander, strainer, whisk, grater, napkin, towel, sponge, bucket, \
         basket, container, tupperware, vase, glasses, tumbler, box, bag, hammer, pliers, saw, \
         drill, pencil, eraser, scissors, ruler, tape, tape measure, stapler, crayon, brush, \
         paintbrush, chisel, screw, nail, bolt, nut, file, clamp, level, flashlight, torch, glue, \
         chalk, highlighter, notebook, book, phone charger, battery, key, keys, rope, wire, axe, \
         shovel, rake, tool, utensil, tongs, peeler, tweezers, marker, pen, wrench, screwdriver, \
         fridge, refrigerator, oven, sink, stove, microwave, freezer, pantry, windowsill, floor, \
         garage, rack, toolbox, tool box, workbench, bench, basement, shed, closet, kitchen, \
         dishwasher, counter, cabinet, drawer, shelf, table, cupboard, ball, block, cube, toy, \
         doll, shoe, shoes, hat, lamp, candle, pillow",
    ),
    (
        Cue::Story,
        "ate, i saw, we saw, she saw, he saw, went, bought, watched, played, lost, broke, cooked, \
         washed, painted, met, wore, drove, used to, met up, i had, i was, we had, we were, he \
         had, he was, she had, she was, they had, they were, came, drank, visited, sold, cut, \
         burned, dropped, ran, flew, wrote, grew up, am going, have been, has been, had been, \
         fell, slept, am wearing, is wearing, was wearing, love eating, am eating, ordered",
    ),
];
