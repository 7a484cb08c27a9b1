/* LM-cut: an admissible bound from landmarks, sets of operators of which each plan needs one.

   Sources: Helmert and Domshlak, Landmarks, critical paths and abstractions (2009); asked several times with ties between
   preconditions broken otherwise, Lauer and Fickert, Beating LM-cut with LM-cut (2020).  A cut is sought backwards
   from the goal zone, as a fact cheaper than the goal can't depend on the zone. */

#pragma once

#include <stdlib.h>
#include <string.h>
#include "landmarks.h"
#include "lists.h"
#include "problem.h"
#include "relaxation.h"
#include "relaxed_problem.h"
#include "values.h"

enum { N_PRIORITIES = 2, N_TURNS = N_PRIORITIES + 1 };

typedef struct {
    RelaxedOp *explored; /* h_max from the state `explored_from`, for its other turns */
    Cost *explored_cost;
    const Word *explored_from;
    int solvable;
    uint32_t *op_mark; /* marks are of a round: in the goal zone, before it (+ 1), neither (+ 2) */
    int32_t *free_adder, *next_free; /* per fact the places in add.at of operators that cost nothing any more */
    Ints stack, cut;
    Landmarks landmarks;
    Ints found; /* the places of those of the state that was asked about last */
    const Cost *priority; /* breaks ties between facts, the greatest first; NULL: the one that was there */
    Cost *priorities;     /* the fewest operators that add it; of these most that ask for it, or the last */
} LmCut;

static int lm_cut_new(LmCut *c, const RelaxedProblem *x) {
    size_t ops = (size_t)x->n_ops + 1, facts = (size_t)x->n_facts + 1, slots = (size_t)x->n_slots + 1;
    c->explored = malloc(ops * sizeof *c->explored), c->explored_cost = malloc(facts * sizeof(Cost));
    c->op_mark = calloc(ops, sizeof *c->op_mark);
    c->free_adder = malloc(facts * sizeof(int32_t)), c->next_free = malloc(slots * sizeof(int32_t));
    c->stack.at = malloc((facts + slots) * sizeof(int32_t)), c->cut.at = malloc(ops * sizeof(int32_t));
    c->priorities = malloc(N_PRIORITIES * facts * sizeof *c->priorities);
    if (!(c->explored && c->explored_cost && c->op_mark && c->free_adder && c->next_free && c->stack.at && c->cut.at &&
          c->priorities))
        return 0;
    for (int32_t f = 0; f < x->n_facts; f++) {
        Cost rare = INT32_MAX - (x->added_by.start[f + 1] - x->added_by.start[f]);
        c->priorities[f] = (rare << 32) + x->asked_by.start[f + 1] - x->asked_by.start[f];
        c->priorities[facts + (size_t)f] = (rare << 32) + f;
    }
    return 1;
}

static void lm_cut_free(LmCut *c) {
    free(c->explored), free(c->explored_cost), free(c->op_mark), free(c->free_adder), free(c->next_free);
    free(c->stack.at), free(c->cut.at), free(c->found.at), landmarks_free(&c->landmarks), free(c->priorities);
}

/* The dearest of some facts; of those the one that was it before, or that has the greatest priority. */
static inline int32_t dearest(const LmCut *c, const Relaxation *r, const int32_t *facts, int32_t count, int32_t before) {
    const Cost *costs = r->cost, *priority = c->priority;
    int32_t best = before;
    Cost most = costs[before];
    for (int32_t k = 0; k < count; k++) {
        Cost cost = costs[facts[k]];
        if (cost > most || (priority && cost == most && priority[facts[k]] > priority[best])) best = facts[k], most = cost;
    }
    return best;
}

static inline int32_t dearest_asked(const LmCut *c, const Relaxation *r, int32_t op) {
    const Lists *pre = &r->problem.pre;
    return dearest(c, r, pre->at + pre->start[op], pre->start[op + 1] - pre->start[op], r->ops[op].supporter);
}

