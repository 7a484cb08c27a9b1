"""The map of a round as the person knows it: what they see, elsewhere what they saw last (semantics 6)."""

from typing import Any

from serendipity.facade.person.sight import Sight
from serendipity.model import GroundAction, Options, Result, Task, surroundings
from serendipity.model.task.actions import apply
from serendipity.pictures.formats.svg import svg
from serendipity.pictures.map.layout import MapLayout, lay_out
from serendipity.pictures.map.places import Places
from serendipity.pictures.picture.drawing import agent_colours, on
from serendipity.pictures.picture.map_picture import MARGIN, initials, map_picture
from serendipity.pictures.scene.crowds import agent_key, cell_size, object_key
from serendipity.pictures.scene.finder import Finder
from serendipity.pictures.scene.scene import Frame, Scene


class Knowledge:
    """What a person takes to be true (``belief``), who sees everything (``observant``), or where they are."""

    def __init__(self, task: Task, view: str) -> None:
        self._human = task.human
        self._around = surroundings(task) if view == "local" else None
        self._sight = Sight(task) if view == "local" and task.needs_time else None
        self._all = range(len(task.facts))
        self._values = [frozenset(v.facts) for v in task.variables if not v.boolean]
        self.belief = task.init

    @property
    def everywhere(self) -> bool:
        """Whether they see everything."""
        return self._around is None or not self._around.located

    def sees(self, fact: int, state: frozenset[int]) -> bool:
        """Whether they see in a state if a fact is true."""
        return self._around is None or self._around.visible(self._human, fact, state)

    def look(self, now: Task, done: GroundAction | None) -> None:
        """Take in an epoch.

        Args:
            now: the task as it stands after it.
            done: what the person did, or began.
        """
        state = now.init
        if self._around is None or not self._around.located:
            self.belief = state
            return
        expected = self._expected(now, done)
        near = self._around.near(self._human, state)
        seen = {fact for fact in self._all if not self._around.parts[fact].isdisjoint(near)}
        known = state & seen
        for values in self._values:  # what is seen in one place is not in another one
            if not values.isdisjoint(known):
                expected -= values
        self.belief = (expected - seen) | known
        if self._sight is not None:
            self._sight.believed = self._sight.believed.at(self.belief)

    def _expected(self, now: Task, done: GroundAction | None) -> frozenset[int]:
        """What they take to be true after an epoch; in time what has begun, and the script, go on."""
        if self._sight is None:
            return self.belief if done is None else apply(self.belief, done)
        self._sight.passed(() if done is None else (done,))
        self._sight.look(now)
        return self._sight.believed.init


class MapView:
    """The map of a task as its person knows it, drawn anew after each epoch."""

    def __init__(self, task: Task, places: Places, knowledge: Knowledge) -> None:
        self._task = task
        self._places = places
        self._finder = Finder(places)
        self._knowledge = knowledge
        self._layout: MapLayout | None = None
        self._size = (0.0, 0.0)
        self._frames: list[Frame] = []
        self.look()

    def look(self) -> None:
        """Take in where things are after an epoch; the map has room for all that has been anywhere."""
        known = self._knowledge.belief
        at, objects = self._finder.agents(known), self._finder.objects(known)
        self._frames.append(Frame(len(self._frames), at, objects))
        if not self._places.names:
            return
        wanted = cell_size(self._scene(), self._places.names)
        size = max(wanted[0], self._size[0]), max(wanted[1], self._size[1])
        if size != self._size:
            self._size, self._layout = size, lay_out(self._places, size)

    @property
    def here(self) -> str | None:
        """Where the person is."""
        return self._frames[-1].at.get(self._task.human)

    def picture(self) -> dict[str, Any] | None:
        """The map as SVG, its places, and what on it is only remembered; None without a map."""
        if self._layout is None:
            return None
        drawn = map_picture(self._scene(), len(self._frames) - 1)
        assert drawn is not None, "there is a layout"
        boxes = {
            place: [box.x + MARGIN, box.y + MARGIN, box.width, box.height]
            for place, box in self._layout.boxes.items()
        }
        return {
            "svg": svg(drawn, inline=True, id="map"),
            "width": drawn.width,
            "places": boxes,
            "here": self.here,
            "seen": None if self._knowledge.everywhere else [self.here],
            "remembered": self._remembered(),
        }

    def legend(self) -> list[dict[str, str]]:
        """Who is who."""
        colours = agent_colours(len(self._task.agents), self._task.human)
        letters = initials(self._task.agents)
        human = self._task.human
        order = [human, *self._task.robots, *sorted(self._task.script.people)]
        return [
            {
                "name": self._task.agents[agent],
                "letter": letters[agent],
                "colour": colours[agent],
                "ink": on(colours[agent]),
                "kind": "person" if agent == human else "machine",
            }
            for agent in order
        ]

    def _remembered(self) -> list[str]:
        """Tokens of what the person does not see now."""
        if self._knowledge.everywhere:
            return []
        frame = self._frames[-1]
        away = [agent for agent, place in frame.at.items() if place != self.here]
        faded = [agent_key(agent) for agent in away]
        faded += [
            object_key(index)
            for index, name in enumerate(frame.objects)
            if self._place(frame, name) != self.here
        ]
        return faded

    def _place(self, frame: Frame, name: str) -> str | None:
        """Where an object is, or what it is in, or who holds it."""
        where = frame.objects[name]
        if where.carrier in frame.objects:
            return self._place(frame, str(where.carrier))
        return where.place if where.holder is None else frame.at.get(where.holder)

    def _scene(self) -> Scene:
        task = self._task
        nothing = Result("individual", "unknown", task.agents[task.human], Options(mode="individual"))
        return Scene(
            name=task.name,
            agents=task.agents,
            human=task.human,
            result=nothing,
            frames=tuple(self._frames),
            layout=self._layout,
            goals=self._places.goals(task),
            vehicles=self._places.vehicles,
        )
