"""The strong encoding of a question, from its task to a program that a solver can take."""

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Final

from serendipity.model import Deadline, GroundAction, Step, Task, Window
from verify.base.control import INSIDE, SUFFIX, HumanControl, expected_states
from verify.base.due import filled
from verify.base.execution import awake, grouped
from verify.base.relevance import Relevant, relevant_part, whole_task
from verify.base.subproblem import WINDOW, Subproblem
from verify.base.undecided import during
from verify.limits import limits, uses
from verify.programs.agents.product import Automaton, SmallAutomata, automata, private_facts
from verify.programs.automata.linear import plus
from verify.programs.automata.network import HumanNetwork, Network, RobotNetwork, distances, goal_states
from verify.programs.automata.program import BYTES_AN_ARC, NetworkProgram
from verify.programs.automata.pruning import prune, unroll
from verify.programs.automata.setting import NetworkSetting, outer_needs
from verify.programs.automata.windows import keep_within_windows
from verify.programs.promising import TeamMoves, keep_promising
from verify.solvers.mip import Model


def _suffix_starts(program: NetworkProgram, xi2: int, state: frozenset[int]) -> tuple[dict[int, int], int]:
    """Minus 1 unless the suffix starts at ``xi2`` with the human's private facts as in ``state``."""
    network = program.setting.human
    layer, columns = network.layers[xi2 - 1], program.flows.columns[program.task.human][xi2 - 1]
    starts: dict[int, int] = {}
    for (source, target, *_), x in zip(program.deadline.each(layer), columns, strict=True):
        begins = network.controls[source][0] == INSIDE and network.controls[target][0] == SUFFIX
        if begins and network.true_facts(source) == state & network.automaton.facts:
            starts[x] = 1
    return starts, -1


def _suffix_weights(program: NetworkProgram) -> dict[int, int]:
    weights: dict[int, int] = {}
    human, all_columns = program.setting.human, program.flows.columns[program.task.human]
    for layer, columns in zip(human.layers, all_columns, strict=True):
        for (_, target, _, weight, _), x in zip(program.deadline.each(layer), columns, strict=True):
            if weight and human.controls[target][0] == SUFFIX:
                weights[x] = weight
    return weights


_WORTH: Final = 0.9
"""A turn of small automata that leaves more than this share of the actions was idle."""

_IDLE_TURNS: Final = 2
"""Idle turns in a row after which there is no other."""


