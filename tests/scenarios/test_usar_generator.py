"""The generator: seeded, connected, loadable, and the semantics of the paper's problems.

In each shipped domain somebody finds a thing done that they were about to do, and that is proved.
"""

import os
import subprocess
import sys
from pathlib import Path

import networkx as nx
import pytest

import serendipity
from serendipity.model import Task
from serendipity.scenarios.examples import DATA, EXAMPLES
from serendipity.scenarios.generate import PRESETS, make_usar
from serendipity.scenarios.usar import LAYOUTS, Building, Usar, figure2, pddl_files, random_building


def load(folder: Path, layout: str, robots: int) -> Task:
    if layout == "agents":
        return serendipity.load(folder)
    names = ["robot"] if robots == 1 else [f"robot{i}" for i in range(1, robots + 1)]
    return serendipity.load_pddl(folder / "domain.pddl", folder / "problem.pddl", "commx", names)


@pytest.mark.parametrize("locations", [2, 3, 21, 200])
@pytest.mark.parametrize("seed", range(4))
def test_a_random_building_is_a_tree(locations: int, seed: int) -> None:
    building = random_building(locations, seed=seed)
    assert len(building.locations) == locations
    assert nx.is_tree(nx.Graph(building.connections))


@pytest.mark.parametrize(("locations", "extra"), [(3, 1), (10, 7), (10, 36), (50, 20)])
def test_extra_edges_close_cycles(locations: int, extra: int) -> None:
    graph = nx.Graph(random_building(locations, seed=1, extra_edges=extra).connections)
    assert nx.is_connected(graph)
    assert graph.number_of_edges() == locations - 1 + extra


@pytest.mark.parametrize("corridors", [1, 2, 7, 80])
def test_halls_form_as_many_corridors_as_asked(corridors: int) -> None:
    graph = nx.Graph(random_building(210, seed=3, corridors=corridors).connections)
    assert nx.is_tree(graph)
    halls = graph.subgraph(node for node in graph if node.startswith("hall"))
    assert nx.is_connected(halls)
    ends = sum(degree == 1 for _, degree in halls.degree)
    assert ends <= corridors + 1
    if corridors == 1:
        assert nx.diameter(halls) == len(halls) - 1


def test_fewer_corridors_are_longer() -> None:
    diameters = [
        nx.diameter(nx.Graph(random_building(210, seed=1, corridors=n).connections)) for n in (1, 4, 16, 64)
    ]
    assert diameters == sorted(diameters, reverse=True)
    assert diameters[0] > 3 * diameters[-1]


def test_figure_2_is_the_papers_tree() -> None:
    graph = nx.Graph(figure2().connections)
    assert (graph.number_of_nodes(), graph.number_of_edges()) == (21, 20)
    assert nx.is_tree(graph)
    assert nx.shortest_path_length(graph, "room13", "room1") == 9
    assert nx.shortest_path_length(graph, "room6", "hall7") == 2


@pytest.mark.parametrize("layout", LAYOUTS)
def test_equal_seeds_give_equal_bytes_in_any_process(layout: str, tmp_path: Path) -> None:
    program = (
        "import sys, serendipity\n"
        f"serendipity.generate_usar(sys.argv[1], rooms=40, medkits=3, robots=2, seed=5, extra_edges=4, "
        f"layout={layout!r})"
    )
    for name in ("1", "2"):
        environment = os.environ | {"PYTHONHASHSEED": name}
        subprocess.run([sys.executable, "-c", program, str(tmp_path / name)], check=True, env=environment)
    files = [path.relative_to(tmp_path / "1") for path in sorted((tmp_path / "1").rglob("*.pddl"))]
    assert files
    for file in files:
        assert (tmp_path / "1" / file).read_bytes() == (tmp_path / "2" / file).read_bytes()


def test_another_seed_gives_another_task() -> None:
    assert make_usar(rooms=40, seed=1).building != make_usar(rooms=40, seed=2).building
    figures = {make_usar(preset="figure2", seed=seed).agents_at for seed in range(6)}
    assert len(figures) > 1


@pytest.mark.parametrize("robots", [1, 3])
def test_both_layouts_load_as_the_same_task(robots: int, tmp_path: Path) -> None:
    tasks = []
    for layout in LAYOUTS:
        serendipity.generate_usar(
            tmp_path / layout, rooms=12, medkits=2, robots=robots, seed=3, extra_edges=2, layout=layout
        )
        tasks.append(load(tmp_path / layout, layout, robots))
    first, second = ({(a.name, _names(task, a.participants)) for a in task.actions} for task in tasks)
    assert first == second
    assert len(tasks[0].robots) == robots


