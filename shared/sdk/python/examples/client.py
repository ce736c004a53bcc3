"""A client: asks for an object, answers the robot's questions from the keyboard, and prints the outcome.

    python3 shared/sdk/python/examples/client.py "get me the bowl"
    python3 shared/sdk/python/examples/client.py "get me the bowl" --want clear   # answers by itself
"""

import argparse
import sys

from whichone import Client, NoPick
from whichone import messages as m


def true_answer(scene, question, wanted):
    """What a person who wants that object answers."""
    has = scene.attributes[wanted]
    match question:
        case m.QuestionPoint(number):
            return "yes" if scene.objects[number] == wanted else "no"
        case m.QuestionAttribute(attribute, value):
            name, values = list(scene.values.items())[attribute]
            return "yes" if has.get(name) == values[value] else "no"
        case m.QuestionWhich(attribute):
            return has.get(list(scene.values)[attribute], "no")
        case m.QuestionChoice(attribute, options):
            name, values = list(scene.values.items())[attribute]
            return has.get(name) if has.get(name) in [values[it] for it in options] else "neither"
    return "yes"


def converse(robot, number, wanted):
    """Answers each question until the interaction that utterance `number` belongs to has ended."""
    answered = 0
    for now in robot.watch():
        if now.view and now.view.applied >= number and not now.view.interaction:
            return
        if now.open_question and now.view.prompt > answered:
            answered = now.view.prompt
            print(f"robot  {now.view.text}")
            robot.say(true_answer(now.scene, now.open_question, wanted) if wanted else input("you    "))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("text", help="the request")
    parser.add_argument("--want", metavar="OBJECT", help="an object of the scene: the questions are answered truly")
    parser.add_argument("--group", help="the group: $WHICHONE_GROUP, else whichone")
    chosen = parser.parse_args()
    with Client(chosen.group) as robot:
        if chosen.want not in (None, *robot.scene.objects):
            parser.error(f"--want: expected one of {', '.join(robot.scene.objects)}, found {chosen.want}")
        converse(robot, robot.say(chosen.text), chosen.want)
        try:
            ended = robot.await_pick(timeout=60)
        except NoPick as answer:
            sys.exit(f"robot  {answer}")
        print(f"{ended.outcome.name.lower()} {ended.name} after {ended.questions} questions, {ended.seconds:.1f} s")


if __name__ == "__main__":
    main()
