"""One planning call as a value."""

from dataclasses import dataclass
from typing import Any

from serendipity.model import HumanPlan, Options, Task


@dataclass(frozen=True, slots=True)
class Call:
    """One planning call: a task, options that are legal for it, ``pi_H`` where it is given."""

    task: Task
    options: Options
    human_plan: HumanPlan | None = None

    @property
    def human_plan_names(self) -> list[str] | None:
        """The given plan as the facade takes it."""
        if self.human_plan is None:
            return None
        return [self.task.actions[i].name for i in self.human_plan]

    def keywords(self, **changes: Any) -> dict[str, Any]:
        """The options as the facade takes them, each of them, with some changed."""
        return {name: getattr(self.options, name) for name in self.options.to_dict()} | changes
