"""A planner that looks one question ahead, in the policy service:

    whichone swap policy -- whichone-policy --planner-program python3 shared/sdk/python/examples/planner.py
"""

from whichone import Decision, Planner


class OneAhead(Planner):
    def decide(self, problem):
        best = self.stop(problem, problem.belief)
        for question in problem.questions:
            outcomes = problem.outcomes(question)
            then = sum(share * self.stop(problem, belief).value for share, belief in outcomes)
            value = problem.discount * then - question.cost
            if value > best.value:
                best = Decision(ask=question, value=value)
        return best

    def stop(self, problem, belief):
        """The better of picking the likeliest object and waiting."""
        likeliest = max(range(len(belief)), key=belief.__getitem__)
        value = problem.pick_value(belief[likeliest])
        return Decision(pick=likeliest, value=value) if value > problem.wait else Decision(value=problem.wait)


if __name__ == "__main__":
    OneAhead().run()