/* The same after operators of the cut have become cheaper. */
static void explore_again(const LmCut *c, Relaxation *r) {
    const RelaxedProblem *x = &r->problem;
    RelaxedOp *ops = r->ops;
    for (size_t i = 0; i < c->cut.count; i++) {
        const RelaxedOp *op = &ops[c->cut.at[i]];
        add_facts(r, op, op->supporter_cost + op->cost);
    }
    while (r->queue.count) {
        int32_t fact = next_fact(r);
        Cost cost = r->cost[fact];
        const int32_t *asking = x->asked_by.at + x->asked_by.start[fact], *end = x->asked_by.at + x->asked_by.start[fact + 1];
        for (; asking < end; asking++) {
            RelaxedOp *op = &ops[*asking];
            if (op->supporter != fact || op->supporter_cost <= cost || op->unsatisfied) continue;
            op->supporter = dearest_asked(c, r, *asking);
            Cost now_cost = r->cost[op->supporter];
            if (now_cost == op->supporter_cost) continue;
            op->supporter_cost = now_cost;
            add_facts(r, op, now_cost + op->cost);
        }
    }
}

/* Facts from which a fact costs nothing more. */
static void mark_zone(const LmCut *c, Relaxation *r, int32_t goal) {
    const RelaxedProblem *x = &r->problem;
    r->round += 3, r->zone.count = 0;
    r->mark[goal] = r->round;
    put(&r->zone, goal);
    for (size_t i = 0; i < r->zone.count; i++)
        for (int32_t j = c->free_adder[r->zone.at[i]]; j != NONE; j = c->next_free[j]) {
            int32_t from = r->ops[x->adder[j]].supporter;
            if (from == NONE || r->mark[from] == r->round) continue;
            r->mark[from] = r->round;
            put(&r->zone, from);
        }
}

/* Whether a fact can be reached without the zone, in which all facts cost at least `least`. */
static int is_before(LmCut *c, Relaxation *r, int32_t fact, Cost least) {
    const RelaxedProblem *x = &r->problem;
    uint32_t before = r->round + 1, not_before = r->round + 2;
    if (r->cost[fact] < least || r->mark[fact] == before) return 1;
    if (r->mark[fact] == not_before) return 0;
    c->stack.count = 0;
    put(&c->stack, fact);
    r->mark[fact] = not_before;
    for (size_t i = 0; i < c->stack.count; i++) {
        int32_t at = c->stack.at[i];
        for (int32_t j = x->added_by.start[at]; j < x->added_by.start[at + 1]; j++) {
            const RelaxedOp *op = &r->ops[x->added_by.at[j]];
            if (op->unsatisfied) continue;
            int32_t from = op->supporter;
            if (from == NONE || r->cost[from] < least || r->mark[from] == before) {
                for (size_t k = 0; k < c->stack.count; k++) r->mark[c->stack.at[k]] = 0;
                r->mark[fact] = before;
                return 1;
            }
            if (r->mark[from] == r->round || r->mark[from] == not_before) continue;
            r->mark[from] = not_before;
            put(&c->stack, from);
        }
    }
    return 0;
}

/* Operators that lead into the zone: each plan needs one of them.  The least that one costs. */
static Cost find_cut(LmCut *c, Relaxation *r, Cost least) {
    const RelaxedProblem *x = &r->problem;
    const RelaxedOp *ops = r->ops;
    const uint32_t *mark = r->mark, round = r->round;
    uint32_t *op_mark = c->op_mark;
    int32_t *cut = c->cut.at;
    size_t count = 0;
    Cost cheapest = INFINITE_COST;
    for (size_t i = 0; i < r->zone.count; i++) {
        int32_t fact = r->zone.at[i];
        const int32_t *adding = x->added_by.at + x->added_by.start[fact], *end = x->added_by.at + x->added_by.start[fact + 1];
        for (; adding < end; adding++) {
            const RelaxedOp *op = &ops[*adding];
            if (op->unsatisfied || !op->cost || op_mark[*adding] == round) continue;
            if (op->supporter_cost >= least && (mark[op->supporter] == round || !is_before(c, r, op->supporter, least))) continue;
            op_mark[*adding] = round, cut[count++] = *adding;
            if (op->cost < cheapest) cheapest = op->cost;
        }
    }
    c->cut.count = count;
    return cheapest;
}

