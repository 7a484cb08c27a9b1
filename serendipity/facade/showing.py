"""Pictures of tasks, results and reports on windows: in a notebook, and as files."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from serendipity.facade.interruptibility import InterruptionReport, drawn
from serendipity.model import InputError, Options, Result, Task, UsageError
from serendipity.model.arguments import PATH, RESULT_IN_TIME, TASK_IN_TIME, expect
from serendipity.pictures import Scene, build_scene, check_epoch, draw, other_scenes


@dataclass(frozen=True, slots=True, repr=False)
class Drawing:
    """Something drawn: a notebook shows it, ``save`` writes it to a file.

    Args:
        drawn: a scene, or a report on windows.
        epoch: of a still; None for the one that says most.
        others: makes the scenes that can be chosen on a page instead.
    """

    drawn: Scene | InterruptionReport
    epoch: int | None = None
    others: Callable[[], Iterable[Scene]] = tuple

    def html(self) -> str:
        """A page that plays the plan, with everything in it."""
        return str(self._content(".html"))

    def svg(self) -> str:
        """A still."""
        return str(self._content(".svg"))

    def png(self) -> bytes:
        """A still (extra ``plot``)."""
        content = self._content(".png")
        assert isinstance(content, bytes), "no text"
        return content

    def save(self, path: str | Path) -> Path:
        """Write a page ``.html``, or a still ``.svg`` or ``.png``, as the file's name ends.

        Raises:
            UsageError: the name ends otherwise, or a picture can't be had in this form: a report on windows
                has no page, and PNG needs the extra ``plot``.
            OSError: the file can't be written.
        """
        expect(PATH, path=path)
        file = Path(path)
        content = self._content(file.suffix)
        if isinstance(content, str):
            file.write_text(content, encoding="utf-8")
        else:
            file.write_bytes(content)
        return file

    def _content(self, suffix: str) -> str | bytes:
        if isinstance(self.drawn, Scene):
            return draw(self.drawn, suffix, None if suffix == ".html" else self.epoch, self.others)
        return drawn(self.drawn, suffix)

    def __repr__(self) -> str:
        if isinstance(self.drawn, InterruptionReport):
            return f"Drawing(the windows of {self.drawn.human!r:.80})"
        return f"Drawing({self.drawn.name!r:.80}, {len(self.drawn.frames) - 1} epochs)"

    def _repr_svg_(self) -> str:
        return self.svg()


def show(
    task: Task,
    answer: Result | InterruptionReport | None = None,
    *,
    epoch: int | None = None,
    scenario: str | None = None,
) -> Drawing:
    """A task, an answer or a report on windows as a picture that a notebook shows.

    Files come from it, too: ``serendipity.show(task, result).save("help.html")``.

    Args:
        task: the task.
        answer: a result, whose plan is played; what :func:`serendipity.interruptions` says, as a heat map;
            None: where everything is at the start.
        epoch: of a still; None for the one that says most, a hand-over for example.
        scenario: what is played of an answer over scenarios, by its name; None for the most probable.

    Raises:
        UsageError: there is no such epoch or scenario.
        InputError: the answer is to another task.
    """
    expect(TASK_IN_TIME, task=task)
    if isinstance(answer, InterruptionReport):
        if epoch is not None or scenario is not None or answer.human not in task.agents:
            raise UsageError(
                "show: a report on windows has no epochs or scenarios, and names somebody of the task"
            )
        return Drawing(answer)
    human = task.agents[task.human]
    if answer is None:
        answer = Result("individual", "unknown", human, Options(mode="individual"))
    expect(RESULT_IN_TIME, answer=answer)
    if answer.human != human:
        raise InputError(f"result: is for another task: its human is '{answer.human}'")
    scene = build_scene(task, answer, scenario)
    check_epoch(scene, epoch)
    return Drawing(scene, epoch, partial(other_scenes, task, answer, scene))
