/* A*: a cheapest plan, or that none is below a limit.

   A state is evaluated when it comes up, not when it is generated, and opened again at a lower cost.  Source: Hart,
   Nilsson and Raphael, A formal basis for the heuristic determination of minimum cost paths (1968). */

#pragma once

#include <stdlib.h>
#include "evaluation.h"
#include "heap.h"
#include "learning.h"
#include "like_fields.h"
#include "lists.h"
#include "lookahead.h"
#include "problem.h"
#include "relaxation.h"
#include "state_table.h"
#include "stubborn_sets.h"
#include "successor_generator.h"
#include "values.h"

typedef struct {
    const Problem *problem;
    Relaxation *relaxation;
    Lookahead *lookahead;
    Evaluator evaluator;
    Stubborn stubborn;
    Table table;
    Heap open;
    Ints applicable, closed, plan, spare; /* plan: the best that was found, if has_plan; it costs what the limit is */
    Ints alike;  /* fields that are: only states that stand for others are in the table */
    Word *row, *real, *like, *other, *target; /* rows to work with */
    Word *asked; /* where it began, as it was asked about */
    Cost limit, least; /* nothing from the limit on is of interest; no plan is cheaper than least */
    uint32_t stamp;
    int32_t start, serial, has_plan;
    Cost nearest; /* what was left where plans were looked for, since least has risen */
    int cut_off, unfit; /* whether something was left out because of the limit, or as it costs more than there is room for */
    int64_t expanded, generated;
} AStar;

static int a_star_new(AStar *s, const Problem *p, Relaxation *r, Lookahead *l) {
    s->problem = p, s->relaxation = r, s->lookahead = l, s->table.words = p->words;
    size_t words = (size_t)p->words;
    s->row = malloc(6 * words * sizeof *s->row), s->applicable.at = malloc(((size_t)p->n_ops + 1) * sizeof(int32_t));
    if (s->row) s->asked = s->row + words, s->real = s->asked + words, s->like = s->real + words;
    if (s->row) s->other = s->like + words, s->target = s->other + words;
    return s->row && s->applicable.at && evaluator_new(&s->evaluator, &r->problem) && stubborn_new(&s->stubborn, p);
}

static void a_star_free(AStar *s) {
    evaluator_free(&s->evaluator), table_free(&s->table);
    if (s->problem) stubborn_free(&s->stubborn, s->problem->n_ops);
    free(s->open.at), free(s->applicable.at), free(s->closed.at), free(s->plan.at), free(s->spare.at), free(s->alike.at), free(s->row);
}

/* Whether a node costs in all, at least, what its entry in the queue says. */
static int is_up_to_date(const Node *node, Cost total) {
    return node->rest < INFINITE_COST && node->spent + node->rest == total;
}

static void open_node(AStar *s, int32_t id) {
    Node *node = node_of(&s->table, id);
    if (node->rest == INFINITE_COST) return;
    Cost total = plus(node->spent, node->rest);
    if (total >= s->limit || total == MOST_COST) {
        if (total >= s->limit) s->cut_off = 1;
        else s->unfit = 1;
        return;
    }
    heap_push(&s->open, (Entry){total, node->rest, id, s->serial++});
}

static int first_first(const void *a, const void *b) { return *(const int32_t *)a - *(const int32_t *)b; }

/* Operators that are applicable in a state, ascending. */
static const Ints *allowed_in(AStar *s, const Word *state) {
    successors(s->problem, state, &s->applicable);
    qsort(s->applicable.at, s->applicable.count, sizeof(int32_t), first_first);
    return &s->applicable;
}

static void copy_row(const AStar *s, Word *to, const Word *from) { memcpy(to, from, (size_t)s->problem->words * sizeof *to); }

/* Be told which fields are alike.  What is known of a state is known of what stands for it; a search that is under way has to
   begin anew. */
static int take_alike(AStar *s, const int32_t *fields, int32_t count, size_t allowed) {
    Table *t = &s->table;
    grant(t, allowed);
    if (!set_alike(&s->alike, fields, count)) return t->wanted = SIZE_MAX, MEMORY;
    for (int32_t id = 0, known = t->count; id < known; id++) {
        copy_row(s, s->row, state_of(t, id));
        if (!represent(s->problem, &s->alike, s->row)) continue;
        if (!reserve(t, 1)) return MEMORY;
        const Node *node = node_of(t, id);
        Node *like = node_of(t, find(t, s->row, NULL));
        if (node->exact || (!like->exact && node->rest > like->rest)) like->rest = node->rest, like->exact = node->exact;
    }
    return FOUND;
}

/* The number of what stands for a state, or NONE. */
static int32_t met_like(const AStar *s, const Word *state) {
    copy_row(s, s->like, state);
    represent(s->problem, &s->alike, s->like);
    return met(&s->table, s->like);
}

