/* Lazy greedy search for a first plan, with preferred operators.

   Two open lists take turns, one of them for what preferred operators lead to, which has a thousand turns more whenever a
   state is nearer to the goal than all before; from there it also looks ahead.  Once it takes long, every other turn is for
   a state that lacks the least of the goal: relaxed plans say little where somebody has to go a long way.  Source: Richter
   and Westphal, The LAMA planner (2010). */

#pragma once

#include <stdlib.h>
#include "heap.h"
#include "lists.h"
#include "lookahead.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_plan.h"
#include "state_table.h"
#include "successor_generator.h"
#include "values.h"

enum { BOOST = 1000, PATIENCE = 2500 };

typedef struct {
    const Problem *problem;
    Relaxation *relaxation;
    Lookahead *lookahead;
    RelaxedPlan relaxed_plan;
    Table table;
    Heap all, preferred, nearest; /* nearest: by how much of the goal is missing, once it takes long */
    Ints applicable, first, plan; /* first: operators that the relaxed plan begins with; plan: what was found */
    Word *row;
    Cost best_rest;
    int64_t turn_all, turn_preferred, turn_nearest, evaluated, begun;
    int32_t serial;
} Greedy;

static int greedy_new(Greedy *s, const Problem *p, Relaxation *r, Lookahead *l) {
    s->problem = p, s->relaxation = r, s->lookahead = l, s->table.words = p->words;
    s->row = malloc((size_t)p->words * sizeof *s->row), s->applicable.at = malloc(((size_t)p->n_ops + 1) * sizeof(int32_t));
    return s->row && s->applicable.at && relaxed_plan_new(&s->relaxed_plan, &r->problem);
}

static void greedy_free(Greedy *s) {
    relaxed_plan_free(&s->relaxed_plan), table_free(&s->table);
    free(s->all.at), free(s->preferred.at), free(s->nearest.at), free(s->applicable.at), free(s->first.at), free(s->plan.at), free(s->row);
}

static int greedy_begin(Greedy *s, const Word *state, size_t allowed) {
    table_clear(&s->table);
    s->all.count = s->preferred.count = s->nearest.count = 0;
    grant(&s->table, allowed);
    if (!reserve(&s->table, 1) || !heap_reserve(&s->all, 1, &s->table)) return MEMORY;
    s->serial = 0, s->turn_all = s->turn_preferred = s->turn_nearest = 0, s->begun = s->evaluated;
    s->best_rest = INFINITE_COST, s->plan.count = 0;
    int is_new;
    int32_t id = find(&s->table, state, &is_new);
    Node *node = node_of(&s->table, id);
    node->parent = NONE, node->op = NONE;
    heap_push(&s->all, (Entry){0, 0, id, 0});
    return RUNNING;
}

/* How many fields have not the value that the goal asks for. */
static Cost missing(const Problem *p, const Word *state) {
    Cost count = 0;
    for (int32_t f = 0; f < p->n_fields; f++)
        if (mentions(p->goal_mask, &p->fields[f])) count += code(state, &p->fields[f]) != code(p->goal, &p->fields[f]);
    return count;
}

static int is_long(const Greedy *s) { return s->evaluated - s->begun >= PATIENCE; }

static void expand_greedily(Greedy *s, int32_t id, Cost rest) {
    const Problem *p = s->problem;
    const RelaxedProblem *x = &s->relaxation->problem;
    uint8_t *chosen = s->relaxed_plan.chosen;
    const Word *state = state_of(&s->table, id);
    for (size_t i = 0; i < s->first.count; i++) chosen[s->first.at[i]] = 1;
    successors(p, state, &s->applicable);
    for (size_t i = 0; i < s->applicable.count; i++) {
        int32_t op = s->applicable.at[i];
        apply(p, op, state, s->row);
        int is_new;
        int32_t next = find(&s->table, s->row, &is_new);
        if (!is_new) continue;
        Node *after = node_of(&s->table, next);
        after->parent = id, after->op = op, after->spent = plus(node_of(&s->table, id)->spent, p->weight[op]);
        Entry entry = {rest, after->spent, next, -s->serial++};
        heap_push(&s->all, entry);
        int32_t class = x->class_of[op];
        if (class != NONE && chosen[class]) heap_push(&s->preferred, entry);
        if (is_long(s)) heap_push(&s->nearest, (Entry){missing(p, s->row), rest, next, entry.third});
    }
    for (size_t i = 0; i < s->first.count; i++) chosen[s->first.at[i]] = 0;
}

static int greedy_run(Greedy *s, double seconds, size_t allowed) {
    double end = now() + seconds;
    grant(&s->table, allowed);
    while (s->all.count || s->preferred.count || s->nearest.count) {
        if (now() >= end) return RUNNING;
        size_t more = (size_t)s->problem->n_ops + 1;
        if (!reserve(&s->table, (int32_t)more) || !heap_reserve(&s->all, more, &s->table) ||
            !heap_reserve(&s->preferred, more, &s->table) || !heap_reserve(&s->nearest, more, &s->table))
            return MEMORY;
        int preferred = s->preferred.count && (!s->all.count || s->turn_preferred <= s->turn_all);
        int nearest = s->nearest.count && (s->turn_nearest++ % 2 || !(s->all.count || s->preferred.count));
        Entry entry = heap_pop(nearest ? &s->nearest : preferred ? &s->preferred : &s->all);
        if (preferred && !nearest) s->turn_preferred++;
        if (!preferred && !nearest) s->turn_all++;
        Node *node = node_of(&s->table, entry.item);
        if (node->closed) continue;
        node->closed = 1;
        const Word *state = state_of(&s->table, entry.item);
        if (is_goal(s->problem, state)) return way_to(&s->table, entry.item, NULL, &s->plan) ? FOUND : MEMORY;
        s->first.count = 0;
        Cost rest = relaxed_plan(&s->relaxed_plan, s->relaxation, s->problem, state, 0, &s->first);
        s->evaluated++;
        if (rest == INFINITE_COST) continue;
        if (rest < s->best_rest) {
            s->best_rest = rest, s->turn_preferred -= BOOST;
            if (look_ahead(s->lookahead, s->relaxation, s->problem, state, INFINITE_COST) != INFINITE_COST)
                return way_to(&s->table, entry.item, &s->lookahead->plan, &s->plan) ? FOUND : MEMORY;
        }
        expand_greedily(s, entry.item, rest);
    }
    return HOPELESS;
}
