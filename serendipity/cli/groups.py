"""Groups of options: each option is declared once, and a command has those of a group as one parameter."""

from collections.abc import Callable
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import Annotated, Any, Self, get_args, get_origin, get_type_hints


class OptionGroup:
    """Options that belong together: attributes that are annotated as typer has it, each with its default.

    A command has a parameter of that type, and on the command line an option for each attribute in its place.
    (A dataclass in all but the time that it takes to make one.)
    """

    def __init__(self, **values: Any) -> None:
        vars(self).update(values)

    def but(self, **changes: Any) -> Self:
        """The same with some values changed."""
        return type(self)(**vars(self) | changes)

    @classmethod
    def parameters(cls, *more: Any) -> list[Parameter]:
        """What typer is shown.

        Args:
            more: the metadata of the command's annotation: a tuple with the names of the attributes that
                are options there, by default all; parameters that take the place of those of their names.
        """
        names = [name for each in more if isinstance(each, tuple) for name in each]
        instead = {other.name: other for other in more if isinstance(other, Parameter)}
        return [
            instead.get(name)
            or Parameter(name, Parameter.KEYWORD_ONLY, default=getattr(cls, name), annotation=hint)
            for name, hint in get_type_hints(cls, include_extras=True).items()
            if not names or name in names
        ]


def spread(command: Callable[..., int], last: type[OptionGroup]) -> Callable[..., int]:
    """A command as typer takes it: each of its groups is spread out into options.

    Args:
        command: a function of keywords.
        last: a group behind all other options, whose values the command is not given.
    """
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, tuple[type[OptionGroup], list[str]]] = {}
    shown: list[Parameter] = []
    for name, parameter in signature(command).parameters.items():
        kind, *more = get_args(hints[name]) if get_origin(hints[name]) is Annotated else (hints[name],)
        if isinstance(kind, type) and issubclass(kind, OptionGroup):
            own = kind.parameters(*more)
            groups[name] = kind, [option.name for option in own]
            shown += own
        else:
            shown.append(parameter.replace(kind=Parameter.KEYWORD_ONLY, annotation=hints[name]))
    unseen = last.parameters() if shown else []

    @wraps(command)
    def call(**values: Any) -> int:
        for option in unseen:
            del values[option.name]
        made = {
            name: kind(**{own: values.pop(own) for own in names}) for name, (kind, names) in groups.items()
        }
        return command(**values, **made)

    call.__signature__ = Signature([*shown, *unseen])  # type: ignore[attr-defined]
    return call