/* Whether one state stands for both. */
static int are_alike(const AStar *s, const Word *state, const Word *target) {
    copy_row(s, s->like, state), copy_row(s, s->target, target);
    represent(s->problem, &s->alike, s->like), represent(s->problem, &s->alike, s->target);
    return is_same(s->like, s->target, s->problem->words);
}

/* The next operator of the cheapest plan that was found from a state, which `row` becomes the state after; NONE: there
   is none, or it ends here. */
static int32_t known_step(AStar *s, Word *row) {
    const Problem *p = s->problem;
    int32_t id = met_like(s, row);
    if (id == NONE || !node_of(&s->table, id)->exact || !node_of(&s->table, id)->rest) return NONE;
    Cost rest = node_of(&s->table, id)->rest;
    const Ints *ops = allowed_in(s, row);
    copy_row(s, s->real, row);
    for (size_t i = 0; i < ops->count; i++) {
        apply(p, ops->at[i], s->real, row);
        int32_t next = met_like(s, row);
        if (next == NONE) continue;
        const Node *after = node_of(&s->table, next);
        if (after->exact && after->rest != INFINITE_COST && after->rest + p->weight[ops->at[i]] == rest) return ops->at[i];
    }
    return NONE;
}

/* Of the way to a node, which leads by states that stand for others, and of what follows, the operators from the state that
   was asked about on.  `chain`: how many lead to the node. */
static void name_really(AStar *s, Ints *way, size_t chain) {
    const Problem *p = s->problem;
    Word *at = s->other, *real = s->real; /* the same, but for names */
    copy_row(s, at, state_of(&s->table, s->start)), copy_row(s, real, s->asked);
    for (size_t i = 0; i < way->count; i++) {
        int32_t op = way->at[i];
        apply(p, op, at, s->row);
        copy_row(s, at, s->row);
        if (i < chain) represent(p, &s->alike, at);
        const Ints *ops = allowed_in(s, real);
        for (size_t j = 0; j < ops->count; j++) {
            if (p->weight[ops->at[j]] != p->weight[op]) continue;
            apply(p, ops->at[j], real, s->row);
            if (!are_alike(s, s->row, at)) continue;
            way->at[i] = ops->at[j], copy_row(s, real, s->row);
            break;
        }
    }
}

/* A better plan: by the way to a node, and on from there. */
static int keep_plan(AStar *s, int32_t id, const Ints *rest) {
    if (!way_to(&s->table, id, rest, &s->spare)) return 0;
    if (s->alike.count) name_really(s, &s->spare, s->spare.count - rest->count);
    Ints before = s->plan;
    s->plan = s->spare, s->spare = before;
    s->has_plan = 1, s->limit = node_of(&s->table, id)->spent;
    for (size_t i = 0; i < rest->count; i++) s->limit += s->problem->weight[rest->at[i]];
    return 1;
}

/* What relaxed plans suggest from a node may be a better plan, if it is nearer to the goal than all others that cost as much. */
static void suggest(AStar *s, int32_t id) {
    const Node *node = node_of(&s->table, id);
    if (left_out & LOOKAHEAD || node->rest >= s->nearest) return;
    s->nearest = node->rest;
    Cost left = (s->limit < MOST_COST ? s->limit : MOST_COST) - node->spent;
    if (look_ahead(s->lookahead, s->relaxation, s->problem, state_of(&s->table, id), left) != INFINITE_COST)
        keep_plan(s, id, &s->lookahead->plan);
}

/* From a node of which the cost is known: the plan that it is known by. */
static int go_on(AStar *s, int32_t id) {
    Ints *rest = &s->lookahead->plan;
    rest->count = 0;
    memcpy(s->lookahead->state, state_of(&s->table, id), (size_t)s->problem->words * sizeof(Word));
    for (int32_t op; (op = known_step(s, s->lookahead->state)) != NONE;)
        if (!ints_push(rest, op)) return 0;
    return keep_plan(s, id, rest);
}

static int finish(AStar *s, int outcome, Cost total) {
    learn(&s->table, &s->closed, total);
    s->least = total;
    copy_row(s, s->real, s->asked);
    if (outcome == FOUND && s->has_plan) learn_plan(&s->table, s->problem, &s->alike, &s->plan, total, s->real, s->like);
    return outcome;
}

/* The limit is INFINITE_COST, or at most MOST_COST. */
static int a_star_begin(AStar *s, const Word *state, Cost limit, size_t allowed) {
    s->open.count = s->closed.count = 0;
    s->least = 0;
    grant(&s->table, allowed);
    if (!reserve(&s->table, 1) || !heap_reserve(&s->open, 1, &s->table)) return MEMORY;
    copy_row(s, s->asked, state), copy_row(s, s->row, state);
    represent(s->problem, &s->alike, s->row);
    s->start = find(&s->table, s->row, NULL);
    Node *node = node_of(&s->table, s->start);
    s->limit = limit, s->cut_off = s->unfit = 0, s->serial = 0, s->has_plan = 0, s->nearest = INFINITE_COST;
    s->stamp++;
    node->stamp = s->stamp, node->spent = 0, node->closed = 0, node->parent = NONE, node->op = NONE;
    open_node(s, s->start);
    return RUNNING;
}