class AutomataEncoding:
    """An encoding of a question.

    Attributes:
        model: the integer program, or None where pruning alone proves that there is no plan.
    """

    def __init__(
        self,
        question: Subproblem,
        *,
        pruned: bool = True,
        shared: Model | None = None,
        control: type[HumanControl] = HumanControl,
    ) -> None:
        """Build the program.  The horizon has to be at least 1.

        Args:
            pruned: leave out what costs and goals exclude; else there is a program, whatever is asked,
                of all that can be reached if nothing is ever deleted.
            shared: what it becomes part of, and all that anybody can do counts there, relevant or not.
            control: which rule the human follows.
        """
        self.question, self._shared, self._control = question, shared, control
        self.deadline = question.deadline
        self.setting: NetworkSetting | None = None
        self._expected = expected_states(question)
        part = None if shared else relevant_part(question, frozenset().union(*self._expected))
        if part is None and not pruned:
            part = whole_task(question)
        if part is None:
            return
        self._whole = self.needs_whole_state(part)
        groups = [frozenset(variable.facts) for variable in question.task.variables]
        self._groups = _moving_by_value(question, part, groups)
        with during("building the agents' automata"):
            owner = private_facts(question.task, part, self.deadline)
            if pruned:
                few = self._with_few_facts(part, owner)
                if few is None:
                    return
                part = few
            machines = automata(question.task, part, self._groups, self.deadline, owner)
        if pruned and not self._keep_promising(part, machines):
            return
        with during("building the agents' networks"):
            setting = self._setting(part, machines)
        doing = "pruning" if pruned else "unrolling"
        with during(f"{doing} the agents' automata over {question.horizon} epochs"):
            if prune(setting) if pruned and uses("arc-pruning") else unroll(setting):
                self.setting = setting

    def _with_few_facts(self, part: Relevant, owner: Mapping[int, int]) -> Relevant | None:
        """What small automata leave of many actions; None if there is no plan within the limits."""
        if len(part.actions) <= limits().many_actions or not uses("few-facts"):
            return part
        task, idle = self.question.task, 0
        small = SmallAutomata(task, self._groups, self.deadline, owner)
        while len(part.actions) > limits().many_actions and idle < _IDLE_TURNS:
            machines = small.turn(part)
            if machines is None:
                break
            if not self._keep_promising(part, machines):
                return None
            left = part.only(_offered(task, machines, self.deadline))
            worth = any(
                after < before * _WORTH
                for before, after in zip(_sizes(task, part), _sizes(task, left), strict=True)
            )
            part, idle = left, 0 if worth else idle + 1
        return part

    @cached_property
    def program(self) -> NetworkProgram:
        """The program of the networks that pruning leaves."""
        setting = self.setting
        assert setting is not None, "there is something left"
        arcs = sum(len(layer) for network in setting.networks for layer in network.layers)
        with during(f"writing a program for {arcs:,} arcs of the agents' automata"):
            self.deadline.require(arcs * BYTES_AN_ARC)
            return NetworkProgram(self.question, setting, self._groups, self._shared, complete=self._whole)

    @property
    def model(self) -> Model | None:
        """The integer program, or None where pruning alone proves that there is no plan."""
        return None if self.setting is None else self.program.model

    def plan(self, values: tuple[int, ...]) -> tuple[tuple[Step, ...], Window | None]:
        """The plan and the window that a solution stands for, with what of a script is in no program."""
        steps, window = self.program.plan(values)
        question = self.question
        if question.task.of_bystanders:
            steps = filled(question.task, steps, question.horizon, strict=question.options.strict)
        return steps, window

    def told(self, state: frozenset[int]) -> frozenset[int]:
        """A state as the program tells it: other facts can't change, or no optimal plan asks for them."""
        told = self.program.setting.part.facts
        return state & told | self.question.task.init - told

    def bound_suffix(self, xi2: int, state: frozenset[int], least: int | None) -> None:
        """A suffix from ``state`` at ``xi2`` adds at least ``least`` units; with None there is none.

        The condition is a sum of literals that is 0 exactly in that case and at most -1 else.
        """
        program, part = self.program, self.program.setting.part
        literals, constant = _suffix_starts(program, xi2, state)
        for f in program.deadline.each(sorted(part.facts - program.setting.human.automaton.facts)):
            terms, fixed = program.facts.truth(f, xi2 - 1)
            literals = plus(literals, terms, 1 if f in state else -1)
            constant += fixed - 1 if f in state else -fixed
        program.model.family = "Def. 2.0a"
        if least is None:
            program.model.add(literals, "<=", -1 - constant)
        else:
            scaled = {x: -least * c for x, c in literals.items()}
            program.model.add(plus(scaled, _suffix_weights(program)), ">=", least * (constant + 1))

    def needs_whole_state(self, part: Relevant) -> bool:
        """Whether a suffix may turn out not to be the human's optimal plan, or that plan not to fit.

        With equal positive costs of their own actions a cheaper plan is a shorter one, so
        that what the program finds cheapest is optimal and fits (semantics 3.1, rule 3).
        """
        question = self.question
        if not question.replans:
            return False
        task = question.task
        his = (task.actions[i] for i in self.deadline.each(part.actions))
        costs = {action.cost for action in his if action.participants == (task.human,)}
        talk = any(question.prices.talk[i] for i in task.human_actions)
        return len(costs) > 1 or 0 in costs or talk or bool(task.robot_goal or task.due)

    def _setting(self, part: Relevant, machines: tuple[Automaton, ...]) -> NetworkSetting:
        question = self.question
        task = question.task
        wanted_true, wanted_false = self._wanted(part)
        weights = self._weights()
        control = self._control(question, self._expected)
        networks: list[Network] = []
        for agent, machine in enumerate(machines):
            if agent == task.human:
                human = HumanNetwork(machine, weights[agent], control, question, part)
                networks.append(human)
            else:
                open_end = self._goes_on(part, machine, wanted_true | wanted_false)
                due = task.due_for.keys()
                networks.append(RobotNetwork(machine, weights[agent], due, open_end=open_end))
        finals = [goal_states(question, machine) for machine in machines]
        return NetworkSetting(
            task=task,
            part=part,
            networks=networks,
            human=human,
            horizon=question.horizon,
            most=question.largest,
            wanted_true=wanted_true,
            wanted_false=wanted_false,
            finals=finals,
            deadline=self.deadline,
            bounds=distances(machines[task.human], weights[task.human], finals[task.human], self.deadline),
        )

    def _wanted(self, part: Relevant) -> tuple[frozenset[int], frozenset[int]]:
        """Facts that a goal, or a state to be preserved, wants true, and those that a goal wants false."""
        goal = self.question.goal
        true = frozenset(goal.positive).union(*self._expected)
        return true & part.facts, part.facts.intersection(goal.negative)

    def _keep_promising(self, part: Relevant, machines: tuple[Automaton, ...]) -> bool:
        """Drop moves of the automata that are on no plan within the limits; False if there is no plan."""
        task = self.question.task
        if task.of_bystanders or awake(task):
            return True  # bystanders move whether it pays or not, and so does the human where waiting costs
        question, prices = self.question, self.question.prices
        wanted_true, wanted_false = self._wanted(part)
        going_on = [m.agent for m in machines if self._goes_on(part, m, wanted_true | wanted_false)]
        window = prices.epoch if question.rule == WINDOW else 0
        with during("looking for moves of the agents that may pay"):
            windows = keep_within_windows(question, machines[question.task.human])
            pre, neg = outer_needs(question.task, part, machines, self.deadline)
            team = TeamMoves(
                task=question.task,
                machines=machines,
                pre=pre,
                neg=neg,
                price=[a + b for a, b in zip(prices.team, prices.talk, strict=True)],
                horizon=question.horizon,
                most=question.largest - window,
                wanted_true=wanted_true,
                wanted_false=wanted_false,
                finals=[goal_states(question, machine) for machine in machines],
                watched=frozenset(going_on),
                deadline=self.deadline,
                windows=windows,
            )
            promising = not uses("relevance-pruning") or keep_promising(team)
        for machine, moves in zip(machines, team.moves, strict=True):
            machine.moves = moves
        return promising

    def _goes_on(self, part: Relevant, machine: Automaton, wanted: frozenset[int]) -> bool:
        """Whether an agent's flow goes on to the end, since its state may count there."""
        if machine.agent == self.question.task.human or self._whole or self.question.task.due:
            return True
        return not machine.facts.isdisjoint(wanted) or any(  # whether anybody else looks at its private facts
            not machine.facts.isdisjoint((*part.pre[i], *part.neg[i]))
            for i in self.deadline.each(part.actions)
            if machine.agent not in self.question.task.actions[i].participants
        )

    def _weights(self) -> list[list[int]]:
        """What an arc of each action adds to the objective in each agent's network.

        A joint action counts once: the human pays, or its first participant.
        """
        question = self.question
        task = question.task
        weights = [[0] * len(task.actions) for _ in task.agents]
        for i, action in enumerate(self.deadline.each(task.actions)):
            payer = task.human if task.human in action.participants else action.participants[0]
            weights[payer][i] = question.prices.team[i] + question.prices.talk[i]
        return weights


