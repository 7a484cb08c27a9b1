"""The lower bounds of the search: where each comes from, what it holds for, and who asks it.

Every bound leaves out costs, conditions or agents, and adds none: it never is above what the cheapest way on
costs.  The documentation shows this table; a bound that is asked anywhere stands in it.
"""

from typing import Final, NamedTuple


class LowerBound(NamedTuple):
    """A row of the table.

    Attributes:
        name: the field's word for it.
        home: module and name of what works it out.
        source: the work that it is taken from, or what it relaxes.
        holds_for: the questions for which it is admissible.
        needs: what has to be worked out before it can be asked.
        asked_by: the strategies, spaces and modes that ask it.
    """

    name: str
    home: str
    source: str
    holds_for: str
    needs: str
    asked_by: str


BOUNDS: Final = (
    LowerBound(
        "private projection",
        "search.human.pattern_database:PatternDatabase",
        "Culberson and Schaeffer 1998, on one agent's private variables",
        "the human's share of every plan, in all modes",
        "distances in the projection, once for a task",
        "bound; all spaces; the human alone",
    ),
    LowerBound(
        "achiever automata",
        "search.bounds.achievers:Achievers",
        "relaxed relay: one robot tracked at a time, all other conditions dropped",
        "robots' share until they have provided what one of the human's actions asks for",
        "an automaton for each variable that robots change",
        "first interaction; windows on the way",
    ),
    LowerBound(
        "private distances",
        "search.bounds.private_distances:PrivateDistances",
        "the projection, from and to each of the human's actions that touch others' variables",
        "the human's way to what is provided, and on from there",
        "the private projection",
        "first interaction; windows on the way",
    ),
    LowerBound(
        "first interaction",
        "search.bounds.first_interaction:FirstInteraction",
        "a landmark that is disjunctive: no help, or a first action that needs robots",
        "modes with windows, communication and composite, where goals are private",
        "achiever automata, private distances",
        "all-plans",
    ),
    LowerBound(
        "first interaction on the way",
        "search.bounds.prefix_bounds:FirstInteractionOnTheWay",
        "the same, by the epoch in which the window opens",
        "modes with windows, while the human follows pi_H",
        "first interaction, for each epoch of pi_H",
        "all-plans",
    ),
    LowerBound(
        "LM-cut",
        "search.classical.planner:ClassicalPlanner",
        "Helmert and Domshlak 2009; up to three rounds of cuts, landmarks handed to successors",
        "the human alone, and all agents together where epochs do not count: so every mode",
        "the kernel; effects of joint actions that belong together",
        "joint-optimum; all-plans where goals are shared; the human alone",
    ),
    LowerBound(
        "symbolic bidirectional search",
        "search.classical.symbolic:cheapest_plan",
        "Torralba, Alcazar, Kissmann and Edelkamp 2017",
        "as LM-cut",
        "the extra `symbolic`; a process, once a question has taken long",
        "as the kernel's A*, whose place it takes for a while",
    ),
    LowerBound(
        "relaxed timeline of one robot",
        "search.short_windows.independent.timeline:RobotLayers",
        "decoupled search, Gnad and Hoffmann 2018: other robots provide for nothing what they can",
        "windows of one epoch that leave something behind",
        "the soonest epoch of each value",
        "robots-apart",
    ),
    LowerBound(
        "landmarks whatever is left behind",
        "search.short_windows.independent.landmarks:Landmarks",
        "LM-cut, with what robots could provide for nothing",
        "what the human pays after a window of one epoch",
        "LM-cut at the window",
        "robots-apart",
    ),
    LowerBound(
        "any optimal plan",
        "search.modes.tie_bound:least_over_ties",
        "all optimal plans of the human at once, as layers",
        "ties: robust, optimistic and mean answers",
        "the graph of optimal plans",
        "ties",
    ),
    LowerBound(
        "relaxed provision",
        "search.modes.assistance.bounds.relaxed_provision:RelaxedProvision",
        "the supporter's provisions for nothing but the cheapest action each",
        "values of silent assistance",
        "private and provided fields of the prime",
        "assistance, where a table of all states is out of reach",
    ),
    LowerBound(
        "h_max of both",
        "search.modes.assistance.bounds.bound:joint_lower_bound",
        "Bonet and Geffner 2001",
        "values of silent assistance",
        "nothing",
        "assistance, where optimal costs are out of reach",
    ),
)
"""The bounds, the cheapest to ask first."""