/* Of equal entries the latest is expanded first, so the first operator comes last: plans are found near the canonical one. */
static int later_first(const void *a, const void *b) { return *(const int32_t *)b - *(const int32_t *)a; }

static void expand(AStar *s, int32_t id) {
    const Problem *p = s->problem;
    Node *node = node_of(&s->table, id);
    const Word *state = state_of(&s->table, id);
    int fresh = s->evaluator.rests_of == state;
    node->closed = 1;
    ints_push(&s->closed, id);
    s->expanded++;
    successors(p, state, &s->applicable);
    leave_stubborn(&s->stubborn, p, &s->table, state, &s->applicable);
    qsort(s->applicable.at, s->applicable.count, sizeof(int32_t), later_first);
    for (size_t i = 0; i < s->applicable.count; i++) {
        int32_t op = s->applicable.at[i];
        apply(p, op, state, s->row);
        int moved = represent(p, &s->alike, s->row);
        int32_t next = find(&s->table, s->row, NULL);
        Node *after = node_of(&s->table, next);
        s->generated++;
        Cost spent = plus(node->spent, p->weight[op]);
        if (after->stamp == s->stamp && after->spent <= spent) continue;
        after->stamp = s->stamp, after->spent = spent, after->parent = id, after->op = op, after->closed = 0;
        after->renamed = moved != 0;
        if (!after->exact) {
            Cost rest = node->rest - p->weight[op];
            Cost known = fresh ? rest_after(&s->evaluator, &s->relaxation->problem, op) : 0;
            if (known > rest) rest = known;
            if (after->rest < rest) after->rest = rest;
        }
        open_node(s, next);
    }
}

static int a_star_run(AStar *s, double seconds, size_t allowed) {
    const Problem *p = s->problem;
    double end = now() + seconds;
    grant(&s->table, allowed);
    while (s->open.count) {
        Entry entry = s->open.at[0];
        Node *node = node_of(&s->table, entry.item);
        if (node->closed || !is_up_to_date(node, entry.key)) {
            heap_pop(&s->open);
            continue;
        }
        if (entry.key >= s->limit) break;
        if (entry.key > s->least) s->least = entry.key, s->nearest = INFINITE_COST;
        if (now() >= end) return RUNNING;
        const Word *state = state_of(&s->table, entry.item);
        if (!node->exact && is_goal(p, state)) node->rest = 0, node->exact = 1;
        if (node->exact && node->spent + node->rest == entry.key) {
            if (entry.item == s->start && node->rest) return finish(s, FOUND, entry.key); /* its plan is known */
            if (!go_on(s, entry.item)) return MEMORY;
            break;
        }
        if (!landmarks_reserve(&s->evaluator.lm_cut.landmarks, &s->table)) return MEMORY;
        if (node->evaluated < N_TURNS && is_up_to_date(node, entry.key))
            evaluate(&s->evaluator, p, s->relaxation, &s->table, node, state);
        if (!is_up_to_date(node, entry.key)) {
            heap_pop(&s->open);
            open_node(s, entry.item);
            continue;
        }
        if (node->evaluated < N_TURNS) continue;
        suggest(s, entry.item);
        if (entry.key >= s->limit) break;
        size_t more = (size_t)p->n_ops + 1;
        if (!reserve(&s->table, (int32_t)more) || !heap_reserve(&s->open, more, &s->table)) return MEMORY;
        heap_pop(&s->open);
        expand(s, entry.item);
    }
    if (!s->has_plan && s->unfit) return UNFIT;
    if (!s->has_plan) return s->cut_off ? finish(s, NOT_BELOW, s->limit) : finish(s, HOPELESS, INFINITE_COST);
    return reserve(&s->table, (int32_t)s->plan.count + 1) ? finish(s, FOUND, s->limit) : MEMORY;
}

/* Lower bound from a state; -1 where memory is missing.  A search that is under way goes on with what it says. */
static Cost a_star_bound(AStar *s, const Word *asked, size_t allowed) {
    grant(&s->table, allowed);
    if (!reserve(&s->table, 1) || !landmarks_reserve(&s->evaluator.lm_cut.landmarks, &s->table)) return -1;
    copy_row(s, s->like, asked);
    represent(s->problem, &s->alike, s->like);
    int32_t id = find(&s->table, s->like, NULL);
    Node *node = node_of(&s->table, id);
    const Word *state = state_of(&s->table, id);
    if (!node->evaluated && node->rest < INFINITE_COST) {
        int is_open = s->stamp && node->stamp == s->stamp && !node->closed;
        if (is_open && !heap_reserve(&s->open, 1, &s->table)) return -1;
        evaluate(&s->evaluator, s->problem, s->relaxation, &s->table, node, state);
        if (is_open) open_node(s, id); /* its entry in the queue is no longer true */
    }
    return node->rest;
}
