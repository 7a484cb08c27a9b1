/* Lower bounds of nodes: what LM-cut says, when it is asked, and what follows for successors.

   Source of the last: landmarks of a state hold after an operator that is not in them; after Pommerening and Helmert,
   Incremental LM-cut (2013). */

#pragma once

#include <stdlib.h>
#include "intended_effects.h"
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
    Intentions intentions;
    /* how often LM-cut was asked, by turns and for an operator alone, said more than what was known, and was not asked */
    int64_t asked[N_TURNS + 1], raised[N_TURNS + 1], skipped[N_TURNS + 1];
    int64_t evaluated;
    const Word *rests_of; /* the state whose landmarks `rests` is about */
    Cost *rests;          /* per relaxed operator what is left after it; last: after those that are no relaxed ones */
} Evaluator;

static int evaluator_new(Evaluator *s, const RelaxedProblem *x, const Problem *p) {
    return intentions_new(&s->intentions, p, x) && (s->rests = malloc(((size_t)x->n_ops + 1) * sizeof(Cost))) && lm_cut_new(&s->lm_cut, x);
}

static void evaluator_free(Evaluator *s) {
    lm_cut_free(&s->lm_cut), intentions_free(&s->intentions), free(s->rests);
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

/* What LM-cut has left says of plans that intend what the operator before does. */
static void look_onward(Evaluator *s, const Problem *p, const Relaxation *r, Node *node, const Word *state, Cost total) {
    if (left_out & INTENDED_EFFECTS || node->op == NONE || node->onward == SEVERAL) return;
    Cost onward = with_intention(&s->intentions, p, r, node->op, state, total);
    if (onward > node->onward) node->onward = onward;
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
    look_onward(s, p, r, node, state, rest);
}

/* The same for the operator that the best way to the node ends with, where this was not asked together with LM-cut. */
static void evaluate_onward(Evaluator *s, const Problem *p, Relaxation *r, Node *node, const Word *state) {
    if (left_out & INTENDED_EFFECTS || node->onward || node->op == NONE) return;
    if (users_of(&s->intentions, p, &r->problem, node->op) < 0 || !pays(s, N_TURNS)) return;
    s->evaluated++, s->asked[N_TURNS]++;
    look_onward(s, p, r, node, state, lm_cut(&s->lm_cut, r, p, state, 0, set_of(&s->lm_cut.landmarks, node->landmarks, 0), NONE));
    if (node->onward > node->rest) s->raised[N_TURNS]++;
}

/* What is known to be left after an operator, from the state that was evaluated last. */
static inline Cost rest_after(const Evaluator *s, const RelaxedProblem *x, int32_t op) {
    int32_t class = x->class_of[op];
    return s->rests[class == NONE ? x->n_ops : class];
}
