"""The picture of a round: the map as the person knows it, and where on it the places are."""

from fractions import Fraction
from typing import Any

from serendipity.live.play.eyes import Eyes
from serendipity.model import Options, Result, Task
from serendipity.show.formats.svg import svg
from serendipity.show.map.layout import lay_out
from serendipity.show.map.places import Places
from serendipity.show.picture.map_picture import MARGIN, map_picture
from serendipity.show.picture.palette import agent_colours, on
from serendipity.show.picture.tokens import agent_key, initials, object_key
from serendipity.show.scene.finder import Finder
from serendipity.show.scene.scene import Frame, Scene


class Stage:
    """The map of a task, drawn anew after each epoch.

    Args:
        task: the task.
        places: its map.
        eyes: what the person knows.
    """

    def __init__(self, task: Task, places: Places, eyes: Eyes) -> None:
        self._task = task
        self._finder = Finder(places)
        self._eyes = eyes
        self._layout = lay_out(places) if places.names else None
        own = places.positions.get(task.human, {})
        named = (places.marks.get(fact) or own.get(fact) for fact in task.goal.positive)
        self._goals = tuple(dict.fromkeys(place for place in named if place is not None))
        self._frames: list[Frame] = []

    def look(self, state: frozenset[int]) -> None:
        """Take in where things are after an epoch."""
        self._state = state
        self._frames.append(self._frame(len(self._frames)))

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
            "seen": None if self._eyes.everywhere else [self.here],
            "remembered": self._remembered(),
        }

    def legend(self) -> list[dict[str, str]]:
        """Who is who."""
        colours = agent_colours(len(self._task.agents), self._task.human)
        letters = initials(self._task.agents)
        human = self._task.human
        order = [human, *self._task.robots]
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
        if self._eyes.everywhere:
            return []
        frame = self._frames[-1]
        away = [agent for agent, place in frame.at.items() if place != self.here]
        faded = [agent_key(agent) for agent in away]
        for index, where in enumerate(frame.objects.values()):
            place = where.place if where.holder is None else frame.at.get(where.holder)
            if place != self.here:
                faded.append(object_key(index))
        return faded

    def _frame(self, epoch: int) -> Frame:
        known = self._eyes.belief
        return Frame(
            epoch=epoch,
            at=self._finder.agents(known),
            objects=self._finder.objects(known),
            former_at=None,
            made=(),
            undone=(),
            spent={},
            former_spent=Fraction(0),
            caption="",
            in_window=False,
        )

    def _scene(self) -> Scene:
        task = self._task
        nothing = Result("individual", "unknown", task.agents[task.human], Options(mode="individual"))
        return Scene(
            name=task.name,
            agents=task.agents,
            human=task.human,
            layout=self._layout,
            goals=self._goals,
            frames=tuple(self._frames),
            acts=(),
            former_acts=(),
            meetings=(),
            window=None,
            changes=(),
            result=nothing,
        )
