"""A grounding service: spots the scene's words and their synonyms, yes and no.

    whichone swap grounding -- python3 shared/sdk/python/examples/grounding.py

It remembers nothing, so it can be killed and swapped at any moment, as the one that it replaces.
"""

from whichone import Grounder, Reading, Response
from whichone.grounding import AFFIRMATIVE, NEGATIVE
from whichone.scene import WORDS


class Spotter(Grounder):
    def ground(self, heard):
        also = [(synonym, word) for word, synonyms in self.scene.synonyms.items() for synonym in synonyms]
        return [self.read(hypothesis, also) for hypothesis in heard.hypotheses]

    def read(self, hypothesis, also):
        said = {match.group() for match in WORDS.finditer(hypothesis.text.lower())}
        yes, no = bool(said & AFFIRMATIVE), bool(said & NEGATIVE)
        words = self.scene.spot(hypothesis.text, also)
        return Reading(
            base=[word for word, _ in words],
            # A word counts for less where the recogniser was not sure of it.
            base_doubt=[hypothesis.doubt(place) for _, place in words],
            response=Response.NONE if yes == no else Response.YES if yes else Response.NO,
            weight=hypothesis.weight,
        )


if __name__ == "__main__":
    Spotter().run()
