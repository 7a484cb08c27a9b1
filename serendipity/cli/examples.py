"""``serendipity examples``: the tasks that are shipped."""

import typer


def examples() -> None:
    """List the tasks that --example takes."""
    from serendipity.scenarios import EXAMPLES

    width = max(len(name) for name in EXAMPLES)
    for shipped in EXAMPLES.values():
        typer.echo(f"{shipped.name:<{width}}  {shipped.summary}")
