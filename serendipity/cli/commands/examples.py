"""``serendipity examples``: the tasks that are shipped."""

from serendipity.cli.streams import output


def examples() -> None:
    """List the tasks that --example takes."""
    from serendipity.scenarios.examples import EXAMPLES

    width = max(len(name) for name in EXAMPLES)
    output.say("".join(f"{shipped.name:<{width}}  {shipped.summary}\n" for shipped in EXAMPLES.values()))
