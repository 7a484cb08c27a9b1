/* Lower bounds of nodes: what projections and LM-cut say, when LM-cut is asked, and what follows for successors.

   Source of the last: landmarks of a state hold after an operator that is not in them; after Pommerening and Helmert,
   Incremental LM-cut (2013). */

#pragma once

#include <stdint.h>
#include <stdlib.h>
#include "cost_partitioning.h"
#include "lm_cut.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_problem.h"
#include "state_table.h"
#include "values.h"

enum { TRIALS = 500, SELDOM = 20 };

typedef struct {
    LmCut lm_cut;
    Projections projections;
    /* how often LM-cut was asked, by turns, said more than what was known, and was not asked */
    int64_t asked[N_TURNS], raised[N_TURNS], skipped[N_TURNS];
    int64_t evaluated;
    const Word *rests_of; /* the state whose landmarks `rests` is about */
    Cost *rests;          /* per relaxed operator what is left after it; last: after those that are no relaxed ones */
} Evaluator;

static int evaluator_new(Evaluator *s, const RelaxedProblem *x) {
    return (s->rests = malloc(((size_t)x->n_ops + 1) * sizeof(Cost))) && lm_cut_new(&s->lm_cut, x);
}

static void evaluator_free(Evaluator *s) { lm_cut_free(&s->lm_cut), projections_free(&s->projections), free(s->rests); }

/* What projections say of a node, once. */
static void look_up(const Evaluator *s, const Problem *p, Node *node, const Word *state) {
    if (node->projected || !s->projections.n_orders) return;
    node->projected = 1;
    Cost rest = projected(&s->projections, p, state);
    if (rest > node->rest) node->rest = rest;
    if (rest == INFINITE_COST) node->exact = 1;
}

/* Whether it is worth asking: one that seldom said more is asked now and then only. */
static int pays(Evaluator *s, int32_t turn) {
    return s->asked[turn] < TRIALS || s->raised[turn] * SELDOM >= s->asked[turn] || !(s->skipped[turn]++ % SELDOM);
}

/* What is left after each operator, at least: of the landmarks of LM-cut those that it is not in. */
static void keep_rests(Evaluator *s, const Relaxation *r, const Word *state, Cost total) {
    const RelaxedProblem *x = &r->problem;
    if (s->rests_of != state) {
        for (int32_t o = 0; o <= x->n_ops; o++) s->rests[o] = 0;
        s->rests_of = state;
    }
    for (int32_t o = 0; o < x->n_ops; o++) {
        Cost rest = total - x->weight[o] + r->ops[o].cost;
        if (rest > s->rests[o]) s->rests[o] = rest;
    }
    if (total > s->rests[x->n_ops]) s->rests[x->n_ops] = total;
}

/* What the next turn of LM-cut says of a node. */
static void evaluate(Evaluator *s, const Problem *p, Relaxation *r, Node *node, const Word *state) {
    int32_t turn = node->evaluated++;
    if (node->exact || turn >= N_TURNS || (turn && !pays(s, turn))) return;
    s->evaluated++, s->asked[turn]++;
    Cost rest = lm_cut(&s->lm_cut, r, p, state, turn);
    if (rest > node->rest) node->rest = rest, s->raised[turn]++;
    if (rest == INFINITE_COST) {
        node->exact = 1;
        return;
    }
    keep_rests(s, r, state, rest);
}

/* What is known to be left after an operator, from the state that was evaluated last. */
static inline Cost rest_after(const Evaluator *s, const RelaxedProblem *x, int32_t op) {
    int32_t class = x->class_of[op];
    return s->rests[class == NONE ? x->n_ops : class];
}
