/* FF: the length of a plan of the delete relaxation, and the operators that it begins with.

   Sources: Hoffmann and Nebel, The FF planning system (2001); over additive supporters, Keyder and Geffner, Heuristics for
   planning with action costs revisited (2008). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "lists.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_problem.h"
#include "values.h"

typedef struct {
    int32_t *supporter; /* per fact the operator that adds it first */
    uint8_t *chosen;    /* operators; 0 between two calls */
    Ints plan;          /* the operators that were chosen last, later ones first */
} RelaxedPlan;

static int relaxed_plan_new(RelaxedPlan *f, const RelaxedProblem *x) {
    f->supporter = malloc(((size_t)x->n_facts + 1) * sizeof *f->supporter), f->chosen = calloc((size_t)x->n_ops + 1, 1);
    f->plan.at = malloc(((size_t)x->n_ops + 1) * sizeof(int32_t));
    return f->supporter && f->chosen && f->plan.at;
}

static void relaxed_plan_free(RelaxedPlan *f) { free(f->supporter), free(f->chosen), free(f->plan.at); }

/* Number of operators of a relaxed plan, whose first ones are added to `preferred`, if that is there; each costs what it
   weighs, or 1. */
static Cost relaxed_plan(RelaxedPlan *f, Relaxation *r, const Problem *p, const Word *state, int weighed, Ints *preferred) {
    const RelaxedProblem *x = &r->problem;
    int32_t *supporter = f->supporter;
    uint8_t *chosen = f->chosen;
    start_from(r, p, state);
    if (!weighed)
        for (int32_t o = 0; o < x->n_ops; o++) r->ops[o].cost = 1;
    for (size_t i = 0; i < r->initial.count; i++) supporter[r->initial.at[i]] = NONE;
    for (size_t i = 0; i < x->always.count; i++) {
        int32_t op = x->always.at[i];
        for (int32_t k = x->add.start[op]; k < x->add.start[op + 1]; k++) {
            if (r->cost[x->add.at[k]] <= r->ops[op].cost) continue;
            supporter[x->add.at[k]] = op;
            reach(r, x->add.at[k], r->ops[op].cost);
        }
    }
    while (r->queue.count) {
        int32_t from = next_fact(r);
        for (int32_t j = x->asked_by.start[from]; j < x->asked_by.start[from + 1]; j++) {
            int32_t number = x->asked_by.at[j];
            RelaxedOp *op = &r->ops[number];
            op->cost = plus(op->cost, r->cost[from]);
            if (--op->unsatisfied) continue;
            for (int32_t k = x->add.start[number]; k < x->add.start[number + 1]; k++) {
                int32_t fact = x->add.at[k];
                if (op->cost >= r->cost[fact]) continue;
                supporter[fact] = number;
                reach(r, fact, op->cost);
            }
        }
    }
    if (!goal_reached(r)) return INFINITE_COST;
    memset(chosen, 0, (size_t)x->n_ops);
    r->round += 3, r->zone.count = 0;
    for (size_t i = 0; i < x->goal.count; i++) {
        r->mark[x->goal.at[i]] = r->round;
        put(&r->zone, x->goal.at[i]);
    }
    f->plan.count = 0;
    for (size_t i = 0; i < r->zone.count; i++) {
        int32_t op = supporter[r->zone.at[i]];
        if (op == NONE || chosen[op]) continue;
        chosen[op] = 1;
        put(&f->plan, op);
        if (preferred && r->ops[op].cost == (weighed ? x->weight[op] : 1)) ints_push(preferred, op);
        for (int32_t j = x->pre.start[op]; j < x->pre.start[op + 1]; j++) {
            int32_t fact = x->pre.at[j];
            if (r->mark[fact] == r->round) continue;
            r->mark[fact] = r->round;
            put(&r->zone, fact);
        }
    }
    memset(chosen, 0, (size_t)x->n_ops);
    return (Cost)f->plan.count;
}
