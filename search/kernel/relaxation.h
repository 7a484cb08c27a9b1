/* What is reached in the delete relaxation from one state.

   LM-cut and FF begin with it.  Source of h_max: Bonet and Geffner, Planning as heuristic search (2001). */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "fact_queue.h"
#include "lists.h"
#include "problem.h"
#include "relaxed_problem.h"
#include "values.h"

typedef struct {
    Cost cost, supporter_cost;
    int32_t supporter, unsatisfied; /* supporter: a fact, NONE where nothing is asked for */
    int32_t first_add, end_add;     /* what it adds in add.at */
} RelaxedOp;

/* What is reached from one state, and at what cost. */
typedef struct {
    RelaxedProblem problem;
    RelaxedOp *ops, *fresh; /* now, and before anything is reached */
    Cost *cost;             /* of facts */
    uint8_t *waiting;
    Queue queue;
    Ints initial;
    uint32_t *mark, round; /* of facts; marks from before this round are none */
    Ints zone;             /* facts that were collected backwards from the goal */
} Relaxation;

static int relaxation_new(Relaxation *r, const Problem *p) {
    RelaxedProblem *x = &r->problem;
    if (!relax(x, p)) return 0;
    size_t ops = (size_t)x->n_ops + 1, facts = (size_t)x->n_facts + 1;
    r->ops = malloc(ops * sizeof *r->ops), r->fresh = malloc(ops * sizeof *r->ops);
    r->cost = malloc(facts * sizeof(Cost)), r->waiting = calloc(facts, 1), r->mark = calloc(facts, sizeof *r->mark);
    r->queue.key = malloc(facts * sizeof(Cost)), r->queue.first = malloc(facts * sizeof(int32_t));
    r->queue.next = malloc(facts * sizeof(int32_t)), r->queue.last = malloc(facts * sizeof(int32_t));
    r->zone.at = malloc(facts * sizeof(int32_t)), r->initial.at = malloc(facts * sizeof(int32_t));
    if (!(r->ops && r->fresh && r->cost && r->waiting && r->mark && r->queue.key && r->queue.first && r->queue.next &&
          r->queue.last && r->zone.at && r->initial.at))
        return 0;
    for (int32_t o = 0; o < x->n_ops; o++)
        r->fresh[o] = (RelaxedOp){x->weight[o], 0, NONE, x->pre.start[o + 1] - x->pre.start[o], x->add.start[o], x->add.start[o + 1]};
    return 1;
}

static void relaxation_free(Relaxation *r) {
    relaxed_problem_free(&r->problem);
    free(r->ops), free(r->fresh), free(r->cost), free(r->waiting), free(r->mark);
    free(r->queue.key), free(r->queue.first), free(r->queue.next), free(r->queue.last);
    free(r->zone.at), free(r->initial.at);
}

static void facts_of(const RelaxedProblem *x, const Problem *p, const Word *state, Ints *found) {
    found->count = 0;
    for (int32_t f = 0; f < p->n_fields; f++) {
        int32_t fact = x->fact_of[p->fields[f].offset + (int32_t)code(state, &p->fields[f])];
        if (fact != NONE) put(found, fact);
    }
}

static inline void reach(Relaxation *r, int32_t fact, Cost cost) {
    Cost old = r->cost[fact];
    if (cost >= old) return;
    if (r->waiting[fact]) queue_remove(&r->queue, old, fact);
    r->waiting[fact] = 1, r->cost[fact] = cost;
    queue_push(&r->queue, cost, fact);
}

static inline void add_facts(Relaxation *r, const RelaxedOp *op, Cost cost) {
    const int32_t *facts = r->problem.add.at;
    for (int32_t j = op->first_add, end = op->end_add; j < end; j++) reach(r, facts[j], cost);
}

static inline int32_t next_fact(Relaxation *r) {
    int32_t fact = queue_pop(&r->queue);
    r->waiting[fact] = 0;
    return fact;
}

static int goal_reached(const Relaxation *r) {
    for (size_t i = 0; i < r->problem.goal.count; i++)
        if (r->cost[r->problem.goal.at[i]] == INFINITE_COST) return 0;
    return 1;
}

static void start_from(Relaxation *r, const Problem *p, const Word *state) {
    const RelaxedProblem *x = &r->problem;
    facts_of(x, p, state, &r->initial);
    memcpy(r->ops, r->fresh, (size_t)x->n_ops * sizeof *r->ops);
    for (int32_t f = 0; f < x->n_facts; f++) r->cost[f] = INFINITE_COST;
    for (size_t i = 0; i < r->initial.count; i++) reach(r, r->initial.at[i], 0);
}

/* h_max from where it was started, with the fact that supports each operator; whether the goal is reached. */
static int explore(Relaxation *r) {
    const RelaxedProblem *x = &r->problem;
    for (size_t i = 0; i < x->always.count; i++) add_facts(r, &r->ops[x->always.at[i]], r->ops[x->always.at[i]].cost);
    RelaxedOp *ops = r->ops;
    while (r->queue.count) {
        int32_t fact = next_fact(r);
        Cost cost = r->cost[fact];
        const int32_t *asking = x->asked_by.at + x->asked_by.start[fact], *end = x->asked_by.at + x->asked_by.start[fact + 1];
        for (; asking < end; asking++) {
            RelaxedOp *op = &ops[*asking];
            if (--op->unsatisfied) continue;
            op->supporter = fact, op->supporter_cost = cost;
            add_facts(r, op, cost + op->cost);
        }
    }
    return goal_reached(r);
}
