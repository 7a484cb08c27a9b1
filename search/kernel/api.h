/* What Python calls: a planner for one problem, by ctypes (search/classical/planner.py).

   Work goes on in slices: whoever calls looks at the time and the memory between two of them. */

#pragma once

#include <stdlib.h>
#include "a_star.h"
#include "epoch_ways.h"
#include "epochs.h"
#include "greedy_search.h"
#include "lookahead.h"
#include "problem.h"
#include "relaxation.h"
#include "state_table.h"
#include "successor_generator.h"
#include "values.h"

#if defined(_WIN32)
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif

API void leave_out(int techniques) { left_out = techniques; } /* by every planner from now on */

typedef struct {
    Problem problem;
    Relaxation relaxation; /* both searches work with it, and with this: */
    Lookahead lookahead;
    AStar a_star;
    Greedy greedy;
} Planner;

API void planner_free(Planner *s) {
    if (!s) return;
    a_star_free(&s->a_star), greedy_free(&s->greedy);
    lookahead_free(&s->lookahead), relaxation_free(&s->relaxation), problem_free(&s->problem);
    free(s);
}

API Planner *planner_new(const Spec *spec) {
    Planner *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    Problem *p = &s->problem;
    if (problem_new(p, spec) && plant_all(p) && relaxation_new(&s->relaxation, p) &&
        lookahead_new(&s->lookahead, p, &s->relaxation.problem) &&
        a_star_new(&s->a_star, p, &s->relaxation, &s->lookahead) && greedy_new(&s->greedy, p, &s->relaxation, &s->lookahead))
        return s;
    planner_free(s);
    return NULL;
}

/* Optimal search, from a state, below a limit: slice by slice until it is no longer RUNNING. */
API int planner_begin(Planner *s, const Word *state, Cost limit, size_t allowed) {
    return a_star_begin(&s->a_star, state, limit, allowed);
}
/* Fields that are alike, class by class, each ends with NONE. */
API int planner_alike(Planner *s, const int32_t *fields, int32_t count, size_t allowed) {
    return take_alike(&s->a_star, fields, count, allowed);
}
API int planner_run(Planner *s, double seconds, size_t allowed) { return a_star_run(&s->a_star, seconds, allowed); }

/* No plan from where it began is cheaper. */
API Cost planner_least(const Planner *s) { return s->a_star.least; }

/* No plan from a state is cheaper; -1 where memory is missing. */
API Cost planner_bound(Planner *s, const Word *state, size_t allowed) { return a_star_bound(&s->a_star, state, allowed); }

/* Greedy search, likewise. */
API int planner_begin_greedy(Planner *s, const Word *state, size_t allowed) { return greedy_begin(&s->greedy, state, allowed); }
API int planner_run_greedy(Planner *s, double seconds, size_t allowed) { return greedy_run(&s->greedy, seconds, allowed); }

static int32_t told(const Ints *plan, int32_t *ops, int32_t room) {
    for (size_t i = 0; i < plan->count && i < (size_t)room; i++) ops[i] = plan->at[i];
    return (int32_t)plan->count;
}

/* The plan that greedy search has found; how many operators. */
API int32_t planner_greedy_way(const Planner *s, int32_t *ops, int32_t room) { return told(&s->greedy.plan, ops, room); }

/* The best plan that the optimal search has come across so far; how many operators, NONE: no plan. */
API int32_t planner_best_way(const Planner *s, int32_t *ops, int32_t room) {
    return s->a_star.has_plan ? told(&s->a_star.plan, ops, room) : NONE;
}

/* The first operators of a cheapest plan from a state, `row`, which becomes the state after them; how many, fewer than there
   is room for where the plan ends; NONE where its cost is not known. */
API int32_t planner_known_way(Planner *s, Word *row, int32_t *ops, int32_t room) {
    int32_t count = 0, id = met_like(&s->a_star, row);
    if (id == NONE || !node_of(&s->a_star.table, id)->exact || node_of(&s->a_star.table, id)->rest == INFINITE_COST) return NONE;
    for (int32_t op; count < room && (op = known_step(&s->a_star, row)) != NONE; count++) ops[count] = op;
    return count;
}

/* Operators that a state allows, ascending; how many. */
API int32_t planner_allowed(Planner *s, const Word *state, int32_t *ops) {
    const Ints *found = allowed_in(&s->a_star, state);
    memcpy(ops, found->at, found->count * sizeof *ops);
    return (int32_t)found->count;
}

/* Bytes that were missing where there was not enough memory. */
API size_t planner_wanted(const Planner *s) {
    size_t optimal = s->a_star.table.wanted, greedy = s->greedy.table.wanted;
    return optimal > greedy ? optimal : greedy;
}

/* States expanded, generated and evaluated so far. */
API void planner_counts(const Planner *s, int64_t *counts) {
    counts[0] = s->a_star.expanded, counts[1] = s->a_star.generated;
    counts[2] = s->a_star.evaluator.evaluated + s->greedy.evaluated;
}

/* States epoch by epoch, and what follows them (search/timetable/epochs.py): `after` is for what comes then, and stays. */
API Epochs *epochs_new(const Spec *spec, const uint64_t *agents, const Word *apart, Planner *after, const Word *mask,
                       const uint8_t *lost, Cost unit) {
    return epochs_of(spec, agents, apart, &after->a_star, mask, lost, unit);
}
API void epochs_delete(Epochs *e) { epochs_free(e); }
API int epochs_start(Epochs *e, const Word *state, size_t allowed) { return epochs_begin(e, state, allowed); }
API int epochs_turn(Epochs *e, int32_t given, const int32_t *alike, int32_t count) {
    return epochs_next(e, given, alike, count);
}
API int epochs_slice(Epochs *e, Cost limit, double seconds, size_t allowed) { return epochs_run(e, limit, seconds, allowed); }
API size_t epochs_wanted(const Epochs *e) { return e->wanted; }
API int64_t epochs_states(const Epochs *e) {
    int64_t count = e->ends.count;
    for (int32_t i = 0; i < e->n_layers; i++) count += e->layers[i].count;
    return count;
}

/* What can be left behind: totals, what is paid of them. */
API int32_t epochs_leavings(const Epochs *e, Cost *totals, Cost *paid) {
    for (size_t i = 0; totals && i < e->n_leavings; i++) totals[i] = e->leavings[i].total, paid[i] = e->leavings[i].paid;
    return (int32_t)e->n_leavings;
}
API void epochs_left(const Epochs *e, int32_t number, Word *row) {
    memcpy(row, state_of(&e->ends, e->leavings[number].end), (size_t)e->ends.words * sizeof *row);
}
API int epochs_back(Epochs *e, const int32_t *given, Cost limit, double seconds) { return epochs_go_back(e, given, limit, seconds); }
API Cost epochs_rest(Epochs *e, int32_t layer, const Word *state, int at_once) { return rest_from(e, layer, state, at_once); }
API int32_t epochs_sets(Epochs *e, int32_t number, const int32_t *given, int32_t *ops) { return epochs_way(e, number, given, ops); }