def _names(task: Task, participants: tuple[int, ...]) -> frozenset[str]:
    return frozenset(task.agents[i] for i in participants)


def test_actions_are_those_of_the_papers_files(usar200: Path) -> None:
    """Figure 2 has the same ground actions, by kind and participants, as the authors' files."""
    theirs = serendipity.load(usar200 / "test1")
    ours = serendipity.example("room2")
    for task in (theirs, ours):
        assert task.agents[task.human] == "commx"

    def moves(task: Task) -> set[str]:
        names = (action.name.replace(" ", "_") for action in task.actions)
        return {name for name in names if name.startswith("move")}

    assert moves(ours) == moves(theirs)
    for kind in ("pick_up_medkit", "drop_off", "hand_over"):
        for task in (ours, theirs):
            assert sum(action.name.startswith(kind) for action in task.actions) == 84


@pytest.mark.parametrize("name", [name for name in PRESETS if name in EXAMPLES])
def test_shipped_examples_are_what_the_generator_writes(name: str) -> None:
    files = pddl_files(make_usar(preset=name), "pair")
    example = EXAMPLES[name]
    assert (DATA / example.domain).read_text(encoding="utf-8") == files["domain.pddl"]
    assert (DATA / example.problem).read_text(encoding="utf-8") == files["problem.pddl"]


@pytest.mark.parametrize(
    "arguments",
    [
        {"rooms": 1},
        {"medkits": 0},
        {"robots": 0},
        {"rooms": 5, "extra_edges": 7},
        {"extra_edges": -1},
        {"corridors": 0},
        {"rooms": 10**12},
        {"robots": 2000, "rooms": 1000},
        {"extra_edges": 10**9},
        {"preset": "figure2", "medkits": 10**9},
        {"rooms": 21, "corridors": 9},
        {"preset": "room3"},
        {"layout": "tree"},
    ],
)
def test_wrong_numbers_are_refused_by_name(arguments: dict[str, object], tmp_path: Path) -> None:
    name = next(reversed(arguments))
    with pytest.raises(serendipity.UsageError, match=name):
        serendipity.generate_usar(tmp_path / "task", **arguments)  # type: ignore[arg-type]
    assert not (tmp_path / "task").exists()


def test_a_folder_that_cannot_be_made_is_a_usage_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(serendipity.UsageError, match="file"):
        serendipity.generate_usar(tmp_path / "file")


@pytest.mark.parametrize(
    ("locations", "connections", "message"),
    [
        (("a", "a"), (), "same name"),
        (("a", "b"), (("a", "c"),), "two different locations"),
        (("a", "b"), (("a", "a"),), "two different locations"),
        (("a", "b"), (("a", "b"), ("b", "a")), "same locations"),
    ],
)
def test_impossible_buildings_are_refused(
    locations: tuple[str, ...], connections: tuple[tuple[str, str], ...], message: str
) -> None:
    with pytest.raises(serendipity.UsageError, match=message):
        Building(locations, connections)


def test_impossible_positions_are_refused() -> None:
    building = Building(("a", "b"), (("a", "b"),))
    with pytest.raises(serendipity.UsageError, match="one position for each agent"):
        Usar("task", building, ("robot",), ("a",), ("b",), "b")
    with pytest.raises(serendipity.UsageError, match="no location 'c'"):
        Usar("task", building, ("robot",), ("a", "c"), ("b",), "b")


SAVED = {"parcels": (12, 10.5, 6), "flights": (20, 14, 4), "taxis": (14, 8.5, 6)}
SAVED |= {"morning": (40, 35, 15), "office": (34, 30, 13)}  # in time
"""What the human pays alone, what the team pays at discount 0.5, and when the window is."""


@pytest.mark.parametrize("name", SAVED)
def test_there_is_an_opportunity_and_a_certificate(name: str) -> None:
    task = serendipity.example(name)
    result = serendipity.plan(task, discount="0.5")
    assert result.status == "optimal" and result.opportunity
    assert result.window is not None and result.window.end == result.window.start + 1
    assert (result.human_cost, result.cost, result.window.start) == SAVED[name]
    assert result.realised == ({} if task.needs_time else {"observant": True})
    assert serendipity.verify(task, result).verdict == "proved"


@pytest.mark.parametrize("name", SAVED)
def test_every_action_is_its_agents_alone(name: str) -> None:
    assert not any(action.joint for action in serendipity.example(name).actions)


def test_all_three_taxis_act() -> None:
    result = serendipity.plan(serendipity.example("taxis"), discount="0.5")
    assert {agent for step in result.plan or () for agent in step.agents} == {"tom", "uno", "due"}
