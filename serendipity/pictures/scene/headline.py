"""What a picture says in words: one line for everybody, one with the particulars."""

from serendipity.model.numbers import as_written, plain
from serendipity.pictures.scene.scene import Scene


def headline(scene: Scene) -> str:
    """The answer in one sentence."""
    result, human = scene.result, scene.agents[scene.human]
    if result.status == "infeasible":
        return "There is no plan at all (proved)"
    if result.status == "unknown":
        return "The time limit came before any plan"
    if result.plan is None:
        return f"No single plan: figures over all optimal plans of {human}"
    if result.opportunity and scene.meetings:
        first = scene.meetings[0]
        return f"{first.text[:1].upper()}{first.text[1:]} at epoch {first.epoch}: {_saved(scene)}"
    if result.opportunity:
        return f"The robots help {human}: {_saved(scene)}"
    if result.human_plan == () and not result.plan:
        return f"No help is needed: the goal of {human} holds already"
    if result.mode in ("serendipity", "communication"):
        return f"No help pays: {human} keeps the former plan"
    return f"A plan of cost {plain(result.cost or 0)}"


def subtitle(scene: Scene) -> str:
    """Task, mode, options, costs and window."""
    result = scene.result
    words = [scene.name, result.mode]
    turns = result.mode == "assistance"
    if result.options.discount and not turns:
        words.append(f"discount {plain(float(result.options.discount))}")
    if result.cost is not None and result.human_cost is not None and not turns:
        words.append(f"cost {plain(result.human_cost)} → {plain(result.cost)}")
    if result.window is not None:
        first, last = result.window.start, result.window.end - 1
        words.append(f"window: epoch {first}" if first == last else f"window: epochs {first} to {last}")
    if result.status == "optimal":
        words.append("proved to be the best")
    return " · ".join(words)


def _saved(scene: Scene) -> str:
    result = scene.result
    if result.mode == "assistance":
        human = scene.agents[scene.human]
        own = result.agent_costs.get(human, 0)
        others = sum(as_written(c) for name, c in result.agent_costs.items() if name != human)
        before = "" if result.human_cost is None else f"{plain(result.human_cost)} → "
        return f"{before}{plain(own)} for {human}, {plain(others)} for the others"
    if result.saving is None or result.human_cost is None or result.cost is None:
        return "a plan together"
    return f"cost {plain(result.human_cost)} → {plain(result.cost)}, {plain(result.saving)} saved"