/* A landmark takes what it costs of its operators' costs. */
static void take(LmCut *c, Relaxation *r, const int32_t *ops, int32_t count, Cost cost) {
    const Lists *add = &r->problem.add;
    for (int32_t i = 0; i < count; i++) {
        if (r->ops[ops[i]].cost -= cost) continue;
        for (int32_t j = add->start[ops[i]]; j < add->start[ops[i] + 1]; j++)
            c->next_free[j] = c->free_adder[add->at[j]], c->free_adder[add->at[j]] = j;
    }
}

/* The landmarks of a set that an operator is not in; what they cost. */
static Cost take_known(LmCut *c, Relaxation *r, const int32_t *set, int32_t without) {
    Cost total = 0;
    for (const int32_t *place = set + SET, *end = place + set[0]; place < end; place++) {
        const int32_t *landmark = c->landmarks.pool.at + *place, *ops = landmark + LANDMARK;
        int32_t count = landmark[3], i = 0;
        while (i < count && ops[i] != without) i++;
        if (i < count) continue;
        take(c, r, ops, count, cost_of(landmark));
        ints_push(&c->found, *place);
        total += cost_of(landmark);
    }
    return total;
}

/* The LM-cut value of a state of the table, which is known by its address; operators keep what it has not taken of
   their costs.  Ties are broken in one way per turn.  It begins with the landmarks of a set that an operator, which
   has led to the state, is not in, if there is one. */
static Cost lm_cut(LmCut *c, Relaxation *r, const Problem *p, const Word *state, int32_t turn, const int32_t *set, int32_t without) {
    const RelaxedProblem *x = &r->problem;
    size_t ops = (size_t)x->n_ops, facts = (size_t)x->n_facts;
    c->priority = turn < N_PRIORITIES ? c->priorities + (size_t)turn * (facts + 1) : NULL;
    c->found.count = 0;
    memset(c->free_adder, 0xFF, facts * sizeof *c->free_adder);
    Cost total = 0;
    if (set) {
        start_from(r, p, state);
        total = take_known(c, r, set, without);
        if (!explore(r)) return INFINITE_COST;
    } else if (c->explored_from != state) {
        start_from(r, p, state);
        c->explored_from = state, c->solvable = explore(r);
        memcpy(c->explored, r->ops, ops * sizeof *r->ops);
        memcpy(c->explored_cost, r->cost, facts * sizeof *r->cost);
    } else {
        memcpy(r->ops, c->explored, ops * sizeof *r->ops);
        memcpy(r->cost, c->explored_cost, facts * sizeof *r->cost);
    }
    if (!set && !c->solvable) return INFINITE_COST;
    if (!x->goal.count) return 0;
    if (c->priority)
        for (size_t o = 0; o < ops; o++)
            if (!r->ops[o].unsatisfied && r->ops[o].supporter != NONE) r->ops[o].supporter = dearest_asked(c, r, (int32_t)o);
    if (r->round > UINT32_MAX / 2) {
        r->round = 0;
        memset(r->mark, 0, facts * sizeof *r->mark), memset(c->op_mark, 0, ops * sizeof *c->op_mark);
    }
    int32_t goal = x->goal.at[0];
    for (;;) {
        goal = dearest(c, r, x->goal.at, (int32_t)x->goal.count, goal);
        Cost most = r->cost[goal];
        if (!most) return total;
        mark_zone(c, r, goal);
        Cost least = find_cut(c, r, most);
        total += least;
        int32_t place = place_of(&c->landmarks, c->cut.at, (int32_t)c->cut.count, least);
        if (place != NONE) ints_push(&c->found, place);
        take(c, r, c->cut.at, (int32_t)c->cut.count, least);
        explore_again(c, r);
    }
}