def _sizes(task: Task, part: Relevant) -> tuple[int, int]:
    """How many actions there are, and in how many the human takes part."""
    return len(part.actions), sum(task.human in task.actions[i].participants for i in part.actions)


def _offered(task: Task, machines: tuple[Automaton, ...], deadline: Deadline) -> set[int]:
    """The actions of which everybody who takes part in them has a move."""
    moves = [{i for each in deadline.each(machine.moves) for i, _ in each} for machine in machines]
    offered = set().union(*moves)
    return {i for i in deadline.each(offered) if all(i in moves[k] for k in task.actions[i].participants)}


def _moving_by_value(
    question: Subproblem, part: Relevant, groups: Iterable[frozenset[int]]
) -> list[frozenset[int]]:
    """Groups of which exactly one fact is true initially and each action keeps it so.

    Each action that changes the group needs and deletes one member and adds another, so
    that two of them exclude each other and a unit of flow follows the group exactly.
    """
    task = question.task
    found = [
        group
        for group in groups
        if len(group) > 1 and len(group & task.init) == 1 and not group.isdisjoint(part.facts)
    ]
    holding = grouped((fact, number) for number, group in enumerate(found) for fact in group)
    spoilt: set[int] = set()
    for i in question.deadline.each(part.actions):
        action = task.actions[i]
        changed = {number for fact in (*action.add, *action.delete) for number in holding.get(fact, ())}
        spoilt.update(number for number in changed - spoilt if not _moves(action, found[number]))
    return [group for number, group in enumerate(found) if number not in spoilt]


def _moves(action: GroundAction, group: frozenset[int]) -> bool:
    added, deleted = group.intersection(action.add), group.intersection(action.delete)
    if not added and not deleted:
        return True
    needed = group.intersection(action.pre)
    return len(needed) == 1 and needed <= deleted and len(added) == 1 and added.isdisjoint(needed)
