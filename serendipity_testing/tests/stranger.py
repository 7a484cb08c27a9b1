"""A planner of help as somebody else would write it: every window, every set of actions, epoch by epoch."""

from itertools import combinations

from serendipity_testing import Answer


def usable(action, state):
    return state.issuperset(action.pre) and state.isdisjoint(action.neg)


def after(state, actions):
    return state.difference(*(a.delete for a in actions)).union(*(a.add for a in actions))


def apart(a, b):
    if {*a.participants} & {*b.participants}:
        return False
    return not ({*a.delete} & {*b.add, *b.delete} or {*b.delete} & {*a.add})


def alone(task, state):
    """The human's cheapest way to their goal, the shortest of these: (cost, actions)."""
    seen, queue = set(), [(0, 0, state, ())]
    while queue:
        cost, length, state, plan = queue.pop(queue.index(min(queue, key=lambda entry: entry[:2])))
        if task.goal.holds(state):
            return cost, plan
        for a in (task.actions[i] for i in task.human_actions if state not in seen):
            if usable(a, state):
                queue.append((cost + a.cost, length + 1, after(state, [a]), (*plan, a)))
        seen.add(state)
    return None


def epoch(task, discount, layer, his):
    """The cheapest way to each state after one more epoch; with ``his`` None the human is free."""
    found = {}
    for state, (cost, plan) in layer.items():
        ready = [a for a in task.actions if usable(a, state)]
        for chosen in (some for size in range(len(task.agents) + 1) for some in combinations(ready, size)):
            if his is not None and [a for a in chosen if task.human in a.participants] != [his]:
                continue
            if all(apart(a, b) for a, b in combinations(chosen, 2)):
                total, onward = cost + sum(task.team_cost(a, discount) for a in chosen), after(state, chosen)
                if onward not in found or total < found[onward][0]:
                    found[onward] = total, (*plan, chosen)
    return found


def plan(task, options, human_plan):
    if options.mode != "serendipity" or task.robot_goal:
        raise NotImplementedError
    if human_plan is None:
        return None
    theirs = [task.actions[i] for i in task.plan_from_names(human_plan)]
    idle = sum(a.cost for a in theirs)
    best, answer = idle + options.window_weight, Answer([[name] for name in human_plan])
    before = {task.init: (0, ())}
    for start, planned in enumerate(theirs, start=1):
        inside = before
        for end in range(start + 1, options.horizon + 2):
            inside = epoch(task, options.discount, inside, None)
            for state, (cost, plan) in inside.items():
                rest = alone(task, state)
                if rest is None or len(rest[1]) > options.horizon + 1 - end or cost + rest[0] >= idle:
                    continue
                objective = cost + rest[0] + options.window_weight * (end - start)
                if objective < best:
                    names = [[a.name for a in chosen] for chosen in (*plan, *((a,) for a in rest[1]))]
                    best, answer = objective, Answer(names, (start, end))
        before = epoch(task, options.discount, before, planned)
    return answer
