"""The examples of ``--help``: data, so that the tests can run them in this order."""

from typing import Final

EXAMPLES: Final = (
    "serendipity examples",
    "serendipity plan --example room2 --discount 0.6",
    "serendipity plan --example room7 --discount 0.6 --mode communication --format json -o help.json",
    "serendipity verify --example room7 help.json",
    "serendipity verify --example room7 help.json --proof proof.json.gz",
    "serendipity check-proof proof.json.gz --example room7 help.json",
    "serendipity simulate --example room7 help.json --human-model local",
    "serendipity plan --example room2 --discount 0.9 --human-model observant",
    "serendipity execute --example room2 --discount 0.6 --log run.jsonl",
    "serendipity execute --example room2 --replay run.jsonl",
    "serendipity execute --example room2 --discount 1 --human noisy:0.2 --runs 9 --log days.jsonl",
    "serendipity learn --example room2 days.jsonl -o plans.json",
    "serendipity execute --example room2 --discount 0.9 --human noisy:0.1 --runs 5 --seed 7 --deadline 0.1",
    "serendipity plan --example room2 --discount 0.6 --save-plan help.plan",
    "serendipity show --example room7 help.json -o help.html",
    "serendipity show --example room7 help.json --epoch 6 -o help.svg",
    "serendipity solve --example room7 --discount 0.6 --mode communication --solver highs",
    "serendipity crosscheck --count 5 --judges search,automata",
    "serendipity league --season spring --cases 2 --helper idle --helper ours-policy --families buildings",
    "serendipity bench --rooms 12 --seeds 2 --contenders search,automata --repeat 1 -o timings.csv",
    "serendipity generate usar --rooms 30 --medkits 3 --seed 6 -o building",
    "serendipity check-task building",
    "serendipity plan building --discount 0.9",
    "serendipity generate usar --preset figure2 --seed 7 --layout pair -o figure2",
    "serendipity plan figure2/domain.pddl figure2/problem.pddl --human commx --robot robot",
    "serendipity explain --example room2 --discount 0.6",
    "serendipity explain --example room7 help.json",
    "serendipity interruptions --example room2 --discount 0.6 --heat-map windows.svg",
    "serendipity front --example room2 --discount 0.9 --picture front.svg",
    "serendipity generate usar --preset room2 -o suite/test1",
    "serendipity recognise --example room2 --goals goals.txt",
    "serendipity reproduce suite --modes serendipity,communication --discounts 0,0.6 --report suite.html",
)

SERVERS: Final = (
    "serendipity play --example taxis --discount 0.9 --port 8124",
    "serendipity play --study answers --rounds 4 --seed 1 --port 8124",
    "serendipity serve --workers 2 --time-limit 10 --port 8123",
    "serendipity mcp --http --time-limit 10 --port 8125",
)
"""They go on until somebody stops them, so the tests ask them for a port that there can't be."""

_FIRST: Final = ("examples", "plan", "explain", "generate", "play")
"""Commands that whoever knows none of them begins with."""


def epilog(command: str = "") -> str:
    """The examples of one command (without one, the first of some), as the closing lines of its help."""
    every = (*EXAMPLES, *SERVERS)
    if command:
        chosen = [text for text in every if text.split()[1] == command]
    else:
        chosen = [next(text for text in every if text.split()[1] == name) for name in _FIRST]
        chosen.append("serendipity COMMAND --help")
    return "\n".join(["\b", "Examples:", *(f"  {text}" for text in chosen)])
