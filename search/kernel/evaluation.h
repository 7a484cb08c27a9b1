/* Lower bounds of nodes: what LM-cut says, when it is asked, and what follows for successors.

   Source of the last: landmarks of a state hold after an operator that is not in them; after Pommerening and Helmert,
   Incremental LM-cut (2013). */

#pragma once

#include <stdlib.h>
#include "landmarks.h"
#include "lm_cut.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_problem.h"
#include "state_table.h"
#include "values.h"

/* The turn that begins without landmarks of the state before: what is handed down again and again says less. */
enum { ANEW = N_PRIORITIES, TRIALS = 500, SELDOM = 20 };

typedef struct {
    LmCut lm_cut;
    /* how often LM-cut was asked, by turns, said more than what was known, and was not asked */
    int64_t asked[N_TURNS], raised[N_TURNS], skipped[N_TURNS];
    int64_t evaluated;
    const Word *rests_of; /* the state whose landmarks `rests` is about */
    Cost *rests;          /* per relaxed operator what is left after it; last: after those that are no relaxed ones */
} Evaluator;

static int evaluator_new(Evaluator *s, const RelaxedProblem *x) {
    return (s->rests = malloc(((size_t)x->n_ops + 1) * sizeof(Cost))) && lm_cut_new(&s->lm_cut, x);
}

static void evaluator_free(Evaluator *s) {
    lm_cut_free(&s->lm_cut), free(s->rests);
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
static void evaluate(Evaluator *s, const Problem *p, Relaxation *r, const Table *t, Node *node, const Word *state) {
    int32_t turn = node->evaluated++;
    if (node->exact || turn >= N_TURNS || (turn && (left_out & SECOND_CUTS << (turn - 1) || !pays(s, turn)))) return;
    s->evaluated++, s->asked[turn]++;
    const int32_t *known = NULL;
    if (turn != ANEW && node->parent != NONE && !node->renamed && !(left_out & HANDED_DOWN))
        known = set_of(&s->lm_cut.landmarks, node_of(t, node->parent)->landmarks, turn);
    Cost rest = lm_cut(&s->lm_cut, r, p, state, turn, known, node->op == NONE ? NONE : r->problem.class_of[node->op]);
    if (rest > node->rest) node->rest = rest, s->raised[turn]++;
    if ((node->exact = rest == INFINITE_COST)) return;
    node->landmarks = keep_set(&s->lm_cut.landmarks, &s->lm_cut.found, turn, node->landmarks);
    keep_rests(s, r, state, rest);
}

/* What is known to be left after an operator, from the state that was evaluated last. */
static inline Cost rest_after(const Evaluator *s, const RelaxedProblem *x, int32_t op) {
    int32_t class = x->class_of[op];
    return s->rests[class == NONE ? x->n_ops : class];
}
