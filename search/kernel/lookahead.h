/* Plans that come cheap: what a relaxed plan asks for is done as far as it can be, again and again.

   Source: lookahead plans of Vidal, A lookahead strategy for heuristic search planning (2004). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_plan.h"
#include "values.h"

typedef struct {
    RelaxedPlan relaxed_plan;
    Word *state, *row;
    Ints plan;  /* the one that was found last */
    Ints order; /* of a relaxed plan's operators */
} Lookahead;

static int lookahead_new(Lookahead *l, const Problem *p, const RelaxedProblem *x) {
    size_t row = (size_t)p->words * sizeof(Word);
    l->state = malloc(row), l->row = malloc(row), l->order.at = malloc(((size_t)x->n_ops + 1) * sizeof(int32_t));
    return l->state && l->row && l->order.at && relaxed_plan_new(&l->relaxed_plan, x);
}

static void lookahead_free(Lookahead *l) {
    relaxed_plan_free(&l->relaxed_plan), free(l->state), free(l->row), free(l->plan.at), free(l->order.at);
}

/* Of the operators that a relaxed one stands for the cheapest that is applicable, or NONE. */
static int32_t cheapest_member(const Problem *p, const RelaxedProblem *x, int32_t class, const Word *state) {
    int32_t best = NONE;
    for (int32_t j = x->members.start[class]; j < x->members.start[class + 1]; j++) {
        int32_t op = x->members.at[j];
        if (is_allowed(p, op, state) && (best == NONE || p->weight[op] < p->weight[best])) best = op;
    }
    return best;
}

/* The operators of the relaxed plan, those first that need the least before them. */
static void sort_relaxed_plan(Lookahead *l, const Relaxation *r) {
    l->order.count = 0;
    for (size_t i = l->relaxed_plan.plan.count; i-- > 0;) {
        int32_t op = l->relaxed_plan.plan.at[i];
        size_t j = l->order.count++;
        for (; j && r->ops[l->order.at[j - 1]].cost > r->ops[op].cost; j--) l->order.at[j] = l->order.at[j - 1];
        l->order.at[j] = op;
    }
}

/* A plan from a state that costs less than a limit: what it costs, or INFINITE_COST where none was found.  Without a limit
   what it costs may be more than is told. */
static Cost look_ahead(Lookahead *l, Relaxation *r, const Problem *p, const Word *from, Cost limit) {
    const RelaxedProblem *x = &r->problem;
    Cost spent = 0, before = INFINITE_COST;
    l->plan.count = 0;
    memcpy(l->state, from, (size_t)p->words * sizeof(Word));
    while (!is_goal(p, l->state)) {
        Cost count = relaxed_plan(&l->relaxed_plan, r, p, l->state, 1, NULL);
        if (count >= before) return INFINITE_COST; /* no nearer than before, or no way */
        before = count;
        sort_relaxed_plan(l, r);
        size_t done = l->plan.count;
        for (int moved = 1; moved;) {
            size_t left = moved = 0;
            for (size_t i = 0; i < l->order.count; i++) {
                int32_t op = cheapest_member(p, x, l->order.at[i], l->state);
                if (op == NONE) {
                    l->order.at[left++] = l->order.at[i];
                    continue;
                }
                apply(p, op, l->state, l->row);
                memcpy(l->state, l->row, (size_t)p->words * sizeof(Word));
                spent = plus(spent, p->weight[op]), moved = 1;
                if (spent >= limit || !ints_push(&l->plan, op)) return INFINITE_COST;
            }
            l->order.count = left;
        }
        if (l->plan.count == done) return INFINITE_COST;
    }
    return spent < limit ? spent : INFINITE_COST;
}
